// SPDX-License-Identifier: BSD-3-Clause
// Where the fit starts: w from the smallest force, E* from a coarse logarithmic grid, and for each E* the contact point
// at which the loaded points lie on the law. Deterministic; the least-squares fit then only has to descend.
#include "guess.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "nanotouch/material.h"

namespace nanotouch
{

namespace
{

constexpr int grid_per_decade = 1;
constexpr long sample_size = 24;

struct Sample {
    double position, force;
};

// Up to sample_size points at equal steps of rank in force, so that every level of load is represented.
std::vector<Sample> sample_of(const nt_fit_data &data)
{
    std::vector<Sample> all(static_cast<std::size_t>(data.count));
    for (long i = 0; i < data.count; i++)
        all[static_cast<std::size_t>(i)] = {data.position[i * data.position_stride], data.force[i * data.force_stride]};
    std::sort(all.begin(), all.end(), [](const Sample &a, const Sample &b) {
        return a.force < b.force || (a.force == b.force && a.position < b.position);
    });
    const long size = std::min(data.count, sample_size);
    std::vector<Sample> sample;
    for (long i = 0; i < size; i++)
        sample.push_back(all[static_cast<std::size_t>(i * (data.count - 1) / (size - 1))]);
    return sample;
}

double guess_work_of_adhesion(const nt_fit_options &options, const std::vector<Sample> &sample)
{
    const double span = sample.back().force - sample.front().force;
    const double measured = options.pull_off_sigma > 0.0 ? options.pull_off_force : -sample.front().force;
    const double pull_off = std::max(measured, 1e-3 * span);
    const double per_radius = options.model == NT_JKR ? 1.5 : options.model == NT_DMT ? 2.0 : 1.75; // pi w R
    const nt_fit_start &bounds = options.parameter[NT_FIT_WORK_OF_ADHESION];
    return std::clamp(pull_off / (per_radius * NT_PI * options.radius), bounds.minimum, bounds.maximum);
}

// delta0 at which the median point of the upper half of the load lies on the law; NaN if none can.
double guess_contact_point(const Model &model, const std::vector<Sample> &sample, double offset)
{
    const double half = 0.5 * (sample.front().force + sample.back().force);
    std::vector<double> candidates;
    for (const Sample &point : sample) {
        double travel;
        if (point.force >= half && model.travel(point.force - offset, &travel) == NT_OK)
            candidates.push_back(point.position - travel);
    }
    if (candidates.empty())
        return std::numeric_limits<double>::quiet_NaN();
    const auto middle = candidates.begin() + static_cast<std::ptrdiff_t>(candidates.size() / 2);
    std::nth_element(candidates.begin(), middle, candidates.end());
    return *middle;
}

// Sum of absolute deviations [N]; infinity where the law does not exist.
double misfit(const Model &model, const std::vector<Sample> &sample)
{
    double sum = 0.0;
    Track track;
    for (const Sample &sampled : sample) {
        Point point;
        if (model.at(sampled.position, &track, &point) != NT_OK)
            return std::numeric_limits<double>::infinity();
        sum += std::fabs(point.force - sampled.force);
    }
    return sum;
}

// The best of all tried so far.
struct Best {
    double misfit = std::numeric_limits<double>::infinity();
    Parameters value{};
};

// Everything but the contact point given in trial.
void consider(const nt_fit_options &options, const std::vector<Sample> &sample, Parameters trial, Best *best)
{
    Model model;
    if (std::isnan(trial[NT_FIT_CONTACT_POINT])) {
        trial[NT_FIT_CONTACT_POINT] = 0.0;
        if (model.prepare(options, trial) != NT_OK)
            return;
        trial[NT_FIT_CONTACT_POINT] = guess_contact_point(model, sample, trial[NT_FIT_FORCE_OFFSET]);
    }
    if (std::isnan(trial[NT_FIT_CONTACT_POINT]) || model.prepare(options, trial) != NT_OK)
        return;
    const double found = misfit(model, sample);
    if (found < best->misfit)
        *best = {found, trial};
}

// h0 at which Maugis' lambda is as given.
double range_at(const nt_fit_options &options, const Parameters &trial, double lambda)
{
    const nt_contact contact{options.radius, trial[NT_FIT_EFFECTIVE_MODULUS], trial[NT_FIT_WORK_OF_ADHESION], 1.0};
    const nt_fit_start &bounds = options.parameter[NT_FIT_COHESIVE_RANGE];
    return std::clamp(trial[NT_FIT_WORK_OF_ADHESION] * nt_maugis_lambda(&contact) / lambda, bounds.minimum,
                      bounds.maximum);
}

} // namespace

nt_status guess(const nt_fit_options &options, const nt_fit_data &data, double lambda, Parameters *value)
{
    const std::vector<Sample> sample = sample_of(data);
    Parameters trial;
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        trial[static_cast<std::size_t>(i)] = options.parameter[i].initial;
    if (std::isnan(trial[NT_FIT_WORK_OF_ADHESION]) && nt_fit_model_has(options.model, NT_FIT_WORK_OF_ADHESION))
        trial[NT_FIT_WORK_OF_ADHESION] = guess_work_of_adhesion(options, sample);
    if (std::isnan(trial[NT_FIT_FORCE_OFFSET]))
        trial[NT_FIT_FORCE_OFFSET] = 0.0;
    if (std::isnan(trial[NT_FIT_COMPLIANCE]))
        trial[NT_FIT_COMPLIANCE] = 1.0;

    const nt_fit_start &bounds = options.parameter[NT_FIT_EFFECTIVE_MODULUS];
    const double given = trial[NT_FIT_EFFECTIVE_MODULUS];
    const double lowest = std::isnan(given) ? bounds.minimum : given;
    const double highest = std::isnan(given) ? bounds.maximum : given;
    const int steps = static_cast<int>(std::ceil(grid_per_decade * std::log10(highest / lowest)));
    Best best;
    for (int i = 0; i <= steps; i++) {
        Parameters candidate = trial;
        candidate[NT_FIT_EFFECTIVE_MODULUS] = steps ? lowest * std::pow(highest / lowest, double(i) / steps) : lowest;
        if (std::isnan(trial[NT_FIT_COHESIVE_RANGE]) && options.model == NT_MAUGIS)
            candidate[NT_FIT_COHESIVE_RANGE] = range_at(options, candidate, lambda);
        consider(options, sample, candidate, &best);
    }
    if (!std::isfinite(best.misfit))
        return NT_E_NO_CONVERGENCE;
    *value = best.value;
    return NT_OK;
}

} // namespace nanotouch
