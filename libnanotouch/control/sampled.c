/* SPDX-License-Identifier: BSD-3-Clause
 * The linear loop as its samples see it. Between samples every part is a second-order system under a held command,
 * which a dead time of n + eps periods divides in two: x[k+1] = Phi x[k] + Phi(T - eps) Gamma(eps) u[k-n-1] + Gamma(T -
 * eps) u[k-n]. Rational functions of z are evaluated in z - 1, which keeps its accuracy at high rates. */
#include "control/sampled.h"

#include <math.h>

#include "internal/control.h"
#include "nanotouch/material.h"

nt_sampled nt_sampled_make(double mass, double damping, double stiffness, double period, double dead_time)
{
    nt_sampled part = {.mass = mass,
                       .damping = damping,
                       .stiffness = stiffness,
                       .period = period,
                       .whole = (int)fmin(1e9, floor(dead_time / period + 1e-9))};
    const double split = fmax(0.0, dead_time / period - part.whole);
    const nt_lti continuous = {.order = 2,
                               .a = {{0.0, 1.0}, {-stiffness * period / mass * period, -damping / mass * period}},
                               .b = {0.0, period / mass * period}};
    nt_lti all = {.order = 2}, before = {.order = 2, .a = {{1.0, 0.0}, {0.0, 1.0}}}, after = {.order = 2};
    nt_status status = nt_lti_discretise(&continuous, 1.0, &all);
    if (status == NT_OK && split > 0.0)
        status = nt_lti_discretise(&continuous, split, &before);
    if (status == NT_OK)
        status = nt_lti_discretise(&continuous, 1.0 - split, &after);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++)
            part.step[i][j] = status == NT_OK ? all.a[i][j] - (i == j) : (double)NAN;
        part.early[i] = after.a[i][0] * before.b[0] + after.a[i][1] * before.b[1];
        part.late[i] = after.b[i];
    }
    return part;
}

/* exp(-j theta) */
static double complex back_by(double theta)
{
    return nt_complex(cos(theta), -sin(theta));
}

nt_sampled_value nt_sampled_at(const nt_sampled *part, double theta)
{
    const double complex less = nt_complex_from_one(theta), delay = back_by(theta), dead = back_by(part->whole * theta);
    const double complex first = dead * (part->early[0] * delay + part->late[0]);
    const double complex second = dead * (part->early[1] * delay + part->late[1]);
    const double complex a = less - part->step[0][0], d = less - part->step[1][1];
    nt_sampled_value value = {
        .position = d * first + part->step[0][1] * second,
        .speed = (part->step[1][0] * first + a * second) / part->period,
        .determinant = a * d - part->step[0][1] * part->step[1][0],
    };
    value.acceleration =
        (delay * dead * value.determinant - part->damping * value.speed - part->stiffness * value.position) /
        part->mass;
    return value;
}

double nt_sampled_angle(const nt_sampled *part)
{
    const double decay = 0.5 * part->damping / part->mass;
    const double square = part->stiffness / part->mass - decay * decay;
    const double angle = fmod(sqrt(fmax(0.0, square)) * part->period, 2.0 * NT_PI);
    return fmin(angle, 2.0 * NT_PI - angle);
}

double nt_sampled_dead_time(const nt_rig *rig, const nt_gains *gains)
{
    const nt_converters *converters = &rig->converters;
    const double T = 1.0 / gains->rate;
    const double repeats = converters->adc_rate > 0.0 ? fmax(0.0, 1.0 / converters->adc_rate - T) : 0.0;
    return gains->delay * T + converters->adc_latency + repeats + converters->dac_latency;
}

double nt_sampled_master_hold(const nt_rig *rig, const nt_gains *gains)
{
    return rig->master.rate > 0.0 ? fmax(0.0, 1.0 / rig->master.rate - 1.0 / gains->rate) : 0.0;
}

static nt_sampled_tool tool_of(const nt_gains *gains)
{
    const double K = gains->coupling_stiffness, drag = gains->coupling_damping * gains->rate;
    return K > 0.0 ? (nt_sampled_tool){1.0 / K, drag / (K + drag), K * drag / (K + drag)}
                   : (nt_sampled_tool){.give = 0.0};
}

