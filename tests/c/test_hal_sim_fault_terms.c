/* SPDX-License-Identifier: BSD-3-Clause
 * What each fault makes of a reading, a stage, a motor, by number; when it begins and ends; what a schedule refuses. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "hal/sim/parts.h"
#include "internal/random.h"
#include "larger.h"

#define T 0.125

static const nt_sensor position = {0.0, 0.5, 8.0}, felt = {0.25, 0.125, 4.0};

static nt_sim_link link_with(const nt_fault *faults, int count)
{
    nt_sim_link link;
    memset(&link, 0, sizeof link);
    link.rig = nt_rig_defaults();
    link.period = T;
    link.tick = 8u; /* at 1 s */
    link.valid = (1u << NT_READS) - 1u;
    link.last = (nt_sim_memory){5.0, 6.0, 0.25, 3u, 7u};
    link.fresh = (nt_sim_memory){1.5, 2.5, 0.25, 2u, 4u};
    for (uint32_t i = 0; i < NT_SIM_NOISES; ++i)
        link.noise[i] = nt_noise_of(1, i);
    for (int i = 0; i < count; ++i)
        assert_int_equal(nt_faults_add(&link.faults, &faults[i]), NT_OK);
    return link;
}

static nt_fault fault_of(nt_fault_kind kind, nt_channel channel, double value)
{
    return (nt_fault){kind, channel, 0.5, 10.0, value};
}

static nt_reading reading_of(const nt_sim_link *link)
{
    nt_reading reading;
    memset(&reading, 0, sizeof reading);
    reading.valid = link->valid;
    reading.position[NT_Z] = 2.0;
    reading.felt[NT_Z] = -1.0;
    reading.sequence = 9u;
    return reading;
}

static void a_schedule_by_its_borders(void **state)
{
    (void)state;
    int count;
    const nt_fault_description *table = nt_fault_descriptions(&count);
    assert_true(nt_fault_descriptions(NULL) == table && count == NT_FAULT_SLIP + 1);
    for (int kind = 0; kind < count; ++kind) {
        int channels = 0;
        for (int channel = 0; channel <= NT_CHANNEL_RIG; ++channel) {
            nt_faults faults = {.count = 0};
            nt_fault fault = {(nt_fault_kind)kind, (nt_channel)channel, 0.0, DBL_MIN, table[kind].minimum};
            const int may = table[kind].channels >> channel & 1;
            channels += may;
            assert_int_equal(nt_faults_add(&faults, &fault), may ? NT_OK : NT_E_ARGUMENT);
            if (!may)
                continue;
            fault.value = table[kind].maximum;
            assert_int_equal(nt_faults_add(&faults, &fault), NT_OK);
            assert_int_equal(faults.count, 2);
            const double wrong[][3] = {{-DBL_MIN, 1.0, fault.value},
                                       {0.0, 0.0, fault.value},
                                       {0.0, 1.0, nextafter(table[kind].maximum, 1e12)},
                                       {0.0, 1.0, nextafter(table[kind].minimum, -1e12)},
                                       {NAN, 1.0, fault.value},
                                       {0.0, NAN, fault.value},
                                       {0.0, 1.0, NAN}};
            for (int i = 0; i < 7; ++i) {
                const nt_fault bad = {fault.kind, fault.channel, wrong[i][0], wrong[i][1], wrong[i][2]};
                assert_int_equal(nt_faults_add(&faults, &bad), i < 4 ? NT_E_RANGE : NT_E_NOT_FINITE);
            }
        }
        assert_true(channels > 0);
    }
    nt_faults faults = {.count = 0};
    nt_fault fault = fault_of(NT_FAULT_NAN, NT_CHANNEL_DEFLECTION, 0.0);
    for (int i = 0; i <= NT_FAULTS_MAX; ++i)
        assert_int_equal(nt_faults_add(&faults, &fault), i < NT_FAULTS_MAX ? NT_OK : NT_E_CAPACITY);
    fault.kind = (nt_fault_kind)count;
    assert_int_equal(nt_faults_add(&faults, &fault), NT_E_ARGUMENT);
    fault = fault_of(NT_FAULT_NAN, (nt_channel)(NT_CHANNEL_RIG + 1), 0.0);
    assert_int_equal(nt_faults_add(&faults, &fault), NT_E_ARGUMENT);
    assert_string_equal(nt_channel_name(NT_CHANNEL_RIG), "rig");
    assert_string_equal(nt_channel_name((nt_channel)(NT_CHANNEL_RIG + 1)), "");
}

