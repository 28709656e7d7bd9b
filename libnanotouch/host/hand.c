/* SPDX-License-Identifier: BSD-3-Clause
 * The hand of a person who has no haptic device: it moves a point, the proxy, and physics lets the tip follow through a
 * spring, the virtual coupling. What lies between the two is what would be felt.
 *
 * Such a hand is a master without a motor: no loop closes through it. Its moves are lengths at the tip, scaled up by
 * 1/alpha_p here. It gives way as an arm would where the force comes near the limit. */
#include <math.h>

#include "internal/host.h"
#include "nanotouch/host.h"

static const double PRESS = 0.5;     /* of the max load: the steady force */
static const double STEPS = 80.0;    /* of the wheel from first touch to the max load */
static const double APPROACH = 12.0; /* far from the surface a step is at least this part of the gap */
static const double OVER = 1.1;      /* of the limit: here it gives way by itself */

static double spring_of(const nt_proxy_facts *facts)
{
    const double coupling = facts->coupling / (facts->alpha_p * facts->alpha_f), lever = facts->lever;
    return coupling > 0.0 ? coupling * lever / (coupling + lever) : lever;
}

nt_proxy nt_proxy_begin(const nt_proxy_facts *facts)
{
    nt_proxy hand = {.facts = *facts, .aimed_at = -INFINITY};
    const double start[2] = {facts->x, facts->y}, size[2] = {facts->width, facts->height};
    for (int axis = 0; axis < NT_AXES; ++axis) {
        hand.low[axis] = -0.5 * facts->travel;
        hand.high[axis] = 0.5 * facts->travel;
        if (axis < 2 && facts->width > 0.0) { /* it stays over the surface */
            hand.low[axis] = fmax(hand.low[axis], -start[axis] / facts->alpha_p);
            hand.high[axis] = fmin(hand.high[axis], (size[axis] - start[axis]) / facts->alpha_p);
        }
    }
    hand.place[NT_Z] = facts->held;
    hand.height = facts->start_height;
    hand.zero = hand.height + facts->alpha_p * facts->held;
    hand.stiffness = spring_of(facts);
    hand.step = (facts->indentation + facts->load / hand.stiffness) / STEPS;
    hand.limit = NT_PROXY_LOAD * facts->limit;
    hand.press = PRESS * facts->load;
    hand.reach = (isfinite(facts->sunk) ? facts->sunk : 0.0) + hand.limit / hand.stiffness;
    return hand;
}

static double known(double gap)
{
    return isfinite(gap) ? gap : 0.0; /* a real slave does not say */
}

static void shift(nt_proxy *hand, const double way[NT_AXES], const nt_frame *frame)
{
    if (!isfinite(way[0]) || !isfinite(way[1]) || !isfinite(way[2])) /* where the tip is nobody knows */
        return;
    const double before = hand->place[NT_Z];
    hand->aimed_at = frame->time;
    for (int axis = 0; axis < NT_AXES; ++axis)
        hand->place[axis] =
            fmin(fmax(hand->place[axis] + way[axis] / hand->facts.alpha_p, hand->low[axis]), hand->high[axis]);
    hand->height -= (hand->place[NT_Z] - before) * hand->facts.alpha_p; /* no further than the hand has gone */
    hand->aims = 1;
}

/* Another program may have led the hand meanwhile: it is where the master is. */
static void catch_up(nt_proxy *hand, const nt_frame *frame)
{
    if (frame->time < hand->aimed_at + 2.0 * NT_PROXY_GLIDE)
        return;
    const double apart = fmax(5.0 * hand->facts.resolution, 1e-4 * hand->facts.travel);
    double way[NT_AXES], most = 0.0;
    for (int axis = 0; axis < NT_AXES; ++axis) {
        const int leads = axis == NT_Z || hand->facts.axes == 3;
        way[axis] = leads ? frame->master_position[axis] - hand->place[axis] : 0.0;
        most = fmax(most, fabs(way[axis]));
    }
    if (!(most > apart))
        return;
    for (int axis = 0; axis < NT_AXES; ++axis)
        hand->place[axis] += way[axis];
    hand->height -= way[NT_Z] * hand->facts.alpha_p;
}

