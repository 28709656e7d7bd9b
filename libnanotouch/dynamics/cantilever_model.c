/* SPDX-License-Identifier: BSD-3-Clause
 * Dynamic cantilever, prepared: the exact transitions of its linear part over a period and its halves, the thermal
 * motion that belongs to each, and what a quasi-static model would leave out. */
#include <math.h>
#include <stddef.h>

#include "core/rig.h"
#include "nanotouch/material.h"
#include "oscillator.h"

#define BOLTZMANN 1.380649e-23 /* k_B [J/K] */
#define STIFFEST 1e3           /* the finest sub-step resolves a contact of 1e6 k_c: its frequency over w0 */
#define QUADRATURE_STEP 0.01   /* w0 h up to which three Gauss points integrate the noise to 1e-13 */

/* Covariance of (zeta, zeta') [m^2, m^2/s, m^2/s^2]. */
typedef struct covariance {
    double xx, xv, vv;
} covariance;

/* Over a short step h: integral of g g^T q dt, g the answer to an impulse, q = 2 k_B T b/m^2. */
static covariance noise_of_short(const nt_oscillator_constants *c, double q, double h)
{
    static const double nodes[] = {0.1127016653792583115, 0.5, 0.8872983346207416885};
    static const double weights[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    covariance sum = {0.0, 0.0, 0.0};
    for (int i = 0; i < 3; i++) {
        const nt_oscillator o = nt_oscillator_over(c, nodes[i] * h);
        const double weight = q * h * weights[i];
        sum.xx += weight * o.xv * o.xv;
        sum.xv += weight * o.xv * o.vv;
        sum.vv += weight * o.vv * o.vv;
    }
    return sum;
}

/* Over twice the step: N + Phi N Phi^T; only sums of squares, so that nothing cancels. */
static covariance noise_doubled(const nt_oscillator_constants *c, const covariance *n, double h)
{
    const nt_oscillator o = nt_oscillator_over(c, h);
    const double a = 1.0 - o.xf * o.k, d = -o.vf * o.k;
    const double xx = a * n->xx + o.xv * n->xv, xv = a * n->xv + o.xv * n->vv;
    const double vx = d * n->xx + o.vv * n->xv, vv = d * n->xv + o.vv * n->vv;
    return (covariance){n->xx + xx * a + xv * o.xv, n->xv + xx * d + xv * o.vv, n->vv + vx * d + vv * o.vv};
}

static void set_noise(double noise[3], const covariance *n)
{
    noise[0] = sqrt(n->xx);
    noise[1] = noise[0] > 0.0 ? n->xv / noise[0] : 0.0;
    noise[2] = sqrt(fmax(0.0, n->vv - noise[1] * noise[1]));
}

/* From a step short enough for the quadrature, by doubling, to all steps of the model. */
static void init_noise(nt_cantilever_model *model, const nt_oscillator_constants *c)
{
    const double q = 2.0 * BOLTZMANN * model->probe.temperature * c->damping / (c->mass * c->mass);
    const double widest = model->rate * model->period / QUADRATURE_STEP;
    int halvings = model->finest;
    if (ldexp(1.0, halvings) < widest)
        halvings = ilogb(widest) + 1;
    double h = ldexp(model->period, -halvings);
    covariance n = noise_of_short(c, q, h);
    for (; halvings >= 0; halvings--, h *= 2.0) {
        if (halvings <= model->finest)
            set_noise(model->steps[halvings].noise, &n);
        n = noise_doubled(c, &n, h);
    }
}

nt_status nt_cantilever_model_init(nt_cantilever_model *model, const nt_probe *probe, double period, double substep)
{
    nt_rig rig = nt_rig_defaults();
    rig.probe = *probe;
    const nt_status status = nt_rig_check(&rig, NULL);
    if (status != NT_OK)
        return status;
    if (!isfinite(period) || !isfinite(substep))
        return NT_E_NOT_FINITE;
    if (period <= 0.0 || substep <= 0.0)
        return NT_E_RANGE;
    nt_cantilever_model made = {.probe = *probe,
                                .period = period,
                                .cosine = cos(probe->tilt),
                                .rate = 2.0 * NT_PI * probe->resonance,
                                .substep = substep};
    const double finest = log2(made.rate * period * STIFFEST / substep);
    made.finest = (int)fmin(fmax(ceil(finest), 0.0), NT_CANTILEVER_LEVELS);
    const double mass = nt_probe_effective_mass(probe);
    const nt_oscillator_constants constants = {mass, mass * made.rate / probe->quality, probe->spring_constant};
    for (int level = 0; level <= made.finest; level++) {
        made.steps[level].length = ldexp(period, -level);
        made.steps[level].oscillator = nt_oscillator_over(&constants, made.steps[level].length);
    }
    if (probe->temperature > 0.0)
        init_noise(&made, &constants);
    *model = made;
    return NT_OK;
}

/* zeta = zeta_static - zeta'/(Q w0) - zeta''/w0^2. The command is limited to the speed v; the stage that follows it can
 * overshoot to 2 v, with accelerations up to v wn. */
nt_cantilever_lag nt_cantilever_lag_of(const nt_probe *probe, const nt_stage *stage)
{
    const double rate = 2.0 * NT_PI * probe->resonance, stage_rate = 2.0 * NT_PI * stage->resonance;
    const double lag = 2.0 * stage->max_speed / (probe->quality * rate);
    const double inertia = stage->max_speed * stage_rate / (rate * rate);
    return (nt_cantilever_lag){.force = probe->spring_constant * (lag + inertia),
                               .settling = 2.0 * probe->quality / rate,
                               .thermal = sqrt(probe->spring_constant * BOLTZMANN * probe->temperature)};
}
