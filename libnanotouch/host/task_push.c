/* SPDX-License-Identifier: BSD-3-Clause
 * Push particles to where they shall lie, by hand: one, five into a pattern, or a rod, each of whose ends shall lie in
 * a ring. The session lays and moves them, by the laws of advanced/manipulation.h. */
#include "host/task_push.h"

#include <math.h>
#include <string.h>

static const double WORST = 5.0; /* so many times what is allowed scores nothing */
static const double LOSS = 2.0;  /* of the score, for each loss of contact on the way */
static const double DEGREE = 3.14159265358979323846 / 180.0;

/* Of the width; of a rod its pose, the angle in radians. */
static const double one_start[][3] = {{0.35, 0.5, 0.0}}, one_target[][2] = {{0.15, 0.5}};
static const double five_starts[][3] = {
    {0.3, 0.3, 0.0}, {0.7, 0.3, 0.0}, {0.75, 0.6, 0.0}, {0.5, 0.8, 0.0}, {0.25, 0.6, 0.0}};
static const double rod_start[3] = {0.5, 0.4, 0.0}, rod_target[3] = {0.5, 0.5, 0.4};

static int is_rod(const nt_session_host *host)
{
    return host->pushed == NT_HOST_ROD;
}

static void ends_of(const nt_session_host *host, const double pose[3], double ends[2][3])
{
    const double half = 0.5 * host->left.laid.length;
    for (int end = 0; end < 2; ++end) {
        const double along = end ? half : -half;
        ends[end][0] = pose[0] + along * cos(pose[2]);
        ends[end][1] = pose[1] + along * sin(pose[2]);
        ends[end][2] = host->left.laid.radius;
    }
}

/* Those that are not told yet; what does not fit is old. */
static void add_event(nt_trainer *trainer, const char *event)
{
    if (trainer->event_count < NT_EVENTS_TOLD)
        trainer->events[trainer->event_count++] = event;
}

/* What is pushed has moved, was touched or was lost. */
static void take(nt_session_host *host)
{
    nt_trainer *trainer = &host->trainer;
    const nt_session_particles *laid = &host->left.laid;
    double places[NT_PARTICLES][3] = {{0.0}}, force[NT_AXES] = {0.0};
    long touches = 0, losses = 0;
    for (int i = 0; i < trainer->lay_count; ++i) {
        memcpy(places[i], laid->position[i], sizeof places[i]);
        for (int axis = 0; axis < NT_AXES; ++axis)
            force[axis] += laid->force[i][axis];
        touches += laid->touches[i];
        losses += laid->losses[i];
    }
    if (is_rod(host)) {
        const double pose[3] = {laid->position[0][0], laid->position[0][1], laid->angle[0]};
        ends_of(host, pose, places);
    }
    if (trainer->touches_before < 0) { /* as the task began */
        trainer->touches_before = touches;
        trainer->losses_before = losses;
    }
    touches -= trainer->touches_before;
    losses -= trainer->losses_before;
    if (touches > trainer->touches_now + trainer->losses)
        add_event(trainer, "snap");
    if (losses > trainer->losses)
        add_event(trainer, "tear");
    trainer->touches_now = touches - losses;
    trainer->losses = losses;
    trainer->push = sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
    trainer->max_push = fmax(trainer->max_push, trainer->push);
    if (trainer->event_count || memcmp(places, trainer->places, sizeof places) != 0)
        host->due |= NT_DUE_PARTICLES;
    memcpy(trainer->places, places, sizeof places);
}

static nt_status begin_with(nt_session_host *host, const double (*starts)[3], int count)
{
    nt_trainer *trainer = &host->trainer;
    double poses[NT_PARTICLES][3];
    for (int i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k)
            poses[i][k] = starts[i][k] * (k < 2 ? host->width : 1.0);
    trainer->lay_count = trainer->place_count = trainer->free_losses = count;
    trainer->touches_before = -1;
    const nt_status status = nt_left_lay(host, (const double (*)[3])poses, count);
    if (status == NT_OK)
        take(host);
    host->due |= NT_DUE_PARTICLES;
    return status;
}

static void add_goal(nt_session_host *host, double x, double y)
{
    double *goal = host->trainer.goals[host->trainer.goal_count++];
    goal[0] = x;
    goal[1] = y;
}

static nt_status push_begin(nt_session_host *host)
{
    add_goal(host, one_target[0][0] * host->width, one_target[0][1] * host->width);
    return begin_with(host, one_start, 1);
}

static nt_status pattern_begin(nt_session_host *host)
{
    for (int i = 0; i < 5; ++i) {
        const double angle = (90.0 + 72.0 * i) * DEGREE;
        add_goal(host, (0.5 + 0.3 * cos(angle)) * host->width, (0.5 + 0.3 * sin(angle)) * host->width);
    }
    return begin_with(host, five_starts, 5);
}

static nt_status wire_begin(nt_session_host *host)
{
    const double goal[3] = {rod_target[0] * host->width, rod_target[1] * host->width, rod_target[2]};
    double ends[2][3];
    const nt_status status = begin_with(host, &rod_start, 1);
    ends_of(host, goal, ends);
    add_goal(host, ends[0][0], ends[0][1]);
    add_goal(host, ends[1][0], ends[1][1]);
    host->trainer.place_count = host->trainer.free_losses = 2; /* across, and round */
    return status;
}

/* Of a target, the distance of the nearest particle [m]. */
static double error_of(const nt_trainer *trainer, int goal)
{
    double nearest = INFINITY;
    for (int i = 0; i < trainer->place_count; ++i)
        nearest = fmin(nearest, hypot(trainer->places[i][0] - trainer->goals[goal][0],
                                      trainer->places[i][1] - trainer->goals[goal][1]));
    return nearest;
}

