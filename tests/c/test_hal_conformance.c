/* SPDX-License-Identifier: BSD-3-Clause
 * One suite on every backend that there is: simulated, on converters, shared objects, a device behind a socket; and on
 * a mock that breaks one rule at a time, which the suite has to find. */
#define _POSIX_C_SOURCE 200809L
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "conformance.h"
#include "converter_rig.h"
#include "host_fixture.h"
#include "nanotouch/advanced/hal_linux.h"
#include "nanotouch/advanced/hal_replay.h"
#include "nanotouch/advanced/timing.h"
#include "nanotouch/nanotouch.h" /* no name of these headers is taken by another */
#include "pointer_device.h"

static conformance subject(nt_half half, const nt_backend *backend, void *context)
{
    return (conformance){.half = half,
                         .choice = {backend, context},
                         .host = &host,
                         .configuration = {sizeof(nt_configuration), 0, 1e-3, 1e-6, ""},
                         .periods = 60,
                         .pass = pass};
}

static void assert_conforms(const conformance *c, const char *name)
{
    const char *rule = conform(name, c);
    if (rule)
        fail_msg("%s: %s", name, rule);
}

/* --- the simulated halves --- */

static nt_sim sim;

static void fault_both(nt_fault_kind kind)
{
    const nt_fault fault = {kind, NT_CHANNEL_RIG, 0.0, INFINITY, 0.0};
    assert_int_equal(nt_sim_inject(&sim, &fault), NT_OK);
}

static void sim_silence(void *device, int on)
{
    (void)device;
    if (on)
        fault_both(NT_FAULT_DROPOUT);
    else
        sim.master.link.faults.count = sim.slave.link.faults.count = 0;
}

static void sim_lose(void *device)
{
    (void)device;
    fault_both(NT_FAULT_DEVICE_LOST);
}

static double sim_travel(void *device)
{
    (void)device;
    return sim.slave.pending[(sim.slave.link.tick + NT_SIM_SLOTS - 1u) % NT_SIM_SLOTS][NT_Z];
}

static double sim_motor(void *device)
{
    (void)device;
    return sim.master.pending[(sim.master.link.tick + NT_SIM_SLOTS - 1u) % NT_SIM_SLOTS][NT_Z];
}

static void simulated_halves(void **state)
{
    (void)state;
    const nt_scene scene = nt_scene_defaults();
    const nt_demand demand = nt_demand_defaults();
    const nt_rig rig = nt_rig_defaults();
    const nt_plan_inputs inputs = {.scene = &scene, .demand = &demand};
    static nt_plan plan;
    assert_int_equal(nt_plan_make(&plan, &inputs, NULL), NT_OK);
    const nt_sim_setup setup = {.plan = &plan, .rig = &rig, .period = 1e-3, .clearance = 1e-6, .seed = 1};
    for (int half = 0; half < 2; ++half) {
        assert_int_equal(nt_sim_init(&sim, &setup), NT_OK);
        conformance c = half == NT_HALF_MASTER ? subject(NT_HALF_MASTER, nt_sim_master_backend(), &sim.master)
                                               : subject(NT_HALF_SLAVE, nt_sim_slave_backend(), &sim.slave);
        c.silence = sim_silence;
        c.lose = sim_lose;
        c.left_at = half == NT_HALF_MASTER ? sim_motor : sim_travel;
        assert_conforms(&c, half == NT_HALF_MASTER ? "simulated master" : "simulated slave");
    }
}

/* --- converters on the simulated bus --- */

static bus_fault silence_is;

static void bus_silence(void *device, int on)
{
    ((simulated_bus *)device)->fault = on ? silence_is : BUS_WELL;
}

static void bus_lose(void *device)
{
    ((simulated_bus *)device)->fault = BUS_GONE;
}

static double bus_left_at(void *device)
{
    return simulated_travel(device);
}

