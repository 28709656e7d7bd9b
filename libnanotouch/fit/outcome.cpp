// SPDX-License-Identifier: BSD-3-Clause
// What is told of a recorded curve: what it shows without a model, and what is left of one that could not be fitted.
#include <algorithm>
#include <limits>

#include "curve.hpp"

namespace nanotouch
{

namespace
{

constexpr double gaussian = 1.96; // half width of 95 %, in standard deviations
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

} // namespace

void summarise(const nt_curve_reading &read, nt_fit_reading *reading)
{
    const nt_curve_branch &approach = read.approach, &retract = read.retract;
    const nt_curve_branch &first = approach.count ? approach : retract;
    reading->baseline_tilt = first.baseline.slope;
    reading->contact_slope = first.contact_slope;
    reading->noise = approach.count && retract.count ? 0.5 * (approach.noise + retract.noise) : first.noise;
    if (approach.count)
        reading->snap_in_force = approach.dip;
    if (retract.count) {
        reading->pull_off_force = retract.dip;
        reading->adhesion_work = retract.adhesion_work;
        const double half = gaussian * read.pull_off_sigma;
        reading->pull_off_least = std::max(read.pull_off_least - half, 0.0);
        reading->pull_off_most = read.pull_off_most + half;
        reading->offset = {read.offset, read.offset_sigma};
        reading->ruptures = read.ruptures;
    }
}

nt_fit_outcome failed(nt_status status)
{
    nt_fit_outcome outcome{};
    const nt_curve_measured unknown{not_a_number, not_a_number};
    outcome.status = status;
    outcome.reading = {not_a_number, not_a_number, unknown,      unknown, unknown,
                       unknown,      not_a_number, not_a_number, unknown, 0};
    outcome.rating = not_a_number;
    nt_fit_result &fit = outcome.fit;
    std::fill_n(fit.value, NT_FIT_PARAMETERS, not_a_number);
    std::fill_n(fit.sigma, NT_FIT_PARAMETERS, not_a_number);
    std::fill_n(fit.from_tear, NT_FIT_PARAMETERS, not_a_number);
    std::fill_n(&fit.covariance[0][0], NT_FIT_PARAMETERS * NT_FIT_PARAMETERS, not_a_number);
    fit.residual_rms = fit.residual_noise = fit.misfit = fit.transition_parameter = fit.pull_off_force = not_a_number;
    fit.contact_radius = fit.contact_stiffness = fit.chi_square = not_a_number;
    return outcome;
}

} // namespace nanotouch
