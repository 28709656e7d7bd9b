// SPDX-License-Identifier: BSD-3-Clause
// What the values of a fit are worth; private to fit/.
#pragma once

#include "problem.hpp"

namespace nanotouch
{

// Variance of one residual in its unit.
double noise_variance(const Residuals &residuals, const Coordinates &coordinates, const ceres::LossFunction *loss);

// Fills sigma, covariance, from_tear, identifiable and misfit.
void fill_uncertainties(const nt_fit_options &options, const Residuals &residuals, const Coordinates &coordinates,
                        double variance, nt_fit_result *result);

} // namespace nanotouch
