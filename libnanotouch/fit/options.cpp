// SPDX-License-Identifier: BSD-3-Clause
// Options of a fit: names, defaults, checks.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include "nanotouch/field.h"
#include "nanotouch/fit.h"

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

struct Description {
    const char *name, *unit;
    double minimum, maximum; // widest bounds
    const char *initial_name, *minimum_name, *maximum_name;
};

#define DESCRIBE(name, unit, minimum, maximum)                                                                         \
    {name, unit, minimum, maximum, name ".initial", name ".minimum", name ".maximum"}
const Description descriptions[NT_FIT_PARAMETERS] = {
    DESCRIBE("effective_modulus", "Pa", 1.0, 1e14), DESCRIBE("work_of_adhesion", "J/m^2", 1e-9, 1e3),
    DESCRIBE("cohesive_range", "m", 1e-12, 1e-5),   DESCRIBE("contact_point", "m", -1.0, 1.0),
    DESCRIBE("force_offset", "N", -1.0, 1.0),       DESCRIBE("compliance", "", 0.1, 10.0),
};
#undef DESCRIBE

#define FIELD(path, unit, minimum, maximum)                                                                            \
    {#path, unit, minimum, maximum, static_cast<unsigned>(offsetof(nt_fit_options, path)), ""}
const nt_field fields[] = {
    FIELD(radius, "m", 1e-10, 1.0),        FIELD(spring_constant, "N/m", 0.0, 1e6),
    FIELD(loss_scale, "N", 1e-18, 1.0),    FIELD(force_noise, "N", 0.0, 1.0),
    FIELD(pull_off_force, "N", 0.0, 1.0),  FIELD(pull_off_sigma, "N", 0.0, 1.0),
    FIELD(compliance_sigma, "", 0.0, 1.0),
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

void hold(nt_fit_start *start, double value)
{
    start->initial = value;
    start->fixed = 1;
}

nt_status check_start(const Description &description, const nt_fit_start &start, nt_problem *problem)
{
    const char *unit = description.unit;
    const double lowest = description.minimum, highest = description.maximum;
    if (!within(start.minimum, lowest, highest))
        return complain(problem, {description.minimum_name, unit, start.minimum, lowest, highest});
    if (!within(start.maximum, start.minimum, highest))
        return complain(problem, {description.maximum_name, unit, start.maximum, start.minimum, highest});
    const bool to_be_guessed = std::isnan(start.initial) && !start.fixed;
    if (!to_be_guessed && !within(start.initial, start.minimum, start.maximum))
        return complain(problem, {description.initial_name, unit, start.initial, start.minimum, start.maximum});
    return NT_OK;
}

nt_status check_choices(const nt_fit_options *options, nt_problem *problem)
{
    const int model = number_of(options->model), loss = number_of(options->loss);
    if (model < NT_HERTZ || model > NT_MAUGIS)
        return complain(problem, {"model", "", double(model), NT_HERTZ, NT_MAUGIS});
    if (loss < NT_LOSS_SQUARES || loss > NT_LOSS_CAUCHY)
        return complain(problem, {"loss", "", double(loss), NT_LOSS_SQUARES, NT_LOSS_CAUCHY});
    if (options->max_iterations < 1 || options->max_iterations > 100000)
        return complain(problem, {"max_iterations", "", double(options->max_iterations), 1.0, 1e5});
    const bool needs_noise = options->pull_off_sigma > 0.0 || options->compliance_sigma > 0.0;
    if (needs_noise && options->force_noise == 0.0)
        return complain(problem, {"force_noise", "N", 0.0, 1e-18, 1.0});
    const nt_fit_start &compliance = options->parameter[NT_FIT_COMPLIANCE];
    if (!compliance.fixed && options->spring_constant == 0.0)
        return complain(problem, {"spring_constant", "N/m", 0.0, 1e-6, 1e6});
    return NT_OK;
}

} // namespace

const char *nt_fit_parameter_name(nt_fit_parameter parameter)
{
    const int index = number_of(parameter);
    return index >= 0 && index < NT_FIT_PARAMETERS ? descriptions[index].name : nullptr;
}

const char *nt_fit_parameter_unit(nt_fit_parameter parameter)
{
    const int index = number_of(parameter);
    return index >= 0 && index < NT_FIT_PARAMETERS ? descriptions[index].unit : nullptr;
}

int nt_fit_model_has(nt_model model, nt_fit_parameter parameter)
{
    switch (parameter) {
    case NT_FIT_WORK_OF_ADHESION:
        return model != NT_HERTZ;
    case NT_FIT_COHESIVE_RANGE:
        return model == NT_MAUGIS;
    default:
        return 1;
    }
}

nt_fit_options nt_fit_defaults(nt_model model)
{
    nt_fit_options options{};
    options.model = model;
    options.radius = 20e-9;
    options.loss = NT_LOSS_SQUARES;
    options.loss_scale = 1e-9;
    options.max_iterations = 100;
    for (int i = 0; i < NT_FIT_PARAMETERS; i++)
        options.parameter[i] = {not_given, descriptions[i].minimum, descriptions[i].maximum, 0};
    hold(&options.parameter[NT_FIT_COHESIVE_RANGE], 0.2e-9);
    hold(&options.parameter[NT_FIT_FORCE_OFFSET], 0.0);
    hold(&options.parameter[NT_FIT_COMPLIANCE], 1.0);
    return options;
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
    for (int i = 0; i < NT_FIT_PARAMETERS && status == NT_OK; i++)
        if (nt_fit_model_has(options->model, static_cast<nt_fit_parameter>(i)))
            status = check_start(descriptions[i], options->parameter[i], problem);
    return status;
}
