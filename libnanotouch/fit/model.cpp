// SPDX-License-Identifier: BSD-3-Clause
#include "model.hpp"

#include "contact_model.hpp"
#include "custom_model.hpp"

namespace nanotouch
{

bool is_logarithmic(const nt_fit_options &options, int parameter)
{
    return nt_fit_quantity_of(&options, static_cast<nt_fit_parameter>(parameter)).minimum > 0.0;
}

bool is_free(const nt_fit_options &options, int parameter)
{
    return !options.parameter[parameter].fixed &&
           nt_fit_quantity_of(&options, static_cast<nt_fit_parameter>(parameter)).name;
}

std::unique_ptr<Model> Model::make(const nt_fit_options &options)
{
    if (options.model == NT_FIT_CUSTOM)
        return std::make_unique<CustomModel>(options);
    return std::make_unique<ContactModel>(options);
}

void Points::resize(std::size_t count)
{
    force.resize(count);
    indentation.resize(count);
    held.resize(count);
    for (std::vector<double> &slope : gradient)
        slope.resize(count);
}

void Points::set(std::size_t i, const Point &point)
{
    force[i] = point.force;
    indentation[i] = point.indentation;
    held[i] = point.held;
    for (std::size_t p = 0; p < NT_FIT_PARAMETERS; p++)
        gradient[p][i] = point.gradient[p];
}

} // namespace nanotouch
