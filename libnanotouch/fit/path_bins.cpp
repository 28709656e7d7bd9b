// SPDX-License-Identifier: BSD-3-Clause
// Means of neighbouring points. A mean lies off the curve by f'' h^2/24, so that bins are single points where the force
// bends (after a turn) and grow with the distance from it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/problem.h"
#include "path.hpp"

namespace nanotouch
{

namespace
{

constexpr long in_contact = 200; // bins of a segment
constexpr long out_of_it = 40;
constexpr long alike = 8;          // bins of one size after a turn, before the size doubles
constexpr double margin = 0.1;     // of the depth: before first touch, where bins are narrow already
constexpr long widest = 64;        // parts of a segment that positions are smoothed over, at least
constexpr double shortest = 1e-12; // s

nt_status wrong(nt_problem *problem, nt_status status, const nt_problem &found)
{
    if (problem)
        *problem = found;
    return status;
}

long end_of(const nt_fit_path &path, int segment)
{
    return segment + 1 < path.segments ? path.starts[segment + 1] : path.count;
}

// Line through the points from first to last by time: its value at `time`.
struct Line {
    double mean_time = 0.0, mean = 0.0, slope = 0.0;
    Line(const double *time, const double *value, long first, long last)
    {
        const double count = double(last - first);
        for (long i = first; i < last; i++) {
            mean_time += time[i] / count;
            mean += value[i] / count;
        }
        double square = 0.0, product = 0.0;
        for (long i = first; i < last; i++) {
            square += (time[i] - mean_time) * (time[i] - mean_time);
            product += (time[i] - mean_time) * (value[i] - mean);
        }
        slope = square > 0.0 ? product / square : 0.0;
    }
    double at(double time) const
    {
        return mean + slope * (time - mean_time);
    }
};

bool goes_one_way(const std::vector<double> &position, long first, long last)
{
    const double way = position[std::size_t(last - 1)] - position[std::size_t(first)];
    for (long i = first + 1; i < last; i++)
        if ((position[std::size_t(i)] - position[std::size_t(i - 1)]) * way < 0.0)
            return false;
    return true;
}

void add(PathBins *bins, const nt_fit_path &path, const std::vector<double> &position, long first, long last)
{
    const double count = double(last - first);
    double time = 0.0, place = 0.0, force = 0.0;
    bool fitted = true;
    for (long i = first; i < last; i++) {
        time += path.times[i] / count;
        place += position[std::size_t(i)] / count;
        force += path.forces[i] / count;
        fitted = fitted && (!path.fitted || path.fitted[i]);
    }
    bins->time.push_back(time);
    bins->position.push_back(place);
    bins->force.push_back(force);
    bins->count.push_back(fitted ? count : 0.0);
}

// Speeds of the base at the nodes, by their neighbours within a segment.
void add_speeds(PathBins *bins)
{
    const long nodes = long(bins->size());
    bins->speed.assign(bins->size(), 0.0);
    for (std::size_t s = 0; s < bins->first.size(); s++) {
        const long first = bins->first[s], last = s + 1 < bins->first.size() ? bins->first[s + 1] : nodes;
        for (long i = first; i < last && last - first > 1; i++) {
            const auto before = std::size_t(std::max(i - 1, first)), after = std::size_t(std::min(i + 1, last - 1));
            bins->speed[std::size_t(i)] =
                (bins->position[after] - bins->position[before]) / (bins->time[after] - bins->time[before]);
        }
    }
}

// Points from first to last in bins of `size`; from single ones on where a turn stands before them.
void add_run(PathBins *bins, const nt_fit_path &path, const std::vector<double> &position,
             const std::array<long, 4> &run) // first, last, size, whether a turn stands before
{
    const auto [first, last, size, after_turn] = run;
    long width = after_turn ? 1 : size, of_this = 0;
    for (long i = first; i < last;) {
        const long next = std::min(i + width, last);
        add(bins, path, position, i, next);
        i = next;
        if (width < size && ++of_this == alike) {
            width = std::min(2 * width, size);
            of_this = 0;
        }
    }
}

} // namespace

nt_status check_path(const nt_fit_path_options &options, const nt_fit_path &path, nt_problem *problem)
{
    const double inf = std::numeric_limits<double>::infinity();
    nt_status status = nt_viscoelastic_check(&options.contact, problem);
    if (status != NT_OK)
        return status;
    if (!(options.noise > 0.0 && options.noise < inf))
        return wrong(problem, NT_E_RANGE, nt_problem_of("noise", "N", options.noise, 1e-18, 1.0));
    if (path.count < 16 || path.segments < 1 || path.starts[0] != 0)
        return wrong(problem, NT_E_RANGE, nt_problem_of("count", "", double(path.count), 16.0, inf));
    for (int s = 0; s < path.segments; s++)
        if (path.starts[s] >= end_of(path, s))
            return wrong(problem, NT_E_RANGE, nt_problem_of("starts", "", double(path.starts[s]), 0.0, inf));
    for (long i = 0; i < path.count; i++) {
        if (!std::isfinite(path.times[i]))
            return wrong(problem, NT_E_NOT_FINITE, nt_problem_of("times", "s", path.times[i], -inf, inf));
        if (!std::isfinite(path.positions[i]))
            return wrong(problem, NT_E_NOT_FINITE, nt_problem_of("positions", "m", path.positions[i], -inf, inf));
        if (!std::isfinite(path.forces[i]))
            return wrong(problem, NT_E_NOT_FINITE, nt_problem_of("forces", "N", path.forces[i], -inf, inf));
        if (i > 0 && !(path.times[i] - path.times[i - 1] > shortest))
            return wrong(problem, NT_E_RANGE, nt_problem_of("times", "s", path.times[i], path.times[i - 1], inf));
    }
    return NT_OK;
}

std::vector<double> steady_positions(const nt_fit_path &path)
{
    std::vector<double> position(path.positions, path.positions + path.count);
    for (int s = 0; s < path.segments; s++) {
        const long first = path.starts[s], last = end_of(path, s);
        for (long half = 2; !goes_one_way(position, first, last) && half <= (last - first) / widest; half *= 2)
            for (long i = first; i < last; i++) {
                const long low = std::max(i - half, first), high = std::min(i + half + 1, last);
                position[std::size_t(i)] = Line(path.times, path.positions, low, high).at(path.times[i]);
            }
    }
    return position;
}

PathBins bin_path(const nt_fit_path &path, const std::vector<double> &position, const PathSpan &span)
{
    PathBins bins;
    const double near = span.first_touch - margin * span.depth;
    for (int s = 0; s < path.segments; s++) {
        const long first = path.starts[s], last = end_of(path, s);
        const auto free = [&](long i) { return position[std::size_t(i)] < near; };
        long begins = first, ends = last; // of what is near or in contact
        while (begins < last && free(begins))
            begins++;
        while (ends > begins && free(ends - 1))
            ends--;
        bins.first.push_back(long(bins.size()));
        const long outside = std::max<long>(1, (last - first - (ends - begins)) / out_of_it);
        const long size = std::max<long>(1, (ends - begins) / in_contact);
        const bool turned = s > 0 && begins == first;
        const long to = ends == last ? std::max(ends - 1, begins) : ends; // the last point is a node of its own
        add_run(&bins, path, position, {first, begins, outside, false});
        add_run(&bins, path, position, {begins, to, size, turned});
        add_run(&bins, path, position, {to, ends, 1, false});
        add_run(&bins, path, position, {ends, last, outside, false});
    }
    add_speeds(&bins);
    return bins;
}

PathBins all_points(const nt_fit_path &path, const std::vector<double> &position)
{
    PathBins bins;
    for (int s = 0; s < path.segments; s++) {
        bins.first.push_back(long(bins.size()));
        add_run(&bins, path, position, {path.starts[s], end_of(path, s), 1, false});
    }
    add_speeds(&bins);
    return bins;
}

} // namespace nanotouch
