/* SPDX-License-Identifier: BSD-3-Clause
 * A tick of springs: z <- rho z + phi (u - u_old), f = E_inf u + Sum E_k z. One that is not pressed moves so that f =
 * 0; the tip presses those that it is deeper than.
 *
 * No energy comes out. Of an arm: E z' du - E/2 (z'^2 - z^2) >= 0 for any z and du, z' = rho z + phi du, if rho^2 + (1
 * - phi)^2 <= 1, which exp(-x) and (1 - exp(-x))/x fulfil for all x >= 0; of E_inf it is E_inf/2 du^2. A spring that
 * the tip meets moves less than the tip does, so that the tip's work is not less than what the spring takes. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "core/variants.h"
#include "internal/field.h"
#include "internal/rheology.h"
#include "nanotouch/rheology.h"
#include "rheology/loop.h"
#include "rheology/springs.h"

#define FLOOR                                                                                                          \
    1e-25 /* what is added and taken away leaves multiples of 1e-41 m: no denormal number, which would be slow */

#define SAME_ARMS 1e-12 /* of exp(-period/tau) */

static const nt_field fields[] = {
    NT_FIELD(nt_viscoelastic_demand, period, "s", 1e-7, 1.0, "of a tick"),
    NT_FIELD(nt_viscoelastic_demand, max_indentation, "m", 1e-12, 1e-3, "max indentation"),
    NT_FIELD(nt_viscoelastic_demand, longest_time, "s", 1e-6, 1e9, "over which the sample's memory counts"),
    NT_FIELD(nt_viscoelastic_demand, kernel_error, "", 1e-8, 0.1, "of E(t) from one period on"),
};

nt_viscoelastic_demand nt_viscoelastic_demand_defaults(void)
{
    return (nt_viscoelastic_demand){1e-3, 1e-6, 100.0, 1e-3, 64};
}

static nt_status refuse(nt_problem *problem, nt_status status, nt_problem found)
{
    if (problem != NULL)
        *problem = found;
    return status;
}

static nt_status check(const nt_viscoelastic *contact, const nt_viscoelastic_demand *demand, nt_problem *problem)
{
    nt_status status = nt_viscoelastic_check(contact, problem);
    if (status == NT_OK)
        status = nt_field_check(fields, (int)(sizeof fields / sizeof fields[0]), demand, problem);
    if (status != NT_OK)
        return status;
    if (demand->springs < 8 || demand->springs > NT_LOOP_SPRINGS)
        return refuse(problem, NT_E_RANGE, nt_problem_of("springs", "", demand->springs, 8.0, NT_LOOP_SPRINGS));
    if (!(demand->longest_time > demand->period))
        return refuse(problem, NT_E_RANGE,
                      nt_problem_of("longest_time", "s", demand->longest_time, demand->period, 1e9));
    const double deepest = nt_profile_make(&contact->shape, contact->thickness).deepest;
    if (demand->max_indentation > deepest)
        return refuse(problem, NT_E_RANGE,
                      nt_problem_of("max_indentation", "m", demand->max_indentation, 0.0, deepest));
    return NT_OK;
}

nt_status nt_viscoelastic_bed_make(const nt_viscoelastic *contact, const nt_viscoelastic_demand *demand,
                                   nt_viscoelastic_bed *bed, nt_problem *problem)
{
    return nt_viscoelastic_bed_graded(contact, demand, 1.0, bed, problem);
}

