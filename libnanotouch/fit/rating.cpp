// SPDX-License-Identifier: BSD-3-Clause
// How good a fit looks, from 0 to 10, as people have rated curves: by what is left over beside the load.
//
// The rule is a curve through the 1132 ratings of nanite's training set (zef18) over its feature con_idt_maxima_75perc:
// it separates ratings of 5 and more from the rest with an area under the curve of 0.94 (docs/evidence/fit.md).
#include <algorithm>
#include <cmath>
#include <limits>

#include "nanotouch/fit.h"

namespace
{

constexpr int parts = 3;          // of the indentation, each with its largest residual
constexpr double shallow = 0.25;  // of the deepest indentation: shallower points are left to the contact point
constexpr double middle = 0.17;   // 2 ln(1 + residual/load) that is rated 5
constexpr double steepness = 1.4; // of the rule
constexpr double unseen = 10.0;   // load over noise below which there is nothing to rate
constexpr double best = 10.0;

} // namespace

double nt_fit_rating(const nt_fit_rated *rated)
{
    const long count = rated->count;
    if (count <= 0)
        return 0.0;
    const double deepest = *std::max_element(rated->indentation, rated->indentation + count);
    const auto [lowest, highest] = std::minmax_element(rated->force, rated->force + count);
    const double load = std::max(std::fabs(*lowest), std::fabs(*highest));
    if (!(deepest > 0.0) || !(load > unseen * rated->noise))
        return 0.0;
    const auto deep = [&](long i) { return rated->indentation[i] >= shallow * deepest; };
    long kept = 0, seen = 0;
    for (long i = 0; i < count; i++)
        kept += deep(i);
    if (kept < parts)
        return 0.0;
    double largest[parts] = {};
    for (long i = 0; i < count; i++)
        if (deep(i)) {
            double *part = &largest[seen++ * parts / kept];
            *part = std::max(*part, std::fabs(rated->force[i] - rated->fitted[i]));
        }
    const double left = (largest[0] + largest[1] + largest[2]) / load;
    return best / (1.0 + std::pow(2.0 * std::log1p(left) / middle, steepness));
}
