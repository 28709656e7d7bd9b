/* SPDX-License-Identifier: BSD-3-Clause
 * A session in a thread of its own, at one of three paces. Free: as fast as it goes. Wall: time is virtual; the thread
 * wakes each millisecond and runs the ticks that are due, so a machine that cannot keep up slows the session down, and
 * no tick is late or lost. Hard: each tick at its deadline on the monotonic clock (loop.c). */
#if defined(__linux__)
#define _POSIX_C_SOURCE 200809L
#endif

#include "session/frames_memory.h"
#include "session/state.h"

#if defined(__linux__)

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

#include "core/problem.h"

#define WAKE 1000000      /* wall pace: [ns] */
#define LONGEST_LAG 0.05  /* further behind than this a session slows down instead of catching up, at the most [s] */
#define SLOWDOWN_TIME 1.0 /* over which the slowdown is told [s] */
enum { BATCH = 64 };      /* ticks between two looks at what was asked of the thread */
enum { MOST_STEPS = 1000000000 }; /* that wait to be done */

struct nt_runner {
    pthread_t thread, keeper; /* the loop; and who prepares what clients of published frames ask for */
    int has_keeper;
    pid_t process;
    nt_pace pace;
    uint64_t last; /* tick to end before; 0: none */
    atomic_int halts, paused, has_ended;
    atomic_long steps;     /* that a paused one still has to do */
    _Atomic(double) speed; /* session time over time on the clock */
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
    nt_session_sleep_until(deadline);
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

/* Paused: what is asked is done, and steps that are granted. */
static long pass_pause(nt_session *session)
{
    nt_session_take_calls(session);
    const long done = run_steps(session);
    if (done < BATCH)
        rest(session, nt_session_machine_time() + WAKE);
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
        const int64_t now = nt_session_machine_time();
        if (!paused && done < BATCH) { /* no room: a reader has to come, who may be asking for something */
            nt_session_take_calls(session);
            rest(session, now + WAKE / 4);
        }
        if (now - beat > 50 * WAKE && session->frames) {
            nt_frames_beat(session->frames);
            beat = now;
        }
    }
}

/* Time that the session owes its person, and how much slower than it should it goes. */
typedef struct wall_clock {
    int64_t last; /* when it was looked at [ns] */
    double lag;   /* the most that it may owe [s] */
    double due;   /* session time that has to be run yet [s] */
    double lost;  /* share of time that could not be run, lately [-] */
} wall_clock;

/* What is owed is run at once, and meanwhile no device says anything new. A quarter of a device's own period is the
 * most: twice that may come between two readings, half a period more than they are apart, and two make it stale. */
static double longest_lag(const nt_session *session)
{
    const double due = fmax(0.25 * nt_session_own_period(session), 2.0 * session->now->touch.period);
    return fmin(LONGEST_LAG, due);
}

static void look_at(wall_clock *clock, nt_runner *runner)
{
    const int64_t now = nt_session_machine_time();
    const double passed = 1e-9 * (double)(now - clock->last), speed = atomic_load(&runner->speed);
    clock->last = now;
    clock->due += speed * passed;
    const double lost = fmax(0.0, clock->due - speed * clock->lag);
    clock->due -= lost;
    const double share = -expm1(-passed / SLOWDOWN_TIME);
    if (passed > 0.0)
        clock->lost += share * (lost / (speed * passed) - clock->lost);
    atomic_store(&runner->slowdown, 1.0 / fmax(1e-9, 1.0 - clock->lost));
}

static void run_wall(nt_session *session)
{
    nt_runner *runner = session->runner;
    const double period = session->now->touch.period;
    wall_clock clock = {.last = nt_session_machine_time(), .lag = longest_lag(session)};
    const int64_t wake = llround(fmin(WAKE, 0.5e9 * clock.lag));
    while (!is_over(session)) {
        if (atomic_load(&runner->paused)) {
            if (pass_pause(session) < 0)
                return;
            clock.last = nt_session_machine_time();
            continue;
        }
        look_at(&clock, runner);
        const long done = run_ticks(session, (long)(clock.due / period));
        if (done < 0)
            return;
        if (done == 0)
            nt_session_take_calls(session);
        clock.due -= (double)done * period;
        rest(session, clock.last + wake);
    }
}

static int hard_tick(void *context, uint64_t tick, double lateness)
{
    nt_session *session = context;
    nt_runner *runner = session->runner;
    (void)tick;
    session->lateness = lateness;
    if (lateness > atomic_load_explicit(&runner->worst_delay, memory_order_relaxed))
        atomic_store_explicit(&runner->worst_delay, lateness, memory_order_relaxed);
    const nt_status status = nt_session_tick(session);
    atomic_store_explicit(&runner->ticks, session->touch_state.ticks, memory_order_relaxed);
    if (status != NT_OK)
        atomic_store(&runner->status, (int)status);
    return status != NT_OK || is_over(session);
}

static void run_hard(nt_session *session)
{
    int64_t (*const before)(void) = session->clock;
    session->may_drop = 1;
    session->clock = nt_session_machine_time;
    const nt_status status = nt_loop_run(session->now->touch.period, UINT64_MAX, hard_tick, session, NULL);
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
        nt_session_sleep_until(nt_session_machine_time() + 2 * WAKE);
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
        nt_session_sleep_until(nt_session_machine_time() + WAKE / 10);
    }
    return NT_OK;
}

#else

nt_status nt_session_start(nt_session *session, nt_pace pace, uint64_t ticks)
{
    (void)session, (void)pace, (void)ticks;
    return NT_E_UNSUPPORTED;
}
nt_status nt_session_halt(nt_session *session)
{
    (void)session;
    return NT_OK;
}
nt_status nt_session_pause(nt_session *session, int paused)
{
    (void)session, (void)paused;
    return NT_E_UNSUPPORTED;
}
nt_status nt_session_step_on(nt_session *session, long ticks)
{
    (void)session, (void)ticks;
    return NT_E_UNSUPPORTED;
}
nt_status nt_session_set_speed(nt_session *session, double speed, nt_problem *problem)
{
    (void)session, (void)speed, (void)problem;
    return NT_E_UNSUPPORTED;
}
nt_progress nt_session_progress(const nt_session *session)
{
    return (nt_progress){.ticks = session->touch_state.ticks, .slowdown = 1.0};
}
int nt_session_is_running(const nt_session *session)
{
    (void)session;
    return 0;
}
nt_status nt_session_await(nt_session *session)
{
    (void)session;
    return NT_E_UNSUPPORTED;
}

#endif
