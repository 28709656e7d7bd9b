/* SPDX-License-Identifier: BSD-3-Clause
 * A session as a person touches it: what is asked of it, and what happens by itself (host.h). */
#include <math.h>
#include <string.h>

#include "host/state.h"
#include "internal/host.h"
#include "internal/session.h"

static const double MAX_SEED = 9007199254740992.0; /* whole numbers that a double holds */
static const char *const STOPS = "The hand stops here: the force limit is near.";

size_t nt_host_size(void)
{
    return sizeof(nt_session_host);
}

nt_session_host *nt_host_init(void *memory)
{
    nt_session_host *host = memset(memory, 0, sizeof(nt_session_host));
    nt_left_forget(host);
    return host;
}

const void *nt_host_described(const nt_session_host *host, nt_host_kind kind)
{
    const nt_session_setup *setup = nt_session_setup_of(host->session);
    const void *const of[] = {&setup->scene, &setup->rig, &setup->settings};
    return of[kind];
}

int nt_frame_touches(const nt_frame *frame)
{
    return frame->contact_radius > 0.0 || frame->gap < 0.0; /* a brush keeps bodies apart, further down than they are */
}

/* --- the session --- */

static void copy(char *to, size_t size, const char *from)
{
    nt_text text = nt_text_in(to, size);
    nt_text_add(&text, from ? from : "");
}

void nt_host_lay(nt_session_host *host, const nt_host_subject *subject)
{
    copy(host->name, sizeof host->name, subject->name);
    copy(host->title, sizeof host->title, subject->title);
    copy(host->hint, sizeof host->hint, subject->hint);
    copy(host->source, sizeof host->source, subject->source);
    copy(host->said, sizeof host->said, subject->said);
    host->width = subject->width;
    host->height = subject->height;
    host->pushed = subject->pushed;
    host->done_count = host->undone_count = host->kept_count = host->reopens = host->is_laid = 0;
    host->slider_count = 0;
    host->guide.touched = 0;
    nt_trainer_end(host);
}

void nt_host_close(nt_session_host *host)
{
    host->session = NULL;
    host->has_frame = 0;
}

static nt_proxy hand_of(nt_session_host *host)
{
    const nt_session_setup *setup = nt_session_setup_of(host->session);
    const nt_gains *gains = &setup->settings.gains;
    const double limit = setup->settings.limits.force;
    const nt_proxy_facts facts = {.alpha_p = gains->alpha_p,
                                  .alpha_f = gains->alpha_f,
                                  .coupling = gains->coupling_stiffness,
                                  .lever = setup->rig.probe.spring_constant,
                                  .travel = setup->rig.master.travel,
                                  .resolution = setup->rig.master.resolution,
                                  .axes = (int)setup->rig.master.axes,
                                  .clearance = setup->clearance,
                                  .pull_off = host->plan.pull_off_force,
                                  .load = setup->scene.range.maximum_load,
                                  .limit = limit,
                                  .indentation = host->plan.largest_indentation,
                                  .sunk = host->plan.history == NT_HISTORY_RELAXES
                                              ? (double)NAN
                                              : nt_law_depth(&host->plan, NT_PROXY_LOAD * limit),
                                  .start_height = nt_session_start_height(host->session),
                                  .held = nt_session_master_start(host->session),
                                  .x = setup->x,
                                  .y = setup->y,
                                  .width = host->width,
                                  .height = host->height};
    return nt_proxy_begin(&facts);
}

static nt_host_bounds bounds_of(const nt_session *session)
{
    const nt_session_setup *setup = nt_session_setup_of(session);
    const nt_plan *plan = nt_session_plan(session);
    nt_margins margins;
    const nt_verdict verdict =
        nt_margins_judge(&setup->rig, &setup->settings, plan->maximum_stiffness, setup->mode, &margins);
    return (nt_host_bounds){plan->bound.force_error, verdict.margin, nt_session_guarantee(session).force,
                            nt_session_motor_bound(session).force};
}