static void converters(void **state)
{
    (void)state;
    static const char *const silences[BUS_FAULTS] = {"well", "0", "1", "short", "refusing", "gone", "flipped", "deaf"};
    char name[80];
    for (int has_sensor = 0; has_sensor < 2; ++has_sensor)
        for (int fault = BUS_ALL_ZERO; fault < BUS_FAULTS; ++fault) {
            simulated_bus bus = simulated_bus_after_power_up();
            const nt_converter_setup setup = slave_setup(&bus, has_sensor);
            nt_converter_half half;
            assert_int_equal(nt_converter_half_init(&half, &setup, NULL), NT_OK);
            conformance c = subject(NT_HALF_SLAVE, nt_converter_half_backend(NT_HALF_SLAVE), &half);
            c.device = &bus;
            c.silence = fault == BUS_GONE || (fault == BUS_DEAF && has_sensor) ? NULL : bus_silence;
            c.lose = bus_lose;
            c.left_at = bus_left_at;
            c.slack = 1e-9;
            silence_is = (bus_fault)fault;
            if (fault == BUS_DEAF) /* it hears nothing, and nothing is asked of it: that is no silence */
                c.silence = NULL;
            (void)snprintf(name, sizeof name, "converters%s, bus %s", has_sensor ? " with a sensor of travel" : "",
                           silences[fault]);
            assert_conforms(&c, name);
        }
}

/* --- shared objects, and a device behind a socket --- */

static void say(const nt_host *of, const char *text)
{
    (void)of, (void)text;
}
static const nt_host talking = {sizeof talking, NT_HAL_API_VERSION, now, say, NULL};

static void object_conforms(const char *path, nt_half half, const char *option)
{
    nt_module module;
    if (nt_hal_load(&module, path, half) != NT_OK)
        fail_msg("%s", module.text);
    conformance c = subject(half, module.backend, NULL);
    c.host = &talking;
    c.configuration.option = option;
    assert_conforms(&c, strrchr(path, '/') + 1);
    nt_hal_unload(&module);
}

static void shared_objects(void **state)
{
    (void)state;
    object_conforms(OBJECTS "/tiny.so", NT_HALF_MASTER, "");
    object_conforms(OBJECTS "/real_master.so", NT_HALF_MASTER, "");
    object_conforms(OBJECTS "/real_slave.so", NT_HALF_SLAVE, "");
}

/* --- a recording, given again --- */

static void replay(void **state)
{
    (void)state;
    enum { ROWS = 200 };
    static double time[ROWS], position[NT_AXES * ROWS], felt[NT_AXES * ROWS];
    for (int i = 0; i < ROWS; ++i) {
        time[i] = 1e-3 * i;
        for (int j = 0; j < NT_AXES; ++j)
            position[NT_AXES * i + j] = felt[NT_AXES * i + j] = 1e-9 * i;
    }
    const nt_replay_rows rows = {ROWS, NT_AXES, time, position, felt};
    for (int half = 0; half < 2; ++half) {
        nt_replay_half replayed;
        assert_int_equal(nt_replay_half_init(&replayed, &rows, NULL), NT_OK);
        conformance c = subject((nt_half)half, nt_replay_backend((nt_half)half), &replayed);
        assert_conforms(&c, half == NT_HALF_MASTER ? "replayed master" : "replayed slave");
    }
}

static pointer_device pointer;

static void pass_with_pointer(const nt_host *of, double period)
{
    pass(of, period);
    pointer_tick(&pointer);
}

static void silence_pointer(void *device, int on)
{
    (void)device;
    (void)pthread_mutex_lock(&pointer.lock);
    pointer.is_silent = on;
    (void)pthread_mutex_unlock(&pointer.lock);
}

static void device_behind_a_socket(void **state)
{
    (void)state;
    nt_module module;
    if (!pointer_start(&pointer, &clock_now))
        fail_msg("no socket");
    if (nt_hal_load(&module, OBJECTS "/pointer.so", NT_HALF_MASTER) != NT_OK)
        fail_msg("%s", module.text);
    conformance c = subject(NT_HALF_MASTER, module.backend, NULL);
    c.host = &talking;
    c.configuration.option = pointer.port;
    c.pass = pass_with_pointer;
    c.silence = silence_pointer;
    assert_conforms(&c, "pointer.so, a device behind a socket");
    pointer_end(&pointer);
    nt_hal_unload(&module);
}

/* --- a mock that breaks one rule at a time --- */

typedef enum offence {
    NONE,
    MOVES_AT_OPEN,
    KEEPS_PRESSING,
    LIFTS_TWICE,
    FOLLOWS_NAN,
    INVENTS_WHILE_SILENT,
    FALLS_WHILE_SILENT,
    GOES_ON_WHEN_LOST,
    HIDES_THE_LOSS,
    OFFENCES
} offence;

