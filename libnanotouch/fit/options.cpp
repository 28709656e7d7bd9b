// SPDX-License-Identifier: BSD-3-Clause
// Options of a fit: names, defaults, checks.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "core/problem.h"
#include "fit/models/row.h"
#include "internal/field.h"
#include "internal/fit.h"
#include "nanotouch/advanced/field.h"

namespace
{

constexpr double not_given = std::numeric_limits<double>::quiet_NaN();

// An enumerator from C may be any number; C++ must not look at it as an enumerator before it is checked.
template <class Enumeration> int number_of(const Enumeration &enumerator)
{
    static_assert(sizeof(Enumeration) == sizeof(int));
    int number;
    std::memcpy(&number, &enumerator, sizeof number);
    return number;
}

bool is_built_in(const nt_fit_model &model)
{
    const int index = number_of(model);
    return index >= 0 && index < NT_FIT_CUSTOM;
}

const nt_fit_quantity none{nullptr, "", not_given, 0.0, 0.0};
const nt_fit_quantity common[NT_FIT_PARAMETERS - NT_FIT_OWN] = {
    {"contact_point", "m", not_given, -1.0, 1.0},
    {"force_offset", "N", 0.0, -1.0, 1.0},
    {"force_tilt", "N/m", 0.0, -1e3, 1e3},
    {"sensitivity", "", 1.0, 0.1, 10.0},
};

#define FIELD(path, ...) NT_FIELD(nt_fit_options, path, __VA_ARGS__, "")
const nt_field fields[] = {
    FIELD(radius, "m", 1e-10, 1.0),       FIELD(half_angle, "rad", 0.01, 1.56), FIELD(spring_constant, "N/m", 0.0, 1e6),
    FIELD(tilt_position, "m", -1.0, 1.0), FIELD(loss_scale, "N", 1e-18, 1.0),   FIELD(force_noise, "N", 0.0, 1.0),
    FIELD(tear_position, "m", -1.0, 1.0), FIELD(tear_sigma, "m", 0.0, 1.0),
};
#undef FIELD

nt_status complain(nt_problem *problem, const nt_problem &what)
{
    if (problem)
        *problem = what;
    return std::isfinite(what.value) ? NT_E_RANGE : NT_E_NOT_FINITE;
}

bool within(double value, double minimum, double maximum)
{
    return value >= minimum && value <= maximum;
}

nt_status check_start(const nt_fit_quantity &quantity, const nt_fit_start &start, nt_problem *problem)
{
    const nt_problem complaint =
        nt_problem_of(quantity.name, quantity.unit, start.initial, start.minimum, start.maximum);
    const double lowest = quantity.minimum, highest = quantity.maximum;
    if (!within(start.minimum, lowest, highest))
        return complain(problem, nt_problem_of(quantity.name, quantity.unit, start.minimum, lowest, highest));
    if (!within(start.maximum, start.minimum, highest))
        return complain(problem, nt_problem_of(quantity.name, quantity.unit, start.maximum, start.minimum, highest));
    if (!within(start.sigma, 0.0, std::numeric_limits<double>::max()))
        return complain(problem, nt_problem_of(quantity.name, quantity.unit, start.sigma, 0.0, highest));
    const bool to_be_guessed = std::isnan(start.initial) && !start.fixed && start.sigma == 0.0;
    if (!to_be_guessed && !within(start.initial, start.minimum, start.maximum))
        return complain(problem, complaint);
    return NT_OK;
}

nt_status check_law(const nt_fit_law *law, nt_problem *problem)
{
    if (!law || !law->force || !law->name)
        return NT_E_ARGUMENT;
    if (law->count < 1 || law->count > NT_FIT_OWN)
        return complain(problem, nt_problem_of("law.count", "", double(law->count), 1.0, double(NT_FIT_OWN)));
    for (int i = 0; i < law->count; i++) {
        const nt_fit_quantity &quantity = law->parameter[i];
        if (!quantity.name || !quantity.unit)
            return NT_E_ARGUMENT;
        if (!std::isfinite(quantity.minimum) || !(quantity.maximum > quantity.minimum) ||
            !std::isfinite(quantity.maximum))
            return complain(problem,
                            nt_problem_of(quantity.name, quantity.unit, quantity.maximum, quantity.minimum, 1e300));
    }
    return NT_OK;
}

nt_status check_choices(const nt_fit_options *options, nt_problem *problem)
{
    const int model = number_of(options->model), loss = number_of(options->loss);
    if (model < 0 || model > NT_FIT_CUSTOM)
        return complain(problem, nt_problem_of("model", "", double(model), 0.0, NT_FIT_CUSTOM));
    if (loss < NT_LOSS_SQUARES || loss > NT_LOSS_CAUCHY)
        return complain(problem, nt_problem_of("loss", "", double(loss), NT_LOSS_SQUARES, NT_LOSS_CAUCHY));
    if (options->max_iterations < 1 || options->max_iterations > 100000)
        return complain(problem, nt_problem_of("max_iterations", "", double(options->max_iterations), 1.0, 1e5));
    const nt_fit_start &sensitivity = options->parameter[NT_FIT_SENSITIVITY];
    if ((!sensitivity.fixed || options->tear_sigma > 0.0) && options->spring_constant == 0.0)
        return complain(problem, nt_problem_of("spring_constant", "N/m", 0.0, 1e-6, 1e6));
    if (options->tear_sigma > 0.0 && !(nt_fit_describe(options->model).pull_off > 0.0))
        return complain(problem, nt_problem_of("tear_sigma", "m", options->tear_sigma, 0.0, 0.0));
    return options->model == NT_FIT_CUSTOM ? check_law(options->law, problem) : NT_OK;
}

nt_status check_noise(const nt_fit_options *options, nt_problem *problem)
{
    bool needed = options->tear_sigma > 0.0;
    for (const nt_fit_start &start : options->parameter)
        needed = needed || (start.sigma > 0.0 && !start.fixed);
    return needed && options->force_noise == 0.0 ? complain(problem, nt_problem_of("force_noise", "N", 0.0, 1e-18, 1.0))
                                                 : NT_OK;
}

nt_fit_options defaults(nt_fit_model model, const nt_fit_law *law)
{
    nt_fit_options options{};
    options.model = model;
    options.law = law;
    options.radius = 20e-9;
    options.half_angle = 20.0 * 3.14159265358979323846 / 180.0;
    options.loss = NT_LOSS_SQUARES;
    options.loss_scale = 1e-9;
    options.max_iterations = 100;
    for (int i = 0; i < NT_FIT_PARAMETERS; i++) {
        const nt_fit_quantity quantity = nt_fit_quantity_of(&options, static_cast<nt_fit_parameter>(i));
        options.parameter[i] = {quantity.initial, quantity.minimum, quantity.maximum, 0.0, 0};
    }
    for (int i = 0; i < NT_FIT_OWN && is_built_in(model); i++)
        options.parameter[i].fixed = nt_fit_row_of(model)->held >> i & 1U;
    for (const int background : {NT_FIT_FORCE_OFFSET, NT_FIT_FORCE_TILT, NT_FIT_SENSITIVITY})
        options.parameter[background].fixed = 1;
    return options;
}

} // namespace

