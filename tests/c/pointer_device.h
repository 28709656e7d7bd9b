/* SPDX-License-Identifier: BSD-3-Clause
 * The device that docs/examples/hal/pointer.c speaks to, within a test: it answers each "hello" with a report, and
 * sends another one whenever the test lets a period pass. Its stamps are the test's clock. */
#ifndef TESTS_POINTER_DEVICE_H
#define TESTS_POINTER_DEVICE_H

#include <arpa/inet.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

typedef struct pointer_device {
    int link, is_silent, has_listener;
    uint64_t sequence;
    struct sockaddr_in listener;
    pthread_t answering;
    pthread_mutex_t lock;
    int64_t *clock;
    char port[8];
} pointer_device;

static inline void pointer_put(uint8_t *to, uint64_t value, int count)
{
    for (int i = 0; i < count; ++i)
        to[i] = (uint8_t)(value >> 8 * i);
}

/* With the lock held. */
static inline void pointer_report(pointer_device *d)
{
    uint8_t bytes[56] = {'N', 'T', 'P', '1', 1};
    const double z = 1e-3;
    uint64_t bits;
    if (d->is_silent || !d->has_listener)
        return;
    memcpy(&bits, &z, sizeof bits);
    pointer_put(bytes + 8, ++d->sequence, 8);
    pointer_put(bytes + 16, (uint64_t)*d->clock, 8);
    pointer_put(bytes + 40, bits, 8);
    uint32_t crc = 0xffffffffu;
    for (int i = 0; i < 52; ++i) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ (crc & 1u ? 0xedb88320u : 0u);
    }
    pointer_put(bytes + 52, ~crc, 4);
    (void)!sendto(d->link, bytes, sizeof bytes, 0, (const struct sockaddr *)&d->listener, sizeof d->listener);
}

static inline void *pointer_answer(void *context)
{
    pointer_device *d = context;
    char hello[16];
    for (;;) {
        struct sockaddr_in from;
        socklen_t length = sizeof from;
        const ssize_t count = recvfrom(d->link, hello, sizeof hello, 0, (struct sockaddr *)&from, &length);
        if (count == 3) /* "end" */
            return NULL;
        (void)pthread_mutex_lock(&d->lock);
        d->has_listener = 1;
        d->listener = from;
        pointer_report(d);
        (void)pthread_mutex_unlock(&d->lock);
    }
}

static inline int pointer_start(pointer_device *d, int64_t *clock)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t length = sizeof address;
    *d = (pointer_device){.link = socket(AF_INET, SOCK_DGRAM, 0), .clock = clock};
    (void)pthread_mutex_init(&d->lock, NULL);
    if (bind(d->link, (const struct sockaddr *)&address, length) != 0 ||
        getsockname(d->link, (struct sockaddr *)&address, &length) != 0)
        return 0;
    (void)snprintf(d->port, sizeof d->port, "%d", ntohs(address.sin_port));
    return pthread_create(&d->answering, NULL, pointer_answer, d) == 0;
}

static inline void pointer_tick(pointer_device *d)
{
    (void)pthread_mutex_lock(&d->lock);
    pointer_report(d);
    (void)pthread_mutex_unlock(&d->lock);
}

static inline void pointer_end(pointer_device *d)
{
    struct sockaddr_in address;
    socklen_t length = sizeof address;
    (void)getsockname(d->link, (struct sockaddr *)&address, &length);
    (void)!sendto(d->link, "end", 3, 0, (const struct sockaddr *)&address, length);
    (void)pthread_join(d->answering, NULL);
    (void)close(d->link);
}

#endif
