/* SPDX-License-Identifier: BSD-3-Clause
 * Wall pace with a real master. The slave is simulated, so that lateness can only slow the clock down; but the motor on
 * the hand is an actuator. Ticks are run in batches, one for each wake-up, and a machine wakes up late: a reading and a
 * force are held so much longer. To the loop that is a master that measures less often by both (sampled.c: its hold
 * counts on the way in and on the way out). */
#include <limits.h>
#include <math.h>

#include "internal/control.h"
#include "session/state.h"

#define WAKE 1000000 /* at the most between two wake-ups [ns] */
#define FRESH 2.0    /* of its periods a master's reading is fresh for; the supervisor holds then */
#define OWN_STALL                                                                                                      \
    2e-3 /* of the time between two looks no more counts as waiting for the master: this thread stood [s] */
#define MOST_LOST 0.5 /* of the time: a master that is late so often is not waited for */

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

/* For how many more ticks the master's reading is fresh. On the machine's clock hardly any time passes in a batch. */
static long fresh_ticks(const nt_session *session)
{
    const double period = session->now->touch.period;
    const int64_t next = session->clock ? session->clock() : session->time + llround(1e9 * period);
    const double left =
        FRESH * session->now->touch.supervisor.master_period - 1e-9 * (double)(next - session->master.reading.time);
    if (left < 0.0)
        return 0;
    return session->clock ? LONG_MAX : 1 + (long)(left / period);
}

/* It is gone, or bad, or somebody stops: ticks have to tell. */
static int is_urgent(const nt_session *session)
{
    return atomic_load_explicit(&session->stop, memory_order_relaxed) != 0u ||
           session->master.reading.flags & (NT_SAMPLE_DEVICE_LOST | NT_SAMPLE_INVALID);
}

long nt_wall_ticks(nt_session *session, nt_wall_clock *clock, long due)
{
    if (!is_driven(session) || session->leader || due <= 0)
        return due;
    long fresh = fresh_ticks(session);
    if (fresh < due && nt_hal_read(&session->master) == NT_OK)
        fresh = fresh_ticks(session);
    clock->waited = fresh > 0 ? 0.0 : clock->waited + fmin(clock->passed, OWN_STALL);
    if (fresh > 0)
        return fresh < due ? fresh : due;
    return is_urgent(session) || clock->lost > MOST_LOST || clock->waited > NT_WALL_PATIENCE ? due : 0;
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
    if (is_driven(session) && !session->leader)
        rig.converters.dac_latency += NT_WALL_PATIENCE; /* meanwhile the last force stays */
    return nt_motor_bound_compute(&rig, &session->now->setup.settings);
}
