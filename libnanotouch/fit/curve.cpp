// SPDX-License-Identifier: BSD-3-Clause
// One recorded curve: read it, take the points that the law describes, fit (solving.cpp).
//
// Adhesive laws: from the deepest point to where the tip is torn off, which is one more datum; others: as far as the
// force is repulsive.
#include "curve.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/problem.h"
#include "internal/fit.h"
#include "points.hpp"
#include "power.hpp"
#include "solving.hpp"

namespace nanotouch
{

namespace
{

constexpr double loss_scale = 3.0;              // times the noise
constexpr double least_loss_scale = 1e-18;      // N
constexpr double largest_spring_constant = 1e6; // N/m

nt_fit_known known_of(const nt_fit_recipe &recipe, const nt_curve_branch &branch, const Fitted &fitted)
{
    nt_fit_known known{};
    known.noise = branch.noise;
    known.free = branch.baseline.noise;
    known.baseline_position = -branch.baseline.z_mean;
    known.level_sigma = std::sqrt(branch.baseline.force_variance);
    known.tilt_sigma = std::sqrt(branch.baseline.slope_variance);
    known.tear_position = fitted.tear_position;
    known.tear_sigma = fitted.tear_sigma;
    known.sensitivity_sigma = recipe.sensitivity_uncertainty;
    known.fit_offset = recipe.fit_offset;
    std::copy_n(recipe.held, NT_FIT_PARAMETERS, known.held);
    return known;
}

// What the free part and the other branch say against a law without adhesion.
void doubt_contact(const nt_fit_recipe &recipe, double spring_constant, const nt_curve_reading &read,
                   const nt_fit_solution &solution, nt_fit_outcome *outcome)
{
    const nt_curve_branch &branch = recipe.approach ? read.approach : read.retract;
    double further, left, kept_back;
    if (nt_fit_begins_in_contact(&branch, outcome->reading.noise, spring_constant, &further, &left)) {
        outcome->flags |= NT_FIT_BEGINS_IN_CONTACT;
        std::fill_n(outcome->fit.identifiable, NT_FIT_PARAMETERS, 0);
    }
    if (!has_power(solution.options))
        return;
    const nt_fit_branches branches = {
        &read.approach,   &read.retract, read.ruptures, spring_constant, -solution.fit.value[NT_FIT_CONTACT_POINT],
        solution.power[1]};
    const unsigned doubts = nt_fit_branch_doubts(&branches, &kept_back);
    if (doubts)
        outcome->fit.identifiable[NT_FIT_EFFECTIVE_MODULUS] = 0;
    outcome->flags |= doubts;
}

nt_status fit_branch(const nt_fit_recipe &recipe, double spring_constant, const nt_curve_reading &read,
                     nt_fit_outcome *outcome)
{
    const nt_curve_branch &branch = recipe.approach ? read.approach : read.retract;
    if (!(spring_constant > 0.0 && spring_constant < largest_spring_constant)) {
        outcome->problem = nt_problem_of("spring_constant", "N/m", spring_constant, 0.0, largest_spring_constant);
        return std::isnan(spring_constant) ? NT_E_NOT_FINITE : NT_E_RANGE;
    }
    Fitted fitted;
    nt_status status = take_points(recipe, branch, &fitted, &outcome->problem);
    if (status != NT_OK)
        return status;
    nt_fit_options options = recipe.options;
    options.spring_constant = spring_constant;
    if (!(options.loss_scale > 0.0))
        options.loss_scale = std::max(loss_scale * outcome->reading.noise, least_loss_scale);
    const nt_fit_known known = known_of(recipe, branch, fitted);
    Solving solving(options, known, fitted.data(), &outcome->problem);
    status = solving.run();
    if (status != NT_OK)
        return status;
    outcome->fit = solving.solution().fit;
    outcome->rating = solving.solution().rating;
    outcome->flags = solving.solution().flags;
    if (std::hypot(branch.baseline.wave.cosine, branch.baseline.wave.sine) > 0.0)
        outcome->flags |= NT_FIT_WAVES;
    if (!(nt_fit_describe(recipe.options.model).pull_off > 0.0))
        doubt_contact(recipe, spring_constant, read, solving.solution(), outcome);
    return NT_OK;
}

// A force that never changes is none that a model could be fitted to.
nt_status check_span(const nt_curve_segment &segment, nt_problem *problem)
{
    const auto changes = [&](double force) { return force != segment.force[0]; };
    if (segment.count < NT_CURVE_FEWEST || std::any_of(segment.force, segment.force + segment.count, changes))
        return NT_OK;
    *problem = nt_problem_of("force (span)", "N", 0.0, 1e-18, 1.0);
    return NT_E_RANGE;
}

} // namespace

void fit_recorded(const nt_fit_recipe &recipe, const nt_curve &curve, nt_fit_outcome *outcome)
{
    *outcome = failed(NT_OK);
    const nt_curve_segment &fitted = recipe.approach ? curve.approach : curve.retract;
    // not cleared: that alone would cost a twentieth of the whole
    const std::unique_ptr<double[]> work(
        new double[static_cast<std::size_t>(nt_curve_work_size(curve.approach.count + curve.retract.count))]);
    nt_curve_reading read;
    if (curve.approach.count >= NT_CURVE_FEWEST || curve.retract.count >= NT_CURVE_FEWEST) {
        outcome->status = nt_curve_read(&curve, &recipe.baseline, work.get(), &read, &outcome->problem);
        for (const nt_curve_segment *segment : {&curve.approach, &curve.retract})
            if (outcome->status == NT_OK)
                outcome->status = check_span(*segment, &outcome->problem);
        if (outcome->status != NT_OK)
            return;
        summarise(read, &outcome->reading);
    }
    if (fitted.count < NT_CURVE_FEWEST) {
        const char *name = recipe.approach ? "approach.count" : "retract.count";
        outcome->problem = nt_problem_of(name, "", double(fitted.count), NT_CURVE_FEWEST, 1e9);
        outcome->status = NT_E_RANGE;
        return;
    }
    outcome->status = fit_branch(recipe, curve.spring_constant, read, outcome);
    if (outcome->status != NT_OK)
        outcome->flags = 0;
}

} // namespace nanotouch
