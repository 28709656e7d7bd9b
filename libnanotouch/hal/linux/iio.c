/* SPDX-License-Identifier: BSD-3-Clause
 * Frames of hal/chips/iio.c as numbers of IIO: a channel's attribute `raw`, with (raw + offset) scale in millivolts. */
#include "nanotouch/advanced/hal_iio.h"

#ifdef NT_HAS_IIO

#include <errno.h>
#include <iio.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define TIMEOUT_MS 1000 /* of a network; sysfs does not wait */
#define LIKE 2.0        /* the ends of the span may differ from the driver's by so many codes */

/* --- open --- */

static nt_status refuse(char *reason, const char *format, ...)
{
    va_list rest;
    va_start(rest, format);
    if (reason)
        (void)vsnprintf(reason, NT_IIO_REASON, format, rest);
    va_end(rest);
    return NT_E_DEVICE;
}

/* The raw number of the lowest code, from the driver's scale and offset. */
static nt_status find_lowest(struct iio_channel *channel, const nt_iio_device *device, long long *lowest, char *reason)
{
    double scale = 0.0, offset = 0.0;
    const char *id = iio_channel_get_id(channel);
    const int error = iio_channel_attr_read_double(channel, "scale", &scale);
    if (error < 0 || !(fabs(scale) > 0.0) || !isfinite(scale))
        return refuse(reason, "%s: %s has no scale", device->device, id);
    if (iio_channel_attr_read_double(channel, "offset", &offset) < 0)
        offset = 0.0;
    const nt_chip *chip = &device->chip;
    const double step = 1e-3 * scale, given = (device->span.high - device->span.low) / chip->steps;
    if (!(fabs(step - given) * chip->steps <= LIKE * fabs(step)))
        return refuse(reason, "%s: %s has steps of %g V, low and high say %g V", device->device, id, step, given);
    const double first = device->span.low / step - offset, half = ldexp(1.0, chip->bits - 1);
    const double nearest = fabs(first) <= LIKE ? 0.0 : -half;
    if (!(fabs(first - nearest) <= LIKE))
        return refuse(reason, "%s: %s begins at %g V or at %g V, low says %g V", device->device, id, step * offset,
                      step * (offset - half), device->span.low);
    *lowest = (long long)nearest;
    return NT_OK;
}

static nt_status find_channels(nt_iio *iio, int at, const nt_iio_device *device, char *reason)
{
    const struct iio_device *found = iio_context_find_device(iio->context, device->device);
    if (!found)
        return refuse(reason, "there is no device %s", device->device);
    nt_status status = NT_OK;
    for (int i = 0; i < device->chip.channels && status == NT_OK; ++i) {
        struct iio_channel *channel = iio_device_find_channel(found, device->channels[i], device->chip.is_dac != 0);
        if (!channel)
            return refuse(reason, "%s has no %s %s", device->device, device->chip.is_dac ? "output" : "input",
                          device->channels[i]);
        long long lowest = 0;
        status = find_lowest(channel, device, &lowest, reason);
        if (status == NT_OK && i > 0 && lowest != iio->converter[at].lowest)
            return refuse(reason, "%s: %s counts from another number than %s", device->device, device->channels[i],
                          device->channels[0]);
        iio->converter[at].lowest = lowest;
        iio->converter[at].channels[i] = channel;
    }
    return status;
}

nt_status nt_iio_open(nt_iio *iio, const char *uri, const nt_iio_device *devices, int count, char reason[NT_IIO_REASON])
{
    if (!iio || !uri || !devices || count < 1 || count > NT_CONVERTERS)
        return NT_E_ARGUMENT;
    for (int i = 0; i < count; ++i)
        if (!devices[i].chip.name || !devices[i].device)
            return NT_E_ARGUMENT;
    *iio = (nt_iio){.count = count};
    char own[NT_IIO_REASON]; /* libiio cuts the port off what it is given */
    (void)snprintf(own, sizeof own, "%s", uri);
    iio->context = iio_create_context_from_uri(own);
    if (!iio->context) {
        iio->error = errno;
        return refuse(reason, "%s: %s", uri, strerror(errno));
    }
    (void)iio_context_set_timeout(iio->context, TIMEOUT_MS);
    nt_status status = NT_OK;
    for (int i = 0; i < count && status == NT_OK; ++i) {
        iio->converter[i].chip = devices[i].chip;
        iio->converter[i].span = devices[i].span;
        status = find_channels(iio, i, &devices[i], reason);
    }
    if (status != NT_OK)
        nt_iio_close(iio);
    return status;
}

