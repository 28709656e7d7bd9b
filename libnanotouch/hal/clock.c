/* SPDX-License-Identifier: BSD-3-Clause */
#if defined(__linux__)
#define _POSIX_C_SOURCE 200809L
#endif

#include "hal/clock.h"

#if defined(_WIN32)

#include <windows.h>

#ifndef CREATE_WAITABLE_TIMER_HIGH_RESOLUTION /* Windows 10, 1803: 0.5 ms; without it a timer has some 15 ms */
#define CREATE_WAITABLE_TIMER_HIGH_RESOLUTION 2
#endif

int64_t nt_clock_now(void)
{
    LARGE_INTEGER now, frequency; /* neither call fails since Windows XP */
    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&frequency);
    const int64_t whole = now.QuadPart / frequency.QuadPart, rest = now.QuadPart % frequency.QuadPart;
    return whole * 1000000000 + rest * 1000000000 / frequency.QuadPart;
}

static HANDLE make_timer(void)
{
    HANDLE timer = CreateWaitableTimerExW(NULL, NULL, CREATE_WAITABLE_TIMER_HIGH_RESOLUTION, TIMER_ALL_ACCESS);
    return timer ? timer : CreateWaitableTimerExW(NULL, NULL, 0, TIMER_ALL_ACCESS);
}

nt_status nt_clock_sleep_until(int64_t deadline)
{
    int64_t left = deadline - nt_clock_now();
    HANDLE timer = left > 0 ? make_timer() : NULL;
    int is_set = left <= 0 || timer != NULL;
    while (is_set && left > 0) { /* a timer may ring early by its unit, 100 ns */
        const LARGE_INTEGER due = {.QuadPart = -(left + 99) / 100};
        is_set = SetWaitableTimer(timer, &due, 0, NULL, NULL, FALSE) &&
                 WaitForSingleObject(timer, INFINITE) == WAIT_OBJECT_0;
        left = deadline - nt_clock_now();
    }
    if (timer)
        CloseHandle(timer);
    return is_set ? NT_OK : NT_E_DEVICE;
}

#elif NT_HAS_SYSTEM

#include <errno.h>
#include <time.h>

static const int64_t second = 1000000000; /* [ns] */

int64_t nt_clock_now(void)
{
    struct timespec now;
    return clock_gettime(CLOCK_MONOTONIC, &now) == 0 ? (int64_t)now.tv_sec * second + now.tv_nsec : 0;
}

static struct timespec to_timespec(int64_t time)
{
    return (struct timespec){.tv_sec = (time_t)(time / second), .tv_nsec = (long)(time % second)};
}

#if defined(__linux__)

nt_status nt_clock_sleep_until(int64_t deadline)
{
    const struct timespec time = to_timespec(deadline);
    int error;
    do
        error = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, NULL);
    while (error == EINTR);
    return error == 0 ? NT_OK : NT_E_DEVICE;
}

#else /* macOS sleeps for a while, not until a time */

nt_status nt_clock_sleep_until(int64_t deadline)
{
    for (int64_t left = deadline - nt_clock_now(); left > 0; left = deadline - nt_clock_now()) {
        const struct timespec time = to_timespec(left);
        if (nanosleep(&time, NULL) != 0 && errno != EINTR)
            return NT_E_DEVICE;
    }
    return NT_OK;
}

#endif

#else

int64_t nt_clock_now(void)
{
    return 0;
}

nt_status nt_clock_sleep_until(int64_t deadline)
{
    (void)deadline;
    return NT_OK;
}

#endif
