// SPDX-License-Identifier: BSD-3-Clause
// A tip that slips by 3 nm, or a scanner that bows by as much, leaves residuals below the noise of a point and a wrong
// modulus. Chow's test (1960) sees it: what lies above and below a depth, each fitted alone from the common solution by
// one step of Gauss and Newton, must ask for the same E* and contact point. What they differ by is the size of the
// error.
#include "halves.hpp"
#include "internal/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace nanotouch
{

namespace
{

constexpr int layers = 8;        // equal parts of the deepest indentation; the contact is cut between two of them
constexpr double surely = 22.0;  // chi^2 of two degrees of freedom, of the worst cut: 1e-4
constexpr long fewest = 8;       // points of a part
constexpr double regular = 1e-6; // 1 - correlation^2 of E* and contact point

using Pair = std::array<double, 2>; // of ln E* and contact point [m]

struct Part {
    double aa = 0.0, ab = 0.0, bb = 0.0; // J^T J / noise^2
    Pair right{};                        // J^T r / noise^2
    long count = 0;
};

struct Step {
    Pair change{};
    double aa = 0.0, ab = 0.0, bb = 0.0; // covariance
};

void add(const Pair &slope, double residual, Part *part)
{
    part->aa += slope[0] * slope[0];
    part->ab += slope[0] * slope[1];
    part->bb += slope[1] * slope[1];
    part->right[0] += slope[0] * residual;
    part->right[1] += slope[1] * residual;
    part->count++;
}

// False where the part does not tell both.
bool invert(double aa, double ab, double bb, Step *step)
{
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > regular * aa * bb))
        return false;
    step->aa = bb / determinant;
    step->ab = -ab / determinant;
    step->bb = aa / determinant;
    return true;
}

bool solve(const Part &part, Step *step)
{
    if (part.count < fewest || !invert(part.aa, part.ab, part.bb, step))
        return false;
    step->change = {step->aa * part.right[0] + step->ab * part.right[1],
                    step->ab * part.right[0] + step->bb * part.right[1]};
    return true;
}

// How unlikely it is that two parts of one contact differ so.
double chi_square(const Pair &difference, const Step &one, const Step &other)
{
    Step inverse;
    if (!invert(one.aa + other.aa, one.ab + other.ab, one.bb + other.bb, &inverse))
        return 0.0;
    return inverse.aa * difference[0] * difference[0] + 2.0 * inverse.ab * difference[0] * difference[1] +
           inverse.bb * difference[1] * difference[1];
}

Part sum(const Part &one, const Part &other)
{
    return {one.aa + other.aa,
            one.ab + other.ab,
            one.bb + other.bb,
            {one.right[0] + other.right[0], one.right[1] + other.right[1]},
            one.count + other.count};
}

double deepest(const std::vector<nt_fit_point> &points)
{
    double depth = 0.0;
    for (const nt_fit_point &point : points)
        depth = std::max(depth, point.indentation);
    return depth;
}

struct Cut {
    double chi_square = 0.0; // of the worst
    Step shallow, deep;      // on either side of the one nearest to half the depth
};

Cut cut_between(const std::array<Part, layers> &layer, const Part &whole)
{
    Cut found;
    int from_middle = layers;
    Part shallow;
    for (int i = 1; i < layers; i++) {
        shallow = sum(shallow, layer[static_cast<std::size_t>(i - 1)]);
        const Part deep{whole.aa - shallow.aa,
                        whole.ab - shallow.ab,
                        whole.bb - shallow.bb,
                        {whole.right[0] - shallow.right[0], whole.right[1] - shallow.right[1]},
                        whole.count - shallow.count};
        Step one, other;
        if (!solve(shallow, &one) || !solve(deep, &other))
            continue;
        const Pair difference{other.change[0] - one.change[0], other.change[1] - one.change[1]};
        found.chi_square = std::max(found.chi_square, chi_square(difference, one, other));
        if (std::abs(i - layers / 2) < from_middle) {
            from_middle = std::abs(i - layers / 2);
            found.shallow = one;
            found.deep = other;
        }
    }
    return found;
}

void widen(nt_fit_result *fit, double by_modulus, double by_contact)
{
    const double modulus = by_modulus * fit->value[NT_FIT_EFFECTIVE_MODULUS];
    double (*covariance)[NT_FIT_PARAMETERS] = fit->covariance;
    covariance[NT_FIT_EFFECTIVE_MODULUS][NT_FIT_EFFECTIVE_MODULUS] += modulus * modulus;
    covariance[NT_FIT_CONTACT_POINT][NT_FIT_CONTACT_POINT] += by_contact * by_contact;
    covariance[NT_FIT_EFFECTIVE_MODULUS][NT_FIT_CONTACT_POINT] += modulus * by_contact;
    covariance[NT_FIT_CONTACT_POINT][NT_FIT_EFFECTIVE_MODULUS] += modulus * by_contact;
    for (const int p : {int(NT_FIT_EFFECTIVE_MODULUS), int(NT_FIT_CONTACT_POINT)})
        fit->sigma[p] = std::sqrt(covariance[p][p]);
    if (!(fit->sigma[NT_FIT_EFFECTIVE_MODULUS] < NT_FIT_IDENTIFIABLE * fit->value[NT_FIT_EFFECTIVE_MODULUS]))
        fit->identifiable[NT_FIT_EFFECTIVE_MODULUS] = 0;
}

} // namespace

void compare_halves(const std::vector<nt_fit_point> &points, const nt_fit_data &data, double noise,
                    nt_fit_solution *solution)
{
    nt_fit_result &fit = solution->fit;
    solution->half_modulus[0] = solution->half_modulus[1] = std::numeric_limits<double>::quiet_NaN();
    const double modulus = fit.value[NT_FIT_EFFECTIVE_MODULUS];
    if (!(noise > 0.0 && std::isfinite(fit.sigma[NT_FIT_EFFECTIVE_MODULUS])) ||
        solution->options.loss != NT_LOSS_SQUARES)
        return;
    std::array<Part, layers> layer;
    const double thickness = deepest(points) / layers;
    for (std::size_t i = 0; i < points.size(); i++) {
        const nt_fit_point &point = points[i];
        if (point.gradient[NT_FIT_EFFECTIVE_MODULUS] == 0.0)
            continue;
        const double residual = data.force[static_cast<long>(i) * data.force_stride] - point.force;
        const int place = int(std::clamp(point.indentation / thickness, 0.0, double(layers - 1)));
        add({modulus * point.gradient[NT_FIT_EFFECTIVE_MODULUS] / noise, point.gradient[NT_FIT_CONTACT_POINT] / noise},
            residual / noise, &layer[static_cast<std::size_t>(place)]);
    }
    Part whole;
    for (const Part &part : layer)
        whole = sum(whole, part);
    const Cut cut = cut_between(layer, whole);
    if (cut.chi_square < surely)
        return;
    const Pair &above = cut.shallow.change, &below = cut.deep.change;
    solution->half_modulus[0] = modulus * std::exp(above[0]);
    solution->half_modulus[1] = modulus * std::exp(below[0]);
    solution->flags |= NT_FIT_UNEVEN;
    // a contact point that is off by so much moves the modulus by so much
    const double by_contact = below[1] - above[1], along = std::fabs(whole.ab / whole.aa * by_contact);
    widen(&fit, std::max(0.5 * std::fabs(below[0] - above[0]), along), std::copysign(0.5 * by_contact, -whole.ab));
}

} // namespace nanotouch
