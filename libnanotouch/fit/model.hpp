// SPDX-License-Identifier: BSD-3-Clause
// The model of fit.h with its analytic derivatives; private to fit/.
#pragma once

#include <array>

#include "nanotouch/fit.h"

namespace nanotouch {

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

class Model {
public:
    // Makes the law ready for the given values (SI); NT_E_RANGE where it does not exist.
    nt_status prepare(const nt_fit_options &options, const Parameters &value);

    // near: a force near the result, where the search starts [N]; the result does not depend on it.
    nt_status at(double position, double near, Point *point) const;

    // Force and derivatives of the load fold: -pull-off force; the indentation there.
    const Point &pull_off() const { return pull_off_; }

    // delta + c F/k_c at a force on the stable branch: how far the base has travelled since first touch.
    nt_status travel(double force, double *travel) const;

    const nt_contact_law &law() const { return law_; }
    nt_status law_value(double indentation, nt_law_value *value) const;

private:
    nt_status prepare_load_fold();
    void differentiate(double indentation, const nt_law_value &value, Point *point) const;

    nt_contact_law law_{};
    Parameters value_{};
    double compliance_ = 0.0;             // c/k_c [m/N]
    double load_fold_indentation_ = 0.0;  // [m]
    Point pull_off_{};
};

}  // namespace nanotouch
