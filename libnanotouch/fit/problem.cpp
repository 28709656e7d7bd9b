// SPDX-License-Identifier: BSD-3-Clause
// Residuals in units of the noise where it is known, else of the largest force: see problem.hpp.
#include "problem.hpp"

#include <algorithm>
#include <cmath>

#include "data.hpp"

namespace nanotouch
{

Coordinates::Coordinates(const nt_fit_options &options, const nt_fit_data &data, const Parameters &start)
    : start_(start)
{
    scale_.fill(1.0);
    scale_[NT_FIT_CONTACT_POINT] = position_span(data).width();
    scale_[NT_FIT_FORCE_OFFSET] = force_span(data).width();
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        if (!options.parameter[i].fixed && nt_fit_model_has(options.model, static_cast<nt_fit_parameter>(i)))
            free_.push_back(i);
}

Parameters Coordinates::values(const double *x) const
{
    Parameters value = start_;
    for (int i = 0; i < size(); i++) {
        const auto p = static_cast<std::size_t>(parameter(i));
        value[p] = is_logarithmic(parameter(i)) ? start_[p] * std::exp(x[i]) : start_[p] + scale_[p] * x[i];
    }
    return value;
}

double Coordinates::inverse(int i, double value) const
{
    const auto p = static_cast<std::size_t>(parameter(i));
    return is_logarithmic(parameter(i)) ? std::log(value / start_[p]) : (value - start_[p]) / scale_[p];
}

double Coordinates::gradient_scale(int i) const
{
    return scale_[static_cast<std::size_t>(parameter(i))];
}

double Coordinates::slope(int i, const Parameters &value) const
{
    return is_logarithmic(parameter(i)) ? value[static_cast<std::size_t>(parameter(i))] : gradient_scale(i);
}

Residuals::Residuals(const nt_fit_options &options, const nt_fit_data &data, const Coordinates &coordinates)
    : options_(options), data_(data), coordinates_(coordinates),
      unit_(options.force_noise > 0.0 ? options.force_noise : force_span(data).largest()),
      has_pull_off_(options.pull_off_sigma > 0.0),
      has_compliance_(options.compliance_sigma > 0.0 && !options.parameter[NT_FIT_COMPLIANCE].fixed),
      count_(data.count + has_pull_off_ + has_compliance_), x_(static_cast<std::size_t>(coordinates.size())),
      residual_(static_cast<std::size_t>(count_)), gradient_(static_cast<std::size_t>(count_ * coordinates.size()))
{
}

void Residuals::PrepareForEvaluation(bool, bool new_evaluation_point)
{
    if (new_evaluation_point)
        valid_ = evaluate();
}

bool Residuals::evaluate()
{
    const Parameters value = values();
    if (model_.prepare(options_, value) != NT_OK)
        return false;
    Point point;
    Track track;
    for (long i = 0; i < data_.count; i++) {
        const double force = data_.force[i * data_.force_stride];
        if (model_.at(data_.position[i * data_.position_stride], &track, &point) != NT_OK)
            return false;
        store(i, point.force - force, point, unit_);
    }
    long i = data_.count;
    if (has_pull_off_)
        store(i++, model_.pull_off().force + options_.pull_off_force, model_.pull_off(), options_.pull_off_sigma);
    if (has_compliance_) {
        point.gradient.fill(0.0);
        point.gradient[NT_FIT_COMPLIANCE] = 1.0;
        store(i, std::log(value[NT_FIT_COMPLIANCE]), point, options_.compliance_sigma);
    }
    const auto finite = [](double number) { return std::isfinite(number); };
    return std::all_of(residual_.begin(), residual_.end(), finite) &&
           std::all_of(gradient_.begin(), gradient_.end(), finite);
}

void Residuals::store(long i, double residual, const Point &point, double unit)
{
    residual_[static_cast<std::size_t>(i)] = residual / unit;
    for (int j = 0; j < coordinates_.size(); j++)
        gradient_[static_cast<std::size_t>(i * coordinates_.size() + j)] =
            point.gradient[static_cast<std::size_t>(coordinates_.parameter(j))] * coordinates_.gradient_scale(j) / unit;
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
