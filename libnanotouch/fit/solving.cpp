// SPDX-License-Identifier: BSD-3-Clause
// Sensitivity, level and tilt of the baseline and the tear are data of their own uncertainty. Fitted with the noise of
// the free cantilever, its 1/f part included, then once more with the scatter that is left where that is more. A last
// fit with any sensitivity shows whether the curve contradicts its calibration.
#include "solving.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "core/problem.h"
#include "fit/models/row.h"
#include "halves.hpp"
#include "internal/curves.h"
#include "internal/fit.h"
#include "model.hpp"
#include "power.hpp"
#include "solve.hpp"

namespace nanotouch
{

namespace
{

constexpr double stiff = 5.0;          // contact stiffness over spring constant
constexpr double misfitting = 3.0;     // residual over noise
constexpr double wrong = 0.05;         // residual over the span of the force
constexpr double as_given = 0.05;      // relative difference of scatter and noise that changes nothing
constexpr double started = 1.5;        // scatter over noise below which a start is near
constexpr int weighings = 3;           // of the points at most
constexpr double torn_elsewhere = 2.5; // standard deviations of the place of the tear
constexpr double contradiction = 4.0;  // standard deviations of the sensitivity
constexpr double much_better = 0.7;    // ratio of residuals
constexpr double moved = 0.5;          // of ln E*
constexpr double gaussian = 1.96;      // half width of 95 %, in standard deviations
constexpr double precise = 0.1823;     // ln 1.2: what 95 % of E* may be off by from noise and baseline
constexpr double bent = 0.1;           // of the load
constexpr double computed = 1e-9;      // noise over force of points in which nothing is to be weighed
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

bool is_near(double scatter, double noise)
{
    return std::fabs(scatter / noise - 1.0) <= as_given;
}

double force_at(const nt_fit_data &data, long i)
{
    return data.force[i * data.force_stride];
}

} // namespace

Solving::Solving(const nt_fit_options &options, const nt_fit_known &known, const nt_fit_data &data, nt_problem *problem)
    : given_(options), known_(known), data_(data), problem_(problem)
{
    for (long i = 0; i < data.count; i++)
        largest_ = std::max(largest_, std::fabs(force_at(data, i)));
}

void Solving::know(nt_fit_parameter parameter, double value, double sigma)
{
    nt_fit_start &start = solution_.options.parameter[parameter];
    if (sigma > 0.0 && !known_.held[parameter])
        start = {value, start.minimum, start.maximum, sigma, 0};
}

// What is known to some uncertainty becomes a datum.
void Solving::let_vary()
{
    nt_fit_options &options = solution_.options;
    options.force_noise = noise();
    options.tilt_position = known_.baseline_position;
    know(NT_FIT_SENSITIVITY, 1.0, known_.sensitivity_sigma);
    if (known_.fit_offset)
        options.parameter[NT_FIT_FORCE_OFFSET].fixed = 0;
    else
        know(NT_FIT_FORCE_OFFSET, 0.0, known_.level_sigma);
    know(NT_FIT_FORCE_TILT, 0.0, known_.tilt_sigma);
    const bool adheres = options.model != NT_FIT_CUSTOM && nt_fit_quantity_of(&options, NT_FIT_WORK_OF_ADHESION).name;
    if (known_.tear_sigma > 0.0 && adheres) {
        options.tear_position = known_.tear_position;
        options.tear_sigma = known_.tear_sigma;
    }
}

nt_status Solving::fit()
{
    const nt_status status = run_with_points(solution_.options, data_, &solution_.fit, &points_, problem_);
    if (status == NT_OK)
        look();
    return status;
}

// What the fit leaves over.
void Solving::look()
{
    std::vector<double> rest(points_.size());
    for (std::size_t i = 0; i < rest.size(); i++)
        rest[i] = points_[i].force - force_at(data_, static_cast<long>(i));
    look_at(rest);
}

// Standard deviation of one point such that N independent ones would scatter as the mean of these N does [N].
void Solving::look_at(const std::vector<double> &rest)
{
    double squares = 0.0;
    for (const double one : rest)
        squares += one * one;
    const double correlation = nt_curve_residual_correlation(rest.data(), data_.count);
    scatter_ = std::max(std::sqrt(squares / double(data_.count) * correlation), correlated_noise());
}

// Whether the tip was torn off elsewhere than where such a contact lets go: by a shock, or it is another contact.
nt_status Solving::contradicts_tear(bool *contradicts)
{
    *contradicts = false;
    const nt_fit_options &options = solution_.options;
    if (options.tear_sigma == 0.0)
        return NT_OK;
    const nt_status status = tear_of(options, solution_.fit.value, &tear_);
    if (status == NT_OK)
        *contradicts = std::fabs(tear_.position - options.tear_position) > torn_elsewhere * options.tear_sigma;
    return status;
}

double Solving::correlated_noise() const
{
    return nt_curve_correlated_noise(known_.noise, &known_.free, data_.count);
}

double Solving::noise() const
{
    return std::max(known_.noise, correlated_noise());
}

bool Solving::is_exact() const
{
    return scatter_ < computed * largest_;
}

bool Solving::is_as_known() const
{
    return is_exact() || is_near(scatter_, noise());
}

// With the noise from point to point; then once more with the scatter that was found.
nt_status Solving::fit_with_scatter()
{
    double *used = &solution_.options.force_noise;
    if (*used > 0.0 && has_one_start(solution_.options))
        return fit_by_scatter(used);
    const nt_status status = fit();
    if (status != NT_OK || *used == 0.0 || is_as_known())
        return status;
    *used = scatter_;
    return fit();
}

double Solving::wanted_noise() const
{
    return is_as_known() ? noise() : scatter_;
}

// The same from a start that is near: what is left there tells the scatter, unless it is far above the noise.
nt_status Solving::fit_by_scatter(double *used)
{
    Parameters value;
    nt_status status = check(solution_.options, &data_, problem_);
    if (status == NT_OK)
        status = start_near(solution_.options, data_, &value);
    if (status != NT_OK)
        return status;
    Fit fit(solution_.options, data_, value);
    Found found;
    status = fit.begin();
    if (status == NT_OK)
        look_at(fit.rest());
    const bool is_there = scatter_ < started * noise();
    if (status == NT_OK && !is_there) {
        status = fit.run(&found, true);
        look_at(fit.rest());
    }
    for (int i = 0; status == NT_OK && (i == 0 || (i < weighings && is_there && !is_near(wanted_noise(), *used)));
         i++) {
        *used = wanted_noise();
        fit.weigh();
        status = fit.run(&found, false);
        look_at(fit.rest());
    }
    if (status == NT_OK)
        write(solution_.options, found, &solution_.fit, &points_);
    return status;
}

nt_status Solving::fit_without_false_tear()
{
    nt_fit_options &options = solution_.options = given_;
    if (noise() > computed * largest_)
        let_vary();
    nt_status status = fit_with_scatter();
    bool contradicts = false;
    if (status == NT_OK)
        status = contradicts_tear(&contradicts);
    if (!contradicts)
        return status;
    options.tear_sigma = 0.0;
    options.force_noise = noise();
    return fit_with_scatter();
}

// What was measured where the model is only continued is left out, by its distance from the measured tear: the model
// must not choose its points.
nt_status Solving::leave_steep_part()
{
    if (solution_.options.tear_sigma == 0.0)
        return NT_OK;
    const long before = data_.count;
    while (data_.count > 0 &&
           !(data_.position[(data_.count - 1) * data_.position_stride] - known_.tear_position > tear_.steep))
        data_.count--;
    if (data_.count == before)
        return NT_OK;
    if (data_.count >= NT_CURVE_FEWEST)
        return fit_without_false_tear();
    if (problem_)
        *problem_ = nt_problem_of("points left to fit", "", double(data_.count), NT_CURVE_FEWEST, 1e9);
    return NT_E_RANGE;
}

nt_status Solving::fit_any_sensitivity(bool *doubtful)
{
    nt_fit_options options = solution_.options;
    nt_fit_start &sensitivity = options.parameter[NT_FIT_SENSITIVITY];
    sensitivity.initial = 1.0;
    sensitivity.sigma = 0.0;
    nt_fit_result any;
    const nt_status status = nt_fit_run(&options, &data_, &any, problem_);
    if (status != NT_OK)
        return status;
    solution_.any_sensitivity = any.value[NT_FIT_SENSITIVITY];
    solution_.any_modulus = any.value[NT_FIT_EFFECTIVE_MODULUS];
    solution_.any_rms = any.residual_rms;
    const double change = std::log(solution_.any_modulus / solution_.fit.value[NT_FIT_EFFECTIVE_MODULUS]);
    *doubtful = any.residual_rms <= much_better * solution_.fit.residual_rms && std::fabs(change) >= moved;
    return NT_OK;
}

// A sensitivity far from the one given, or a much better fit with one that may be anything, puts E* in doubt.
nt_status Solving::doubt_calibration()
{
    nt_fit_result &fit = solution_.fit;
    const nt_fit_options &options = solution_.options;
    solution_.any_sensitivity = solution_.any_modulus = solution_.any_rms = not_a_number;
    if (!asks(options, NT_FIT_EFFECTIVE_MODULUS, "effective_modulus") || options.parameter[NT_FIT_SENSITIVITY].fixed ||
        is_exact() || known_.sensitivity_sigma == 0.0)
        return NT_OK;
    const double asked = std::log(fit.value[NT_FIT_SENSITIVITY]);
    bool doubtful = std::fabs(asked) > contradiction * known_.sensitivity_sigma;
    if (doubtful && asks(options, NT_FIT_WORK_OF_ADHESION, "work_of_adhesion"))
        fit.identifiable[NT_FIT_WORK_OF_ADHESION] = 0;
    nt_status status = NT_OK;
    if (!doubtful && fit.residual_rms / known_.noise >= 1.0 / much_better)
        status = fit_any_sensitivity(&doubtful);
    if (doubtful) {
        fit.identifiable[NT_FIT_EFFECTIVE_MODULUS] = 0;
        solution_.flags |= NT_FIT_CALIBRATION;
    }
    return status;
}

double Solving::rating() const
{
    std::vector<double> indentation(points_.size()), force(points_.size()), fitted(points_.size());
    for (std::size_t i = 0; i < fitted.size(); i++) {
        indentation[i] = points_[i].indentation;
        force[i] = force_at(data_, static_cast<long>(i));
        fitted[i] = points_[i].force;
    }
    const nt_fit_rated rated{indentation.data(), force.data(), fitted.data(), data_.count, known_.noise};
    return nt_fit_rating(&rated);
}

void Solving::judge()
{
    nt_fit_result &fit = solution_.fit;
    const nt_fit_options &options = solution_.options;
    double lowest = force_at(data_, 0), highest = lowest;
    for (long i = 1; i < data_.count; i++) {
        lowest = std::min(lowest, force_at(data_, i));
        highest = std::max(highest, force_at(data_, i));
    }
    const double misfit = fit.residual_rms / known_.noise; // infinite without noise
    const bool in_doubt =
        asks(options, NT_FIT_EFFECTIVE_MODULUS, "effective_modulus") && !fit.identifiable[NT_FIT_EFFECTIVE_MODULUS];
    const bool tear_unused = known_.tear_sigma > 0.0 && asks(options, NT_FIT_WORK_OF_ADHESION, "work_of_adhesion") &&
                             options.tear_sigma == 0.0;
    solution_.rating = rating();
    unsigned flags = fit.converged ? 0U : unsigned(NT_FIT_NOT_CONVERGED);
    if (in_doubt && fit.contact_stiffness > stiff * options.spring_constant)
        flags |= NT_FIT_STIFF;
    if (options.model != NT_FIT_CUSTOM)
        flags |= nt_fit_row_of(options.model)->doubts(&options, &fit);
    if (tear_unused && !is_exact())
        flags |= NT_FIT_TORN_ELSEWHERE;
    if (misfit > misfitting && std::isfinite(misfit)) {
        if (solution_.rating < NT_FIT_GOOD)
            flags |= NT_FIT_MISFIT;
        if (tear_unused || fit.residual_rms > wrong * (highest - lowest)) {
            flags |= NT_FIT_WRONG_MODEL;
            std::fill_n(fit.identifiable, NT_FIT_PARAMETERS, 0);
        }
    }
    solution_.flags |= flags;
    solution_.half_modulus[0] = solution_.half_modulus[1] = solution_.power[0] = solution_.power[1] = not_a_number;
    if (asks(options, NT_FIT_EFFECTIVE_MODULUS, "effective_modulus") && !is_exact())
        doubt_modulus();
    doubt_adhesion();
}

// Of the law's shape, and of what noise leaves: each puts E* in doubt.
void Solving::doubt_modulus()
{
    nt_fit_result &fit = solution_.fit;
    const nt_fit_options &options = solution_.options;
    const double point_noise = std::max(noise(), fit.residual_noise);
    if (asks(options, NT_FIT_CONTACT_POINT, "contact_point"))
        compare_halves(points_, data_, point_noise, &solution_);
    const bool known = fit.identifiable[NT_FIT_EFFECTIVE_MODULUS],
               imprecise = known && (!(gaussian * noise_of_modulus() < precise) || is_bent());
    unsigned doubts = imprecise ? unsigned(NT_FIT_IMPRECISE) : 0U;
    if (has_power(options)) {
        find_power(points_, data_, point_noise, &solution_);
        const bool is_good = known && !imprecise && !(solution_.flags & NT_FIT_MISFIT);
        if (asks_other_power(solution_) || (is_good && is_rivalled(solution_, data_)))
            doubts |= NT_FIT_OTHER_POWER;
    }
    if (doubts)
        fit.identifiable[NT_FIT_EFFECTIVE_MODULUS] = 0;
    solution_.flags |= doubts;
}

// Whether what bends the free part, going on, may make a tenth of the load at the deepest point: no tilt takes that up.
bool Solving::is_bent() const
{
    return known_.tilt_sigma * std::fabs(data_.position[0] - known_.baseline_position) > bent * largest_;
}

// What noise and baseline leave of E*, relative: with the sensitivity known exactly.
double Solving::noise_of_modulus() const
{
    const double *of_modulus = solution_.fit.covariance[NT_FIT_EFFECTIVE_MODULUS],
                 both = of_modulus[NT_FIT_SENSITIVITY];
    const double own = solution_.fit.covariance[NT_FIT_SENSITIVITY][NT_FIT_SENSITIVITY];
    const double variance =
        of_modulus[NT_FIT_EFFECTIVE_MODULUS] - (own > 0.0 && std::isfinite(own) ? both * both / own : 0.0);
    return std::sqrt(std::max(variance, 0.0)) / solution_.fit.value[NT_FIT_EFFECTIVE_MODULUS];
}

nt_status Solving::run()
{
    nt_status status = fit_without_false_tear();
    if (status == NT_OK)
        status = leave_steep_part();
    if (status == NT_OK)
        status = doubt_calibration();
    if (status != NT_OK)
        return status;
    solution_.count = data_.count;
    solution_.exact = is_exact();
    judge();
    return NT_OK;
}

} // namespace nanotouch

nt_status nt_fit_solve(const nt_fit_options *options, const nt_fit_known *known, const nt_fit_data *data,
                       nt_fit_solution *solution, nt_problem *problem)
{
    if (!options || !known || !data || !data->position || !data->force || data->count < 1 || !solution)
        return NT_E_ARGUMENT;
    try {
        nanotouch::Solving solving(*options, *known, *data, problem);
        const nt_status status = solving.run();
        if (status == NT_OK)
            *solution = solving.solution();
        return status;
    } catch (const std::bad_alloc &) {
        return NT_E_NO_MEMORY;
    } catch (...) {
        return NT_E_NO_CONVERGENCE;
    }
}
