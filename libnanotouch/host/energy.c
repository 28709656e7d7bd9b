/* SPDX-License-Identifier: BSD-3-Clause
 * Where the work of the hand goes in the last touch: into the spring, into the contact and, where the tip jumps, into
 * heat. Sums over the ticks: between two of them the spring's mean force on both of its ends is what it stores,
 * exactly. In x and y no spring lies between. */
#include <math.h>

#include "host/state.h"

static const double QUIET = 1e-3; /* of the largest load: below this nothing is touched */
static const double CALM = 0.015; /* for so long, until the touch is over [s] */

void nt_energy_begin(nt_session_host *host)
{
    host->energy = (nt_host_energy){.is_free = 1};
}

/* Outside of RUN the supervisor moves the tip: the hand has let go. */
void nt_energy_let_go(nt_session_host *host)
{
    nt_host_energy *sums = &host->energy;
    if (!sums->is_free)
        sums->spent = host->left.laid.dissipated - sums->spent_before;
    sums->has_last = 0;
    sums->is_free = sums->is_stopped = 1;
}

/* Of the spring [m]; it is taken hold of anew where the tip is after a stop. */
static double stretch_now(nt_session_host *host, const nt_frame *frame)
{
    nt_host_energy *sums = &host->energy;
    const double found =
        frame->tip_position[NT_Z] - (host->hand.zero - host->hand.facts.alpha_p * frame->master_position[NT_Z]);
    if (sums->is_stopped)
        sums->shift = found - frame->tip_force[NT_Z] / host->hand.stiffness;
    sums->is_stopped = 0;
    return found - sums->shift;
}

static void begin_touch(nt_session_host *host, double stretch)
{
    nt_host_energy *sums = &host->energy;
    sums->spent_before = host->left.laid.dissipated;
    sums->spent = 0.0;
    sums->hand = sums->tip = sums->heat = 0.0;
    sums->began = 0.5 * host->hand.stiffness * stretch * stretch;
    sums->is_free = 0;
}

/* Of the mean force on the way since the last tick [J]. */
static double work_along(const nt_host_energy *sums, const nt_frame *frame, int axis)
{
    return 0.5 * (frame->tip_force[axis] + sums->force[axis]) * (frame->tip_position[axis] - sums->place[axis]);
}

static int is_known(const nt_frame *frame)
{
    int known = isfinite(frame->master_position[NT_Z]);
    for (int i = 0; i < NT_AXES; i++)
        known = known && isfinite(frame->tip_position[i]) && isfinite(frame->tip_force[i]);
    return known;
}

void nt_energy_see(nt_session_host *host, const nt_frame *frame)
{
    nt_host_energy *sums = &host->energy;
    if (frame->state != NT_RUN) {
        nt_energy_let_go(host);
        return;
    }
    if (!is_known(frame))
        return;
    const double height = frame->tip_position[NT_Z], stretch = stretch_now(host, frame);
    if (!(fabs(frame->tip_force[NT_Z]) < QUIET * host->hand.facts.load)) {
        if (sums->is_free)
            begin_touch(host, sums->has_last ? sums->stretch : stretch);
        sums->quiet_since = frame->time;
    }
    if (!sums->is_free && sums->has_last) {
        const double pull = host->hand.stiffness * 0.5 * (stretch + sums->stretch), moved = height - sums->place[NT_Z];
        const double law = work_along(sums, frame, NT_Z),
                     sideways = work_along(sums, frame, NT_X) + work_along(sums, frame, NT_Y);
        sums->hand -= pull * (moved - (stretch - sums->stretch)) + sideways;
        sums->tip -= law + sideways;
        sums->heat -= pull * moved - law;
        sums->now = 0.5 * host->hand.stiffness * stretch * stretch;
    }
    if (!sums->is_free && frame->time - sums->quiet_since > CALM) {
        sums->spent = host->left.laid.dissipated - sums->spent_before;
        sums->is_free = 1;
    }
    for (int i = 0; i < NT_AXES; i++) {
        sums->place[i] = frame->tip_position[i];
        sums->force[i] = frame->tip_force[i];
    }
    sums->stretch = stretch;
    sums->has_last = 1;
}

/* Work of the hand, what the spring has stored, what the law has taken, heat [J]: the first is the sum of the others.
 */
void nt_energies(const nt_session_host *host, double found[4])
{
    const nt_host_energy *sums = &host->energy;
    const double spent = sums->is_free ? sums->spent : host->left.laid.dissipated - sums->spent_before;
    found[0] = sums->hand;
    found[1] = sums->now - sums->began;
    found[2] = sums->tip - spent;
    found[3] = sums->heat + spent;
}