nt_status nt_host_learn(nt_session_host *host)
{
    const nt_session_setup *setup = nt_session_setup_of(host->session);
    const nt_plan_inputs inputs = {.scene = &setup->scene, .demand = &setup->demand};
    const nt_status status = nt_plan_make(&host->plan, &inputs, NULL);
    const nt_proxy before = host->hand;
    host->hand = hand_of(host);
    if (before.facts.alpha_p > 0.0) { /* the hand stays where it is */
        memcpy(host->hand.place, before.place, sizeof before.place);
        host->hand.height = before.height;
        host->hand.presses = before.presses;
        host->hand.aimed_at = before.aimed_at;
    }
    const nt_proxy *now = &host->hand;
    if (before.stiffness != now->stiffness || before.zero != now->zero || before.facts.load != now->facts.load)
        nt_energy_begin(host);
    host->bounds = bounds_of(host->session);
    nt_recovery_learn(host);
    host->due |= NT_DUE_WORLD | NT_DUE_GUIDE;
    return status;
}

nt_status nt_host_open(nt_session_host *host, nt_session *session)
{
    host->session = session;
    host->has_frame = 0;
    host->hand = (nt_proxy){0};
    host->event = (nt_host_event){.told = -INFINITY};
    nt_left_forget(host);
    nt_recovery_forget(host);
    const nt_status status = nt_host_learn(host);
    if (!host->is_laid)
        host->meant = nt_session_setup_of(session)->scene;
    host->is_laid = 1;
    nt_host_settle(host);
    if (!host->slider_count) {
        const nt_session_setup *setup = nt_session_setup_of(session);
        host->slider_count = nt_host_sliders(&setup->scene, &setup->rig, &setup->settings, host->sliders);
        host->due |= NT_DUE_SLIDERS;
    }
    nt_left_look(host);
    host->due |= host->plan.history == NT_HISTORY_DENTS ? NT_DUE_DENTS : 0u;
    if (host->wants[0]) {
        host->wants[0] = '\0';
        (void)nt_host_ask_task(host, &(nt_host_asked){"task", host->waits, {0.0, host->seed, 0.0}});
    }
    return status;
}

void nt_host_aim(nt_session_host *host)
{
    if (!host->hand.aims)
        return;
    host->hand.aims = 0;
    const double *place = host->hand.place;
    const nt_input input = {.holds = 1,
                            .master_position = {place[0], place[1], place[2]},
                            .x = (double)NAN,
                            .y = (double)NAN,
                            .duration = NT_PROXY_GLIDE};
    nt_problem problem = {0};
    const nt_status status = nt_session_aim(host->session, &input, &problem);
    if (status != NT_OK)
        nt_host_refuse(host, nt_status_message(status));
}

void nt_host_see(nt_session_host *host, const nt_frame *frames, long count)
{
    for (long i = 0; i < count; ++i) {
        if (host->has_frame && frames[i].time < host->frame.time) { /* rewound */
            nt_energy_begin(host);
            nt_energy_let_go(host);
        }
        host->frame = frames[i];
        host->has_frame = 1;
        nt_energy_see(host, &frames[i]);
        nt_event_see(host, &frames[i]);
        nt_left_see(host, &frames[i]);
        nt_recovery_see(host, &frames[i]);
        nt_trainer_see(host, &frames[i]);
    }
}

void nt_host_follow(nt_session_host *host, double elapsed)
{
    nt_left_look(host);
    if (host->trainer.task && host->trainer.task->take)
        host->trainer.task->take(host);
    if (!host->has_frame)
        return;
    nt_proxy_follow(&host->hand, &host->frame, elapsed);
    nt_host_aim(host);
    nt_guide_follow(host);
}

