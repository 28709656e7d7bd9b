// SPDX-License-Identifier: BSD-3-Clause
// What a recorded branch shows before anything is fitted; private to fit/. Definitions: curves/events.py.
#pragma once

#include <cstddef>
#include <vector>

#include "baseline.hpp"

namespace nanotouch
{

// A branch with its baseline taken off, from the deepest point outwards.
class Branch
{
  public:
    Branch() = default;
    Branch(const nt_fit_segment &segment, bool waves);

    double visible() const;       // smallest force that can be told from the baseline [N]
    double sigma(double z) const; // of one force at z [N]
    // Standard deviation of one of so many points such that the mean of independent ones would scatter as theirs [N]; 0
    // where the free cantilever does not show that they are not independent.
    double correlated_noise(std::size_t points) const;
    std::size_t lowest() const; // the point of the smallest force, not at the far end
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
