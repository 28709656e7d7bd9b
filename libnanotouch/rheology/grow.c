/* SPDX-License-Identifier: BSD-3-Clause
 * A step of a contact that grows: Z <- exp(-x) Z + Sum d_j psi_j. The lever's balance delta + F/k_c = base is solved by
 * Newton's steps on sums over the arms that are made once. */
#include <math.h>

#include "core/variants.h"
#include "rheology/run.h"

enum { ITERATIONS = 60 };
#define CONVERGED 1e-8
#define ROUNDING 1e-14

NT_VARIANTS double nt_run_relax(const nt_run *run, double *x, double (*x_by)[NT_ARMS], double *sum_by)
{
    const nt_arms *arms = &run->arms;
    const double *decay = run->step.decay;
    for (int p = 0; p < arms->parameters; p++) {
        const int arm = arms->arm[p];
        if (arm >= 0)
            x_by[p][arm] -= x[arm] * run->step.h * arms->rate_by[p];
        nt_arms_multiply(arms->width, x_by[p], decay);
        sum_by[p] = nt_arms_sum(arms->width, arms->modulus, x_by[p]);
    }
    nt_arms_multiply(arms->width, x, decay);
    for (int p = 0; p < arms->parameters; p++)
        sum_by[p] += nt_arms_sum(arms->width, arms->by[p], x);
    return nt_arms_sum(arms->width, arms->modulus, x);
}

/* From values at both ends and the integral. */
static void polynomial(double first, double last, double integral, double d[3])
{
    d[0] = first;
    d[2] = 3.0 * (first + last) - 6.0 * integral;
    d[1] = last - first - d[2];
}

void nt_run_piece(const nt_profile_value *from, const nt_profile_value *to, double length, double d[3])
{
    polynomial(from->slope * length, to->slope * length, to->g - from->g, d);
}

void nt_run_piece_by(const nt_profile_value *from, const nt_profile_value *to, double length, const double ends_by[2],
                     double d_by[3])
{
    const double longer = ends_by[1] - ends_by[0];
    polynomial(from->curvature * ends_by[0] * length + from->slope * longer,
               to->curvature * ends_by[1] * length + to->slope * longer,
               to->slope * ends_by[1] - from->slope * ends_by[0], d_by);
}

/* The new indentation, where the lever is in balance, and the profile there; `held` is Sum E_k Z_k before it. */
static nt_status solve(const nt_run *run, double held, double base, double *depth, nt_profile_value *end)
{
    const double *sum = run->step.sum, softness = run->compliance * run->factor, from = run->depth;
    double to = softness == 0.0 ? base : from + run->follows * fmax(base - run->base, 0.0); /* it grows */
    for (int i = 0; i < ITERATIONS; i++) {
        *end = nt_profile_at(&run->profile, to);
        if (softness == 0.0) {
            *depth = to;
            return NT_OK;
        }
        double d[3], slope[3];
        nt_run_piece(&run->value, end, to - from, d);
        nt_run_piece_by(&run->value, end, to - from, (double[2]){0.0, 1.0}, slope);
        const double force = held + d[0] * sum[0] + d[1] * sum[1] + d[2] * sum[2];
        const double stiffness = slope[0] * sum[0] + slope[1] * sum[1] + slope[2] * sum[2];
        const double change = -(to + softness * force - base) / (1.0 + softness * stiffness);
        const double rounding = softness * fabs(held) / (1.0 + softness * stiffness);
        if (fabs(change) <= CONVERGED * fabs(to) + ROUNDING * rounding) { /* what is left is its square */
            *depth = to + change;
            end->g += change * (end->slope + 0.5 * change * end->curvature);
            end->slope += change * end->curvature;
            return NT_OK;
        }
        to = to + change > 0.0 || run->profile.kind == NT_SHAPE_PUNCH ? to + change : 0.25 * to;
    }
    return NT_E_NO_CONVERGENCE;
}

