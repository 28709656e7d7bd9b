// SPDX-License-Identifier: BSD-3-Clause
// Adhesive laws: from the deepest point to the tear, or the lowest force. Others: as far as the force is repulsive.
#include "points.hpp"

#include <algorithm>
#include <cmath>

namespace nanotouch
{

namespace
{

constexpr double beyond_contact = 1.5; // of the loaded travel, seen where nothing attracts

bool is_adhesive(nt_fit_model model)
{
    return model == NT_FIT_DMT || model == NT_FIT_JKR || model == NT_FIT_MAUGIS;
}

// Up to where attraction begins; without attraction, a piece of the baseline as well.
std::size_t repulsive(const Branch &branch)
{
    const std::size_t count = branch.z.size();
    const auto deepest = std::max_element(branch.force.begin(), branch.force.end());
    const auto below = std::find_if(deepest, branch.force.end(), [](double force) { return force <= 0.0; });
    const auto zero = static_cast<std::size_t>(below - branch.force.begin());
    if (branch.dips())
        return zero;
    const double beyond = branch.z[0] + beyond_contact * (branch.z[std::min(zero, count - 1)] - branch.z[0]);
    const auto end = std::lower_bound(branch.z.begin(), branch.z.end(), beyond);
    return std::max(zero, static_cast<std::size_t>(end - branch.z.begin()));
}

} // namespace

double Fitted::largest() const
{
    const auto [low, high] = std::minmax_element(force.begin(), force.end());
    return std::max(std::fabs(*low), std::fabs(*high));
}

nt_status check_count(const Fitted &fitted, nt_problem *problem)
{
    if (fitted.position.size() >= NT_FIT_MIN_POINTS)
        return NT_OK;
    *problem = {"points left to fit", "", double(fitted.position.size()), NT_FIT_MIN_POINTS, 1e9};
    return NT_E_RANGE;
}

nt_status take_points(const nt_fit_recipe &recipe, const Branch &branch, Fitted *fitted, nt_problem *problem)
{
    const bool adhesive = is_adhesive(recipe.options.model);
    std::size_t last = 0;
    const bool torn = adhesive && !recipe.approach && branch.tear(&last);
    const std::size_t lowest = adhesive && branch.dips() ? branch.lowest() + 1 : 0;
    const std::size_t end = torn ? last + 1 : lowest > 0 ? lowest : repulsive(branch);
    for (std::size_t i = 0; i < end; i++) {
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