typedef struct mock {
    offence is;
    int is_silent, is_lost, is_armed, has_been_armed;
    double z, lift;
    uint64_t sequence;
} mock;

static nt_status open_mock(void *context, const nt_host *given, nt_problem *problem)
{
    mock *m = context;
    (void)given, (void)problem;
    m->sequence = 100;
    m->has_been_armed = 0;
    m->z -= m->is == MOVES_AT_OPEN ? 1e-6 : 0.0;
    return NT_OK;
}

static nt_status configure_mock(void *context, const nt_configuration *configuration, nt_problem *problem)
{
    (void)problem;
    ((mock *)context)->lift = configuration->lift;
    return NT_OK;
}

static nt_status arm_mock(void *context)
{
    ((mock *)context)->is_armed = ((mock *)context)->has_been_armed = 1;
    return NT_OK;
}

static nt_status read_mock(void *context, nt_reading *reading)
{
    mock *m = context;
    if (m->is_lost && m->is != GOES_ON_WHEN_LOST)
        return m->is == HIDES_THE_LOSS ? NT_OK : NT_E_DEVICE;
    if (m->is_silent && m->is == FALLS_WHILE_SILENT) {
        reading->sequence -= 1;
        reading->valid = 0;
        reading->flags = NT_SAMPLE_INVALID;
        return NT_OK;
    }
    if (m->is_silent && m->is != INVENTS_WHILE_SILENT)
        return NT_OK;
    reading->sequence = ++m->sequence;
    reading->time = clock_now;
    reading->position[NT_Z] = m->z;
    reading->valid = 1u << NT_Z;
    return NT_OK;
}

static nt_status write_mock(void *context, const nt_action *action)
{
    mock *m = context;
    const double z = action->target[NT_Z];
    if (isnan(z) && m->is != FOLLOWS_NAN)
        return NT_E_NOT_FINITE;
    m->z = isnan(z) ? 1.0 : z;
    return NT_OK;
}

static void disarm_mock(void *context)
{
    mock *m = context;
    if (m->is_armed || (m->has_been_armed && m->is == LIFTS_TWICE))
        m->z -= m->is == KEEPS_PRESSING ? 0.0 : m->lift;
    m->is_armed = 0;
}

static void mock_silence(void *device, int on)
{
    ((mock *)device)->is_silent = on;
}
static void mock_lose(void *device)
{
    ((mock *)device)->is_lost = 1;
}
static double mock_left_at(void *device)
{
    return ((mock *)device)->z;
}

static void every_offence_is_found(void **state)
{
    (void)state;
    static const nt_backend backend = {.size = sizeof backend,
                                       .version = NT_HAL_API_VERSION,
                                       .name = "mock",
                                       .half = NT_HALF_SLAVE,
                                       .open = open_mock,
                                       .configure = configure_mock,
                                       .arm = arm_mock,
                                       .read = read_mock,
                                       .write = write_mock,
                                       .disarm = disarm_mock,
                                       .close = disarm_mock};
    static const char *const found[OFFENCES] = {NULL,
                                                "nothing is driven before arm",
                                                "close lifts",
                                                "close after disarm moves nothing more",
                                                "a target that is no number moves nothing",
                                                "a silent device gives nothing new",
                                                "the sequence does not fall",
                                                "a lost device gives nothing new",
                                                "a lost device says so"};
    for (int is = NONE; is < OFFENCES; ++is) {
        mock m = {.is = (offence)is};
        conformance c = subject(NT_HALF_SLAVE, &backend, &m);
        c.device = &m;
        c.silence = mock_silence;
        c.lose = mock_lose;
        c.left_at = mock_left_at;
        c.slack = 1e-12;
        char name[80];
        (void)snprintf(name, sizeof name, "mock%s%s", found[is] ? " that breaks: " : "", found[is] ? found[is] : "");
        const char *rule = conform(name, &c);
        if (found[is] ? !rule || strcmp(rule, found[is]) != 0 : rule != NULL)
            fail_msg("offence %d: \"%s\" instead of \"%s\"", is, rule ? rule : "", found[is] ? found[is] : "");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(simulated_halves),       cmocka_unit_test(converters),
        cmocka_unit_test(shared_objects),         cmocka_unit_test(replay),
        cmocka_unit_test(device_behind_a_socket), cmocka_unit_test(every_offence_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
