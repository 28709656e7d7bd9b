// SPDX-License-Identifier: BSD-3-Clause
// The force at a position and its derivatives.
//
// Derivatives at constant delta. In Maugis' units F = S_P p(d; lambda), d = delta/S_d with S_P = pi w R,
// S_d = (pi^2 w^2 R/K^2)^(1/3) and lambda = 2 (w/h0) (R/(pi w K^2))^(1/3), so that with Lambda = S_P lambda
// dp/dlambda|_d
//
//     dF/d ln E* = 2/3 (k delta - Lambda)     dF/d ln w = F - 2/3 (k delta - Lambda)     dF/d ln h0 = -Lambda (scaling)
//
// for every model; Lambda = 0 without a range of adhesion. For Maugis-Dugdale, dp/dlambda|_d = p_lambda - k d_lambda at
// constant branch parameter y. Differentiating (Griffith) of contact/maugis_branch.c by lambda gives, with
// q = 4/3 lambda^2 g2 b and r = (1 + q)/(2 - q),
//
//     lambda b_lambda = -r b     lambda p_lambda = p (1 - 2r) - a^3 (1 + r)     lambda d_lambda = d (1 - r) - a^2 (1 +
//     r)
//
// At constant position, (cantilever) of fit.h turns dF into (dF - k ddelta0 - k F c/k_c dln c)/(1 + c k/k_c).
#include "model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nanotouch
{

namespace
{

constexpr int max_iterations = 100;
constexpr double linear = 1e-9; // of s: over a step that small the branch is straight to the last bit

nt_status indentation_at(const nt_contact_law &law, double force, double *indentation)
{
    const nt_contact *contact = &law.maugis.contact;
    switch (law.model) {
    case NT_HERTZ:
        *indentation = nt_hertz_indentation(contact, force);
        break;
    case NT_DMT:
        *indentation = nt_dmt_indentation(contact, force);
        break;
    case NT_JKR:
        return nt_jkr_indentation(contact, force, NT_BRANCH_STABLE, indentation);
    case NT_MAUGIS:
        return nt_maugis_indentation(&law.maugis, force, NT_BRANCH_STABLE, indentation, nullptr);
    }
    return std::isfinite(*indentation) ? NT_OK : NT_E_NO_SOLUTION;
}

} // namespace

double Track::predict(double position, double otherwise) const
{
    const double travel = position - position_;
    return known_ ? s_ + travel * (slope_ + 0.5 * travel * bend_) : otherwise;
}

void Track::add(double position, double s, double slope)
{
    bend_ = known_ && position != position_ ? (slope - slope_) / (position - position_) : 0.0;
    known_ = true;
    position_ = position;
    s_ = s;
    slope_ = slope;
}

nt_status Model::law_value(double indentation, nt_law_value *value) const
{
    return nt_contact_law_eval(&law_, indentation, NT_BRANCH_STABLE, value);
}

nt_status Model::travel(double force, double *travel) const
{
    double indentation = 0.0;
    const nt_status status = indentation_at(law_, force, &indentation);
    if (status == NT_OK)
        *travel = indentation + compliance_ * force;
    return status;
}

void Model::differentiate(const nt_fit_state &state, double stiffness, Point *point) const
{
    const double elastic = 2.0 / 3.0 * (stiffness * state.indentation - state.range);
    const double softening = 1.0 / (1.0 + compliance_ * stiffness);
    point->force = state.F + value_[NT_FIT_FORCE_OFFSET];
    point->indentation = state.indentation;
    point->gradient[NT_FIT_EFFECTIVE_MODULUS] = softening * elastic;
    point->gradient[NT_FIT_WORK_OF_ADHESION] = softening * (state.F - elastic);
    point->gradient[NT_FIT_COHESIVE_RANGE] = softening * -state.range;
    point->gradient[NT_FIT_CONTACT_POINT] = softening * -stiffness;
    point->gradient[NT_FIT_FORCE_OFFSET] = 1.0;
    point->gradient[NT_FIT_COMPLIANCE] = softening * -stiffness * state.F * compliance_;
}

nt_status Model::prepare(const nt_fit_options &options, const Parameters &value)
{
    nt_contact contact{options.radius, value[NT_FIT_EFFECTIVE_MODULUS], 0.0, 0.0};
    if (options.model != NT_HERTZ)
        contact.work_of_adhesion = value[NT_FIT_WORK_OF_ADHESION];
    if (options.model == NT_MAUGIS)
        contact.cohesive_stress = value[NT_FIT_WORK_OF_ADHESION] / value[NT_FIT_COHESIVE_RANGE];
    const nt_status status = nt_contact_law_init(&law_, options.model, &contact);
    if (status != NT_OK)
        return status;
    value_ = value;
    compliance_ = options.spring_constant > 0.0 ? value[NT_FIT_COMPLIANCE] / options.spring_constant : 0.0;
    branch_ = nt_fit_branch_of(&law_);
    nt_fit_state load_fold = nt_fit_branch_at(&branch_, branch_.start);
    load_fold.F = -nt_contact_law_pull_off_force(&law_); // the branch gives it but for rounding
    differentiate(load_fold, 0.0, &pull_off_);
    return NT_OK;
}

// s at which delta + F c/k_c, which grows with s, is `base`; the state there.
nt_status Model::search(double base, double start, double *s, nt_fit_state *state) const
{
    double lo = branch_.start, hi = std::numeric_limits<double>::infinity();
    *s = std::max(start, lo);
    for (int i = 0; i < max_iterations; i++) {
        *state = nt_fit_branch_at(&branch_, *s);
        const double excess = state->indentation + compliance_ * state->F - base;
        const double step = -excess / (state->indentation1 + compliance_ * state->F1);
        const double next = *s + step;
        const double resolution = 1e-15 * (std::fabs(state->indentation) + std::fabs(base));
        if (std::fabs(step) <= linear * *s || std::fabs(excess) <= resolution) {
            state->F += state->F1 * step;
            state->indentation += state->indentation1 * step;
            return NT_OK;
        }
        (excess > 0.0 ? hi : lo) = *s;
        if (next > lo && next < hi)
            *s = next;
        else
            *s = std::isinf(hi) ? 4.0 * *s + branch_.unit : 0.5 * (lo + hi);
    }
    return NT_E_NO_CONVERGENCE;
}

nt_status Model::at(double position, Track *track, Point *point) const
{
    const double base = position - value_[NT_FIT_CONTACT_POINT];
    const double excess = base + compliance_ * nt_contact_law_pull_off_force(&law_) - pull_off_.indentation;
    if (std::isnan(excess))
        return NT_E_NOT_FINITE;
    if (excess <= 0.0) {
        *point = pull_off_;
        point->indentation += excess;
        return NT_OK;
    }
    double s;
    nt_fit_state state;
    const nt_status status = search(base, track->predict(position, branch_.start + branch_.unit), &s, &state);
    if (status != NT_OK)
        return status;
    track->add(position, s, 1.0 / (state.indentation1 + compliance_ * state.F1));
    differentiate(state, state.F1 / state.indentation1, point);
    return NT_OK;
}

} // namespace nanotouch
