/* SPDX-License-Identifier: BSD-3-Clause
 * A lever above the sample of a plan, for a board that has a hand to train and no microscope. */
#ifndef APPS_MCU_SAMPLE_H
#define APPS_MCU_SAMPLE_H

#include "nanotouch_single.h"

typedef struct lever {
    int attached;     /* history of the contact */
    float deflection; /* zeta [m] */
    uint32_t noise;   /* state of its generator */
} lever;

/* One period: what the lever says with its base at a gap h - zeta [m] above the sample: it moves towards
 * k_c zeta = F(h) by one step of Newton, and has the noise of the rig's probe. */
float lever_read(lever *state, const ntf_force_table *force, const ntf_probe *probe, float base);

#endif
