// SPDX-License-Identifier: BSD-3-Clause
// Baseline, noise, dips, tear, work of adhesion and slope of one recorded branch.
//
// The baseline is a line by Tukey-weighted least squares through the far half of the travel, then through all points
// beyond the outermost one that this line cannot explain: hardly extrapolated to where it is needed. The variance of
// its two parameters contains the correlation of the residuals.
#include "reading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace nanotouch
{

namespace
{

constexpr double far_part = 0.5;     // of the travel taken for the first line
constexpr double margin = 0.05;      // of the travel, kept between an event and the baseline that judges it
constexpr double event_level = 5.0;  // standard deviations of the noise: one in 2e6 points
constexpr double wave_level = 3.0;   // standard deviations of the scatter about the line
constexpr double mad_sigma = 1.4826; // standard deviation over median absolute deviation, Gaussian
constexpr double tukey = 4.685;      // 95 % efficiency on Gaussian noise
constexpr int weightings = 10;       // at most
constexpr double settled = 1e-3;     // of the scatter, by which the line may still move
constexpr std::size_t blocks = 10;   // whose means show the correlation of the residuals
constexpr double wavy = 5.0;         // of white noise the correlation is 1 +- 0.45
constexpr double end_part = 0.1;     // of the travel, beyond which no baseline is left to judge a point by
constexpr std::size_t neighbours = 5;
constexpr double before_tear = 0.5, after_tear = 0.25; // of the depth: a tear leads past both within two points
constexpr double largest_value = 1.0;                  // m or N: beyond, the unit is surely not SI
constexpr double smallest_spread = 1e-300;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using Values = std::vector<double>;

double median(Values &values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2)
        return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double median_size(const Values &values, Values &scratch)
{
    scratch.resize(values.size());
    std::transform(values.begin(), values.end(), scratch.begin(), [](double value) { return std::fabs(value); });
    return median(scratch);
}

// From differences of neighbours, so that no shape of the curve enters.
double noise_of(const nt_fit_segment &segment)
{
    Values steps(static_cast<std::size_t>(segment.count - 1)), scratch;
    for (std::size_t i = 0; i < steps.size(); i++)
        steps[i] = segment.force[i + 1] - segment.force[i];
    return mad_sigma * median_size(steps, scratch) / std::sqrt(2.0);
}

// By how much the residuals' correlation raises the variance of their mean (1 for white noise).
double correlation(const Values &rest, double scatter)
{
    const std::size_t size = rest.size() / blocks;
    if (scatter == 0.0 || size < 2)
        return 1.0;
    double squares = 0.0;
    for (std::size_t block = 0; block < blocks; block++) {
        const auto start = rest.begin() + static_cast<std::ptrdiff_t>(block * size);
        const double mean = std::accumulate(start, start + static_cast<std::ptrdiff_t>(size), 0.0) / double(size);
        squares += mean * mean;
    }
    return std::max(1.0, squares / double(blocks) * double(size) / (scatter * scatter));
}

struct Points {
    Values x, force; // x from the mean of z
    double z_mean = 0.0;
    void add(double z, double force_there)
    {
        x.push_back(z);
        force.push_back(force_there);
    }
    void centre()
    {
        z_mean = std::accumulate(x.begin(), x.end(), 0.0) / double(x.size());
        for (double &z : x)
            z -= z_mean;
    }
};

// Weighted least squares; the line's force is that at x = 0.
void weighted_line(const Points &points, const Values &weight, Baseline *line)
{
    double total = 0.0, x = 0.0, force = 0.0, spread = 0.0, product = 0.0;
    for (std::size_t i = 0; i < weight.size(); i++) {
        total += weight[i];
        x += weight[i] * points.x[i];
        force += weight[i] * points.force[i];
    }
    x /= total;
    force /= total;
    for (std::size_t i = 0; i < weight.size(); i++) {
        spread += weight[i] * (points.x[i] - x) * (points.x[i] - x);
        product += weight[i] * (points.x[i] - x) * (points.force[i] - force);
    }
    line->slope = spread > 0.0 ? product / spread : 0.0;
    line->force = force - line->slope * x;
}

Baseline robust_line(const Points &points)
{
    const std::size_t count = points.x.size();
    const auto [lowest, highest] = std::minmax_element(points.x.begin(), points.x.end());
    const double travel = *highest - *lowest;
    Values weight(count, 1.0), rest(count), scratch;
    Baseline line{};
    line.z_mean = points.z_mean;
    for (int round = 0; round < weightings; round++) {
        const double before = line.slope;
        weighted_line(points, weight, &line);
        for (std::size_t i = 0; i < count; i++)
            rest[i] = points.force[i] - line.force - line.slope * points.x[i];
        line.scatter = mad_sigma * median_size(rest, scratch);
        if (line.scatter == 0.0 || std::fabs(line.slope - before) * travel < settled * line.scatter)
            break;
        for (std::size_t i = 0; i < count; i++) {
            const double u = rest[i] / (tukey * line.scatter), inside = std::max(0.0, 1.0 - u * u);
            weight[i] = inside * inside;
        }
    }
    const double related = correlation(rest, line.scatter), worth = line.scatter * line.scatter * related;
    const double spread = std::inner_product(points.x.begin(), points.x.end(), points.x.begin(), 0.0);
    line.force_variance = worth / double(count);
    line.slope_variance = worth / std::max(spread, smallest_spread);
    line.waves = related >= wavy;
    return line;
}

Points outside(const nt_fit_segment &segment, double far, double start)
{
    Points points;
    for (long i = 0; i < segment.count; i++)
        if (segment.z[i] >= far || segment.z[i] > start)
            points.add(segment.z[i], segment.force[i]);
    points.centre();
    return points;
}

Baseline baseline_of(const nt_fit_segment &segment, double noise)
{
    const auto [lowest, highest] = std::minmax_element(segment.z, segment.z + segment.count);
    const double travel = *highest - *lowest, far = *highest - far_part * travel;
    const double none = std::numeric_limits<double>::infinity();
    const Baseline first = robust_line(outside(segment, far, none));
    double largest = 0.0, start = -none;
    for (long i = 0; i < segment.count; i++)
        largest = std::max(largest, std::fabs(segment.force[i] - first.at(segment.z[i])));
    const double limit = std::max(event_level * noise, wave_level * first.scatter) + 0.1 * largest;
    for (long i = 0; i < segment.count; i++)
        if (std::fabs(segment.force[i] - first.at(segment.z[i])) > limit)
            start = std::max(start, segment.z[i]);
    return std::isfinite(start) ? robust_line(outside(segment, far, start + margin * travel)) : first;
}

} // namespace

double Baseline::sigma(double z) const
{
    return std::sqrt(force_variance + slope_variance * (z - z_mean) * (z - z_mean));
}

Branch::Branch(const nt_fit_segment &segment)
{
    noise = noise_of(segment);
    baseline = baseline_of(segment, noise);
    const auto count = static_cast<std::size_t>(segment.count);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return segment.z[a] < segment.z[b]; });
    z.reserve(count);
    force.reserve(count);
    for (const std::size_t i : order) {
        z.push_back(segment.z[i]);
        force.push_back(segment.force[i] - baseline.at(segment.z[i]));
    }
}

