/* SPDX-License-Identifier: BSD-3-Clause
 * Trace a grating with the lights off, and say its period: the surface is not drawn, height comes from the hand alone.
 */
#include <math.h>

#include "host/state.h"

static const double NEEDED = 0.5;  /* fraction of the width */
static const double ALLOWED = 0.1; /* error of the period, relative */
static const double PERIOD = 3e-6; /* of the sample [m] */

static double fraction(const nt_session_host *host)
{
    int touched = 0;
    for (int i = 0; i < NT_TRACE_PARTS; ++i)
        touched += host->trainer.touched[i];
    return (double)touched / NT_TRACE_PARTS;
}

static void figures_of(nt_session_host *host, nt_figure *figures)
{
    figures[0] = (nt_figure){"width", host->width, "m", 0};
    figures[1] = (nt_figure){"share", fraction(host), "%", 0};
}

static void judge(nt_session_host *host, const nt_frame *frame)
{
    const double part = floor(frame->tip_position[NT_X] / host->width * NT_TRACE_PARTS);
    host->trainer.max_force = fmax(host->trainer.max_force, frame->tip_force[NT_Z]);
    if (nt_frame_touches(frame) && isfinite(part))
        host->trainer.touched[(int)fmin(fmax(part, 0.0), NT_TRACE_PARTS - 1.0)] = 1;
}

static void now(nt_session_host *host, nt_text *text)
{
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    figures_of(host, figures);
    nt_text_fill(text, fraction(host) >= NEEDED ? "press N and type the period" : "{share} % of the width touched",
                 figures);
}

static nt_status answer(nt_session_host *host, double value)
{
    const double error = fabs(value - PERIOD) / PERIOD;
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    figures_of(host, figures);
    if (fraction(host) < NEEDED)
        return nt_trainer_early(host, "only {share} % of the width are touched", figures);
    nt_trainer_measure(host, "answer", "m", value);
    nt_trainer_measure(host, "period", "m", PERIOD);
    nt_trainer_measure(host, "error", "", error);
    nt_trainer_measure(host, "largest force", "N", host->trainer.max_force);
    nt_trainer_measure(host, "width touched", "", fraction(host));
    nt_trainer_finish(host, error <= ALLOWED, 100.0 * (1.0 - error), "you say {answer}; it is {period}",
                      (const nt_figure[]){{"answer", value, "m", 0}, {"period", PERIOD, "m", 0}, {0}});
    return NT_OK;
}

/* Along x to a place, at a light force; the mean way between two edges of a kind, NaN where there are too few. */
static double draw(nt_operator *op, double to, double ends[2])
{
    nt_session_host *host = op->host;
    const double force = 0.1 * nt_session_setup_of(host->session)->scene.range.maximum_load;
    const double step = host->frame.tip_position[NT_X] < to ? 0.002 * host->width : -0.002 * host->width;
    double edges[64];
    int count = 0, high = -1;
    while (nt_operator_goes_on(op) && (to - host->frame.tip_position[NT_X]) * step > 0.0) {
        nt_operator_hold(op, force, step);
        const double z = host->frame.tip_position[NT_Z], x = host->frame.tip_position[NT_X];
        const int was = high;
        ends[0] = fmin(ends[0], z);
        ends[1] = fmax(ends[1], z);
        high = z > 0.5 * (ends[0] + ends[1]);
        if (was >= 0 && high != was && count < 64)
            edges[count++] = x;
    }
    double sum = 0.0;
    for (int i = 2; i < count; ++i)
        sum += fabs(edges[i] - edges[i - 2]);
    return sum / (count - 2);
}

/* To the left, then to the right at a light force. */
static void solve(nt_operator *op)
{
    double ends[2] = {INFINITY, -INFINITY};
    (void)nt_operator_down_to(op, 0.1 * nt_session_setup_of(op->host->session)->scene.range.maximum_load);
    (void)draw(op, 0.1 * op->host->width, ends);
    nt_operator_ask(op, "say", draw(op, 0.9 * op->host->width, ends), 0.0, 0.0);
}

const nt_task nt_task_trace = {
    .about = {"trace", "Trace a grating, lights off", "grating", "m", "", NT_HOST_NOTHING, 0},
    .hides = "contact|surface",
    .choices = "",
    .words =
        "Touch, then draw the tip along x over half of the width ({width}) without letting go. Count its steps up. "
        "Then press N and type the period, as 2.5um.",
    .judge = judge,
    .now = now,
    .figures = figures_of,
    .answer = answer,
    .solve = solve};
