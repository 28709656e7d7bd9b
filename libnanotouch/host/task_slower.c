/* SPDX-License-Identifier: BSD-3-Clause
 * Find the slower of two samples, which differ in their relaxation time alone: the smallest difference that is felt, by
 * a staircase. No answer is said to be right or wrong before the end. */
#include <math.h>

#include "host/state.h"

static const char *const FIELD = "rheology.relaxation_time_1";
static const double GOOD = 1.0; /* told apart at twice the time */
static const double BEST = 0.1;

static nt_status show(nt_session_host *host, char letter)
{
    nt_trainer *trainer = &host->trainer;
    const double half = sqrt(nt_staircase_ratio(&trainer->stairs));
    trainer->shown = letter;
    return nt_host_set(host, FIELD, trainer->own * (letter == trainer->wanted ? half : 1.0 / half));
}

static nt_status deal(nt_session_host *host)
{
    host->trainer.wanted = nt_random_uniform(&host->trainer.random) < 0.5 ? 'A' : 'B';
    return show(host, 'A');
}

static nt_status begin(nt_session_host *host)
{
    nt_trainer *trainer = &host->trainer;
    const nt_scene *scene = &nt_session_setup_of(host->session)->scene;
    if (host->plan.history != NT_HISTORY_RELAXES || scene->rheology.kind == NT_RHEOLOGY_POWER_LAW)
        return nt_host_refuse_filled(host, "task {name}: this sample has no relaxation time; lay {preset}",
                                     (const nt_figure[]){{"name", 0.0, NULL, trainer->task->about.name},
                                                         {"preset", 0.0, NULL, trainer->task->about.preset},
                                                         {0}});
    trainer->stairs = nt_staircase_begin(4.0, 1.05, 10.0, 8);
    trainer->own = scene->rheology.relaxation_times[0];
    return deal(host);
}

static void figures_of(nt_session_host *host, nt_figure *figures)
{
    figures[0] = (nt_figure){"time", host->trainer.own, "2 s", 0};
}

static void now(nt_session_host *host, nt_text *text)
{
    const char letter[] = {host->trainer.shown, '\0'};
    nt_text_fill(
        text, "sample {shown} lies under the tip; pair {pair}",
        (const nt_figure[]){{"shown", 0.0, NULL, letter}, {"pair", host->trainer.stairs.trials + 1, "#", 0}, {0}});
}

static void finish(nt_session_host *host)
{
    const nt_trainer *trainer = &host->trainer;
    const double weber = nt_staircase_threshold(&trainer->stairs) - 1.0;
    int right = 0;
    for (int i = 0; i < trainer->trial_count; ++i)
        right += trainer->trials[i].wanted == trainer->trials[i].answer;
    nt_trainer_measure(host, "Weber fraction of the relaxation time", "", weber);
    nt_trainer_measure(host, "relaxation time", "s", trainer->own);
    nt_trainer_measure(host, "right answers", "", (double)right / trainer->trial_count);
    nt_trainer_finish(host, weber <= GOOD, 100.0 * fmin(1.0, BEST / fmax(weber, 1e-9)),
                      "told apart ({right} % right) where one takes {more} % longer than the other",
                      (const nt_figure[]){{"right", NT_STAIRCASE_RIGHT, "%", 0}, {"more", weber, "%", 0}, {0}});
    (void)nt_host_set(host, FIELD, trainer->own);
}

static nt_status choose(nt_session_host *host, int number)
{
    return nt_trainer_compare(host, &(nt_comparison){show, deal, finish}, number);
}

/* Push quickly, hold still, and see what part of the force is left. */
static double force_left(nt_operator *op)
{
    const double push = 20.0, rise = 0.06, hold = 0.2; /* [steps of the wheel], [s], [s] */
    const nt_frame *frame = nt_operator_wheel(op, 0.0);
    while (nt_operator_goes_on(op) && !nt_frame_touches(frame))
        frame = nt_operator_wheel(op, 0.3);
    nt_operator_ask(op, "wheel", push, 0.0, 0.0);
    const double pushed = nt_operator_wait(op, rise)->tip_force[NT_Z];
    return nt_operator_wait(op, hold)->tip_force[NT_Z] / pushed;
}

static void solve(nt_operator *op)
{
    while (nt_operator_goes_on(op)) {
        double left[2];
        for (int sample = 0; sample < 2; ++sample) {
            nt_operator_ask(op, "choose", sample, 0.0, 0.0);
            left[sample] = force_left(op);
            nt_operator_up(op);
        }
        nt_operator_ask(op, "choose", left[0] > left[1] ? 2 : 3, 0.0, 0.0);
    }
}

const nt_task nt_task_slower = {
    .about = {"slower", "Find the slower of two samples", "chondrocyte", "", "", NT_HOST_NOTHING, 0},
    .hides = "contact|law|sliders",
    .trials = "pair,ratio of relaxation times,slower,answer,right",
    .choices = "lay A|lay B|A is slower|B is slower",
    .words = "Push quickly into A, hold still, and feel the force fall; lift, and do the same on B. Which one takes "
             "longer? Both are as stiff at once and in the end; the time is around {time}.",
    .begin = begin,
    .now = now,
    .figures = figures_of,
    .choose = choose,
    .solve = solve};
