/* SPDX-License-Identifier: BSD-3-Clause
 * Frames to the kernel's spidev: each under a chip select of its own, several in a message, none divided. */
#if defined(__linux__)
#define _DEFAULT_SOURCE /* flock */
#endif

#include "nanotouch/advanced/hal_linux.h"

#if defined(__linux__)

#include <errno.h>
#include <fcntl.h>
#include <linux/spi/spidev.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

/* --- the system calls --- */

static int open_file(void *context, const char *path)
{
    (void)context;
    const int file = open(path, O_RDWR | O_CLOEXEC);
    if (file < 0)
        return -errno;
    if (flock(file, LOCK_EX | LOCK_NB) == 0) /* two loops on one stage would fight */
        return file;
    const int error = errno == EWOULDBLOCK ? EBUSY : errno;
    (void)close(file);
    return -error;
}

static int control_file(void *context, int file, unsigned long request, void *argument)
{
    (void)context;
    const int result = ioctl(file, request, argument);
    return result < 0 ? -errno : result;
}

static void close_file(void *context, int file)
{
    (void)context;
    (void)close(file);
}

/* --- open --- */

typedef struct setting {
    const char *name;
    unsigned long write, read;
    uint32_t size;
} setting;

static const setting settings[] = {
    {"mode", SPI_IOC_WR_MODE, SPI_IOC_RD_MODE, 1},
    {"bits of a word", SPI_IOC_WR_BITS_PER_WORD, SPI_IOC_RD_BITS_PER_WORD, 1},
    {"clock", SPI_IOC_WR_MAX_SPEED_HZ, SPI_IOC_RD_MAX_SPEED_HZ, 4},
};

/* Little or big endian: a single byte of a setting is a byte. */
static int put(const nt_spi *spi, int file, const setting *at, uint32_t value)
{
    uint8_t byte = (uint8_t)value;
    return spi->calls.control(spi->calls.context, file, at->write, at->size == 1 ? (void *)&byte : (void *)&value);
}

static int get(const nt_spi *spi, int file, const setting *at, uint32_t *value)
{
    uint8_t byte = 0;
    const int result =
        spi->calls.control(spi->calls.context, file, at->read, at->size == 1 ? (void *)&byte : (void *)value);
    if (at->size == 1)
        *value = byte;
    return result;
}

static nt_status refuse(char *reason, const char *path, const char *what, int error)
{
    if (reason)
        (void)snprintf(reason, NT_SPI_REASON, "%s: %s: %s", path, what, error ? strerror(error) : "it was not taken");
    return NT_E_DEVICE;
}

static nt_status set_up(nt_spi *spi, int index, const nt_spi_device *device, char *reason)
{
    const uint32_t wanted[] = {device->mode, 8, (uint32_t)lround(device->clock)};
    const int file = spi->file[index];
    for (int i = 0; i < 3; ++i) {
        uint32_t found = 0;
        int result = put(spi, file, &settings[i], wanted[i]);
        if (result >= 0)
            result = get(spi, file, &settings[i], &found);
        if (result < 0)
            return refuse(reason, device->path, settings[i].name, -result);
        if (i < 2 ? found != wanted[i] : found > wanted[i]) /* a slower clock is no harm */
            return refuse(reason, device->path, settings[i].name, 0);
        if (i == 2)
            spi->clock[index] = found;
    }
    return NT_OK;
}

static nt_status open_device(nt_spi *spi, int index, const nt_spi_device *device, char *reason)
{
    if (!device->path || device->mode > 3)
        return NT_E_ARGUMENT;
    if (!(device->clock >= 1e3 && device->clock <= 1e8))
        return NT_E_RANGE;
    const int file = spi->calls.open(spi->calls.context, device->path);
    if (file < 0)
        return refuse(reason, device->path, "open", -file);
    spi->file[index] = file;
    spi->count = index + 1;
    return set_up(spi, index, device, reason);
}

