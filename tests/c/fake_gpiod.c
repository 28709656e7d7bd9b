/* SPDX-License-Identifier: BSD-3-Clause */
#include "fake_gpiod.h"

#include <errno.h>
#include <gpiod.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

fake_chip fake_chips[2];
int fake_handles;

struct gpiod_chip {
    fake_chip *chip;
};
struct gpiod_chip_info {
    fake_chip *chip;
    char name[32];
};
struct gpiod_line_info {
    fake_line *line;
};
struct gpiod_line_settings {
    int is_output, pulled_down, value;
    unsigned long debounce;
};
struct gpiod_line_config {
    unsigned offset;
    struct gpiod_line_settings settings;
};
struct gpiod_request_config {
    size_t buffer_size;
};
struct gpiod_line_request {
    fake_line *line;
    unsigned offset;
};
struct gpiod_edge_event {
    int falling;
    unsigned long seqno;
};
struct gpiod_edge_event_buffer {
    struct gpiod_edge_event events[FAKE_EVENTS_MAX];
};

void fake_edge(fake_line *line, int level, int dropped)
{
    line->level = level;
    line->seqno++;
    if (dropped)
        return;
    line->events[line->event_count].falling = !level;
    line->events[line->event_count++].seqno = line->seqno;
}

static void *fake_new(size_t size)
{
    fake_handles++;
    return calloc(1, size);
}

static void fake_free(void *object)
{
    fake_handles -= object != NULL;
    free(object);
}

/* --- chips --- */
static fake_chip *chip_at(const char *path)
{
    for (int i = 0; i < 2; i++) {
        char name[32];
        snprintf(name, sizeof name, "/dev/gpiochip%d", fake_chips[i].number);
        if (fake_chips[i].line_count > 0 && strcmp(name, path) == 0)
            return &fake_chips[i];
    }
    return NULL;
}

bool gpiod_is_gpiochip_device(const char *path)
{
    return chip_at(path) != NULL;
}

struct gpiod_chip *gpiod_chip_open(const char *path)
{
    fake_chip *chip = chip_at(path);
    if (!chip || chip->may_not_open) {
        errno = EACCES;
        return NULL;
    }
    struct gpiod_chip *handle = fake_new(sizeof *handle);
    handle->chip = chip;
    return handle;
}

void gpiod_chip_close(struct gpiod_chip *chip)
{
    fake_free(chip);
}

struct gpiod_chip_info *gpiod_chip_get_info(struct gpiod_chip *chip)
{
    struct gpiod_chip_info *info = fake_new(sizeof *info);
    info->chip = chip->chip;
    snprintf(info->name, sizeof info->name, "gpiochip%d", chip->chip->number);
    return info;
}

void gpiod_chip_info_free(struct gpiod_chip_info *info)
{
    fake_free(info);
}
const char *gpiod_chip_info_get_name(struct gpiod_chip_info *info)
{
    return info->name;
}
size_t gpiod_chip_info_get_num_lines(struct gpiod_chip_info *info)
{
    return (size_t)info->chip->line_count;
}

struct gpiod_line_info *gpiod_chip_get_line_info(struct gpiod_chip *chip, unsigned offset)
{
    struct gpiod_line_info *info = fake_new(sizeof *info);
    info->line = &chip->chip->lines[offset];
    return info;
}

void gpiod_line_info_free(struct gpiod_line_info *info)
{
    fake_free(info);
}
const char *gpiod_line_info_get_name(struct gpiod_line_info *info)
{
    return info->line->name;
}
bool gpiod_line_info_is_used(struct gpiod_line_info *info)
{
    return info->line->consumer || info->line->requested;
}
const char *gpiod_line_info_get_consumer(struct gpiod_line_info *info)
{
    return info->line->consumer;
}

/* --- requests --- */
struct gpiod_line_settings *gpiod_line_settings_new(void)
{
    return fake_new(sizeof(struct gpiod_line_settings));
}
void gpiod_line_settings_free(struct gpiod_line_settings *settings)
{
    fake_free(settings);
}

int gpiod_line_settings_set_direction(struct gpiod_line_settings *settings, enum gpiod_line_direction direction)
{
    settings->is_output = direction == GPIOD_LINE_DIRECTION_OUTPUT;
    return 0;
}

int gpiod_line_settings_set_bias(struct gpiod_line_settings *settings, enum gpiod_line_bias bias)
{
    settings->pulled_down = bias == GPIOD_LINE_BIAS_PULL_DOWN;
    return 0;
}

