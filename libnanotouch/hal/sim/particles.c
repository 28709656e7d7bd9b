/* SPDX-License-Identifier: BSD-3-Clause
 * Particles on the surface of the simulated slave: laid, pushed, and left by the tip. */
#include <math.h>
#include <string.h>

#include "parts.h"

#define MOVED 1e-10 /* less is no push that is told of [m] */

/* Pressed into the substrate by less than a nanometre, the tip stands on it. */
static void place_of_tip(const nt_sim_slave *slave, double height, double base[NT_AXES])
{
    base[NT_X] = slave->x;
    base[NT_Y] = slave->y;
    base[NT_Z] = fmax(height, 0.0);
}

nt_status nt_sim_begin_particles(nt_sim_slave *slave, const nt_sim_setup *setup)
{
    nt_sim_particles *pushed = &slave->pushed;
    if (!setup->particles)
        return NT_OK;
    if (setup->probe_model == NT_PROBE_DYNAMIC || setup->lock_in)
        return NT_E_UNSUPPORTED;
    double base[NT_AXES];
    pushed->can = 1;
    pushed->laws = *setup->particles;
    pushed->laws.lever[NT_X] = pushed->laws.lever[NT_Y] = slave->link.rig.probe.lateral_stiffness;
    pushed->laws.lever[NT_Z] = 0.0;
    place_of_tip(slave, setup->clearance, base);
    return nt_particles_begin(&pushed->laws, base, &pushed->state);
}

nt_status nt_sim_push_particles(const nt_sim_slave *slave, double height, nt_particles_state *to)
{
    double base[NT_AXES];
    *to = slave->pushed.state;
    place_of_tip(slave, height, base);
    return nt_particles_advance(&slave->pushed.laws, to, base);
}

/* Nothing is touched any more: which of them lie elsewhere? */
static void tell_left(nt_sim_particles *pushed)
{
    for (int i = 0; i < pushed->state.count; ++i) {
        const double *now = pushed->state.particles[i].position;
        if (!(fabs(now[NT_X] - pushed->rested[i][NT_X]) + fabs(now[NT_Y] - pushed->rested[i][NT_Y]) > MOVED))
            continue;
        pushed->left |= 1u << i;
        memcpy(pushed->before[i], pushed->rested[i], sizeof pushed->before[i]);
        memcpy(pushed->rested[i], now, sizeof pushed->rested[i]);
    }
}

void nt_sim_keep_particles(nt_sim_slave *slave, const nt_particles_state *state)
{
    nt_sim_particles *pushed = &slave->pushed;
    const int touched = nt_particles_touches(&pushed->state);
    for (int i = 0; i < state->count; ++i) {
        const int was = pushed->state.particles[i].attached[NT_AT_TIP], is = state->particles[i].attached[NT_AT_TIP];
        pushed->touches[i] += is && !was;
        pushed->losses[i] += was && !is;
    }
    pushed->state = *state;
    if (touched && !nt_particles_touches(state))
        tell_left(pushed);
}

nt_status nt_sim_lay(nt_sim_slave *slave, int number, const double place[2])
{
    nt_sim_particles *pushed = &slave->pushed;
    if (!pushed->can)
        return NT_E_UNSUPPORTED;
    double base[NT_AXES];
    nt_particles_state laid = pushed->state;
    place_of_tip(slave, slave->truth.tip_height, base);
    nt_status status = laid.count > 0 ? NT_OK : nt_particles_begin(&pushed->laws, base, &laid);
    if (status == NT_OK)
        status = nt_particles_lay(&pushed->laws, &laid, number, place);
    if (status != NT_OK)
        return status;
    pushed->state = laid;
    memcpy(pushed->rested[number], place, sizeof pushed->rested[number]);
    slave->law_gap = NAN; /* the force on the tip is another one */
    return NT_OK;
}
