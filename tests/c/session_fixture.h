/* SPDX-License-Identifier: BSD-3-Clause
 * Sessions that open, and what every test of a session does with them. Include after cmocka. */
#ifndef TESTS_SESSION_FIXTURE_H
#define TESTS_SESSION_FIXTURE_H

#include <math.h>

#include "nanotouch/nanotouch.h"

static inline nt_session *open_session(const nt_session_setup *setup)
{
    nt_session *session = NULL;
    nt_problem problem = {0};
    const nt_status status = nt_session_open(&session, setup, &problem);
    if (status != NT_OK)
        fail_msg("%s: %s %g", nt_status_message(status), problem.field ? problem.field : "?", problem.value);
    return session;
}

/* A hand that pushes, the tip where it is. */
static inline void push(nt_session *session, double force, double duration)
{
    const nt_input input = {
        .operator_force = {[NT_Z] = force}, .x = (double)NAN, .y = (double)NAN, .duration = duration};
    assert_int_equal(nt_session_aim(session, &input, NULL), NT_OK);
}

/* Runs and reads as many ticks. */
static inline void run(nt_session *session, nt_record *records, long ticks)
{
    assert_int_equal(nt_session_advance(session, ticks), NT_OK);
    assert_int_equal(nt_session_read(session, records, ticks), ticks);
}

/* What the touch step was given in a tick. */
static inline nt_sample sample_of(const nt_record *record)
{
    nt_sample sample = {.tick = record->tick,
                        .age = record->age,
                        .master_age = record->master_age,
                        .lateness = record->lateness,
                        .flags = record->flags};
    for (int i = 0; i < NT_AXES; i++) {
        sample.master_position[i] = record->master_position[i];
        sample.operator_force[i] = record->operator_force[i];
        sample.stage_position[i] = record->stage_position[i];
        sample.deflection[i] = record->deflection[i];
    }
    return sample;
}

#endif
