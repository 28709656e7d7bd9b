/* SPDX-License-Identifier: BSD-3-Clause
 * Notch and gain of the stage's loop. */
#include <math.h>

#include "internal/control.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/material.h"

/* z^2 - sum z + product: the poles of s^2 + 2 zeta wn s + wn^2 under a hold, z = exp(s T); angle = wn T. */
typedef struct pole_pair {
    double sum, product;
} pole_pair;

static pole_pair poles_of(double zeta, double angle)
{
    const double decay = zeta * angle;
    const double split = angle * sqrt(fabs(1.0 - zeta * zeta));
    const double sum = zeta < 1.0 ? 2.0 * exp(-decay) * cos(split) : exp(split - decay) + exp(-split - decay);
    return (pole_pair){sum, exp(-2.0 * decay)};
}

int nt_stage_loop_notches(const nt_stage *stage, const nt_gains *gains)
{
    return gains->rate > 2.0 * stage->resonance;
}

nt_stage_loop nt_stage_loop_make(const nt_stage *stage, const nt_gains *gains)
{
    nt_stage_loop loop = {.b = {1.0, 0.0, 0.0}, .a = {1.0, 0.0, 0.0}, .integral = gains->stage_integral / gains->rate};
    const double angle = 2.0 * NT_PI * stage->resonance / gains->rate;
    if (!nt_stage_loop_notches(stage, gains))
        return loop;
    const pole_pair bare = poles_of(0.5 / stage->quality, angle);
    const pole_pair damped = poles_of(gains->stage_damping, angle);
    const double scale = (1.0 - damped.sum + damped.product) / (1.0 - bare.sum + bare.product); /* gain 1 at rest */
    loop.b[0] = scale;
    loop.b[1] = -scale * bare.sum;
    loop.b[2] = scale * bare.product;
    loop.a[1] = -damped.sum;
    loop.a[2] = damped.product;
    return loop;
}
