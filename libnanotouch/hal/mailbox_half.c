/* SPDX-License-Identifier: BSD-3-Clause
 * The session's end of a mailbox: a backend as hal_backend.h wants it. */
#include <math.h>
#include <stdlib.h>

#include "core/axes.h"
#include "core/problem.h"
#include "hal/clock.h"
#include "hal/mailbox_memory.h"
#include "hal/reading.h"

#define NAP 200000               /* between two looks [ns] */
#define FIRST_READING 1000000000 /* arm waits so long for it [ns] */

/* What an open half has. The claim is held by one session alone; the system takes it away when that ends. */
typedef struct nt_mailbox_link {
    const nt_host *host;
    nt_shared claim, memory;
    nt_mailbox_block *block;
    nt_mailbox_description description; /* a copy: the program cannot change it any more */
    nt_channel_row rows[NT_MAILBOX_CHANNELS];
    nt_reading reading; /* the newest */
    double lift;        /* [m] */
    int is_armed;
} nt_mailbox_link;

static int64_t machine_now(const nt_mailbox_half *half)
{
    return half->clock ? half->clock() : nt_clock_now();
}

static nt_status say(const nt_host *host, nt_status status, const char *text)
{
    if (host && host->say)
        host->say(host, text);
    return status;
}

nt_status nt_mailbox_half_init(nt_mailbox_half *half, const char *name)
{
    if (!half || !name)
        return NT_E_ARGUMENT;
    const size_t length = strlen(name);
    if (length == 0 || length >= NT_MAILBOX_NAME)
        return NT_E_RANGE;
    *half = (nt_mailbox_half){.clock = NULL};
    memcpy(half->name, name, length + 1);
    return NT_OK;
}

/* --- open, close --- */

static void close_half(void *context);

static nt_status attach(nt_mailbox_half *half, nt_half wanted, nt_problem *problem)
{
    nt_mailbox_link *link = half->link;
    nt_status status = nt_shared_create(&link->claim, "claim", half->name, sizeof(uint64_t));
    if (status != NT_OK) {
        if (status == NT_E_STATE)
            (void)nt_problem_set(problem, "sessions that have this mailbox already", "", 1.0, 0.0, 0.0);
        return status;
    }
    status = nt_shared_attach(&link->memory, "mailbox", half->name, sizeof(nt_mailbox_block), 1);
    if (status == NT_OK) {
        link->block = link->memory.memory;
        if (atomic_load_explicit(&link->block->magic, memory_order_acquire) != NT_MAILBOX_MAGIC)
            status = NT_E_DEVICE;
        else if (nt_word_of(&link->block->layout) != NT_MAILBOX_LAYOUT)
            status = NT_E_UNSUPPORTED;
    }
    if (status == NT_E_UNSUPPORTED)
        (void)nt_problem_set(problem, "mailboxes of this version (another version of nanotouch made it)", "", 0.0, 1.0,
                             1.0);
    if (status == NT_E_DEVICE)
        (void)nt_problem_set(problem, "programs that serve this mailbox", "", 0.0, 1.0, 1.0);
    if (status == NT_E_STATE)
        (void)nt_problem_set(problem, "programs of this user that serve this mailbox (another user's does)", "", 0.0,
                             1.0, 1.0);
    if (status != NT_OK)
        return status;
    link->description = link->block->description;
    if (link->description.half == (uint32_t)wanted)
        return NT_OK;
    (void)nt_problem_set(problem, "half of this mailbox (0: master, 1: slave)", "", link->description.half, wanted,
                         wanted);
    return NT_E_UNSUPPORTED;
}

static nt_status open_half(void *context, nt_half wanted, const nt_host *host, nt_problem *problem)
{
    nt_mailbox_half *half = context;
    half->link = calloc(1, sizeof *half->link);
    half->counts = (nt_mailbox_counts){0};
    if (!half->link)
        return NT_E_NO_MEMORY;
    nt_reading *reading = &half->link->reading;
    half->link->host = host;
    half->link->claim.file = half->link->memory.file = -1;
    for (int i = 0; i < NT_AXES; ++i)
        reading->position[i] = reading->felt[i] = (double)NAN;
    const nt_status status = attach(half, wanted, problem);
    if (status != NT_OK)
        close_half(half);
    return status;
}

