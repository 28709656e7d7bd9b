/* SPDX-License-Identifier: BSD-3-Clause
 * Dice of the adversary, and what they are thrown for. The dice are random numbers, or genes that a search changes. */
#ifndef TESTS_ADVERSARY_DICE_H
#define TESTS_ADVERSARY_DICE_H

#include <math.h>

#include "nanotouch/advanced/random.h"
#include "nanotouch/nanotouch.h"

typedef enum attack { ATTACK_QUASI_STATIC, ATTACK_DYNAMIC, ATTACK_FAULT, ATTACKS } attack;

enum { GENES = 400, FAULT_GENES = 10, MAP = 40 }; /* the last ones are the fault's */
typedef struct dice {
    nt_random random;
    double *genes; /* NULL: random numbers */
    int used;
} dice;

static inline double throw_dice(dice *d)
{
    return d->genes ? d->genes[d->used++ % GENES] : nt_random_uniform(&d->random);
}
static inline double between(dice *d, double low, double high)
{
    return low + (high - low) * throw_dice(d);
}
/* Evenly in the logarithm. */
static inline double magnitude(dice *d, double low, double high)
{
    return low * pow(high / low, throw_dice(d));
}
static inline int chance(dice *d, double share)
{
    return throw_dice(d) < share;
}
static inline int choose(dice *d, int count)
{
    const int chosen = (int)between(d, 0.0, (double)count);
    return chosen < count ? chosen : count - 1;
}

/* What is run. The session is opened with the lever as it is, and a limit that trips where the believed one does. */
typedef struct plot {
    attack kind;
    const struct known_rig *known; /* of a search; NULL: all is drawn */
    nt_failure sought;             /* by a search; then the failure that was drawn */
    int nth;                       /* of the faults that are this failure, in a search */
    int rehearses;                 /* a search: without the fault, to know when a stop comes */
    double stopped;                /* by a rehearsal: when that was, NAN: never [s] */
    nt_session_setup setup;
    double rate; /* of the loop [Hz] */
    nt_rig believed;
    nt_settings settings; /* as the operator has set them */
    nt_faults faults;
    nt_guarantee promised; /* of the believed rig, wherever the tip can be led ... */
    nt_reach reach;        /* ... which is here */
    double heights[MAP * MAP];
} plot;

#endif
