/* SPDX-License-Identifier: BSD-3-Clause
 * A session in a thread of its own, at one of three paces. Free: as fast as it goes. Wall: time is virtual; the thread
 * wakes each millisecond and runs the ticks that are due, so a machine that cannot keep up slows the session down, and
 * no tick is late or lost. Hard: each tick at its deadline on the monotonic clock (loop.c). Where a half leads the
 * clock, its readings give the ticks at any pace. */
#if defined(__linux__)
#define _POSIX_C_SOURCE 200809L
#endif

#include "session/frames_memory.h"
#include "session/state.h"

#if NT_HAS_SYSTEM

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include "core/problem.h"
#include "internal/session.h"

#define WAKE 1000000              /* wall pace: [ns] */
enum { BATCH = 64 };              /* ticks between two looks at what was asked of the thread */
enum { MOST_STEPS = 1000000000 }; /* that wait to be done */

struct nt_runner {
    pthread_t thread, keeper; /* the loop; and who prepares what clients of published frames ask for */
    int has_keeper;
    pid_t process;
    nt_pace pace;
    uint64_t last;                               /* tick to end before; 0: none */
    atomic_int halts, paused, stands, has_ended; /* stands: the thread has seen the pause */
    atomic_long steps;                           /* that a paused one still has to do */
    _Atomic(double) speed;                       /* session time over time on the clock */
    _Atomic(double) slowdown, worst_delay;
    atomic_ullong ticks;
    atomic_int status;
};

/* --- the thread --- */

static int is_over(const nt_session *session)
{
    const nt_runner *runner = session->runner;
    return atomic_load_explicit(&runner->halts, memory_order_acquire) ||
           (runner->last != 0 && session->touch_state.ticks >= runner->last);
}

static int has_room(const nt_session *session)
{
    if (session->comes_back && nt_session_events_are_full(session))
        return 0;
    return !session->records || nt_ring_count(&session->ring) < session->ring.capacity;
}

/* Up to `wanted` ticks; fewer where the ring is full, or it is over. Returns how many; below 0: it failed. */
static long run_ticks(nt_session *session, long wanted)
{
    long done = 0;
    while (done < wanted && has_room(session) && !is_over(session)) {
        nt_history_keep(session);
        const nt_status status = nt_session_tick(session);
        if (status != NT_OK) {
            atomic_store(&session->runner->status, (int)status);
            return -1;
        }
        ++done;
    }
    atomic_store_explicit(&session->runner->ticks, session->touch_state.ticks, memory_order_relaxed);
    return done;
}

static void rest(nt_session *session, int64_t deadline)
{
    if (session->frames)
        nt_frames_beat(session->frames);
    (void)nt_clock_sleep_until(deadline);
}

/* Some of the steps that are granted; what has been done is taken off, unless a new pause has taken all. */
static long run_steps(nt_session *session)
{
    atomic_long *steps = &session->runner->steps;
    const long granted = atomic_load(steps), done = run_ticks(session, granted < BATCH ? granted : BATCH);
    long left = atomic_load(steps);
    while (done > 0 && left > 0 && !atomic_compare_exchange_weak(steps, &left, left > done ? left - done : 0))
        continue;
    return done;
}

/* What is asked while no tick runs. */
static void take_requests(nt_session *session)
{
    if (session->frames)
        nt_session_take_clients(session);
    nt_session_take_calls(session);
}

/* Paused: what is asked is done, and steps that are granted. */
static long pass_pause(nt_session *session)
{
    take_requests(session);
    const long done = run_steps(session);
    if (done == 0) {
        session->comes_back = !session->simulates[NT_HALF_MASTER];
        atomic_store(&session->runner->stands, 1);
    }
    if (done < BATCH)
        rest(session, nt_clock_now() + WAKE);
    return done;
}

static void run_free(nt_session *session)
{
    int64_t beat = 0;
    while (!is_over(session)) {
        const int paused = atomic_load(&session->runner->paused);
        const long done = paused ? pass_pause(session) : run_ticks(session, BATCH);
        if (done < 0)
            return;
        const int64_t now = nt_clock_now();
        if (!paused && done < BATCH) { /* no room: a reader has to come, who may be asking for something */
            take_requests(session);
            rest(session, now + WAKE / 4);
        }
        if (now - beat > 50 * WAKE && session->frames) {
            nt_frames_beat(session->frames);
            beat = now;
        }
    }
}

