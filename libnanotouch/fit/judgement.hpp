// SPDX-License-Identifier: BSD-3-Clause
// Whether what a fit leaves over is noise; private to fit/.
#pragma once

#include "problem.hpp"

namespace nanotouch
{

// Fills residual_noise and residuals_are_noise from the residuals and result->residual_rms.
void judge_residuals(const nt_fit_options &options, const nt_fit_data &data, const Residuals &residuals,
                     nt_fit_result *result);

} // namespace nanotouch