nt_status nt_viscoelastic_bed_graded(const nt_viscoelastic *contact, const nt_viscoelastic_demand *demand,
                                     double grading, nt_viscoelastic_bed *bed, nt_problem *problem)
{
    nt_spectrum spectrum;
    nt_status status = check(contact, demand, problem);
    if (status != NT_OK)
        return status;
    const nt_time_range range = {demand->period, demand->longest_time};
    status = nt_rheology_discretize(&contact->rheology, &range, demand->kernel_error, &spectrum);
    if (status != NT_OK || spectrum.count > NT_LOOP_ARMS)
        return refuse(problem, NT_E_CAPACITY,
                      nt_problem_of("kernel_error", "", demand->kernel_error, spectrum.error, 0.1));
    *bed = (nt_viscoelastic_bed){.arms = spectrum.count,
                                 .period = demand->period,
                                 .max_indentation = demand->max_indentation,
                                 .factor = 1.0 / (1.0 - contact->poisson_ratio * contact->poisson_ratio),
                                 .equilibrium_modulus = spectrum.equilibrium_modulus,
                                 .modulus_over_period = spectrum.equilibrium_modulus,
                                 .kernel_error = spectrum.error};
    for (int k = 0; k < spectrum.count; k++) {
        const double x = demand->period * spectrum.rates[k];
        bed->moduli[k] = spectrum.moduli[k];
        bed->decay[k] = exp(-x);
        bed->follow[k] = -expm1(-x) / x;
        bed->modulus_over_period += bed->moduli[k] * bed->follow[k];
    }
    const nt_profile profile = nt_profile_make(&contact->shape, contact->thickness);
    bed->springs = contact->shape.kind == NT_SHAPE_PUNCH ? 1 : demand->springs;
    nt_springs_place(&profile, demand->max_indentation, grading, bed->springs, bed->depth, bed->weight);
    return NT_OK;
}

/* Relaxes z of the springs that were touched; held: Sum E_k z + E_inf u, their force if they stayed where they are. */
NT_VARIANTS static void relax(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double *held)
{
    const int count = state->touched;
    for (int i = 0; i < count; i++)
        held[i] = bed->equilibrium_modulus * state->u[i];
    for (int i = count; i < bed->springs; i++)
        held[i] = 0.0;
    for (int k = 0; k < bed->arms; k++) {
        const double decay = bed->decay[k], modulus = bed->moduli[k];
        double *restrict z = state->z[k];
        for (int i = 0; i < count; i++) {
            z[i] = (z[i] * decay + FLOOR) - FLOOR;
            held[i] += modulus * z[i];
        }
    }
}

/* Where the springs go: with the tip, or to where they carry no force. */
static void move(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, int count, double *way)
{
    const double A = bed->modulus_over_period, tip = state->indentation;
    double force = 0.0, reached = 0.0;
    state->pressed = 0;
    for (int i = 0; i < count; i++) {
        const double held = way[i], free = -held / A, pressed = tip - bed->depth[i] - state->u[i];
        way[i] = free;
        if (pressed > free) {
            way[i] = pressed;
            force += bed->weight[i] * (held + A * pressed);
            reached += bed->weight[i];
            state->pressed++;
        }
        state->u[i] += way[i];
    }
    state->force = bed->factor * force;
    state->stiffness = bed->factor * A * reached;
}

NT_VARIANTS static void follow(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, int count,
                               const double *way)
{
    for (int k = 0; k < bed->arms; k++) {
        const double phi = bed->follow[k];
        double *restrict z = state->z[k];
        for (int i = 0; i < count; i++)
            z[i] += phi * way[i];
    }
}

void nt_viscoelastic_begin(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double *held)
{
    relax(bed, state, held);
}

NT_VARIANTS nt_law_value nt_viscoelastic_at(const nt_viscoelastic_bed *bed, const nt_viscoelastic_state *state,
                                            const double *held, double indentation)
{
    const double A = bed->modulus_over_period;
    double forces[NT_LANES] = {0.0}, reached[NT_LANES] = {0.0};
    if (!(indentation > 0.0) && state->touched == 0)
        return (nt_law_value){0.0 * indentation, 0.0, 0.0, 0.0};
    for (int start = 0; start < bed->springs; start += NT_LANES) {
        const int count = nt_lanes_from(start, bed->springs);
        const double *depth = bed->depth + start, *u = state->u + start, *w = bed->weight + start;
        const double *f = held + start;
        for (int j = 0; j < count; j++) {
            const double force = f[j] + A * (indentation - depth[j] - u[j]);
            forces[j] += force > 0.0 ? w[j] * force : 0.0;
            reached[j] += force > 0.0 ? w[j] : 0.0;
        }
    }
    const double width = nt_lanes_sum(reached); /* 2 a */
    return (nt_law_value){
        .U = 0.0, .F = bed->factor * nt_lanes_sum(forces), .k = bed->factor * A * width, .a = 0.5 * width};
}

