/* SPDX-License-Identifier: BSD-3-Clause
 * The kernel's calls for spidev on a model of it: "0" and "1" are the files, memory is the test's own. */
#ifndef TESTS_SPIDEV_CALLS_H
#define TESTS_SPIDEV_CALLS_H

#include <stdint.h>
#include <string.h>

static inline int open_call(void *context, const char *path)
{
    (void)context;
    return path[0] - '0';
}

static inline void close_call(void *context, int file)
{
    (void)context, (void)file;
}

static inline int copy_bytes(void *context, uint64_t theirs, uint8_t *ours, uint32_t count, int is_write)
{
    (void)context;
    memcpy(is_write ? (void *)(uintptr_t)theirs : ours, is_write ? ours : (const void *)(uintptr_t)theirs, count);
    return 0;
}

#endif
