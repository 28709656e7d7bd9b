// SPDX-License-Identifier: BSD-3-Clause
// The force at a position and its derivatives.
//
// Derivatives at constant delta. In Maugis' units F = S_P p(d; lambda), d = delta/S_d with S_P = pi w R,
// S_d = (pi^2 w^2 R/K^2)^(1/3) and lambda = 2 (w/h0) (R/(pi w K^2))^(1/3), so that with Lambda = S_P lambda dp/dlambda|_d
//
//     dF/d ln E* = 2/3 (k delta - Lambda)     dF/d ln w = F - 2/3 (k delta - Lambda)     dF/d ln h0 = -Lambda     (scaling)
//
// for every model; Lambda = 0 without a range of adhesion. For Maugis-Dugdale, dp/dlambda|_d = p_lambda - k d_lambda at
// constant branch parameter y. Differentiating (Griffith) of contact/maugis_branch.c by lambda gives, with
// q = 4/3 lambda^2 g2 b and r = (1 + q)/(2 - q),
//
//     lambda b_lambda = -r b     lambda p_lambda = p (1 - 2r) - a^3 (1 + r)     lambda d_lambda = d (1 - r) - a^2 (1 + r)
//
// At constant position, (cantilever) of fit.h turns dF into (dF - k ddelta0 - k F c/k_c dln c)/(1 + c k/k_c).
#include "model.hpp"

#include <algorithm>
#include <cmath>

namespace nanotouch {

namespace {

constexpr int max_iterations = 100;

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

// Lambda of (scaling) [N], from a point on the contact branch.
double range_derivative(const nt_maugis &maugis, double indentation, const nt_law_value &value)
{
    const double lambda = maugis.lambda;
    const double a = value.a / maugis.radius_scale, d = indentation / maugis.indentation_scale;
    const double P = value.F / maugis.load_scale, k = value.k * maugis.indentation_scale / maugis.load_scale;
    const double b = (a * a - d) / (4.0 / 3.0 * lambda), y = a / b;
    const double g2 = std::atan2(1.0, y) - 1.0 / (y + std::sqrt(1.0 + y * y));
    const double q = std::clamp(4.0 / 3.0 * lambda * lambda * g2 * b, 0.0, 1.0);  // rounding only
    const double r = (1.0 + q) / (2.0 - q);
    const double load = P * (1.0 - 2.0 * r) - a * a * a * (1.0 + r);
    const double depth = d * (1.0 - r) - a * a * (1.0 + r);
    return maugis.load_scale * (load - k * depth);
}

}  // namespace

nt_status Model::law_value(double indentation, nt_law_value *value) const
{
    return nt_contact_law_eval(&law_, indentation, NT_BRANCH_STABLE, value);
}

nt_status Model::travel(double force, double *travel) const
{
    double indentation;
    const nt_status status = indentation_at(law_, force, &indentation);
    if (status == NT_OK)
        *travel = indentation + compliance_ * force;
    return status;
}

void Model::differentiate(double indentation, const nt_law_value &value, Point *point) const
{
    const double range = law_.model == NT_MAUGIS ? range_derivative(law_.maugis, indentation, value) : 0.0;
    const double elastic = 2.0 / 3.0 * (value.k * indentation - range);
    const double softening = 1.0 / (1.0 + compliance_ * value.k);
    point->force = value.F + value_[NT_FIT_FORCE_OFFSET];
    point->indentation = indentation;
    point->gradient[NT_FIT_EFFECTIVE_MODULUS] = softening * elastic;
    point->gradient[NT_FIT_WORK_OF_ADHESION] = softening * (value.F - elastic);
    point->gradient[NT_FIT_COHESIVE_RANGE] = softening * -range;
    point->gradient[NT_FIT_CONTACT_POINT] = softening * -value.k;
    point->gradient[NT_FIT_FORCE_OFFSET] = 1.0;
    point->gradient[NT_FIT_COMPLIANCE] = softening * -value.k * value.F * compliance_;
}

nt_status Model::prepare_load_fold()
{
    nt_status status = NT_OK;
    if (law_.model == NT_MAUGIS)
        load_fold_indentation_ = law_.maugis.folds.pull_off_indentation * law_.maugis.indentation_scale;
    else
        status = indentation_at(law_, -nt_contact_law_pull_off_force(&law_), &load_fold_indentation_);
    nt_law_value value;
    if (status == NT_OK)
        status = law_value(load_fold_indentation_, &value);
    if (status != NT_OK)
        return status;
    value.k = 0.0;  // the law gives both but for rounding
    value.F = -nt_contact_law_pull_off_force(&law_);
    differentiate(load_fold_indentation_, value, &pull_off_);
    return NT_OK;
}

nt_status Model::prepare(const nt_fit_options &options, const Parameters &value)
{
    nt_contact contact{options.radius, value[NT_FIT_EFFECTIVE_MODULUS], 0.0, 0.0};
    if (options.model != NT_HERTZ)
        contact.work_of_adhesion = value[NT_FIT_WORK_OF_ADHESION];
    if (options.model == NT_MAUGIS)
        contact.cohesive_stress = value[NT_FIT_WORK_OF_ADHESION] / value[NT_FIT_COHESIVE_RANGE];
    nt_status status = nt_contact_law_init(&law_, options.model, &contact);
    if (status != NT_OK)
        return status;
    value_ = value;
    compliance_ = options.spring_constant > 0.0 ? value[NT_FIT_COMPLIANCE] / options.spring_constant : 0.0;
    return prepare_load_fold();
}

nt_status Model::at(double position, double near, Point *point) const
{
    // h(delta) = delta + F c/k_c - base is increasing and convex between the load fold and `upper`, where it changes sign.
    const double base = position - value_[NT_FIT_CONTACT_POINT];
    const double upper = base + compliance_ * nt_contact_law_pull_off_force(&law_);
    if (std::isnan(upper))
        return NT_E_NOT_FINITE;
    if (upper <= load_fold_indentation_) {
        *point = pull_off_;
        point->indentation = upper;
        return NT_OK;
    }

    double lo = load_fold_indentation_, hi = upper;
    double delta = std::clamp(base - compliance_ * (near - value_[NT_FIT_FORCE_OFFSET]), lo, hi);
    nt_law_value value;
    for (int i = 0; i < max_iterations; i++) {
        const nt_status status = law_value(delta, &value);
        if (status != NT_OK)
            return status;
        const double excess = delta - base + compliance_ * value.F;
        (excess > 0.0 ? hi : lo) = delta;
        const double newton = delta - excess / (1.0 + compliance_ * value.k);
        const double next = newton >= lo && newton <= hi ? newton : 0.5 * (lo + hi);
        if (std::fabs(next - delta) <= 1e-12 * (std::fabs(delta) + std::fabs(base))) {
            value.F += value.k * (next - delta);  // the last step is so small that the law is linear over it
            differentiate(next, value, point);
            return NT_OK;
        }
        delta = next;
    }
    return NT_E_NO_CONVERGENCE;
}

}  // namespace nanotouch
