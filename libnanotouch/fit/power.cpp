// SPDX-License-Identifier: BSD-3-Clause
// A law of the wrong power - a cone taken for a sphere, a thin layer on rigid ground, a contact that adheres or creeps
// - can be fitted to within the noise by another contact point and modulus. What cannot be mimicked is looked for: at
// the solution one step of Gauss and Newton with the power free, all that is known beforehand in it (a score test, Rao
// 1948). And a tip of another power is fitted to means of neighbours.
#include "power.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <limits>

#include "data.hpp"
#include "internal/fit.h"
#include "solve.hpp"

namespace nanotouch
{

namespace
{

constexpr double sharper = 2.0;  // standard deviations by which the power is above the law's: its own sigma is somewhat
                                 // large (z scatters by 0.8), and layers, films and cones are common
constexpr double blunter = 3.0;  // by which it is below
constexpr double matters = 0.05; // of the power: what it is off by moves E* by some 15 %
constexpr long some = 60;        // means
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int most = NT_FIT_PARAMETERS + 1;

using Matrix = Eigen::Matrix<double, most, most>;
using Vector = Eigen::Matrix<double, most, 1>;

// J^T J and J^T r over the noise; the last place is the power's, unused ones are held at 0.
struct Normal {
    Matrix matrix = Matrix::Zero();
    Vector right = Vector::Zero();
};

void know(const nt_fit_solution &solution, Normal *normal)
{
    for (int p = 0; p < NT_FIT_PARAMETERS; p++) {
        const nt_fit_start &start = solution.options.parameter[p];
        if (!is_free(solution.options, p)) {
            normal->matrix(p, p) = 1.0;
        } else if (start.sigma > 0.0) {
            normal->matrix(p, p) += 1.0 / (start.sigma * start.sigma);
            normal->right(p) += (start.initial - solution.fit.value[p]) / (start.sigma * start.sigma);
        }
    }
}

double deepest(const std::vector<nt_fit_point> &points)
{
    double depth = 0.0;
    for (const nt_fit_point &point : points)
        depth = std::max(depth, point.indentation);
    return depth;
}

nt_fit_model rival_of(nt_fit_model model)
{
    return nt_fit_describe(model).exponent > 1.75 ? NT_FIT_HERTZ : NT_FIT_CONE;
}

bool chi_square(const nt_fit_options &options, const nt_fit_data &data, double *found)
{
    nt_fit_result fit;
    if (run_with_points(options, data, &fit, nullptr, nullptr) != NT_OK)
        return false;
    *found = fit.chi_square;
    return std::isfinite(*found);
}

} // namespace

bool has_power(const nt_fit_options &options)
{
    switch (options.model) {
    case NT_FIT_HERTZ:
    case NT_FIT_SPHERE:
    case NT_FIT_CONE:
    case NT_FIT_PYRAMID:
    case NT_FIT_PYRAMID3:
    case NT_FIT_LAYER:
    case NT_FIT_LAYER_CONE:
        return options.loss == NT_LOSS_SQUARES && is_free(options, NT_FIT_EFFECTIVE_MODULUS) &&
               is_free(options, NT_FIT_CONTACT_POINT);
    default:
        return false;
    }
}

void find_power(const std::vector<nt_fit_point> &points, const nt_fit_data &data, double noise,
                nt_fit_solution *solution)
{
    Normal normal;
    know(*solution, &normal);
    const double depth = deepest(points), modulus = solution->fit.value[NT_FIT_EFFECTIVE_MODULUS];
    for (std::size_t i = 0; i < points.size(); i++) {
        const nt_fit_point &point = points[i];
        Vector slope = Vector::Zero();
        for (int p = 0; p < NT_FIT_PARAMETERS; p++)
            if (is_free(solution->options, p))
                slope(p) = point.gradient[p] / noise;
        if (point.indentation > 0.0) // the force is linear in E*
            slope(most - 1) =
                modulus * point.gradient[NT_FIT_EFFECTIVE_MODULUS] / noise * std::log(point.indentation / depth);
        const double rest = data.force[static_cast<long>(i) * data.force_stride] - point.force;
        normal.matrix.selfadjointView<Eigen::Lower>().rankUpdate(slope);
        normal.right += slope * (rest / noise);
    }
    normal.matrix.triangularView<Eigen::StrictlyUpper>() = normal.matrix.transpose();
    const Vector scale = normal.matrix.diagonal().cwiseSqrt();
    if (!(noise > 0.0 && scale.minCoeff() > 0.0))
        return;
    normal.matrix = (normal.matrix.array() / (scale * scale.transpose()).array()).matrix();
    const Eigen::LDLT<Matrix> solver(normal.matrix);
    const Vector last = solver.solve(Vector::Unit(most - 1));
    const double step = last.dot(normal.right.cwiseQuotient(scale)) / scale(most - 1);
    const double variance = last(most - 1) / (scale(most - 1) * scale(most - 1));
    if (!(std::isfinite(step) && variance > 0.0))
        return;
    solution->power[0] = nt_fit_describe(solution->options.model).exponent + step;
    solution->power[1] = std::sqrt(variance);
}

bool asks_other_power(const nt_fit_solution &solution)
{
    const double off = solution.power[0] - nt_fit_describe(solution.options.model).exponent;
    const double surely = off > 0.0 ? sharper : blunter;
    return std::fabs(off) > std::max(matters, surely * solution.power[1]); // not where untold
}

bool is_rivalled(const nt_fit_solution &solution, const nt_fit_data &data)
{
    const long size = std::max(1L, data.count / some);
    const Means means(data, size);
    nt_fit_options options = solution.options;
    options.force_noise /= std::sqrt(double(size));
    double own, other;
    if (!chi_square(options, means.data(), &own))
        return false;
    options.model = rival_of(options.model);
    options.parameter[NT_FIT_EFFECTIVE_MODULUS].initial = not_a_number;
    return chi_square(options, means.data(), &other) && other < own;
}

} // namespace nanotouch
