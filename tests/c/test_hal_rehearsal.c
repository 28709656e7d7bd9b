/* SPDX-License-Identifier: BSD-3-Clause
 * A backend that keeps the contract passes; each single offence is found and named. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "host_fixture.h"

typedef enum offence {
    NONE,
    OPEN_FAILS,
    OPENS_ONCE,
    DESCRIBE_FAILS,
    CONFIGURE_FAILS,
    ARM_FAILS,
    ARMS_ONCE,
    READ_FAILS,
    WRITE_FAILS,
    TOO_MANY_AXES,
    GROWN_CAPABILITIES,
    NAMELESS_CHANNEL,
    WRONG_UNIT,
    WRONG_AXIS,
    EMPTY_RANGE,
    NOISE_IS_NAN,
    UNSAFE,
    NO_SAFE_FORCE,
    READ_IS_SAFE,
    GROWN_READING,
    UNKNOWN_FLAG,
    LOST_BUT_VALID,
    LATE_FOLLOWER,
    LATENESS_IS_NAN,
    FEELS_WITHOUT_GAUGE,
    SIDEWAYS_WITHOUT_AXES,
    VALID_NAN,
    VALID_INFINITY,
    ZERO_FOR_UNKNOWN,
    SEQUENCE_FALLS,
    FROM_THE_FUTURE,
    TIME_FALLS,
    NO_HEARTBEAT,
    NOTHING_AT_FIRST,
    OFFENCES
} offence;

typedef struct device {
    offence is;
    const nt_host *host;
    int opens, closes, arms, disarms, reads, is_open, is_armed;
    int is_out_of_order;
    double left_at; /* what the motor is left at [N] */
} device;

static nt_status open_device(void *context, const nt_host *given, nt_problem *problem)
{
    device *d = context;
    (void)problem;
    d->is_out_of_order |= d->is_open;
    d->is_open = 1;
    d->host = given;
    d->reads = 0;
    ++d->opens;
    if (d->is == OPENS_ONCE && d->opens > 1)
        return NT_E_STATE;
    return d->is == OPEN_FAILS ? NT_E_DEVICE : NT_OK;
}

static nt_channel_row rows[2];

static nt_status describe_device(void *context, nt_capabilities *capabilities)
{
    const offence is = ((device *)context)->is;
    rows[0] = (nt_channel_row){"position", "m", 0, NT_Z, -0.01, 0.01, 1e-6, 0.0, 0.0, NAN};
    rows[1] = (nt_channel_row){"motor", "N", 1, NT_Z, -5.0, 5.0, 0.0, 0.0, 1e-4, 0.0};
    rows[0].name = is == NAMELESS_CHANNEL ? "" : "position";
    rows[0].unit = is == WRONG_UNIT ? "mm" : "m";
    rows[0].axis = is == WRONG_AXIS ? 4 : NT_Z;
    rows[0].maximum = is == EMPTY_RANGE ? -0.01 : 0.01;
    rows[0].noise = is == NOISE_IS_NAN ? (double)NAN : 0.0;
    rows[0].safe = is == READ_IS_SAFE ? 0.0 : (double)NAN;
    rows[1].safe = is == UNSAFE ? 6.0 : is == NO_SAFE_FORCE ? (double)NAN : 0.0;
    capabilities->size += is == GROWN_CAPABILITIES;
    capabilities->can = NT_CAN_PUSH | NT_IS_EVENT_DRIVEN;
    capabilities->axes = is == TOO_MANY_AXES ? 4 : 1;
    capabilities->rows = 2;
    capabilities->channels = rows;
    capabilities->period = 4e-3;
    return is == DESCRIBE_FAILS ? NT_E_DEVICE : NT_OK;
}

static nt_status configure_device(void *context, const nt_configuration *configuration, nt_problem *problem)
{
    device *d = context;
    (void)problem;
    d->is_out_of_order |= !d->is_open || configuration->period != 1e-3 || strcmp(configuration->option, "so") != 0;
    return d->is == CONFIGURE_FAILS ? NT_E_RANGE : NT_OK;
}

