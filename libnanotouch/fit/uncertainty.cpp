// SPDX-License-Identifier: BSD-3-Clause
// Covariance (J^T J)^-1 by the singular values of J, those of its null space left out, and what follows from it.
#include "uncertainty.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nanotouch
{

namespace
{

using Matrix = Eigen::MatrixXd;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double null_space = 1e-7;       // of the largest singular value
constexpr double whole = 1e-3;            // by which the resolution may differ from 1
constexpr double beside_the_bound = 1e-6; // in coordinates

struct Covariance {
    Matrix matrix;
    Eigen::VectorXd resolution; // of each coordinate: 1 if it is determined, less if it takes part in the null space
};

// J = Q R, R = U S V^T: the SVD is that of a small matrix.
Covariance covariance_of(const Residuals::Columns &jacobian)
{
    const Eigen::Index size = jacobian.cols();
    const Matrix R = Eigen::HouseholderQR<Matrix>(jacobian).matrixQR().topRows(size).triangularView<Eigen::Upper>();
    const Eigen::JacobiSVD<Matrix> svd(R, Eigen::ComputeThinV);
    Matrix directions = svd.matrixV();
    Covariance found{Matrix::Zero(size, size), Eigen::VectorXd::Zero(size)};
    for (Eigen::Index i = 0; i < size; i++) {
        const double value = svd.singularValues()(i);
        if (!(value > null_space * svd.singularValues()(0)))
            continue;
        const Eigen::VectorXd direction = directions.col(i);
        found.matrix += direction * direction.transpose() / (value * value);
        found.resolution += direction.cwiseProduct(direction);
    }
    return found;
}

bool at_bound(const nt_fit_start &bounds, const Coordinates &coordinates, int i, double value)
{
    const double x = coordinates.inverse(i, value);
    return std::min(x - coordinates.inverse(i, bounds.minimum), coordinates.inverse(i, bounds.maximum) - x) <
           beside_the_bound;
}

} // namespace

// With a robust loss Huber's M-estimate, psi(u) = rho'(u^2) u. A datum of a parameter makes up for the parameter.
double noise_variance(const Residuals &residuals, const Coordinates &coordinates, const ceres::LossFunction *loss)
{
    const long count = residuals.data_count();
    double squares = 0.0, slopes = 0.0;
    for (long i = 0; i < count; i++) {
        const double u = residuals.residual(i), s = u * u;
        double rho[3] = {s, 1.0, 0.0};
        if (loss)
            loss->Evaluate(s, rho);
        squares += rho[1] * u * rho[1] * u;
        slopes += rho[1] + 2.0 * s * rho[2];
    }
    const double mean_slope = slopes / double(count);
    const long freedom = std::min(residuals.count() - coordinates.size(), count);
    return squares / double(freedom) / (mean_slope * mean_slope);
}

void fill_uncertainties(const nt_fit_options &options, const Residuals &residuals, const Coordinates &coordinates,
                        double variance, nt_fit_result *result)
{
    const bool noise_known = options.force_noise > 0.0;
    const double scale = noise_known ? std::max(1.0, variance) : variance;
    result->misfit = noise_known ? variance : not_a_number;
    const Parameters value = residuals.values();
    const int size = coordinates.size();
    const Residuals::Columns jacobian = residuals.jacobian();
    const Covariance covariance = covariance_of(jacobian);
    Eigen::VectorXd by_tear = Eigen::VectorXd::Zero(size);
    if (residuals.has_tear())
        by_tear = covariance.matrix * jacobian.row(residuals.data_count()).transpose();
    const auto determined = [&](int i) { return std::fabs(covariance.resolution(i) - 1.0) < whole; };
    for (int i = 0; i < size; i++) {
        const int p = coordinates.parameter(i);
        for (int j = 0; j < size; j++)
            result->covariance[p][coordinates.parameter(j)] =
                determined(i) && determined(j)
                    ? scale * covariance.matrix(i, j) * coordinates.slope(i, value) * coordinates.slope(j, value)
                : i == j ? infinity
                         : not_a_number;
        result->sigma[p] = std::sqrt(result->covariance[p][p]);
        result->from_tear[p] = determined(i) ? by_tear(i) * by_tear(i) / covariance.matrix(i, i) : 0.0;
        result->identifiable[p] = result->sigma[p] < NT_FIT_IDENTIFIABLE * coordinates.slope(i, value) &&
                                  !at_bound(options.parameter[p], coordinates, i, value[static_cast<std::size_t>(p)]);
    }
}

} // namespace nanotouch
