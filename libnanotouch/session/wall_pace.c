/* SPDX-License-Identifier: BSD-3-Clause
 * Wall pace with a real master. The slave is simulated, so that lateness can only slow the clock down; but the motor on
 * the hand is an actuator. Ticks are run in batches, one for each wake-up, and a machine wakes up late: a reading and a
 * force are held so much longer. To the loop that is a master that measures less often by both (sampled.c: its hold
 * counts on the way in and on the way out). */
#include <math.h>

#include "session/state.h"

#define WAKE 1000000 /* at the most between two wake-ups [ns] */

enum { LOOKS = 60, COUNTED = 54 }; /* wake-ups that are measured; of these in order the one that counts */

static int is_real(const nt_hal *half)
{
    return (half->capabilities.can & NT_IS_REAL) != 0;
}

nt_pace nt_session_pace(const nt_session *session)
{
    if (is_real(&session->slave))
        return NT_PACE_HARD;
    return is_real(&session->master) ? NT_PACE_WALL : NT_PACE_FREE;
}

nt_status nt_session_check_pace(const nt_session *session, nt_pace pace)
{
    const uint32_t can = session->master.capabilities.can | session->slave.capabilities.can;
    if (pace < nt_session_pace(session))
        return NT_E_UNSUPPORTED;
    return pace == NT_PACE_HARD && can & NT_IS_SLOW ? NT_E_UNSUPPORTED : NT_OK;
}

int64_t nt_wall_wake(const nt_session *session)
{
    return llround(fmin(WAKE, 0.5e9 * nt_wall_longest_lag(session)));
}

/* A motor that is not simulated here may have a hand on it, whether or not its program says so. */
static int is_driven(const nt_session *session)
{
    const int pushes = !session->simulates[NT_HALF_MASTER] && session->master.capabilities.can & NT_CAN_PUSH;
    return !is_real(&session->slave) && (is_real(&session->master) || pushes);
}

nt_wall_pace nt_session_wall_pace(const nt_session *session)
{
    nt_wall_pace found = session->wall;
    if (found.margin.rule)
        return found;
    found.margin = (nt_verdict){.margin = INFINITY, .rule = "", .field = ""};
    found.hold = is_driven(session) && !session->leader ? 1e-9 * (double)nt_wall_wake(session) : 0.0;
    return found;
}

static double measured_latency(int64_t wake)
{
    double late[LOOKS];
    for (int i = 0; i < LOOKS; ++i) {
        const int64_t due = nt_clock_now() + wake;
        (void)nt_clock_sleep_until(due);
        const double found = 1e-9 * (double)(nt_clock_now() - due);
        int at = i;
        for (; at > 0 && late[at - 1] > found; --at) /* in order */
            late[at] = late[at - 1];
        late[at] = found;
    }
    return late[COUNTED - 1];
}

/* The rig as the loop has it at wall pace. */
static nt_rig delayed(const nt_session *session, const nt_wall_pace *wall)
{
    nt_rig rig = session->now->touch.rig;
    const double own = fmax(session->now->touch.period, rig.master.rate > 0.0 ? 1.0 / rig.master.rate : 0.0);
    rig.master.rate = 1.0 / (own + wall->hold + wall->latency);
    return rig;
}

nt_status nt_wall_judge(nt_session *session)
{
    if (!is_driven(session))
        return NT_OK;
    nt_wall_pace found = nt_session_wall_pace(session);
    found.latency = session->leader ? 0.0 : measured_latency(nt_wall_wake(session));
    nt_composition judged = *session->now;
    judged.touch.rig = delayed(session, &found);
    found.margin = nt_composition_judge(&judged, &judged.setup.settings, judged.setup.mode);
    session->wall = found;
    return nt_composition_allows(&judged, found.margin.margin) ? NT_OK : NT_E_RANGE;
}

nt_motor_bound nt_session_motor_bound(const nt_session *session)
{
    const nt_wall_pace wall = nt_session_wall_pace(session);
    nt_rig rig = session->now->setup.rig;
    rig.converters.dac_latency += wall.hold + wall.latency;
    return nt_motor_bound_compute(&rig, &session->now->setup.settings);
}
