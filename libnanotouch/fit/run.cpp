// SPDX-License-Identifier: BSD-3-Clause
// The C interface: checks, one or several fits, the message. See fit.h for the model.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <new>

#include "data.hpp"
#include "guess.hpp"
#include "internal/fit.h"
#include "linear.hpp"
#include "nanotouch/material.h"
#include "solve.hpp"

namespace nanotouch
{

namespace
{

// Whether a fit that stopped tells nothing of its own law: it slid along a valley of chi^2.
bool is_lost(const nt_fit_options &options, const nt_fit_result &result)
{
    for (int p = 0; p < NT_FIT_OWN; p++)
        if (is_free(options, p) && result.identifiable[p])
            return false;
    return !result.converged;
}

void write_message(const nt_fit_options &options, nt_fit_result *result)
{
    char *text = result->message;
    int used = std::snprintf(text, NT_FIT_MESSAGE,
                             result->converged ? "converged after %d iterations"
                                               : "stopped after %d iterations without convergence",
                             result->iterations);
    if (is_lost(options, *result))
        used += std::snprintf(text + used, static_cast<std::size_t>(NT_FIT_MESSAGE - used),
                              ": other values fit as well (a stiff contact shows the cantilever)");
    if (!result->residuals_are_noise)
        used +=
            std::snprintf(text + used, static_cast<std::size_t>(NT_FIT_MESSAGE - used),
                          "; the residuals (%.3g N RMS) are not noise (%.3g N from point to point): this model does "
                          "not describe the points",
                          result->residual_rms, result->residual_noise);
    const char *separator = "; not determined by these data: ";
    for (int p = 0; p < NT_FIT_PARAMETERS && used < NT_FIT_MESSAGE; p++) {
        const auto parameter = static_cast<nt_fit_parameter>(p);
        if (!is_free(options, p) || result->identifiable[p])
            continue;
        used += std::snprintf(text + used, static_cast<std::size_t>(NT_FIT_MESSAGE - used), "%s%s", separator,
                              nt_fit_quantity_of(&options, parameter).name);
        separator = ", ";
    }
}

// Where the range h0 is to be found too, there can be several minima about as good, or a valley in which one slides:
// fits from all starts, and fits with the range held, are looked at. The best of the first is returned; what differs in
// others about as good is known to no better than the difference.
constexpr double transition_parameters[] = {0.05, 0.2, 0.6, 1.5, 4.0}; // Maugis' lambda to start from
constexpr double held_parameters[] = {0.05, 0.2, 0.6, 1.5, 4.0, 12.0, 40.0};
constexpr double as_good = 9.0; // difference in chi^2, three standard deviations

// A fit of means of neighbours costs little and leaves a step or two for all points.
constexpr long some = 50; // means at least
// Laws with adhesion have several minima. Where what is left shows that a fit may have ended in a wrong one, it is
// begun again from other moduli.
constexpr double other_moduli[] = {1e4, 1e7, 1e10, 1e13}; // [Pa]
constexpr double near_enough = 3.0;                       // residuals of the means over their noise

bool may_end_elsewhere(const nt_fit_options &options)
{
    return options.model != NT_FIT_CUSTOM && is_free(options, NT_FIT_WORK_OF_ADHESION) && options.force_noise > 0.0 &&
           std::isnan(options.parameter[NT_FIT_EFFECTIVE_MODULUS].initial) && !has_several_minima(options);
}

// The start whose means come closest to their law.
void try_moduli(const nt_fit_options &options, const nt_fit_data &data, double misfit, Parameters *start)
{
    nt_fit_options tried = options;
    nt_fit_start &modulus = tried.parameter[NT_FIT_EFFECTIVE_MODULUS];
    for (const double initial : other_moduli) {
        Parameters value;
        double left;
        modulus.initial = std::clamp(initial, modulus.minimum, modulus.maximum);
        if (misfit < near_enough || guess(tried, data, std::nan(""), &value) != NT_OK ||
            Fit(options, data, value).approach(&value, &left) != NT_OK || !(left < misfit))
            continue;
        misfit = left;
        *start = value;
    }
}

nt_status start_from(const nt_fit_options &options, const nt_fit_data &data, double lambda, Parameters *start)
{
    const nt_status status = guess(options, data, lambda, start);
    const long size = data.count / some;
    if (status != NT_OK || size < 2)
        return status;
    const Means means(data, size);
    const nt_fit_data some_data = means.data();
    nt_fit_options weighed = options;
    weighed.force_noise /= std::sqrt(double(size));
    double misfit = std::numeric_limits<double>::infinity();
    (void)Fit(weighed, some_data, *start).approach(start, &misfit);
    if (may_end_elsewhere(options))
        try_moduli(weighed, some_data, misfit, start);
    return NT_OK;
}

nt_status run_from(const nt_fit_options &options, const nt_fit_data &data, double lambda, Found *found)
{
    Parameters start;
    if (solve_linear(options, data, &start))
        return Fit(options, data, start).finish(found);
    const nt_status status = start_from(options, data, lambda, &start);
    return status == NT_OK ? Fit(options, data, start).run(found, true) : status;
}

// Fits with the range held at those of other transition parameters, lambda h0 being the same; of those that converge.
void hold_ranges(const nt_fit_options &options, const nt_fit_data &data, const nt_fit_result &best,
                 std::vector<Found> *all)
{
    nt_fit_options held = options;
    nt_fit_start &range = held.parameter[NT_FIT_COHESIVE_RANGE];
    for (const double lambda : held_parameters) {
        range.initial = best.value[NT_FIT_COHESIVE_RANGE] * best.transition_parameter / lambda;
        range.fixed = 1;
        Found found;
        if (range.initial >= range.minimum && range.initial <= range.maximum &&
            run_from(held, data, std::nan(""), &found) == NT_OK)
            all->push_back(found);
    }
}

// The fit about as good as the best whose values lie farthest from its own, in standard deviations; null without any.
const Found *farthest(const nt_fit_options &options, const std::vector<Found> &all, const Found &best)
{
    const Found *far = nullptr;
    double largest = 0.0;
    for (const Found &other : all) {
        double distance = 0.0;
        for (int p = 0; p < NT_FIT_PARAMETERS; p++) {
            const double sigma = best.result.sigma[p];
            if (is_free(options, p) && sigma > 0.0 && std::isfinite(sigma))
                distance += std::pow((other.result.value[p] - best.result.value[p]) / sigma, 2);
        }
        if (other.cost - best.cost <= as_good * best.variance && distance > largest) {
            largest = distance;
            far = &other;
        }
    }
    return far;
}

void widen(const nt_fit_options &options, const nt_fit_result &other, nt_fit_result *best)
{
    const auto off = [&](int p) { return is_free(options, p) ? other.value[p] - best->value[p] : 0.0; };
    for (int p = 0; p < NT_FIT_PARAMETERS; p++)
        for (int q = 0; q < NT_FIT_PARAMETERS; q++)
            best->covariance[p][q] += off(p) * off(q);
    for (int p = 0; p < NT_FIT_PARAMETERS; p++) {
        if (!is_free(options, p))
            continue;
        const double before = best->sigma[p];
        best->sigma[p] = std::sqrt(best->covariance[p][p]);
        if (best->sigma[p] > before)
            best->from_tear[p] *= std::pow(before / best->sigma[p], 2);
        if (is_logarithmic(options, p) && !(best->sigma[p] < NT_FIT_IDENTIFIABLE * best->value[p]))
            best->identifiable[p] = 0;
    }
}

nt_status run_from_all(const nt_fit_options &options, const nt_fit_data &data, Found *best)
{
    std::vector<Found> all;
    for (const double lambda : transition_parameters) {
        Found found;
        const nt_status status = run_from(options, data, lambda, &found);
        if (status == NT_OK)
            all.push_back(found);
        else if (status != NT_E_NO_CONVERGENCE)
            return status;
    }
    if (all.empty())
        return NT_E_NO_CONVERGENCE;
    *best = *std::min_element(all.begin(), all.end(), [](const Found &a, const Found &b) { return a.cost < b.cost; });
    hold_ranges(options, data, best->result, &all);
    const Found *far = farthest(options, all, *best);
    if (far)
        widen(options, far->result, &best->result);
    return NT_OK;
}

// Where the offset is free, the lowest force does not tell how deep a contact adheres, and a fit may slide to the bound
// of w.
constexpr double depths[] = {0.03, 0.1, 0.3, 1.0}; // pull-off to start from, over the span of the forces
constexpr double lowest_at = -0.8;                 // of the pull-off: where the lowest force may lie

bool may_slide_off(const nt_fit_options &options)
{
    const nt_fit_start &offset = options.parameter[NT_FIT_FORCE_OFFSET],
                       &work = options.parameter[NT_FIT_WORK_OF_ADHESION];
    return options.model != NT_FIT_CUSTOM && is_free(options, NT_FIT_WORK_OF_ADHESION) && std::isnan(work.initial) &&
           !offset.fixed && offset.sigma == 0.0;
}

bool slid_off(const nt_fit_options &options, const nt_fit_result &found)
{
    return may_slide_off(options) && (!found.converged || !found.identifiable[NT_FIT_WORK_OF_ADHESION]);
}

void try_depths(const nt_fit_options &options, const nt_fit_data &data, Found *best)
{
    double lowest = data.force[0], highest = data.force[0];
    for (long i = 0; i < data.count; i++) {
        lowest = std::min(lowest, data.force[i * data.force_stride]);
        highest = std::max(highest, data.force[i * data.force_stride]);
    }
    nt_fit_options tried = options;
    nt_fit_start &offset = tried.parameter[NT_FIT_FORCE_OFFSET], &work = tried.parameter[NT_FIT_WORK_OF_ADHESION];
    const double per_work = nt_fit_describe(options.model).pull_off * NT_PI * options.radius;
    for (const double depth : depths) {
        const double pull_off = depth * (highest - lowest);
        work.initial = std::clamp(pull_off / per_work, work.minimum, work.maximum);
        offset.initial = std::clamp(lowest - lowest_at * pull_off, offset.minimum, offset.maximum);
        Found found;
        if (run_from(tried, data, std::nan(""), &found) == NT_OK && found.cost < best->cost)
            *best = found;
    }
}

void write_result(const nt_fit_options &options, const Found &found, nt_fit_result *result)
{
    *result = found.result;
    result->chi_square = options.force_noise > 0.0 ? found.cost : std::nan("");
    write_message(options, result);
}

// Derivatives by the parameters themselves, in SI.
void write_points(const nt_fit_options &options, const double *value, const Points &points, nt_fit_point *written)
{
    Parameters per;
    for (int p = 0; p < NT_FIT_PARAMETERS; p++)
        per[static_cast<std::size_t>(p)] = is_logarithmic(options, p) ? 1.0 / value[p] : 1.0;
    for (std::size_t i = 0; i < points.size(); i++) {
        written[i] = {points.force[i], points.indentation[i], {}, points.held[i]};
        for (std::size_t p = 0; p < NT_FIT_PARAMETERS; p++)
            written[i].gradient[p] = points.gradient[p][i] * per[p];
    }
}

void write_points(const nt_fit_options &options, const Found &found, std::vector<nt_fit_point> *points)
{
    points->resize(found.points.size());
    write_points(options, found.result.value, found.points, points->data());
}

nt_status run(const nt_fit_options &options, const nt_fit_data &data, nt_fit_result *result,
              std::vector<nt_fit_point> *points)
{
    Found found;
    const nt_status status = has_several_minima(options) ? run_from_all(options, data, &found)
                                                         : run_from(options, data, std::nan(""), &found);
    if (status == NT_OK && !has_several_minima(options) && slid_off(options, found.result))
        try_depths(options, data, &found);
    if (status == NT_OK)
        write_result(options, found, result);
    if (status == NT_OK && points)
        write_points(options, found, points);
    return status;
}

} // namespace

bool has_several_minima(const nt_fit_options &options)
{
    return options.model != NT_FIT_CUSTOM && nt_fit_quantity_of(&options, NT_FIT_COHESIVE_RANGE).name &&
           std::isnan(options.parameter[NT_FIT_COHESIVE_RANGE].initial);
}

bool has_one_start(const nt_fit_options &options)
{
    return !has_several_minima(options) && !may_slide_off(options);
}

nt_status start_near(const nt_fit_options &options, const nt_fit_data &data, Parameters *value)
{
    return start_from(options, data, std::nan(""), value);
}

void write(const nt_fit_options &options, const Found &found, nt_fit_result *result, std::vector<nt_fit_point> *points)
{
    write_result(options, found, result);
    write_points(options, found, points);
}

nt_status check(const nt_fit_options &options, const nt_fit_data *data, nt_problem *problem)
{
    const nt_status status = nt_fit_check(&options, problem);
    return status == NT_OK ? check_data(options, data, problem) : status;
}

nt_status run_with_points(const nt_fit_options &options, const nt_fit_data &data, nt_fit_result *result,
                          std::vector<nt_fit_point> *points, nt_problem *problem)
{
    const nt_status status = check(options, &data, problem);
    return status == NT_OK ? run(options, data, result, points) : status;
}

} // namespace nanotouch

