// SPDX-License-Identifier: BSD-3-Clause
// One recorded curve: read it, take the points that the law describes, fit. The procedure of nanotouch/fit in Python.
//
// Adhesive laws: from the deepest point to where the tip is torn off, which is one more datum; others: as far as the
// force is repulsive. Sensitivity, level and tilt of the baseline are data of their own uncertainty. Fitted with the
// noise of the free cantilever, its 1/f part included, then once more with the scatter that is left where that is
// more: so a law that does not describe the curve gets wide sigmas instead of a bent calibration. A last fit with any
// sensitivity shows whether the curve contradicts its calibration.
#include "curve.hpp"

#include <algorithm>
#include <cmath>

#include "points.hpp"

namespace nanotouch
{

namespace
{

constexpr double loss_scale = 3.0;     // times the noise
constexpr double stiff = 5.0;          // contact stiffness over spring constant
constexpr double wide = 0.5;           // a/R up to which a paraboloid on a half-space is believed
constexpr double misfitting = 3.0;     // residual over noise
constexpr double wrong = 0.05;         // residual over the span of the force
constexpr double as_given = 0.05;      // relative difference of scatter and noise that changes nothing
constexpr double torn_elsewhere = 2.5; // standard deviations of the place of the tear
constexpr double contradiction = 4.0;  // standard deviations of the sensitivity
constexpr int steep_places = 100;      // where the model is asked how close to the tear it is only continued
constexpr double nearest = 1e-13, farthest = 1e-7; // m, from the tear
constexpr double much_better = 0.7;                // ratio of residuals
constexpr double moved = 0.5;                      // of ln E*
constexpr double computed = 1e-9;                  // noise over force of a curve in which nothing is to be weighed
constexpr double least_loss_scale = 1e-18;         // N
constexpr double largest_spring_constant = 1e6;    // N/m

// Standard deviation of one point such that N independent ones would scatter as the mean of these N does [N].
double scatter_of(const Fitted &fitted, const std::vector<nt_fit_point> &points)
{
    std::vector<double> rest(points.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < rest.size(); i++) {
        rest[i] = fitted.force[i] - points[i].force;
        squares += rest[i] * rest[i];
    }
    const double mean_square = squares / double(rest.size());
    return std::sqrt(mean_square * nt_curve_residual_correlation(rest.data(), static_cast<long>(rest.size())));
}

// What a fit is made with and what it found.
struct Solution {
    nt_fit_options options;
    nt_fit_result result;
    std::vector<nt_fit_point> points;
    double scatter;
};

// A recorded curve on its way.
class Curve
{
  public:
    Curve(const nt_fit_recipe &recipe, double spring_constant, const nt_curve_branch &branch, nt_fit_outcome *outcome)
        : recipe_(recipe), spring_constant_(spring_constant), branch_(branch), outcome_(*outcome)
    {
    }
    nt_status fit();

  private:
    nt_status steep_part(double *width) const;
    nt_status leave_steep_part();
    void let_vary(nt_fit_options *options) const;
    void know(nt_fit_options *options, nt_fit_parameter parameter, double value, double sigma) const;
    nt_status run();
    nt_status run_with_scatter();
    nt_status contradicts_tear(bool *contradicts) const;
    nt_status solve();
    bool is_exact() const;
    double correlated_noise() const;
    double noise() const; // of the free cantilever, as far as the fitted points are worth independent ones [N]
    nt_status doubt_calibration();
    double rating() const;
    void judge();

