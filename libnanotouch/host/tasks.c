/* SPDX-License-Identifier: BSD-3-Clause
 * The tasks and the pages of the lesson, in the order in which they are shown. */
#include <string.h>

#include "host/state.h"

static const nt_task *const tasks[] = {
    &nt_task_find,     &nt_task_pull_off, &nt_task_trace,    &nt_task_steady,   &nt_task_stiffer,  &nt_task_slower,
    &nt_task_dent,     &nt_task_scratch,  &nt_task_push,     &nt_task_pattern,  &nt_task_wire,     &nt_task_lesson,
    &nt_task_pages[0], &nt_task_pages[1], &nt_task_pages[2], &nt_task_pages[3], &nt_task_pages[4],
};
enum { TASKS = sizeof tasks / sizeof *tasks };

const nt_host_task *nt_host_tasks(int number)
{
    return number >= 0 && number < TASKS ? &tasks[number]->about : NULL;
}

const nt_task *nt_task_named(const char *name)
{
    for (int i = 0; i < TASKS; ++i)
        if (strcmp(tasks[i]->about.name, name) == 0)
            return tasks[i] == &nt_task_lesson ? &nt_task_pages[0] : tasks[i];
    return NULL;
}
