// SPDX-License-Identifier: BSD-3-Clause
// The force at a position and its derivatives.
//
// Derivatives at constant delta. In Maugis' units F = S_P p(d; lambda), d = delta/S_d with S_P = pi w R,
// S_d = (pi^2 w^2 R/K^2)^(1/3) and lambda = 2 (w/h0) (R/(pi w K^2))^(1/3), so that with Lambda = S_P lambda
// dp/dlambda|_d
//
//     dF/d ln E* = 2/3 (k delta - Lambda)     dF/d ln w = F - 2/3 (k delta - Lambda)     dF/d ln h0 = -Lambda (scaling)
//
// for every paraboloid; Lambda = 0 without a range of adhesion. Cone and pyramid: dF/d ln E* = k delta/2. For
// Maugis-Dugdale, dp/dlambda|_d = p_lambda - k d_lambda at constant branch parameter y. Differentiating (Griffith) of
// contact/maugis/branch.c by lambda gives, with q = 4/3 lambda^2 g2 b and r = (1 + q)/(2 - q),
//
//     lambda b_lambda = -r b     lambda p_lambda = p (1 - 2r) - a^3 (1 + r)     lambda d_lambda = d (1 - r) - a^2 (1 +
//     r)
//
// At constant position, (cantilever) of fit.h turns dF into (dF - k ddelta0)/(1 + k/k_c); measured is F/s.
//
// The tear, dX/ds = 0: there X is stationary along the branch, so its derivative is that at constant delta,
// dX = ddelta0 + dF/k_c.
//
// The straight continuation F = F_e - m (X - X_e) begins where dF/dX = -m. Its derivative at constant X is that of the
// branch at X_e, whatever X_e does, because m is a constant. It ends at F = 0, where the tip is apart.
#include "contact_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nanotouch
{

namespace
{

constexpr int max_iterations = 100;
constexpr double linear = 1e-9; // of s: over a step that small the branch is straight to the last bit
constexpr double tight = 1e-12; // of the part of the branch between its folds
constexpr long spacing = 4;     // points, of those that are searched one from the other
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

} // namespace

Cubic::Cubic(const Place &before, const Place &place, double otherwise) : s_(otherwise)
{
    if (!place.known)
        return;
    position_ = place.position;
    s_ = place.s;
    slope_ = place.slope;
    const double step = place.position - before.position;
    if (!before.known || step == 0.0)
        return;
    const double inverse = 1.0 / step, turned = (place.slope - before.slope) * inverse; // Hermite's
    const double bent = ((before.s - place.s) * inverse + place.slope) * inverse;
    bend_ = 3.0 * bent - turned;
    twist_ = (2.0 * bent - turned) * inverse;
}

// F1 + steepest dX/ds: negative where the curve over X is steeper than that.
double ContactModel::steepness_at(double s, double steepest) const
{
    const nt_fit_state state = row_.at(&branch_, s);
    return state.F1 + steepest * (state.indentation1 + compliance_ * state.F1);
}

// s between the folds where dF/dX = -steepest [N/m]; regula falsi, its bracket kept (Illinois).
double ContactModel::where_steep(double steepest) const
{
    double lo = branch_.grip_fold, hi = branch_.load_fold;
    double at_lo = steepness_at(lo, steepest), at_hi = steepness_at(hi, steepest);
    int last = 0;
    for (int i = 0; i < max_iterations && hi - lo > tight * (hi - branch_.grip_fold); i++) {
        const double s = std::clamp((lo * at_hi - hi * at_lo) / (at_hi - at_lo), lo, hi);
        const double value = steepness_at(s, steepest);
        if (value == 0.0)
            return s;
        const int side = value < 0.0 ? -1 : 1;
        (side < 0 ? lo : hi) = s;
        (side < 0 ? at_lo : at_hi) = value;
        if (side == last)
            (side < 0 ? at_hi : at_lo) *= 0.5;
        last = side;
    }
    return hi;
}

void ContactModel::differentiate(const nt_fit_state &state, double stiffness, Point *point) const
{
    const double softening = 1.0 / ((1.0 + compliance_ * stiffness) * value_[NT_FIT_SENSITIVITY]);
    point->force = state.F / value_[NT_FIT_SENSITIVITY];
    point->indentation = state.indentation;
    point->gradient.fill(0.0);
    row_.derive(&state, stiffness, point->gradient.data());
    for (int i = 0; i < NT_FIT_OWN; i++)
        point->gradient[static_cast<std::size_t>(i)] *= softening;
    point->gradient[NT_FIT_CONTACT_POINT] = softening * -stiffness;
    point->gradient[NT_FIT_SENSITIVITY] = -point->force;
    point->held = true;
}

void ContactModel::add_background(double position, Point *point) const
{
    const double from = position - options_.tilt_position;
    point->force += value_[NT_FIT_FORCE_OFFSET] + value_[NT_FIT_FORCE_TILT] * from;
    point->gradient[NT_FIT_FORCE_OFFSET] = 1.0;
    point->gradient[NT_FIT_FORCE_TILT] = from;
}

nt_status ContactModel::prepare(const Parameters &value)
{
    if (prepared_ && std::equal(value.begin(), value.begin() + NT_FIT_OWN, value_.begin()) &&
        value[NT_FIT_SENSITIVITY] == value_[NT_FIT_SENSITIVITY]) { // only place or background: the same law
        value_ = value;
        return NT_OK;
    }
    prepared_ = false;
    const nt_status status = row_.prepare(&options_, value.data(), &branch_);
    if (status != NT_OK)
        return status;
    value_ = value;
    compliance_ = options_.spring_constant > 0.0 ? 1.0 / options_.spring_constant : 0.0;
    const bool goes_on = compliance_ > 0.0 && branch_.grip_fold < branch_.load_fold;
    end_ = goes_on ? where_steep(NT_FIT_STEEPEST / compliance_) : branch_.load_fold;
    const nt_fit_state end = row_.at(&branch_, end_);
    const double stiffness = goes_on ? end.F1 / end.indentation1 : 0.0;
    end_base_ = end.indentation + compliance_ * end.F;
    end_slope_ = stiffness / (1.0 + compliance_ * stiffness);
    differentiate(end, stiffness, &end_point_);
    prepared_ = true;
    return NT_OK;
}

// s at which delta + F/k_c, which grows with s, is `base`; the state there.
nt_status ContactModel::search(double base, double start, double *s, nt_fit_state *state) const
{
    double lo = end_, hi = std::numeric_limits<double>::infinity();
    *s = std::max(start, lo);
    for (int i = 0; i < max_iterations; i++) {
        *state = row_.at(&branch_, *s);
        const double excess = state->indentation + compliance_ * state->F - base;
        const double step = -excess / (state->indentation1 + compliance_ * state->F1);
        const double next = *s + step;
        const double resolution = 1e-15 * (std::fabs(state->indentation) + std::fabs(base));
        if (std::fabs(step) <= linear * std::fabs(*s) || std::fabs(excess) <= resolution) {
            state->F += state->F1 * step;
            state->indentation += state->indentation1 * step;
            return NT_OK;
        }
        (excess > 0.0 ? hi : lo) = *s;
        if (next > lo && next < hi)
            *s = next;
        else
            *s = std::isinf(hi) ? 4.0 * std::fabs(*s) + branch_.unit : 0.5 * (lo + hi);
    }
    return NT_E_NO_CONVERGENCE;
}

nt_status ContactModel::at(double position, const Cubic &near, Place *place, Point *point) const
{
    const double base = position - value_[NT_FIT_CONTACT_POINT];
    if (std::isnan(base))
        return NT_E_NOT_FINITE;
    if (base <= end_base_) {
        *point = end_point_;
        point->held = false;
        point->indentation += base - end_base_; /* as if the force stayed */
        const double gained = end_slope_ * (base - end_base_) / value_[NT_FIT_SENSITIVITY];
        point->force += gained;
        point->gradient[NT_FIT_SENSITIVITY] -= gained;
        if (end_slope_ < 0.0 && point->force > 0.0) { /* apart */
            point->force = 0.0;
            point->gradient.fill(0.0);
        }
        add_background(position, point);
        return NT_OK;
    }
    double s;
    nt_fit_state state;
    const nt_status status = search(base, near.at(position), &s, &state);
    if (status != NT_OK)
        return status;
    if (place)
        *place = {position, s, 1.0 / (state.indentation1 + compliance_ * state.F1), true};
    differentiate(state, state.F1 / state.indentation1, point);
    add_background(position, point);
    return NT_OK;
}

// Every so many points one after the other; those between from the cubic through them, each by itself, which a
// processor computes side by side.
nt_status ContactModel::points_at(const nt_fit_data &data, std::vector<Point> *points) const
{
    points->resize(static_cast<std::size_t>(data.count));
    const auto position = [&](long i) { return data.position[i * data.position_stride]; };
    const auto point = [&](long i) { return &(*points)[static_cast<std::size_t>(i)]; };
    Place before, last;
    nt_status status = at(position(0), Cubic(before, last, anywhere()), &last, point(0));
    for (long first = 0; first + 1 < data.count && status == NT_OK; first += spacing) {
        const long end = std::min(first + spacing, data.count - 1);
        Place next;
        status = at(position(end), Cubic(before, last, anywhere()), &next, point(end));
        const Cubic between = next.known ? Cubic(last, next, anywhere()) : Cubic(before, last, anywhere());
        for (long i = first + 1; i < end && status == NT_OK; i++)
            status = at(position(i), between, nullptr, point(i));
        before = last;
        last = next;
    }
    return status;
}

nt_status ContactModel::tear(Tear *tear) const
{
    if (!(row_.words.pull_off > 0.0) || compliance_ == 0.0)
        return NT_E_UNSUPPORTED;
    const bool goes_on = branch_.grip_fold < branch_.load_fold;
    const double s = goes_on ? where_steep(1e12 / compliance_) : branch_.load_fold;
    const nt_fit_state state = row_.at(&branch_, s);
    tear->position = value_[NT_FIT_CONTACT_POINT] + state.indentation + compliance_ * state.F;
    tear->steep = std::max(end_base_ - (state.indentation + compliance_ * state.F), 0.0);
    tear->gradient.fill(0.0);
    row_.derive(&state, goes_on ? -1.0 / compliance_ : 0.0, tear->gradient.data());
    for (int i = 0; i < NT_FIT_OWN; i++)
        tear->gradient[static_cast<std::size_t>(i)] *= compliance_;
    tear->gradient[NT_FIT_CONTACT_POINT] = 1.0;
    return NT_OK;
}

nt_status ContactModel::travel(double force, double *travel) const
{
    double indentation = not_a_number;
    const nt_status status = row_.indentation(&branch_, force, &indentation);
    if (status == NT_OK)
        *travel = indentation + compliance_ * force;
    return status;
}

void ContactModel::describe(double deepest, nt_fit_result *result) const
{
    result->pull_off_force = branch_.pull_off;
    result->transition_parameter = branch_.lambda;
    result->contact_radius = result->contact_stiffness = not_a_number;
    Point point;
    if (at(deepest, Cubic({}, {}, anywhere()), nullptr, &point) != NT_OK)
        return;
    const nt_law_value there = row_.contact(&branch_, point.indentation);
    result->contact_radius = there.a;
    result->contact_stiffness = there.k;
}

} // namespace nanotouch