static nt_status open_master(void *context, const nt_host *host, nt_problem *problem)
{
    return open_half(context, NT_HALF_MASTER, host, problem);
}

static nt_status open_slave(void *context, const nt_host *host, nt_problem *problem)
{
    return open_half(context, NT_HALF_SLAVE, host, problem);
}

static nt_status describe(void *context, nt_capabilities *capabilities)
{
    nt_mailbox_link *link = ((nt_mailbox_half *)context)->link;
    nt_mailbox_description *found = &link->description;
    if (found->rows < 0 || found->rows > NT_MAILBOX_CHANNELS || !(found->timeout > 0.0))
        return NT_E_RANGE;
    for (int i = 0; i < found->rows; ++i) {
        nt_mailbox_row *row = &found->row[i];
        row->name[sizeof row->name - 1] = row->unit[sizeof row->unit - 1] = '\0';
        link->rows[i] = row->row;
        link->rows[i].name = row->name;
        link->rows[i].unit = row->unit;
    }
    capabilities->can = found->can & ~(uint32_t)(NT_LEADS_CLOCK | NT_IS_SLOW);
    capabilities->axes = found->axes;
    capabilities->period = found->period;
    capabilities->rows = found->rows;
    capabilities->channels = link->rows;
    return NT_OK;
}

static nt_status configure(void *context, const nt_configuration *configuration, nt_problem *problem)
{
    (void)problem;
    ((nt_mailbox_half *)context)->link->lift = configuration->lift;
    return NT_OK;
}

/* --- readings --- */

/* On the host's clock, never later than now, never earlier than the last one. */
static int64_t host_time(const nt_mailbox_link *link, int64_t age)
{
    const int64_t now = link->host->now(link->host), time = now - age, last = link->reading.time;
    return time > last || link->reading.sequence == 0 ? time : last < now ? last : now;
}

static void take(nt_mailbox_half *half)
{
    nt_mailbox_link *link = half->link;
    nt_mailbox_block *block = link->block;
    nt_reading found;
    if (nt_word_of(&block->published) == link->reading.sequence)
        return;
    const uint64_t number =
        nt_mailbox_take(&block->published, block->readings_at, block->readings[0], &found, NT_WORDS(nt_reading));
    const int64_t age = machine_now(half) - found.time;
    half->counts.torn += number == 0;
    if (number <= link->reading.sequence) /* nothing whole, or a counter that has gone mad */
        return;
    if (age < 0 || !nt_mailbox_is_sound(&found, link->description.can, link->description.axes)) {
        ++half->counts.unsound;
        return;
    }
    for (int i = 0; i < NT_READS; ++i)
        if (!(found.valid >> i & 1u))
            *nt_reading_channel(&found, i) = (double)NAN;
    found.time = host_time(link, age);
    found.sequence = number;
    found.lateness = 0.0; /* it leads no clock */
    link->reading = found;
    ++half->counts.readings;
}

/* 0: closed, silent for too long, or a beat that has not been yet. */
static int is_alive(const nt_mailbox_half *half)
{
    const uint64_t beat = atomic_load_explicit(&half->link->block->beat, memory_order_acquire);
    const int64_t age = machine_now(half) - (int64_t)beat; /* the clock is read last */
    return beat != 0 && age >= 0 && 1e-9 * (double)age <= half->link->description.timeout;
}

static nt_status read_half(void *context, nt_reading *reading)
{
    nt_mailbox_half *half = context;
    if (!is_alive(half))
        return NT_E_DEVICE;
    take(half);
    const uint32_t size = reading->size;
    *reading = half->link->reading;
    reading->size = size;
    return NT_OK;
}

/* --- requests --- */

static void ask(nt_mailbox_half *half, nt_mailbox_request *request)
{
    nt_mailbox_block *block = half->link->block;
    request->time = machine_now(half);
    request->lift = half->link->lift;
    nt_mailbox_put(&block->asked, block->requests_at, block->requests[0], request, NT_WORDS(nt_mailbox_request));
}

