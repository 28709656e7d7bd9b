// SPDX-License-Identifier: BSD-3-Clause
// Residuals in units of the noise where it is known, else of the largest force: see problem.hpp.
#include "problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "data.hpp"
#include "reserve.hpp"

namespace nanotouch
{

Coordinates::Coordinates(const nt_fit_options &options, const nt_fit_data &data, const Parameters &start)
    : start_(start)
{
    for (int i = 0; i < NT_FIT_PARAMETERS; i++) {
        const auto p = static_cast<std::size_t>(i);
        logarithmic_[p] = nanotouch::is_logarithmic(options, i);
        scale_[p] = logarithmic_[p] ? 1.0 : options.parameter[i].maximum - options.parameter[i].minimum;
        if (is_free(options, i))
            free_.push_back(i);
    }
    scale_[NT_FIT_CONTACT_POINT] = position_span(data).width();
    scale_[NT_FIT_FORCE_OFFSET] = force_span(data).width();
    scale_[NT_FIT_FORCE_TILT] = scale_[NT_FIT_FORCE_OFFSET] / scale_[NT_FIT_CONTACT_POINT];
}

Parameters Coordinates::values(const double *x) const
{
    Parameters value = start_;
    for (int i = 0; i < size(); i++) {
        const auto p = static_cast<std::size_t>(parameter(i));
        value[p] = logarithmic_[p] ? start_[p] * std::exp(x[i]) : start_[p] + scale_[p] * x[i];
    }
    return value;
}

double Coordinates::inverse(int i, double value) const
{
    const auto p = static_cast<std::size_t>(parameter(i));
    return logarithmic_[p] ? std::log(value / start_[p]) : (value - start_[p]) / scale_[p];
}

double Coordinates::gradient_scale(int i) const
{
    return scale_[static_cast<std::size_t>(parameter(i))];
}

double Coordinates::slope(int i, const Parameters &value) const
{
    const auto p = static_cast<std::size_t>(parameter(i));
    return logarithmic_[p] ? value[p] : scale_[p];
}

Residuals::Residuals(const nt_fit_options &options, const nt_fit_data &data, const Coordinates &coordinates)
    : options_(options), data_(data), coordinates_(coordinates), model_(Model::make(options)),
      unit_(options.force_noise > 0.0 ? options.force_noise : force_span(data).largest()),
      x_(static_cast<std::size_t>(coordinates.size()))
{
    for (int i = 0; i < coordinates_.size(); i++) {
        const nt_fit_start &start = options_.parameter[coordinates_.parameter(i)];
        lowest_.push_back(coordinates_.inverse(i, start.minimum));
        highest_.push_back(coordinates_.inverse(i, start.maximum));
        if (start.sigma > 0.0)
            known_.push_back(i);
    }
    for (int i = 0; i < coordinates_.size(); i++)
        factor_.push_back(coordinates_.gradient_scale(i) / unit_);
    count_ = data.count + has_tear() + static_cast<long>(known_.size());
    residual_.resize(static_cast<std::size_t>(count_));
    gradient_.resize(static_cast<std::size_t>(count_ * coordinates_.size()));
}

void Residuals::PrepareForEvaluation(bool, bool new_evaluation_point)
{
    if (Reserve::is_used()) // it would not last
        throw std::bad_alloc();
    if (!new_evaluation_point || (is_seen_ && x_ == seen_))
        return;
    is_seen_ = true;
    seen_ = x_;
    valid_ = evaluate();
}

bool Residuals::move_to(const double *x)
{
    std::copy_n(x, size(), x_.begin());
    PrepareForEvaluation(true, true);
    return valid_;
}

double Residuals::sum_of_squares() const
{
    return Eigen::Map<const Eigen::VectorXd>(residual_.data(), count_).squaredNorm();
}

// No step may then lead out of the bounds.
void Residuals::make_bounds_walls(bool walls)
{
    walls_ = walls;
    met_bound_ = false;
    is_seen_ = is_seen_ && valid_;
}

bool Residuals::is_outside() const
{
    for (std::size_t i = 0; i < x_.size(); i++)
        if (x_[i] < lowest_[i] || x_[i] > highest_[i])
            return true;
    return false;
}

bool Residuals::evaluate()
{
    if (walls_ && is_outside()) {
        met_bound_ = true;
        return false;
    }
    if (model_->prepare(values()) != NT_OK || model_->points_at(data_, &points_) != NT_OK)
        return false;
    store_points();
    long i = data_.count;
    if (has_tear() && !store_tear(i++))
        return false;
    for (const int known : known_)
        store_known(i++, known);
    // 0 of finite numbers, NaN of others
    return 0.0 * Eigen::Map<const Eigen::VectorXd>(residual_.data(), count_).array().abs().sum() == 0.0 &&
           0.0 * jacobian().array().abs().sum() == 0.0;
}

void Residuals::store_points()
{
    const std::size_t count = points_.size();
    for (std::size_t i = 0; i < count; i++)
        residual_[i] = (points_.force[i] - data_.force[static_cast<long>(i) * data_.force_stride]) / unit_;
    for (int j = 0; j < coordinates_.size(); j++) {
        const auto p = static_cast<std::size_t>(coordinates_.parameter(j));
        const double factor = factor_[static_cast<std::size_t>(j)];
        const double *gradient = points_.gradient[p].data();
        double *slope = column(j);
        for (std::size_t i = 0; i < count; i++)
            slope[i] = gradient[i] * factor;
    }
}

bool Residuals::store_tear(long i)
{
    Tear tear;
    if (model_->tear(&tear) != NT_OK)
        return false;
    residual_[static_cast<std::size_t>(i)] = (tear.position - options_.tear_position) / options_.tear_sigma;
    for (int j = 0; j < coordinates_.size(); j++)
        column(j)[i] = tear.gradient[static_cast<std::size_t>(coordinates_.parameter(j))] *
                       coordinates_.gradient_scale(j) / options_.tear_sigma;
    return true;
}

void Residuals::weigh(double unit)
{
    const double change = unit_ / unit;
    unit_ = unit;
    for (double &factor : factor_)
        factor *= change;
    std::for_each_n(residual_.begin(), data_.count, [&](double &residual) { residual *= change; });
    for (int j = 0; j < coordinates_.size(); j++)
        std::for_each_n(column(j), data_.count, [&](double &slope) { slope *= change; });
}

// The datum "initial +- sigma" of a free parameter; of its logarithm where that is fitted.
void Residuals::store_known(long i, int coordinate)
{
    const nt_fit_start &start = options_.parameter[coordinates_.parameter(coordinate)];
    const double sigma = coordinates_.is_logarithmic(coordinate)
                             ? start.sigma / start.initial
                             : start.sigma / coordinates_.gradient_scale(coordinate);
    for (int j = 0; j < coordinates_.size(); j++)
        column(j)[i] = j == coordinate ? 1.0 / sigma : 0.0;
    residual_[static_cast<std::size_t>(i)] =
        (x_[static_cast<std::size_t>(coordinate)] - coordinates_.inverse(coordinate, start.initial)) / sigma;
}

// J^T J = L L^T by Cholesky, and L^-1 J^T r: a triangle that has the normal equations of J and r. A pivot that is but
// rounding is a direction in which nothing changes.
static void reduce(const Residuals::Columns &J, const Eigen::Ref<const Eigen::VectorXd> &r,
                   Eigen::Ref<Eigen::MatrixXd> R, Eigen::Ref<Eigen::VectorXd> y)
{
    constexpr double rounding = 1e-15;
    R.setZero();
    for (Eigen::Index j = 0; j < J.cols(); j++) {
        const double square = J.col(j).squaredNorm(), left = square - R.col(j).head(j).squaredNorm();
        if (!(left > rounding * square))
            continue;
        R(j, j) = std::sqrt(left);
        for (Eigen::Index k = j + 1; k < J.cols(); k++)
            R(j, k) = (J.col(j).dot(J.col(k)) - R.col(j).head(j).dot(R.col(k).head(j))) / R(j, j);
        y(j) = (J.col(j).dot(r) - R.col(j).head(j).dot(y.head(j))) / R(j, j);
    }
}

// The solver turns back from where the squares are infinite.
bool Squares::operator()(const double *x, double *residuals, double *jacobian) const
{
    Eigen::Map<Eigen::VectorXd> y(residuals, NumResiduals());
    if (!all.move_to(x)) {
        y.setConstant(std::numeric_limits<double>::infinity());
        return false;
    }
    y.setZero();
    if (jacobian) {
        const Eigen::Map<const Eigen::VectorXd> r(all.residuals(0), all.count());
        reduce(all.jacobian(), r, Eigen::Map<Eigen::MatrixXd>(jacobian, NumResiduals(), all.size()), y);
    }
    y(all.size()) = std::sqrt(std::max(all.sum_of_squares() - y.squaredNorm(), 0.0));
    return true;
}

Residual::Residual(const Residuals &all, long first, long count, int parameters) : all_(all), first_(first)
{
    set_num_residuals(static_cast<int>(count));
    mutable_parameter_block_sizes()->push_back(parameters);
}

bool Residual::Evaluate(double const *const *, double *residuals, double **jacobians) const
{
    if (!all_.valid())
        return false;
    std::copy_n(all_.residuals(first_), num_residuals(), residuals);
    if (jacobians && jacobians[0])
        Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            jacobians[0], num_residuals(), parameter_block_sizes()[0]) =
            all_.jacobian().middleRows(first_, num_residuals());
    return true;
}

} // namespace nanotouch
