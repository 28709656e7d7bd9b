// SPDX-License-Identifier: BSD-3-Clause
// The built-in contact laws with their analytic derivatives; private to fit/.
#pragma once

#include "fit/many.h"
#include "fit/models/row.h"
#include "model.hpp"

namespace nanotouch
{

// Where a point lies on the branch.
struct Place {
    double position = 0.0, s = 0.0, slope = 0.0; // X, s, ds/dX
    bool known = false;
};

// The cubic through two places and their slopes, from which points between them, and not far beyond, are searched.
class Cubic
{
  public:
    Cubic(const Place &before, const Place &place, double otherwise);
    double at(double position) const
    {
        const double x = position - position_;
        return s_ + x * (slope_ + x * (bend_ + x * twist_));
    }

  private:
    double position_ = 0.0, s_, slope_ = 0.0, bend_ = 0.0, twist_ = 0.0;
};

// The last places that were searched one from the other.
struct Walk {
    Place before, last;
};

class ContactModel : public Model
{
  public:
    explicit ContactModel(const nt_fit_options &options) : options_(options), row_(*nt_fit_row_of(options.model))
    {
    }
    nt_status prepare(const Parameters &value) override;
    nt_status points_at(const nt_fit_data &data, Points *points) const override;
    nt_status tear(Tear *tear) const override;
    nt_status travel(double force, double *travel) const override;
    void describe(double deepest, nt_fit_result *result) const override;

  private:
    nt_status at(double position, const Cubic &near, Place *place, Point *point) const;
    nt_status one_by_one(const nt_fit_data &data, Points *points) const;
    nt_status find(double position, const Cubic &near, Place *place) const;
    nt_status start_block(const nt_fit_data &data, long first, Walk *walk, nt_fit_many *many) const;
    nt_status solve_block(nt_fit_many *many) const;
    nt_status write_block(const nt_fit_data &data, long first, const nt_fit_many &many, Points *points) const;
    double anywhere() const
    {
        return branch_.load_fold + branch_.unit;
    }
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
