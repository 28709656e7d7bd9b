// SPDX-License-Identifier: BSD-3-Clause
// Many curves over threads. Each outcome depends on its own curve only, so the number of threads changes none.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#include "core/problem.h"
#include "curve.hpp"
#include "internal/fit.h"

namespace nanotouch
{

namespace
{

// Stand for those of the curves while a recipe is checked.
constexpr double typical_spring_constant = 1.0; // N/m
constexpr double typical_loss_scale = 1e-9;     // N

void fit_safely(const nt_fit_recipe &recipe, const nt_curve &curve, nt_fit_outcome *outcome) noexcept
{
    try {
        fit_recorded(recipe, curve, outcome);
    } catch (const std::bad_alloc &) {
        *outcome = failed(NT_E_NO_MEMORY);
    } catch (...) {
        *outcome = failed(NT_E_NO_CONVERGENCE);
    }
}

nt_status check_curves(const nt_fit_curves *curves)
{
    if (!curves || curves->count < 0 || curves->threads < 0 || (curves->count > 0 && !curves->curve))
        return NT_E_ARGUMENT;
    for (long i = 0; i < curves->count; i++)
        for (const nt_curve_segment *segment : {&curves->curve[i].approach, &curves->curve[i].retract})
            if (segment->count < 0 || (segment->count > 0 && (!segment->z || !segment->force)))
                return NT_E_ARGUMENT;
    return NT_OK;
}

void fit_all(const nt_fit_recipe &recipe, const nt_fit_curves &curves, nt_fit_outcome *outcome)
{
    std::atomic<long> next{0};
    const auto work = [&]() noexcept {
        for (long i = next++; i < curves.count; i = next++)
            fit_safely(recipe, curves.curve[i], &outcome[i]);
    };
    const long asked = curves.threads > 0 ? curves.threads : static_cast<long>(std::thread::hardware_concurrency());
    std::vector<std::thread> others;
    try {
        for (long i = 1; i < std::min(asked, curves.count); i++)
            others.emplace_back(work);
    } catch (const std::exception &) { // no more threads to be had: those there are do all the work
    }
    work();
    for (std::thread &other : others)
        other.join();
}

} // namespace

} // namespace nanotouch

nt_fit_recipe nt_fit_recipe_defaults(nt_fit_model model)
{
    const double all = std::numeric_limits<double>::infinity();
    const bool adhesive = nt_fit_describe(model).pull_off > 0.0;
    nt_fit_recipe recipe{nt_fit_defaults(model), !adhesive, {NT_CURVE_AUTO, 0.0, 0.0}, 0, {}, -all, all, 0.03};
    recipe.options.loss_scale = 0.0;
    return recipe;
}

nt_status nt_fit_recipe_check(const nt_fit_recipe *recipe, nt_problem *problem)
{
    nt_problem ignored;
    if (!problem)
        problem = &ignored;
    *problem = nt_problem{};
    if (!recipe)
        return NT_E_ARGUMENT;
    if (!(recipe->sensitivity_uncertainty >= 0.0 && recipe->sensitivity_uncertainty <= 1.0)) {
        *problem = nt_problem_of("sensitivity_uncertainty", "", recipe->sensitivity_uncertainty, 0.0, 1.0);
        return std::isnan(recipe->sensitivity_uncertainty) ? NT_E_NOT_FINITE : NT_E_RANGE;
    }
    if (!(recipe->lowest_force < recipe->highest_force)) {
        const double all = std::numeric_limits<double>::infinity();
        *problem = nt_problem_of("highest_force", "N", recipe->highest_force, recipe->lowest_force, all);
        return NT_E_RANGE;
    }
    nt_fit_options options = recipe->options;
    options.spring_constant = nanotouch::typical_spring_constant;
    if (options.loss_scale == 0.0)
        options.loss_scale = nanotouch::typical_loss_scale;
    return nt_fit_check(&options, problem);
}

nt_status nt_fit_batch(const nt_fit_recipe *recipe, const nt_fit_curves *curves, nt_fit_outcome *outcome)
{
    nt_status status = nt_fit_recipe_check(recipe, nullptr);
    if (status == NT_OK)
        status = nanotouch::check_curves(curves);
    if (status == NT_OK && curves->count > 0 && !outcome)
        status = NT_E_ARGUMENT;
    if (status == NT_OK)
        nanotouch::fit_all(*recipe, *curves, outcome);
    return status;
}
