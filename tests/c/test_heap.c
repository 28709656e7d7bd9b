/* SPDX-License-Identifier: BSD-3-Clause
 * The malloc trap: the heap is touched in open and close only. The program brings its own malloc and its family, which
 * the C library calls too, and counts the calls while the trap is armed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
/* after what it needs */
#include <cmocka.h>

#include "nanotouch/nanotouch.h"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TRAP 1
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void __libc_free(void *memory);
#else
#define TRAP 0 /* a sanitizer brings its own malloc, and only glibc gives the original away */
#endif

static volatile int armed;
static volatile long calls;

#if TRAP
#pragma GCC visibility push(default) /* else calls from the shared library would pass these by */

void *malloc(size_t size)
{
    calls += armed;
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    calls += armed;
    return __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
    calls += armed;
    return __libc_realloc(memory, size);
}

void free(void *memory)
{
    calls += armed;
    __libc_free(memory);
}

#pragma GCC visibility pop
#endif

static int arm(void **state)
{
    (void)state;
    calls = 0;
    armed = 1;
    return 0;
}

static int disarm(void **state)
{
    (void)state;
    armed = 0;
    return 0;
}

/* Asserts may use the heap, so they come after this. */
static long calls_so_far(void)
{
    armed = 0;
    return calls;
}

/* It sees calls of the program and of the library. */
static void the_trap_works(void **unused)
{
    (void)unused;
    const nt_session_setup setup = nt_session_defaults();
    nt_session *session = NULL;
    void *volatile memory = malloc(10);
    free(memory);
    const long own = calls;
    const nt_status status = nt_session_open(&session, &setup, NULL);
    const long count = calls_so_far();
    nt_session_close(session);
    assert_int_equal(status, NT_OK);
#if TRAP
    assert_int_equal(own, 2);
    assert_true(count > own);
#else
    (void)own;
    (void)count;
    skip();
#endif
}

static void laws_use_no_heap(void **unused)
{
    (void)unused;
    const nt_contact contact = nt_contact_defaults();
    double indentations[16], forces[16];
    int failures = 0;
    for (int i = 0; i < 16; i++)
        indentations[i] = (i - 6) * 0.1e-9;
    for (int model = NT_HERTZ; model <= NT_MAUGIS; model++) {
        nt_contact_law law;
        const nt_strided arrays = {.in = indentations, .F = forces, .count = 16, .in_stride = 1, .out_stride = 1};
        failures += nt_contact_law_init(&law, (nt_model)model, &contact) != NT_OK;
        failures += nt_contact_law_eval_n(&law, NT_BRANCH_APPROACH, &arrays) != NT_OK;
        failures += nt_contact_law_eval_n(&law, NT_BRANCH_STABLE, &arrays) != NT_OK;
    }
    assert_int_equal(calls_so_far(), 0);
    assert_int_equal(failures, 0);
}

enum { PIXELS = 32 };

static double heights[PIXELS * PIXELS], dilated[PIXELS * PIXELS];

static nt_status make_surface(nt_surface *surface)
{
    const nt_grating grating = nt_grating_defaults();
    const nt_tip_shape tip = {.radius = 20e-9, .half_angle = 0.3};
    const nt_height_map map = {.heights = heights, .nx = PIXELS, .ny = PIXELS, .dx = 0.1e-6, .dy = 0.1e-6};
    for (int j = 0; j < PIXELS; j++)
        for (int i = 0; i < PIXELS; i++)
            heights[j * PIXELS + i] = nt_grating_height(&grating, i * map.dx, j * map.dy);
    const nt_status status = nt_surface_dilate(&map, &tip, dilated);
    const nt_height_map touched = {.heights = dilated, .nx = PIXELS, .ny = PIXELS, .dx = map.dx, .dy = map.dy};
    return status != NT_OK ? status : nt_surface_init(surface, &touched, dilated);
}

static void surface_and_interaction_use_no_heap(void **unused)
{
    (void)unused;
    const nt_scene scene = nt_scene_defaults();
    nt_surface surface;
    static nt_plan plan;
    const nt_plan_inputs inputs = {.scene = &scene, .surface = &surface};
    nt_status status = make_surface(&surface);
    if (status == NT_OK)
        status = nt_plan_make(&plan, &inputs, NULL);
    nt_interaction_state contact = {0};
    for (int i = 0; i < 100 && status == NT_OK; i++) {
        const nt_pose pose = {.x = i * 30e-9, .y = 1e-6, .z = 481e-9 - i * 20e-12};
        nt_interaction_advance(&plan, &contact, &pose);
        status = isfinite(nt_interaction_eval(&plan, &contact, &pose).U) ? NT_OK : NT_E_NOT_FINITE;
    }
    assert_int_equal(calls_so_far(), 0);
    assert_int_equal(status, NT_OK);
}

