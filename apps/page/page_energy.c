/* SPDX-License-Identifier: BSD-3-Clause
 * Where the work of the hand goes in the last touch: into the spring, into the contact and, where the tip jumps, into
 * heat. Sums over the ticks, as nanotouch_app/live/energy.py: between two ticks the spring's mean force on both of its
 * ends is what it stores, exactly. */
#include <math.h>
#include <stdint.h>

#include "page.h"

static const double QUIET = 1e-3; /* of the largest load: below this nothing is touched */
static const double CALM = 0.015; /* for so long, until the touch is over [s] */

static struct {
    double spring, zero, alpha_p, load;
    double hand, tip, heat, began, now;         /* [J] */
    double height, stretch, force, quiet_since; /* of the last tick */
    int has_last, is_free;
} sums;

/* A spring [N/m] whose far end is at zero - alpha_p times the master's height; the largest load [N]. Begins anew where
 * one of them is another. */
PAGE_API(page_weigh) void page_weigh(double spring, double zero, double alpha_p, double load)
{
    if (sums.spring == spring && sums.zero == zero && sums.alpha_p == alpha_p && sums.load == load)
        return;
    sums.spring = spring;
    sums.zero = zero;
    sums.alpha_p = alpha_p;
    sums.load = load;
    page_weigh_anew();
}

void page_weigh_anew(void)
{
    sums.hand = sums.tip = sums.heat = sums.began = sums.now = 0.0;
    sums.has_last = 0;
    sums.is_free = 1;
}

static void begin_touch(double stretch)
{
    sums.hand = sums.tip = sums.heat = 0.0;
    sums.began = 0.5 * sums.spring * stretch * stretch;
    sums.is_free = 0;
}

void page_weigh_tick(const nt_frame *frame)
{
    const double height = frame->tip_position[NT_Z], force = frame->tip_force[NT_Z];
    const double stretch = height - (sums.zero - sums.alpha_p * frame->master_position[NT_Z]);
    if (!isfinite(height) || !isfinite(force) || !isfinite(stretch))
        return;
    if (!(fabs(force) < QUIET * sums.load)) {
        if (sums.is_free)
            begin_touch(sums.has_last ? sums.stretch : stretch);
        sums.quiet_since = frame->time;
    }
    if (!sums.is_free && sums.has_last) {
        const double pull = sums.spring * 0.5 * (stretch + sums.stretch), law = 0.5 * (force + sums.force);
        const double moved = height - sums.height;
        sums.hand -= pull * (moved - (stretch - sums.stretch));
        sums.tip -= law * moved;
        sums.heat -= (pull - law) * moved;
        sums.now = 0.5 * sums.spring * stretch * stretch;
    }
    if (frame->time - sums.quiet_since > CALM)
        sums.is_free = 1;
    sums.height = height;
    sums.stretch = stretch;
    sums.force = force;
    sums.has_last = 1;
}

/* Work of the hand, what the spring has stored, what the law has taken, heat [J]: the first is the sum of the others.
 */
PAGE_API(page_energies) void page_energies(double found[4])
{
    found[0] = sums.hand;
    found[1] = sums.now - sums.began;
    found[2] = sums.tip;
    found[3] = sums.heat;
}