double Branch::visible() const
{
    return std::max(event_level * noise, wave_level * baseline.scatter);
}

double Branch::sigma(double at) const
{
    return std::hypot(noise, baseline.sigma(at));
}

std::size_t Branch::lowest() const
{
    const double end = z.back() - end_part * (z.back() - z.front());
    const auto inner = std::lower_bound(z.begin(), z.end(), end) - z.begin();
    return static_cast<std::size_t>(std::min_element(force.begin(), force.begin() + inner) - force.begin());
}

bool Branch::dips() const
{
    const std::size_t deepest = lowest(), end = std::min(deepest + neighbours, force.size());
    if (-force[deepest] > visible())
        return true;
    double smallest = 0.0;
    for (std::size_t i = 0; i + neighbours <= end; i++) {
        const auto start = force.begin() + static_cast<std::ptrdiff_t>(i);
        const double sum = std::accumulate(start, start + static_cast<std::ptrdiff_t>(neighbours), 0.0);
        smallest = std::min(smallest, sum / double(neighbours));
    }
    return -smallest > std::max(event_level / std::sqrt(double(neighbours)) * noise, wave_level * baseline.scatter);
}

bool Branch::tear(std::size_t *last) const
{
    if (!dips())
        return false;
    const std::size_t deepest = lowest(), count = force.size();
    const double depth = -force[deepest];
    std::size_t after = deepest;
    while (after < count && !(force[after] > -before_tear * depth))
        after++;
    if (after == count)
        return false;
    *last = after - 1;
    return std::max(force[after], force[std::min(after + 1, count - 1)]) > -after_tear * depth;
}

