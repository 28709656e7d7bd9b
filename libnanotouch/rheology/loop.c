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
#include "nanotouch/viscoelastic_loop.h"
#include "rheology/springs.h"

#define FLOOR                                                                                                          \
    1e-25 /* what is added and taken away leaves multiples of 1e-41 m: no denormal number, which would be slow */

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
    nt_springs_place(&profile, demand->max_indentation, bed->springs, bed->depth, bed->weight);
    return NT_OK;
}

/* Relaxes z of the first springs; held: Sum E_k z + E_inf u, their force if they stayed where they are. */
NT_VARIANTS static void relax(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, int count, double *held)
{
    for (int i = 0; i < count; i++)
        held[i] = bed->equilibrium_modulus * state->u[i];
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

nt_status nt_viscoelastic_advance(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double indentation)
{
    double way[NT_LOOP_SPRINGS];
    if (!isfinite(indentation))
        return NT_E_NOT_FINITE;
    if (indentation > bed->max_indentation)
        return NT_E_RANGE;
    while (state->touched < bed->springs && bed->depth[state->touched] < indentation)
        state->touched++;
    state->indentation = indentation;
    relax(bed, state, state->touched, way);
    move(bed, state, state->touched, way);
    follow(bed, state, state->touched, way);
    return NT_OK;
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
