// SPDX-License-Identifier: BSD-3-Clause
// Which points of a branch are fitted; private to fit/.
#pragma once

#include <vector>

#include "nanotouch/fit.h"

namespace nanotouch
{

// Positions towards the sample, from the deepest point outwards, and where the tip was torn off.
struct Fitted {
    std::vector<double> position, force;
    bool torn = false;
    double tear_position = 0.0, tear_sigma = 0.0;
    nt_fit_data data() const
    {
        return {position.data(), force.data(), static_cast<long>(position.size()), 1, 1};
    }
};

// Those that the law can describe. NT_E_RANGE if they are too few.
nt_status take_points(const nt_fit_recipe &recipe, const nt_curve_branch &branch, Fitted *fitted, nt_problem *problem);

} // namespace nanotouch
