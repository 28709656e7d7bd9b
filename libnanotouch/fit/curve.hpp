// SPDX-License-Identifier: BSD-3-Clause
// One recorded curve from its baseline to its fit; private to fit/.
#pragma once

#include "nanotouch/fit.h"

namespace nanotouch
{

// Writes all of the outcome. May throw std::bad_alloc.
void fit_recorded(const nt_fit_recipe &recipe, const nt_curve &curve, nt_fit_outcome *outcome);

// What a curve shows without any model.
void summarise(const nt_curve_reading &read, nt_fit_reading *reading);

// An outcome of that status, its numbers NaN.
nt_fit_outcome failed(nt_status status);

} // namespace nanotouch