nt_fit_measured Branch::dip() const
{
    const std::size_t deepest = lowest();
    return {dips() ? -force[deepest] : 0.0, sigma(z[deepest])};
}

// Area below the baseline from where the force crosses it to its last visible dip.
nt_fit_measured Branch::adhesion_work() const
{
    if (!dips())
        return {0.0, not_a_number};
    const std::size_t deepest = lowest();
    const double limit = std::max(-visible(), force[deepest]);
    std::size_t first = deepest, last = force.size() - 1;
    while (first > 0 && force[first - 1] < 0.0)
        first--;
    while (!(force[last] <= limit))
        last--;
    last = std::min(last + 1, force.size() - 1);
    double area = 0.0, squares = 0.0;
    for (std::size_t i = first; i < last; i++) {
        const double step = z[i + 1] - z[i];
        area -= 0.5 * (force[i] + force[i + 1]) * step;
        squares += step * step;
    }
    return {area, std::hypot(baseline.sigma(z[deepest]) * (z[last] - z[first]), noise * std::sqrt(squares))};
}

nt_fit_measured Branch::contact_slope() const
{
    const double top = *std::max_element(force.begin(), force.end());
    Points part;
    for (std::size_t i = 0; i < force.size(); i++)
        if (force[i] > 0.5 * top)
            part.add(z[i], force[i]);
    if (top <= visible() || part.x.size() < 4)
        return {not_a_number, not_a_number};
    part.centre();
    Baseline line{};
    weighted_line(part, Values(part.x.size(), 1.0), &line);
    double spread = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < part.x.size(); i++) {
        const double rest = part.force[i] - line.force - line.slope * part.x[i];
        spread += part.x[i] * part.x[i];
        squares += rest * rest;
    }
    return {-line.slope, std::sqrt(squares / (double(part.x.size()) - 2.0) / spread)};
}

nt_status check_segment(const nt_fit_segment &segment, nt_problem *problem)
{
    const struct {
        const double *values;
        const char *name, *span, *unit;
    } columns[] = {{segment.z, "z", "z (travel)", "m"}, {segment.force, "force", "force (span)", "N"}};
    for (const auto &column : columns) {
        double lowest = column.values[0], highest = lowest;
        for (long i = 0; i < segment.count; i++) {
            const double value = column.values[i];
            if (!(std::fabs(value) <= largest_value)) {
                *problem = {column.name, column.unit, value, -largest_value, largest_value};
                return std::isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
            }
            lowest = std::min(lowest, value);
            highest = std::max(highest, value);
        }
        if (!(highest > lowest)) {
            *problem = {column.span, column.unit, 0.0, 1e-18, largest_value};
            return NT_E_RANGE;
        }
    }
    return NT_OK;
}

} // namespace nanotouch
