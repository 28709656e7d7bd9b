/* SPDX-License-Identifier: BSD-3-Clause
 * What the kernel's spidev makes of its requests, over the simulated bus: settings that it keeps, and messages whose
 * transfers belong to one frame until the chip select changes. Copying is left to whoever uses it. */
#ifndef TESTS_SPIDEV_MODEL_H
#define TESTS_SPIDEV_MODEL_H

#include <errno.h>
#include <linux/spi/spidev.h>
#include <stdint.h>
#include <string.h>
#include <sys/ioctl.h>

#include "simulated_bus.h"

enum { MODEL_MESSAGE = 4096 };

typedef struct spidev_model {
    simulated_bus *bus;
    int chip; /* number on the bus */
    uint8_t mode, bits;
    uint32_t clock;
    uint32_t longest; /* message so far [bytes] */
    long messages;
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

static inline int model_message(spidev_model *m, const struct spi_ioc_transfer *list, uint32_t count, spidev_copy *copy,
                                void *context)
{
    uint8_t out[MODEL_MESSAGE], in[MODEL_MESSAGE];
    uint32_t total = 0, start = 0, first = 0;
    ++m->messages;
    for (uint32_t i = 0; i < count; ++i) {
        if (total + list[i].len > MODEL_MESSAGE)
            return -EMSGSIZE;
        int error = copy(context, list[i].tx_buf, out + total, list[i].len, 0);
        total += list[i].len;
        if (error)
            return error;
        if (!list[i].cs_change && i + 1 < count)
            continue;
        simulated_frame(m->bus, m->chip, out + start, in + start, total - start);
        for (uint32_t at = start; first <= i; at += list[first++].len)
            if ((error = copy(context, list[first].rx_buf, in + at, list[first].len, 1)) != 0)
                return error;
        start = total;
    }
    m->longest = total > m->longest ? total : m->longest;
    return m->bus->fault == BUS_SHORT ? (int)total - 1 : (int)total;
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
