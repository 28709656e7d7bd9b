/* SPDX-License-Identifier: BSD-3-Clause
 * Any converters, any wiring, and anything on the bus: a setup is refused, or what is valid is a number within its
 * range, and a half whose bus has gone says so. */
#include "input.h"
#include "nanotouch/advanced/converters.h"
#include "nanotouch/hal.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { TICKS = 24 };

static int64_t clock_now;

static int64_t now(const nt_host *host)
{
    (void)host;
    return ++clock_now;
}

static const nt_host host = {sizeof host, NT_HAL_API_VERSION, now, NULL, NULL};

/* What comes back is what was sent, or bytes of the input; sometimes nothing does. */
static nt_status exchange(void *context, int converter, const nt_transfer *transfers, int count)
{
    fuzz_input *in = context;
    uint8_t what;
    (void)converter;
    for (int i = 0; i < count; ++i) {
        fuzz_take(in, &what, sizeof what);
        if (what < 4)
            return what == 1 ? NT_E_DEVICE : NT_E_STATE;
        if (what & 1)
            memcpy(transfers[i].in, transfers[i].out, transfers[i].count);
        else
            fuzz_take(in, transfers[i].in, transfers[i].count);
    }
    return NT_OK;
}

static nt_converter_channel channel_of(fuzz_input *in)
{
    uint8_t which;
    fuzz_take(in, &which, sizeof which);
    nt_converter_channel made = {.is_used = which & 1,
                                 .converter = which >> 1 & 3,
                                 .channel = which >> 3 & 7,
                                 .gain = which & 0x40 ? -1e-6 : 1e-6,
                                 .minimum = -10e-6,
                                 .maximum = 10e-6};
    if (which >= 0xc0) {
        made.gain = fuzz_double(in, 1e-9, 10.0);
        made.offset = fuzz_double(in, -1e-6, 1e-6);
        made.maximum = fuzz_double(in, 1e-9, 10.0);
        made.minimum = -made.maximum;
    }
    return made;
}

static nt_converter_setup setup_of(fuzz_input *in)
{
    uint8_t what, chip;
    fuzz_take(in, &what, sizeof what);
    nt_converter_setup made = {.half = what & 1 ? NT_HALF_SLAVE : NT_HALF_MASTER,
                               .axes = (what >> 1 & 3) + (what >> 7),
                               .converters = what >> 3 & 7,
                               .exchange = exchange,
                               .bus = in};
    for (int i = 0; i < NT_CONVERTERS; ++i) {
        fuzz_take(in, &chip, sizeof chip);
        made.converter[i] = (nt_converter){nt_chip_at(chip % nt_chip_count()), {chip & 0x80 ? 0.0 : -10.0, 10.0}};
    }
    for (int i = 0; i < NT_AXES; ++i) {
        made.position[i] = channel_of(in);
        made.felt[i] = channel_of(in);
    }
    for (int i = 0; i < NT_DRIVES; ++i)
        made.driven[i] = channel_of(in);
    for (int i = 0; i < NT_LOCK_IN_OUTPUTS; ++i)
        made.lock_in[i] = channel_of(in);
    return made;
}

static void run(fuzz_input *in, nt_hal *hal)
{
    for (int i = 0; i < TICKS; ++i) {
        REQUIRE(nt_hal_read(hal) == NT_OK);
        const nt_reading *reading = &hal->reading;
        for (int axis = 0; axis < NT_AXES; ++axis) {
            REQUIRE(!(reading->valid >> axis & 1u) || isfinite(reading->position[axis]));
            REQUIRE(!(reading->valid >> (NT_READS_FELT + axis) & 1u) || isfinite(reading->felt[axis]));
        }
        REQUIRE(!(reading->flags & NT_SAMPLE_DEVICE_LOST) || reading->valid == 0);
        nt_action action = {.size = sizeof action};
        for (int axis = 0; axis < NT_AXES; ++axis)
            action.target[axis] = fuzz_double(in, -20e-6, 20e-6);
        action.drive_amplitude = fuzz_double(in, 0.0, 1e-7);
        action.drive_frequency = fuzz_double(in, 1e4, 1e6);
        REQUIRE(nt_hal_write(hal, &action) == NT_OK);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    clock_now = 0;
    const nt_converter_setup setup = setup_of(&in);
    nt_converter_half half;
    if (nt_converter_half_init(&half, &setup, NULL) != NT_OK)
        return 0;
    nt_hal hal = {0};
    const nt_hal_choice choice = {nt_converter_half_backend(setup.half), &half};
    const nt_configuration configuration = {.size = sizeof configuration, .period = 1e-4, .lift = 1e-6, .option = ""};
    if (nt_hal_open(&hal, setup.half, &choice, &host, NULL) != NT_OK)
        return 0;
    if (nt_hal_configure(&hal, &configuration, NULL) == NT_OK && nt_hal_arm(&hal) == NT_OK)
        run(&in, &hal);
    nt_hal_close(&hal);
    return 0;
}
