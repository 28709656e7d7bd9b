/* SPDX-License-Identifier: BSD-3-Clause
 * A session on the simulated rig: down onto a ridge, across it, up again; two faults on the way. Prints the sums of
 * what it recorded, which must be the same on every machine (same_bits.py). */
#include <math.h>
#include <stdio.h>

#include "internal/session.h"
#include "nanotouch/nanotouch.h"

enum { SIZE = 32, BLOCK = 1000, COLUMNS = 5 };
#define STEP 20e-9 /* of the map [m] */

/* FNV-1a over the bytes of numbers. */
typedef struct column {
    const char *name;
    uint64_t sum;
} column;

static void add(column *to, const void *numbers, size_t size)
{
    const unsigned char *bytes = numbers;
    for (size_t i = 0; i < size; ++i)
        to->sum = (to->sum ^ bytes[i]) * 0x100000001b3u;
}

/* In one array each: a record has no holes, but nobody has promised it. */
static void add_record(column *columns, const nt_record *r)
{
    const uint32_t state[] = {r->flags, r->phase, r->state, r->reasons};
    const double hand[] = {r->master_position[NT_Z], r->operator_force[NT_Z], r->motor_force[NT_Z]};
    const double times[] = {r->time, r->age, r->master_age, r->lateness};
    const double truth[] = {r->gap, r->contact_radius, r->surface_height};
    add(&columns[0], state, sizeof state);
    add(&columns[1], hand, sizeof hand);
    add(&columns[2], r->stage_position, sizeof r->stage_position);
    add(&columns[2], r->stage_command, sizeof r->stage_command);
    add(&columns[2], r->deflection, sizeof r->deflection);
    add(&columns[3], truth, sizeof truth);
    add(&columns[3], r->tip_force, sizeof r->tip_force);
    add(&columns[4], times, sizeof times);
}

static nt_status run(nt_session *session, const nt_input *input, double period, column *columns, double *largest)
{
    static nt_record records[BLOCK];
    nt_status status = nt_session_aim(session, input, NULL);
    for (long left = lround(input->duration / period); left > 0 && status == NT_OK; left -= BLOCK) {
        status = nt_session_advance(session, left < BLOCK ? left : BLOCK);
        const long got = nt_session_read(session, records, BLOCK);
        for (long i = 0; i < got; ++i) {
            add_record(columns, &records[i]);
            if (records[i].slave_force > *largest) /* a broken sensor gives none */
                *largest = records[i].slave_force;
        }
    }
    return status;
}

/* A ridge of 40 nm along y. */
static nt_session *open_session(nt_problem *problem)
{
    static double heights[SIZE * SIZE];
    static nt_faults faults;
    for (int i = 0; i < SIZE * SIZE; ++i) {
        const double x = (i % SIZE - SIZE / 2) / 6.0;
        heights[i] = 40e-9 * exp(-x * x);
    }
    const nt_fault loud = {
        .kind = NT_FAULT_NOISE, .channel = NT_CHANNEL_DEFLECTION, .start = 1.2, .duration = 0.01, .value = 2.0};
    const nt_fault broken = {
        .kind = NT_FAULT_NAN, .channel = NT_CHANNEL_DEFLECTION, .start = 2.5, .duration = 0.02}; /* it retracts */
    (void)nt_faults_add(&faults, &loud);
    (void)nt_faults_add(&faults, &broken);
    nt_session_setup setup = nt_session_defaults();
    setup.map = (nt_height_map){heights, SIZE, SIZE, STEP, STEP};
    setup.faults = &faults;
    setup.x = setup.y = 5.0 * STEP;
    nt_session *session = NULL;
    return nt_session_open(&session, &setup, problem) == NT_OK ? session : NULL;
}

int main(void)
{
    nt_problem problem = {0};
    nt_session *session = open_session(&problem);
    if (!session) {
        char text[200];
        return fprintf(stderr, "%s\n", nt_problem_print(&problem, text, sizeof text)), 1;
    }
    const uint64_t basis = 0xcbf29ce484222325u;
    column columns[COLUMNS] = {
        {"states", basis}, {"hand", basis}, {"stage and deflection", basis}, {"truth", basis}, {"times", basis}};
    const double y = 10.0 * STEP, far = 25.0 * STEP;
    const nt_input script[] = {
        {.operator_force[NT_Z] = 0.3, .x = 5.0 * STEP, .y = y, .duration = 1.0},
        {.operator_force[NT_Z] = 0.5, .x = far, .y = y, .duration = 2.0},
        {.operator_force[NT_Z] = -0.3, .x = far, .y = y, .duration = 1.0},
    };
    double largest = 0.0;
    nt_status status = NT_OK;
    for (size_t i = 0; i < sizeof script / sizeof *script && status == NT_OK; ++i)
        status = run(session, &script[i], nt_session_touch(session)->period, columns, &largest);
    const nt_touch_state *last = nt_session_touch_state(session);
    printf("%s; ticks %llu, state %d, largest force %.17g N\n", nt_status_message(status),
           (unsigned long long)last->ticks, (int)last->supervisor.state, largest);
    for (int i = 0; i < COLUMNS; ++i)
        printf("%016llx %s\n", (unsigned long long)columns[i].sum, columns[i].name);
    nt_session_close(session);
    return status == NT_OK && largest > 1e-8 ? 0 : 1; /* it did touch */
}