/* Derivatives of the new indentation and force, and of Z. */
static void derive(nt_run *run, const double held_by[], const nt_profile_value ends[2], const double d[3], double to)
{
    const nt_step *step = &run->step;
    const double C = run->factor;
    for (int p = 0; p < run->arms.parameters; p++) {
        double fixed[3], moved[3], d_by[3], rest = held_by[p], stiffness = 0.0;
        const double length = to - run->depth, from_by = run->depth_by[p], position = p == 0 ? -1.0 : 0.0;
        nt_run_piece_by(&ends[0], &ends[1], length, (double[2]){from_by, 0.0}, fixed);
        nt_run_piece_by(&ends[0], &ends[1], length, (double[2]){0.0, 1.0}, moved);
        for (int j = 0; j < 3; j++) {
            rest += fixed[j] * step->sum[j] + d[j] * step->sum_by[p][j];
            stiffness += moved[j] * step->sum[j];
        }
        const double to_by = (position - run->compliance * C * rest) / (1.0 + run->compliance * C * stiffness);
        for (int j = 0; j < 3; j++)
            d_by[j] = fixed[j] + moved[j] * to_by;
        nt_arms_add_piece(run->arms.width, run->Z_by[p], d_by, step->psi);
        const int arm = run->arms.arm[p];
        for (int j = 0; j < 3 && arm >= 0; j++)
            run->Z_by[p][arm] += d[j] * step->psi_by[p][j];
        run->depth_by[p] = to_by;
        run->force_by[p] = C * (rest + stiffness * to_by);
    }
}

/* Another spring is reached. */
static nt_status keep(nt_run *run)
{
    if (run->edge + 1 >= run->capacity)
        return NT_E_CAPACITY;
    double *record = nt_run_record_at(run, ++run->edge);
    record[NT_RUN_TIME] = run->time;
    record[NT_RUN_DEPTH] = run->depth;
    record[NT_RUN_G] = run->value.g;
    record[NT_RUN_SLOPE] = run->value.slope;
    record[NT_RUN_CURVATURE] = run->value.curvature;
    for (int p = 0; p < run->arms.parameters; p++)
        record[NT_RUN_BY + p] = run->depth_by[p];
    return NT_OK;
}

/* A punch, whose springs leave all at once. */
static void leave(nt_run *run, double base)
{
    for (int k = 0; k < run->arms.width; k++)
        run->S[k] = run->Z[k] / run->profile.scale;
    run->dent = run->depth - nt_arms_sum(run->arms.width, run->arms.modulus, run->S) / run->step.sum[0];
    run->phase = NT_RUN_LEFT;
    run->depth = base;
    run->force = 0.0;
    for (int p = 0; p < run->arms.parameters; p++)
        run->force_by[p] = run->depth_by[p] = 0.0;
}

NT_VARIANTS nt_status nt_run_grow(nt_run *run, double time, double base)
{
    double held_by[NT_ARM_PARAMETERS], depth, d[3];
    nt_profile_value end;
    nt_step_to(&run->step, &run->arms, time - run->time);
    const nt_step *step = &run->step;
    const double held = nt_run_relax(run, run->Z, run->Z_by, held_by);
    const double stays = run->depth + run->compliance * run->factor * held; /* of the base, if the tip stayed */
    if (stays > base && run->profile.kind != NT_SHAPE_PUNCH)
        return nt_run_turn(run, time, base, held, held_by);
    const nt_status status = solve(run, held, base, &depth, &end);
    if (status != NT_OK)
        return status;
    nt_run_piece(&run->value, &end, depth - run->depth, d);
    run->force = run->factor * (held + d[0] * step->sum[0] + d[1] * step->sum[1] + d[2] * step->sum[2]);
    if (run->arms.parameters > 0)
        derive(run, held_by, (nt_profile_value[2]){run->value, end}, d, depth);
    nt_arms_add_piece(run->arms.width, run->Z, d, step->psi);
    run->follows = base > run->base ? (depth - run->depth) / (base - run->base) : 1.0;
    run->time = time;
    run->base = base;
    run->depth = depth;
    run->value = end;
    if (run->force < 0.0)
        leave(run, base);
    return run->profile.kind == NT_SHAPE_PUNCH ? NT_OK : keep(run);
}
