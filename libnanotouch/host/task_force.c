/* SPDX-License-Identifier: BSD-3-Clause
 * Tasks about a force: find the surface below one, keep one, measure the one that lets go. */
#include <math.h>

#include "host/state.h"

static double load_of(const nt_session_host *host)
{
    return nt_session_setup_of(host->session)->scene.range.maximum_load;
}

/* --- find the surface: the largest force until the tip has lain on the sample for a second --- */

static const double LIGHT = 0.05; /* of the max load: the force that is allowed */
static const double HELD = 1.0;   /* the contact is kept for so long [s] */

static void find_figures(nt_session_host *host, nt_figure *figures)
{
    figures[0] = (nt_figure){"held", HELD, "#", 0};
    figures[1] = (nt_figure){"limit", LIGHT * load_of(host), "N", 0};
    figures[2] = (nt_figure){"largest", fmax(host->trainer.max_force, 0.0), "N", 0};
}

static void find_judge(nt_session_host *host, const nt_frame *frame)
{
    nt_trainer *trainer = &host->trainer;
    const double limit = LIGHT * load_of(host);
    trainer->max_force = fmax(trainer->max_force, frame->tip_force[NT_Z]);
    if (!nt_frame_touches(frame)) {
        trainer->since = INFINITY; /* it begins anew when contact is lost */
    } else if (isinf(trainer->since)) {
        trainer->since = frame->time;
    } else if (frame->time - trainer->since >= HELD) {
        nt_figure figures[NT_TASK_FIGURES] = {{0}};
        find_figures(host, figures);
        nt_trainer_measure(host, "largest force", "N", trainer->max_force);
        nt_trainer_measure(host, "limit", "N", limit);
        nt_trainer_finish(host, trainer->max_force <= limit, 100.0 * limit / fmax(trainer->max_force, 1e-15),
                          "found with {largest}; allowed were {limit}", figures);
    }
}

static void find_now(nt_session_host *host, nt_text *text)
{
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    find_figures(host, figures);
    nt_text_fill(text, "largest force so far {largest}", figures);
}

/* Down by small steps until it touches, then wait. */
static void find_solve(nt_operator *op)
{
    (void)nt_operator_down_to(op, -INFINITY);
    while (nt_operator_goes_on(op))
        (void)nt_operator_wait(op, 0.02);
}

const nt_task nt_task_find = {
    .about = {"find", "Find the surface", "silicon_in_air", "", "", NT_HOST_NOTHING, 0},
    .hides = "",
    .choices = "",
    .words = "Go down until the tip touches, and stay there for {held} s. Never press with more than {limit}.",
    .judge = find_judge,
    .now = find_now,
    .figures = find_figures,
    .solve = find_solve};

/* --- keep a force over the relief: it begins when the force is first within the band --- */

static const double TARGET = 0.3, BAND = 0.25; /* of the max load; of the target */
static const double TIME = 10.0, WAY = 0.1;    /* [s]; of the width */
static const double NEEDED = 0.8;              /* fraction of the time within the band */

static nt_status steady_begin(nt_session_host *host)
{
    host->trainer.target = TARGET * load_of(host);
    host->trainer.left = INFINITY;
    host->trainer.right = -INFINITY;
    return NT_OK;
}

static void steady_figures(nt_session_host *host, nt_figure *figures)
{
    const nt_trainer *trainer = &host->trainer;
    figures[0] = (nt_figure){"target", trainer->target, "N", 0};
    figures[1] = (nt_figure){"band", BAND, "%", 0};
    figures[2] = (nt_figure){"time", TIME, "#", 0};
    figures[3] = (nt_figure){"way", WAY * host->width, "m", 0};
    figures[4] = (nt_figure){"share", trainer->good / fmax(trainer->all, 1.0), "%", 0};
}

static void steady_finish(nt_session_host *host)
{
    const nt_trainer *trainer = &host->trainer;
    const double share = trainer->good / trainer->all, way = trainer->right - trainer->left, least = WAY * host->width;
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    steady_figures(host, figures);
    nt_trainer_measure(host, "share within", "", share);
    nt_trainer_measure(host, "RMS error", "N", sqrt(trainer->squares / trainer->all));
    nt_trainer_measure(host, "target", "N", trainer->target);
    nt_trainer_measure(host, "way", "m", way);
    nt_trainer_finish(host, share >= NEEDED && way >= least, 100.0 * share * fmin(1.0, way / least),
                      way >= least ? "within the band for {share} % of the time"
                                   : "within the band for {share} % of the time, but the tip hardly moved",
                      figures);
}

static void steady_judge(nt_session_host *host, const nt_frame *frame)
{
    nt_trainer *trainer = &host->trainer;
    const double error = frame->tip_force[NT_Z] - trainer->target;
    const int within = fabs(error) <= BAND * trainer->target;
    if (isinf(trainer->since) && !within)
        return;
    if (isinf(trainer->since))
        trainer->since = frame->time;
    if (frame->time >= trainer->since + TIME) {
        steady_finish(host);
        return;
    }
    trainer->good += within;
    trainer->all += 1.0;
    trainer->squares += error * error;
    trainer->left = fmin(trainer->left, frame->tip_position[NT_X]);
    trainer->right = fmax(trainer->right, frame->tip_position[NT_X]);
}

