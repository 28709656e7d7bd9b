// SPDX-License-Identifier: BSD-3-Clause
// Where the fit starts: w from the smallest force, the first other parameter that is not given (E*) from a coarse
// logarithmic grid, and for each of its values the contact point at which the loaded points lie on the law, or, of a
// law of the user's own, the best of some. Of the grid of a law of the library only what lies about the E* of two
// points is tried. Deterministic; the least-squares fit then only has to descend.
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
constexpr long averaged = 4; // points of the sample, at its end and in its middle
constexpr long weighed = 5;  // loaded points that vote for the contact point

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

// delta0 at which the median of some points of the upper half of the load lies on the law; NaN if none can.
double median_contact_point(const Model &model, const std::vector<Sample> &sample, const Parameters &value)
{
    const double half = 0.5 * (sample.front().force + sample.back().force);
    const auto loaded = std::find_if(sample.begin(), sample.end(), [&](const Sample &p) { return p.force >= half; });
    const std::ptrdiff_t step = std::max<std::ptrdiff_t>(1, (sample.end() - loaded) / weighed);
    std::vector<double> candidates;
    for (auto point = loaded; point < sample.end(); point += step) {
        double travel;
        const double force = (point->force - value[NT_FIT_FORCE_OFFSET]) * value[NT_FIT_SENSITIVITY];
        if (model.travel(force, &travel) == NT_OK)
            candidates.push_back(point->position - travel);
        if (sample.end() - point <= step)
            break;
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
    Points points;
    if (model.points_at(data, &points) != NT_OK)
        return std::numeric_limits<double>::infinity();
    double sum = 0.0;
    for (std::size_t i = 0; i < sample.size(); i++)
        sum += std::fabs(points.force[i] - sample[i].force);
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

// Values of the searched parameter at equal steps of its logarithm; a single one where nothing is searched.
class Grid
{
  public:
    Grid(const nt_fit_options &options, const Parameters &start, double lambda);
    int size() const
    {
        return steps_ + 1;
    }
    Parameters at(int i) const;
    int nearest(double value) const
    {
        return static_cast<int>(std::lround(
            std::clamp(steps_ * std::log(value / lowest_) / std::log(highest_ / lowest_), 0.0, double(steps_))));
    }
    bool is_of_modulus() const
    {
        return options_.model != NT_FIT_CUSTOM && searched_ == NT_FIT_EFFECTIVE_MODULUS;
    }

  private:
    const nt_fit_options &options_;
    const Parameters start_;
    const double lambda_;
    const int searched_;
    double lowest_ = 1.0, highest_ = 1.0;
    int steps_ = 0;
};

Grid::Grid(const nt_fit_options &options, const Parameters &start, double lambda)
    : options_(options), start_(start), lambda_(lambda), searched_(parameter_of_grid(options, start))
{
    if (searched_ < 0)
        return;
    lowest_ = options.parameter[searched_].minimum;
    highest_ = options.parameter[searched_].maximum;
    steps_ = static_cast<int>(std::ceil(grid_per_decade * std::log10(highest_ / lowest_)));
}

Parameters Grid::at(int i) const
{
    Parameters candidate = start_;
    if (searched_ >= 0)
        candidate[static_cast<std::size_t>(searched_)] =
            steps_ ? lowest_ * std::pow(highest_ / lowest_, double(i) / steps_) : lowest_;
    if (has_several_minima(options_))
        candidate[NT_FIT_COHESIVE_RANGE] = range_at(options_, candidate, lambda_);
    return candidate;
}

Sample mean_of(const std::vector<Sample> &sample, std::size_t first)
{
    Sample mean{0.0, 0.0};
    for (std::size_t i = first; i < first + averaged; i++) {
        mean.position += sample[i].position / averaged;
        mean.force += sample[i].force / averaged;
    }
    return mean;
}

// Place in the grid of the E* at which the contact deforms as it does between half of the points and the deepest; -1
// where they do not tell. At given forces, indentations go as E*^(-1/exponent).
int likely_place(const nt_fit_options &options, const std::vector<Sample> &sample, const Grid &grid)
{
    if (!grid.is_of_modulus() || sample.size() < 3 * averaged)
        return -1;
    const Sample deep = mean_of(sample, sample.size() - averaged), half = mean_of(sample, sample.size() / 2);
    Parameters trial = grid.at(grid.size() / 2);
    trial[NT_FIT_CONTACT_POINT] = 0.0;
    const std::unique_ptr<Model> model = Model::make(options);
    double travel[2];
    const auto force = [&](const Sample &p) {
        return (p.force - trial[NT_FIT_FORCE_OFFSET]) * trial[NT_FIT_SENSITIVITY];
    };
    if (model->prepare(trial) != NT_OK || model->travel(force(deep), &travel[0]) != NT_OK ||
        model->travel(force(half), &travel[1]) != NT_OK)
        return -1;
    const double bent = options.spring_constant > 0.0 ? (force(deep) - force(half)) / options.spring_constant : 0.0;
    const double deformed = deep.position - half.position - bent, tried = travel[0] - travel[1] - bent;
    const double modulus =
        trial[NT_FIT_EFFECTIVE_MODULUS] * std::pow(tried / deformed, nt_fit_describe(options.model).exponent);
    return deformed > 0.0 ? grid.nearest(modulus) : grid.size() - 1;
}

} // namespace

nt_status guess(const nt_fit_options &options, const nt_fit_data &data, double lambda, Parameters *value)
{
    const std::vector<Sample> sample = sample_of(data);
    const Grid grid(options, start_of(options, sample), lambda);
    const int likely = likely_place(options, sample, grid);
    Best best;
    const auto improves = [&](int i) {
        const double before = best.misfit;
        consider_places(options, sample, grid.at(i), &best);
        return best.misfit < before;
    };
    if (likely >= 0 && improves(likely)) {
        int i = likely + 1;
        while (i < grid.size() && improves(i))
            i++;
        for (i = likely - 1; i >= 0 && improves(i);)
            i--;
    } else {
        for (int i = 0; i < grid.size(); i++)
            (void)improves(i);
    }
    if (!std::isfinite(best.misfit))
        return NT_E_NO_CONVERGENCE;
    *value = best.value;
    return NT_OK;
}

} // namespace nanotouch