nt_status nt_fit_run(const nt_fit_options *options, const nt_fit_data *data, nt_fit_result *result, nt_problem *problem)
{
    nt_status status = nt_fit_check(options, problem);
    if (status == NT_OK)
        status = result ? nanotouch::check_data(*options, data, problem) : NT_E_ARGUMENT;
    if (status != NT_OK)
        return status;
    try {
        return nanotouch::run(*options, *data, result, nullptr);
    } catch (const std::bad_alloc &) {
        return NT_E_NO_MEMORY;
    } catch (...) {
        return NT_E_NO_CONVERGENCE;
    }
}

// A model ready for the values; NT_OK or what is wrong with them.
static nt_status prepare(const nt_fit_options *options, const double *value, std::unique_ptr<nanotouch::Model> *model)
{
    const nt_status status = nt_fit_check(options, nullptr);
    if (status != NT_OK)
        return status;
    nanotouch::Parameters values;
    std::copy_n(value, NT_FIT_PARAMETERS, values.begin());
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        if (nt_fit_quantity_of(options, static_cast<nt_fit_parameter>(i)).name && !std::isfinite(value[i]))
            return NT_E_NOT_FINITE;
    *model = nanotouch::Model::make(*options);
    return (*model)->prepare(values);
}

nt_status nt_fit_model_n(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS], const nt_fit_data *data,
                         nt_fit_point *point)
{
    if (!options || !value || !data || !data->position || !point)
        return NT_E_ARGUMENT;
    try {
        std::unique_ptr<nanotouch::Model> model;
        nanotouch::Points points;
        nt_status status = prepare(options, value, &model);
        if (status == NT_OK)
            status = model->points_at(*data, &points);
        if (status == NT_OK)
            nanotouch::write_points(*options, value, points, point);
        return status;
    } catch (const std::bad_alloc &) {
        return NT_E_NO_MEMORY;
    } catch (...) {
        return NT_E_NO_CONVERGENCE;
    }
}

nt_status nanotouch::tear_of(const nt_fit_options &options, const double *value, Tear *tear)
{
    std::unique_ptr<Model> model;
    const nt_status status = prepare(&options, value, &model);
    return status == NT_OK ? model->tear(tear) : status;
}

// One number of a tear.
static nt_status of_tear(const nt_fit_options *options, const double *value, double nanotouch::Tear::*number,
                         double *found)
{
    if (!options || !value || !found)
        return NT_E_ARGUMENT;
    try {
        nanotouch::Tear tear;
        const nt_status status = nanotouch::tear_of(*options, value, &tear);
        if (status == NT_OK)
            *found = tear.*number;
        return status;
    } catch (...) {
        return NT_E_NO_MEMORY;
    }
}

nt_status nt_fit_tear_position(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS], double *position)
{
    return of_tear(options, value, &nanotouch::Tear::position, position);
}

nt_status nt_fit_steep_width(const nt_fit_options *options, const double value[NT_FIT_PARAMETERS], double *width)
{
    return of_tear(options, value, &nanotouch::Tear::steep, width);
}
