// SPDX-License-Identifier: BSD-3-Clause
// What a recorded branch shows before anything is fitted; private to fit/. Definitions: curves/baseline.py, events.py.
#pragma once

#include <cstddef>
#include <vector>

#include "nanotouch/fit.h"

namespace nanotouch
{

// Force of the free cantilever, a line through its far part.
struct Baseline {
    double force, slope, z_mean, scatter; // at z_mean [N], [N/m], [m], robust standard deviation about it [N]
    double force_variance, slope_variance;
    bool waves; // the residuals hang together: perhaps interference
    double at(double z) const
    {
        return force + slope * (z - z_mean);
    }
    double sigma(double z) const; // of the line at z [N]
};

// A branch with its baseline taken off, from the deepest point outwards.
class Branch
{
  public:
    Branch() = default;
    explicit Branch(const nt_fit_segment &segment);

    double visible() const;       // smallest force that can be told from the baseline [N]
    double sigma(double z) const; // of one force at z [N]
    std::size_t lowest() const;   // the point of the smallest force, not at the far end
    // Whether that lies visibly below the baseline: alone, or together with its neighbours.
    bool dips() const;
    // The last point before the tip is torn off, found by the jump and not as the lowest point, which noise picks among
    // several; false where the force comes back gradually, or not at all.
    bool tear(std::size_t *last) const;

    nt_fit_measured dip() const;
    nt_fit_measured adhesion_work() const;
    nt_fit_measured contact_slope() const;

    std::vector<double> z, force;
    Baseline baseline{};
    double noise = 0.0; // from point to point in the order of time [N]
};

// NT_OK, or what is wrong with the values.
nt_status check_segment(const nt_fit_segment &segment, nt_problem *problem);

} // namespace nanotouch
