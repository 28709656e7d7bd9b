/* SPDX-License-Identifier: BSD-3-Clause
 * The machine's monotonic clock, and one thread at a time where requests are prepared. */
#if defined(__linux__)
#define _POSIX_C_SOURCE 200809L
#endif

#include <math.h>

#include "session/state.h"

#if defined(__linux__)

#include <errno.h>
#include <pthread.h>
#include <time.h>

#define NAP 100000 /* between two looks at a lock [ns] */

int64_t nt_session_machine_time(void)
{
    struct timespec now = {0, 0};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

void nt_session_sleep_until(int64_t deadline)
{
    const struct timespec time = {.tv_sec = (time_t)(deadline / 1000000000), .tv_nsec = (long)(deadline % 1000000000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, NULL) == EINTR)
        continue;
}

void nt_session_keep_time(nt_session *session)
{
    if (!session->clock && isinf(nt_session_own_period(session)))
        return;
    const int64_t now = nt_session_machine_time(), next = session->deadline + llround(1e9 * session->now->touch.period);
    session->deadline = next > now ? next : now;
    nt_session_sleep_until(session->deadline);
}

uintptr_t nt_session_thread(void)
{
    return (uintptr_t)pthread_self();
}

void nt_session_lock(nt_session *session)
{
    while (atomic_flag_test_and_set_explicit(&session->asking, memory_order_acquire))
        nt_session_sleep_until(nt_session_machine_time() + NAP);
    atomic_store_explicit(&session->asker, nt_session_thread(), memory_order_relaxed);
}

void nt_session_unlock(nt_session *session)
{
    atomic_store_explicit(&session->asker, 0, memory_order_relaxed);
    atomic_flag_clear_explicit(&session->asking, memory_order_release);
}

#else

int64_t nt_session_machine_time(void)
{
    return 0;
}
void nt_session_sleep_until(int64_t deadline)
{
    (void)deadline;
}
void nt_session_keep_time(nt_session *session)
{
    (void)session;
}
uintptr_t nt_session_thread(void)
{
    return 1;
}
void nt_session_lock(nt_session *session)
{
    atomic_store_explicit(&session->asker, 1, memory_order_relaxed);
}
void nt_session_unlock(nt_session *session)
{
    atomic_store_explicit(&session->asker, 0, memory_order_relaxed);
}

#endif

int nt_session_runs_here(const nt_session *session)
{
    const uintptr_t here = nt_session_thread();
    return atomic_load_explicit(&session->ticker, memory_order_relaxed) == here ||
           atomic_load_explicit(&session->asker, memory_order_relaxed) == here;
}