nt_status nt_spi_open(nt_spi *spi, const nt_spi_device *devices, int count, const nt_spi_calls *calls,
                      char reason[NT_SPI_REASON])
{
    static const nt_spi_calls kernel = {open_file, control_file, close_file, NULL};
    if (!spi || !devices || count < 1 || count > NT_CONVERTERS)
        return NT_E_ARGUMENT;
    if (reason)
        reason[0] = 0;
    *spi = (nt_spi){.calls = calls ? *calls : kernel};
    nt_status status = NT_OK;
    for (int i = 0; i < count && status == NT_OK; ++i)
        status = open_device(spi, i, &devices[i], reason);
    if (status != NT_OK)
        nt_spi_close(spi);
    return status;
}

void nt_spi_close(nt_spi *spi)
{
    for (int i = 0; spi && i < spi->count; ++i)
        spi->calls.close(spi->calls.context, spi->file[i]);
    if (spi)
        spi->count = 0;
}

/* --- exchange --- */

static int is_gone(int error)
{
    return error == ENODEV || error == ENXIO || error == ESHUTDOWN || error == EBADF;
}

/* A message of whole frames: at most NT_SPI_MESSAGE bytes. */
static nt_status send_message(nt_spi *spi, int converter, const nt_transfer *transfers, int count)
{
    struct spi_ioc_transfer list[NT_CONVERTER_FRAMES];
    int total = 0, result = -EINTR;
    memset(list, 0, sizeof list);
    for (int i = 0; i < count; ++i) {
        list[i] = (struct spi_ioc_transfer){.tx_buf = (uintptr_t)transfers[i].out,
                                            .rx_buf = (uintptr_t)transfers[i].in,
                                            .len = transfers[i].count,
                                            .speed_hz = spi->clock[converter],
                                            .bits_per_word = 8,
                                            .cs_change = i + 1 < count};
        total += (int)transfers[i].count;
    }
    const unsigned long request = _IOC(_IOC_WRITE, SPI_IOC_MAGIC, 0, (unsigned)count * sizeof list[0]);
    for (int i = 0; i < NT_SPI_ATTEMPTS && result == -EINTR; ++i) {
        result = spi->calls.control(spi->calls.context, spi->file[converter], request, list);
        ++spi->messages;
        spi->interrupted += result == -EINTR;
    }
    spi->short_ones += result >= 0 && result != total;
    spi->refused += result < 0;
    if (result < 0)
        spi->error = -result;
    if (result == total)
        return NT_OK;
    return result < 0 && is_gone(-result) ? NT_E_DEVICE : NT_E_STATE;
}

nt_status nt_spi_exchange(void *context, int converter, const nt_transfer *transfers, int count)
{
    nt_spi *spi = context;
    if (converter < 0 || converter >= spi->count)
        return NT_E_DEVICE;
    nt_status status = NT_OK;
    for (int first = 0; first < count && status == NT_OK;) {
        uint32_t bytes = transfers[first].count;
        int end = first + 1;
        while (end < count && end - first < NT_CONVERTER_FRAMES && bytes + transfers[end].count <= NT_SPI_MESSAGE)
            bytes += transfers[end++].count;
        if (bytes > NT_SPI_MESSAGE)
            return NT_E_CAPACITY;
        status = send_message(spi, converter, transfers + first, end - first);
        first = end;
    }
    return status;
}

#else

#include <stddef.h>

nt_status nt_spi_open(nt_spi *spi, const nt_spi_device *devices, int count, const nt_spi_calls *calls,
                      char reason[NT_SPI_REASON])
{
    (void)spi, (void)devices, (void)count, (void)calls, (void)reason;
    return NT_E_UNSUPPORTED;
}

void nt_spi_close(nt_spi *spi)
{
    (void)spi;
}

nt_status nt_spi_exchange(void *context, int converter, const nt_transfer *transfers, int count)
{
    (void)context, (void)converter, (void)transfers, (void)count;
    return NT_E_UNSUPPORTED;
}

#endif