nt_sampled_loop nt_sampled_loop_make(const nt_rig *rig, const nt_gains *gains)
{
    const double T = 1.0 / gains->rate, dead_time = nt_sampled_dead_time(rig, gains);
    const double wn = 2.0 * NT_PI * rig->stage.resonance;
    const double hand_dead_time = dead_time + 2.0 * nt_sampled_master_hold(rig, gains);
    const nt_hand *hand = &rig->hand;
    nt_sampled_loop loop = {
        .master = nt_sampled_make(rig->master.mass + hand->mass, rig->master.damping + hand->damping, hand->stiffness,
                                  T, hand_dead_time),
        .hand_dead_time = hand_dead_time,
        .stage = nt_sampled_make(1.0 / (wn * wn), 1.0 / (wn * rig->stage.quality), 1.0, T, dead_time),
        .stage_loop = nt_stage_loop_make(&rig->stage, gains),
        .hand = *hand,
        .tool = tool_of(gains),
        .force_filter = -expm1(-2.0 * NT_PI * gains->force_filter * T),
    };
    loop.notched = nt_stage_loop_notches(&rig->stage, gains);
    return loop;
}

nt_sampled_loop nt_sampled_loop_held(const nt_sampled_loop *loop, const nt_hand *hand)
{
    const nt_sampled *own = &loop->master;
    nt_sampled_loop held = *loop;
    held.hand = *hand;
    held.master =
        nt_sampled_make(own->mass - loop->hand.mass + hand->mass, own->damping - loop->hand.damping + hand->damping,
                        hand->stiffness, own->period, loop->hand_dead_time);
    return held;
}

nt_sampled_loop nt_sampled_loop_of(const nt_rig *rig, const nt_settings *settings, const nt_gains *gains)
{
    nt_sampled_loop loop = nt_sampled_loop_make(rig, gains);
    if (settings->control.choice == NT_CONTROL_PAPER) {
        loop.printed = 1;
        loop.notched = 0;
        loop.proportional = settings->gains.stage_proportional;
        loop.derivative = settings->gains.stage_derivative;
        loop.force_filter = 1.0; /* the raw f_m */
    }
    return loop;
}

/* H, from the stage's reference to its position, as numerator and denominator. The notch's zeros are the stage's
 * poles: both are left out. */
static double complex stage_numerator(const nt_sampled_loop *loop, double theta, double complex *denominator)
{
    const nt_sampled_value stage = nt_sampled_at(&loop->stage, theta);
    const double complex less = nt_complex_from_one(theta);
    const double *a = loop->stage_loop.a;
    *denominator = loop->notched ? less * less + (2.0 + a[1]) * less + (1.0 + a[1] + a[2]) : stage.determinant;
    return loop->notched ? loop->stage_loop.b[0] * stage.position : stage.position;
}

double complex nt_sampled_low_pass(const nt_sampled_loop *loop, double theta)
{
    const double complex less = nt_complex_from_one(theta);
    return loop->force_filter * (1.0 + less) / (less + loop->force_filter);
}

nt_sampled_terms nt_sampled_terms_at(const nt_sampled_loop *loop, double theta)
{
    const double complex less = nt_complex_from_one(theta), z = 1.0 + less;
    double complex below;
    const double complex above = stage_numerator(loop, theta, &below);
    const nt_sampled_value master = nt_sampled_at(&loop->master, theta);
    const nt_hand *hand = &loop->hand;
    const double complex reaction =
        -(hand->mass * master.acceleration + hand->damping * master.speed + hand->stiffness * master.position);
    const double complex low_pass = nt_sampled_low_pass(loop, theta);
    const double complex drive =
        loop->proportional + loop->derivative / loop->stage.period * less * back_by(theta); /* of Eq. 17 */
    const nt_sampled_tool *tool = &loop->tool;
    nt_sampled_terms terms = {.stage = less * below,
                              .tracking = z * above,
                              .reach = (less + loop->stage_loop.integral * z) * above,
                              .master = master.determinant,
                              .way = master.position,
                              .finger = low_pass * reaction,
                              .keeps = 1.0 - tool->kept * back_by(theta),
                              .drags = tool->drag * less * back_by(theta)};
    if (loop->printed) {
        terms.tracking = less * drive * above;
        terms.reach = less * drive * above;
    }
    return terms;
}

