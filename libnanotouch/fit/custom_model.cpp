// SPDX-License-Identifier: BSD-3-Clause
// The indentations of all points are searched together, one call of the law for all of them: it may be a numpy
// function.
#include "custom_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nanotouch
{

namespace
{

constexpr int max_iterations = 80;
constexpr double relative_step = 6e-6; // cube root of the rounding error: of central differences the best
constexpr double converged = 1e-12;    // of the span of the positions; the last step is taken all the same

double largest(const std::vector<double> &values)
{
    double found = 0.0;
    for (const double value : values)
        found = std::max(found, std::fabs(value));
    return found;
}

double step_of(double value, double scale)
{
    return relative_step * std::max(std::fabs(value), 1e-2 * scale);
}

// The root of a growing function, approached by Newton, kept in a bracket that widens as long as it is open.
struct Root {
    double lo = -std::numeric_limits<double>::infinity(), hi = std::numeric_limits<double>::infinity();
    double next(double x, double excess, double slope, double unit)
    {
        (excess > 0.0 ? hi : lo) = x;
        const double newton = x - excess / slope;
        if (slope > 0.0 && newton >= lo && newton <= hi) // equal to x once it is found
            return newton;
        if (std::isinf(lo))
            return x - 2.0 * std::max(std::fabs(excess), unit);
        return std::isinf(hi) ? x + 2.0 * std::max(std::fabs(excess), unit) : 0.5 * (lo + hi);
    }
};

} // namespace

nt_status CustomModel::force_at(const Parameters &value, const Array &indentation, Array *force) const
{
    force->resize(indentation.size());
    return options_.law->force(&options_, value.data(), static_cast<long>(indentation.size()), indentation.data(),
                               force->data());
}

nt_status CustomModel::prepare(const Parameters &value)
{
    for (int i = 0; i < options_.law->count; i++)
        if (!std::isfinite(value[static_cast<std::size_t>(i)]))
            return NT_E_NOT_FINITE;
    value_ = value;
    compliance_ = options_.spring_constant > 0.0 ? 1.0 / options_.spring_constant : 0.0;
    return NT_OK;
}

nt_status CustomModel::slope_at(const Array &indentation, double scale, Array *stiffness) const
{
    Array moved = indentation, up, down;
    for (std::size_t i = 0; i < moved.size(); i++)
        moved[i] += step_of(indentation[i], scale);
    nt_status status = force_at(value_, moved, &up);
    for (std::size_t i = 0; i < moved.size(); i++)
        moved[i] = indentation[i] - step_of(indentation[i], scale);
    if (status == NT_OK)
        status = force_at(value_, moved, &down);
    stiffness->resize(indentation.size());
    for (std::size_t i = 0; i < moved.size() && status == NT_OK; i++)
        (*stiffness)[i] = (up[i] - down[i]) / (2.0 * step_of(indentation[i], scale));
    return status;
}

// delta + F(delta)/k_c = base for every point.
nt_status CustomModel::solve(const Array &base, double scale, Array *indentation, Array *force) const
{
    *indentation = base;
    nt_status status = force_at(value_, *indentation, force);
    if (status != NT_OK || compliance_ == 0.0)
        return status;
    std::vector<Root> roots(base.size());
    Array stiffness;
    for (int i = 0; i < max_iterations; i++) {
        double worst = 0.0;
        status = slope_at(*indentation, scale, &stiffness);
        for (std::size_t j = 0; j < base.size() && status == NT_OK; j++) {
            const double x = (*indentation)[j], excess = x + compliance_ * (*force)[j] - base[j];
            if (!std::isfinite(excess))
                return NT_E_NO_SOLUTION;
            const double next =
                excess == 0.0 ? x : roots[j].next(x, excess, 1.0 + compliance_ * stiffness[j], 1e-3 * scale);
            worst = std::max(worst, std::fabs(next - x));
            (*indentation)[j] = next;
        }
        if (status == NT_OK)
            status = force_at(value_, *indentation, force);
        if (status != NT_OK || worst <= converged * scale)
            return status;
    }
    return NT_E_NO_CONVERGENCE;
}

// dF/dparameter at constant indentation, of ln(parameter) where that is what is fitted.
nt_status CustomModel::differentiate(int parameter, const Array &indentation, Array *slope) const
{
    const auto p = static_cast<std::size_t>(parameter);
    const nt_fit_quantity &quantity = options_.law->parameter[parameter];
    const bool logarithmic = quantity.minimum > 0.0;
    const double size = std::max(std::fabs(value_[p]), 1e-3 * (quantity.maximum - quantity.minimum));
    const double step = relative_step * (logarithmic ? value_[p] : size);
    Parameters moved = value_;
    Array down;
    moved[p] = value_[p] + step;
    nt_status status = force_at(moved, indentation, slope);
    moved[p] = value_[p] - step;
    if (status == NT_OK)
        status = force_at(moved, indentation, &down);
    for (std::size_t i = 0; i < indentation.size() && status == NT_OK; i++)
        (*slope)[i] = ((*slope)[i] - down[i]) / (2.0 * step) * (logarithmic ? value_[p] : 1.0);
    return status;
}

nt_status CustomModel::points_at(const nt_fit_data &data, Points *points) const
{
    const auto count = static_cast<std::size_t>(data.count);
    Array base(count), indentation, force, stiffness, slope;
    for (std::size_t i = 0; i < count; i++)
        base[i] = data.position[static_cast<long>(i) * data.position_stride] - value_[NT_FIT_CONTACT_POINT];
    const double scale = largest(base), s = value_[NT_FIT_SENSITIVITY];
    nt_status status = solve(base, scale, &indentation, &force);
    if (status == NT_OK)
        status = slope_at(indentation, scale, &stiffness);
    if (status != NT_OK)
        return status;
    points->resize(count);
    for (std::size_t i = 0; i < count; i++) {
        Point point{};
        const double from = data.position[static_cast<long>(i) * data.position_stride] - options_.tilt_position;
        point.force = force[i] / s + value_[NT_FIT_FORCE_OFFSET] + value_[NT_FIT_FORCE_TILT] * from;
        point.indentation = indentation[i];
        point.held = true;
        point.gradient[NT_FIT_CONTACT_POINT] = -stiffness[i] / (s * (1.0 + compliance_ * stiffness[i]));
        point.gradient[NT_FIT_FORCE_OFFSET] = 1.0;
        point.gradient[NT_FIT_FORCE_TILT] = from;
        point.gradient[NT_FIT_SENSITIVITY] = -force[i] / s;
        points->set(i, point);
    }
    for (int p = 0; p < options_.law->count && status == NT_OK; p++) {
        status = differentiate(p, indentation, &slope);
        for (std::size_t i = 0; i < count && status == NT_OK; i++)
            points->gradient[static_cast<std::size_t>(p)][i] = slope[i] / (s * (1.0 + compliance_ * stiffness[i]));
    }
    return status;
}

nt_status CustomModel::tear(Tear *) const
{
    return NT_E_UNSUPPORTED;
}

nt_status CustomModel::travel(double, double *) const
{
    return NT_E_UNSUPPORTED;
}

void CustomModel::describe(double, nt_fit_result *result) const
{
    result->pull_off_force = result->transition_parameter = std::numeric_limits<double>::quiet_NaN();
    result->contact_radius = result->contact_stiffness = std::numeric_limits<double>::quiet_NaN();
}

} // namespace nanotouch