/* Into the range of the channel that is driven along this axis. */
static double clipped(nt_mailbox_half *half, int axis, double value)
{
    for (int i = 0; i < half->link->description.rows; ++i) {
        const nt_channel_row *row = &half->link->rows[i];
        if (!row->driven || row->axis != axis)
            continue;
        const double inside = value < row->minimum ? row->minimum : value > row->maximum ? row->maximum : value;
        half->counts.clipped += inside != value;
        return inside;
    }
    return value;
}

static nt_status write_half(void *context, const nt_action *action)
{
    nt_mailbox_half *half = context;
    const nt_mailbox_link *link = half->link;
    nt_mailbox_request request = {.is_armed = 1,
                                  .state = action->state,
                                  .tick = action->tick,
                                  .drive_amplitude = action->drive_amplitude,
                                  .drive_frequency = action->drive_frequency};
    copy_axes(request.target, action->target);
    for (int axis = link->description.axes == 1 ? NT_Z : NT_X; axis < NT_AXES; ++axis) {
        if (!isfinite(request.target[axis]))
            return NT_E_NOT_FINITE;
        request.target[axis] = clipped(half, axis, request.target[axis]);
    }
    if (!isfinite(request.drive_amplitude) || !isfinite(request.drive_frequency))
        return NT_E_NOT_FINITE;
    ask(half, &request);
    return NT_OK;
}

static void ask_nothing(nt_mailbox_half *half, int is_armed)
{
    const double idle = half->link->description.half == NT_HALF_MASTER ? 0.0 : (double)NAN;
    nt_mailbox_request request = {.is_armed = is_armed, .target = {idle, idle, idle}};
    ask(half, &request);
}

static void nap(void)
{
    (void)nt_clock_sleep_until(nt_clock_now() + NAP);
}

static nt_status arm(void *context)
{
    nt_mailbox_half *half = context;
    nt_mailbox_link *link = half->link;
    const uint64_t before = nt_word_of(&link->block->published);
    ask_nothing(half, 1);
    link->is_armed = 1;
    for (const int64_t start = nt_clock_now(); nt_clock_now() - start < FIRST_READING; nap()) {
        take(half);
        if (link->reading.sequence > before && link->reading.valid >> NT_Z & 1u)
            return NT_OK;
    }
    return say(link->host, NT_E_DEVICE, "mailbox: its program lives, but gives no position along z");
}

/* The program is told, and has a moment to take note; one that is gone has nobody to tell. */
static void disarm(void *context)
{
    nt_mailbox_half *half = context;
    nt_mailbox_link *link = half->link;
    if (!link || !link->is_armed)
        return;
    link->is_armed = 0;
    ask_nothing(half, 0);
    const uint64_t number = nt_word_of(&link->block->asked);
    const int64_t start = nt_clock_now(), patience = (int64_t)(1e9 * link->description.timeout);
    while (atomic_load_explicit(&link->block->answered, memory_order_acquire) < number && is_alive(half) &&
           nt_clock_now() - start < patience)
        nap();
}

static void close_half(void *context)
{
    nt_mailbox_half *half = context;
    if (!half->link)
        return;
    disarm(half);
    nt_shared_close(&half->link->memory);
    nt_shared_close(&half->link->claim);
    free(half->link);
    half->link = NULL;
}

const nt_backend *nt_mailbox_backend(nt_half half)
{
#define OPERATIONS                                                                                                     \
    .size = sizeof(nt_backend), .version = NT_HAL_API_VERSION, .name = "mailbox", .describe = describe,                \
    .configure = configure, .arm = arm, .read = read_half, .write = write_half, .disarm = disarm, .close = close_half
    static const nt_backend halves[] = {{OPERATIONS, .half = NT_HALF_MASTER, .open = open_master},
                                        {OPERATIONS, .half = NT_HALF_SLAVE, .open = open_slave}};
    return &halves[half == NT_HALF_SLAVE];
}
