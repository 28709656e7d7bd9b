// SPDX-License-Identifier: BSD-3-Clause
// Force of the free cantilever; private to fit/. Definitions: curves/baseline.py.
#pragma once

#include <vector>

#include "nanotouch/fit.h"

#include "flicker.hpp"

namespace nanotouch
{

constexpr double event_level = 5.0; // standard deviations of the noise: one in 2e6 points
constexpr double wave_level = 3.0;  // standard deviations of the scatter about the baseline

struct Wave {
    double period = 1.0, cosine = 0.0, sine = 0.0; // [m], [N], [N]
    double at(double x) const;
    double amplitude() const;
};

// A line through the far part of a branch, and a wave of interference where there is one.
struct Baseline {
    double force, slope, z_mean, scatter; // at z_mean [N], [N/m], [m], robust standard deviation about it [N]
    double force_variance, slope_variance;
    double correlation; // by how much that of the residuals raises the variance of their mean; 1 for white noise
    Noise noise;        // of the free cantilever
    Wave wave;
    double at(double z) const;
    double sigma(double z) const; // of the baseline at z [N]
};

// Standard deviation from point to point in the order of time, so that no shape of the curve enters [N]. Where more
// than half of the differences are 0, because the converter's step exceeds the noise, from all but the largest
// hundredth.
double point_noise(const nt_fit_segment &segment);
Baseline fit_baseline(const nt_fit_segment &segment, double noise, bool waves);

} // namespace nanotouch
