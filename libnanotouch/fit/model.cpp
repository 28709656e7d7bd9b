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

} // namespace nanotouch
