// SPDX-License-Identifier: BSD-3-Clause
// Where the fit starts: w from the smallest force, the first other parameter that is not given (E*) from a coarse
// logarithmic grid, and for each of its values the contact point at which the loaded points lie on the law, or, of a
// law of the user's own, the best of some. Deterministic; the least-squares fit then only has to descend.
#include "guess.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "nanotouch/material.h"
#include "solve.hpp"

namespace nanotouch
{

namespace
{

constexpr int grid_per_decade = 1;
constexpr long sample_size = 24, sorted_size = 480;

struct Sample {
    double position, force; // force as measured, + repulsive
};

// Up to sample_size points at equal steps of rank in force, so that every level of load is represented.
std::vector<Sample> sample_of(const nt_fit_data &data)
{
    std::vector<Sample> all;
    const long step = std::max(1L, data.count / sorted_size);
    for (long i = 0; i < data.count; i += step)
        all.push_back({data.position[i * data.position_stride], data.force[i * data.force_stride]});
    std::sort(all.begin(), all.end(), [](const Sample &a, const Sample &b) {
        return a.force < b.force || (a.force == b.force && a.position < b.position);
    });
    const long count = static_cast<long>(all.size()), size = std::min(count, sample_size);
    std::vector<Sample> sample;
    for (long i = 0; i < size; i++)
        sample.push_back(all[static_cast<std::size_t>(i * (count - 1) / (size - 1))]);
    return sample;
}

double guess_work_of_adhesion(const nt_fit_options &options, const std::vector<Sample> &sample)
{
    const double span = sample.back().force - sample.front().force;
    const double pull_off = std::max(-sample.front().force, 1e-3 * span);
    const double per_radius = nt_fit_describe(options.model).pull_off; // pi w R
    const nt_fit_start &bounds = options.parameter[NT_FIT_WORK_OF_ADHESION];
    return std::clamp(pull_off / (per_radius * NT_PI * options.radius), bounds.minimum, bounds.maximum);
}

// delta0 at which the median point of the upper half of the load lies on the law; NaN if none can.
double median_contact_point(const Model &model, const std::vector<Sample> &sample, const Parameters &value)
{
    const double half = 0.5 * (sample.front().force + sample.back().force);
    std::vector<double> candidates;
    for (const Sample &point : sample) {
        double travel;
        const double force = (point.force - value[NT_FIT_FORCE_OFFSET]) * value[NT_FIT_SENSITIVITY];
        if (point.force >= half && model.travel(force, &travel) == NT_OK)
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
    const nt_fit_data data{&sample[0].position, nullptr, static_cast<long>(sample.size()), 2, 2};
    std::vector<Point> points;
    if (model.points_at(data, &points) != NT_OK)
        return std::numeric_limits<double>::infinity();
    double sum = 0.0;
    for (std::size_t i = 0; i < sample.size(); i++)
        sum += std::fabs(points[i].force - sample[i].force);
    return std::isnan(sum) ? std::numeric_limits<double>::infinity() : sum;
}

// The best of all tried so far.
struct Best {
    double misfit = std::numeric_limits<double>::infinity();
    Parameters value{};
};

void consider(Model *model, const std::vector<Sample> &sample, const Parameters &trial, Best *best)
{
    if (model->prepare(trial) != NT_OK)
        return;
    const double found = misfit(*model, sample);
    if (found < best->misfit)
        *best = {found, trial};
}

// Everything but the contact point given in trial.
void consider_places(const nt_fit_options &options, const std::vector<Sample> &sample, Parameters trial, Best *best)
{
    const std::unique_ptr<Model> model = Model::make(options);
    if (!std::isnan(trial[NT_FIT_CONTACT_POINT])) {
        consider(model.get(), sample, trial, best);
        return;
    }
    if (options.model == NT_FIT_CUSTOM) {
        for (const Sample &place : sample) {
            trial[NT_FIT_CONTACT_POINT] = place.position;
            consider(model.get(), sample, trial, best);
        }
        return;
    }
    trial[NT_FIT_CONTACT_POINT] = 0.0;
    if (model->prepare(trial) != NT_OK)
        return;
    trial[NT_FIT_CONTACT_POINT] = median_contact_point(*model, sample, trial);
    if (!std::isnan(trial[NT_FIT_CONTACT_POINT]))
        consider(model.get(), sample, trial, best);
}

// h0 at which Maugis' lambda is as given.
double range_at(const nt_fit_options &options, const Parameters &trial, double lambda)
{
    const nt_contact contact{options.radius, trial[NT_FIT_EFFECTIVE_MODULUS], trial[NT_FIT_WORK_OF_ADHESION], 1.0};
    const nt_fit_start &bounds = options.parameter[NT_FIT_COHESIVE_RANGE];
    return std::clamp(trial[NT_FIT_WORK_OF_ADHESION] * nt_maugis_lambda(&contact) / lambda, bounds.minimum,
                      bounds.maximum);
}

// What is given, or follows from the data at once; NaN: the contact point and what the grid is for.
Parameters start_of(const nt_fit_options &options, const std::vector<Sample> &sample)
{
    Parameters start;
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        start[static_cast<std::size_t>(i)] = options.parameter[i].initial;
    const bool adhesive = options.model != NT_FIT_CUSTOM && is_free(options, NT_FIT_WORK_OF_ADHESION);
    if (adhesive && std::isnan(start[NT_FIT_WORK_OF_ADHESION]))
        start[NT_FIT_WORK_OF_ADHESION] = guess_work_of_adhesion(options, sample);
    for (const int background : {NT_FIT_FORCE_OFFSET, NT_FIT_FORCE_TILT})
        if (std::isnan(start[static_cast<std::size_t>(background)]))
            start[static_cast<std::size_t>(background)] = 0.0;
    if (std::isnan(start[NT_FIT_SENSITIVITY]))
        start[NT_FIT_SENSITIVITY] = 1.0;
    return start;
}

int parameter_of_grid(const nt_fit_options &options, const Parameters &start)
{
    const int own = options.model == NT_FIT_CUSTOM ? options.law->count : 1;
    for (int i = 0; i < own; i++)
        if (std::isnan(start[static_cast<std::size_t>(i)]))
            return i;
    return -1;
}

} // namespace

nt_status guess(const nt_fit_options &options, const nt_fit_data &data, double lambda, Parameters *value)
{
    const std::vector<Sample> sample = sample_of(data);
    const Parameters start = start_of(options, sample);
    const int searched = parameter_of_grid(options, start);
    double lowest = 1.0, highest = 1.0;
    if (searched >= 0) {
        lowest = options.parameter[searched].minimum;
        highest = options.parameter[searched].maximum;
    }
    const int steps = static_cast<int>(std::ceil(grid_per_decade * std::log10(highest / lowest)));
    Best best;
    for (int i = 0; i <= steps; i++) {
        Parameters candidate = start;
        if (searched >= 0)
            candidate[static_cast<std::size_t>(searched)] =
                steps ? lowest * std::pow(highest / lowest, double(i) / steps) : lowest;
        if (has_several_minima(options))
            candidate[NT_FIT_COHESIVE_RANGE] = range_at(options, candidate, lambda);
        consider_places(options, sample, candidate, &best);
    }
    if (!std::isfinite(best.misfit))
        return NT_E_NO_CONVERGENCE;
    *value = best.value;
    return NT_OK;
}

} // namespace nanotouch
