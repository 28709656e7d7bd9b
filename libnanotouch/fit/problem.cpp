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
    double sum = 0.0;
    for (const double residual : residual_)
        sum += residual * residual;
    return sum;
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
    for (long i = 0; i < data_.count; i++) {
        const Point &point = points_[static_cast<std::size_t>(i)];
        store(i, point.force - data_.force[i * data_.force_stride], point.gradient);
    }
    long i = data_.count;
    if (has_tear() && !store_tear(i++))
        return false;
    for (const int known : known_)
        store_known(i++, known);
    const auto finite = [](double number) { return std::isfinite(number); };
    return std::all_of(residual_.begin(), residual_.end(), finite) &&
           std::all_of(gradient_.begin(), gradient_.end(), finite);
}

void Residuals::store(long i, double residual, const Parameters &gradient)
{
    const int size = coordinates_.size();
    residual_[static_cast<std::size_t>(i)] = residual / unit_;
    double *row = &gradient_[static_cast<std::size_t>(i * size)];
    for (int j = 0; j < size; j++)
        row[j] = gradient[static_cast<std::size_t>(coordinates_.parameter(j))] * factor_[static_cast<std::size_t>(j)];
}

bool Residuals::store_tear(long i)
{
    Tear tear;
    if (model_->tear(&tear) != NT_OK)
        return false;
    residual_[static_cast<std::size_t>(i)] = (tear.position - options_.tear_position) / options_.tear_sigma;
    double *row = &gradient_[static_cast<std::size_t>(i * coordinates_.size())];
    for (int j = 0; j < coordinates_.size(); j++)
        row[j] = tear.gradient[static_cast<std::size_t>(coordinates_.parameter(j))] * coordinates_.gradient_scale(j) /
                 options_.tear_sigma;
    return true;
}

void Residuals::weigh(double unit)
{
    const double change = unit_ / unit;
    unit_ = unit;
    for (double &factor : factor_)
        factor *= change;
    std::for_each_n(residual_.begin(), data_.count, [&](double &residual) { residual *= change; });
    std::for_each_n(gradient_.begin(), data_.count * coordinates_.size(), [&](double &slope) { slope *= change; });
}

// The datum "initial +- sigma" of a free parameter; of its logarithm where that is fitted.
void Residuals::store_known(long i, int coordinate)
{
    const nt_fit_start &start = options_.parameter[coordinates_.parameter(coordinate)];
    const double sigma = coordinates_.is_logarithmic(coordinate)
                             ? start.sigma / start.initial
                             : start.sigma / coordinates_.gradient_scale(coordinate);
    double *row = &gradient_[static_cast<std::size_t>(i * coordinates_.size())];
    std::fill_n(row, coordinates_.size(), 0.0);
    row[coordinate] = 1.0 / sigma;
    residual_[static_cast<std::size_t>(i)] =
        (x_[static_cast<std::size_t>(coordinate)] - coordinates_.inverse(coordinate, start.initial)) / sigma;
}

// The solver turns back from where the squares are infinite.
bool Squares::operator()(const double *x, double *residuals, double *jacobian) const
{
    if (!all.move_to(x)) {
        std::fill_n(residuals, all.count(), std::numeric_limits<double>::infinity());
        return false;
    }
    std::copy_n(all.residuals(0), all.count(), residuals);
    if (jacobian) {
        using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        Eigen::Map<Eigen::MatrixXd>(jacobian, all.count(), all.size()) =
            Eigen::Map<const Rows>(all.gradient(0), all.count(), all.size());
    }
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
        std::copy_n(all_.gradient(first_), num_residuals() * parameter_block_sizes()[0], jacobians[0]);
    return true;
}

} // namespace nanotouch