/* How many ticks are due; where a half leads the clock, the next one whenever it comes. */
static long due_ticks(const nt_session *session, nt_wall_clock *clock)
{
    if (!session->leader)
        return (long)(clock->due / session->now->touch.period);
    clock->due = fmax(clock->due, 0.0); /* it may be early */
    return 1;
}

static void keep_worst(nt_runner *runner, double delay)
{
    if (delay > atomic_load_explicit(&runner->worst_delay, memory_order_relaxed))
        atomic_store_explicit(&runner->worst_delay, delay, memory_order_relaxed);
}

static void wait_for_wake(nt_session *session, int64_t deadline)
{
    const int waits = deadline > nt_clock_now();
    rest(session, deadline);
    if (waits)
        keep_worst(session->runner, 1e-9 * (double)(nt_clock_now() - deadline));
}

static void run_wall(nt_session *session)
{
    nt_runner *runner = session->runner;
    const double period = session->now->touch.period;
    nt_wall_clock clock = {.last = nt_clock_now(), .lag = nt_wall_longest_lag(session)};
    const int64_t wake = nt_wall_wake(session);
    while (!is_over(session)) {
        if (atomic_load(&runner->paused)) {
            if (pass_pause(session) < 0)
                return;
            clock.last = nt_clock_now();
            continue;
        }
        atomic_store(&runner->slowdown, nt_wall_look(&clock, atomic_load(&runner->speed)));
        const long done = run_ticks(session, nt_wall_ticks(session, &clock, due_ticks(session, &clock)));
        if (done < 0)
            return;
        if (done == 0)
            take_requests(session);
        clock.due -= (double)done * period;
        wait_for_wake(session, session->leader && done > 0 ? clock.last : clock.last + wake);
    }
}

static int hard_tick(void *context, uint64_t tick, double lateness)
{
    nt_session *session = context;
    nt_runner *runner = session->runner;
    (void)tick;
    session->lateness = lateness;
    const nt_status status = nt_session_tick(session);
    keep_worst(runner, session->lateness);
    atomic_store_explicit(&runner->ticks, session->touch_state.ticks, memory_order_relaxed);
    if (status != NT_OK)
        atomic_store(&runner->status, (int)status);
    return status != NT_OK || is_over(session);
}

static void run_hard(nt_session *session)
{
    int64_t (*const before)(void) = session->clock;
    session->may_drop = 1;
    session->clock = nt_clock_now;
    nt_status status = NT_OK;
    if (!session->leader)
        status = nt_loop_run(session->now->touch.period, UINT64_MAX, hard_tick, session, NULL);
    else
        while (hard_tick(session, 0, 0.0) == 0)
            continue;
    if (status != NT_OK)
        atomic_store(&session->runner->status, (int)status);
    session->may_drop = 0;
    session->clock = before;
    session->lateness = 0.0;
}

/* Prepares what clients ask for, while the loop runs. */
static void *serve(void *context)
{
    nt_session *session = context;
    while (!atomic_load_explicit(&session->runner->has_ended, memory_order_acquire)) {
        nt_session_serve_clients(session);
        (void)nt_clock_sleep_until(nt_clock_now() + 2 * WAKE);
    }
    return NULL;
}

static void *run(void *context)
{
    nt_session *session = context;
    nt_session_enter(session);
    switch (session->runner->pace) {
    case NT_PACE_FREE:
        run_free(session);
        break;
    case NT_PACE_WALL:
        run_wall(session);
        break;
    case NT_PACE_HARD:
        run_hard(session);
        break;
    }
    nt_session_leave(session);
    atomic_store_explicit(&session->runner->has_ended, 1, memory_order_release);
    return NULL;
}

/* --- from outside --- */

nt_status nt_session_start(nt_session *session, nt_pace pace, uint64_t ticks)
{
    if (!session || (unsigned)pace > NT_PACE_HARD)
        return NT_E_ARGUMENT;
    if (session->runner || nt_session_runs_here(session) || (session->frames && !nt_frames_are_own(session->frames)))
        return NT_E_STATE;
    nt_status status = nt_session_check_pace(session, pace);
    if (status == NT_OK && nt_session_events_are_full(session))
        status = NT_E_CAPACITY;
    if (status == NT_OK && pace == NT_PACE_WALL)
        status = nt_wall_judge(session);
    if (status != NT_OK)
        return status;
    nt_runner *runner = calloc(1, sizeof *runner);
    if (!runner)
        return NT_E_NO_MEMORY;
    runner->pace = pace;
    runner->process = getpid();
    runner->last = ticks > 0 ? session->touch_state.ticks + ticks : 0;
    atomic_init(&runner->speed, 1.0);
    atomic_init(&runner->slowdown, 1.0);
    atomic_init(&runner->ticks, session->touch_state.ticks);
    session->deadline = 0; /* nothing is late yet */
    session->comes_back = !session->simulates[NT_HALF_MASTER];
    status = pace == NT_PACE_HARD ? NT_OK : nt_history_make(session);
    session->runner = runner;
    if (status == NT_OK && pthread_create(&runner->thread, NULL, run, session) == 0) {
        runner->has_keeper = session->frames && pthread_create(&runner->keeper, NULL, serve, session) == 0;
        return NT_OK;
    }
    session->runner = NULL;
    free(runner);
    return NT_E_NO_MEMORY;
}

