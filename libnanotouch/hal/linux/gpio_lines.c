/* SPDX-License-Identifier: BSD-3-Clause
 * Which GPIO lines this machine has. Chips are /dev/gpiochip0, 1, ...; numbers may have gaps, a chip may vanish while
 * we look, and a chip that we may not open counts as absent: the list is for people and for finding lines by name. */
#include "hal/linux/hal_linux.h"
#include "nanotouch/advanced/hal_linux.h"

#include <gpiod.h>
#include <stdio.h>
#include <string.h>

/* The kernel hands out chip numbers from 0; far more than any machine has. */
enum { CHIPS_MAX = 256 };

/* Called for each line; a non-zero result ends the walk. */
typedef int line_visitor(void *context, const nt_gpio_line *line);

static void copy_text(char *to, const char *from)
{
    snprintf(to, NT_GPIO_NAME_SIZE, "%s", from ? from : "");
}

static int visit_chip(struct gpiod_chip *chip, line_visitor *visit, void *context)
{
    struct gpiod_chip_info *chip_info = gpiod_chip_get_info(chip);
    int stop = 0;
    if (!chip_info)
        return 0;
    const size_t count = gpiod_chip_info_get_num_lines(chip_info);
    for (unsigned offset = 0; offset < count && !stop; offset++) {
        struct gpiod_line_info *info = gpiod_chip_get_line_info(chip, offset);
        nt_gpio_line line = {.offset = offset};
        if (!info)
            break;
        copy_text(line.name, gpiod_line_info_get_name(info));
        copy_text(line.chip, gpiod_chip_info_get_name(chip_info));
        if (gpiod_line_info_is_used(info)) {
            const char *consumer = gpiod_line_info_get_consumer(info);
            copy_text(line.consumer, consumer ? consumer : "kernel");
        }
        gpiod_line_info_free(info);
        stop = visit(context, &line);
    }
    gpiod_chip_info_free(chip_info);
    return stop;
}

static void visit_lines(line_visitor *visit, void *context)
{
    int stop = 0;
    for (int number = 0; number < CHIPS_MAX && !stop; number++) {
        char path[32];
        snprintf(path, sizeof path, "/dev/gpiochip%d", number);
        if (!gpiod_is_gpiochip_device(path))
            continue;
        struct gpiod_chip *chip = gpiod_chip_open(path);
        if (!chip)
            continue;
        stop = visit_chip(chip, visit, context);
        gpiod_chip_close(chip);
    }
}

typedef struct search {
    const char *name;  /* wanted name, or NULL: any line */
    long index;        /* wanted position among the matches, or -1: all are counted */
    long count;        /* matches so far */
    nt_gpio_line line; /* the match at `index`, or the first one */
} search;

static int search_visit(void *context, const nt_gpio_line *line)
{
    search *s = context;
    if (s->name && strcmp(s->name, line->name) != 0)
        return 0;
    if (s->index < 0 ? s->count == 0 : s->count == s->index)
        s->line = *line;
    return s->count++ == s->index;
}

long nt_gpio_line_count(void)
{
    search s = {.index = -1};
    visit_lines(search_visit, &s);
    return s.count;
}

nt_status nt_gpio_line_at(long index, nt_gpio_line *line)
{
    search s = {.index = index};
    if (!line)
        return NT_E_ARGUMENT;
    if (index < 0)
        return NT_E_RANGE;
    visit_lines(search_visit, &s);
    if (s.count <= index)
        return NT_E_RANGE;
    *line = s.line;
    return NT_OK;
}

nt_status nt_gpio_line_find(const char *name, nt_gpio_line *line)
{
    search s = {.name = name, .index = -1};
    if (!name || !*name || !line)
        return NT_E_ARGUMENT;
    visit_lines(search_visit, &s);
    if (s.count == 0)
        return NT_E_DEVICE;
    if (s.count > 1)
        return NT_E_ARGUMENT;
    *line = s.line;
    return NT_OK;
}
