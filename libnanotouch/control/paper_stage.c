/* SPDX-License-Identifier: BSD-3-Clause
 * How far the stage's own loop is from its limit under the paper's law (Eq. 13 and 17): the stage exactly under the
 * hold, speeds by differences, the command delayed. Its growth is read off a simulation: the loop is linear, so any
 * start that is not at rest will do. */
#include <math.h>

#include "core/clamp.h"
#include "core/lti.h"
#include "nanotouch/control.h"
#include "nanotouch/material.h"

enum { MOST_DELAY = 1000, LEAST_TICKS = 4000, TICKS_PER_DELAY = 200 };
#define LARGEST_GAIN 1e4

typedef struct stage_loop {
    nt_lti stage;                    /* states x and x'/w_n */
    double proportional, derivative; /* K_p; K_v over a period */
    int delay;                       /* [periods] */
} stage_loop;

static nt_status make(stage_loop *loop, const nt_rig *rig, const nt_gains *gains)
{
    const double wn = 2.0 * NT_PI * rig->stage.resonance;
    const nt_lti stage = {.order = 2, .a = {{0.0, wn}, {-wn, -wn / rig->stage.quality}}, .b = {0.0, wn}};
    loop->proportional = gains->stage_proportional;
    loop->derivative = gains->stage_derivative * gains->rate;
    loop->delay = (int)lesser(ceil(gains->delay), MOST_DELAY);
    return nt_lti_discretise(&stage, 1.0 / gains->rate, &loop->stage);
}

/* Largest excursion in each half of a run from x = 1, gains times `gain`: does it die away? */
static int is_stable(const stage_loop *loop, double gain)
{
    const double (*a)[NT_LTI_MAX] = loop->stage.a, *b = loop->stage.b;
    double sent[MOST_DELAY + 1] = {0.0}, x = 1.0, v = 0.0, last = 1.0, peaks[2] = {0.0, 0.0};
    const int ticks = LEAST_TICKS + TICKS_PER_DELAY * loop->delay, slots = loop->delay + 1;
    for (int k = 0; k < ticks; ++k) {
        sent[k % slots] = -gain * (loop->derivative * (x - last) + loop->proportional * x);
        const double u = sent[(k + 1) % slots]; /* the oldest; this one without a delay */
        last = x;
        const double moved = a[0][0] * x + a[0][1] * v + b[0] * u;
        v = a[1][0] * x + a[1][1] * v + b[1] * u;
        x = moved;
        if (!(fabs(x) < 1e100))
            return 0;
        double *peak = &peaks[2 * k >= ticks];
        *peak = greater(*peak, fabs(x));
    }
    return peaks[1] < peaks[0];
}

double nt_servo_stage_margin(const nt_rig *rig, const nt_settings *settings)
{
    stage_loop loop;
    if (settings->control.choice != NT_CONTROL_PAPER)
        return INFINITY;
    if (make(&loop, rig, &settings->gains) != NT_OK)
        return NAN;
    double low = 1.0 / LARGEST_GAIN, high = LARGEST_GAIN;
    if (is_stable(&loop, high))
        return INFINITY;
    while (high > 1.001 * low) {
        const double middle = sqrt(low * high);
        if (is_stable(&loop, middle))
            low = middle;
        else
            high = middle;
    }
    return low;
}