nt_fit_quantity nt_fit_quantity_of(const nt_fit_options *options, nt_fit_parameter parameter)
{
    const int index = number_of(parameter);
    if (!options || index < 0 || index >= NT_FIT_PARAMETERS)
        return none;
    if (index >= NT_FIT_OWN)
        return common[index - NT_FIT_OWN];
    if (!is_built_in(options->model))
        return options->law && index < options->law->count ? options->law->parameter[index] : none;
    const nt_fit_quantity &own = nt_fit_row_of(options->model)->parameter[index];
    return own.name ? own : none;
}

nt_fit_options nt_fit_defaults(nt_fit_model model)
{
    return defaults(model, nullptr);
}

nt_fit_options nt_fit_defaults_for(const nt_fit_law *law)
{
    return defaults(NT_FIT_CUSTOM, law);
}

nt_status nt_fit_check(const nt_fit_options *options, nt_problem *problem)
{
    if (problem)
        *problem = nt_problem{};
    if (!options)
        return NT_E_ARGUMENT;
    nt_status status = nt_field_check(fields, sizeof fields / sizeof fields[0], options, problem);
    if (status == NT_OK)
        status = check_choices(options, problem);
    if (status == NT_OK)
        status = check_noise(options, problem);
    for (int i = 0; i < NT_FIT_PARAMETERS && status == NT_OK; i++) {
        const nt_fit_quantity quantity = nt_fit_quantity_of(options, static_cast<nt_fit_parameter>(i));
        if (quantity.name)
            status = check_start(quantity, options->parameter[i], problem);
    }
    return status;
}
