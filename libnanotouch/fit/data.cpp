// SPDX-License-Identifier: BSD-3-Clause
// The points of a curve: spans and checks.
#include "data.hpp"
#include "core/problem.h"

#include <algorithm>
#include <cmath>

namespace nanotouch
{

namespace
{

constexpr double largest_value = 1.0; // m or N: beyond, the unit is surely not SI

Span span(const double *values, long count, long stride)
{
    Span found{values[0], values[0]};
    for (long i = 1; i < count; i++) {
        found.lowest = std::min(found.lowest, values[i * stride]);
        found.highest = std::max(found.highest, values[i * stride]);
    }
    return found;
}

struct Column {
    const double *values;
    long stride;
    const char *name, *span_name, *unit;
};

nt_status check_column(const Column &column, long count, nt_problem *problem)
{
    for (long i = 0; i < count; i++) {
        const double value = column.values[i * column.stride];
        if (std::fabs(value) <= largest_value)
            continue;
        *problem = nt_problem_of(column.name, column.unit, value, -largest_value, largest_value);
        return std::isfinite(value) ? NT_E_RANGE : NT_E_NOT_FINITE;
    }
    if (span(column.values, count, column.stride).width() > 0.0)
        return NT_OK;
    *problem = nt_problem_of(column.span_name, column.unit, 0.0, 1e-18, largest_value);
    return NT_E_RANGE;
}

} // namespace

Span position_span(const nt_fit_data &data)
{
    return span(data.position, data.count, data.position_stride);
}

Span force_span(const nt_fit_data &data)
{
    return span(data.force, data.count, data.force_stride);
}

Means::Means(const nt_fit_data &data, long size)
{
    const long count = data.count / size;
    for (long mean = 0; mean < count; mean++) {
        const long first = mean * data.count / count, end = (mean + 1) * data.count / count;
        double position = 0.0, force = 0.0;
        for (long i = first; i < end; i++) {
            position += data.position[i * data.position_stride];
            force += data.force[i * data.force_stride];
        }
        position_.push_back(position / double(end - first));
        force_.push_back(force / double(end - first));
    }
}

nt_status check_data(const nt_fit_options &options, const nt_fit_data *data, nt_problem *problem)
{
    nt_problem ignored;
    if (!problem)
        problem = &ignored;
    if (!data || !data->position || !data->force)
        return NT_E_ARGUMENT;
    int free = 0;
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        free += is_free(options, i);
    if (free == 0) {
        *problem = nt_problem_of("parameter (free ones)", "", 0.0, 1.0, NT_FIT_PARAMETERS);
        return NT_E_RANGE;
    }
    if (data->count < free + 3) {
        *problem = nt_problem_of("data.count", "", double(data->count), double(free + 3), 1e9);
        return NT_E_RANGE;
    }
    const Column position{data->position, data->position_stride, "data.position", "data.position (span)", "m"};
    const Column force{data->force, data->force_stride, "data.force", "data.force (span)", "N"};
    const nt_status status = check_column(position, data->count, problem);
    return status == NT_OK ? check_column(force, data->count, problem) : status;
}

} // namespace nanotouch
