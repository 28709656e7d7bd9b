// SPDX-License-Identifier: BSD-3-Clause
// Dips, tear, work of adhesion and slope of one recorded branch.
#include "reading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace nanotouch
{

namespace
{

constexpr double end_part = 0.1; // of the travel, beyond which no baseline is left to judge a point by
constexpr std::size_t neighbours = 5;
constexpr double correlated = 1.2; // variance of a mean over that of independent points; of white noise 1 +- 0.1 .. 0.2
constexpr double before_tear = 0.5, after_tear = 0.25; // of the depth: a tear leads past both within two points
constexpr double largest_value = 1.0;                  // m or N: beyond, the unit is surely not SI
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

} // namespace

Branch::Branch(const nt_fit_segment &segment, bool waves)
{
    noise = point_noise(segment);
    baseline = fit_baseline(segment, noise, waves);
    const auto count = static_cast<std::size_t>(segment.count);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(segment.z[a], a) < std::pair(segment.z[b], b); });
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

double Branch::correlated_noise(std::size_t points) const
{
    const Noise &free = baseline.noise;
    if (free.flicker == 0.0 && free.white < correlated * noise * noise)
        return 0.0;
    return std::sqrt(std::max(noise * noise, free.white) + double(points) * free.flicker);
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
    double count = 0.0, z_mean = 0.0, mean = 0.0, spread = 0.0, product = 0.0, squares = 0.0;
    const auto each = [&](auto &&use) {
        for (std::size_t i = 0; i < force.size(); i++)
            if (force[i] > 0.5 * top)
                use(z[i] - z_mean, force[i] - mean);
    };
    each([&](double x, double y) {
        count += 1.0;
        spread += x;
        product += y;
    });
    if (top <= visible() || count < 4.0)
        return {not_a_number, not_a_number};
    z_mean = spread / count;
    mean = product / count;
    spread = product = 0.0;
    each([&](double x, double y) {
        spread += x * x;
        product += x * y;
    });
    const double slope = product / spread;
    each([&](double x, double y) { squares += (y - slope * x) * (y - slope * x); });
    return {-slope, std::sqrt(squares / (count - 2.0) / spread)};
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
