/* SPDX-License-Identifier: BSD-3-Clause
 * Ideal operators that push: around a ball to its far side and against its middle; a rod against its middle, half way
 * to an end, or against an end. Each by what is missing, then look again. */
#include <math.h>
#include <string.h>

#include "host/task_push.h"
#include "internal/manipulation.h"
#include "nanotouch/advanced/manipulation.h"

static const nt_trainer *trainer_of(const nt_operator *op)
{
    return &op->host->trainer;
}

/* From the middle of a ball or wire to the apex of a tip that touches with its flank, at its height now [m]. */
static double reach_of(const nt_operator *op)
{
    const nt_tip *tip = &nt_session_setup_of(op->host->session)->scene.tip;
    const double radius = op->host->left.laid.radius, up = radius - tip->radius - op->host->frame.tip_position[NT_Z];
    return (radius + tip->radius + up * sin(tip->half_angle)) / cos(tip->half_angle);
}

/* In a straight line by steps, until the tip is there. */
static void go(nt_operator *op, const double to[2], double step)
{
    const nt_frame *frame = nt_operator_wait(op, 0.02);
    while (nt_operator_goes_on(op)) {
        const double x = to[0] - frame->tip_position[NT_X], y = to[1] - frame->tip_position[NT_Y];
        const double far = hypot(x, y), part = fmin(1.0, step / far);
        if (!(far > 2e-9))
            return;
        nt_operator_ask(op, "move", part * x, part * y, 0.0);
        frame = nt_operator_wait(op, 0.02);
    }
}

/* A step that would come too near to a ball goes along it, and out. */
static void turn_away(const double ball[3], const nt_frame *frame, const double way[2], double room, double step[2])
{
    const double x = frame->tip_position[NT_X] + step[0] - ball[0], y = frame->tip_position[NT_Y] + step[1] - ball[1];
    const double near = hypot(x, y), out[2] = {x / near, y / near};
    if (near >= room || step[0] * x + step[1] * y >= 0.0)
        return;
    const double side = -out[1] * way[0] + out[0] * way[1] >= 0.0 ? 60e-9 : -60e-9;
    step[0] = -side * out[1] + (room - near) * out[0];
    step[1] = side * out[0] + (room - near) * out[1];
}

/* Away from each ball that is near, then on. */
static void go_around(nt_operator *op, const double to[2], double room)
{
    const nt_frame *frame = nt_operator_wait(op, 0.02);
    while (nt_operator_goes_on(op)) {
        const double way[2] = {to[0] - frame->tip_position[NT_X], to[1] - frame->tip_position[NT_Y]};
        const double far = hypot(way[0], way[1]), part = fmin(1.0, 60e-9 / far);
        double step[2] = {part * way[0], part * way[1]};
        if (!(far > 20e-9))
            return;
        for (int i = 0; i < trainer_of(op)->place_count; ++i)
            turn_away(trainer_of(op)->places[i], frame, way, room, step);
        nt_operator_ask(op, "move", step[0], step[1], 0.0);
        frame = nt_operator_wait(op, 0.02);
    }
}

/* Which goal each ball goes to: the shortest way of all, by trying every order. */
typedef struct matching {
    const nt_trainer *of;
    int order[NT_PARTICLES], best[NT_PARTICLES];
    double least;
} matching;

static void match(matching *m, int ball, unsigned taken, double way)
{
    const int count = m->of->goal_count;
    if (ball == count && way < m->least) {
        m->least = way;
        memcpy(m->best, m->order, sizeof m->best);
    }
    for (int goal = 0; ball < count && goal < count; ++goal)
        if (!(taken >> goal & 1u)) {
            m->order[ball] = goal;
            match(m, ball + 1, taken | 1u << goal,
                  way + hypot(m->of->goals[goal][0] - m->of->places[ball][0],
                              m->of->goals[goal][1] - m->of->places[ball][1]));
        }
}

static void push_one(nt_operator *op, int ball, const double goal[2])
{
    while (nt_operator_goes_on(op)) {
        const double *place = trainer_of(op)->places[ball], at[2] = {place[0], place[1]};
        const double way[2] = {goal[0] - at[0], goal[1] - at[1]}, far = hypot(way[0], way[1]), reach = reach_of(op);
        if (!(far > 0.5 * NT_PUSH_ALLOWED))
            return;
        const double behind[2] = {at[0] - 1.5 * reach * way[0] / far, at[1] - 1.5 * reach * way[1] / far};
        go_around(op, behind, 1.4 * reach);
        go(op, (const double[2]){goal[0] - reach * way[0] / far, goal[1] - reach * way[1] / far}, 10e-9);
        go(op, behind, 100e-9);
    }
}

