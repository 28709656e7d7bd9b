/* SPDX-License-Identifier: BSD-3-Clause
 * A machine with GPIO chips, behind the functions of libgpiod that the library calls: what a kernel would do with
 * chips, lines, edges with sequence numbers and a chip that is pulled out. */
#ifndef FAKE_GPIOD_H
#define FAKE_GPIOD_H

enum { FAKE_LINES_MAX = 4, FAKE_EVENTS_MAX = 8 };

typedef struct fake_line {
    const char *name, *consumer; /* consumer NULL: free */
    int level;                   /* 1: high */
    int is_output, pulled_down;  /* as it was requested */
    unsigned long debounce;      /* as it was requested [us] */
    long edges;                  /* of an output so far */
    int refuse;                  /* errno that a request for it ends with, or 0 */
    int requested;               /* held by a request now */
    int gone;                    /* every access fails */
    unsigned long seqno;         /* of the last edge */
    struct {
        int falling;
        unsigned long seqno;
    } events[FAKE_EVENTS_MAX];
    int event_count;
} fake_line;

typedef struct fake_chip {
    int number; /* /dev/gpiochip<number>; -1: absent */
    int may_not_open;
    int line_count;
    fake_line lines[FAKE_LINES_MAX];
} fake_chip;

extern fake_chip fake_chips[2];
extern int fake_handles; /* objects that are allocated or open: 0 when nothing leaks */

/* The line changes its level and reports it; dropped: the report is lost on the way, as by a full buffer. */
void fake_edge(fake_line *line, int level, int dropped);

#endif