nt_host_state nt_host_state_of(const nt_session_host *host)
{
    const nt_trainer *trainer = &host->trainer;
    nt_host_state state = {.hand = &host->hand,
                           .frame = host->has_frame ? &host->frame : NULL,
                           .acts = host->has_frame && nt_proxy_acts(&host->hand, &host->frame),
                           .undo = nt_host_undoable(host),
                           .task = trainer->task ? trainer->task->about.name : "",
                           .is_done = trainer->is_done,
                           .bounds = host->bounds};
    nt_energies(host, state.energies);
    return state;
}

/* --- what is asked --- */

static nt_status moved(nt_session_host *host, int all)
{
    if (!all) {
        copy(host->note, sizeof host->note, STOPS);
        host->due |= NT_DUE_NOTE;
    }
    nt_host_aim(host);
    return NT_OK;
}

static nt_status ask_hand(nt_session_host *host, const nt_host_asked *asked)
{
    const int lifts = !strcmp(asked->what, "retract") || (!strcmp(asked->what, "press") && asked->value[0] == 0.0);
    if (!lifts && nt_trainer_locks(host))
        return nt_host_refuse_filled(host, "first say what you expect; then you may touch", NULL);
    if (lifts || !strcmp(asked->what, "press")) /* a move goes on pressing */
        host->hand.presses = !lifts;
    if (!host->has_frame)
        return NT_OK;
    if (!strcmp(asked->what, "move"))
        return moved(host, nt_proxy_move(&host->hand, asked->value, &host->frame));
    if (!strcmp(asked->what, "wheel")) {
        (void)nt_proxy_wheel(&host->hand, asked->value[0], &host->frame);
        return moved(host, 1);
    }
    if (lifts)
        nt_proxy_lift(&host->hand, &host->frame);
    return moved(host, 1);
}

static int is_meant(const nt_session_host *host)
{
    int count;
    const nt_field *fields = nt_scene_fields(&count);
    const nt_scene *now = nt_host_described(host, NT_HOST_SCENE);
    for (int i = 0; i < count; ++i)
        if (nt_field_get(&fields[i], now) != nt_field_get(&fields[i], &host->meant))
            return 0;
    return 1;
}

static nt_status refuse_task(nt_session_host *host, const char *name)
{
    char asked[41], names[NT_HOST_LINE];
    nt_text text = nt_text_in(asked, sizeof asked);
    nt_text_add(&text, name);
    text = nt_text_in(names, sizeof names);
    for (int i = 0; nt_host_tasks(i); ++i) {
        nt_text_add(&text, i ? ", " : "");
        nt_text_add(&text, nt_host_tasks(i)->name);
    }
    return nt_host_refuse_filled(host, "task {name}: valid are {names}",
                                 (const nt_figure[]){{"name", 0.0, NULL, asked}, {"names", 0.0, NULL, names}, {0}});
}

/* A task: its name, whether its sample is laid for it, and a seed of what it draws. "": none. */
nt_status nt_host_ask_task(nt_session_host *host, const nt_host_asked *asked)
{
    const nt_task *task = nt_task_named(asked->text);
    nt_trainer_end(host);
    host->wants[0] = '\0';
    if (!asked->text[0])
        return NT_OK;
    if (!task)
        return refuse_task(host, asked->text);
    if (!(asked->value[1] >= 0.0 && asked->value[1] <= MAX_SEED))
        return nt_host_refuse_filled(
            host, "seed {seed}: valid is 0 .. {most}",
            (const nt_figure[]){{"seed", asked->value[1], "#", 0}, {"most", MAX_SEED, "#", 0}, {0}});
    const int lacks = task->about.pushed != NT_HOST_NOTHING && task->about.pushed != host->pushed;
    if (lacks || (asked->value[0] != 0.0 && (strcmp(host->name, task->about.preset) != 0 || !is_meant(host)))) {
        copy(host->wants, sizeof host->wants, task->about.preset);
        copy(host->waits, sizeof host->waits, task->about.name);
        host->seed = asked->value[1];
        return NT_OK;
    }
    return nt_trainer_begin(host, task, asked->value[1]);
}

