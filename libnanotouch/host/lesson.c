/* SPDX-License-Identifier: BSD-3-Clause
 * The lesson: five pages from van der Waals to Maugis' map, each predict, touch, explain. A prediction unlocks the
 * touch; after it, and after a second one where something is changed, it explains. What is right is what the simulation
 * says, not a table. */
#include <math.h>
#include <string.h>

#include "host/lesson.h"
#include "host/state.h"

static const double SAME = 0.02; /* a change of less than this is none */
static const double SOFTER = 0.25, STIFFER = 20.0;

/* 0, 1, 2: smaller, the same, larger. */
static int way(double before, double after)
{
    return fabs(after - before) <= SAME * fabs(before) ? 1 : after > before ? 2 : 0;
}

static int right_jump(nt_session_host *host, nt_figure *figures)
{
    const double stiff = host->hand.stiffness, soft = SOFTER * stiff;
    const double near = nt_law_jump_gap(&host->plan, stiff), far = nt_law_jump_gap(&host->plan, soft);
    figures[0] = (nt_figure){"stiff", stiff, "N/m", 0};
    figures[1] = (nt_figure){"soft", soft, "N/m", 0};
    figures[2] = (nt_figure){"near", near, "m", 0};
    figures[3] = (nt_figure){"far", far, "m", 0};
    return way(near, far);
}

static int right_stick(nt_session_host *host, nt_figure *figures)
{
    const nt_plan *plan = nt_law_with(host, "medium.relative_humidity", 0.0);
    const double wet = host->plan.pull_off_force, dry = plan ? plan->pull_off_force : (double)NAN;
    figures[0] = (nt_figure){"wet", wet, "N", 0};
    figures[1] = (nt_figure){"dry", dry, "N", 0};
    return way(wet, dry);
}

/* The sample of this page has lost its adhesion; the explanation has that of its own. */
static int right_deep(nt_session_host *host, nt_figure *figures)
{
    static const double ratios[] = {1.4142135623730951, 1.5874010519681994, 2.0};
    const double load = 0.4 * nt_session_setup_of(host->session)->scene.range.maximum_load;
    const double ratio = nt_law_depth(&host->plan, 2.0 * load) / nt_law_depth(&host->plan, load);
    const nt_plan *sticky = nt_law_with(host, "adhesion.work_of_adhesion", host->trainer.own);
    int best = 0;
    for (int i = 1; i < 3; ++i)
        if (fabs(log(ratios[i] / ratio)) < fabs(log(ratios[best] / ratio)))
            best = i;
    figures[0] = (nt_figure){"ratio", ratio, "", 0};
    figures[1] = (nt_figure){"radius", sticky ? nt_law_resting_radius(sticky) : (double)NAN, "m", 0};
    return best;
}

static int right_sticky(nt_session_host *host, nt_figure *figures)
{
    const double modulus = nt_session_setup_of(host->session)->scene.sample.youngs_modulus;
    const nt_plan *plan = nt_law_with(host, "sample.youngs_modulus", STIFFER * modulus);
    const double soft = host->plan.lambda, stiff = plan ? plan->lambda : (double)NAN;
    figures[0] = (nt_figure){"soft", soft, "", 0};
    figures[1] = (nt_figure){"stiff", stiff, "", 0};
    return way(soft, stiff);
}

/* With the paper's rig, whose master has a motor. */
static int right_felt(nt_session_host *host, nt_figure *figures)
{
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    const double stiffness = host->plan.maximum_stiffness;
    const double before = nt_margins_compute(&rig, &settings.gains, stiffness).margin;
    settings.gains.alpha_f *= 0.5;
    const double after = nt_margins_compute(&rig, &settings.gains, stiffness).margin;
    figures[0] = (nt_figure){"before", before, "", 0};
    figures[1] = (nt_figure){"after", after, "", 0};
    return way(before, after);
}

static nt_status begin(nt_session_host *host)
{
    const nt_page *page = host->trainer.task->page;
    nt_host_kind kind;
    if (!page->change)
        return NT_OK;
    const nt_field *field = nt_host_field(page->change, &kind);
    host->trainer.own = nt_field_get(field, nt_host_described(host, kind));
    return nt_host_set(host, page->change, page->to);
}

