/* SPDX-License-Identifier: BSD-3-Clause
 * A program that writes anything into its mailbox, and a session that does: neither end reads what cannot be, and
 * neither runs away. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <unistd.h>

#include "hal/mailbox_memory.h"
#include "input.h"
#include "nanotouch/hal.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static int64_t clock_now = 1000000000, each = 1000; /* time, and what it goes on by whenever it is read [ns] */

static nt_mailbox *serves; /* a program that measures whenever time passes; NULL: none does */

static int64_t now(void)
{
    nt_mailbox *program = serves;
    const nt_reading good = {.time = clock_now, .valid = 1u << NT_Z};
    serves = NULL;
    if (program)
        (void)nt_mailbox_publish(program, &good);
    serves = program;
    return clock_now += each;
}

static int64_t now_of(const nt_host *host)
{
    (void)host;
    return now();
}

static const nt_host host = {sizeof host, NT_HAL_API_VERSION, now_of, NULL, NULL};
static const nt_channel_row rows[2][3] = {{{"position", "m", 0, NT_Z, -0.1, 0.1, 0.0, 0.0, 0.0, (double)NAN},
                                           {"motor force", "N", 1, NT_Z, -3.0, 3.0, 0.0, 0.0, 0.0, 0.0}},
                                          {{"position", "m", 0, NT_Z, -1e-5, 1e-5, 0.0, 0.0, 0.0, (double)NAN},
                                           {"deflection", "m", 0, NT_Z, -1e-6, 1e-6, 0.0, 0.0, 0.0, (double)NAN},
                                           {"travel", "m", 1, NT_Z, -1e-5, 1e-5, 0.0, 0.0, 0.0, (double)NAN}}};

static void scribble(fuzz_input *in, nt_mailbox_block *block)
{
    uint16_t place;
    uint8_t count, bytes[64] = {0};
    fuzz_take(in, &place, sizeof place);
    fuzz_take(in, &count, sizeof count);
    const size_t n = count % sizeof bytes + 1;
    fuzz_take(in, bytes, n);
    memcpy((char *)block + place % (sizeof *block - n), bytes, n);
}

/* A reading that is whole, and anything. */
static void put(fuzz_input *in, nt_mailbox_block *block)
{
    nt_reading reading = {0};
    uint8_t part;
    fuzz_take(in, &part, sizeof part);
    fuzz_take(in, (char *)&reading + part % 2 * (sizeof reading / 2), sizeof reading / 2);
    reading.time = clock_now - (part & 0x70) * 1000;
    if (part & 0x80)
        reading.valid &= 0x3fu;
    nt_mailbox_put(&block->published, block->readings_at, block->readings[0], &reading, NT_WORDS(nt_reading));
}

static void check(const nt_hal *hal)
{
    const nt_reading *reading = &hal->reading;
    for (int i = 0; i < NT_AXES; ++i) {
        REQUIRE(!(reading->valid >> i & 1u) || isfinite(reading->position[i]));
        REQUIRE(!(reading->valid >> (NT_READS_FELT + i) & 1u) || isfinite(reading->felt[i]));
    }
    REQUIRE(!(reading->flags & NT_SAMPLE_DEVICE_LOST) || reading->valid == 0);
}

static void drive(fuzz_input *in, nt_hal *hal, nt_mailbox *mailbox)
{
    nt_mailbox_request request;
    nt_action action = {.size = sizeof action, .state = NT_RUN, .time = clock_now};
    for (int i = 0; i < NT_AXES; ++i)
        action.target[i] = fuzz_double(in, -10.0, 10.0);
    (void)nt_hal_write(hal, &action);
    nt_mailbox_ask(mailbox, &request);
    REQUIRE(request.is_armed || !(request.target[NT_Z] > 0.0 || request.target[NT_Z] < 0.0));
}

static void talk(fuzz_input *in, nt_hal *hal, nt_mailbox *mailbox, nt_mailbox_block *block)
{
    while (in->size > 0) {
        uint8_t what;
        fuzz_take(in, &what, sizeof what);
        clock_now += what >> 3;
        if (what % 8 < 2)
            scribble(in, block);
        else if (what % 8 < 5)
            put(in, block);
        else if (what % 8 == 5)
            drive(in, hal, mailbox);
        else if (what % 8 == 6)
            nt_mailbox_beat(mailbox);
        REQUIRE(nt_hal_read(hal) == NT_OK);
        check(hal);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    uint8_t what;
    char name[NT_MAILBOX_NAME];
    (void)snprintf(name, sizeof name, "fuzz-%ld", (long)getpid());
    fuzz_take(&in, &what, sizeof what);
    const nt_half half = what & 1 ? NT_HALF_SLAVE : NT_HALF_MASTER;
    nt_mailbox_device device = nt_mailbox_device_defaults(half);
    device.can = half == NT_HALF_MASTER ? NT_CAN_PUSH : NT_CAN_FEEL;
    device.channels = rows[half];
    device.rows = half == NT_HALF_MASTER ? 2 : 3;
    device.clock = now;
    nt_mailbox *mailbox = NULL;
    nt_shared view = {.file = -1};
    REQUIRE(nt_mailbox_open(&mailbox, name, &device, NULL) == NT_OK);
    REQUIRE(nt_shared_attach(&view, "mailbox", name, sizeof(nt_mailbox_block), 1) == NT_OK);
    if (what & 2) /* before the session comes: what the device says of itself, too */
        scribble(&in, view.memory);
    nt_mailbox_half there;
    nt_hal hal = {0};
    REQUIRE(nt_mailbox_half_init(&there, name) == NT_OK);
    there.clock = now;
    const nt_hal_choice choice = {nt_mailbox_backend(half), &there};
    const nt_configuration configuration = {.size = sizeof configuration, .period = 1e-4, .lift = 1e-6, .option = ""};
    if (nt_hal_open(&hal, half, &choice, &host, NULL) == NT_OK) {
        serves = mailbox; /* arm waits for a reading */
        const nt_status armed =
            nt_hal_configure(&hal, &configuration, NULL) == NT_OK ? nt_hal_arm(&hal) : NT_E_UNSUPPORTED;
        serves = NULL;
        if (armed == NT_OK)
            talk(&in, &hal, mailbox, view.memory);
        each = 100000000; /* nobody answers: the timeout passes at once */
        nt_hal_close(&hal);
        each = 1000;
    }
    nt_shared_close(&view);
    nt_mailbox_close(mailbox);
    return 0;
}
