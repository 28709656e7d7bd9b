/* SPDX-License-Identifier: BSD-3-Clause
 * A half that gives recorded rows again: each at its time, at any period of the loop, what is no number as such, and
 * nothing new after the last. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "host_fixture.h"
#include "nanotouch/advanced/hal_replay.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/hal.h"

enum { ROWS = 500 };

static double time_of[ROWS], position[NT_AXES * ROWS], felt[NT_AXES * ROWS];
static nt_replay_half half;
static nt_hal hal;

/* Rows of random distances; row i has i nm along z. */
static nt_replay_rows draw(uint64_t seed, int axes)
{
    nt_random random = nt_random_seed(seed);
    for (int i = 0; i < ROWS; ++i) {
        time_of[i] = i ? time_of[i - 1] + 1e-6 + 2e-3 * nt_random_uniform(&random) : 0.0;
        for (int j = 0; j < NT_AXES; ++j) {
            position[NT_AXES * i + j] = 1e-9 * (j == NT_Z ? i : -i);
            felt[NT_AXES * i + j] = i % 7 ? 1e-3 * i : (double)NAN;
        }
    }
    return (nt_replay_rows){ROWS, axes, time_of, position, felt};
}

static void start(const nt_replay_rows *rows, nt_half which, double period)
{
    const nt_configuration configuration = {sizeof configuration, 0, period, 1e-6, ""};
    const nt_hal_choice choice = {nt_replay_backend(which), &half};
    assert_int_equal(nt_replay_half_init(&half, rows, NULL), NT_OK);
    assert_int_equal(nt_hal_open(&hal, which, &choice, &host, NULL), NT_OK);
    assert_int_equal(nt_hal_configure(&hal, &configuration, NULL), NT_OK);
    assert_int_equal(nt_hal_arm(&hal), NT_OK);
}

static int64_t row_at(double time)
{
    int64_t row = 0;
    while (row + 1 < ROWS && time_of[row + 1] <= time + 2e-9)
        ++row;
    return row;
}

static void each_row_comes_at_its_time(void **state)
{
    (void)state;
    static const double periods[] = {1e-4, 1e-3, 7.3e-3, 0.1};
    for (size_t k = 0; k < sizeof periods / sizeof *periods; ++k) {
        const nt_replay_rows rows = draw(k, 1);
        start(&rows, (nt_half)(k % 2), periods[k]);
        assert_int_equal(nt_hal_read(&hal), NT_OK); /* the first, whenever that is */
        const int64_t begun = hal.reading.time;
        assert_true(hal.reading.position[NT_Z] == 0.0 && begun == clock_now);
        while (1e-9 * (double)(clock_now - begun) < time_of[ROWS - 1] + 1.0) {
            pass(&host, periods[k]);
            assert_int_equal(nt_hal_read(&hal), NT_OK);
            const int64_t row = row_at(1e-9 * (double)(clock_now - begun));
            assert_int_equal(hal.reading.sequence, row + 1);
            assert_true(hal.reading.position[NT_Z] == 1e-9 * (double)row);
            assert_true(llabs(hal.reading.time - begun - (int64_t)(1e9 * time_of[row])) <= 1);
            assert_true(isnan(hal.reading.position[NT_X]) && isnan(hal.reading.felt[NT_X]));
            assert_true(row % 7 ? hal.reading.felt[NT_Z] == 1e-3 * (double)row : isnan(hal.reading.felt[NT_Z]));
            assert_int_equal(hal.reading.valid, row % 7 ? 1u << NT_Z | 1u << (NT_READS_FELT + NT_Z) : 1u << NT_Z);
        }
        assert_true(clock_now - hal.reading.time > 900000000); /* the last row has grown old */
        nt_hal_close(&hal);
    }
}

static void three_axes_and_a_second_life(void **state)
{
    (void)state;
    const nt_replay_rows rows = draw(9, NT_AXES);
    for (int life = 0; life < 2; ++life) {
        start(&rows, NT_HALF_MASTER, 1e-3);
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        pass(&host, 0.1);
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        assert_true(hal.reading.position[NT_X] == -hal.reading.position[NT_Z] && hal.reading.position[NT_Z] > 0.0);
        nt_hal_close(&hal);
    }
}

static void what_is_no_recording_is_refused(void **state)
{
    (void)state;
    nt_problem problem = {0};
    const nt_replay_rows good = draw(1, 1);
    nt_replay_rows bad = good;
    assert_int_equal(nt_replay_half_init(&half, NULL, &problem), NT_E_ARGUMENT);
    assert_int_equal(nt_replay_half_init(NULL, &good, &problem), NT_E_ARGUMENT);
    bad.time = NULL;
    assert_int_equal(nt_replay_half_init(&half, &bad, &problem), NT_E_ARGUMENT);
    bad = good, bad.position = NULL;
    assert_int_equal(nt_replay_half_init(&half, &bad, &problem), NT_E_ARGUMENT);
    for (int64_t count = -1; count < 1; ++count) {
        bad = good, bad.count = count;
        assert_int_equal(nt_replay_half_init(&half, &bad, &problem), NT_E_RANGE);
        assert_string_equal(problem.field, "rows of a replay");
    }
    for (int axes = 0; axes < 5; ++axes) {
        bad = good, bad.axes = axes;
        assert_int_equal(nt_replay_half_init(&half, &bad, &problem), axes == 1 || axes == 3 ? NT_OK : NT_E_RANGE);
    }
    static const struct {
        int row;
        double time;
        nt_status status;
    } times[] = {{0, 1e-9, NT_E_RANGE},      {0, -1.0, NT_E_RANGE},     {0, NAN, NT_E_NOT_FINITE},
                 {7, 0.0, NT_E_RANGE},       {7, NAN, NT_E_NOT_FINITE}, {ROWS - 1, HUGE_VAL, NT_E_NOT_FINITE},
                 {ROWS - 1, 2e9, NT_E_RANGE}};
    for (size_t i = 0; i < sizeof times / sizeof *times; ++i) {
        bad = draw(1, 1);
        time_of[times[i].row] = times[i].time;
        assert_int_equal(nt_replay_half_init(&half, &bad, &problem), times[i].status);
        assert_true(problem.value == times[i].time || isnan(times[i].time));
    }
    assert_int_equal(nt_replay_half_init(&half, &bad, NULL), NT_E_RANGE);
}

static void one_row_and_nothing_felt(void **state)
{
    (void)state;
    nt_replay_rows rows = draw(2, 1);
    rows.count = 1;
    rows.felt = NULL;
    start(&rows, NT_HALF_SLAVE, 1e-3);
    nt_capabilities can = {.size = sizeof can};
    assert_int_equal(hal.backend->describe(hal.context, &can), NT_OK);
    assert_int_equal(can.can & NT_CAN_FEEL, 0);
    for (int i = 0; i < 10; ++i) {
        assert_int_equal(nt_hal_read(&hal), NT_OK);
        assert_int_equal(hal.reading.sequence, 1);
        assert_int_equal(hal.reading.valid, 1u << NT_Z);
        pass(&host, 1e-3);
    }
    nt_hal_close(&hal);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_row_comes_at_its_time),
        cmocka_unit_test(three_axes_and_a_second_life),
        cmocka_unit_test(what_is_no_recording_is_refused),
        cmocka_unit_test(one_row_and_nothing_felt),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
