/* SPDX-License-Identifier: BSD-3-Clause
 * Any recorded rows as a half of a rig: refused, or each reading is a row, in order, and what is not a number is not
 * valid. */
#include "input.h"
#include "nanotouch/advanced/hal_replay.h"
#include "nanotouch/hal.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { ROWS = 64 };
static int64_t clock_now;

static int64_t now(const nt_host *host)
{
    (void)host;
    return clock_now;
}

static const nt_host host = {sizeof host, NT_HAL_API_VERSION, now, NULL, NULL};
static double time[ROWS], position[ROWS * NT_AXES], felt[ROWS * NT_AXES];

static void play(fuzz_input *in, nt_half half, nt_replay_half *rows)
{
    nt_hal hal = {0};
    const nt_hal_choice choice = {nt_replay_backend(half), rows};
    const nt_configuration configuration = {.size = sizeof configuration, .period = 1e-4, .option = ""};
    if (nt_hal_open(&hal, half, &choice, &host, NULL) != NT_OK)
        return;
    if (nt_hal_configure(&hal, &configuration, NULL) == NT_OK && nt_hal_arm(&hal) == NT_OK) {
        uint64_t last = 0;
        for (int i = 0; i < ROWS; ++i) {
            REQUIRE(nt_hal_read(&hal) == NT_OK);
            REQUIRE(hal.reading.sequence >= last);
            last = hal.reading.sequence;
            for (int axis = 0; axis < NT_AXES; ++axis)
                REQUIRE(!(hal.reading.valid >> axis & 1u) || isfinite(hal.reading.position[axis]));
            const double step = fuzz_double(in, 0.0, 1e-2);
            clock_now += step > 0.0 && step < 1e3 ? (int64_t)(1e9 * step) : 1000;
        }
    }
    nt_hal_close(&hal);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    uint8_t what, count;
    fuzz_take(&in, &what, sizeof what);
    fuzz_take(&in, &count, sizeof count);
    clock_now = 1;
    nt_replay_rows rows = {count % (ROWS + 1), what & 1 ? NT_AXES : 1, time, position, what & 2 ? felt : NULL};
    if (what & 0x80)
        rows.axes = what & 0x7f;
    double at = 0.0;
    for (int64_t i = 0; i < rows.count; ++i) {
        const double step = fuzz_double(&in, 0.0, 1e-2);
        time[i] = at = i > 0 ? at + step : what & 4 ? step : 0.0;
        for (int axis = 0; axis < NT_AXES; ++axis) {
            position[i * NT_AXES + axis] = fuzz_double(&in, -0.1, 0.1);
            felt[i * NT_AXES + axis] = fuzz_double(&in, -1.0, 1.0);
        }
    }
    nt_replay_half half;
    if (nt_replay_half_init(&half, &rows, NULL) == NT_OK)
        play(&in, what & 8 ? NT_HALF_SLAVE : NT_HALF_MASTER, &half);
    return 0;
}
