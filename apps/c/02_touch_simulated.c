/* SPDX-License-Identifier: BSD-3-Clause
 * Touch a flat silicon surface on the simulated rig: approach, press, retract; print what tip and hand felt. */
#include <math.h>
#include <stdio.h>

#include "nanotouch/nanotouch.h"

enum { BLOCK = 1000 };

/* What is kept of all records. */
typedef struct {
    double largest_force, smallest_force; /* at the tip [N] */
    double smallest_operator_force;       /* at the hand [N] */
    double tracking_square;               /* sum of (f_m - alpha_f f_s)^2 while pressing at rest [N^2] */
    long tracking_count, count;
} summary;

static void add(summary *s, const nt_record *r, double alpha_f)
{
    s->largest_force = fmax(s->largest_force, r->tip_force[NT_Z]);
    s->smallest_force = fmin(s->smallest_force, r->tip_force[NT_Z]);
    s->smallest_operator_force = fmin(s->smallest_operator_force, alpha_f * r->slave_force);
    if (r->time > 5.0 && r->time < 6.0) {
        const double error = r->operator_force[NT_Z] - alpha_f * r->slave_force;
        s->tracking_square += error * error;
        ++s->tracking_count;
    }
    ++s->count;
}

static nt_status run(nt_session *session, const nt_input *input, summary *s)
{
    static nt_record records[BLOCK];
    const nt_touch *touch = nt_session_touch(session);
    nt_status status = nt_session_aim(session, input, NULL);
    long left = lround(input->duration / touch->period);
    while (status == NT_OK && left > 0) {
        const long ticks = left < BLOCK ? left : BLOCK;
        status = nt_session_advance(session, ticks);
        const long got = nt_session_read(session, records, BLOCK);
        for (long i = 0; i < got; ++i)
            add(s, &records[i], touch->settings.gains.alpha_f);
        left -= ticks;
    }
    return status;
}

int main(void)
{
    nt_session_setup setup = nt_session_defaults();
    setup.settings = nt_settings_defaults(&setup.rig); /* 2 N press harder than the scene's largest load */
    nt_session *session = NULL;
    nt_problem problem = {0};
    nt_status status = nt_session_open(&session, &setup, &problem);
    if (status != NT_OK) {
        char text[200];
        fprintf(stderr, "%s: %s\n", nt_status_message(status), nt_problem_print(&problem, text, sizeof text));
        return 1;
    }
    const nt_input script[] = {
        {.operator_force[NT_Z] = 0.2, .duration = 0.5},  {.operator_force[NT_Z] = 0.2, .duration = 2.5},  /* approach */
        {.operator_force[NT_Z] = 2.0, .duration = 1.5},  {.operator_force[NT_Z] = 2.0, .duration = 1.5},  /* press */
        {.operator_force[NT_Z] = -0.3, .duration = 3.0}, {.operator_force[NT_Z] = -0.3, .duration = 1.0}, /* retract */
    };
    summary s = {0};
    for (size_t i = 0; i < sizeof script / sizeof script[0] && status == NT_OK; ++i)
        status = run(session, &script[i], &s);
    const nt_plan *plan = nt_session_plan(session);
    printf("form of the contact    %s, Maugis' lambda %.3g\n", nt_form_name(plan->terms[NT_PLAN_CONTACT].form),
           plan->lambda);
    printf("stability margin of R1 %.1f\n", nt_session_margins(session).margin);
    printf("largest force          %.1f nN\n", s.largest_force * 1e9);
    printf("largest attraction     %.2f nN (the plan's pull-off: %.2f nN)\n", -s.smallest_force * 1e9,
           plan->pull_off_force * 1e9);
    printf("felt at the hand       %.3f N\n", -s.smallest_operator_force);
    printf("f_m - alpha_f f_s RMS  %.4f N at rest\n", sqrt(s.tracking_square / (double)s.tracking_count));
    printf("steps                  %ld\n", s.count);
    nt_session_close(session);
    if (status != NT_OK)
        fprintf(stderr, "%s\n", nt_status_message(status));
    return status == NT_OK ? 0 : 1;
}
