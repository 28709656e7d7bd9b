/* SPDX-License-Identifier: BSD-3-Clause
 * The safety lines on libgpiod 2 (kernel uAPI v2: edges carry sequence numbers, so that lost ones are noticed; version
 * 1 loses them silently). Each line is a request of its own: lines may sit on different chips, and one may be lost
 * alone. */
#include <errno.h>
#include <gpiod.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/linux/hal_linux.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/types.h"

enum { EVENTS_MAX = 64 }; /* the kernel's own limit for a request is 16 a line unless asked for more */

/* An input and what is known of it. */
typedef struct input {
    struct gpiod_line_request *request; /* NULL: not wired */
    unsigned offset;
    unsigned long seqno; /* of the last edge seen; the kernel counts from 1 */
    uint64_t lost_events;
    int gone; /* could not be read once: pressed for good */
} input;

typedef struct output {
    struct gpiod_line_request *request; /* NULL: not wired */
    unsigned offset;
    int level;
} output;

struct nt_gpio {
    input emergency_stop, limit_switch;
    output laser, watchdog, convert;
    uint64_t lost_outputs;
    struct gpiod_edge_event_buffer *events;
};

/* Where nt_gpio_open says why it failed. */
typedef struct reason {
    char *text;
    unsigned size;
} reason;

static nt_status fail(const reason *why, nt_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (why->text && why->size > 0)
        vsnprintf(why->text, why->size, format, arguments);
    va_end(arguments);
    return status;
}

/* --- requests --- */

/* How a line is requested. */
typedef struct manner {
    int is_output;
    unsigned long debounce; /* [us] */
} manner;

static int configure(struct gpiod_line_settings *settings, const manner *how)
{
    if (how->is_output)
        return gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_OUTPUT) ||
               gpiod_line_settings_set_output_value(settings, GPIOD_LINE_VALUE_INACTIVE);
    return gpiod_line_settings_set_direction(settings, GPIOD_LINE_DIRECTION_INPUT) ||
           gpiod_line_settings_set_bias(settings, GPIOD_LINE_BIAS_PULL_DOWN) ||
           gpiod_line_settings_set_edge_detection(settings, GPIOD_LINE_EDGE_BOTH) ||
           (gpiod_line_settings_set_debounce_period_us(settings, how->debounce), 0);
}

static struct gpiod_line_request *request_offset(struct gpiod_chip *chip, unsigned offset, const manner *how)
{
    struct gpiod_line_settings *settings = gpiod_line_settings_new();
    struct gpiod_line_config *lines = gpiod_line_config_new();
    struct gpiod_request_config *config = gpiod_request_config_new();
    struct gpiod_line_request *request = NULL;
    if (settings && lines && config && !configure(settings, how) &&
        !gpiod_line_config_add_line_settings(lines, &offset, 1, settings)) {
        gpiod_request_config_set_consumer(config, "nanotouch");
        gpiod_request_config_set_event_buffer_size(config, EVENTS_MAX);
        request = gpiod_chip_request_lines(chip, config, lines);
    }
    const int error = errno; /* the frees below may change it */
    gpiod_request_config_free(config);
    gpiod_line_config_free(lines);
    gpiod_line_settings_free(settings);
    errno = error;
    return request;
}

static nt_status find_line(const char *name, const reason *why, nt_gpio_line *line)
{
    const nt_status status = nt_gpio_line_find(name, line);
    if (status == NT_E_ARGUMENT && *name)
        return fail(why, status, "several GPIO lines are named \"%s\"", name);
    if (status == NT_E_ARGUMENT)
        return fail(why, status, "the name of a GPIO line is empty");
    if (status != NT_OK && nt_gpio_line_count() == 0)
        return fail(why, status, "no GPIO line named \"%s\": this machine has no GPIO chip that may be opened", name);
    if (status != NT_OK)
        return fail(why, status, "no GPIO line is named \"%s\"", name);
    if (line->consumer[0])
        return fail(why, NT_E_DEVICE, "GPIO line \"%s\" is in use by \"%s\"", name, line->consumer);
    return NT_OK;
}