const char *nt_host_wants(const nt_session_host *host)
{
    return host->wants[0] ? host->wants : NULL;
}

static nt_status ask_choice(nt_session_host *host, double number)
{
    nt_trainer *trainer = &host->trainer;
    if (!trainer->task)
        return NT_OK;
    if (trainer->is_done && trainer->task->about.follows[0])
        return nt_host_ask_task(host, &(nt_host_asked){"task", trainer->task->about.follows, {1.0, 0.0, 0.0}});
    const char *choices = nt_trainer_choices(host);
    int offered = choices[0] != '\0';
    for (const char *at = choices; *at; ++at)
        offered += *at == '|';
    if (trainer->is_done || !trainer->task->choose)
        return nt_host_refuse_filled(host, "this task offers no choice", NULL);
    if (offered && !(number >= 0.0 && number < offered)) /* nor NaN */
        return nt_host_refuse_filled(
            host, "choice {number}: valid is 1 .. {offered}",
            (const nt_figure[]){{"number", number + 1.0, "#", 0}, {"offered", offered, "#", 0}, {0}});
    host->due |= NT_DUE_TASK;
    return trainer->task->choose(host, offered ? (int)number : 0);
}

static nt_status ask_answer(nt_session_host *host, double value)
{
    const nt_trainer *trainer = &host->trainer;
    if (!trainer->task)
        return NT_OK;
    if (!trainer->task->answer || trainer->is_done)
        return nt_host_refuse_filled(host, "this task asks for no number", NULL);
    host->due |= NT_DUE_TASK;
    return trainer->task->answer(host, value);
}

static nt_status ask_world(nt_session_host *host, const nt_host_asked *asked)
{
    const nt_status status = !strcmp(asked->what, "change") ? nt_host_ask_change(host, asked->text, asked->value[0])
                             : !strcmp(asked->what, "undo") ? nt_host_undo(host)
                                                            : nt_host_redo(host);
    if (status == NT_OK && !host->reopens)
        host->due |= NT_DUE_WORLD;
    return status;
}

nt_status nt_host_ask(nt_session_host *host, const nt_host_asked *asked)
{
    const char *what = asked->what;
    if (!strcmp(what, "device"))
        return nt_guide_by(host, asked->text);
    if (!host->session)
        return nt_host_refuse_filled(host, "nothing is touched yet: lay a sample first", NULL);
    if (!strcmp(what, "move") || !strcmp(what, "wheel") || !strcmp(what, "press") || !strcmp(what, "retract"))
        return ask_hand(host, asked);
    if (!strcmp(what, "change") || !strcmp(what, "undo") || !strcmp(what, "redo"))
        return ask_world(host, asked);
    if (!strcmp(what, "task"))
        return nt_host_ask_task(host, asked);
    if (!strcmp(what, "choose"))
        return ask_choice(host, asked->value[0]);
    if (!strcmp(what, "say"))
        return ask_answer(host, asked->value[0]);
    if (!strcmp(what, "report")) { /* a view that has just come knows nothing */
        host->due |= NT_DUE_WORLD | NT_DUE_SLIDERS | NT_DUE_GUIDE;
        host->due |= host->plan.history == NT_HISTORY_DENTS ? NT_DUE_DENTS : 0u;
        return NT_OK;
    }
    if (!strcmp(what, "release")) { /* another program leads the hand */
        host->hand.presses = 0;
        return NT_OK;
    }
    if (!strcmp(what, "learn")) /* another program has changed the session */
        return nt_host_learn(host);
    if (!strcmp(what, "resume") && host->has_frame) {
        nt_proxy_resume(&host->hand, &host->frame);
        return moved(host, 1);
    }
    if (!strcmp(what, "rest") && host->has_frame) { /* a slave that has failed does not say where its tip is */
        if (isfinite(host->frame.tip_position[NT_Z]))
            host->hand.height = host->frame.tip_position[NT_Z];
        return NT_OK;
    }
    return NT_E_UNSUPPORTED;
}