static double max_error(const nt_trainer *trainer)
{
    double most = 0.0;
    for (int i = 0; i < trainer->goal_count; ++i)
        most = fmax(most, error_of(trainer, i));
    return most;
}

static void figures_of(nt_session_host *host, nt_figure *figures)
{
    const long extra = host->trainer.losses - host->trainer.free_losses; /* the last one of each is no loss */
    figures[0] = (nt_figure){"radius", host->left.laid.radius, "m", 0};
    figures[1] = (nt_figure){"allowed", NT_PUSH_ALLOWED, "m", 0};
    figures[2] = (nt_figure){"off", max_error(&host->trainer), "m", 0};
    figures[3] = (nt_figure){"force", host->trainer.push, "2 N", 0};
    figures[4] = (nt_figure){"losses", extra > 0 ? (double)extra : 0.0, "#", 0};
    figures[5] = (nt_figure){"what", 0.0, NULL, is_rod(host) ? "wire" : "ball"};
}

static void now(nt_session_host *host, nt_text *text)
{
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    figures_of(host, figures);
    nt_text_fill(text, "{off} off; the {what} pushes back with {force}", figures);
}

static nt_status choose(nt_session_host *host, int number)
{
    (void)number;
    const nt_trainer *trainer = &host->trainer;
    nt_figure figures[NT_TASK_FIGURES] = {{0}};
    double score = 0.0, mean = 0.0;
    if (trainer->touches_now)
        return nt_trainer_early(host, "take the tip away first", NULL);
    for (int i = 0; i < trainer->goal_count; ++i) {
        const double error = error_of(trainer, i), beyond = fmax(error - NT_PUSH_ALLOWED, 0.0);
        mean += error / trainer->goal_count;
        score += (1.0 - fmin(beyond / ((WORST - 1.0) * NT_PUSH_ALLOWED), 1.0)) / trainer->goal_count;
    }
    figures_of(host, figures);
    const double losses = figures[4].value;
    nt_trainer_measure(host, "largest error", "m", max_error(trainer));
    nt_trainer_measure(host, "mean error", "m", mean);
    nt_trainer_measure(host, "losses of contact", "", losses);
    nt_trainer_measure(host, "largest push", "N", trainer->max_push);
    nt_trainer_finish(host, max_error(trainer) <= NT_PUSH_ALLOWED, 100.0 * score - LOSS * losses,
                      "{off} off, allowed were {allowed}; contact lost {losses} times on the way", figures);
    return NT_OK;
}

static void add_places(nt_text *json, const char *key, const double *rows, int count, int width)
{
    nt_json_key(json, key);
    nt_json_open(json, "[");
    for (int i = 0; i < count; ++i) {
        nt_json_open(json, "[");
        for (int k = 0; k < width; ++k)
            nt_json_number(json, NULL, rows[width * i + k]);
        nt_json_close(json, "]");
    }
    nt_json_close(json, "]");
}

void nt_trainer_tell_particles(nt_session_host *host, nt_text *json)
{
    nt_trainer *trainer = &host->trainer;
    const nt_session_particles *laid = &host->left.laid;
    const int shows = trainer->task && trainer->place_count;
    nt_json_number(json, "radius", shows ? laid->radius : 0.0);
    add_places(json, "places", laid->position[0], shows ? trainer->lay_count : 0, 3);
    add_places(json, "targets", trainer->goals[0], shows ? trainer->goal_count : 0, 2);
    nt_json_number(json, "heat", laid->dissipated);
    if (laid->length > 0.0) {
        nt_json_number(json, "length", laid->length);
        nt_json_key(json, "angles");
        nt_json_open(json, "[");
        for (int i = 0; i < (shows ? trainer->lay_count : 0); ++i)
            nt_json_number(json, NULL, laid->angle[i]);
        nt_json_close(json, "]");
    }
    nt_json_key(json, "events");
    nt_json_open(json, "[");
    for (int i = 0; i < trainer->event_count; ++i)
        nt_json_text(json, NULL, trainer->events[i]);
    trainer->event_count = 0;
    nt_json_close(json, "]");
}

#define PUSHED(NAME, TITLE, PRESET, WHAT, WORDS, BEGIN, SOLVE)                                                         \
    {.about = {NAME, TITLE, PRESET, "", "", WHAT, 0},                                                                  \
     .hides = "",                                                                                                      \
     .choices = "it lies there",                                                                                       \
     .words = WORDS,                                                                                                   \
     .begin = BEGIN,                                                                                                   \
     .take = take,                                                                                                     \
     .now = now,                                                                                                       \
     .figures = figures_of,                                                                                            \
     .choose = choose,                                                                                                 \
     .solve = SOLVE}

const nt_task nt_task_push = PUSHED(
    "push", "Push a particle", "latex_on_glass", NT_HOST_PARTICLES,
    "Push the ball (radius {radius}) into the ring, within {allowed}. Stay low, push against its middle, go around "
    "it for another direction. A push beside the middle turns it away.",
    push_begin, nt_push_solve);

const nt_task nt_task_pattern = PUSHED(
    "pattern", "Push five into a pattern", "latex_on_glass", NT_HOST_PARTICLES,
    "Push each ball (radius {radius}) into a ring, within {allowed}. Any ball for any ring; they pass through each "
    "other, so keep them apart.",
    pattern_begin, nt_push_solve);

const nt_task nt_task_wire = PUSHED(
    "wire", "Push a nanowire", "wire_on_glass", NT_HOST_ROD,
    "Push the wire (radius {radius}) until each end lies in a ring, within {allowed}. Stay low. On its middle it "
    "goes without turning; near an end it turns, and resists less.",
    wire_begin, nt_wire_solve);
