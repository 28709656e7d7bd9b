/* SPDX-License-Identifier: BSD-3-Clause
 * A person at a live session, through the C library alone: down to the sample, a slider, undo, and back. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/host.h"
#include "nanotouch/nanotouch.h"

static char message[NT_HOST_MESSAGE];
static double memory[1 << 16];
static nt_session_host *host;
static nt_session *session;
static nt_frame frame;

static int open_host(void **state)
{
    (void)state;
    nt_session_setup setup = nt_session_defaults();
    const nt_host_ground ground = {1e-6, 1e-6, 0.0, 0.0, 0};
    const nt_host_subject subject = {"silicon_in_air", "Silicon", "", "here", "", 1e-6, 1e-6, NT_HOST_NOTHING};
    if (nt_host_size() > sizeof memory)
        return 1;
    host = nt_host_init(memory);
    if (nt_host_compose(host, &setup, &ground, NULL) != NT_OK)
        return 1;
    setup.preflight = 0;
    setup.ring_capacity = 0;
    nt_host_lay(host, &subject);
    return nt_session_open(&session, &setup, NULL) != NT_OK || nt_host_open(host, session) != NT_OK;
}

static int close_host(void **state)
{
    (void)state;
    nt_host_close(host);
    nt_session_close(session);
    return 0;
}

/* Is there a message of this name among those that wait? */
static int told(const char *name)
{
    char begins[64];
    int found = 0;
    (void)snprintf(begins, sizeof begins, "{\"tell\":\"%s\"", name);
    while (nt_host_tell(host, message, sizeof message) > 0)
        found |= strncmp(message, begins, strlen(begins)) == 0;
    return found;
}

static nt_status ask(const char *what, const char *text, double value)
{
    return nt_host_ask(host, &(nt_host_asked){what, text, {value, 0.0, 0.0}});
}

static void pass(int times)
{
    for (int i = 0; i < times; i++) {
        assert_int_equal(nt_session_advance(session, 99), NT_OK);
        assert_int_equal(nt_session_step(session, NULL, &frame), NT_OK);
        nt_host_see(host, &frame, 1);
        nt_host_follow(host, 0.01);
    }
}

static void a_wheel_leads_to_the_sample_and_back(void **state)
{
    (void)state;
    assert_true(told("sliders"));
    assert_int_equal(ask("report", "", 0.0), NT_OK);
    assert_true(told("world"));
    pass(1);
    int steps = 0;
    for (; steps < 600 && !(frame.contact_radius > 0.0); steps++) {
        assert_int_equal(ask("wheel", "", 1.0), NT_OK);
        pass(2);
    }
    assert_in_range(steps, 1, 599);
    const double limit = nt_session_setup_of(session)->settings.limits.force;
    assert_true(fabs(frame.tip_force[NT_Z]) < limit && frame.state == NT_RUN);
    assert_int_equal(ask("retract", "", 0.0), NT_OK);
    pass(100);
    assert_true(frame.contact_radius == 0.0 && frame.gap > 0.0);
}

static void a_change_is_undone_and_done_again(void **state)
{
    (void)state;
    const nt_session_setup *setup = nt_session_setup_of(session);
    const double before = setup->scene.medium.relative_humidity;
    assert_int_equal(ask("change", "medium.relative_humidity", 0.2), NT_OK);
    assert_true(told("world") && nt_session_setup_of(session)->scene.medium.relative_humidity == 0.2);
    assert_int_equal(ask("undo", "", 0.0), NT_OK);
    assert_true(nt_session_setup_of(session)->scene.medium.relative_humidity == before);
    assert_int_equal(ask("redo", "", 0.0), NT_OK);
    assert_true(nt_session_setup_of(session)->scene.medium.relative_humidity == 0.2);
    (void)ask("change", "medium.relative_humidity", 7.0);
    assert_true(told("refused"));
    assert_true(nt_session_setup_of(session)->scene.medium.relative_humidity == 0.2);
}

static void what_no_host_knows_is_left_to_its_caller(void **state)
{
    (void)state;
    assert_int_equal(ask("fly", "", 0.0), NT_E_UNSUPPORTED);
    (void)ask("task", "nothing", 0.0);
    assert_true(told("refused"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wheel_leads_to_the_sample_and_back),
        cmocka_unit_test(a_change_is_undone_and_done_again),
        cmocka_unit_test(what_no_host_knows_is_left_to_its_caller),
    };
    return cmocka_run_group_tests(tests, open_host, close_host);
}
