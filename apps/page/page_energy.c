/* SPDX-License-Identifier: BSD-3-Clause
 * Where the work of the hand goes in the last touch: into the spring, into the contact and, where the tip jumps, into
 * heat. Sums over the ticks, as nanotouch_app/live/energy.py: between two ticks the spring's mean force on both of its
 * ends is what it stores, exactly. In x and y no spring lies between. */
#include <math.h>
#include <stdint.h>

#include "page.h"

static const double QUIET = 1e-3; /* of the largest load: below this nothing is touched */
static const double CALM = 0.015; /* for so long, until the touch is over [s] */

static struct {
    double spring, zero, alpha_p, load;
    double hand, tip, heat, began, now; /* [J] */
    double stretch, quiet_since;        /* of the last tick */
    double spent_before, spent;         /* heat of particles until this touch, and in it [J] */
    double place[NT_AXES], force[NT_AXES];
    double shift; /* of the zero since the hand has let go [m] */
    int has_last, is_free, is_stopped;
} sums;

/* Of what the law takes particles make heat. */
static double heat_of_particles(void)
{
    nt_session_particles laid;
    return nt_session_read_particles(page_the_session(), &laid) == NT_OK ? laid.dissipated : 0.0;
}

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
    sums.shift = sums.spent = 0.0;
    sums.has_last = sums.is_stopped = 0;
    sums.is_free = 1;
}

/* Outside of RUN the supervisor moves the tip: the hand has let go. */
void page_weigh_let_go(void)
{
    if (!sums.is_free)
        sums.spent = heat_of_particles() - sums.spent_before;
    sums.has_last = 0;
    sums.is_free = sums.is_stopped = 1;
}

/* Of the spring [m]; it is taken hold of anew where the tip is after a stop. */
static double stretch_now(const nt_frame *frame)
{
    const double found = frame->tip_position[NT_Z] - (sums.zero - sums.alpha_p * frame->master_position[NT_Z]);
    if (sums.is_stopped)
        sums.shift = found - frame->tip_force[NT_Z] / sums.spring;
    sums.is_stopped = 0;
    return found - sums.shift;
}

static void begin_touch(double stretch)
{
    sums.spent_before = heat_of_particles();
    sums.spent = 0.0;
    sums.hand = sums.tip = sums.heat = 0.0;
    sums.began = 0.5 * sums.spring * stretch * stretch;
    sums.is_free = 0;
}

/* Of the mean force on the way since the last tick [J]. */
static double work_along(const nt_frame *frame, int axis)
{
    return 0.5 * (frame->tip_force[axis] + sums.force[axis]) * (frame->tip_position[axis] - sums.place[axis]);
}

static int is_known(const nt_frame *frame)
{
    int known = isfinite(frame->master_position[NT_Z]);
    for (int i = 0; i < NT_AXES; i++)
        known = known && isfinite(frame->tip_position[i]) && isfinite(frame->tip_force[i]);
    return known;
}

void page_weigh_tick(const nt_frame *frame)
{
    if (frame->state != NT_RUN) {
        page_weigh_let_go();
        return;
    }
    if (!is_known(frame))
        return;
    const double height = frame->tip_position[NT_Z], stretch = stretch_now(frame);
    if (!(fabs(frame->tip_force[NT_Z]) < QUIET * sums.load)) {
        if (sums.is_free)
            begin_touch(sums.has_last ? sums.stretch : stretch);
        sums.quiet_since = frame->time;
    }
    if (!sums.is_free && sums.has_last) {
        const double pull = sums.spring * 0.5 * (stretch + sums.stretch), moved = height - sums.place[NT_Z];
        const double law = work_along(frame, NT_Z), sideways = work_along(frame, NT_X) + work_along(frame, NT_Y);
        sums.hand -= pull * (moved - (stretch - sums.stretch)) + sideways;
        sums.tip -= law + sideways;
        sums.heat -= pull * moved - law;
        sums.now = 0.5 * sums.spring * stretch * stretch;
    }
    if (!sums.is_free && frame->time - sums.quiet_since > CALM) {
        sums.spent = heat_of_particles() - sums.spent_before;
        sums.is_free = 1;
    }
    for (int i = 0; i < NT_AXES; i++) {
        sums.place[i] = frame->tip_position[i];
        sums.force[i] = frame->tip_force[i];
    }
    sums.stretch = stretch;
    sums.has_last = 1;
}

/* Work of the hand, what the spring has stored, what the law has taken, heat [J]: the first is the sum of the others.
 */
PAGE_API(page_energies) void page_energies(double found[4])
{
    if (!sums.is_free)
        sums.spent = heat_of_particles() - sums.spent_before;
    found[0] = sums.hand;
    found[1] = sums.now - sums.began;
    found[2] = sums.tip - sums.spent;
    found[3] = sums.heat + sums.spent;
}
