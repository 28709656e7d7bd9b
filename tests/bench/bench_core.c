/* SPDX-License-Identifier: BSD-3-Clause
 * What one call costs, in nanoseconds on this machine and in multiples of one Hertz evaluation: the least of several
 * repetitions, because whatever disturbs a measurement makes it longer. Prints JSON. */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "../c/larger.h"
#include "internal/surface.h"
#include "nanotouch/nanotouch.h"

enum { REPETITIONS = 9, POINTS = 64 };

static double indentations[POINTS];
static volatile double sink;

/* Everything that a measured call may need. */
typedef struct bench {
    nt_contact_law law;
    nt_branch branch;
    nt_plan plan;
    nt_surface surface;
    nt_session *session;
    nt_frames *frames;
} bench;

static void run_law(bench *b, int i)
{
    nt_law_value value = {0};
    if (nt_contact_law_eval(&b->law, indentations[i % POINTS], b->branch, &value) == NT_OK)
        sink = value.F;
}

static void run_interaction(bench *b, int i)
{
    const nt_interaction_state state = {1, 0.0, 0.0};
    sink = nt_interaction_eval_gap(&b->plan, &state, NULL, -indentations[i % POINTS]).F;
}

static void run_surface(bench *b, int i)
{
    sink = nt_surface_eval(&b->surface, (i % 61) * 20e-9, (i % 53) * 20e-9).z;
}

static void run_tick(bench *b, int i)
{
    static nt_record records[POINTS];
    (void)i;
    sink = nt_session_advance(b->session, 1);
    sink = (double)nt_session_read(b->session, records, POINTS);
}

static void run_frame(bench *b, int i)
{
    static nt_frame frame;
    frame.sequence = (uint64_t)i;
    nt_frames_publish(b->frames, &frame);
}

static double now(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

/* Nanoseconds per call [ns]. */
static double measure(void (*run)(bench *, int), bench *b)
{
    double best = INFINITY;
    int calls = 1000;
    for (int repetition = 0; repetition < REPETITIONS; repetition++) {
        const double start = now();
        for (int i = 0; i < calls; i++)
            run(b, i);
        const double seconds = now() - start;
        best = smaller(best, seconds / calls);
        if (seconds < 0.02) { /* too short for the clock: more of them */
            calls *= 4;
            repetition = -1;
            best = INFINITY;
        }
    }
    return best * 1e9;
}

static void report(const char *name, double ns, double hertz)
{
    printf(",\n  \"%s\": {\"ns\": %.1f, \"hertz\": %.2f}", name, ns, ns / hertz);
}

static nt_status prepare(bench *b)
{
    static double heights[64 * 64];
    const nt_scene scene = nt_scene_defaults();
    const nt_plan_inputs inputs = {.scene = &scene};
    const nt_session_setup setup = nt_session_defaults();
    const nt_height_map map = {.heights = heights, .nx = 64, .ny = 64, .dx = 20e-9, .dy = 20e-9};
    for (int i = 0; i < POINTS; i++)
        indentations[i] = (i + 0.5) / POINTS * 1e-9;
    for (int i = 0; i < 64 * 64; i++)
        heights[i] = 1e-9 * sin(0.1 * i);
    nt_status status = nt_plan_make(&b->plan, &inputs, NULL);
    if (status == NT_OK)
        status = nt_surface_init(&b->surface, &map, heights);
    if (status == NT_OK)
        status = nt_frames_create(&b->frames, NULL);
    return status == NT_OK ? nt_session_open(&b->session, &setup, NULL) : status;
}

int main(void)
{
    const nt_contact contact = nt_contact_defaults();
    static bench b = {.branch = NT_BRANCH_STABLE};
    double hertz = 0.0;
    nt_status status = prepare(&b);
    printf("{\n  \"version\": \"%s\"", nt_version());
    for (int model = NT_HERTZ; model <= NT_MAUGIS && status == NT_OK; model++) {
        status = nt_contact_law_init(&b.law, (nt_model)model, &contact);
        const double ns = measure(run_law, &b);
        hertz = model == NT_HERTZ ? ns : hertz;
        report(nt_model_name((nt_model)model), ns, hertz);
    }
    report("interaction", measure(run_interaction, &b), hertz);
    report("surface", measure(run_surface, &b), hertz);
    report("tick of a simulated session", measure(run_tick, &b), hertz);
    report("frame shown to observers", measure(run_frame, &b), hertz);
    printf("\n}\n");
    nt_frames_close(b.frames);
    nt_session_close(b.session);
    return status == NT_OK ? 0 : 1;
}
