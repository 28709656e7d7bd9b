/* SPDX-License-Identifier: BSD-3-Clause
 * The steady motion of a tapping lever: as it settles by itself until it all but repeats, then Newton's method on the
 * map of one period, x -> P(x), x = (q, q'/w0), which takes three periods where the lever would take Q. Only what the
 * lever has come near to by itself is taken, so the branch is the one that it goes to, and it is stable. */
#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "nanotouch/advanced/tapping.h"

#define NEAR 3e-4    /* change in one period, over A0, from which Newton's method may try */
#define REACH 0.1    /* what it may move the state by, over A0 */
#define PROBE 3e-5   /* of the finite differences, over A0 */
#define SETTLED 30.0 /* change in one period, in tolerances */
#define FINER 0.1    /* of the tolerance, after Newton's method has failed: a stiff contact amplifies errors */
#define FINEST 1e-4  /* of the tolerance that is asked for, at least */
enum { NEWTON_MAX = 8, PATIENCE = 30 };

typedef struct search {
    const nt_tapping *tapping;
    const nt_tapping_over *over;
    long periods;
} search;

static nt_status run(search *s, nt_tapping_state *state, long periods, nt_tapping_value *value)
{
    s->periods += periods;
    return nt_tapping_run(s->tapping, state, s->over, periods, value);
}

/* The Jacobian of P(x) - x by forward differences; column-wise. */
static nt_status jacobian_of(search *s, const nt_tapping_state *x, const nt_tapping_state *image, double j[4])
{
    const double d = PROBE * s->tapping->free_amplitude;
    for (int column = 0; column < 2; column++) {
        nt_tapping_value ignored;
        nt_tapping_state moved = *x;
        moved.position += column == 0 ? d : 0.0;
        moved.speed += column == 1 ? d : 0.0;
        const nt_status status = run(s, &moved, 1, &ignored);
        if (status != NT_OK)
            return status;
        j[2 * column] = (moved.position - image->position) / d - (column == 0);
        j[2 * column + 1] = (moved.speed - image->speed) / d - (column == 1);
    }
    return NT_OK;
}

/* Moves x by Newton's step; 0 if it is none or reaches too far. */
static int newton_step(const search *s, nt_tapping_state *x, const nt_tapping_state *image, const double j[4])
{
    const double q = image->position - x->position, v = image->speed - x->speed;
    const double determinant = j[0] * j[3] - j[2] * j[1];
    const double dq = -(j[3] * q - j[2] * v) / determinant, dv = -(j[0] * v - j[1] * q) / determinant;
    if (!(hypotenuse(dq, dv) <= REACH * s->tapping->free_amplitude))
        return 0;
    x->position += dq;
    x->speed += dv;
    return 1;
}

/* From *state to the fixed point near it; NT_E_NO_CONVERGENCE leaves it. The contact is that of the period's end. */
static nt_status refine(search *s, double tolerance, nt_tapping_state *state, nt_tapping_value *value)
{
    const double wanted = SETTLED * tolerance;
    nt_tapping_state x = *state;
    double best = HUGE_VAL;
    for (int i = 0; i < NEWTON_MAX; i++) {
        nt_tapping_state image = x;
        nt_tapping_value here;
        nt_status status = run(s, &image, 1, &here);
        if (status != NT_OK)
            return status;
        const int repeats = image.contact.attached == x.contact.attached;
        if (here.change <= wanted && repeats) {
            *state = image;
            *value = here;
            return NT_OK;
        }
        if (!(here.change < 0.5 * best))
            break;
        best = here.change;
        double j[4];
        x.step = image.step;
        x.contact = image.contact;
        status = jacobian_of(s, &x, &image, j);
        if (status != NT_OK)
            return status;
        if (!newton_step(s, &x, &image, j))
            break;
    }
    return NT_E_NO_CONVERGENCE;
}

nt_status nt_tapping_settle(const nt_tapping *tapping, nt_tapping_state *state, const nt_tapping_over *over,
                            nt_tapping_value *value, nt_solve_info *info)
{
    if (tapping == NULL || state == NULL || over == NULL || value == NULL)
        return NT_E_ARGUMENT;
    nt_tapping finer = *tapping;
    search s = {&finer, over, 0};
    const double most = PATIENCE * tapping->quality;
    const long block = (long)ceil(0.25 * tapping->quality);
    double near = NEAR;
    nt_status status = NT_E_NO_CONVERGENCE;
    while ((double)s.periods < most && status == NT_E_NO_CONVERGENCE) {
        nt_tapping_value last;
        status = run(&s, state, block, &last);
        if (status == NT_OK)
            status = run(&s, state, 1, value);
        if (status != NT_OK)
            break;
        if (value->change <= SETTLED * tapping->tolerance)
            break;
        status = NT_E_NO_CONVERGENCE;
        if (value->change <= near) {
            status = refine(&s, tapping->tolerance, state, value);
            near *= 0.3;
            finer.tolerance = fmax(FINER * finer.tolerance, FINEST * tapping->tolerance);
        }
    }
    if (info != NULL)
        *info = (nt_solve_info){(int)s.periods, value->change};
    return status;
}
