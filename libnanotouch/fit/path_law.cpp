// SPDX-License-Identifier: BSD-3-Clause
// The force of the contact, level, tilt and drag at every node, with derivatives.
#include <algorithm>
#include <cmath>

#include "internal/rheology.h"
#include "path.hpp"

namespace nanotouch
{

PathLaw::PathLaw(const nt_fit_path_options &options, const PathBins &bins)
    : options_(options), bins_(bins), own_(nt_rheology_parameter_count(&options.contact.rheology))
{
    const std::size_t count = bins.size();
    force.resize(count);
    contact_force.resize(count);
    indentation.resize(count);
    derivatives_.resize(count * std::size_t(1 + own_));
    workspace_.resize(std::size_t(nt_viscoelastic_workspace(&options.contact, long(count), 1)));
}

nt_viscoelastic PathLaw::contact(const PathValues &value) const
{
    nt_viscoelastic contact = options_.contact;
    nt_rheology &rheology = contact.rheology;
    if (rheology.kind == NT_RHEOLOGY_POWER_LAW) {
        rheology.modulus = value[0];
        rheology.exponent = std::max(value[1], 0.0);
        return contact;
    }
    rheology.equilibrium_modulus = value[0];
    for (int k = 0; 2 * k + 2 < own_; k++) {
        rheology.arm_moduli[k] = value[std::size_t(1 + 2 * k)];
        rheology.relaxation_times[k] = value[std::size_t(2 + 2 * k)];
    }
    return contact;
}

double PathLaw::drag_part(std::size_t node, double first_touch) const
{
    const double height = std::max(first_touch - bins_.position[node], 0.0), scale = options_.drag_height;
    return bins_.speed[node] * (scale > 0.0 ? scale / (scale + height) : 1.0);
}

nt_status PathLaw::evaluate(const PathValues &value, const std::vector<int> *free, nt_viscoelastic_result *result)
{
    const nt_viscoelastic law = contact(value);
    const double touch = value[NT_FIT_PATH_CONTACT];
    const nt_viscoelastic_path path = {bins_.time.data(), bins_.position.data(), touch, long(bins_.size()),
                                       workspace_.data()};
    result->forces = contact_force.data();
    result->indentations = indentation.data();
    result->derivatives = free ? derivatives_.data() : nullptr;
    const nt_status status = nt_viscoelastic_run(&law, &path, result, nullptr);
    if (status != NT_OK)
        return status;
    for (std::size_t i = 0; i < bins_.size(); i++)
        force[i] = contact_force[i] + value[NT_FIT_PATH_LEVEL] +
                   value[NT_FIT_PATH_TILT] * (bins_.position[i] - options_.tilt_position) +
                   value[NT_FIT_PATH_DRAG] * drag_part(i, touch);
    if (!free)
        return NT_OK;
    jacobian.resize(Eigen::Index(bins_.size()), Eigen::Index(free->size()));
    for (std::size_t c = 0; c < free->size(); c++) {
        const int p = (*free)[c];
        const auto column = std::size_t(p == NT_FIT_PATH_CONTACT ? 0 : 1 + p);
        for (std::size_t i = 0; i < bins_.size(); i++) {
            double slope = 1.0;
            if (p <= NT_FIT_PATH_CONTACT)
                slope = derivatives_[i * std::size_t(1 + own_) + column];
            else if (p == NT_FIT_PATH_TILT)
                slope = bins_.position[i] - options_.tilt_position;
            else if (p == NT_FIT_PATH_DRAG)
                slope = drag_part(i, touch);
            jacobian(Eigen::Index(i), Eigen::Index(c)) = slope;
        }
    }
    return NT_OK;
}

} // namespace nanotouch
