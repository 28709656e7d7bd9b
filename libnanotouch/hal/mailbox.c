/* SPDX-License-Identifier: BSD-3-Clause
 * The program's end of a mailbox. */
#include "nanotouch/mailbox.h"

#include <math.h>
#include <stdlib.h>

#include "core/problem.h"
#include "hal/capabilities.h"
#include "hal/clock.h"
#include "hal/mailbox_memory.h"
#include "hal/reading.h"

#define DEFAULT_PERIOD 1e-3 /* [s] */
#define DEFAULT_TIMEOUT 0.1 /* without word from the other side: the rig is left safe [s] */
#define LONGEST_TIMEOUT 1.0 /* [s] */
#define ALL_FLAGS (2u * NT_SAMPLE_DEVICE_LOST - 1u)

_Static_assert(sizeof(nt_reading) % sizeof(uint64_t) == 0, "whole words");
_Static_assert(sizeof(nt_mailbox_request) % sizeof(uint64_t) == 0, "whole words");
_Static_assert((int)NT_MAILBOX_NAME == (int)NT_GIVEN_NAME_SIZE, "what shared memory allows");

struct nt_mailbox {
    nt_shared memory;
    nt_mailbox_block *block;
    nt_mailbox_request last; /* the newest that was whole */
    int64_t (*clock)(void);
};

nt_mailbox_device nt_mailbox_device_defaults(nt_half half)
{
    return (nt_mailbox_device){.half = half, .axes = 1, .period = DEFAULT_PERIOD, .timeout = DEFAULT_TIMEOUT};
}

static nt_status check(const nt_mailbox_device *device, nt_problem *problem)
{
    const nt_capabilities has = {.size = sizeof has,
                                 .can = device->can,
                                 .axes = device->axes,
                                 .rows = device->rows,
                                 .channels = device->channels,
                                 .period = device->period};
    const double least = 2.0 * device->period;
    if (device->half != NT_HALF_MASTER && device->half != NT_HALF_SLAVE)
        return nt_problem_set(problem, "half", "", device->half, NT_HALF_MASTER, NT_HALF_SLAVE);
    if (device->can & (NT_LEADS_CLOCK | NT_IS_SLOW))
        return nt_problem_set(problem, "bits of can that a mailbox has not", "",
                              device->can & (NT_LEADS_CLOCK | NT_IS_SLOW), 0.0, 0.0);
    if (device->rows > NT_MAILBOX_CHANNELS)
        return nt_problem_set(problem, "rows", "", device->rows, 0.0, NT_MAILBOX_CHANNELS);
    if (!(device->timeout > least && device->timeout <= LONGEST_TIMEOUT))
        return nt_problem_set(problem, "timeout", "s", device->timeout, least, LONGEST_TIMEOUT);
    nt_status status = nt_capabilities_check(&has, problem);
    for (int i = 0; i < device->rows && status == NT_OK; ++i) {
        const size_t length = strlen(device->channels[i].name);
        if (length >= NT_MAILBOX_CHANNEL_NAME)
            status = nt_problem_set(problem, "bytes of a channel's name", "", (double)length, 1.0,
                                    NT_MAILBOX_CHANNEL_NAME - 1);
    }
    return status;
}

static void describe(nt_mailbox_description *to, const nt_mailbox_device *device)
{
    *to = (nt_mailbox_description){.half = (uint32_t)device->half,
                                   .can = device->can,
                                   .axes = device->axes,
                                   .rows = device->rows,
                                   .period = device->period,
                                   .timeout = device->timeout};
    for (int i = 0; i < device->rows; ++i) {
        const nt_channel_row *row = &device->channels[i];
        to->row[i].row = *row;
        to->row[i].row.name = to->row[i].row.unit = NULL;
        memcpy(to->row[i].name, row->name, strlen(row->name) + 1);
        memcpy(to->row[i].unit, row->unit, strlen(row->unit) + 1);
    }
}

/* No session yet: nobody drives, and nothing is asked. */
static void forget(nt_mailbox *mailbox)
{
    const double idle = mailbox->block->description.half == NT_HALF_MASTER ? 0.0 : (double)NAN;
    mailbox->last.is_armed = 0;
    mailbox->last.target[NT_X] = mailbox->last.target[NT_Y] = mailbox->last.target[NT_Z] = idle;
}