static void now(nt_session_host *host, nt_text *text)
{
    const nt_trainer *trainer = &host->trainer;
    nt_text_add(text, trainer->predicted < 0    ? "First say what you expect. Then you may touch."
                      : trainer->pull_count > 0 ? "Now it is changed. Touch and let go once more."
                                                : "Touch and let go.");
}

/* The answer is found before anything is changed between the touches. */
static nt_status choose(nt_session_host *host, int number)
{
    nt_trainer *trainer = &host->trainer;
    if (trainer->predicted >= 0)
        return nt_trainer_early(host, "touch and let go first", NULL);
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    nt_text said = nt_text_in(trainer->said, sizeof trainer->said);
    const int right = trainer->task->page->right(host, figures);
    trainer->predicted = number;
    trainer->passed = number == right;
    if (trainer->passed) {
        nt_text_add(&said, "You were right. ");
    } else {
        char wanted[NT_HOST_LINE] = {0};
        const char *words = trainer->task->choices;
        for (int skip = right; skip > 0; --skip)
            words = strchr(words, '|') + 1;
        memcpy(wanted, words, strcspn(words, "|"));
        nt_text_fill(&said, "You expected something else: {wanted}. ",
                     (const nt_figure[]){{"wanted", 0.0, NULL, wanted}, {0}});
    }
    nt_text_fill(&said, trainer->task->page->explain, figures);
    return NT_OK;
}

static void explain(nt_session_host *host)
{
    nt_trainer *trainer = &host->trainer;
    char said[NT_HOST_LINE];
    nt_text text = nt_text_in(said, sizeof said);
    nt_text_add(&text, trainer->said);
    if (trainer->task->page->measures)
        nt_text_add(&text, " You measured {first} before and {second} after the change.");
    static const char *const names[] = {"pull-off 1", "pull-off 2"};
    for (int i = 0; i < trainer->pull_count && i < 2; ++i)
        nt_trainer_measure(host, names[i], "N", trainer->pulls[i]);
    nt_trainer_finish(
        host, trainer->passed, 100.0 * trainer->passed, said,
        (const nt_figure[]){{"first", trainer->pulls[0], "N", 0}, {"second", trainer->pulls[1], "N", 0}, {0}});
}

static void change(nt_session_host *host)
{
    const nt_page *page = host->trainer.task->page;
    nt_host_kind kind;
    const nt_field *field = nt_host_field(page->then, &kind);
    (void)nt_host_set(host, page->then, page->factor * nt_field_get(field, nt_host_described(host, kind)));
}

/* Counts touches; between the first and the second the world is changed. */
static void judge(nt_session_host *host, const nt_frame *frame)
{
    nt_trainer *trainer = &host->trainer;
    const int touches = nt_frame_touches(frame), needed = trainer->task->page->then ? 2 : 1;
    if (trainer->predicted < 0)
        return;
    trainer->low = trainer->touches || touches ? fmin(trainer->low, frame->tip_force[NT_Z]) : 0.0;
    if (!trainer->touches || touches)
        return;
    trainer->pulls[trainer->pull_count++] = -trainer->low;
    trainer->low = 0.0;
    if (trainer->pull_count >= needed)
        explain(host);
    else
        change(host);
}

/* Predicts what it does not know, and touches. */
static void solve(nt_operator *op)
{
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    const double load = nt_session_setup_of(op->host->session)->scene.range.maximum_load;
    nt_operator_ask(op, "choose", op->host->trainer.task->page->right(op->host, figures), 0.0, 0.0);
    while (nt_operator_goes_on(op)) {
        (void)nt_operator_down_to(op, 0.1 * load);
        nt_operator_up(op);
    }
}

static const nt_page jump = {
    .action = "Go down slowly by the wheel with shift. Watch the orange line meet the curve.",
    .explain =
        "The tip jumps where attraction grows faster with nearness than the spring can pull back: where the line "
        "touches the curve. With {stiff} that is at {near}, with {soft} at {far}.",
    .right = right_jump,
    .then = "gains.coupling_stiffness",
    .factor = 0.2};
