/* SPDX-License-Identifier: BSD-3-Clause
 * A master in another process: the backend for the device of device.py, as a shared object.
 *
 *     cc -std=c11 -O2 -fPIC -shared -I libnanotouch/include -o pointer.so pointer.c
 *
 * Its option is the device's port. One at a time: a shared object has one state. */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "nanotouch/hal_backend.h"

#define PERIOD (1.0 / 125.0)             /* of the device's heartbeats [s] */
#define TRAVEL 0.02                      /* z runs over half of it to either side [m] */
#define HELLO_EVERY 250000000            /* the device forgets who is silent for a second [ns] */
#define LATEST_STAMP ((uint64_t)1 << 61) /* of a device's clock: 73 years [ns] */
enum { DIFFERENCES = 4, MOST = 256, BODY = 52, REPORT = BODY + 4 };

typedef struct pointer {
    const nt_host *host;
    int link, is_open, turned_away;
    uint32_t run;
    uint64_t sequence; /* of the device */
    int64_t differences[DIFFERENCES], last, greeted;
    unsigned seen;      /* differences so far */
    nt_reading reading; /* the newest */
} pointer;

/* --- time --- */

static int64_t clock_now(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

/* From the device's stamps to the host's clock: their least difference of late is the one without delays. */
static int64_t convert(pointer *p, int64_t stamp)
{
    const int64_t now = p->host->now(p->host);
    p->differences[p->seen++ % DIFFERENCES] = now - stamp;
    int64_t least = now - stamp;
    for (unsigned i = 0; i < DIFFERENCES && i < p->seen; ++i)
        if (p->differences[i] < least)
            least = p->differences[i];
    if (stamp + least > p->last)
        p->last = stamp + least;
    return p->last < now ? p->last : now;
}

/* --- what comes in --- */

static uint32_t crc32_of(const unsigned char *bytes, int count)
{
    uint32_t crc = 0xffffffffu;
    for (int i = 0; i < count; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ (crc & 1u ? 0xedb88320u : 0u);
    }
    return ~crc;
}

/* Little-endian, as it was sent. */
static uint64_t number(const unsigned char *bytes, int count)
{
    uint64_t value = 0;
    for (int i = count - 1; i >= 0; --i)
        value = value << 8 | bytes[i];
    return value;
}

/* 0 for what is no report, damaged, old or impossible; it changes nothing. */
static int understand(pointer *p, const unsigned char *report, ssize_t length)
{
    if (length != REPORT || memcmp(report, "NTP1", 4) != 0 || crc32_of(report, BODY) != number(report + BODY, 4))
        return 0;
    const uint32_t run = (uint32_t)number(report + 4, 4);
    const uint64_t sequence = number(report + 8, 8), stamp = number(report + 16, 8), bits = number(report + 40, 8);
    double z;
    memcpy(&z, &bits, sizeof z);
    if ((p->seen > 0 && run == p->run && sequence <= p->sequence) || !(fabs(z) <= 0.5 * TRAVEL) || stamp > LATEST_STAMP)
        return 0;
    if (run != p->run) /* the device has been started anew: another clock */
        p->seen = 0;
    p->run = run;
    p->sequence = sequence;
    p->reading.time = convert(p, (int64_t)stamp);
    p->reading.position[NT_Z] = z;
    p->reading.valid = 1u << NT_Z;
    p->reading.buttons = (uint32_t)number(report + 48, 4);
    return 1;
}

/* All that has come in meanwhile; never waits. */
static void drain(pointer *p)
{
    unsigned char report[256];
    int understood = 0;
    if (clock_now() - p->greeted > HELLO_EVERY) {
        p->greeted = clock_now();
        (void)!send(p->link, "hello", 5, 0); /* it may not be there, or not yet */
    }
    for (int i = 0; i < MOST; ++i) {
        const ssize_t length = recv(p->link, report, sizeof report, MSG_DONTWAIT);
        if (length < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
            break;
        understood |= length >= 0 && understand(p, report, length);
    }
    p->reading.sequence += understood != 0;
}

/* --- the table --- */

static nt_status open_pointer(void *context, const nt_host *host, nt_problem *problem)
{
    pointer *p = context;
    (void)problem;
    if (p->is_open) {
        ++p->turned_away; /* close will be called for this one, too */
        return NT_E_STATE;
    }
    *p = (pointer){.host = host, .link = -1, .is_open = 1, .last = INT64_MIN, .greeted = INT64_MIN / 2};
    p->reading.size = sizeof p->reading;
    for (int i = 0; i < NT_AXES; ++i)
        p->reading.position[i] = p->reading.felt[i] = NAN;
    return NT_OK;
}

static nt_status describe(void *context, nt_capabilities *capabilities)
{
    static const nt_channel_row rows[] = {{"position", "m", 0, NT_Z, -0.5 * TRAVEL, 0.5 * TRAVEL, 0.0, 0.0, 1e-3, NAN}};
    (void)context;
    capabilities->can = NT_IS_EVENT_DRIVEN; /* neither feels nor pushes */
    capabilities->axes = 1;
    capabilities->period = PERIOD;
    capabilities->rows = 1;
    capabilities->channels = rows;
    return NT_OK;
}

static nt_status configure(void *context, const nt_configuration *configuration, nt_problem *problem)
{
    pointer *p = context;
    const long port = strtol(configuration->option, NULL, 10);
    if (port < 1 || port > 65535) {
        *problem = (nt_problem){
            .field = "option: the device's port", .value = (double)port, .minimum = 1.0, .maximum = 65535.0};
        return NT_E_RANGE;
    }
    const struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons((uint16_t)port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    p->link = socket(AF_INET, SOCK_DGRAM, 0);
    if (p->link < 0 || connect(p->link, (const struct sockaddr *)&address, sizeof address) != 0)
        return NT_E_DEVICE; /* once connected nobody else is heard */
    return NT_OK;
}

static nt_status arm(void *context)
{
    pointer *p = context;
    const struct timespec moment = {.tv_nsec = 1000000};
    for (int i = 0; i < 1000; ++i) {
        drain(p);
        if (p->reading.sequence > 0)
            return NT_OK;
        (void)nanosleep(&moment, NULL);
    }
    p->host->say(p->host, "no device answers at this port");
    return NT_E_DEVICE;
}

static nt_status read_pointer(void *context, nt_reading *reading)
{
    pointer *p = context;
    drain(p);
    *reading = p->reading;
    return NT_OK;
}

static nt_status write_pointer(void *context, const nt_action *action)
{
    (void)context, (void)action; /* it has no motor */
    return NT_OK;
}

static void close_pointer(void *context)
{
    pointer *p = context;
    if (p->turned_away > 0) {
        --p->turned_away;
        return;
    }
    if (p->link >= 0)
        (void)close(p->link);
    p->link = -1;
    p->is_open = 0;
}

NT_API const nt_backend *nanotouch_backend(void);
NT_API const nt_backend *nanotouch_backend(void)
{
    static pointer state;
    static const nt_backend backend = {.size = sizeof backend,
                                       .version = NT_HAL_API_VERSION,
                                       .name = "pointer",
                                       .half = NT_HALF_MASTER,
                                       .open = open_pointer,
                                       .describe = describe,
                                       .configure = configure,
                                       .arm = arm,
                                       .read = read_pointer,
                                       .write = write_pointer,
                                       .close = close_pointer,
                                       .context = &state};
    return &backend;
}