double complex nt_sampled_servo(const nt_sampled_loop *loop, const nt_sampled_terms *terms)
{
    return terms->stage + (loop->printed ? 1.0 : loop->stage_loop.integral) * terms->tracking;
}

double complex nt_sampled_air(const nt_sampled_terms *terms, double force_gain)
{
    return (terms->master - force_gain * terms->finger) * terms->keeps + (1.0 + force_gain) * terms->drags * terms->way;
}

double complex nt_sampled_touch(const nt_sampled_loop *loop, const nt_sampled_terms *terms, double force_gain)
{
    const double complex gives = (terms->master - force_gain * terms->finger) * loop->tool.give;
    return (1.0 - loop->tool.kept) * terms->reach * (gives + (1.0 + force_gain) * terms->way);
}

double complex nt_sampled_stage(const nt_sampled_loop *loop, double theta)
{
    const double complex less = nt_complex_from_one(theta), integral = loop->stage_loop.integral * (1.0 + less);
    double complex below;
    const double complex above = stage_numerator(loop, theta, &below);
    if (loop->printed) {
        const double complex drive = loop->proportional + loop->derivative / loop->stage.period * less * back_by(theta);
        return drive * above / (below + drive * above);
    }
    return (less + integral) * above / (less * below + integral * above);
}

nt_sampled_flow nt_sampled_flow_at(const nt_sampled_loop *loop, double force_gain, double theta)
{
    const nt_sampled_terms terms = nt_sampled_terms_at(loop, theta);
    const nt_sampled_value stage = nt_sampled_at(&loop->stage, theta);
    const double gain = loop->printed ? 1.0 : loop->stage_loop.integral;
    const double complex servo = nt_sampled_servo(loop, &terms); /* 1 + G I over less and below */
    return (nt_sampled_flow){
        .stage = nt_sampled_stage(loop, theta),
        .command = stage.position / stage.determinant * terms.stage / servo,
        .reading = gain * terms.tracking / servo,
        .master = terms.way / (terms.master - force_gain * terms.finger),
        .low_pass = nt_sampled_low_pass(loop, theta),
        .tool = (1.0 - loop->tool.kept) / terms.keeps,
    };
}

/* Slowest corner of all parts, as an angle: nothing crosses far below it. */
static double slowest(const nt_sampled_loop *loop)
{
    const nt_sampled *master = &loop->master, *stage = &loop->stage;
    double corner = fmin(1.0, sqrt(stage->stiffness / stage->mass) * stage->period);
    corner = fmin(corner, stage->stiffness / stage->damping * stage->period);
    corner = fmin(corner, master->damping / master->mass * master->period);
    corner = fmin(corner, 1.0 - loop->tool.kept);
    if (master->stiffness > 0.0) {
        corner = fmin(corner, master->stiffness / master->damping * master->period);
        corner = fmin(corner, sqrt(master->stiffness / master->mass) * master->period);
    }
    return corner;
}

double nt_sampled_first(const nt_sampled_loop *loop)
{
    return 1e-3 * slowest(loop);
}

/* A share of the way to or from the nearest resonance, where the phase turns fastest, no closer than a fraction of its
 * width; and so near that dead times do not turn the phase by more than a quarter. */
double nt_sampled_next(const nt_sampled_loop *loop, double theta, double share)
{
    const nt_sampled *parts[] = {&loop->stage, &loop->master};
    double step = fmin(share * theta, 0.25 * NT_PI / (2.0 * loop->master.whole + 8.0));
    for (int i = 0; i < 2; i++) {
        const double width = 0.5 * parts[i]->damping / parts[i]->mass * parts[i]->period;
        const double distance = fabs(theta - nt_sampled_angle(parts[i]));
        step = fmin(step, fmax(share * distance, 0.05 * width));
    }
    return theta + fmax(step, 1e-12);
}