void nt_iio_close(nt_iio *iio)
{
    if (!iio || !iio->context)
        return;
    iio_context_destroy(iio->context);
    iio->context = NULL;
}

/* --- exchange --- */

static nt_status judge(nt_iio *iio, int error)
{
    if (error >= 0)
        return NT_OK;
    ++iio->refused;
    iio->error = -error;
    static const int gone[] = {ENODEV, ENXIO, ESHUTDOWN, EBADF, ENOENT, EPIPE, ECONNRESET, ENOTCONN, ECONNREFUSED};
    for (size_t i = 0; i < sizeof gone / sizeof *gone; ++i)
        if (iio->error == gone[i])
            return NT_E_DEVICE;
    return NT_E_STATE;
}

/* The code of a channel, from 0 on. */
static nt_status read_code(nt_iio *iio, int converter, int channel, uint32_t *code)
{
    long long raw = 0;
    const nt_status status =
        judge(iio, iio_channel_attr_read_longlong(iio->converter[converter].channels[channel], "raw", &raw));
    if (status != NT_OK)
        return status;
    ++iio->read;
    raw -= iio->converter[converter].lowest;
    if (raw < 0 || raw >= 1LL << iio->converter[converter].chip.bits)
        return NT_E_STATE;
    *code = (uint32_t)raw;
    return NT_OK;
}

static void put(uint8_t bytes[3], uint32_t word)
{
    bytes[0] = (uint8_t)(word >> 16), bytes[1] = (uint8_t)(word >> 8), bytes[2] = (uint8_t)word;
}

static nt_status drive(nt_iio *iio, int converter, const nt_transfer *transfer)
{
    const nt_chip *chip = &iio->converter[converter].chip;
    const uint8_t *out = transfer->out;
    const uint32_t word = (uint32_t)out[0] << 16 | (uint32_t)out[1] << 8 | out[2], shift = 20u - (uint32_t)chip->bits;
    const int channel = (int)(word >> 20 & 3u);
    uint32_t code = (word & 0xFFFFFu) >> shift;
    nt_status status = NT_OK;
    memcpy(transfer->in, iio->converter[converter].reply, 3);
    put(iio->converter[converter].reply, 0);
    if (channel >= chip->channels)
        return NT_E_STATE;
    if (word >> 23)
        status = read_code(iio, converter, channel, &code);
    if (word >> 23 && status == NT_OK)
        put(iio->converter[converter].reply, code << shift);
    if (word >> 22 == 1u) {
        const long long raw = (long long)code + iio->converter[converter].lowest;
        status = judge(iio, iio_channel_attr_write_longlong(iio->converter[converter].channels[channel], "raw", raw));
        iio->written += status == NT_OK;
    }
    return status;
}

static nt_status measure(nt_iio *iio, int converter, const nt_transfer *transfer)
{
    const nt_chip *chip = &iio->converter[converter].chip;
    nt_status status = NT_OK;
    for (int i = 0; i < chip->channels && status == NT_OK; ++i) {
        uint32_t code = 0;
        status = read_code(iio, converter, i, &code);
        put(&transfer->in[3 * i], code ^ 1u << (chip->bits - 1)); /* two's complement of `bits` bits */
    }
    transfer->in[transfer->count - 1] = 1;
    return status;
}

nt_status nt_iio_exchange(void *iio, int converter, const nt_transfer *transfers, int count)
{
    nt_iio *on = iio;
    if (!on || !on->context || converter < 0 || converter >= on->count)
        return NT_E_DEVICE;
    const nt_chip *chip = &on->converter[converter].chip;
    nt_status status = NT_OK;
    for (int i = 0; i < count && status == NT_OK; ++i) {
        if (transfers[i].count != (chip->is_dac ? 3u : chip->answer.count))
            return NT_E_STATE;
        status = chip->is_dac ? drive(on, converter, &transfers[i]) : measure(on, converter, &transfers[i]);
    }
    return status;
}

/* --- scans --- */

/* Sets the trigger of that name, if there is one; `trigger` is the one that the device has then, or NULL. */
static nt_status set_trigger(nt_iio *iio, const struct iio_device *device, const char *name,
                             const struct iio_device **trigger)
{
    if (!name) {
        if (iio_device_get_trigger(device, trigger) < 0)
            *trigger = NULL;
        return NT_OK;
    }
    *trigger = iio_context_find_device(iio->context, name);
    if (!*trigger)
        iio->error = ENODEV;
    return *trigger ? judge(iio, iio_device_set_trigger(device, *trigger)) : NT_E_DEVICE;
}