/* Requests the line of that name; NULL is "not wired" and leaves *request NULL. */
static nt_status take_line(const char *name, const manner *how, const reason *why, struct gpiod_line_request **request,
                           unsigned *offset)
{
    char path[NT_GPIO_NAME_SIZE + 8];
    nt_gpio_line line;
    if (!name)
        return NT_OK;
    const nt_status status = find_line(name, why, &line);
    if (status != NT_OK)
        return status;
    snprintf(path, sizeof path, "/dev/%s", line.chip);
    struct gpiod_chip *chip = gpiod_chip_open(path);
    if (chip)
        *request = request_offset(chip, line.offset, how);
    const int error = errno;
    if (chip)
        gpiod_chip_close(chip);
    *offset = line.offset;
    if (!*request)
        return fail(why, NT_E_DEVICE, "GPIO line \"%s\" on %s was refused: %s", name, line.chip, strerror(error));
    return NT_OK;
}

static nt_status take_lines(nt_gpio *gpio, const nt_gpio_wiring *wiring, const reason *why)
{
    input *stop = &gpio->emergency_stop, *limit = &gpio->limit_switch;
    const manner at_once = {0, 0}, debounced = {0, (unsigned long)(1e6 * wiring->debounce + 0.5)}, driven = {1, 0};
    const struct {
        const char *name;
        output *line;
    } outputs[] = {
        {wiring->laser_enable, &gpio->laser}, {wiring->watchdog, &gpio->watchdog}, {wiring->convert, &gpio->convert}};
    nt_status status = take_line(wiring->emergency_stop, &at_once, why, &stop->request, &stop->offset);
    if (status == NT_OK)
        status = take_line(wiring->limit_switch, &debounced, why, &limit->request, &limit->offset);
    for (int i = 0; i < 3 && status == NT_OK; i++)
        status = take_line(outputs[i].name, &driven, why, &outputs[i].line->request, &outputs[i].line->offset);
    return status;
}

/* --- inputs --- */

/* Takes the edges that wait. Returns 1 if the input was pressed meanwhile (an edge down, or lost ones), -1 if it is
 * gone. */
static int take_edges(input *in, struct gpiod_edge_event_buffer *events)
{
    int pressed = 0;
    const int waiting = gpiod_line_request_wait_edge_events(in->request, 0);
    if (waiting <= 0)
        return waiting;
    const int count = gpiod_line_request_read_edge_events(in->request, events, EVENTS_MAX);
    for (int i = 0; i < count; i++) {
        struct gpiod_edge_event *event = gpiod_edge_event_buffer_get_event(events, (unsigned long)i);
        const unsigned long seqno = gpiod_edge_event_get_line_seqno(event);
        in->lost_events += seqno - in->seqno - 1;
        pressed |= seqno != in->seqno + 1 || gpiod_edge_event_get_event_type(event) == GPIOD_EDGE_EVENT_FALLING_EDGE;
        in->seqno = seqno;
    }
    return count < 0 ? -1 : pressed;
}

/* Returns 1 if the input is or was pressed, or is gone; 0 if it is well or not wired. */
static int read_input(input *in, struct gpiod_edge_event_buffer *events)
{
    if (!in->request || in->gone)
        return in->gone;
    const int edges = take_edges(in, events);
    const enum gpiod_line_value level = gpiod_line_request_get_value(in->request, in->offset);
    in->gone = edges < 0 || level == GPIOD_LINE_VALUE_ERROR;
    return edges != 0 || level != GPIOD_LINE_VALUE_ACTIVE;
}

/* --- outputs --- */