static const nt_page stick = {
    .action = "Press lightly, then pull up until it tears.",
    .explain = "The neck of water pulls with 4 pi R gamma cos(theta), whatever its size. Without water only the solids "
               "hold each other. The law has {wet} in humid and {dry} in dry air. Both grow as the radius.",
    .right = right_stick,
    .then = "medium.relative_humidity",
    .factor = 0.0,
    .measures = 1};
static const nt_page deep = {
    .action = "Press by the space bar and let go. There is no adhesion yet.",
    .explain =
        "Hertz: the contact grows with the depth, so F ~ depth^1.5 and the depth grows as F^(2/3): {ratio} times. "
        "With the rubber's own adhesion the contact at zero load has a radius of {radius}; without it, none.",
    .right = right_deep,
    .change = "adhesion.work_of_adhesion",
    .to = 0.0};
static const nt_page sticky = {
    .action = "Press, then pull slowly. Look how far retraction lies behind approach.",
    .explain = "Tabor's number compares how far adhesion draws up the surface with how far it reaches; lambda is 1.16 "
               "times it and falls as E^(-2/3): from {soft} to {stiff}. Below 0.1 it is DMT, above 5 JKR.",
    .right = right_sticky,
    .then = "sample.youngs_modulus",
    .factor = 20.0};
static const nt_page felt = {
    .action = "Touch, and watch the force at the hand.",
    .explain = "The loop meets the contact's stiffness times the scale. With the paper's device the margin goes from "
               "{before} to {after}. Force gain and scale act as one product: so K_f cannot be any number.",
    .right = right_felt,
    .then = "gains.alpha_f",
    .factor = 0.5};

#define PAGE(NAME, TITLE, PRESET, NEXT, PAGE_OF, QUESTION, CHOICES)                                                    \
    {.about = {NAME, TITLE, PRESET, "", NEXT, NT_HOST_NOTHING, 1},                                                     \
     .hides = "",                                                                                                      \
     .choices = CHOICES,                                                                                               \
     .words = QUESTION,                                                                                                \
     .begin = begin,                                                                                                   \
     .judge = judge,                                                                                                   \
     .now = now,                                                                                                       \
     .choose = choose,                                                                                                 \
     .solve = solve,                                                                                                   \
     .page = PAGE_OF}

const nt_task nt_task_pages[5] = {
    PAGE("lesson-1", "1 Why does it jump?", "mica_in_air", "lesson-2", &jump,
         "Attraction grows the nearer the tip comes. A spring holds the tip. The spring becomes four times as soft: "
         "where "
         "does the tip jump in now?",
         "nearer to the surface|at the same height|further away"),
    PAGE(
        "lesson-2", "2 Why does it stick?", "silicon_in_air", "lesson-3", &stick,
        "In humid air water condenses between tip and sample. The air is dried. What becomes of the force at which the "
        "tip tears off?",
        "it becomes smaller|it stays|it becomes larger"),
    PAGE("lesson-3", "3 How deep am I?", "silicone_rubber", "lesson-4", &deep,
         "A ball without adhesion is pressed into rubber. The load doubles. How much deeper is it?",
         "1.41 times|1.59 times|2 times"),
    PAGE("lesson-4", "4 Soft or sticky?", "silicone_rubber", "lesson-5", &sticky,
         "Soft rubber is drawn up into a neck before it lets go: JKR. The rubber becomes 20 times as stiff. Where does "
         "it "
         "go on Maugis' map?",
         "towards DMT|nowhere|further into JKR"),
    PAGE("lesson-5", "5 What would a hand feel?", "silicon_in_air", "", &felt,
         "A motor shows your hand the force on the tip, some million times larger. That scale is halved. What becomes "
         "of "
         "the margin to instability?",
         "it halves|it stays|it doubles"),
};

/* Of a menu; it begins with the first page. */
const nt_task nt_task_lesson = {
    .about = {"lesson", "Lesson: predict, touch, explain", "mica_in_air", "", "", NT_HOST_NOTHING, 0}};
