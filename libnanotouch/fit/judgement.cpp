// SPDX-License-Identifier: BSD-3-Clause
// White noise has the same standard deviation from point to point as about its mean (von Neumann 1941); what a wrong
// model leaves over is smooth, and is larger about the mean: in all of the points, or where noise hides it there, in
// the medians of parts of them.
#include "judgement.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "internal/curves.h"
#include "nanotouch/curves.h"

namespace nanotouch
{

namespace
{

constexpr double at_most = 1.5, of_few = 4.0; // ratio of the two; both are estimates: + of_few/sqrt(points)
// Medians of so many parts, of so many points each at least, are within smooth + by_part/sqrt(points) of the noise,
// RMS; those of white noise are, but for 2 in 10 000.
constexpr long parts = 16, of_part = 4;
constexpr double smooth = 0.2, by_part = 2.5;
constexpr double exact = 1e-9;       // of the largest force: residuals of a computed curve
constexpr double mad_sigma = 1.4826; // standard deviation over median absolute deviation, Gaussian

// The residuals [N] in the order of position, in which neighbours have the same error of the model.
std::vector<double> in_order(const nt_fit_data &data, const Residuals &residuals)
{
    std::vector<long> order(static_cast<std::size_t>(data.count));
    std::iota(order.begin(), order.end(), 0L);
    const auto before = [&](long a, long b) {
        return data.position[a * data.position_stride] < data.position[b * data.position_stride];
    };
    if (!std::is_sorted(order.begin(), order.end(), before))
        std::sort(order.begin(), order.end(), before);
    std::vector<double> found;
    found.reserve(order.size());
    for (const long i : order)
        found.push_back(residuals.unit() * residuals.residual(i));
    return found;
}

double typical_size(std::vector<double> values)
{
    for (double &value : values)
        value = std::fabs(value);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return mad_sigma * *middle;
}

double median_of(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// Whether a wave lies under the noise: each part's median has an error of 1.25/sqrt(points), and what is left of a law
// that is nearly right goes to and fro.
bool has_smooth_part(const std::vector<double> &left, double noise)
{
    const std::ptrdiff_t size = static_cast<std::ptrdiff_t>(left.size()) / parts;
    if (size < of_part)
        return false;
    double squares = 0.0;
    for (std::ptrdiff_t i = 0; i < parts; i++) {
        const double median = median_of({left.begin() + i * size, left.begin() + (i + 1) * size});
        squares += median * median / parts;
    }
    return std::sqrt(squares) > noise * (smooth + by_part / std::sqrt(double(size)));
}

double largest_force(const nt_fit_data &data)
{
    double largest = 0.0;
    for (long i = 0; i < data.count; i++)
        largest = std::max(largest, std::fabs(data.force[i * data.force_stride]));
    return largest;
}

} // namespace

void judge_residuals(const nt_fit_options &options, const nt_fit_data &data, const Residuals &residuals,
                     nt_fit_result *result)
{
    const std::vector<double> left = in_order(data, residuals);
    std::vector<double> work(left.size());
    const double noise = nt_curve_point_noise(left.data(), data.count, work.data());
    const double size = options.loss == NT_LOSS_SQUARES ? result->residual_rms : typical_size(left);
    const double limit = at_most + of_few / std::sqrt(double(data.count));
    const bool stated = options.force_noise > 0.0;
    result->residual_noise = noise;
    result->residuals_are_noise =
        size <= exact * largest_force(data) ||
        (size <= limit * noise && (!stated || size <= limit * options.force_noise) && !has_smooth_part(left, noise));
}

} // namespace nanotouch