/* How far down it may go. A sample that relaxes has no depth of a force: in contact the spring alone tells. */
static double room_of(const nt_proxy *hand, const nt_frame *frame)
{
    if (!isfinite(frame->gap))
        return (hand->limit - frame->tip_force[NT_Z]) / hand->stiffness; /* what a lever feels */
    const double gap = isfinite(hand->facts.sunk) ? frame->gap : fmax(frame->gap, 0.0);
    return hand->height - frame->tip_position[NT_Z] + gap + hand->reach;
}

int nt_proxy_move(nt_proxy *hand, const double way[NT_AXES], const nt_frame *frame)
{
    catch_up(hand, frame);
    const double room = room_of(hand, frame);
    const double down = isfinite(room) ? fmin(way[NT_Z], fmax(room, 0.0)) : fmin(way[NT_Z], 0.0);
    shift(hand, (const double[NT_AXES]){way[NT_X], way[NT_Y], down}, frame);
    return down == way[NT_Z];
}

int nt_proxy_wheel(nt_proxy *hand, double steps, const nt_frame *frame)
{
    const double far = frame->contact_radius > 0.0 ? 0.0 : fmax(known(frame->gap), 0.0) / APPROACH;
    hand->presses = 0;
    return nt_proxy_move(hand, (const double[NT_AXES]){0.0, 0.0, steps * fmax(hand->step, far)}, frame);
}

void nt_proxy_lift(nt_proxy *hand, const nt_frame *frame)
{
    catch_up(hand, frame);
    hand->presses = 0;
    const double stretch = hand->facts.pull_off / hand->stiffness;
    const double surface = frame->tip_position[NT_Z] + fmax(-known(frame->gap), 0.0);
    const double up = surface + hand->facts.clearance + 1.2 * stretch - hand->height;
    shift(hand, (const double[NT_AXES]){0.0, 0.0, -fmax(up, 0.0)}, frame);
}

int nt_proxy_acts(const nt_proxy *hand, const nt_frame *frame)
{
    return hand->presses || frame->tip_force[NT_Z] > OVER * hand->limit;
}

void nt_proxy_follow(nt_proxy *hand, const nt_frame *frame, double elapsed)
{
    const double force = frame->tip_force[NT_Z], tip = frame->tip_position[NT_Z];
    if (!isfinite(force) || !isfinite(tip))
        return;
    if (frame->state != NT_RUN) {
        hand->height = tip - force / hand->stiffness;
        hand->presses = 0;
    } else if (force > OVER * hand->limit) {
        shift(hand, (const double[NT_AXES]){0.0, 0.0, -(force - hand->limit) / hand->stiffness}, frame);
    } else if (hand->presses) {
        const double compliance = STEPS * hand->step / hand->facts.load; /* of spring and sample */
        const double speed = frame->contact_radius > 0.0 ? 4.0 * (hand->press - force) * compliance
                                                         : fmax(STEPS * hand->step, 2.0 * known(frame->gap));
        (void)nt_proxy_move(hand, (const double[NT_AXES]){0.0, 0.0, elapsed * speed}, frame);
    }
}

void nt_proxy_resume(nt_proxy *hand, const nt_frame *frame)
{
    const double height = frame->tip_position[NT_Z] - frame->tip_force[NT_Z] / hand->stiffness;
    for (int axis = 0; axis < NT_AXES; ++axis) /* what nobody knows stays as it was */
        if (isfinite(frame->master_position[axis]))
            hand->place[axis] = frame->master_position[axis];
    if (isfinite(height))
        hand->height = height;
    (void)nt_proxy_move(hand, (const double[NT_AXES]){0.0, 0.0, 0.0}, frame);
}