nt_status nt_mailbox_open(nt_mailbox **mailbox, const char *name, const nt_mailbox_device *device, nt_problem *problem)
{
    if (!mailbox || !name || !device)
        return NT_E_ARGUMENT;
    nt_status status = check(device, problem);
    if (status != NT_OK)
        return status;
    nt_mailbox *made = calloc(1, sizeof *made);
    if (!made)
        return NT_E_NO_MEMORY;
    status = nt_shared_create(&made->memory, "mailbox", name, sizeof(nt_mailbox_block));
    if (status != NT_OK) {
        if (status == NT_E_RANGE)
            (void)nt_problem_set(problem, "bytes of the name: letters, digits, '.', '-' and '_'", "",
                                 (double)strlen(name), 1.0, NT_MAILBOX_NAME - 1);
        free(made);
        return status;
    }
    made->block = made->memory.memory;
    made->clock = device->clock ? device->clock : nt_clock_now;
    describe(&made->block->description, device);
    forget(made);
    nt_mailbox_beat(made);
    atomic_store_explicit(&made->block->layout, NT_MAILBOX_LAYOUT, memory_order_relaxed);
    atomic_store_explicit(&made->block->magic, NT_MAILBOX_MAGIC, memory_order_release);
    *mailbox = made;
    return NT_OK;
}

int nt_mailbox_is_sound(const nt_reading *reading, uint32_t can, int axes)
{
    nt_reading found = *reading;
    if (reading->flags & ~ALL_FLAGS || reading->valid & ~nt_reading_may_hold(can, axes))
        return 0;
    if (reading->flags & NT_SAMPLE_DEVICE_LOST && reading->valid)
        return 0;
    for (int i = 0; i < NT_READS; ++i)
        if (reading->valid >> i & 1u && !isfinite(*nt_reading_channel(&found, i)))
            return 0;
    return 1;
}

nt_status nt_mailbox_publish(nt_mailbox *mailbox, const nt_reading *reading)
{
    nt_mailbox_block *block = mailbox->block;
    nt_mailbox_beat(mailbox);
    if (!nt_mailbox_is_sound(reading, block->description.can, block->description.axes) ||
        reading->time > (int64_t)nt_word_of(&block->beat))
        return NT_E_RANGE;
    nt_mailbox_put(&block->published, block->readings_at, block->readings[0], reading, NT_WORDS(nt_reading));
    return NT_OK;
}

void nt_mailbox_beat(nt_mailbox *mailbox)
{
    const int64_t now = mailbox->clock();
    atomic_store_explicit(&mailbox->block->beat, now > 0 ? (uint64_t)now : 1u, memory_order_release);
}

int64_t nt_mailbox_now(const nt_mailbox *mailbox)
{
    return mailbox->clock();
}

static int is_alive(const nt_mailbox *mailbox)
{
    const int64_t age = mailbox->clock() - mailbox->last.time; /* the clock is read last: below 0 is nonsense */
    return age >= 0 && 1e-9 * (double)age <= mailbox->block->description.timeout;
}

void nt_mailbox_ask(nt_mailbox *mailbox, nt_mailbox_request *request)
{
    nt_mailbox_block *block = mailbox->block;
    nt_mailbox_request found;
    const uint64_t number =
        nt_mailbox_take(&block->asked, block->requests_at, block->requests[0], &found, NT_WORDS(nt_mailbox_request));
    if (number > 0) {
        mailbox->last = found;
        atomic_store_explicit(&block->answered, number, memory_order_release);
    }
    if (!mailbox->last.is_armed || !is_alive(mailbox))
        forget(mailbox);
    *request = mailbox->last;
}

void nt_mailbox_close(nt_mailbox *mailbox)
{
    if (!mailbox)
        return;
    if (nt_shared_is_own(&mailbox->memory))
        atomic_store_explicit(&mailbox->block->beat, 0, memory_order_release);
    nt_shared_close(&mailbox->memory);
    free(mailbox);
}
