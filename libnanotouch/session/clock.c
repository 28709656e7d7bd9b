/* SPDX-License-Identifier: BSD-3-Clause
 * The machine's monotonic clock, the clock of the half that leads, what a session at wall pace owes, and one thread at
 * a time where requests are prepared. */
#include <math.h>

#include "internal/session.h"
#include "session/state.h"

#if NT_HAS_SYSTEM
#include <pthread.h>
#endif

#define LONGEST_LAG 0.05  /* further behind than this a session slows down instead of catching up, at the most [s] */
#define SLOWDOWN_TIME 1.0 /* over which the slowdown is told [s] */
#define NAP 100000        /* between two looks at a lock [ns] */

/* A period after the last one. */
static int64_t next_deadline(const nt_session *session)
{
    return session->deadline + llround(1e9 * session->now->touch.period);
}

static void wait_for_deadline(nt_session *session)
{
    const int64_t now = nt_clock_now(), next = next_deadline(session);
    session->deadline = next > now ? next : now;
    (void)nt_clock_sleep_until(session->deadline);
}

void nt_session_keep_time(nt_session *session)
{
    if (!session->leader && (session->clock || isfinite(nt_session_own_period(session))))
        wait_for_deadline(session);
}

nt_status nt_session_follow_leader(nt_session *session)
{
    nt_hal *leader = session->leader;
    const uint64_t before = leader->reading.sequence;
    const int64_t due = session->deadline > 0 ? next_deadline(session) : INT64_MAX;
    session->waits = 1;
    const nt_status status = nt_hal_read(leader);
    session->waits = 0;
    if (leader->reading.sequence == before || leader->reading.flags & NT_SAMPLE_DEVICE_LOST)
        wait_for_deadline(session);
    else
        session->deadline = nt_clock_now();
    const double late = session->deadline > due ? 1e-9 * (double)(session->deadline - due) : 0.0;
    session->lateness = late > leader->reading.lateness ? late : leader->reading.lateness;
    return status;
}

uintptr_t nt_session_thread(void)
{
#if NT_HAS_SYSTEM
    return (uintptr_t)pthread_self();
#else
    return 1; /* there is no other */
#endif
}

void nt_session_lock(nt_session *session)
{
    while (atomic_flag_test_and_set_explicit(&session->asking, memory_order_acquire))
        (void)nt_clock_sleep_until(nt_clock_now() + NAP);
    atomic_store_explicit(&session->asker, nt_session_thread(), memory_order_relaxed);
}

void nt_session_unlock(nt_session *session)
{
    atomic_store_explicit(&session->asker, 0, memory_order_relaxed);
    atomic_flag_clear_explicit(&session->asking, memory_order_release);
}

/* What is owed is run at once, and meanwhile no device says anything new. A quarter of a device's own period is the
 * most: twice that may come between two readings, half a period more than they are apart, and two make it stale. A real
 * master without one measures in every period. */
double nt_wall_longest_lag(const nt_session *session)
{
    const double period = session->now->touch.period;
    const double own = session->master.capabilities.can & NT_IS_REAL && session->master.capabilities.period == 0.0
                           ? period
                           : nt_session_own_period(session);
    const double due = fmax(0.25 * own, 2.0 * period);
    return fmin(LONGEST_LAG, due);
}

double nt_wall_look(nt_wall_clock *clock, double speed)
{
    const int64_t now = nt_clock_now();
    const double passed = 1e-9 * (double)(now - clock->last);
    clock->last = now;
    clock->passed = passed;
    clock->due += speed * passed;
    const double lost = fmax(0.0, clock->due - speed * clock->lag);
    clock->due -= lost;
    const double share = -expm1(-passed / SLOWDOWN_TIME);
    if (passed > 0.0)
        clock->lost += share * (lost / (speed * passed) - clock->lost);
    return 1.0 / fmax(1e-9, 1.0 - clock->lost);
}

int nt_session_runs_here(const nt_session *session)
{
    const uintptr_t here = nt_session_thread();
    return atomic_load_explicit(&session->ticker, memory_order_relaxed) == here ||
           atomic_load_explicit(&session->asker, memory_order_relaxed) == here;
}
