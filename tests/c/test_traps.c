/* SPDX-License-Identifier: BSD-3-Clause
 * The system-call trap: a child process gives up every system call but exit, and then touches. The kernel kills it at
 * the first one. (test_heap is the trap for malloc; a lock that waits is a system call, too.) */
#if defined(__linux__)
#define _GNU_SOURCE
#endif

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nanotouch/nanotouch.h"

#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

static nt_session *session;

static int press(void)
{
    static nt_record records[1000];
    const nt_input input = {.operator_force[NT_Z] = 1.0, .duration = 0.05};
    long count = 0;
    nt_status status = nt_session_aim(session, &input, NULL);
    for (int i = 0; i < 10 && status == NT_OK; i++) {
        status = nt_session_advance(session, 1000);
        count += nt_session_read(session, records, 1000);
    }
    return status != NT_OK || count != 10000;
}

static int request_everything(void)
{
    const nt_gains *gains = &nt_session_touch(session)->settings.gains;
    const nt_scaling scaling = {gains->alpha_p, 0.5 * gains->alpha_f};
    int failures = nt_session_rescale(session, &scaling, NULL) != NT_OK;
    nt_session_clutch(session, 1);
    failures += nt_session_set_mode(session, NT_MODE_TOPOGRAPHY, NULL) != NT_OK;
    nt_session_emergency_stop(session, 1);
    failures += nt_session_advance(session, 100) != NT_OK;
    nt_session_emergency_stop(session, 0);
    return failures + (nt_session_arm(session, 1) != NT_OK) + press();
}

static int call_the_system(void)
{
    return getppid() == 0;
}

/* The exit status of a child that may only compute and exit; -1 if it was killed for more. */
static int trapped(int (*work)(void))
{
    const pid_t child = fork();
    if (child == 0) {
        if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_STRICT) != 0)
            _exit(77);
        const int result = work();
        syscall(SYS_exit, result); /* exit_group, as _exit has it, is forbidden too */
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static int open_session(void **state)
{
    (void)state;
    const nt_session_setup setup = nt_session_defaults();
    return nt_session_open(&session, &setup, NULL) != NT_OK;
}

static int close_session(void **state)
{
    (void)state;
    nt_session_close(session);
    return 0;
}

static void the_trap_works(void **state)
{
    (void)state;
    const int found = trapped(call_the_system);
    if (found == 77)
        skip(); /* no seccomp here */
    assert_int_equal(found, -1);
}

static void a_running_session_calls_no_system(void **state)
{
    (void)state;
    const int pressed = trapped(press);
    if (pressed == 77)
        skip();
    assert_int_equal(pressed, 0);
    assert_int_equal(trapped(request_everything), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_trap_works),
                                       cmocka_unit_test(a_running_session_calls_no_system)};
    return cmocka_run_group_tests(tests, open_session, close_session);
}

#else

static void no_trap_here(void **state)
{
    (void)state;
    skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_trap_here)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