static nt_status arm_device(void *context)
{
    device *d = context;
    d->is_out_of_order |= d->is_armed;
    ++d->arms;
    if (d->is == ARM_FAILS || (d->is == ARMS_ONCE && d->arms > 1))
        return NT_E_DEVICE;
    d->is_armed = 1;
    d->left_at = 5.0;
    return NT_OK;
}

static void offend(const device *d, nt_reading *reading)
{
    reading->size += d->is == GROWN_READING;
    reading->flags |= d->is == UNKNOWN_FLAG ? 1u << 20 : 0u;
    reading->flags |= d->is == LOST_BUT_VALID ? (uint32_t)NT_SAMPLE_DEVICE_LOST : 0u;
    reading->lateness = d->is == LATE_FOLLOWER ? 1e-4 : d->is == LATENESS_IS_NAN ? (double)NAN : 0.0;
    if (d->is == FEELS_WITHOUT_GAUGE) {
        reading->felt[NT_Z] = 0.0;
        reading->valid |= 1u << (NT_READS_FELT + NT_Z);
    }
    if (d->is == SIDEWAYS_WITHOUT_AXES) {
        reading->position[NT_X] = 0.0;
        reading->valid |= 1u << NT_X;
    }
    if (d->is == VALID_NAN || d->is == VALID_INFINITY)
        reading->position[NT_Z] = d->is == VALID_NAN ? (double)NAN : (double)INFINITY;
    if (d->is == ZERO_FOR_UNKNOWN)
        reading->felt[NT_Y] = 0.0;
}

/* A new measurement in every fourth period; between them the reading is held. */
static nt_status read_device(void *context, nt_reading *reading)
{
    device *d = context;
    d->is_out_of_order |= !d->is_armed;
    const int read = d->reads++;
    if (d->is == READ_FAILS && read == 5)
        return NT_E_DEVICE;
    if (read % 4 != 0 || (d->is == NO_HEARTBEAT && read > 8) || (d->is == NOTHING_AT_FIRST && read == 0))
        return NT_OK;
    reading->sequence = (uint64_t)(d->is == SEQUENCE_FALLS ? 100 - read : read + 1);
    reading->time = d->host->now(d->host) + (d->is == FROM_THE_FUTURE ? 1 : 0);
    reading->time -= d->is == TIME_FALLS && read == 4 ? 4000001 : 0;
    reading->position[NT_Z] = 1e-3;
    reading->valid = 1u << NT_Z;
    offend(d, reading);
    return NT_OK;
}

static nt_status write_device(void *context, const nt_action *action)
{
    device *d = context;
    d->is_out_of_order |= !d->is_armed || action->size != sizeof *action || action->target[NT_Z] != 0.0;
    return d->is == WRITE_FAILS ? NT_E_DEVICE : NT_OK;
}

static void disarm_device(void *context)
{
    device *d = context;
    d->is_out_of_order |= !d->is_armed;
    d->is_armed = 0;
    d->left_at = 0.0;
    ++d->disarms;
}

static void close_device(void *context)
{
    device *d = context;
    d->is_out_of_order |= d->is_armed || !d->is_open;
    d->is_open = 0;
    ++d->closes;
}

static const nt_backend backend = {.size = sizeof backend,
                                   .version = NT_HAL_API_VERSION,
                                   .name = "mock",
                                   .half = NT_HALF_MASTER,
                                   .open = open_device,
                                   .describe = describe_device,
                                   .configure = configure_device,
                                   .arm = arm_device,
                                   .read = read_device,
                                   .write = write_device,
                                   .disarm = disarm_device,
                                   .close = close_device};

static nt_status rehearse(device *d, nt_rehearsed *seen, nt_problem *problem)
{
    const nt_rehearsal rehearsal = {.half = NT_HALF_MASTER,
                                    .choice = {&backend, d},
                                    .host = &host,
                                    .configuration = {sizeof(nt_configuration), 0, 1e-3, 0.0, "so"},
                                    .periods = 40,
                                    .pass = pass};
    return nt_hal_rehearse(&rehearsal, seen, problem);
}

/* Whatever happens: opened and closed as often, in order, and left safe. */
static void assert_orderly(const device *d)
{
    assert_false(d->is_out_of_order);
    assert_int_equal(d->opens, d->closes);
    assert_false(d->is_open || d->is_armed);
    assert_true(d->left_at == 0.0);
}

