/* SPDX-License-Identifier: BSD-3-Clause
 * Private to host/: a page of the lesson. */
#ifndef NANOTOUCH_HOST_LESSON_H
#define NANOTOUCH_HOST_LESSON_H

#include "host/task.h"

typedef struct nt_page {
    const char *action;                                      /* what to do once it is unlocked */
    const char *explain;                                     /* with the figures of `right` */
    int (*right)(nt_session_host *host, nt_figure *figures); /* which choice the simulation bears out */
    const char *change; /* a field that is changed at its beginning, to `to`; NULL: none */
    double to;          /* [unit of the field] */
    const char *then;   /* a field that is changed between two touches; NULL: one touch */
    double factor;      /* by this [-] */
    int measures;       /* 1: it says what was measured */
} nt_page;

#endif
