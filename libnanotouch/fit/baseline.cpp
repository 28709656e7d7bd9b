// SPDX-License-Identifier: BSD-3-Clause
// A line by Tukey-weighted least squares through the far half of the travel, then through all points beyond the
// outermost one that this line cannot explain: hardly extrapolated to where it is needed. Light that the sample
// reflects interferes with that of the cantilever and adds a wave over z, one period for half a wavelength of height;
// it is fitted too where the residuals of the line prove it. The variances contain the flicker noise of the residuals.
#include "baseline.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Dense>

namespace nanotouch
{

namespace
{

constexpr double far_part = 0.5;     // of the travel taken for the first line
constexpr double margin = 0.05;      // of the travel, kept between an event and the baseline that judges it
constexpr double mad_sigma = 1.4826; // standard deviation over median absolute deviation, Gaussian
constexpr double tukey = 4.685;      // 95 % efficiency on Gaussian noise
constexpr int weightings = 10;       // at most
constexpr double settled = 1e-3;     // of the scatter, by which the line may still move
constexpr std::size_t blocks = 10;   // whose means show the correlation of the residuals
constexpr double smallest_spread = 1e-300;
constexpr double pi = 3.14159265358979323846;

constexpr double correlated = 5.0;                           // of white noise this ratio is 1 +- 0.45
constexpr double shortest_period = 160e-9, longest = 800e-9; // m: half the wavelengths of common lasers, inclined
constexpr double cycles = 1.5;                               // periods that have to be seen
constexpr double share = 0.3;                                // of the variance of the residuals that a wave has to make
constexpr std::size_t grid = 1024;       // points of the spectrum it is looked for in, zero-padded to 4 grid
constexpr double all_but_largest = 0.99; // of the steps, where the converter's step exceeds the noise
constexpr double evidence = 10.0;        // difference in BIC: very strong
constexpr double seen = 2.5, clearer = 1.5, much_clearer = 5.0; // so many periods, or much less scatter: not drift

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

// What the residuals say of the noise and of level and slope.
void judge(const Points &points, const Values &rest, Baseline *line)
{
    const double count = double(rest.size());
    line->correlation = correlation(rest, line->scatter);
    line->noise = split_noise(rest, line->scatter);
    const double worth = line->noise.white + count * line->noise.flicker;
    const double spread = std::inner_product(points.x.begin(), points.x.end(), points.x.begin(), 0.0);
    line->force_variance = worth / count;
    line->slope_variance = worth / std::max(spread, smallest_spread);
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
    judge(points, rest, &line);
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

Baseline straight(const nt_fit_segment &segment, double noise, Points *free)
{
    const auto [lowest, highest] = std::minmax_element(segment.z, segment.z + segment.count);
    const double travel = *highest - *lowest, far = *highest - far_part * travel;
    const double none = std::numeric_limits<double>::infinity();
    *free = outside(segment, far, none);
    const Baseline first = robust_line(*free);
    double largest = 0.0, start = -none;
    for (long i = 0; i < segment.count; i++)
        largest = std::max(largest, std::fabs(segment.force[i] - first.at(segment.z[i])));
    const double limit = std::max(event_level * noise, wave_level * first.scatter) + 0.1 * largest;
    for (long i = 0; i < segment.count; i++)
        if (std::fabs(segment.force[i] - first.at(segment.z[i])) > limit)
            start = std::max(start, segment.z[i]);
    if (!std::isfinite(start))
        return first;
    *free = outside(segment, far, start + margin * travel);
    return robust_line(*free);
}

// Level, slope, cosine and sine of one period, and the sum of squares they leave.
struct Terms {
    double level = 0.0, slope = 0.0;
    Wave wave;
    double squares = std::numeric_limits<double>::infinity();
    double at(double x) const
    {
        return level + slope * x + wave.at(x);
    }
};

Terms wave_terms(const Points &points, const Values &weight, double inverse_period)
{
    double scale = 0.0;
    for (const double x : points.x)
        scale = std::max(scale, std::fabs(x));
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < weight.size(); i++) {
        const double phase = 2.0 * pi * inverse_period * points.x[i];
        const Eigen::Vector4d row(1.0, points.x[i] / scale, std::cos(phase), std::sin(phase));
        normal += weight[i] * row * row.transpose();
        right += weight[i] * points.force[i] * row;
    }
    const Eigen::Vector4d found = normal.partialPivLu().solve(right);
    Terms terms;
    if (!found.allFinite())
        return terms;
    terms = {found[0], found[1] / scale, {1.0 / inverse_period, found[2], found[3]}, 0.0};
    for (std::size_t i = 0; i < weight.size(); i++) {
        const double rest = points.force[i] - terms.at(points.x[i]);
        terms.squares += weight[i] * rest * rest;
    }
    return terms;
}

// Residuals of a line at `grid` even steps of z, their mean taken off.
Values even_residuals(const Points &points, const Values &rest)
{
    std::vector<std::size_t> order(rest.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(points.x[a], a) < std::pair(points.x[b], b); });
    const double first = points.x[order.front()], travel = points.x[order.back()] - first;
    Values even(grid);
    for (std::size_t i = 0, next = 1; i < grid; i++) {
        const double x = first + travel * double(i) / double(grid - 1);
        while (next + 1 < order.size() && points.x[order[next]] < x)
            next++;
        const std::size_t low = order[next - 1], high = order[next];
        const double width = points.x[high] - points.x[low];
        const double part = width > 0.0 ? std::min((x - points.x[low]) / width, 1.0) : 1.0;
        even[i] = rest[low] + part * (rest[high] - rest[low]);
    }
    const double mean = std::accumulate(even.begin(), even.end(), 0.0) / double(grid);
    for (double &value : even)
        value -= mean;
    return even;
}

// 1/period of the strongest interference in the residuals [1/m]; 0 if it makes too little of them.
double likely_wave(const Points &points, const Values &rest)
{
    const auto [low, high] = std::minmax_element(points.x.begin(), points.x.end());
    const double travel = *high - *low;
    const double finest = 4.0 * travel / double(std::min(rest.size(), grid));
    const double most = 1.0 / std::max(shortest_period, finest), least = 1.0 / std::min(longest, travel / cycles);
    if (most <= least)
        return 0.0;
    const Values even = even_residuals(points, rest);
    const double total = std::inner_product(even.begin(), even.end(), even.begin(), 0.0);
    double strongest = 0.0, found = 0.0;
    for (std::size_t k = 1; k <= 2 * grid; k++) {
        const double inverse = double(k) / (4.0 * travel);
        if (inverse < least || inverse > most)
            continue;
        const std::complex<double> turn = std::polar(1.0, -2.0 * pi * double(k) / double(4 * grid));
        std::complex<double> sum = 0.0, factor = 1.0;
        for (const double value : even) {
            sum += value * factor;
            factor *= turn;
        }
        if (std::norm(sum) > strongest) {
            strongest = std::norm(sum);
            found = inverse;
        }
    }
    return 2.0 * strongest > share * double(grid) * total ? found : 0.0;
}

void weigh(const Values &rest, double scatter, Values *weight)
{
    for (std::size_t i = 0; i < rest.size(); i++) {
        const double u = rest[i] / (tukey * scatter), inside = std::max(0.0, 1.0 - u * u);
        (*weight)[i] = inside * inside;
    }
}

double refine(const Points &points, const Values &weight, double inverse, double step)
{
    for (int round = 0; round < 4; round++, step /= 3.0) {
        double best = inverse, least = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 5; i++) {
            const double tried = inverse + step * (0.5 * i - 1.0);
            const double squares = wave_terms(points, weight, tried).squares;
            if (squares < least) {
                least = squares;
                best = tried;
            }
        }
        inverse = best;
    }
    return inverse;
}

