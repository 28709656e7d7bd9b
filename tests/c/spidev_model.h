/* SPDX-License-Identifier: BSD-3-Clause
 * What the kernel's spidev makes of its requests, over the simulated bus: settings that it keeps, and messages whose
 * transfers belong to one frame until the chip select changes. Copying is left to whoever uses it. A frame of which the
 * end does not go through is told as the kernel tells it (spidev_message in drivers/spi/spidev.c): by the whole length,
 * with what the message before left in spidev's buffer where nothing came. */
#ifndef TESTS_SPIDEV_MODEL_H
#define TESTS_SPIDEV_MODEL_H

#include <errno.h>
#include <linux/spi/spidev.h>
#include <stdint.h>
#include <string.h>
#include <sys/ioctl.h>

#include "simulated_bus.h"

enum { MODEL_MESSAGE = 4096, MODEL_ALIGN = 64 }; /* spidev's buffer; where each transfer begins in it, on Arm [bytes] */

typedef struct spidev_model {
    simulated_bus *bus;
    int chip; /* number on the bus */
    uint8_t mode, bits;
    uint32_t clock;
    uint32_t longest; /* message so far [bytes] */
    long messages;
    uint8_t received[MODEL_MESSAGE]; /* nobody clears it between two messages */
} spidev_model;

/* Copies between a message's buffers and here; 0 or -errno. */
typedef int spidev_copy(void *context, uint64_t theirs, uint8_t *ours, uint32_t count, int is_write);

static inline int model_setting(spidev_model *m, unsigned request, uint8_t *argument)
{
    switch (request) {
    case SPI_IOC_WR_MODE:
        m->mode = argument[0];
        return 0;
    case SPI_IOC_RD_MODE:
        argument[0] = m->mode;
        return 0;
    case SPI_IOC_WR_BITS_PER_WORD:
        m->bits = argument[0];
        return 0;
    case SPI_IOC_RD_BITS_PER_WORD:
        argument[0] = m->bits;
        return 0;
    case SPI_IOC_WR_MAX_SPEED_HZ:
        memcpy(&m->clock, argument, 4);
        return 0;
    case SPI_IOC_RD_MAX_SPEED_HZ:
        memcpy(argument, &m->clock, 4);
        return 0;
    default:
        return -ENOTTY;
    }
}

/* One frame, of transfers `first` to `last`: what came goes to where each transfer has its place, from `place` on. */
static inline uint32_t model_frame(spidev_model *m, const struct spi_ioc_transfer *first,
                                   const struct spi_ioc_transfer *last, const uint8_t *out, uint32_t place)
{
    uint8_t in[MODEL_MESSAGE];
    uint32_t length = 0, at = 0;
    for (const struct spi_ioc_transfer *t = first; t <= last; ++t)
        length += t->len;
    const uint32_t through = simulated_through(m->bus, m->chip, length);
    simulated_frame(m->bus, m->chip, out, in, through);
    for (const struct spi_ioc_transfer *t = first; t <= last; at += t++->len) {
        const uint32_t came = through <= at ? 0u : through - at < t->len ? through - at : t->len;
        memcpy(m->received + place, in + at, came);
        place += (t->len + MODEL_ALIGN - 1) / MODEL_ALIGN * MODEL_ALIGN;
    }
    return place;
}

static inline int model_message(spidev_model *m, const struct spi_ioc_transfer *list, uint32_t count, spidev_copy *copy,
                                void *context)
{
    uint8_t out[MODEL_MESSAGE];
    uint32_t total = 0, room = 0, start = 0, first = 0, place = 0;
    int error = 0;
    ++m->messages;
    for (uint32_t i = 0; i < count && !error; total += list[i++].len) {
        room += (list[i].len + MODEL_ALIGN - 1) / MODEL_ALIGN * MODEL_ALIGN;
        error = room > MODEL_MESSAGE ? -EMSGSIZE : copy(context, list[i].tx_buf, out + total, list[i].len, 0);
    }
    for (uint32_t i = 0, end = 0; i < count && !error; ++i) {
        end += list[i].len;
        if (!list[i].cs_change && i + 1 < count)
            continue;
        place = model_frame(m, list + first, list + i, out + start, place);
        first = i + 1;
        start = end;
    }
    place = 0;
    for (uint32_t i = 0; i < count && !error; ++i) {
        error = copy(context, list[i].rx_buf, m->received + place, list[i].len, 1);
        place += (list[i].len + MODEL_ALIGN - 1) / MODEL_ALIGN * MODEL_ALIGN;
    }
    m->longest = total > m->longest ? total : m->longest;
    return error ? error : (int)total;
}

/* A request with its argument, as long as it says; the result of the ioctl, or -errno. */
static inline int model_request(spidev_model *m, unsigned request, void *argument, spidev_copy *copy, void *context)
{
    if (m->bus->fault == BUS_GONE)
        return -ESHUTDOWN;
    if (_IOC_TYPE(request) != SPI_IOC_MAGIC)
        return -ENOTTY;
    if (_IOC_NR(request) != 0 || _IOC_DIR(request) != _IOC_WRITE)
        return model_setting(m, request, argument);
    if (m->bus->fault == BUS_REFUSED)
        return -EIO;
    if (m->bus->errors != 0) {
        m->bus->errors -= m->bus->errors > 0;
        return -m->bus->error;
    }
    if (m->mode != (!m->chip ? 1 : m->bus->has_crc ? 3 : 2)) /* on the wrong edge every bit is that of its neighbour */
        return -EPROTO;
    const uint32_t size = _IOC_SIZE(request);
    return size % sizeof(struct spi_ioc_transfer)
               ? -EINVAL
               : model_message(m, argument, size / (uint32_t)sizeof(struct spi_ioc_transfer), copy, context);
}

#endif
