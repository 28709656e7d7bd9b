/* SPDX-License-Identifier: BSD-3-Clause
 * What the kernel grants the thread of a loop, and why it does not. */
#if defined(__linux__)
#define _GNU_SOURCE /* processors of a thread */
#endif

#include "nanotouch/advanced/hal_linux.h"

#if defined(__linux__)

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { STACK = 256 * 1024 }; /* [bytes] */

static void outcome(nt_realtime *rt, unsigned bit, int error, const char *what, const char *help)
{
    rt->wished |= bit;
    if (error == 0) {
        rt->granted |= bit;
        return;
    }
    const size_t used = strlen(rt->refused);
    (void)snprintf(rt->refused + used, sizeof rt->refused - used, "%s was refused: %s; %s\n", what, strerror(error),
                   help);
}

static void ask_priority(nt_realtime *rt, int priority)
{
    struct sched_param now = {0}, wanted = {.sched_priority = priority};
    rt->policy = sched_getscheduler(0);
    (void)sched_getparam(0, &now);
    rt->priority = now.sched_priority;
    outcome(rt, NT_REALTIME_PRIORITY, sched_setscheduler(0, SCHED_FIFO, &wanted) == 0 ? 0 : errno,
            "priority (SCHED_FIFO)", "it takes CAP_SYS_NICE or rtprio in /etc/security/limits.conf");
}

static void ask_processor(nt_realtime *rt, int processor)
{
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET((size_t)processor, &set);
    outcome(rt, NT_REALTIME_PROCESSOR, sched_setaffinity(0, sizeof set, &set) == 0 ? 0 : errno, "the processor",
            "it must be one of this machine that this program may use");
}

/* Touches the stack that the loop will use, so that no page of it is missing later. */
static void touch_stack(void)
{
    volatile unsigned char stack[STACK];
    for (size_t i = 0; i < sizeof stack; i += 1024)
        stack[i] = 0;
}

static void ask_memory(nt_realtime *rt)
{
    outcome(rt, NT_REALTIME_MEMORY, mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno, "locked memory (mlockall)",
            "it takes CAP_IPC_LOCK or memlock in /etc/security/limits.conf");
    touch_stack();
}

/* The wish holds as long as the file is open. */
static void ask_awake(nt_realtime *rt)
{
    const int32_t none = 0; /* [us] */
    const int file = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    int error = file < 0 ? errno : 0;
    if (error == 0 && write(file, &none, sizeof none) != (ssize_t)sizeof none)
        error = errno;
    if (error != 0 && file >= 0)
        (void)close(file);
    rt->awake_file = error == 0 ? file : -1;
    outcome(rt, NT_REALTIME_AWAKE, error, "staying awake (/dev/cpu_dma_latency)", "it takes write access to that file");
}

nt_realtime_wish nt_realtime_wish_defaults(void)
{
    return (nt_realtime_wish){.priority = 80, .processor = -1, .locks = 1, .stays_awake = 1};
}

nt_status nt_realtime_begin(nt_realtime *realtime, const nt_realtime_wish *wish)
{
    if (!realtime || !wish)
        return NT_E_ARGUMENT;
    if (wish->priority < 0 || wish->priority > 99 || wish->processor < -1 || wish->processor >= CPU_SETSIZE)
        return NT_E_RANGE;
    *realtime = (nt_realtime){.awake_file = -1};
    if (wish->locks)
        ask_memory(realtime);
    if (wish->processor >= 0)
        ask_processor(realtime, wish->processor);
    if (wish->stays_awake)
        ask_awake(realtime);
    if (wish->priority > 0)
        ask_priority(realtime, wish->priority);
    return NT_OK;
}

void nt_realtime_end(nt_realtime *realtime)
{
    if (!realtime)
        return;
    if (realtime->granted & NT_REALTIME_PRIORITY) {
        const struct sched_param before = {.sched_priority = realtime->priority};
        (void)sched_setscheduler(0, realtime->policy, &before);
    }
    if (realtime->granted & NT_REALTIME_AWAKE)
        (void)close(realtime->awake_file);
    if (realtime->granted & NT_REALTIME_MEMORY)
        (void)munlockall();
    realtime->granted = 0;
}

#else

nt_realtime_wish nt_realtime_wish_defaults(void)
{
    return (nt_realtime_wish){.priority = 80, .processor = -1, .locks = 1, .stays_awake = 1};
}

nt_status nt_realtime_begin(nt_realtime *realtime, const nt_realtime_wish *wish)
{
    (void)realtime, (void)wish;
    return NT_E_UNSUPPORTED;
}

void nt_realtime_end(nt_realtime *realtime)
{
    (void)realtime;
}

#endif