// Whether the wave is one, and not the wandering of a drifting force, which has no period: by the BIC of the line over
// that of the wave, with as many points as the residuals of the wave are worth; and by how much scatter it explains, of
// which drift leaves more, the more periods are seen.
bool is_evident(const Baseline &line, const Baseline &waved, const Points &points)
{
    if (waved.scatter == 0.0)
        return true;
    const auto [low, high] = std::minmax_element(points.x.begin(), points.x.end());
    const double gain = line.scatter / waved.scatter, independent = double(points.x.size()) / waved.correlation;
    const double bic = independent * 2.0 * std::log(gain) - 3.0 * std::log(std::max(independent, 1.0));
    const bool many = (*high - *low) / waved.wave.period >= seen;
    return gain >= (many ? clearer : much_clearer) && bic >= evidence;
}

// Line and wave together with Tukey's weights; the line if no wave stands out of its residuals.
Baseline with_wave(const Points &points, const Baseline &line)
{
    const std::size_t count = points.x.size();
    Values rest(count), weight(count), scratch;
    for (std::size_t i = 0; i < count; i++)
        rest[i] = points.force[i] - line.force - line.slope * points.x[i];
    const double start = likely_wave(points, rest);
    if (!(start > 0.0))
        return line;
    weigh(rest, line.scatter, &weight);
    const auto [low, high] = std::minmax_element(points.x.begin(), points.x.end());
    const double inverse = refine(points, weight, start, 0.25 / (*high - *low));
    Baseline waved = line;
    for (int round = 0; round < 3; round++) {
        const Terms terms = wave_terms(points, weight, inverse);
        for (std::size_t i = 0; i < count; i++)
            rest[i] = points.force[i] - terms.at(points.x[i]);
        waved.force = terms.level;
        waved.slope = terms.slope;
        waved.wave = terms.wave;
        waved.scatter = mad_sigma * median_size(rest, scratch);
        if (waved.scatter == 0.0)
            break;
        weigh(rest, waved.scatter, &weight);
    }
    judge(points, rest, &waved);
    return is_evident(line, waved, points) ? waved : line;
}

} // namespace

double Wave::at(double x) const
{
    const double phase = 2.0 * pi / period * x;
    return amplitude() > 0.0 ? cosine * std::cos(phase) + sine * std::sin(phase) : 0.0;
}

double Wave::amplitude() const
{
    return std::hypot(cosine, sine);
}

double Baseline::at(double z) const
{
    const double x = z - z_mean;
    return force + slope * x + wave.at(x);
}

double Baseline::sigma(double z) const
{
    return std::sqrt(force_variance + slope_variance * (z - z_mean) * (z - z_mean));
}

double point_noise(const nt_fit_segment &segment)
{
    Values steps(static_cast<std::size_t>(segment.count - 1));
    for (std::size_t i = 0; i < steps.size(); i++)
        steps[i] = std::fabs(segment.force[i + 1] - segment.force[i]);
    double size = mad_sigma * median(steps);
    if (size == 0.0) {
        std::sort(steps.begin(), steps.end());
        steps.resize(static_cast<std::size_t>(all_but_largest * double(steps.size())));
        const double squares = std::inner_product(steps.begin(), steps.end(), steps.begin(), 0.0);
        size = std::sqrt(squares / double(steps.size()));
    }
    return size / std::sqrt(2.0);
}

Baseline fit_baseline(const nt_fit_segment &segment, double noise, bool waves)
{
    Points free;
    const Baseline line = straight(segment, noise, &free);
    return waves && line.correlation >= correlated ? with_wave(free, line) : line;
}

} // namespace nanotouch