static nt_status set_output(nt_gpio *gpio, output *out, int level)
{
    if (!out->request)
        return NT_E_STATE;
    out->level = level;
    const enum gpiod_line_value value = level ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
    if (gpiod_line_request_set_value(out->request, out->offset, value) == 0)
        return NT_OK;
    ++gpio->lost_outputs;
    return NT_E_DEVICE;
}

/* Low, and given back: what a pin does after that is for a resistor to say. */
static void leave_output(nt_gpio *gpio, output *out)
{
    if (!out->request)
        return;
    (void)set_output(gpio, out, 0);
    gpiod_line_request_release(out->request);
}

/* --- public --- */

nt_gpio_wiring nt_gpio_wiring_defaults(void)
{
    return (nt_gpio_wiring){.emergency_stop = "estop", .limit_switch = "limit", .laser_enable = "laser-en"};
}

nt_status nt_gpio_open(const nt_gpio_wiring *wiring, char *text, unsigned size, nt_gpio **result)
{
    const reason why = {text, size};
    if (!wiring || !result || !wiring->emergency_stop)
        return fail(&why, NT_E_ARGUMENT, "the wiring must name an emergency stop");
    if (!(wiring->debounce >= 0.0 && wiring->debounce <= 0.1))
        return fail(&why, NT_E_RANGE, "the limit switch's debounce is %g s: valid is 0 .. 0.1 s", wiring->debounce);
    nt_gpio *gpio = calloc(1, sizeof *gpio);
    if (!gpio)
        return fail(&why, NT_E_NO_MEMORY, "out of memory");
    gpio->events = gpiod_edge_event_buffer_new(EVENTS_MAX);
    const nt_status status =
        gpio->events ? take_lines(gpio, wiring, &why) : fail(&why, NT_E_NO_MEMORY, "out of memory");
    if (status != NT_OK) {
        nt_gpio_close(gpio);
        return status;
    }
    *result = gpio;
    return NT_OK;
}

void nt_gpio_close(nt_gpio *gpio)
{
    if (!gpio)
        return;
    leave_output(gpio, &gpio->laser);
    leave_output(gpio, &gpio->convert);
    leave_output(gpio, &gpio->watchdog);
    if (gpio->limit_switch.request)
        gpiod_line_request_release(gpio->limit_switch.request);
    if (gpio->emergency_stop.request)
        gpiod_line_request_release(gpio->emergency_stop.request);
    gpiod_edge_event_buffer_free(gpio->events);
    free(gpio);
}

nt_status nt_gpio_read(nt_gpio *gpio, nt_gpio_state *state)
{
    if (!gpio || !state)
        return NT_E_ARGUMENT;
    input *stop = &gpio->emergency_stop, *limit = &gpio->limit_switch;
    const int stopped = read_input(stop, gpio->events);
    const int limited = read_input(limit, gpio->events);
    state->flags =
        (stopped ? (uint32_t)NT_SAMPLE_EMERGENCY_STOP : 0u) | (limited ? (uint32_t)NT_SAMPLE_LIMIT_SWITCH : 0u);
    state->lost_events = stop->lost_events + limit->lost_events;
    state->lost_outputs = gpio->lost_outputs;
    return stop->gone || limit->gone ? NT_E_DEVICE : NT_OK;
}

nt_status nt_gpio_laser(nt_gpio *gpio, int on)
{
    return gpio ? set_output(gpio, &gpio->laser, on != 0) : NT_E_ARGUMENT;
}

nt_status nt_gpio_beat(nt_gpio *gpio)
{
    return gpio ? set_output(gpio, &gpio->watchdog, !gpio->watchdog.level) : NT_E_ARGUMENT;
}

nt_status nt_gpio_convert(nt_gpio *gpio)
{
    if (!gpio)
        return NT_E_ARGUMENT;
    const nt_status status = set_output(gpio, &gpio->convert, 1);
    const nt_status second = set_output(gpio, &gpio->convert, 0);
    return status == NT_OK ? second : status;
}
