// SPDX-License-Identifier: BSD-3-Clause
// The built-in contact laws with their analytic derivatives; private to fit/.
#pragma once

#include "fit/models/row.h"
#include "model.hpp"

namespace nanotouch
{

// Where the two points before lay on the branch: the next, mostly a neighbour, starts from their cubic.
class Track
{
  public:
    double predict(double position, double otherwise) const;
    void add(double position, double s, double slope);

  private:
    bool known_ = false;
    double position_ = 0.0, s_ = 0.0, slope_ = 0.0; // s, ds/dX at X
    double step_ = 0.0, bend_ = 0.0, twist_ = 0.0;  // from the point before it [m]; of the cubic through both
};

class ContactModel : public Model
{
  public:
    explicit ContactModel(const nt_fit_options &options) : options_(options), row_(*nt_fit_row_of(options.model))
    {
    }
    nt_status prepare(const Parameters &value) override;
    nt_status points_at(const nt_fit_data &data, std::vector<Point> *points) const override;
    nt_status tear(Tear *tear) const override;
    nt_status travel(double force, double *travel) const override;
    void describe(double deepest, nt_fit_result *result) const override;

  private:
    nt_status at(double position, Track *track, Point *point) const;
    nt_status search(double base, double start, double *s, nt_fit_state *state) const;
    double steepness_at(double s, double steepest) const;
    double where_steep(double steepest) const;
    void differentiate(const nt_fit_state &state, double stiffness, Point *point) const;
    void add_background(double position, Point *point) const;

    const nt_fit_options &options_;
    const nt_fit_row &row_;
    nt_fit_branch branch_{};
    Parameters value_{};
    double compliance_ = 0.0; // 1/k_c [m/N]; 0 without a spring constant
    double end_ = 0.0;        // s at which the straight continuation begins
    bool prepared_ = false;   // for the law of value_
    double end_base_ = 0.0;   // X - delta0 there [m]
    double end_slope_ = 0.0;  // dF/dX there [N/m]
    Point end_point_{};
};

} // namespace nanotouch
