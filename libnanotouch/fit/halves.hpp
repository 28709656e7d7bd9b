// SPDX-License-Identifier: BSD-3-Clause
// Whether the shallow and the deep half of a contact ask for the same modulus and contact point; private to fit/.
#pragma once

#include <vector>

#include "internal/fit.h"
#include "nanotouch/fit.h"

namespace nanotouch
{

// Fills solution->half_modulus. Where they differ surely, the sigmas of E* and contact point cover half of what they
// differ by, and NT_FIT_UNEVEN is set. noise: of a point, as far as the points are independent [N].
void compare_halves(const std::vector<nt_fit_point> &points, const nt_fit_data &data, double noise,
                    nt_fit_solution *solution);

} // namespace nanotouch
