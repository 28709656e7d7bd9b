// SPDX-License-Identifier: BSD-3-Clause
// White and 1/f (flicker) noise of a record; private to fit/. Definitions: curves/flicker.py.
#pragma once

#include <vector>

namespace nanotouch
{

// The mean of n neighbouring points has the variance white/n + flicker [N^2].
struct Noise {
    double white, flicker;
};

// Of residuals in their order of time with a robust standard deviation `scatter`, which white is no less than.
Noise split_noise(const std::vector<double> &rest, double scatter);

} // namespace nanotouch
