// SPDX-License-Identifier: BSD-3-Clause
// With which power of the indentation the force rises; private to fit/.
#pragma once

#include <vector>

#include "internal/fit.h"
#include "nanotouch/fit.h"

namespace nanotouch
{

// Whether the model is one of a tip of a given power without adhesion.
bool has_power(const nt_fit_options &options);

// Fills solution->power of a law that has_power. noise: of a point, as far as the points are independent [N].
void find_power(const std::vector<nt_fit_point> &points, const nt_fit_data &data, double noise,
                nt_fit_solution *solution);

// Whether the points surely ask for another power than the law's.
bool asks_other_power(const nt_fit_solution &solution);

// Whether the law of a tip of another power describes the points better.
bool is_rivalled(const nt_fit_solution &solution, const nt_fit_data &data);

} // namespace nanotouch
