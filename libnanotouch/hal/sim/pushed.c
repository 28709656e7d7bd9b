/* SPDX-License-Identifier: BSD-3-Clause
 * What lies on the surface of the simulated slave: laid, pushed, and left by the tip. */
#include <math.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "manipulation/pushed.h"
#include "parts.h"

#define MOVED 1e-10 /* less is no push that is told of [m] ... */
#define TURNED 1e-4 /* ... nor, of a rod [rad] */

/* Pressed into the substrate by less than a nanometre, the tip stands on it. */
static void place_of_tip(const nt_sim_slave *slave, double height, double base[NT_AXES])
{
    base[NT_X] = slave->x;
    base[NT_Y] = slave->y;
    base[NT_Z] = fmax(height, 0.0);
}

nt_status nt_sim_begin_pushed(nt_sim_slave *slave, const nt_sim_setup *setup)
{
    nt_sim_pushed *pushed = &slave->pushed;
    if (!setup->pushed)
        return NT_OK;
    if (setup->probe_model == NT_PROBE_DYNAMIC || setup->lock_in)
        return NT_E_UNSUPPORTED;
    double base[NT_AXES];
    pushed->laws = nt_pushed_under(setup->pushed, slave->link.rig.probe.lateral_stiffness);
    place_of_tip(slave, setup->clearance, base);
    return nt_pushed_begin(&pushed->laws, base, &pushed->state);
}

nt_status nt_sim_lead_pushed(const nt_sim_slave *slave, double height, nt_pushed_state *to)
{
    double base[NT_AXES];
    place_of_tip(slave, height, base);
    return nt_pushed_advance(&slave->pushed.laws, &slave->pushed.state, base, to);
}

static void pose_of(const nt_pushed_body *body, double pose[3])
{
    pose[0] = body->place[NT_X];
    pose[1] = body->place[NT_Y];
    pose[2] = body->angle;
}

/* Nothing is touched any more: which of them lie elsewhere? */
static void tell_left(nt_sim_pushed *pushed)
{
    for (int i = 0; i < pushed->state.count; ++i) {
        const double *rested = pushed->rested[i];
        double now[3];
        pose_of(&pushed->state.bodies[i], now);
        if (!(fabs(now[0] - rested[0]) + fabs(now[1] - rested[1]) > MOVED || fabs(now[2] - rested[2]) > TURNED))
            continue;
        pushed->left |= 1u << i;
        memcpy(pushed->before[i], rested, sizeof pushed->before[i]);
        memcpy(pushed->rested[i], now, sizeof pushed->rested[i]);
    }
}

void nt_sim_keep_pushed(nt_sim_slave *slave, const nt_pushed_state *state)
{
    nt_sim_pushed *pushed = &slave->pushed;
    const int touched = nt_pushed_touches(&pushed->laws, &pushed->state);
    for (int i = 0; i < state->count; ++i) {
        const int was = pushed->state.bodies[i].touched, is = state->bodies[i].touched;
        pushed->touches[i] += is && !was;
        pushed->losses[i] += was && !is;
    }
    nt_pushed_copy(&pushed->laws, &pushed->state, state);
    if (touched && !nt_pushed_touches(&pushed->laws, state))
        tell_left(pushed);
}

nt_status nt_sim_lay(nt_sim_slave *slave, int number, const double pose[3])
{
    nt_sim_pushed *pushed = &slave->pushed;
    if (pushed->laws.kind == NT_PUSHED_NOTHING)
        return NT_E_UNSUPPORTED;
    double base[NT_AXES];
    nt_pushed_state laid;
    nt_status status = NT_OK;
    place_of_tip(slave, slave->truth.tip_height, base);
    if (pushed->state.count > 0)
        nt_pushed_copy(&pushed->laws, &laid, &pushed->state);
    else
        status = nt_pushed_begin(&pushed->laws, base, &laid);
    if (status == NT_OK)
        status = nt_pushed_lay(&pushed->laws, &laid, number, pose);
    if (status != NT_OK)
        return status;
    nt_pushed_copy(&pushed->laws, &pushed->state, &laid);
    pose_of(&laid.bodies[number], pushed->rested[number]);
    slave->law_gap = NAN; /* the force on the tip is another one */
    return NT_OK;
}
