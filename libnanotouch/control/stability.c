/* SPDX-License-Identifier: BSD-3-Clause
 * Where the sampled loop turns unstable, exactly. The characteristic function is A + g B in every gain g that is asked
 * for. As g grows from a value where all its roots are inside the unit circle, the first root to leave passes through
 * the circle at some z = exp(j theta), where -A/B = g is real and positive: the limit is the smallest such value over
 * theta. That asks for no eigenvalue and no polynomial, and loses nothing at high rates, where all roots crowd at z
 * = 1. */
#include <math.h>

#include "control/sampled.h"
#include "nanotouch/material.h"

/* Gains, each with the others as they are given. */
typedef enum gain {
    STAGE_GAIN,
    DRAG_IN_AIR, /* of the virtual tool, without K_f */
    FORCE_GAIN_IN_AIR,
    FORCE_GAIN_IN_CONTACT,
    STIFFNESS_WITHOUT_GAIN,
    STIFFNESS,
    STIFFNESS_HELD, /* the master held still: tool and stage alone */
    GAINS
} gain;

typedef struct asked {
    const nt_sampled_loop *loop;
    double force_gain;
    double reflected_stiffness;
} asked;

typedef struct crossing {
    double limit; /* smallest so far */
    double angle; /* where */
} crossing;

/* -A conj(B), of the phase of g, and |g|. */
static double complex phasor(const asked *question, gain which, const nt_sampled_terms *terms, double *size)
{
    const nt_sampled_loop *loop = question->loop;
    const double k = question->reflected_stiffness, K_f = which == STIFFNESS ? question->force_gain : 0.0;
    const double complex servo = nt_sampled_servo(loop, terms);
    double complex A = 0.0, B = 0.0;
    switch (which) {
    case STAGE_GAIN:
        A = terms->stage;
        B = terms->tracking;
        break;
    case DRAG_IN_AIR:
        A = terms->master * terms->keeps;
        B = terms->drags * terms->way;
        break;
    case FORCE_GAIN_IN_AIR:
        A = nt_sampled_air(terms, 0.0);
        B = nt_sampled_air(terms, 1.0) - A;
        break;
    case FORCE_GAIN_IN_CONTACT:
        A = servo * nt_sampled_air(terms, 0.0) + k * nt_sampled_touch(loop, terms, 0.0);
        B = servo * nt_sampled_air(terms, 1.0) + k * nt_sampled_touch(loop, terms, 1.0) - A;
        break;
    case STIFFNESS_HELD:
        A = servo * terms->keeps;
        B = (1.0 - loop->tool.kept) * loop->tool.give * terms->reach;
        break;
    default:
        A = servo * nt_sampled_air(terms, K_f);
        B = nt_sampled_touch(loop, terms, K_f);
    }
    const double a = cabs(A), b = cabs(B);
    *size = a / b;
    return a > 0.0 && b > 0.0 ? -(A / a) * (conj(B) / b) : 0.0;
}

/* Halves [low, high], over which the phase of g passes through 0. */
static void refine(const asked *question, gain which, double low, double high, crossing *found)
{
    double size;
    nt_sampled_terms terms = nt_sampled_terms_at(question->loop, low);
    const int rising = cimag(phasor(question, which, &terms, &size)) < 0.0;
    for (int i = 0; i < 60 && high - low > 1e-14 * high; i++) {
        const double middle = 0.5 * (low + high);
        terms = nt_sampled_terms_at(question->loop, middle);
        *((cimag(phasor(question, which, &terms, &size)) < 0.0) == rising ? &low : &high) = middle;
    }
    terms = nt_sampled_terms_at(question->loop, high);
    if (creal(phasor(question, which, &terms, &size)) > 0.0 && size < found->limit)
        *found = (crossing){size, high};
}

/* The phases of all gains along the circle. */
static void march(const asked *question, crossing found[GAINS])
{
    double last_theta = nt_sampled_first(question->loop), last[GAINS] = {0.0}, size;
    for (double theta = last_theta;; theta = fmin(nt_sampled_next(question->loop, theta, 0.125), NT_PI)) {
        const nt_sampled_terms terms = nt_sampled_terms_at(question->loop, theta);
        for (int which = 0; which < GAINS; which++) {
            const double complex g = phasor(question, (gain)which, &terms, &size);
            if (last[which] * cimag(g) < 0.0)
                refine(question, (gain)which, last_theta, theta, &found[which]);
            if (theta >= NT_PI && creal(g) > 0.0 && size < found[which].limit) /* all is real there */
                found[which] = (crossing){size, NT_PI};
            last[which] = cimag(g);
        }
        last_theta = theta;
        if (!(theta < NT_PI))
            return;
    }
}

nt_sampled_limits nt_sampled_limits_of(const nt_sampled_loop *loop, double force_gain, double reflected_stiffness)
{
    const int is_closed = loop->master.damping > 0.0 && loop->master.whole <= NT_SAMPLED_LONGEST;
    nt_sampled_loop walked = *loop;
    if (loop->stage.whole > NT_SAMPLED_LONGEST)
        return (nt_sampled_limits){0.0, NAN, 0.0, 0.0, 0.0};
    if (!is_closed) { /* the stage's own loop does not ask the master */
        walked.master.damping = walked.master.mass / walked.master.period;
        walked.master.whole = walked.stage.whole;
    }
    const asked question = {&walked, force_gain, reflected_stiffness};
    crossing found[GAINS];
    for (int which = 0; which < GAINS; which++)
        found[which] = (crossing){INFINITY, NAN};
    march(&question, found);
    const double servo = loop->printed ? 1.0 : loop->stage_loop.integral;
    nt_sampled_limits limits = {0.0, NAN, found[STIFFNESS_HELD].limit, 0.0, found[STAGE_GAIN].limit};
    if (servo >= found[STAGE_GAIN].limit)
        limits.tool_stiffness = 0.0;
    if (!is_closed || servo >= found[STAGE_GAIN].limit || !(found[DRAG_IN_AIR].limit > 1.0))
        return limits; /* nothing takes out what the holds put in, or it comes too late */
    if (force_gain < found[FORCE_GAIN_IN_AIR].limit) {
        limits.loop_stiffness = (1.0 + force_gain) * found[STIFFNESS].limit;
        limits.angle = found[STIFFNESS].angle;
    }
    if (reflected_stiffness < found[STIFFNESS_WITHOUT_GAIN].limit)
        limits.force_gain = fmin(found[FORCE_GAIN_IN_AIR].limit, found[FORCE_GAIN_IN_CONTACT].limit);
    return limits;
}