/* Half a period of slack at both ends. */
static void when_it_acts(void **state)
{
    (void)state;
    const struct {
        double start, duration;
        int acts;
    } cases[] = {{1.0625, 1.0, 1}, {1.0626, 1.0, 0}, {0.0, 1.0625, 0}, {0.0, 1.0626, 1}, {0.0, HUGE_VAL, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const nt_fault two[] = {{NT_FAULT_PUSH, NT_CHANNEL_RIG, cases[i].start, cases[i].duration, 3.0},
                                {NT_FAULT_PUSH, NT_CHANNEL_RIG, cases[i].start, cases[i].duration, 4.0}};
        const nt_sim_link link = link_with(two, 2);
        assert_true(nt_sim_sum_of_faults(&link, NT_FAULT_PUSH) == (cases[i].acts ? 7.0 : 0.0));
        assert_true(nt_sim_sum_of_faults(&link, NT_FAULT_JUMP) == 0.0);
    }
}

/* Of both sensors of a half; elapsed is 0.5 s and half a period. */
static void readings_that_are_spoilt(void **state)
{
    (void)state;
    const struct {
        nt_fault_kind kind;
        double value, position, felt;
    } cases[] = {{NT_FAULT_NAN, 0.0, NAN, NAN},
                 {NT_FAULT_INFINITE, 1.0, HUGE_VAL, HUGE_VAL},
                 {NT_FAULT_INFINITE, -1.0, -HUGE_VAL, -HUGE_VAL},
                 {NT_FAULT_SATURATED, 0.0, 8.0, 4.0},
                 {NT_FAULT_SATURATED, -2.0, -8.0, -4.0},
                 {NT_FAULT_STUCK, 0.0, 5.0, 6.0},
                 {NT_FAULT_GAIN, 3.0, 6.0, -3.0},
                 {NT_FAULT_DRIFT, 2.0, 2.0 + 2.0 * 0.5625, -1.0 + 2.0 * 0.5625},
                 {NT_FAULT_SLIP, 0.01, 2.01, -0.99}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        for (int half = 0; half < 2; ++half)
            for (int of_position = 0; of_position < 2; ++of_position) {
                const nt_channel channels[2][2] = {{NT_CHANNEL_OPERATOR_FORCE, NT_CHANNEL_MASTER_POSITION},
                                                   {NT_CHANNEL_DEFLECTION, NT_CHANNEL_STAGE_POSITION}};
                const nt_channel channel = channels[half][of_position];
                if (cases[i].kind == NT_FAULT_SLIP && channel == NT_CHANNEL_OPERATOR_FORCE)
                    continue;
                const nt_fault fault = fault_of(cases[i].kind, channel, cases[i].value);
                nt_sim_link link = link_with(&fault, 1);
                for (int other = 0; other < 2; ++other) { /* the other half's reading is left alone */
                    const nt_sim_sensors sensors = {(nt_half)(other ? 1 - half : half), &position, &felt};
                    nt_reading reading = reading_of(&link);
                    double age = 0.0;
                    nt_sim_spoil_signals(&link, &sensors, &reading);
                    assert_int_equal(nt_sim_spoil(&link, &sensors, &reading, &age), 0);
                    const double z = other || !of_position ? 2.0 : cases[i].position;
                    const double f = other || of_position ? -1.0 : cases[i].felt;
                    assert_true(isnan(z) ? isnan(reading.position[NT_Z]) : reading.position[NT_Z] == z);
                    assert_true(isnan(f) ? isnan(reading.felt[NT_Z]) : reading.felt[NT_Z] == f);
                    uint32_t valid = link.valid;
                    valid &= isnan(z) ? ~(1u << (NT_READS_POSITION + NT_Z)) : ~0u;
                    valid &= isnan(f) ? ~(1u << (NT_READS_FELT + NT_Z)) : ~0u;
                    assert_int_equal(reading.valid, valid);
                }
            }
}

/* So many times the noise, or the step where that is more; in the sensor's steps. */
static void noise_by_number(void **state)
{
    (void)state;
    for (int of_position = 0; of_position < 2; ++of_position) {
        const nt_channel channel = of_position ? NT_CHANNEL_STAGE_POSITION : NT_CHANNEL_DEFLECTION;
        const nt_fault fault = fault_of(NT_FAULT_NOISE, channel, 3.0);
        nt_sim_link link = link_with(&fault, 1);
        const nt_sensor *sensor = of_position ? &position : &felt;
        const double sigma = 3.0 * larger(sensor->noise, sensor->resolution);
        double sum = 0.0, squares = 0.0;
        const int n = 4000;
        for (int i = 0; i < n; ++i) {
            const nt_sim_sensors sensors = {NT_HALF_SLAVE, &position, &felt};
            link.tick = 8u + (uint64_t)i % 60u;
            for (uint32_t k = 0; k < NT_SIM_NOISES && i % 60 == 0; ++k)
                link.noise[k] = nt_noise_of((uint64_t)i, k);
            nt_reading reading = reading_of(&link);
            nt_sim_spoil_signals(&link, &sensors, &reading);
            const double value = of_position ? reading.position[NT_Z] - 2.0 : reading.felt[NT_Z] + 1.0;
            assert_true(fmod(of_position ? reading.position[NT_Z] : reading.felt[NT_Z], sensor->resolution) == 0.0);
            sum += value;
            squares += value * value;
        }
        assert_true(fabs(sum / n) < 5.0 * sigma / sqrt(n));        /* 5 standard deviations of the mean ... */
        assert_true(fabs(sqrt(squares / n) / sigma - 1.0) < 0.08); /* ... and of sigma, with steps */
    }
}

static void frames_that_are_spoilt(void **state)
{
    (void)state;
    const nt_sim_sensors sensors = {NT_HALF_MASTER, &position, &felt};
    const nt_fault_kind kinds[] = {
        NT_FAULT_STALE,          NT_FAULT_DROPOUT,      NT_FAULT_CLOCK,       NT_FAULT_CLOCK_DRIFT,
        NT_FAULT_EMERGENCY_STOP, NT_FAULT_LIMIT_SWITCH, NT_FAULT_DEVICE_LOST, NT_FAULT_JUMP};
    const uint32_t flags[] = {
        0u, NT_SAMPLE_INVALID, 0u, 0u, NT_SAMPLE_EMERGENCY_STOP, NT_SAMPLE_LIMIT_SWITCH, NT_SAMPLE_DEVICE_LOST, 0u};
    for (int i = 0; i < 8; ++i) {
        const nt_fault fault = fault_of(kinds[i], NT_CHANNEL_RIG, i == 2 ? -7.0 : i == 7 ? 1e-9 : 0.5);
        nt_sim_link link = link_with(&fault, 1);
        nt_reading reading = reading_of(&link);
        double age = 0.25;
        assert_int_equal(nt_sim_spoil(&link, &sensors, &reading, &age), i == 0);
        assert_int_equal(reading.flags, flags[i]);
        const double ages[] = {0.25 + 4.0 * T, 0.25, -7.0, 0.25 + 0.5 * 0.5625, 0.25, 0.25, 0.25, 0.25};
        assert_true(age == ages[i]);
        const int gone = i == 1 || i == 6;
        assert_true(gone ? isnan(reading.position[NT_Z]) && isnan(reading.felt[NT_Z])
                         : reading.position[NT_Z] == (i ? 2.0 : 1.5) && reading.felt[NT_Z] == (i ? -1.0 : 2.5));
        assert_true(reading.sequence == (i ? 9u : 2u));
        assert_true(i == 6 ? reading.valid == 0u : (reading.valid == link.valid) == (i != 1));
    }
}

static nt_sim_slave slave_with(const nt_fault *faults, int count)
{
    nt_sim_slave slave;
    memset(&slave, 0, sizeof slave);
    slave.link = link_with(faults, count);
    slave.link.rig.stage.travel = 40.0;
    slave.link.rig.stage.max_speed = 16.0; /* 2 in a period */
    return slave;
}

static void a_stage_with_faults(void **state)
{
    (void)state;
    static nt_sim_slave slave;
    const nt_fault gain = fault_of(NT_FAULT_GAIN, NT_CHANNEL_STAGE, -3.0);
    slave = slave_with(&gain, 1);
    slave.stood = 4.0;
    slave.driven = 3.0;
    assert_true(nt_sim_stage_by_faults(&slave, 3.5, T) == 5.0); /* 4 - 3 (-0.5) = 5.5, but 2 at most */
    assert_true(nt_sim_stage_by_faults(&slave, 3.75, T) == 4.75 && slave.stood == 4.0);
    slave.driven = -19.0;
    assert_true(nt_sim_stage_by_faults(&slave, 40.0, T) == -20.0); /* the end of its travel */
    slave.driven = 19.0;
    assert_true(nt_sim_stage_by_faults(&slave, -40.0, T) == 20.0);
    const nt_fault limit = fault_of(NT_FAULT_LIMIT, NT_CHANNEL_STAGE, 1e-3);
    slave = slave_with(&limit, 1);
    slave.stood = 4.0;
    assert_true(nt_sim_stage_by_faults(&slave, 5.0, T) == 4.001 && nt_sim_stage_by_faults(&slave, 3.0, T) == 3.0);
    assert_true(slave.stood == 4.0 && slave.driven == 3.0);
    slave = slave_with(NULL, 0);
    assert_true(nt_sim_stage_by_faults(&slave, 5.0, T) == 5.0 && slave.stood == 5.0 && slave.driven == 5.0);
    const nt_fault power = {NT_FAULT_POWER, NT_CHANNEL_STAGE, 0.5, 0.625, -1e-3};
    slave = slave_with(&power, 1);
    slave.driven = 3.0;
    assert_true(nt_sim_stage_by_faults(&slave, 5.0, T) == 1.0 && slave.was_off); /* to where it rests */
    assert_true(nt_sim_stage_by_faults(&slave, 5.0, T) == -1e-3);
    slave.link.tick = 9u; /* it is back: to where it is told, no faster than it can */
    assert_true(nt_sim_stage_by_faults(&slave, 3.0, T) == 2.0 - 1e-3 && slave.was_off);
    assert_true(nt_sim_stage_by_faults(&slave, 3.0, T) == 3.0 && !slave.was_off);
    assert_true(nt_sim_stage_by_faults(&slave, 9.0, T) == 9.0);             /* from here as it is told */
    const nt_fault motor = fault_of(NT_FAULT_POWER, NT_CHANNEL_MOTOR, 0.0); /* is not the stage's */
    slave = slave_with(&motor, 1);
    assert_true(nt_sim_stage_by_faults(&slave, 5.0, T) == 5.0 && !slave.was_off);
}

static void hysteresis_motor_and_drift(void **state)
{
    (void)state;
    const nt_fault faults[] = {
        fault_of(NT_FAULT_HYSTERESIS, NT_CHANNEL_STAGE, 0.3),   fault_of(NT_FAULT_GAIN, NT_CHANNEL_MOTOR, -2.0),
        fault_of(NT_FAULT_GAIN, NT_CHANNEL_MOTOR, 3.0),         fault_of(NT_FAULT_DRIFT, NT_CHANNEL_STAGE, 2.0),
        fault_of(NT_FAULT_DRIFT, NT_CHANNEL_DEFLECTION, 100.0), fault_of(NT_FAULT_GAIN, NT_CHANNEL_STAGE, 5.0)};
    nt_sim_link link = link_with(faults, 6);
    assert_true(nt_sim_hysteresis_by_faults(&link) == 0.3 && nt_sim_motor_by_faults(&link, 1.5) == -9.0);
    assert_true(nt_sim_drift_of_faults(&link) == 2.0 * 0.5625);
    const nt_fault power = fault_of(NT_FAULT_POWER, NT_CHANNEL_MOTOR, 1e-3);
    link = link_with(&power, 1);
    assert_true(nt_sim_motor_by_faults(&link, 1.5) == 0.0);
    link.rig.stage.hysteresis = 0.125;
    assert_true(nt_sim_hysteresis_by_faults(&link) == 0.125 && nt_sim_drift_of_faults(&link) == 0.0);
}

/* As it is given away: within the range, with its age on the clock; what is stale does not count as fresh. */
static void what_a_half_gives(void **state)
{
    (void)state;
    const nt_sim_sensors sensors = {NT_HALF_MASTER, &position, &felt};
    for (int i = 0; i < 3; ++i) {
        const nt_fault fault = i == 1 ? fault_of(NT_FAULT_STALE, NT_CHANNEL_RIG, 0.0)
                                      : fault_of(NT_FAULT_GAIN, NT_CHANNEL_MASTER_POSITION, -8.0);
        nt_sim_link link = link_with(&fault, i ? 1 : 0);
        link.converted = 6u;
        link.rig.converters.adc_latency = 0.03125;
        link.lateness = 0.75;
        nt_reading reading = reading_of(&link);
        reading.felt[NT_Z] = 5.0;
        nt_sim_give(&link, &sensors, &reading);
        const double age = i == 1 ? 0.25 + 4.0 * T : 0.03125 + 2.0 * T;
        assert_true(reading.time == (int64_t)(1e9 * (1.0 - age)) && reading.lateness == 0.75);
        assert_true(reading.size == sizeof reading && reading.sequence == (i == 1 ? 2u : 7u));
        const double z[] = {2.0, 1.5, -8.0}, f[] = {4.0, 2.5, 4.0};
        assert_true(reading.position[NT_Z] == z[i] && reading.felt[NT_Z] == f[i]);
        assert_true(link.last.position == z[i] && link.last.age == age && link.last.tick == 8u);
        assert_true(link.fresh.tick == (i == 1 ? 4u : 8u));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_schedule_by_its_borders),  cmocka_unit_test(when_it_acts),
        cmocka_unit_test(readings_that_are_spoilt),   cmocka_unit_test(noise_by_number),
        cmocka_unit_test(frames_that_are_spoilt),     cmocka_unit_test(a_stage_with_faults),
        cmocka_unit_test(hysteresis_motor_and_drift), cmocka_unit_test(what_a_half_gives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
