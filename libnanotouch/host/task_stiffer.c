/* SPDX-License-Identifier: BSD-3-Clause
 * Tell the stiffer of two samples, which differ in their modulus alone: the smallest difference that is felt, by a
 * staircase. No answer is said to be right or wrong before the end. */
#include <math.h>

#include "host/state.h"

static const double LOAD = 0.4;  /* of the max one: where stiffness is told */
static const double DULL = 0.5;  /* the sample is stiffer than the lever if less than this part of 2/3 is felt */
static const double GOOD = 0.15; /* Weber fraction of stiffness that people have at worst */
static const double BEST = 0.05;

static double load_of(const nt_session_host *host)
{
    return LOAD * nt_session_setup_of(host->session)->scene.range.maximum_load;
}

/* k_i of the contact and the spring, one after the other, the modulus so many times as high [N/m]. */
static double felt_stiffness(nt_session_host *host, double ratio)
{
    const nt_plan *plan = nt_law_with(host, "sample.youngs_modulus", ratio * host->trainer.modulus);
    const double k = plan ? nt_law_stiffness(plan, load_of(host)) : (double)NAN, spring = host->hand.stiffness;
    return k * spring / (k + spring);
}

/* d ln k/d ln E = 2/3 k_c/(k_c + k_i): what of a change of the modulus is felt, 2/3 at most (Hertz). */
static double felt_share(nt_session_host *host)
{
    return 2.0 / 3.0 * (1.0 - felt_stiffness(host, 1.0) / host->hand.stiffness);
}

static nt_status show(nt_session_host *host, char letter)
{
    nt_trainer *trainer = &host->trainer;
    const double half = sqrt(nt_staircase_ratio(&trainer->stairs));
    trainer->shown = letter;
    return nt_host_set(host, "sample.youngs_modulus",
                       trainer->modulus * (letter == trainer->wanted ? half : 1.0 / half));
}

static nt_status deal(nt_session_host *host)
{
    host->trainer.wanted = nt_random_uniform(&host->trainer.random) < 0.5 ? 'A' : 'B';
    return show(host, 'A');
}

static nt_status begin(nt_session_host *host)
{
    host->trainer.stairs = nt_staircase_begin(3.0, 1.02, 10.0, 8);
    host->trainer.modulus = nt_session_setup_of(host->session)->scene.sample.youngs_modulus;
    host->trainer.target = felt_share(host);
    return deal(host);
}

static void figures_of(nt_session_host *host, nt_figure *figures)
{
    const double share = host->trainer.target;
    figures[0] = (nt_figure){"felt", 0.1 * share, "%.1", 0};
    figures[1] = (nt_figure){"dull", 0.0, NULL,
                             share < DULL * 2.0 / 3.0
                                 ? " This sample is stiffer than the lever: all such samples feel like the lever."
                                 : ""};
}

static void now(nt_session_host *host, nt_text *text)
{
    const char letter[] = {host->trainer.shown, '\0'};
    nt_text_fill(
        text, "sample {shown} lies under the tip; pair {pair}",
        (const nt_figure[]){{"shown", 0.0, NULL, letter}, {"pair", host->trainer.stairs.trials + 1, "#", 0}, {0}});
}

/* Weber fractions: of the modulus, and of what is felt through the spring. */
static void finish(nt_session_host *host)
{
    const nt_trainer *trainer = &host->trainer;
    const double ratio = nt_staircase_threshold(&trainer->stairs), half = sqrt(ratio);
    const double felt = felt_stiffness(host, half) / felt_stiffness(host, 1.0 / half) - 1.0;
    int right = 0;
    for (int i = 0; i < trainer->trial_count; ++i)
        right += trainer->trials[i].wanted == trainer->trials[i].answer;
    nt_trainer_measure(host, "Weber fraction of the modulus", "", ratio - 1.0);
    nt_trainer_measure(host, "Weber fraction of felt stiffness", "", felt);
    nt_trainer_measure(host, "d ln k/d ln E", "", trainer->target);
    nt_trainer_measure(host, "right answers", "", (double)right / trainer->trial_count);
    nt_trainer_finish(
        host, felt <= GOOD, 100.0 * fmin(1.0, BEST / fmax(felt, 1e-9)),
        "told apart ({right} % right) at {modulus} % of the modulus, {stiffness} % of the felt stiffness; "
        "people have 9 to 15 % of stiffness",
        (const nt_figure[]){{"right", NT_STAIRCASE_RIGHT, "%", 0},
                            {"modulus", ratio - 1.0, "%", 0},
                            {"stiffness", felt, "%.1", 0},
                            {0}});
    (void)nt_host_set(host, "sample.youngs_modulus", trainer->modulus);
}

static nt_status choose(nt_session_host *host, int number)
{
    return nt_trainer_compare(host, &(nt_comparison){show, deal, finish}, number);
}

/* How deep the sample gives way under a force, on the way to a larger one. */
static double depth_at(nt_operator *op, double force)
{
    const nt_frame *frame = nt_operator_wheel(op, 0.0);
    double before[2] = {-INFINITY, 0.0}, depth = 0.0;
    while (nt_operator_goes_on(op) && frame->tip_force[NT_Z] < force / 0.9) {
        const double lacks = (force / 0.9 - frame->tip_force[NT_Z]) / load_of(op->host);
        frame = nt_operator_wheel(op, nt_frame_touches(frame) ? fmin(1.0, 0.1 + 8.0 * lacks) : 0.3);
        const double now_at[2] = {frame->tip_force[NT_Z], -frame->gap};
        if (before[0] < force && now_at[0] >= force)
            depth =
                now_at[1] -
                (isfinite(before[0]) ? (now_at[0] - force) / (now_at[0] - before[0]) * (now_at[1] - before[1]) : 0.0);
        before[0] = now_at[0];
        before[1] = now_at[1];
    }
    return depth;
}

/* Which one gives way less under the same force. */
static void solve(nt_operator *op)
{
    while (nt_operator_goes_on(op)) {
        double depth[2];
        for (int sample = 0; sample < 2; ++sample) {
            nt_operator_ask(op, "choose", sample, 0.0, 0.0);
            depth[sample] = depth_at(op, 0.9 * load_of(op->host));
            nt_operator_up(op);
        }
        nt_operator_ask(op, "choose", depth[0] < depth[1] ? 2 : 3, 0.0, 0.0);
    }
}

const nt_task nt_task_stiffer = {
    .about = {"stiffer", "Tell the stiffer of two samples", "cell_in_liquid", "", "", NT_HOST_NOTHING, 0},
    .hides = "contact|law|sliders",
    .trials = "pair,ratio of moduli,stiffer,answer,right",
    .choices = "lay A|lay B|A is stiffer|B is stiffer",
    .words = "Press on A, lift, press on B. Which one is stiffer? Of 10 % of the modulus {felt} % are felt.{dull}",
    .begin = begin,
    .now = now,
    .figures = figures_of,
    .choose = choose,
    .solve = solve};
