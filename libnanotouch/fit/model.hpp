// SPDX-License-Identifier: BSD-3-Clause
// The model of fit.h with its analytic derivatives; private to fit/.
#pragma once

#include <array>

#include "fit/branch.h"
#include "nanotouch/fit.h"

namespace nanotouch
{

using Parameters = std::array<double, NT_FIT_PARAMETERS>;

// Positive quantities are fitted by their logarithm, so that their scale does not matter and they cannot change sign.
inline bool is_logarithmic(int parameter)
{
    return parameter != NT_FIT_CONTACT_POINT && parameter != NT_FIT_FORCE_OFFSET;
}

// Force and derivatives by ln(parameter) where that is_logarithmic, else by the parameter.
struct Point {
    double force;
    double indentation;
    Parameters gradient;
};

// Where the points before lay on the branch: the next, mostly a neighbour, starts from there.
class Track
{
  public:
    double predict(double position, double otherwise) const;
    void add(double position, double s, double slope);

  private:
    bool known_ = false;
    double position_ = 0.0, s_ = 0.0, slope_ = 0.0, bend_ = 0.0; // s, ds/dX, d2s/dX2 at X
};

class Model
{
  public:
    // Makes the law ready for the given values (SI); NT_E_RANGE where it does not exist.
    nt_status prepare(const nt_fit_options &options, const Parameters &value);

    // track: only where the search starts; the result does not depend on it.
    nt_status at(double position, Track *track, Point *point) const;

    // Force and derivatives of the load fold: -pull-off force; the indentation there.
    const Point &pull_off() const
    {
        return pull_off_;
    }

    // delta + c F/k_c at a force on the stable branch: how far the base has travelled since first touch.
    nt_status travel(double force, double *travel) const;

    const nt_contact_law &law() const
    {
        return law_;
    }
    nt_status law_value(double indentation, nt_law_value *value) const;

  private:
    nt_status search(double base, double start, double *s, nt_fit_state *state) const;
    void differentiate(const nt_fit_state &state, double stiffness, Point *point) const;

    nt_contact_law law_{};
    nt_fit_branch branch_{};
    Parameters value_{};
    double compliance_ = 0.0; // c/k_c [m/N]
    Point pull_off_{};
};

} // namespace nanotouch
