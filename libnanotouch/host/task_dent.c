/* SPDX-License-Identifier: BSD-3-Clause
 * Leave a dent of a depth that is asked for, in a sample that yields; and scratch a groove. The depth that stays is
 * what counts: less than how far the tip went down. */
#include <math.h>

#include "host/state.h"

static const double LEAST = 0.3, MOST = 0.8;  /* of the max load: between these lies the one that makes what is asked */
static const double ALLOWED = 0.15;           /* error of the residual depth, relative */
static const double GROOVE = 0.3, LONG = 0.1; /* of the width: the groove's length; its error, relative */

static int is_scratch(const nt_session_host *host)
{
    return host->trainer.task == &nt_task_scratch;
}

static double load_of(const nt_session_host *host)
{
    return nt_session_setup_of(host->session)->scene.range.maximum_load;
}

static double length_of(const nt_imprint *imprint)
{
    return hypot(imprint->end[0] - imprint->start[0], imprint->end[1] - imprint->start[1]);
}

/* The newest dent, or the newest groove; NULL: none. */
static const nt_imprint *newest(const nt_session_host *host)
{
    for (int i = host->left.count - 1; i >= 0; --i)
        if ((length_of(&host->left.dents[i].imprint) > 0.0) == is_scratch(host))
            return &host->left.dents[i].imprint;
    return NULL;
}

static nt_status begin(nt_session_host *host)
{
    nt_trainer *trainer = &host->trainer;
    if (host->plan.history != NT_HISTORY_DENTS)
        return nt_host_refuse_filled(host, "task {name}: this sample keeps no dents; lay {preset}",
                                     (const nt_figure[]){{"name", 0.0, NULL, trainer->task->about.name},
                                                         {"preset", 0.0, NULL, trainer->task->about.preset},
                                                         {0}});
    const double load = (LEAST + (MOST - LEAST) * nt_random_uniform(&trainer->random)) * load_of(host);
    const nt_indentation *law = &host->plan.indentation;
    trainer->target = nt_indentation_first(law, nt_indentation_radius_at_load(law, load)).residual_depth;
    return NT_OK;
}

static void figures_of(nt_session_host *host, nt_figure *figures)
{
    figures[0] = (nt_figure){"depth", host->trainer.target, "2 m", 0};
    figures[1] = (nt_figure){"length", GROOVE * host->width, "2 m", 0};
}

static void now(nt_session_host *host, nt_text *text)
{
    const nt_imprint *made = newest(host);
    nt_text_fill(text, made ? "the newest one is {depth} deep" : "nothing is left yet",
                 (const nt_figure[]){{"depth", made ? made->depth : 0.0, "m", 0}, {0}});
}

static void judge(nt_session_host *host, const nt_frame *frame)
{
    if (nt_frame_touches(frame))
        host->trainer.deepest = fmax(host->trainer.deepest, -frame->tip_position[NT_Z]);
    host->trainer.max_force = fmax(host->trainer.max_force, frame->tip_force[NT_Z]);
}

/* Of a dent the depth alone; of a groove the worse of depth and length is the score. */
static nt_status choose(nt_session_host *host, int number)
{
    (void)number;
    const nt_trainer *trainer = &host->trainer;
    const nt_imprint *made = newest(host);
    if (trainer->touches)
        return nt_trainer_early(host, "lift the tip first", NULL);
    if (!made)
        return nt_trainer_early(host, "nothing is left yet", NULL);
    const double error = fabs(made->depth - trainer->target) / trainer->target, wanted = GROOVE * host->width;
    const double off = is_scratch(host) ? fabs(length_of(made) - wanted) / wanted : 0.0;
    nt_trainer_measure(host, "residual depth", "m", made->depth);
    nt_trainer_measure(host, "asked", "m", trainer->target);
    nt_trainer_measure(host, "error", "", error);
    nt_trainer_measure(host, "depth reached", "m", trainer->deepest);
    nt_trainer_measure(host, "largest force", "N", trainer->max_force);
    if (is_scratch(host)) {
        nt_trainer_measure(host, "length", "m", length_of(made));
        nt_trainer_measure(host, "error of the length", "", off);
    }
    nt_trainer_finish(host, error <= ALLOWED && off <= LONG, 100.0 * (1.0 - fmax(error, off)),
                      is_scratch(host) ? "it is {depth} deep, asked were {asked}; the tip went down by {reached}; "
                                         "{length} long, asked were {wanted}"
                                       : "it is {depth} deep, asked were {asked}; the tip went down by {reached}",
                      (const nt_figure[]){{"depth", made->depth, "m", 0},
                                          {"asked", trainer->target, "m", 0},
                                          {"reached", trainer->deepest, "m", 0},
                                          {"length", length_of(made), "m", 0},
                                          {"wanted", wanted, "m", 0},
                                          {0}});
    return NT_OK;
}

static int is_shallow(const nt_operator *op, double enough)
{
    const nt_imprint *made = newest(op->host);
    return nt_operator_goes_on(op) && (!made || made->depth < enough * op->host->trainer.target);
}

/* Press a little harder each time, in the same place, until what stays is deep enough. */
static void dent_solve(nt_operator *op)
{
    for (double force = 0.1 * load_of(op->host); is_shallow(op, 0.95); force *= 1.05) {
        (void)nt_operator_down_to(op, force);
        nt_operator_up(op);
    }
    nt_operator_ask(op, "choose", 0.0, 0.0, 0.0);
}

/* Grooves beside each other, each under a larger force, until one is deep enough. */
static void scratch_solve(nt_operator *op)
{
    enum { PIECES = 60 };
    const double length = GROOVE * op->host->width;
    for (double force = 0.08 * load_of(op->host); is_shallow(op, 0.93); force *= 1.1) {
        (void)nt_operator_down_to(op, force);
        for (int i = 0; i < PIECES; ++i) {
            nt_operator_ask(op, "move", length / PIECES, 0.0, 0.0);
            (void)nt_operator_wait(op, 0.02);
        }
        nt_operator_up(op);
        nt_operator_ask(op, "move", -length, 0.12 * op->host->width, 0.0);
        (void)nt_operator_wait(op, 0.3);
    }
    nt_operator_ask(op, "choose", 0.0, 0.0, 0.0);
}

const nt_task nt_task_dent = {
    .about = {"dent", "Leave a dent of a depth", "soft_gold", "", "", NT_HOST_NOTHING, 0},
    .hides = "",
    .choices = "measure it",
    .words =
        "Press, let go, and leave a dent that is {depth} deep when the tip is away. It is less deep than you press. "
        "You may press again in the same dent, or elsewhere; the newest one counts.",
    .begin = begin,
    .judge = judge,
    .now = now,
    .figures = figures_of,
    .choose = choose,
    .solve = dent_solve};

const nt_task nt_task_scratch = {
    .about = {"scratch", "Scratch a groove", "soft_gold", "", "", NT_HOST_NOTHING, 0},
    .hides = "",
    .choices = "measure it",
    .words =
        "Press and draw the tip in a straight line of {length}, so that a groove of {depth} stays. The newest groove "
        "counts.",
    .begin = begin,
    .judge = judge,
    .now = now,
    .figures = figures_of,
    .choose = choose,
    .solve = scratch_solve};