void nt_viscoelastic_end(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double *held, double indentation)
{
    while (state->touched < bed->springs && bed->depth[state->touched] < indentation)
        state->touched++;
    state->indentation = indentation;
    move(bed, state, state->touched, held);
    follow(bed, state, state->touched, held);
}

nt_status nt_viscoelastic_advance(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double indentation)
{
    double held[NT_LOOP_SPRINGS];
    if (!isfinite(indentation))
        return NT_E_NOT_FINITE;
    if (indentation > bed->max_indentation)
        return NT_E_RANGE;
    nt_viscoelastic_begin(bed, state, held);
    nt_viscoelastic_end(bed, state, held, indentation);
    return NT_OK;
}

/* Do both follow the same times? */
static int has_same_arms(const nt_viscoelastic_bed *a, const nt_viscoelastic_bed *b)
{
    int same = a->arms == b->arms;
    for (int k = 0; k < a->arms && same; k++)
        same = fabs(a->decay[k] - b->decay[k]) <= SAME_ARMS;
    return same;
}

void nt_viscoelastic_carry(const nt_viscoelastic_bed *from, const nt_viscoelastic_state *state,
                           const nt_viscoelastic_bed *to, nt_viscoelastic_state *carried)
{
    nt_viscoelastic_state made = {.touched = 0};
    const int last = from ? state->touched - 1 : -1, keeps = from && has_same_arms(from, to);
    for (int i = 0, j = 0; i < to->springs && last >= 0 && to->depth[i] <= from->depth[last]; i++) {
        while (j < last && from->depth[j + 1] < to->depth[i])
            j++;
        const int next = j < last ? j + 1 : j;
        const double apart = from->depth[next] - from->depth[j];
        const double part = apart > 0.0 ? fmax((to->depth[i] - from->depth[j]) / apart, 0.0) : 0.0;
        made.u[i] = state->u[j] + part * (state->u[next] - state->u[j]);
        for (int k = 0; k < to->arms && keeps; k++)
            made.z[k][i] = state->z[k][j] + part * (state->z[k][next] - state->z[k][j]);
        made.touched = i + 1;
    }
    made.pressed = state->pressed;
    made.indentation = state->indentation;
    *carried = made;
}

void nt_viscoelastic_rest(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double indentation)
{
    nt_viscoelastic_state made = {.indentation = indentation};
    while (made.touched < bed->springs && bed->depth[made.touched] < indentation) {
        made.u[made.touched] = indentation - bed->depth[made.touched];
        made.touched++;
    }
    made.pressed = made.touched;
    *state = made;
}

double nt_viscoelastic_stored(const nt_viscoelastic_bed *bed, const nt_viscoelastic_state *state)
{
    double sum = 0.0;
    for (int i = 0; i < state->touched; i++) {
        double of = bed->equilibrium_modulus * state->u[i] * state->u[i];
        for (int k = 0; k < bed->arms; k++)
            of += bed->moduli[k] * state->z[k][i] * state->z[k][i];
        sum += 0.5 * bed->weight[i] * of;
    }
    return bed->factor * sum;
}

double nt_viscoelastic_max_stiffness(const nt_viscoelastic_bed *bed, double indentation)
{
    double reached = 0.0;
    for (int i = 0; i < bed->springs && bed->depth[i] < indentation; i++)
        reached += bed->weight[i];
    return isnan(indentation) ? (double)NAN : bed->factor * bed->modulus_over_period * reached;
}
