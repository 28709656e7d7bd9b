// SPDX-License-Identifier: BSD-3-Clause
// Adhesive laws: from the deepest point to the tear, or the lowest force. Others: as far as the force is repulsive.
#include "points.hpp"
#include "core/problem.h"

#include <algorithm>
#include <cmath>

namespace nanotouch
{

namespace
{

nt_status check_count(const Fitted &fitted, nt_problem *problem)
{
    if (fitted.position.size() >= NT_CURVE_FEWEST)
        return NT_OK;
    *problem = nt_problem_of("points left to fit", "", double(fitted.position.size()), NT_CURVE_FEWEST, 1e9);
    return NT_E_RANGE;
}

} // namespace

nt_status take_points(const nt_fit_recipe &recipe, const nt_curve_branch &branch, Fitted *fitted, nt_problem *problem)
{
    const bool adhesive = nt_fit_describe(recipe.options.model).pull_off > 0.0;
    const bool torn = adhesive && !recipe.approach && branch.torn >= 0;
    const long last = torn ? branch.torn : branch.lowest;
    const long end = adhesive && branch.dips ? last + 1 : branch.repulsive;
    for (long i = 0; i < end; i++) {
        if (!(branch.force[i] >= recipe.lowest_force && branch.force[i] <= recipe.highest_force))
            continue;
        fitted->position.push_back(-branch.z[i]);
        fitted->force.push_back(branch.force[i]);
    }
    fitted->torn = torn && std::isinf(recipe.lowest_force) && std::isinf(recipe.highest_force);
    if (fitted->torn) { // equally likely anywhere between this sample and the next
        const double step = branch.z[last + 1] - branch.z[last];
        fitted->tear_position = -(branch.z[last] + 0.5 * step);
        fitted->tear_sigma = step / std::sqrt(12.0);
    }
    return check_count(*fitted, problem);
}

} // namespace nanotouch
