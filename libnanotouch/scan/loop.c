/* SPDX-License-Identifier: BSD-3-Clause
 * The z loop on the unit circle, z = exp(j theta). A base that is held over a tick moves the slow flow by its matrix
 * exponential, so that resonances near and beyond half the rate, and an answer that runs ahead, come out as the samples
 * see them. As K_I grows from 0 the loop begins to ring where L(z) first reaches -1: at the largest |L| among the
 * points of the circle where L is real and below 0. */
#include "loop.h"

#include <math.h>

#include "answer.h"
#include "core/same_bits.h"
#include "nanotouch/material.h"
#include "scan/flow.h"

#define SHARE 0.01  /* of a step along the circle */
#define FINEST 0.05 /* of a step, over the width of the stage's resonance */
#define ROUNDED 1e-9
enum { BISECTIONS = 40 };

/* Over that of a flat: there; in a hollow of four times the radius; and, as phase feedback feels it that swings so far
 * that the tip is off the sample for a part of the time. There the lag shows the speed of the base the longer. */
static const double stiffness[] = {1.0, 2.0, 0.5, 0.25, 0.125};
enum { OF_AMPLITUDE = 2, OF_PHASE = (int)(sizeof stiffness / sizeof *stiffness) };

/* --- answers --- */

static nt_loop_answer free_lever(const nt_tapping *lever, double period, double moment)
{
    const double time = 2.0 * lever->quality / lever->rate;
    const nt_lti model = {.order = 1, .a = {{-1.0 / time}}, .b = {1.0 / time}};
    nt_loop_answer made = {.order = 1, .read = {1.0}};
    if (nt_lti_discretise(&model, period, &made.tick) != NT_OK ||
        nt_lti_discretise(&model, moment, &made.part) != NT_OK)
        made.order = 0; /* so slow a tick that the lever follows at once */
    return made;
}

/* The slow flow about a motion, t in 1/w0, a and p the changes of A and phi for one of the height:
 *     2 r a' + (r/Q + fs_A) a - D cos(phi) p = -fs_z,    2 r A p' + D sin(phi) p + (g_A + 1 - r^2) a = -g_z.
 * Phase feedback reads A0 cos(phi) p. The states are a and A p, so that the entries are of like size. */
static nt_loop_answer at_set_point(const nt_tapping *t, const nt_tap_answer *at, const nt_zloop *zloop, double moment)
{
    const double r = t->ratio, A = at->amplitude, per = 0.5 * t->rate / r, k = at->force_swing + 1.0 - r * r;
    const nt_lti model = {
        .order = 2,
        .a = {{-per * (r / t->quality + at->loss_swing), per * at->cosine / A}, {-per * k, -per * at->sine / A}},
        .b = {-per * at->loss_height, -per * at->force_height}};
    nt_loop_answer made = {.order = 2, .read = {1.0, 0.0}};
    if (zloop->mode == NT_ZLOOP_PHASE) {
        made.read[0] = 0.0;
        made.read[1] = t->free_amplitude * at->cosine / t->strength / A;
    }
    if (nt_lti_discretise(&model, 1.0 / zloop->rate, &made.tick) != NT_OK ||
        nt_lti_discretise(&model, moment, &made.part) != NT_OK)
        made.order = 0;
    return made;
}

static void add(nt_tap_loop *loop, nt_loop_answer answer)
{
    loop->answer[loop->count++] = answer;
}

nt_tap_loop nt_tap_loop_at_once(void)
{
    return (nt_tap_loop){.count = 1, .share = 1.0};
}

nt_tap_loop nt_tap_loop_make(const nt_tapping *lever, const nt_zloop *zloop, const nt_tap_answer answer[NT_TAP_ANSWERS])
{
    const double period = 1.0 / zloop->rate;
    const double moments[] = {period, period * (1.0 - 0.5 / nt_flow_steps(lever, period))};
    nt_tap_loop made = nt_tap_loop_at_once();
    if (zloop->lock_in > 0.0)
        made.share = -expm1(-period / zloop->lock_in);
    for (int m = 0; m < 2; m++)
        add(&made, free_lever(lever, period, moments[m]));
    for (int i = 0; i < NT_TAP_ANSWERS; i++) {
        nt_tap_answer at = answer[i];
        if (!(at.amplitude > 0.0))
            continue;
        if (made.at_set_point == 0)
            made.at_set_point = made.count;
        for (int kind = 0; kind < (zloop->mode == NT_ZLOOP_PHASE ? OF_PHASE : OF_AMPLITUDE); kind++) {
            at = answer[i];
            at.force_swing += (1.0 - stiffness[kind]) * lever->cosine * at.force_height;
            at.force_height *= stiffness[kind];
            for (int m = 0; m < 2 && nt_tap_can_be_held(lever, zloop->mode, &at); m++)
                add(&made, at_set_point(lever, &at, zloop, moments[m]));
        }
    }
    return made;
}