static void steady_now(nt_session_host *host, nt_text *text)
{
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    steady_figures(host, figures);
    nt_text_fill(text, host->trainer.all > 0.0 ? "within the band for {share} % of the time" : "it begins at {target}",
                 figures);
}

/* Correct the height against the force. */
static void steady_solve(nt_operator *op)
{
    const double target = op->host->trainer.target;
    (void)nt_operator_down_to(op, 0.9 * target);
    while (nt_operator_goes_on(op))
        nt_operator_hold(op, target, 0.0004 * op->host->width);
}

const nt_task nt_task_steady = {
    .about = {"steady", "Keep a constant force", "silicon_in_air", "", "", NT_HOST_NOTHING, 0},
    .hides = "",
    .choices = "",
    .words = "Hold {target} within {band} % for {time} s, and carry the tip over {way} of the surface meanwhile.",
    .begin = steady_begin,
    .judge = steady_judge,
    .now = steady_now,
    .figures = steady_figures,
    .solve = steady_solve};

/* --- measure a pull-off: the law is hidden, the force over time is not --- */

enum { TEARS = 3 };
static const double CLOSE = 0.1; /* error of the answer, relative */

static void pull_off_figures(nt_session_host *host, nt_figure *figures)
{
    figures[0] = (nt_figure){"needed", TEARS, "#", 0};
    figures[1] = (nt_figure){"left", TEARS - host->trainer.pull_count, "#", 0};
}

/* A pull-off is the deepest pull between a contact and its end. */
static void pull_off_judge(nt_session_host *host, const nt_frame *frame)
{
    nt_trainer *trainer = &host->trainer;
    const double force = frame->tip_force[NT_Z];
    if (nt_frame_touches(frame))
        trainer->low = trainer->touches ? fmin(trainer->low, force) : force;
    else if (trainer->touches && trainer->pull_count < NT_PULLS)
        trainer->pulls[trainer->pull_count++] = -fmin(trainer->low, force);
}

static void pull_off_now(nt_session_host *host, nt_text *text)
{
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    pull_off_figures(host, figures);
    nt_text_fill(text, host->trainer.pull_count < TEARS ? "{left} to go" : "press N and type the force", figures);
}

/* Against the mean of what has torn, and against the law. */
static nt_status pull_off_answer(nt_session_host *host, double value)
{
    const nt_trainer *trainer = &host->trainer;
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    pull_off_figures(host, figures);
    if (trainer->pull_count < TEARS)
        return nt_trainer_early(host, "{left} pull-offs are missing", figures);
    double mean = 0.0;
    for (int i = 0; i < trainer->pull_count; ++i)
        mean += trainer->pulls[i] / trainer->pull_count;
    const double error = mean > 0.0 ? fabs(fabs(value) - mean) / mean : (double)INFINITY,
                 law = host->plan.pull_off_force;
    nt_trainer_measure(host, "answer", "N", fabs(value));
    nt_trainer_measure(host, "measured", "N", mean);
    nt_trainer_measure(host, "law", "N", law);
    nt_trainer_measure(host, "error", "", error);
    nt_trainer_finish(
        host, error <= CLOSE, 100.0 * (1.0 - error), "you say {answer}; it tore at {mean}; the law of a flat has {law}",
        (const nt_figure[]){{"answer", fabs(value), "N", 0}, {"mean", mean, "N", 0}, {"law", law, "N", 0}, {0}});
    return NT_OK;
}

/* What the chart shows as the deepest pull since a time. */
static double deepest_since(const nt_trainer *trainer, double time)
{
    double low = 0.0;
    for (int i = 0; i < trainer->trace_count; ++i)
        if (trainer->trace[i].time >= time)
            low = fmin(low, trainer->trace[i].low);
    return low;
}

/* Touch and tear; say the mean of the deepest pulls that were seen. */
static void pull_off_solve(nt_operator *op)
{
    double sum = 0.0;
    for (int i = 0; i < TEARS; ++i) {
        const double pressed = nt_operator_down_to(op, 0.05 * load_of(op->host))->time;
        nt_operator_up(op);
        sum -= deepest_since(&op->host->trainer, pressed);
    }
    nt_operator_ask(op, "say", sum / TEARS, 0.0, 0.0);
}

const nt_task nt_task_pull_off = {
    .about = {"pull_off", "Measure a pull-off", "silicon_in_air", "N", "", NT_HOST_NOTHING, 0},
    .hides = "law",
    .choices = "",
    .words = "Touch and tear {needed} times. Read the largest pull on the tip from the bars or the chart. Then press N "
             "and type it with its unit, as 12nN.",
    .judge = pull_off_judge,
    .now = pull_off_now,
    .figures = pull_off_figures,
    .answer = pull_off_answer,
    .solve = pull_off_solve};