static void problems_are_printed_without_heap(void **unused)
{
    (void)unused;
    nt_rig rig = nt_rig_defaults();
    nt_problem problem = {0};
    char text[200];
    rig.probe.spring_constant = 0.0;
    const nt_status status = nt_rig_check(&rig, &problem);
    const char *printed = nt_problem_print(&problem, text, sizeof text);
    assert_int_equal(calls_so_far(), 0);
    assert_int_not_equal(status, NT_OK);
    assert_non_null(printed);
}

/* Approach, press, retract: 6000 ticks of simulated rig and touch step; the probe by either model, with faults. */
static void run_session(nt_probe_model model)
{
    const nt_input inputs[] = {{.operator_force[NT_Z] = 1.0, .duration = 0.1},
                               {.operator_force[NT_Z] = -1.0, .duration = 0.1}};
    static nt_record records[1000];
    nt_session_setup setup = nt_session_defaults();
    setup.probe_model = model;
    if (model == NT_PROBE_DYNAMIC)
        setup.substep = 50.0;
    nt_session *session = NULL;
    long count = 0;
    armed = 0;
    assert_int_equal(nt_session_open(&session, &setup, NULL), NT_OK);
    armed = 1;
    nt_status status = NT_OK;
    for (int i = 0; i < 6 && status == NT_OK; i++) {
        status = nt_session_aim(session, &inputs[i % 2], NULL);
        if (status == NT_OK)
            status = nt_session_advance(session, 1000);
        count += nt_session_read(session, records, 1000);
    }
    const nt_fault noise = {NT_FAULT_NOISE, NT_CHANNEL_DEFLECTION, 0.61, 0.01, 10.0};
    const nt_fault late = {NT_FAULT_LATE, NT_CHANNEL_RIG, 0.605, 1e-4, 2.0};
    if (status == NT_OK)
        status = nt_session_inject(session, &noise);
    if (status == NT_OK)
        status = nt_session_inject(session, &late);
    nt_session_emergency_stop(session, 1);
    if (status == NT_OK)
        status = nt_session_advance(session, 100);
    const long touched = calls_so_far();
    nt_session_close(session);
    assert_int_equal(touched, 0);
    assert_int_equal(status, NT_OK);
    assert_int_equal(count, 6000);
}

static void open_session_uses_no_heap(void **unused)
{
    (void)unused;
    run_session(NT_PROBE_QUASI_STATIC);
    armed = 1;
    run_session(NT_PROBE_DYNAMIC);
}

/* The touch step in each state, both modes, good samples and bad. */
static void touch_step_uses_no_heap(void **unused)
{
    (void)unused;
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    unsigned states = 0;
    nt_status status = NT_OK;
    for (int mode = NT_MODE_TOUCH; mode <= NT_MODE_TOPOGRAPHY && status == NT_OK; mode++) {
        nt_touch touch;
        nt_command command = {0};
        status = nt_touch_make(&touch, &rig, &settings, (nt_mode)mode, NULL);
        nt_touch_state state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
        for (int i = 0; i < 400 && status == NT_OK; i++) {
            nt_sample sample = {.stage_position[NT_Z] = command.stage_position[NT_Z],
                                .operator_force[NT_Z] = 0.1,
                                .deflection[NT_Z] = i * 1e-12};
            sample.flags = i % 100 > 90 ? NT_SAMPLE_INVALID : i > 350 ? NT_SAMPLE_EMERGENCY_STOP : 0u;
            status = nt_touch_aim(&touch, &state, 1e-6, i * 1e-9, 0.1);
            nt_touch_step(&touch, &state, &sample, &command);
            states |= 1u << command.state;
            if (i % 100 == 99 && i < 350)
                status = nt_touch_arm(&state, 1);
        }
    }
    assert_int_equal(calls_so_far(), 0);
    assert_int_equal(status, NT_OK);
    assert_int_equal(states, 15); /* RUN, HOLD, RETRACT, LATCHED */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(the_trap_works, arm, disarm),
        cmocka_unit_test_setup_teardown(laws_use_no_heap, arm, disarm),
        cmocka_unit_test_setup_teardown(surface_and_interaction_use_no_heap, arm, disarm),
        cmocka_unit_test_setup_teardown(problems_are_printed_without_heap, arm, disarm),
        cmocka_unit_test_setup_teardown(touch_step_uses_no_heap, arm, disarm),
        cmocka_unit_test_setup_teardown(open_session_uses_no_heap, arm, disarm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