/* State over a held input at exp(j theta), and from there on to the moment of the reading. */
static double complex read_at(const nt_loop_answer *answer, double complex less)
{
    const nt_lti *tick = &answer->tick, *part = &answer->part;
    if (answer->order == 0)
        return 1.0;
    const double complex a = less - (tick->a[0][0] - 1.0);
    if (answer->order == 1)
        return part->b[0] + part->a[0][0] * tick->b[0] / a;
    const double complex d = less - (tick->a[1][1] - 1.0), below = a * d - tick->a[0][1] * tick->a[1][0];
    const double complex x = (d * tick->b[0] + tick->a[0][1] * tick->b[1]) / below;
    const double complex y = (a * tick->b[1] + tick->a[1][0] * tick->b[0]) / below;
    return answer->read[0] * (part->b[0] + part->a[0][0] * x + part->a[0][1] * y) +
           answer->read[1] * (part->b[1] + part->a[1][0] * x + part->a[1][1] * y);
}

double complex nt_tap_loop_at(const nt_tap_loop *loop, int answer, double theta)
{
    const double complex less = nt_complex_from_one(theta);
    return read_at(&loop->answer[answer], less) * loop->share * (1.0 + less) / (less + loop->share);
}

/* --- margins --- */

double complex nt_open_loop_at(const nt_open_loop *loop, int answer, double theta)
{
    return loop->stage(loop->context, theta) * nt_tap_loop_at(loop->tap, answer, theta);
}

/* Closer near the stage's resonance, where the phase turns fastest. */
static double next_angle(const nt_open_loop *loop, double theta)
{
    const double near = fmax(SHARE * fabs(theta - loop->angle), FINEST * loop->width);
    const double next = theta + fmax(1e-12, fmin(SHARE * theta, near));
    return theta < NT_PI && next > NT_PI ? NT_PI : next;
}

/* |L| where it crosses the real axis between two angles. */
static double crossing(const nt_open_loop *loop, int answer, double low, double high)
{
    const int sign = cimag(nt_open_loop_at(loop, answer, low)) > 0.0;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = 0.5 * (low + high);
        *((cimag(nt_open_loop_at(loop, answer, middle)) > 0.0) == sign ? &low : &high) = middle;
    }
    return -creal(nt_open_loop_at(loop, answer, high));
}

nt_loop_limits nt_open_loop_limits(const nt_open_loop *loop, double phase_margin)
{
    const double slope = tan(phase_margin);
    double real = 0.0, cone = 0.0;
    for (int answer = 0; answer < loop->tap->count; answer++) {
        double before = loop->first;
        double complex last = nt_open_loop_at(loop, answer, before);
        for (double theta = next_angle(loop, before); theta <= NT_PI; theta = next_angle(loop, theta)) {
            const double complex now = nt_open_loop_at(loop, answer, theta);
            if (theta == NT_PI)
                real = fmax(real, -creal(now)); /* its imaginary part is rounding */
            else if ((cimag(now) > 0.0) != (cimag(last) > 0.0))
                real = fmax(real, crossing(loop, answer, before, theta));
            if (-creal(now) * slope >= fabs(cimag(now)))
                cone = fmax(cone, hypotenuse(creal(now), cimag(now)));
            before = theta;
            last = now;
        }
    }
    return (nt_loop_limits){1.0 / real, 1.0 / fmax(real, cone)};
}

nt_loop_phase nt_open_loop_phase(const nt_open_loop *loop, double integral)
{
    nt_loop_phase found = {NT_PI, 0.0};
    for (int answer = 0; answer < loop->tap->count; answer++)
        for (double theta = loop->first; theta <= NT_PI; theta = next_angle(loop, theta)) {
            const double complex now = nt_open_loop_at(loop, answer, theta);
            if (integral * hypotenuse(creal(now), cimag(now)) < 1.0 + ROUNDED)
                continue;
            found.margin = fmin(found.margin, fabs(atan2(cimag(-now), creal(-now))));
            found.angle = fmax(found.angle, theta);
        }
    return found;
}