/* libiio's timeout is that of all scans together, and it tells a server half of it: twice their time is waited, where
 * somebody says how fast they come. */
static void wait_for(const nt_iio *iio, const struct iio_device *device, const struct iio_device *trigger, long count)
{
    double frequency = 0.0, longest = TIMEOUT_MS;
    if (trigger && iio_device_attr_read_double(trigger, "sampling_frequency", &frequency) < 0)
        frequency = 0.0;
    if (!(frequency > 0.0) && iio_device_attr_read_double(device, "sampling_frequency", &frequency) < 0)
        frequency = 0.0;
    if (frequency > 0.0)
        longest += fmin(2e3 * (double)count / frequency, (double)INT_MAX - TIMEOUT_MS);
    (void)iio_context_set_timeout(iio->context, (unsigned)longest);
}

/* All scans, or an error: fewer of them are none. */
static int refill(struct iio_buffer *buffer, long count)
{
    const ssize_t bytes = iio_buffer_refill(buffer);
    if (bytes < 0)
        return (int)bytes;
    return bytes == (ssize_t)count * iio_buffer_step(buffer) ? 0 : -EIO;
}

/* One channel of all scans that the buffer holds. */
static void take(const nt_iio *iio, int converter, int channel, struct iio_buffer *buffer, double *volts)
{
    const nt_chip *chip = &iio->converter[converter].chip;
    const nt_chip_span *span = &iio->converter[converter].span;
    const struct iio_channel *from = iio->converter[converter].channels[channel];
    const struct iio_data_format *format = iio_channel_get_data_format(from);
    const int spare = 64 - (int)format->length;
    const ptrdiff_t step = iio_buffer_step(buffer);
    const uint8_t *end = iio_buffer_end(buffer);
    for (const uint8_t *at = iio_buffer_first(buffer, from); at < end; at += step, volts += chip->channels) {
        uint64_t bits = 0; /* as many bytes as the number has */
        iio_channel_convert(from, &bits, at);
        const int64_t raw = format->is_signed ? (int64_t)(bits << spare) >> spare : (int64_t)bits;
        *volts = span->low + (double)(raw - iio->converter[converter].lowest) * (span->high - span->low) / chip->steps;
    }
}

nt_status nt_iio_scan(nt_iio *iio, int converter, const char *trigger, double *volts, long count)
{
    if (!iio || !iio->context || converter < 0 || converter >= iio->count || !volts || count < 1)
        return NT_E_ARGUMENT;
    const nt_chip *chip = &iio->converter[converter].chip;
    const struct iio_device *device = iio_channel_get_device(iio->converter[converter].channels[0]);
    if (chip->is_dac || !iio_channel_is_scan_element(iio->converter[converter].channels[0]))
        return NT_E_ARGUMENT;
    const struct iio_device *at = NULL;
    nt_status status = set_trigger(iio, device, trigger, &at);
    for (int i = 0; i < chip->channels; ++i)
        iio_channel_enable(iio->converter[converter].channels[i]);
    struct iio_buffer *buffer = NULL;
    if (status == NT_OK) {
        wait_for(iio, device, at, count);
        buffer = iio_device_create_buffer(device, (size_t)count, false);
        status = judge(iio, buffer ? refill(buffer, count) : -errno);
        (void)iio_context_set_timeout(iio->context, TIMEOUT_MS);
    }
    for (int i = 0; i < chip->channels && status == NT_OK; ++i)
        take(iio, converter, i, buffer, volts + i);
    if (buffer)
        iio_buffer_destroy(buffer);
    return status;
}

#else

nt_status nt_iio_open(nt_iio *iio, const char *uri, const nt_iio_device *devices, int count, char reason[NT_IIO_REASON])
{
    (void)uri, (void)devices, (void)count;
    if (iio)
        *iio = (nt_iio){.count = 0};
    if (reason)
        reason[0] = 0;
    return NT_E_UNSUPPORTED;
}

nt_status nt_iio_exchange(void *iio, int converter, const nt_transfer *transfers, int count)
{
    (void)iio, (void)converter, (void)transfers, (void)count;
    return NT_E_UNSUPPORTED;
}

nt_status nt_iio_scan(nt_iio *iio, int converter, const char *trigger, double *volts, long count)
{
    (void)iio, (void)converter, (void)trigger, (void)volts, (void)count;
    return NT_E_UNSUPPORTED;
}

void nt_iio_close(nt_iio *iio)
{
    (void)iio;
}

#endif
