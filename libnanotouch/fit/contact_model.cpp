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
constexpr long spacing = 8;     // points, of those that are searched one from the other
constexpr long few = 32;        // points that are all searched so
constexpr int together = 2;     // of Newton's steps, before those that have not settled are searched
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

// Where the base stands at a position; unknown on the straight continuation.
nt_status ContactModel::find(double position, const Cubic &near, Place *place) const
{
    *place = Place{};
    const double base = position - value_[NT_FIT_CONTACT_POINT];
    if (std::isnan(base))
        return NT_E_NOT_FINITE;
    if (base <= end_base_)
        return NT_OK;
    double s;
    nt_fit_state state;
    const nt_status status = search(base, near.at(position), &s, &state);
    *place = {position, s, 1.0 / (state.indentation1 + compliance_ * state.F1), status == NT_OK};
    return status;
}

// The last of every so many points is searched from those before; the others start from the cubic through these.
nt_status ContactModel::start_block(const nt_fit_data &data, long first, Walk *walk, nt_fit_many *many) const
{
    const auto position = [&](long i) { return data.position[(first + i) * data.position_stride]; };
    nt_status status = NT_OK;
    const long count = many->at.count;
    for (long start = 0; start < count && status == NT_OK; start += spacing) {
        const long end = std::min(start + spacing, count);
        Place next;
        status = find(position(end - 1), Cubic(walk->before, walk->last, anywhere()), &next);
        const Cubic between =
            next.known ? Cubic(walk->last, next, anywhere()) : Cubic(walk->before, walk->last, anywhere());
        for (long i = start; i < end; i++) {
            const double base = position(i) - value_[NT_FIT_CONTACT_POINT];
            if (std::isnan(base))
                return NT_E_NOT_FINITE;
            const bool is_held = base > end_base_;
            many->base[i] = is_held ? base : end_base_;
            many->at.s[i] = is_held ? std::max(between.at(position(i)), end_) : end_;
            many->from[i] = position(i) - options_.tilt_position;
        }
        *walk = {walk->last, next};
    }
    return status;
}

// By Newton's method side by side; what does not settle, one by one.
nt_status ContactModel::solve_block(nt_fit_many *many) const
{
    row_.many(&branch_, &many->at);
    int far = nt_fit_many_step(many);
    for (int i = 0; far && i < together; i++) {
        nt_fit_many_move(many, end_);
        row_.many(&branch_, &many->at);
        far = nt_fit_many_step(many);
    }
    nt_status status = NT_OK;
    for (int i = 0; far && i < many->at.count && status == NT_OK; i++) {
        if (!nt_fit_many_moves(many, i))
            continue;
        nt_fit_state state;
        status = search(many->base[i], many->at.s[i], &many->at.s[i], &state);
        many->at.F[i] = state.F;
        many->at.indentation[i] = state.indentation;
        many->at.F1[i] = state.F1;
        many->at.indentation1[i] = state.indentation1;
        many->at.range[i] = state.range;
        many->step[i] = 0.0;
    }
    return status;
}

nt_status ContactModel::write_block(const nt_fit_data &data, long first, const nt_fit_many &many, Points *points) const
{
    const auto write = [&](const double *from, std::vector<double> *to) {
        std::copy_n(from, many.at.count, to->begin() + first);
    };
    write(many.force, &points->force);
    write(many.at.indentation, &points->indentation);
    write(many.by_modulus, &points->gradient[NT_FIT_EFFECTIVE_MODULUS]);
    if (row_.parameter[NT_FIT_WORK_OF_ADHESION].name)
        write(many.by_work, &points->gradient[NT_FIT_WORK_OF_ADHESION]);
    if (row_.parameter[NT_FIT_COHESIVE_RANGE].name)
        write(many.by_range, &points->gradient[NT_FIT_COHESIVE_RANGE]);
    write(many.by_place, &points->gradient[NT_FIT_CONTACT_POINT]);
    write(many.by_sensitivity, &points->gradient[NT_FIT_SENSITIVITY]);
    write(many.from, &points->gradient[NT_FIT_FORCE_TILT]);
    for (long i = first; i < first + many.at.count; i++) {
        const double position = data.position[i * data.position_stride];
        points->gradient[NT_FIT_FORCE_OFFSET][static_cast<std::size_t>(i)] = 1.0;
        points->held[static_cast<std::size_t>(i)] = 1;
        Point point;
        if (position - value_[NT_FIT_CONTACT_POINT] > end_base_)
            continue;
        const nt_status status = at(position, Cubic({}, {}, end_), nullptr, &point);
        if (status != NT_OK)
            return status;
        points->set(static_cast<std::size_t>(i), point);
    }
    return NT_OK;
}

nt_status ContactModel::one_by_one(const nt_fit_data &data, Points *points) const
{
    Walk walk;
    nt_status status = NT_OK;
    for (long i = 0; i < data.count && status == NT_OK; i++) {
        Place next;
        Point point;
        status = at(data.position[i * data.position_stride], Cubic(walk.before, walk.last, anywhere()), &next, &point);
        points->set(static_cast<std::size_t>(i), point);
        walk = {walk.last, next};
    }
    return status;
}

nt_status ContactModel::points_at(const nt_fit_data &data, Points *points) const
{
    points->resize(static_cast<std::size_t>(data.count));
    if (!row_.many || data.count < few)
        return one_by_one(data, points);
    Walk walk;
    nt_fit_many many;
    many.lever = {compliance_, value_[NT_FIT_SENSITIVITY], value_[NT_FIT_FORCE_OFFSET], value_[NT_FIT_FORCE_TILT]};
    std::fill_n(many.at.range, NT_FIT_BLOCK, 0.0);
    nt_status status = NT_OK;
    for (long first = 0; first < data.count && status == NT_OK; first += NT_FIT_BLOCK) {
        many.at.count = static_cast<int>(std::min<long>(NT_FIT_BLOCK, data.count - first));
        status = start_block(data, first, &walk, &many);
        if (status == NT_OK)
            status = solve_block(&many);
        if (status != NT_OK)
            break;
        nt_fit_many_show(&many);
        status = write_block(data, first, many, points);
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