void nt_push_solve(nt_operator *op)
{
    matching m = {.of = trainer_of(op), .least = INFINITY};
    match(&m, 0, 0u, 0.0);
    for (int ball = 0; ball < trainer_of(op)->goal_count; ++ball)
        push_one(op, ball, trainer_of(op)->goals[m.best[ball]]);
    nt_operator_ask(op, "choose", 0.0, 0.0, 0.0);
}

/* By a length, where a spot of the rod's axis lies; high up there, and back. */
static void shove(nt_operator *op, const double spot[2], const double way[2], double length)
{
    const double radius = op->host->left.laid.radius;
    const double behind[2] = {spot[0] - 2.0 * radius * way[0], spot[1] - 2.0 * radius * way[1]};
    while (nt_operator_goes_on(op) && nt_operator_wheel(op, -5.0)->tip_position[NT_Z] < 2.5 * radius)
        ;
    go(op, behind, 100e-9);
    while (nt_operator_goes_on(op) && nt_operator_wheel(op, 1.0)->tip_position[NT_Z] > 0.5 * radius)
        ;
    (void)nt_operator_wait(op, 0.1);
    const double by = length - reach_of(op);
    go(op, (const double[2]){spot[0] + by * way[0], spot[1] + by * way[1]}, 10e-9);
    go(op, behind, 100e-9);
}

/* What is missing of both ends, each to the goal by which both have the shorter way. */
static double missing(const nt_trainer *trainer, double off[2][2])
{
    double ways[2][2][2], size[2] = {0.0, 0.0};
    for (int order = 0; order < 2; ++order)
        for (int end = 0; end < 2; ++end)
            for (int k = 0; k < 2; ++k) {
                ways[order][end][k] = trainer->goals[order ? 1 - end : end][k] - trainer->places[end][k];
                size[order] += ways[order][end][k] * ways[order][end][k];
            }
    memcpy(off, ways[size[1] < size[0]], sizeof ways[0]);
    return fmax(hypot(off[0][0], off[0][1]), hypot(off[1][0], off[1][1]));
}

void nt_wire_solve(nt_operator *op)
{
    const double c = nt_rod_turning_point(2.0, 0.5); /* of half of the length */
    const double back = (1.0 - c) / (1.0 + c);       /* that goes the other end by */
    const double length = op->host->left.laid.length;
    double off[2][2];
    while (nt_operator_goes_on(op) && missing(trainer_of(op), off) >= 0.7 * NT_PUSH_ALLOWED) {
        const double (*ends)[3] = trainer_of(op)->places;
        const double axis[2] = {(ends[1][0] - ends[0][0]) / length, (ends[1][1] - ends[0][1]) / length};
        const double normal[2] = {-axis[1], axis[0]};
        const double first = off[0][0] * normal[0] + off[0][1] * normal[1];
        const double second = off[1][0] * normal[0] + off[1][1] * normal[1];
        const double along = 0.5 * ((off[0][0] + off[1][0]) * axis[0] + (off[0][1] + off[1][1]) * axis[1]);
        const double turn = (second - first) / (1.0 + back), all = first + back * turn;
        const double middle[2] = {0.5 * (ends[0][0] + ends[1][0]), 0.5 * (ends[0][1] + ends[1][1])};
        double sign, spot[2] = {middle[0], middle[1]};
        if (fabs(along) > fmax(0.4 * NT_PUSH_ALLOWED, fmax(fabs(all), fabs(turn)))) {
            sign = along > 0.0 ? 1.0 : -1.0;
            memcpy(spot, ends[along > 0.0 ? 0 : 1], sizeof spot);
            shove(op, spot, (const double[2]){sign * axis[0], sign * axis[1]}, fabs(along));
        } else if (fabs(all) > 0.3 * NT_PUSH_ALLOWED) {
            sign = all > 0.0 ? 1.0 : -1.0;
            shove(op, spot, (const double[2]){sign * normal[0], sign * normal[1]}, fabs(all));
        } else {
            sign = turn > 0.0 ? 1.0 : -1.0;
            spot[0] = 0.5 * (middle[0] + ends[1][0]);
            spot[1] = 0.5 * (middle[1] + ends[1][1]);
            shove(op, spot, (const double[2]){sign * normal[0], sign * normal[1]}, (c + 0.5) / (c + 1.0) * fabs(turn));
        }
    }
    nt_operator_ask(op, "choose", 0.0, 0.0, 0.0);
}