nt_status nt_session_halt(nt_session *session)
{
    if (!session)
        return NT_E_ARGUMENT;
    nt_runner *runner = session->runner;
    if (nt_session_runs_here(session))
        return NT_E_STATE;
    if (!runner)
        return NT_OK;
    atomic_store_explicit(&runner->halts, 1, memory_order_release);
    if (runner->process == getpid()) { /* threads do not come along with a fork */
        (void)pthread_join(runner->thread, NULL);
        if (runner->has_keeper)
            (void)pthread_join(runner->keeper, NULL);
    }
    const nt_status status = (nt_status)atomic_load(&runner->status);
    session->runner = NULL;
    free(runner);
    return status;
}

static nt_status check_not_hard(const nt_session *session)
{
    if (!session)
        return NT_E_ARGUMENT;
    return session->runner && session->runner->pace != NT_PACE_HARD ? NT_OK : NT_E_STATE;
}

nt_status nt_session_pause(nt_session *session, int paused)
{
    const nt_status status = check_not_hard(session);
    if (status != NT_OK)
        return status;
    atomic_store(&session->runner->stands, 0); /* set again by the thread alone, once it has seen the pause */
    atomic_store(&session->runner->paused, paused != 0);
    atomic_store(&session->runner->steps, 0);
    return NT_OK;
}

nt_status nt_session_step_on(nt_session *session, long ticks)
{
    nt_status status = check_not_hard(session);
    if (status == NT_OK && !(ticks >= 0 && ticks <= MOST_STEPS - atomic_load(&session->runner->steps)))
        status = NT_E_RANGE;
    if (status == NT_OK && !atomic_load(&session->runner->paused))
        status = NT_E_STATE;
    if (status == NT_OK)
        atomic_fetch_add(&session->runner->steps, ticks);
    return status;
}

nt_status nt_session_set_speed(nt_session *session, double speed, nt_problem *problem)
{
    const nt_status status = check_not_hard(session);
    if (status != NT_OK)
        return status;
    if (session->leader && speed != 1.0)
        return nt_problem_set(problem, "speed of a session whose clock a half leads", "", speed, 1.0, 1.0);
    if (!(speed >= 1e-3 && speed <= 1e3))
        return nt_problem_set(problem, "speed", "", speed, 1e-3, 1e3);
    atomic_store(&session->runner->speed, speed);
    return NT_OK;
}

nt_progress nt_session_progress(const nt_session *session)
{
    const nt_runner *runner = session->runner;
    nt_progress found = {.slowdown = 1.0, .dropped = atomic_load_explicit(&session->dropped, memory_order_relaxed)};
    if (!runner) {
        found.ticks = session->touch_state.ticks;
        return found;
    }
    found.ticks = atomic_load_explicit(&runner->ticks, memory_order_relaxed);
    found.slowdown = atomic_load(&runner->slowdown);
    found.worst_delay = atomic_load(&runner->worst_delay);
    found.runs = !atomic_load_explicit(&runner->has_ended, memory_order_acquire);
    found.paused = atomic_load(&runner->paused);
    found.stands = found.paused && atomic_load(&runner->stands) && atomic_load(&runner->steps) == 0;
    found.status = (nt_status)atomic_load(&runner->status);
    return found;
}

int nt_session_is_running(const nt_session *session)
{
    return session->runner && !atomic_load_explicit(&session->runner->has_ended, memory_order_acquire);
}

nt_status nt_session_await(nt_session *session)
{
    while (atomic_load_explicit(&session->call_status, memory_order_acquire) == NT_CALL_WAITING) {
        if (!nt_session_is_running(session))
            return NT_E_STATE;
        (void)nt_clock_sleep_until(nt_clock_now() + WAKE / 10);
    }
    return NT_OK;
}

#endif