static void a_good_backend_passes(void **state)
{
    (void)state;
    device d = {.is = NONE};
    nt_rehearsed seen;
    nt_problem problem = {0};
    assert_int_equal(rehearse(&d, &seen, &problem), NT_OK);
    assert_null(problem.field);
    assert_orderly(&d);
    assert_true(d.opens == 3 && d.arms == 2 && d.disarms == 2);
    assert_int_equal(seen.readings, 20);
    assert_true(fabs(seen.oldest - 3e-3) < 1e-12);
    assert_true(seen.capabilities.axes == 1 && seen.capabilities.rows == 2);
    assert_int_equal(rehearse(&d, NULL, NULL), NT_OK);
}

static const char *const rules[OFFENCES] = {
    [OPEN_FAILS] = "open",
    [OPENS_ONCE] = "open",
    [DESCRIBE_FAILS] = "open",
    [CONFIGURE_FAILS] = "configure",
    [ARM_FAILS] = "arm",
    [ARMS_ONCE] = "arm",
    [READ_FAILS] = "read",
    [WRITE_FAILS] = "write",
    [TOO_MANY_AXES] = "capabilities.axes",
    [GROWN_CAPABILITIES] = "capabilities.size",
    [NAMELESS_CHANNEL] = "channels without a name",
    [WRONG_UNIT] = "channels with a unit other than m, N, rad and Hz",
    [WRONG_AXIS] = "axis of a channel",
    [EMPTY_RANGE] = "minimum of a channel",
    [NOISE_IS_NAN] = "noise of a channel",
    [UNSAFE] = "safe value of a driven channel",
    [NO_SAFE_FORCE] = "safe value of a driven channel",
    [READ_IS_SAFE] = "safe values of channels that are read",
    [GROWN_READING] = "reading.size",
    [UNKNOWN_FLAG] = "unknown flags",
    [LOST_BUT_VALID] = "valid bits of a lost device",
    [LATE_FOLLOWER] = "reading.lateness",
    [LATENESS_IS_NAN] = "reading.lateness",
    [FEELS_WITHOUT_GAUGE] = "valid bits of what it cannot measure",
    [SIDEWAYS_WITHOUT_AXES] = "valid bits of what it cannot measure",
    [VALID_NAN] = "valid bits of what is no number",
    [VALID_INFINITY] = "valid bits of what is no number",
    [ZERO_FOR_UNKNOWN] = "numbers without a valid bit",
    [SEQUENCE_FALLS] = "steps of the sequence",
    [FROM_THE_FUTURE] = "age of a reading [s]",
    [TIME_FALLS] = "time between two readings [s]",
    [NO_HEARTBEAT] = "age of a reading [s]",
    [NOTHING_AT_FIRST] = "valid first readings of the position along z",
};

static void every_offence_is_found(void **state)
{
    (void)state;
    for (int is = NONE + 1; is < OFFENCES; ++is) {
        device d = {.is = (offence)is};
        nt_problem problem = {0};
        const nt_status status = rehearse(&d, NULL, &problem);
        if (status == NT_OK || !problem.field || strcmp(problem.field, rules[is]) != 0)
            fail_msg("offence %d: status %d, \"%s\" instead of \"%s\"", is, (int)status,
                     problem.field ? problem.field : "", rules[is]);
        assert_orderly(&d);
    }
}

static void arguments_are_checked(void **state)
{
    (void)state;
    device d = {.is = NONE};
    nt_rehearsal wrong = {.choice = {&backend, &d}, .host = &host, .pass = pass};
    nt_problem problem = {0};
    assert_int_equal(nt_hal_rehearse(&wrong, NULL, &problem), NT_E_RANGE);
    assert_string_equal(problem.field, "periods");
    wrong.host = NULL;
    assert_int_equal(nt_hal_rehearse(&wrong, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(nt_hal_rehearse(NULL, NULL, NULL), NT_E_ARGUMENT);
    assert_int_equal(d.opens, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_good_backend_passes),
        cmocka_unit_test(every_offence_is_found),
        cmocka_unit_test(arguments_are_checked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
