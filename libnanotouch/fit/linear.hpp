// SPDX-License-Identifier: BSD-3-Clause
// Fits that are linear in what is free; private to fit/.
#pragma once

#include "model.hpp"

namespace nanotouch
{

// The least-squares values where all that is free enters linearly: Hertz, cone or pyramid over the indentation itself,
// about a given contact point. False: it does not, or what comes out lies outside its bounds.
bool solve_linear(const nt_fit_options &options, const nt_fit_data &data, Parameters *value);

} // namespace nanotouch
