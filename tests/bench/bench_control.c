/* SPDX-License-Identifier: BSD-3-Clause
 * What a control period costs, in instructions and nanoseconds: the touch step alone (supervisor, law, passivity,
 * limits, stage loop), fed with the samples of a touch in contact, and the complete simulated cycle of that touch
 * (read, touch step, record, write, and the plant for a period). Instructions are those of this process as the
 * processor counts them; null where it does not let us. Prints JSON. */
#if defined(__linux__)
#define _GNU_SOURCE
#endif

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../c/larger.h"
#include "internal/session.h"
#include "nanotouch/nanotouch.h"

enum { TICKS = 20000 };
static nt_record records[TICKS];
static nt_sample samples[TICKS];
static double times[TICKS]; /* [ns] */

#if defined(__linux__)
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

/* A counter of instructions in user space; -1 if there is none. */
static int open_counter(void)
{
    struct perf_event_attr wanted;
    memset(&wanted, 0, sizeof wanted);
    wanted.size = sizeof wanted;
    wanted.type = PERF_TYPE_HARDWARE;
    wanted.config = PERF_COUNT_HW_INSTRUCTIONS;
    wanted.exclude_kernel = 1;
    wanted.exclude_hv = 1;
    return (int)syscall(SYS_perf_event_open, &wanted, 0, -1, -1, 0);
}

static double read_counter(int counter)
{
    unsigned long long count = 0;
    return counter >= 0 && read(counter, &count, sizeof count) == sizeof count ? (double)count : (double)NAN;
}
#else
static int open_counter(void)
{
    return -1;
}

static double read_counter(int counter)
{
    (void)counter;
    return (double)NAN;
}
#endif

static double now(void)
{
    static time_t origin; /* seconds since 1970 leave no nanoseconds to a double */
    struct timespec t;
    if (timespec_get(&t, TIME_UTC) == 0)
        return NAN;
    origin = origin ? origin : t.tv_sec;
    return 1e9 * (double)(t.tv_sec - origin) + (double)t.tv_nsec;
}

/* What is measured: one period. */
typedef void (*period)(void *context, int tick);

typedef struct step_bench {
    const nt_touch *touch;
    nt_touch_state state;
} step_bench;

static void run_step(void *context, int tick)
{
    step_bench *b = context;
    nt_command command;
    nt_touch_step(b->touch, &b->state, &samples[tick], &command);
}

static void run_cycle(void *context, int tick)
{
    if (nt_session_advance(context, 1) != NT_OK || nt_session_read(context, &records[tick], 1) != 1)
        abort();
}

static void run_nothing(void *context, int tick)
{
    (void)context;
    (void)tick;
}

static int rising(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct cost {
    double instructions, mean, median, rare; /* mean of the best block, p50 and p99.9 of single periods [ns] */
} cost;

static cost measure(period run, void *context, int counter)
{
    cost found;
    const double instructions = read_counter(counter);
    found.mean = HUGE_VAL;
    for (int block = 0; block < 10; block++) { /* the least: whatever disturbs a measurement makes it longer */
        const double start = now();
        for (int i = 0; i < TICKS / 20; i++)
            run(context, block * (TICKS / 20) + i);
        found.mean = smaller(found.mean, (now() - start) / (TICKS / 20));
    }
    found.instructions = (read_counter(counter) - instructions) / (TICKS / 2);
    for (int i = TICKS / 2; i < TICKS; i++) {
        const double before = now();
        run(context, i);
        times[i] = now() - before;
    }
    qsort(times + TICKS / 2, TICKS / 2, sizeof *times, rising);
    found.median = times[TICKS / 2 + TICKS / 4];
    found.rare = times[TICKS / 2 + TICKS / 2 * 999 / 1000];
    return found;
}

static void report(const char *name, const cost *found, const cost *nothing)
{
    printf(",\n  \"%s\": {\"instructions\": ", name);
    if (isfinite(found->instructions))
        printf("%.0f", found->instructions - nothing->instructions);
    else
        printf("null");
    printf(", \"ns\": %.1f, \"ns_p50\": %.0f, \"ns_p99.9\": %.0f}", found->mean - nothing->mean,
           found->median - nothing->median, found->rare - nothing->median);
}

/* Pressed with 1 N, at rest. */
static nt_session *open_pressed(nt_mode mode)
{
    nt_session_setup setup = nt_session_defaults();
    const nt_input input = {.operator_force[NT_Z] = 1.0, .duration = 0.5};
    nt_session *session = NULL;
    setup.mode = mode;
    setup.clearance = 20e-9;
    if (nt_session_open(&session, &setup, NULL) != NT_OK || nt_session_aim(session, &input, NULL) != NT_OK)
        return NULL;
    for (int i = 0; i < 2; i++)
        if (nt_session_advance(session, TICKS) != NT_OK || nt_session_read(session, records, TICKS) != TICKS)
            return NULL;
    return session;
}

static nt_sample sample_of(const nt_record *record)
{
    nt_sample sample = {
        .tick = record->tick, .age = record->age, .master_age = record->master_age, .flags = record->flags};
    for (int i = 0; i < NT_AXES; i++) {
        sample.master_position[i] = record->master_position[i];
        sample.operator_force[i] = record->operator_force[i];
        sample.stage_position[i] = record->stage_position[i];
        sample.deflection[i] = record->deflection[i];
    }
    return sample;
}

int main(void)
{
    const int counter = open_counter();
    printf("{\n  \"version\": \"%s\"", nt_version());
    const cost nothing = measure(run_nothing, NULL, counter);
    for (int mode = NT_MODE_TOUCH; mode <= NT_MODE_TOPOGRAPHY; mode++) {
        nt_session *session = open_pressed((nt_mode)mode);
        if (!session)
            return 1;
        step_bench b = {.touch = nt_session_touch(session), .state = *nt_session_touch_state(session)};
        const cost cycle = measure(run_cycle, session, counter);
        for (int i = 0; i < TICKS; i++)
            samples[i] = sample_of(&records[i]);
        const cost step = measure(run_step, &b, counter);
        report(mode == NT_MODE_TOUCH ? "touch step" : "topography step", &step, &nothing);
        report(mode == NT_MODE_TOUCH ? "simulated cycle in contact" : "simulated topography cycle", &cycle, &nothing);
        nt_session_close(session);
    }
    printf("\n}\n");
    return 0;
}
