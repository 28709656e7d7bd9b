/* SPDX-License-Identifier: BSD-3-Clause
 * What one period of the simulated rig costs in processor time, the least of several repetitions: its parts, the probe
 * by both models, the whole cycle with the touch step; in nanoseconds, and the cycle as multiples of real time at 10
 * kHz. Prints JSON. Argument "count": one long pass of the cycle and no clock, for an instruction counter. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "../c/larger.h"
#include "../c/loop_fixture.h"

enum { REPETITIONS = 7 };

static loop l;
static nt_sim still; /* the rig as the loop has left it */

static void run_cycle(int i)
{
    (void)i;
    (void)loop_tick(&l, NULL, NULL);
}

static void run_touch(int i)
{
    (void)i;
    nt_touch_step(&l.touch, &l.state, &l.sample, &l.command);
}

static void run_read(int i)
{
    nt_sample sample;
    (void)i;
    (void)nt_sim_read(&still, &sample);
}

/* The stage trembles by two steps of its command, as it does when somebody holds it. */
static void run_write(int i)
{
    nt_command command = l.command;
    command.stage_position[NT_Z] += i % 2 ? 0.2e-9 : 0.0;
    (void)nt_sim_write(&still, &command);
}

static double now(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* Nanoseconds per call. */
static double measure(void (*run)(int), int calls)
{
    double best = INFINITY;
    for (int repetition = 0; repetition < REPETITIONS; repetition++) {
        const double start = now();
        for (int i = 0; i < calls; i++)
            run(i);
        best = smaller(best, (now() - start) / calls);
    }
    return best * 1e9;
}

/* The rig at rest, pressed with 3 N or still in the air; the probe dynamic or not. */
static nt_status prepare(double force, nt_probe_model model, double substep)
{
    nt_session_setup setup = nt_session_defaults();
    setup.settings = nt_settings_defaults(&setup.rig); /* 3 N is more than the scene's largest load */
    setup.clearance = force > 0.0 ? 20e-9 : 100e-9;
    nt_status status = loop_open(&l, &setup);
    loop_push(&l, force, 0.5);
    for (int i = 0; i < 30000 && status == NT_OK; i++)
        status = loop_tick(&l, NULL, NULL);
    if (model == NT_PROBE_DYNAMIC) {
        l.sim.slave.dynamic = 1;
        if (status == NT_OK)
            status = nt_cantilever_model_init(&l.sim.slave.cantilever_model, &l.sim.slave.link.rig.probe,
                                              l.sim.slave.link.period, substep);
    }
    still = l.sim;
    return status;
}

static nt_status report_probe(const char *name, double force, double substep)
{
    const nt_probe_model model = substep > 0.0 ? NT_PROBE_DYNAMIC : NT_PROBE_QUASI_STATIC;
    const nt_status status = prepare(force, model, substep);
    const int calls = substep > 0.0 ? 200 : 200000;
    printf(",\n  \"write, %s\": {\"ns\": %.1f}", name, measure(run_write, calls));
    return status;
}

int main(int argc, char **argv)
{
    nt_status status = prepare(3.0, NT_PROBE_QUASI_STATIC, 0.0);
    if (argc > 1 && strcmp(argv[1], "count") == 0) {
        for (int i = 0; i < 1000000; i++)
            run_cycle(i);
        return status == NT_OK ? 0 : 1;
    }
    const double cycle = measure(run_cycle, 200000);
    printf("{\n  \"version\": \"%s\"", nt_version());
    printf(",\n  \"cycle in contact\": {\"ns\": %.1f, \"times real time\": %.0f}", cycle, 1e5 / cycle);
    printf(",\n  \"touch step\": {\"ns\": %.1f}", measure(run_touch, 200000));
    printf(",\n  \"read\": {\"ns\": %.1f}", measure(run_read, 200000));
    status = status == NT_OK ? report_probe("quasi-static in contact", 3.0, 0.0) : status;
    status = status == NT_OK ? report_probe("quasi-static in air", 0.0, 0.0) : status;
    status = status == NT_OK ? report_probe("dynamic in contact, sub-steps of 0.25", 3.0, 0.25) : status;
    status = status == NT_OK ? report_probe("dynamic in contact, sub-steps of 4", 3.0, 4.0) : status;
    status = status == NT_OK ? report_probe("dynamic in contact, sub-steps of 60", 3.0, 60.0) : status;
    status = status == NT_OK ? report_probe("dynamic in air", 0.0, 0.25) : status;
    printf("\n}\n");
    return status == NT_OK ? 0 : 1;
}
