/* SPDX-License-Identifier: BSD-3-Clause
 * The devices of the test kernel, as a test handles them: a thread that plays the chips of /dev/nanotouch-bus, lines of
 * gpio-sim that are pulled and read, a chip of them that comes and goes, and spidev that lets a device go. */
#ifndef TESTS_KERNEL_BUS_H
#define TESTS_KERNEL_BUS_H

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "nanotouch_bus.h"
#include "simulated_bus.h"

typedef struct kernel_bus kernel_bus;
struct kernel_bus {
    simulated_bus bus;
    int device;
    uint32_t clock;  /* of the last frame [Hz] */
    int is_mute;     /* nothing is answered */
    long wrong_mode; /* frames in a mode that the chip does not know */
    void (*plays)(kernel_bus *k, int chip, const uint8_t *out, struct nanotouch_frame *frame); /* NULL: the chips */
    pthread_t serving;
};

static inline int bus_error(simulated_bus *bus)
{
    if (bus->fault == BUS_GONE)
        return -ESHUTDOWN;
    if (bus->fault == BUS_REFUSED)
        return -EIO;
    if (bus->errors == 0)
        return 0;
    bus->errors -= bus->errors > 0;
    return -bus->error;
}

static inline void *bus_serve(void *context)
{
    kernel_bus *k = context;
    struct nanotouch_frame frame;
    uint8_t out[NANOTOUCH_FRAME];
    while (read(k->device, &frame, sizeof frame) == (ssize_t)sizeof frame) {
        k->clock = frame.clock;
        k->wrong_mode += frame.mode != (frame.chip ? 2u : 1u);
        memcpy(out, frame.bytes, frame.length);
        frame.error = bus_error(&k->bus);
        frame.length = simulated_through(&k->bus, (int)frame.chip, frame.length);
        if (k->plays)
            k->plays(k, (int)frame.chip, out, &frame);
        else if (frame.error == 0)
            simulated_frame(&k->bus, (int)frame.chip, out, frame.bytes, frame.length);
        if (!k->is_mute)
            (void)!write(k->device, &frame, sizeof frame);
    }
    return NULL;
}

static inline int kernel_bus_start(kernel_bus *k)
{
    k->bus = simulated_bus_after_power_up();
    k->device = open("/dev/nanotouch-bus", O_RDWR);
    return k->device >= 0 && pthread_create(&k->serving, NULL, bus_serve, k) == 0;
}

static inline int write_text(const char *path, const char *text)
{
    const int file = open(path, O_WRONLY);
    const int is_written = file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text);
    if (file >= 0)
        (void)close(file);
    return is_written;
}

static inline int read_text(const char *path, char *text, int size)
{
    const int file = open(path, O_RDONLY);
    const ssize_t count = file < 0 ? -1 : read(file, text, (size_t)size - 1);
    if (file >= 0)
        (void)close(file);
    text[count > 0 ? count : 0] = 0;
    text[strcspn(text, "\n")] = 0;
    return count > 0;
}

static inline void bind_spidev(const char *name, int on)
{
    (void)write_text(on ? "/sys/bus/spi/drivers/spidev/bind" : "/sys/bus/spi/drivers/spidev/unbind", name);
}

/* --- lines of gpio-sim --- */

#define GPIO_SIM "/sys/kernel/config/gpio-sim/rig"
static const char *const line_names[] = {"estop", "limit", "laser-en", "watchdog", "convert"};
enum { LINES = sizeof line_names / sizeof *line_names };

static inline int has_gpio_chip(void)
{
    char text[8];
    return read_text(GPIO_SIM "/live", text, sizeof text) && text[0] == '1';
}

/* Made once, by name; then plugged in or pulled out. */
static inline int gpio_chip(int on)
{
    char path[128];
    if (mkdir(GPIO_SIM, 0755) == 0) {
        (void)mkdir(GPIO_SIM "/lines", 0755);
        (void)write_text(GPIO_SIM "/lines/num_lines", "5");
        for (int i = 0; i < LINES; ++i) {
            (void)snprintf(path, sizeof path, GPIO_SIM "/lines/line%d", i);
            (void)mkdir(path, 0755);
            (void)snprintf(path, sizeof path, GPIO_SIM "/lines/line%d/name", i);
            (void)write_text(path, line_names[i]);
        }
    }
    return write_text(GPIO_SIM "/live", on ? "1" : "0");
}

static inline void line_path(const char *name, const char *file, char path[192])
{
    char device[48], chip[48];
    int line = 0;
    while (line < LINES - 1 && strcmp(line_names[line], name) != 0)
        ++line;
    (void)read_text(GPIO_SIM "/dev_name", device, sizeof device);
    (void)read_text(GPIO_SIM "/lines/chip_name", chip, sizeof chip);
    (void)snprintf(path, 192, "/sys/devices/platform/%s/%s/sim_gpio%d/%s", device, chip, line, file);
}

static inline void pull_line(const char *name, int up)
{
    char path[192];
    line_path(name, "pull", path);
    (void)write_text(path, up ? "pull-up" : "pull-down");
}

static inline int line_level(const char *name)
{
    char path[192], text[8];
    line_path(name, "value", path);
    return read_text(path, text, sizeof text) ? text[0] - '0' : -1;
}

/* --- IIO's own dummy: an input of 13 bits that reads 73, and scans of 7 at a trigger of 100 Hz; offset 7, 1.333 uV ---
 */

static inline int iio_dummy(void)
{
    const int device = mkdir("/sys/kernel/config/iio/devices/dummy/dummy", 0755);
    return device == 0 && mkdir("/sys/kernel/config/iio/triggers/hrtimer/clock", 0755) == 0;
}

#endif
