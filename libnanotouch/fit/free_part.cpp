// SPDX-License-Identifier: BSD-3-Clause
// Whether a branch has a free part at all: the baseline of a ramp that begins in contact lies in contact, and bends.
//
// Hertz' power of 3/2, from further out and over a level line, tells contact from a straight line well enough for all
// laws without adhesion.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "internal/fit.h"
#include "nanotouch/fit.h"

namespace
{

constexpr double least_scatter = 4.0; // times the noise from point to point: below, nothing hides in the free part
constexpr double better = 0.5;        // of the scatter about the baseline: what that contact must leave less than
constexpr double outer_part = 0.5;    // of the free part, in which that contact must begin
constexpr double level_part = 0.02;   // of the travel, the outermost: the level of the force
constexpr long places = 40, most_points = 600; // contact points that are tried, on so many points

constexpr std::size_t room = 2 * most_points; // of a branch at most one point less is kept

struct Points {
    std::size_t count = 0;
    std::array<double, room> depth, force, bend; // -z [m], with the baseline [N], deflection above the level [m]
};

// Of the outermost part of the travel, median [N].
double level_of(const Points &points)
{
    const auto [least, most] = std::minmax_element(points.depth.begin(), points.depth.begin() + points.count);
    std::array<double, room> level;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.count; i++)
        if (points.depth[i] <= *least + level_part * (*most - *least))
            level[count++] = points.force[i];
    std::nth_element(level.begin(), level.begin() + count / 2, level.begin() + count);
    return level[count / 2];
}

void thin(const nt_curve_branch &branch, double spring_constant, Points *points)
{
    const nt_curve_baseline &baseline = branch.baseline;
    for (long i = 0; i < branch.count; i += std::max(1L, branch.count / most_points)) {
        const double line = baseline.force + baseline.slope * (branch.z[i] - baseline.z_mean); // is off the force
        points->depth[points->count] = -branch.z[i];
        points->force[points->count++] = branch.force[i] + line;
    }
    const double level = level_of(*points);
    for (std::size_t i = 0; i < points->count; i++)
        points->bend[i] = (points->force[i] - level) / spring_constant;
}

// RMS of what a level and a multiple of the law from `start` leave [N]; its regression, by sums about the means.
double left_by(const Points &points, double start)
{
    const auto count = static_cast<double>(points.count);
    std::array<double, room> law;
    double law_mean = 0.0, force_mean = 0.0, covariance = 0.0, law_square = 0.0, force_square = 0.0;
    for (std::size_t i = 0; i < points.count; i++) {
        const double indentation = std::max(points.depth[i] - start - points.bend[i], 0.0);
        law[i] = indentation * std::sqrt(indentation);
        law_mean += law[i] / count;
        force_mean += points.force[i] / count;
    }
    for (std::size_t i = 0; i < points.count; i++) {
        const double along = law[i] - law_mean, force = points.force[i] - force_mean;
        covariance += along * force;
        law_square += along * along;
        force_square += force * force;
    }
    const double explained = law_square > 0.0 ? covariance * covariance / law_square : 0.0;
    return std::sqrt(std::max(force_square - explained, 0.0) / count);
}

// Standard deviation of the points of the baseline [N], and how many they are.
double scatter_of(const nt_curve_branch &branch, long *count)
{
    double mean = 0.0, square = 0.0;
    *count = 0;
    for (long i = 0; i < branch.count; i++)
        if (branch.z[i] >= branch.baseline.nearest) { // by Welford's sums
            const double before = branch.force[i] - mean;
            mean += before / double(++*count);
            square += before * (branch.force[i] - mean);
        }
    return *count > 0 ? std::sqrt(square / double(*count)) : 0.0;
}

} // namespace

int nt_fit_begins_in_contact(const nt_curve_branch *branch, double noise, double spring_constant, double *further,
                             double *left)
{
    *further = *left = 0.0;
    if (!(branch->baseline.scatter > least_scatter * noise && noise > 0.0))
        return 0;
    long count = 0;
    const double scatter = scatter_of(*branch, &count);
    if (count <= places)
        return 0;
    Points points;
    thin(*branch, spring_constant, &points);
    const double outer = *std::min_element(points.depth.begin(), points.depth.begin() + points.count);
    const double inner = -branch->baseline.nearest;
    double begin = outer, least = left_by(points, outer);
    for (long i = 1; i < places; i++) {
        const double start = outer + (inner - outer) * double(i) / double(places - 1);
        const double rms = left_by(points, start);
        if (rms < least) {
            least = rms;
            begin = start;
        }
    }
    if (!(least <= better * scatter && begin <= outer + outer_part * (inner - outer)))
        return 0;
    *further = inner - begin;
    *left = least;
    return 1;
}