    const nt_fit_recipe &recipe_;
    const double spring_constant_;
    const nt_curve_branch &branch_;
    nt_fit_outcome &outcome_;
    Fitted fitted_;
    Solution solution_{};
};

void Curve::know(nt_fit_options *options, nt_fit_parameter parameter, double value, double sigma) const
{
    nt_fit_start &start = options->parameter[parameter];
    if (sigma > 0.0 && !recipe_.held[parameter])
        start = {value, start.minimum, start.maximum, sigma, 0};
}

// What is known to some uncertainty becomes a datum.
void Curve::let_vary(nt_fit_options *options) const
{
    options->force_noise = noise();
    options->tilt_position = -branch_.baseline.z_mean;
    know(options, NT_FIT_SENSITIVITY, 1.0, recipe_.sensitivity_uncertainty);
    if (recipe_.fit_offset)
        options->parameter[NT_FIT_FORCE_OFFSET].fixed = 0;
    else
        know(options, NT_FIT_FORCE_OFFSET, 0.0, std::sqrt(branch_.baseline.force_variance));
    know(options, NT_FIT_FORCE_TILT, 0.0, std::sqrt(branch_.baseline.slope_variance));
    if (fitted_.torn) {
        options->tear_position = fitted_.tear_position;
        options->tear_sigma = fitted_.tear_sigma;
    }
}

nt_status Curve::run()
{
    const nt_fit_data data = fitted_.data();
    Solution &found = solution_;
    nt_status status = nt_fit_run(&found.options, &data, &found.result, &outcome_.problem);
    if (status != NT_OK)
        return status;
    found.points.resize(fitted_.position.size());
    status = nt_fit_model_n(&found.options, found.result.value, &data, found.points.data());
    if (status == NT_OK)
        found.scatter = std::max(scatter_of(fitted_, found.points), correlated_noise());
    return status;
}

// Whether the tip was torn off elsewhere than where such a contact lets go: by a shock, or it is another contact.
nt_status Curve::contradicts_tear(bool *contradicts) const
{
    *contradicts = false;
    const nt_fit_options &options = solution_.options;
    if (options.tear_sigma == 0.0)
        return NT_OK;
    double position;
    const nt_status status = nt_fit_tear_position(&options, solution_.result.value, &position);
    if (status == NT_OK)
        *contradicts = std::fabs(position - options.tear_position) > torn_elsewhere * options.tear_sigma;
    return status;
}

double Curve::correlated_noise() const
{
    return nt_curve_correlated_noise(branch_.noise, &branch_.baseline.noise,
                                     static_cast<long>(fitted_.position.size()));
}

double Curve::noise() const
{
    return std::max(branch_.noise, correlated_noise());
}

bool Curve::is_exact() const
{
    return solution_.scatter < computed * fitted_.largest();
}

// With the noise from point to point; then once more with the scatter that was found.
nt_status Curve::run_with_scatter()
{
    const nt_status status = run();
    double *used = &solution_.options.force_noise;
    const bool as_known = std::fabs(solution_.scatter / noise() - 1.0) <= as_given;
    if (status != NT_OK || is_exact() || *used == 0.0 || as_known)
        return status;
    *used = solution_.scatter;
    return run();
}

nt_status Curve::solve()
{
    nt_fit_options &options = solution_.options;
    options = recipe_.options;
    options.spring_constant = spring_constant_;
    if (!(options.loss_scale > 0.0))
        options.loss_scale = std::max(loss_scale * outcome_.reading.noise, least_loss_scale);
    if (noise() > computed * fitted_.largest())
        let_vary(&options);
    nt_status status = run_with_scatter();
    bool contradicts = false;
    if (status == NT_OK)
        status = contradicts_tear(&contradicts);
    if (!contradicts)
        return status;
    options.tear_sigma = 0.0;
    options.force_noise = noise();
    return run_with_scatter();
}

// How far before the tear the model is only a straight continuation [m]; 0 where the tear is not used.
nt_status Curve::steep_part(double *width) const
{
    *width = 0.0;
    if (solution_.options.tear_sigma == 0.0)
        return NT_OK;
    double tear;
    nt_status status = nt_fit_tear_position(&solution_.options, solution_.result.value, &tear);
    double distance[steep_places], position[steep_places];
    for (int i = 0; i < steep_places; i++) {
        distance[i] = nearest * std::pow(farthest / nearest, double(i) / (steep_places - 1));
        position[i] = tear + distance[i];
    }
    nt_fit_point points[steep_places];
    const nt_fit_data data{position, nullptr, steep_places, 1, 1};
    if (status == NT_OK)
        status = nt_fit_model_n(&solution_.options, solution_.result.value, &data, points);
    if (status != NT_OK)
        return status;
    const auto held = std::find_if(points, points + steep_places, [](const nt_fit_point &p) { return p.held != 0; });
    *width = distance[held == points + steep_places ? 0 : held - points];
    return NT_OK;
}

// What was measured there is left out, by its distance from the measured tear: the model must not choose its points.
nt_status Curve::leave_steep_part()
{
    double width;
    nt_status status = steep_part(&width);
    if (status != NT_OK || !fitted_.torn || !(width > fitted_.position.back() - fitted_.tear_position))
        return status;
    const auto far = [&](double position) { return position - fitted_.tear_position > width; };
    const auto kept = std::find_if(fitted_.position.rbegin(), fitted_.position.rend(), far);
    const auto count = static_cast<std::size_t>(fitted_.position.rend() - kept);
    fitted_.position.resize(count);
    fitted_.force.resize(count);
    status = check_count(fitted_, &outcome_.problem);
    return status == NT_OK ? solve() : status;
}

// A sensitivity far from the one given, or a much better fit with one that may be anything, puts E* in doubt.
nt_status Curve::doubt_calibration()
{
    nt_fit_result &fit = solution_.result;
    nt_fit_options options = solution_.options;
    nt_fit_start &sensitivity = options.parameter[NT_FIT_SENSITIVITY];
    if (options.parameter[NT_FIT_EFFECTIVE_MODULUS].fixed || sensitivity.fixed || is_exact() ||
        recipe_.sensitivity_uncertainty == 0.0)
        return NT_OK;
    const double asked = std::log(fit.value[NT_FIT_SENSITIVITY]);
    bool doubtful = std::fabs(asked) > contradiction * recipe_.sensitivity_uncertainty;
    if (doubtful)
        fit.identifiable[NT_FIT_WORK_OF_ADHESION] = 0;
    if (!doubtful && fit.residual_rms / branch_.noise >= 1.0 / much_better) {
        sensitivity.initial = 1.0;
        sensitivity.sigma = 0.0;
        const nt_fit_data data = fitted_.data();
        nt_fit_result any;
        const nt_status status = nt_fit_run(&options, &data, &any, &outcome_.problem);
        if (status != NT_OK)
            return status;
        const double change = std::log(any.value[NT_FIT_EFFECTIVE_MODULUS] / fit.value[NT_FIT_EFFECTIVE_MODULUS]);
        doubtful = any.residual_rms <= much_better * fit.residual_rms && std::fabs(change) >= moved;
    }
    if (doubtful) {
        fit.identifiable[NT_FIT_EFFECTIVE_MODULUS] = 0;
        outcome_.flags |= NT_FIT_CALIBRATION;
    }
    return NT_OK;
}

double Curve::rating() const
{
    std::vector<double> indentation(solution_.points.size()), fitted(solution_.points.size());
    for (std::size_t i = 0; i < fitted.size(); i++) {
        indentation[i] = solution_.points[i].indentation;
        fitted[i] = solution_.points[i].force;
    }
    const nt_fit_rated rated{indentation.data(), fitted_.force.data(), fitted.data(), static_cast<long>(fitted.size()),
                             branch_.noise};
    return nt_fit_rating(&rated);
}

void Curve::judge()
{
    nt_fit_result &fit = solution_.result;
    const nt_fit_options &options = solution_.options;
    const auto [lowest, highest] = std::minmax_element(fitted_.force.begin(), fitted_.force.end());
    const double misfit = fit.residual_rms / branch_.noise; // infinite without noise
    const bool modulus_known =
        options.parameter[NT_FIT_EFFECTIVE_MODULUS].fixed || fit.identifiable[NT_FIT_EFFECTIVE_MODULUS];
    const bool round = options.model != NT_FIT_CONE && options.model != NT_FIT_PYRAMID;
    unsigned flags = fit.converged ? 0U : unsigned(NT_FIT_NOT_CONVERGED);
    if (!modulus_known && fit.contact_stiffness > stiff * spring_constant_)
        flags |= NT_FIT_STIFF;
    if (round && fit.contact_radius > wide * options.radius)
        flags |= NT_FIT_WIDE;
    if (std::hypot(branch_.baseline.wave.cosine, branch_.baseline.wave.sine) > 0.0)
        flags |= NT_FIT_WAVES;
    const bool tear_unused =
        fitted_.torn && !options.parameter[NT_FIT_WORK_OF_ADHESION].fixed && options.tear_sigma == 0.0;
    if (tear_unused && !is_exact())
        flags |= NT_FIT_TORN_ELSEWHERE;
    outcome_.rating = rating();
    if (misfit > misfitting && std::isfinite(misfit)) {
        if (outcome_.rating < NT_FIT_GOOD)
            flags |= NT_FIT_MISFIT;
        if (tear_unused || fit.residual_rms > wrong * (*highest - *lowest)) {
            flags |= NT_FIT_WRONG_MODEL;
            std::fill_n(fit.identifiable, NT_FIT_PARAMETERS, 0);
        }
    }
    outcome_.flags |= flags;
}

nt_status Curve::fit()
{
    if (!(spring_constant_ > 0.0 && spring_constant_ < largest_spring_constant)) {
        outcome_.problem = {"spring_constant", "N/m", spring_constant_, 0.0, largest_spring_constant};
        return std::isnan(spring_constant_) ? NT_E_NOT_FINITE : NT_E_RANGE;
    }
    nt_status status = take_points(recipe_, branch_, &fitted_, &outcome_.problem);
    if (status == NT_OK)
        status = solve();
    if (status == NT_OK)
        status = leave_steep_part();
    if (status == NT_OK)
        status = doubt_calibration();
    if (status != NT_OK)
        return status;
    judge();
    outcome_.fit = solution_.result;
    return NT_OK;
}

// A force that never changes is none that a model could be fitted to.
nt_status check_span(const nt_curve_segment &segment, nt_problem *problem)
{
    const auto [lowest, highest] = std::minmax_element(segment.force, segment.force + segment.count);
    if (segment.count < NT_CURVE_FEWEST || *highest > *lowest || std::isnan(*lowest))
        return NT_OK;
    *problem = {"force (span)", "N", 0.0, 1e-18, 1.0};
    return NT_E_RANGE;
}

} // namespace

void fit_recorded(const nt_fit_recipe &recipe, const nt_curve &curve, nt_fit_outcome *outcome)
{
    *outcome = failed(NT_OK);
    const nt_curve_segment &fitted = recipe.approach ? curve.approach : curve.retract;
    std::vector<double> work(static_cast<std::size_t>(nt_curve_work_size(curve.approach.count + curve.retract.count)));
    nt_curve_reading read;
    if (curve.approach.count >= NT_CURVE_FEWEST || curve.retract.count >= NT_CURVE_FEWEST) {
        outcome->status = nt_curve_read(&curve, &recipe.baseline, work.data(), &read, &outcome->problem);
        for (const nt_curve_segment *segment : {&curve.approach, &curve.retract})
            if (outcome->status == NT_OK)
                outcome->status = check_span(*segment, &outcome->problem);
        if (outcome->status != NT_OK)
            return;
        summarise(read, &outcome->reading);
    }
    if (fitted.count < NT_CURVE_FEWEST) {
        const char *name = recipe.approach ? "approach.count" : "retract.count";
        outcome->problem = {name, "", double(fitted.count), NT_CURVE_FEWEST, 1e9};
        outcome->status = NT_E_RANGE;
        return;
    }
    outcome->status =
        Curve(recipe, curve.spring_constant, recipe.approach ? read.approach : read.retract, outcome).fit();
    if (outcome->status != NT_OK)
        outcome->flags = 0;
}

} // namespace nanotouch