int gpiod_line_settings_set_edge_detection(struct gpiod_line_settings *settings, enum gpiod_line_edge edge)
{
    (void)settings;
    return edge == GPIOD_LINE_EDGE_BOTH ? 0 : -1;
}

int gpiod_line_settings_set_output_value(struct gpiod_line_settings *settings, enum gpiod_line_value value)
{
    settings->value = value == GPIOD_LINE_VALUE_ACTIVE;
    return 0;
}

void gpiod_line_settings_set_debounce_period_us(struct gpiod_line_settings *settings, unsigned long period)
{
    settings->debounce = period;
}

struct gpiod_line_config *gpiod_line_config_new(void)
{
    return fake_new(sizeof(struct gpiod_line_config));
}
void gpiod_line_config_free(struct gpiod_line_config *config)
{
    fake_free(config);
}

int gpiod_line_config_add_line_settings(struct gpiod_line_config *config, const unsigned *offsets, size_t count,
                                        struct gpiod_line_settings *settings)
{
    config->offset = offsets[0];
    config->settings = *settings;
    return count == 1 ? 0 : -1;
}

struct gpiod_request_config *gpiod_request_config_new(void)
{
    return fake_new(sizeof(struct gpiod_request_config));
}
void gpiod_request_config_free(struct gpiod_request_config *config)
{
    fake_free(config);
}
void gpiod_request_config_set_consumer(struct gpiod_request_config *c, const char *name)
{
    (void)c, (void)name;
}
void gpiod_request_config_set_event_buffer_size(struct gpiod_request_config *c, size_t size)
{
    c->buffer_size = size;
}

struct gpiod_line_request *gpiod_chip_request_lines(struct gpiod_chip *chip, struct gpiod_request_config *config,
                                                    struct gpiod_line_config *lines)
{
    fake_line *line = &chip->chip->lines[lines->offset];
    (void)config;
    if (line->refuse) {
        errno = line->refuse;
        return NULL;
    }
    line->requested = 1;
    line->is_output = lines->settings.is_output;
    line->pulled_down = lines->settings.pulled_down;
    line->debounce = lines->settings.debounce;
    if (line->is_output)
        line->level = lines->settings.value;
    struct gpiod_line_request *request = fake_new(sizeof *request);
    request->line = line;
    request->offset = lines->offset;
    return request;
}

void gpiod_line_request_release(struct gpiod_line_request *request)
{
    request->line->requested = 0;
    fake_free(request);
}

enum gpiod_line_value gpiod_line_request_get_value(struct gpiod_line_request *request, unsigned offset)
{
    if (request->line->gone || offset != request->offset)
        return GPIOD_LINE_VALUE_ERROR;
    return request->line->level ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
}

int gpiod_line_request_set_value(struct gpiod_line_request *request, unsigned offset, enum gpiod_line_value value)
{
    if (request->line->gone || offset != request->offset)
        return -1;
    request->line->edges += request->line->level != (value == GPIOD_LINE_VALUE_ACTIVE);
    request->line->level = value == GPIOD_LINE_VALUE_ACTIVE;
    return 0;
}

/* --- edges --- */
int gpiod_line_request_wait_edge_events(struct gpiod_line_request *request, int64_t timeout_ns)
{
    if (request->line->gone || timeout_ns != 0)
        return -1;
    return request->line->event_count > 0;
}

int gpiod_line_request_read_edge_events(struct gpiod_line_request *request, struct gpiod_edge_event_buffer *buffer,
                                        size_t max_events)
{
    const int count = request->line->event_count;
    if ((size_t)count > max_events)
        return -1;
    for (int i = 0; i < count; i++)
        buffer->events[i] = (struct gpiod_edge_event){request->line->events[i].falling, request->line->events[i].seqno};
    request->line->event_count = 0;
    return count;
}

struct gpiod_edge_event_buffer *gpiod_edge_event_buffer_new(size_t capacity)
{
    (void)capacity;
    return fake_new(sizeof(struct gpiod_edge_event_buffer));
}

void gpiod_edge_event_buffer_free(struct gpiod_edge_event_buffer *buffer)
{
    fake_free(buffer);
}

struct gpiod_edge_event *gpiod_edge_event_buffer_get_event(struct gpiod_edge_event_buffer *buffer, unsigned long index)
{
    return &buffer->events[index];
}

unsigned long gpiod_edge_event_get_line_seqno(struct gpiod_edge_event *event)
{
    return event->seqno;
}

enum gpiod_edge_event_type gpiod_edge_event_get_event_type(struct gpiod_edge_event *event)
{
    return event->falling ? GPIOD_EDGE_EVENT_FALLING_EDGE : GPIOD_EDGE_EVENT_RISING_EDGE;
}
