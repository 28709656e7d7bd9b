/* SPDX-License-Identifier: BSD-3-Clause
 * Made by tools/single.py from nanotouch 0.1.0: do not edit.  */

#include "nanotouch_single.h"

#include <math.h>
#include <stddef.h>

/* In the type of what they are given: what adds up is double. */
static inline float ntf_lesser(float a, float b)
{
    return a < b ? a : b;
}
static inline float ntf_greater(float a, float b)
{
    return a > b ? a : b;
}
static inline double ntf_lesser_sum(double a, double b)
{
    return a < b ? a : b;
}
static inline double ntf_greater_sum(double a, double b)
{
    return a > b ? a : b;
}
#define lesser(a, b) _Generic((a) + (b), float: ntf_lesser, double: ntf_lesser_sum)(a, b)
#define greater(a, b) _Generic((a) + (b), float: ntf_greater, double: ntf_greater_sum)(a, b)
#define clamp(value, minimum, maximum) lesser(greater(value, minimum), maximum)

/* sqrt(a^2 + b^2) to 2^-52; both below 1e150, and at least one of them above 1e-146 or the result is less exact. */
static inline float hypotenuse(float a, float b)
{
    return sqrtf(a * a + b * b);
}

/* Where the stage should be by now, told to be at the reference [m], whatever it shows. */
void ntf_follow_expect(const ntf_supervisor *supervisor, ntf_supervisor_state *state, ntf_sum reference);
/* Of where it is read to be [m]. Not where it should be: hold; for follow_time: latched, and it stays there. So does a
 * lift whose force cannot be read, until it can be and grows; one that was a second try is given up. */
ntf_state ntf_follow_judge(const ntf_supervisor *supervisor, ntf_supervisor_state *state, float position, int tells_force);
/* Growth of the force that is none: deflections may show it during a lift, beside their noise [N]. */
float ntf_lift_tolerance(const ntf_supervisor *supervisor);
/* Of a force that could be read [N], and where the stage is read to be [m]: 0 when it should have turned, is not seen
 * to rise, and the force has grown since. */
int ntf_lift_helps(const ntf_supervisor *supervisor, ntf_supervisor_state *state, float force, float position);
/* Of where the stage is read to be [m]: 0 when it has gone the wrong way. */
int ntf_lift_rises(const ntf_supervisor *supervisor, ntf_supervisor_state *state, float position);
/* How far the stop lifts in all [m]; begins anew, from retracted = 0, where the tip is not free yet or no more. */
float ntf_lift_distance(const ntf_touch *touch, ntf_touch_state *state);
/* RUN: moves the reference as the mode has it; returns the motor force wanted, not a number if the law gave none. */
float ntf_mode_run(const ntf_touch *touch, ntf_touch_state *state);
/* The master is uncoupled and indexed anew; returns what is left of the force, with damping. */
float ntf_mode_release(const ntf_touch *touch, ntf_touch_state *state);
/* Not RUN: lifts by up to `distance` [m] in all, and releases. */
float ntf_mode_stop(const ntf_touch *touch, ntf_touch_state *state, float distance);
/* A spring draws the master to the height that the stage stands at. */
float ntf_motor_height(const ntf_gains *gains, float height_position, float master_position);
/* Not in RUN: the force fades to zero with damping against the master's motion. */
float ntf_motor_fade(const ntf_master *master, float force, float speed);
/* Power, rate and amplitude, in this order: the last one always holds. Only what drives the hand is limited in power:
 * a brake takes energy away. */
float ntf_motor_limit(const ntf_limits *limits, float largest_step, float last, float force, float speed);
/* How far the hand has gone sideways since the tip last followed, and how fast it goes. */
void ntf_sideways_follow_hand(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample);
/* The lever's force sideways, and what a hand of one axis feels of it. After signals.slave_force. */
void ntf_sideways_read(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample);
/* What goes in at the hand in x and y, and what comes out at the tip; counted while the loop is closed. */
void ntf_sideways_watch(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample, int closed);
/* Where the tip goes: after the hand, or along its path. */
void ntf_sideways_move(const ntf_touch *touch, ntf_touch_state *state);
/* Motor forces in x and y: alpha_f times the force on the tip, fading as the one that presses does. */
void ntf_sideways_drive(const ntf_touch *touch, ntf_touch_state *state);
/* Of a valid sample. NTF_HOLD for a sensor that seems dead, NTF_LATCHED where a step away has not helped. shows_none: the
 * reading is one that shows no noise anyway. */
ntf_state ntf_stuck_judge(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample,
                        int shows_none);
/* --- control/motor.c --- */
/* The motor of the master where no law speaks, and its limits. */


/* Share of the master's own damping that the motor adds while it fades out; well below the sampled limit 2 b. */
#define FADE_DAMPING 0.5f

float ntf_motor_height(const ntf_gains *gains, float height_position, float master_position)
{
    return gains->height_stiffness * (height_position - master_position);
}

float ntf_motor_fade(const ntf_master *master, float force, float speed)
{
    return force - FADE_DAMPING * master->damping * speed;
}

float ntf_motor_limit(const ntf_limits *limits, float largest_step, float last, float force, float speed)
{
    const float power = force * speed;
    const float allowed = power > limits->motor_power ? limits->motor_power / speed : force;
    const float slewed = clamp(allowed, last - largest_step, last + largest_step);
    return clamp(slewed, -limits->motor_force, limits->motor_force);
}

#undef FADE_DAMPING

/* --- control/laws.c --- */
/* The three laws (paper, Eq. 16-17). */


/* tau_m = -alpha_f f_s - K_f (alpha_f f_s - f_m). At rest f_m = alpha_f f_s for any K_f (erratum E16). */
static float reflect(const ntf_gains *gains, const ntf_signals *signals, float operator_force)
{
    const float reflected = signals->scaling.alpha_f * signals->felt_force;
    return -reflected - signals->gain_factor * gains->force_gain * (reflected - operator_force);
}

static float feed_forward(const ntf_gains *gains, const ntf_signals *signals)
{
    return gains->velocity_feedforward * signals->master_damping * signals->smooth_speed;
}

ntf_effort ntf_servo_default(void *unused, const ntf_gains *gains, const ntf_signals *signals)
{
    (void)unused;
    const float force = reflect(gains, signals, signals->smooth_force);
    return (ntf_effort){force + feed_forward(gains, signals), signals->target};
}

ntf_effort ntf_servo_paper(void *unused, const ntf_gains *gains, const ntf_signals *signals)
{
    (void)unused;
    const float speed = signals->scaling.alpha_p * signals->master_speed - signals->stage_speed;
    const float error = signals->target - signals->stage_position;
    const float drive = gains->stage_derivative * speed + gains->stage_proportional * error;
    return (ntf_effort){reflect(gains, signals, signals->operator_force), drive};
}

ntf_effort ntf_servo_impedance(void *unused, const ntf_gains *gains, const ntf_signals *signals)
{
    (void)unused;
    const float reflected = signals->gain_factor * signals->scaling.alpha_f * signals->felt_force;
    return (ntf_effort){feed_forward(gains, signals) - reflected, signals->target};
}

ntf_control_law ntf_control_law_of(const ntf_control *control)
{
    switch (control->choice) {
    case NTF_CONTROL_DEFAULT:
        return ntf_servo_default;
    case NTF_CONTROL_PAPER:
        return ntf_servo_paper;
    case NTF_CONTROL_IMPEDANCE:
        return ntf_servo_impedance;
    case NTF_CONTROL_OWN:
        return control->law;
    }
    return NULL;
}


/* --- control/stage_loop.c --- */
/* The stage follows a reference: feed-forward through a notch that replaces the lightly damped resonance (Eq. 13: 450
 * Hz, Q = 20) by a well damped one, plus integral action on the read-out. The paper's PD (Eq. 17) cannot track: its
 * static gain is K_p/(1 + K_p), and stability at 3 ms holds K_p below 0.5. */

ntf_sum ntf_stage_loop_step(const ntf_stage_loop *loop, ntf_stage_loop_state *state, ntf_sum reference, float measured)
{
    state->correction += loop->integral * (reference - measured);
    const ntf_sum in = reference + state->correction;
    const ntf_sum out = loop->b[0] * in + state->w[0]; /* transposed direct form II */
    state->w[0] = loop->b[1] * in - loop->a[1] * out + state->w[1];
    state->w[1] = loop->b[2] * in - loop->a[2] * out;
    return out;
}


/* --- control/passivity.c --- */
/* Time-domain passivity of the two-port between hand and tip. What goes in at the hand, f_m dx_m, minus what comes out
 * at the tip, alpha_f f_s dx_s/alpha_p, is by Eq. 12 and 17 (f_m - alpha_f f_s) dx = (m x'' + b x') dx/(1 + K_f): the
 * master's own damping, whatever the surface does. Holds and delays take from it; in a limit cycle nothing is left,
 * because the motor pays for the damping. So it is not enough that no energy comes out: a share of b v^2/(1 + K_f) must
 * be seen to go in. Where it is not, K_f backs off by a fifth and stays there: damping injection alone does not stop
 * that limit cycle (docs/control.md), so the motor adds damping only when there is no gain left to take. The hand's
 * port alone would not do: a surface that rises under a moving tip gives energy to the operator, and that is the
 * physics. What has been swallowed is forgotten beyond a small store, or it would hide an instability that begins late.
 */


#define BACK_OFF 0.8f
#define LEAST_GAIN 0.05f  /* below it damping is added */
#define DAMPING_STEP 0.2f /* of the master's own, up to all of it */

static float work(const ntf_port *from, const ntf_port *to)
{
    return 0.5f * (from->force + to->force) * (to->position - from->position);
}

static float hand_work(const ntf_passivity *passivity, const ntf_passivity_state *state, const ntf_port *hand)
{
    if (passivity->credit == 0.0f)
        return work(&state->last_hand, hand);
    return (hand->force + passivity->credit * state->speed) * (hand->position - state->last_hand.position);
}

/* The least that the damping has to swallow in this period [J]. */
static float energy_due(const ntf_passivity *passivity, ntf_passivity_state *state, const ntf_port *hand)
{
    const float speed = (hand->position - state->last_hand.position) / passivity->period;
    const float likely = clamp(speed, -passivity->speed_limit, passivity->speed_limit);
    state->speed += passivity->speed_filter * (likely - state->speed);
    const float floorf = passivity->speed_floor;
    const float square = greater(0.0f, state->speed * state->speed - floorf * floorf);
    return passivity->due * square / (1.0f + state->gain * passivity->force_gain);
}

float ntf_passivity_step(const ntf_passivity *passivity, ntf_passivity_state *state, const ntf_port *hand,
                         const ntf_port *tip)
{
    const float due = energy_due(passivity, state, hand);
    const float given = hand_work(passivity, state, hand);
    const float swallowed = given - work(&state->last_tip, tip);
    state->energy = lesser(state->energy + swallowed - due, NTF_PASSIVITY_STORE * passivity->dead_zone);
    state->last_hand = *hand;
    state->last_tip = *tip;
    if (state->energy < -passivity->dead_zone) {
        if (state->gain >= LEAST_GAIN)
            state->gain *= BACK_OFF;
        else
            state->damping = lesser(1.0f, state->damping + DAMPING_STEP);
        state->energy = 0.0f;
        ++state->trips;
    }
    return state->gain;
}

float ntf_passivity_damping_force(const ntf_passivity *passivity, const ntf_passivity_state *state)
{
    const int is_motion = fabsf(state->speed) > passivity->speed_floor;
    return is_motion ? -state->damping * passivity->damping * state->speed : 0.0f;
}

int ntf_passivity_is_exhausted(const ntf_passivity_state *state)
{
    return state->gain < LEAST_GAIN && state->damping >= 1.0f;
}

#undef BACK_OFF
#undef LEAST_GAIN
#undef DAMPING_STEP

/* --- control/rescale.c --- */
/* Scales that change while the loop runs (docs/control.md). By Eq. 16 the operator's contact is the tip's, stretched by
 * 1/alpha_p in length and alpha_f in force: it holds gamma S, gamma = alpha_f/alpha_p. dS is what comes through the
 * port; gamma' S would be made by the computer. So gamma rises only as fast as a tank pays gamma' S, and the tank holds
 * what the operator has lost in the master's damping. In free air S = 0 and everything is allowed. */

ntf_rescale_state ntf_rescale_start(const ntf_rescale *rescale, const ntf_scaling *scaling)
{
    ntf_rescale_state state = {.now = *scaling, .wanted = *scaling};
    state.now.alpha_f *= rescale->factors[NTF_REGION_APPROACH];
    return state;
}

/* Free air is left by pressing; a pull that follows contact is adhesion, and the next free air ends it. */
static ntf_region region_of(const ntf_rescale *rescale, ntf_region last, float force)
{
    if (force > rescale->threshold)
        return NTF_REGION_INDENT;
    if (force < -rescale->threshold)
        return last == NTF_REGION_APPROACH ? NTF_REGION_APPROACH : NTF_REGION_RETRACT;
    return last == NTF_REGION_RETRACT ? NTF_REGION_APPROACH : last;
}

static float towards(float now, float wanted, float share)
{
    return clamp(wanted, now * (1.0f - share), now * (1.0f + share));
}

void ntf_rescale_step(const ntf_rescale *rescale, ntf_rescale_state *state, float slave_force, float stage_position,
                     float master_speed)
{
    state->work += slave_force * (stage_position - state->last_position);
    state->last_position = stage_position;
    state->tank = lesser(state->tank + rescale->income * master_speed * master_speed, rescale->capacity);
    const int is_free = slave_force <= rescale->threshold && slave_force >= -rescale->threshold;
    if (is_free)
        state->work = 0.0f;
    state->region = region_of(rescale, state->region, slave_force);
    const float alpha_f = state->wanted.alpha_f * rescale->factors[state->region];
    ntf_scaling *now = &state->now;
    if (now->alpha_f == alpha_f && now->alpha_p == state->wanted.alpha_p)
        return;
    const ntf_scaling next = {towards(now->alpha_p, state->wanted.alpha_p, rescale->share),
                             towards(now->alpha_f, alpha_f, rescale->share)};
    /* the lever's own energy at least, where a surface has risen under a stage that stands */
    const float held =
        is_free ? 0.0f : greater(state->work, 0.5f * slave_force * slave_force / rescale->spring_constant);
    const float price = (next.alpha_f / next.alpha_p - now->alpha_f / now->alpha_p) * held;
    if (price > state->tank)
        return;
    state->tank -= greater(price, 0.0f);
    *now = next;
}


/* --- control/follow.c --- */
/* Does the stage move as it is told? What it is told passes its lag; its read-out may be off by a slack. */



#define FOLLOW_TICKS 3u   /* in a row: HOLD; while lifting: LATCHED */
#define FOLLOW_SHARE 0.75f /* of the way it was to go lately: room for hysteresis */

void ntf_follow_expect(const ntf_supervisor *supervisor, ntf_supervisor_state *state, ntf_sum reference)
{
    if (isnan(state->expected))
        state->expected = reference;
    state->lifts = reference < state->reference;
    state->reference = reference;
    const float step = supervisor->stage_share * (reference - state->expected);
    state->expected += step;
    state->path = supervisor->path_kept * state->path + fabsf(step);
}

/* What of the way that it lifts a stage may lose, while the integral stands still; and, where ticks come late and lift
 * farther, the lag: the filter's part of it counts ticks, the stage's own does not [m]. */
static float lost_in_lift(const ntf_supervisor *supervisor, const ntf_supervisor_state *state)
{
    const int lifts = state->state >= NTF_RETRACT && isfinite(state->stopped);
    const float late = supervisor->limits.retract_speed * state->late / supervisor->stage_share;
    return lifts ? supervisor->lift_share * fabsf(state->expected - state->stopped) + late : 0.0f;
}

ntf_state ntf_follow_judge(const ntf_supervisor *supervisor, ntf_supervisor_state *state, float position, int tells_force)
{
    const ntf_limits *limits = &supervisor->limits;
    const float slack = lesser(supervisor->stage_most, greater(supervisor->stage_slack, FOLLOW_SHARE * state->path));
    const float below = position - state->expected; /* a stop may be farther up than it was told */
    const float off = state->state >= NTF_RETRACT ? below : fabsf(below);
    if (off <= slack + lost_in_lift(supervisor, state)) {
        state->off_run = 0;
        return NTF_RUN;
    }
    if (++state->off_run < FOLLOW_TICKS)
        return NTF_RUN;
    const int lasts = state->off_run * supervisor->period > limits->follow_time;
    if (state->state < NTF_RETRACT && lasts)
        state->lift = NTF_LIFT_WAITS;
    else if (state->state >= NTF_RETRACT && !tells_force)
        state->lift = state->lift < NTF_LIFT_TRIES ? NTF_LIFT_WAITS : NTF_LIFT_GIVEN_UP;
    return state->state >= NTF_RETRACT || lasts ? NTF_LATCHED : NTF_HOLD;
}

#undef FOLLOW_TICKS
#undef FOLLOW_SHARE

/* --- control/lift.c --- */
/* A stop lifts, keeps watching and lifts again: by retract_distance, once more whenever force shows, and as far as
 * travel allows while no force can be read. A stage that did not follow, or that goes the wrong way, stays where it is
 * until the force grows; then the force alone tells. Once the stage should have turned, a lift makes no force grow;
 * where one does, and the read-out does not show it rising, it is no lift and is given up. A read-out that does show it
 * says that the frame comes down faster, or a flank passes by below: then lifting is all there is to do. */



#define GROWTH_TICKS 3u /* in a row */
#define DRIFT 1e-9f      /* [m] */
#define FALL_SLACKS 2.0f /* what the stage may yet go when it is told to turn: its lag, and its ringing */

float ntf_lift_tolerance(const ntf_supervisor *supervisor)
{
    return supervisor->free_force + DRIFT * supervisor->spring_constant;
}

/* A tip that is let go springs back to 0: that is no growth. */
static void begin(ntf_supervisor_state *state, float force)
{
    state->turn = state->expected;
    state->lift_force = greater(0.0f, force);
    state->growth_run = 0;
}

/* By its read-out, which has told the truth so far. */
static int shows_rise(const ntf_supervisor *supervisor, const ntf_supervisor_state *state, float position)
{
    return state->lift == NTF_LIFT_GOES && position < state->turn_position - supervisor->turn_slack;
}

int ntf_lift_helps(const ntf_supervisor *supervisor, ntf_supervisor_state *state, float force, float position)
{
    const int runs = state->state < NTF_RETRACT, goes = state->lift == NTF_LIFT_GOES;
    if (runs) {
        state->lift = NTF_LIFT_GOES;
        state->stopped = state->expected;
    }
    if (runs || (goes && !state->lifts)) {
        begin(state, force);
        return 1;
    }
    const int has_turned = !goes || state->expected < state->turn - supervisor->turn_slack; /* else it began at rest */
    if (!has_turned)
        state->lift_force = greater(state->lift_force, force);
    const int grows = has_turned && force > state->lift_force + ntf_lift_tolerance(supervisor);
    state->growth_run = grows ? state->growth_run + 1u : 0u;
    if (state->growth_run < GROWTH_TICKS || shows_rise(supervisor, state, position))
        return 1;
    if (state->lift == NTF_LIFT_WAITS) {
        state->lift = NTF_LIFT_TRIES;
        begin(state, force);
        return 1;
    }
    state->lift = NTF_LIFT_GIVEN_UP;
    return 0;
}

/* Is it read well below the farthest that it has come, and farther down than where that began? A slip is over at once;
 * a stage that goes the wrong way goes on. */
static int falls_on(const ntf_supervisor *supervisor, ntf_supervisor_state *state, float position)
{
    state->top_position = lesser(state->top_position, position);
    if (position <= state->top_position + FALL_SLACKS * supervisor->turn_slack)
        state->fall_position = INFINITY;
    else if (isinf(state->fall_position))
        state->fall_position = position;
    return position > state->fall_position + supervisor->turn_slack;
}

int ntf_lift_rises(const ntf_supervisor *supervisor, ntf_supervisor_state *state, float position)
{
    const int goes = state->state >= NTF_RETRACT && state->lift == NTF_LIFT_GOES && state->lifts;
    if (!goes)
        state->turn_position = state->top_position = position;
    state->fall_run = falls_on(supervisor, state, position) ? state->fall_run + 1u : 0u;
    if (state->fall_run < GROWTH_TICKS)
        return 1;
    state->lift = NTF_LIFT_WAITS;
    return 0;
}

float ntf_lift_distance(const ntf_touch *touch, ntf_touch_state *state)
{
    const float distance = touch->settings.limits.retract_distance;
    if (state->supervisor.lift != NTF_LIFT_GOES && state->supervisor.lift != NTF_LIFT_TRIES)
        return 0.0f;
    if (state->supervisor.presses && state->retracted >= distance)
        state->retracted = 0.0f;
    return distance;
}

#undef GROWTH_TICKS
#undef DRIFT
#undef FALL_SLACKS

/* --- control/stuck.c --- */
/* A live sensor shows its noise; none while z moves means that it is dead. How much it has is learnt from its first
 * samples, so that a sensor better than declared is not taken for a dead one, and one that has lost its gain is. */



#define BAND 0.25f     /* of its standard deviation: a living sensor keeps to it once in 10^35 */
#define BLOCK 50u     /* samples */
#define SAMPLES 200u  /* that are looked at */
#define STEP 1.128379f /* mean |difference| of two normal numbers, over sigma */

/* The noise of the quietest block; no more than declared. */
static void learn_noise(const ntf_supervisor *supervisor, ntf_supervisor_state *state, float deflection)
{
    if (state->noise_samples == SAMPLES)
        return;
    if (state->noise_samples > 0)
        state->noise_sum += fabsf(deflection - state->last_deflection);
    state->last_deflection = deflection;
    if (++state->noise_samples % BLOCK > 0)
        return;
    const float noise = state->noise_sum / (STEP * BLOCK);
    state->noise = state->noise_samples == BLOCK ? noise : lesser(state->noise, noise);
    state->noise_sum = 0.0f;
    if (state->noise_samples == SAMPLES)
        state->stuck_band = BAND * lesser(state->noise, supervisor->noise);
}

/* The count stands at NTF_STUCK_SAMPLES until z has moved, so that HOLD comes first. */
ntf_state ntf_stuck_judge(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample,
                        int shows_none)
{
    const float deflection = sample->deflection[NTF_Z], position = sample->stage_position[NTF_Z];
    if (supervisor->stuck_distance == 0.0f)
        return NTF_RUN;
    learn_noise(supervisor, state, deflection);
    if (shows_none || !(fabsf(deflection - state->stuck_deflection) <= state->stuck_band)) {
        state->stuck_deflection = deflection;
        state->stuck_position = position;
        state->stuck_run = 0;
        return NTF_RUN;
    }
    const int moved = fabsf(position - state->stuck_position) > supervisor->stuck_distance;
    if (state->stuck_run < NTF_STUCK_SAMPLES || (moved && state->stuck_run < 2 * NTF_STUCK_SAMPLES))
        ++state->stuck_run;
    if (state->stuck_run < NTF_STUCK_SAMPLES || !moved)
        return NTF_RUN;
    return state->stuck_run < 2 * NTF_STUCK_SAMPLES ? NTF_HOLD : NTF_LATCHED;
}

#undef BAND
#undef BLOCK
#undef SAMPLES
#undef STEP

/* --- control/supervisor.c --- */
/* What happens when something is wrong: RUN, HOLD, RETRACT, LATCHED as a pure function of sample, command and limits
 * (docs/safety.md holds the table). Jump-in and pull-off are the physics of the scene and trip nothing. */



#define STALE_HOLD_PERIODS 2.0f
#define STALE_RETRACT_PERIODS 5.0f
#define LATE_PERIODS 0.2f
#define MOST_LATE 1000.0f /* periods: what a stop makes up for in one tick */
#define LATE_TICKS 5u    /* in a row: HOLD, until as many punctual ones have made up for them */

ntf_supervisor_state ntf_supervisor_start(void)
{
    return (ntf_supervisor_state){
        .state = NTF_RUN, .stuck_deflection = NAN, .surface = NAN, .expected = NAN}; /* nothing seen yet */
}

static ntf_state worse(ntf_state a, ntf_state b)
{
    return a > b ? a : b;
}

/* NaN fails every comparison. */
static int is_within(float value, float range)
{
    return fabsf(value) <= range;
}

static int is_within_sideways(const ntf_supervisor *supervisor, const ntf_sample *sample)
{
    return is_within(sample->master_position[NTF_X], supervisor->master_range) &&
           is_within(sample->master_position[NTF_Y], supervisor->master_range);
}

/* A lever that shows lateral forces does so always. */
static int shows_sideways(const ntf_supervisor *supervisor, const ntf_sample *sample)
{
    return supervisor->lateral_stiffness == 0.0f ||
           (isfinite(sample->deflection[NTF_X]) && isfinite(sample->deflection[NTF_Y]));
}

/* Numbers that no sensor of this rig can give (twice its range) are as bad as no numbers. The deflection is judged by
 * its force. */
static int is_valid(const ntf_supervisor *supervisor, const ntf_sample *sample)
{
    const float gauge = supervisor->gauge_range;
    return !(sample->flags & (NTF_SAMPLE_INVALID | NTF_SAMPLE_DEVICE_LOST)) &&
           is_within(sample->master_position[NTF_Z], supervisor->master_range) &&
           (!supervisor->leads_sideways || is_within_sideways(supervisor, sample)) &&
           (gauge == 0.0f || is_within(sample->operator_force[NTF_Z], 2.0f * gauge)) &&
           is_within(sample->stage_position[NTF_Z], supervisor->stage_range) && isfinite(sample->deflection[NTF_Z]) &&
           shows_sideways(supervisor, sample) && isfinite(sample->stage_position[NTF_X]) &&
           isfinite(sample->stage_position[NTF_Y]) && isfinite(sample->age) && sample->age >= 0.0f;
}

static ntf_state blame(ntf_supervisor_state *state, uint32_t reason, ntf_state verdict)
{
    state->reasons |= reason;
    return verdict;
}

/* One bad sample: hold, reuse nothing; the second in a row: retract. Never "zero force". */
static ntf_state judge_validity(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample)
{
    if (is_valid(supervisor, sample)) {
        state->invalid_run = 0;
        return NTF_RUN;
    }
    return blame(state, NTF_REASON_INVALID, ++state->invalid_run > 1 ? NTF_RETRACT : NTF_HOLD);
}

static int is_saturated(const ntf_supervisor *supervisor, const ntf_sample *sample)
{
    return sample->flags & NTF_SAMPLE_SATURATED || fabsf(sample->deflection[NTF_Z]) >= supervisor->deflection_range;
}

/* Does the sample tell how the force changes? A sensor that shows noise again does. */
static int tells_force(const ntf_supervisor *supervisor, const ntf_supervisor_state *state, const ntf_sample *sample)
{
    return isfinite(sample->deflection[NTF_Z]) && !is_saturated(supervisor, sample) &&
           state->stuck_run < NTF_STUCK_SAMPLES;
}

static int is_held_too_hard(const ntf_supervisor *supervisor, const ntf_sample *sample)
{
    const float stiffness = supervisor->lateral_stiffness;
    return stiffness > 0.0f && stiffness * hypotenuse(sample->deflection[NTF_X], sample->deflection[NTF_Y]) >
                                  supervisor->limits.lateral_force;
}

static ntf_state judge_force(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample,
                            int saturated)
{
    const float force = supervisor->spring_constant * sample->deflection[NTF_Z];
    ntf_state verdict = NTF_RUN;
    if (saturated)
        verdict = blame(state, NTF_REASON_SATURATED, NTF_RETRACT);
    if (fabsf(force) > supervisor->limits.force)
        verdict = blame(state, NTF_REASON_FORCE_LIMIT, NTF_RETRACT);
    if (is_held_too_hard(supervisor, sample))
        verdict = blame(state, NTF_REASON_LATERAL, NTF_RETRACT);
    if (supervisor->gauge_range > 0.0f && fabsf(sample->operator_force[NTF_Z]) >= supervisor->gauge_range)
        state->reasons |= NTF_REASON_OPERATOR_CLIPPED;
    return verdict;
}

/* The tip's travel since it was last free. A surface that passes by below rises and falls: its travel is not counted.
 */
static ntf_state judge_indentation(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample,
                                  int moves_sideways)
{
    const float travel = sample->stage_position[NTF_Z] - sample->deflection[NTF_Z]; /* of the tip, towards the sample */
    const int is_free = fabsf(supervisor->spring_constant * sample->deflection[NTF_Z]) <= supervisor->free_force;
    if (is_free || isnan(state->surface))
        state->surface = travel;
    else if (moves_sideways)
        state->surface = travel - state->indentation;
    state->indentation = travel - state->surface;
    return state->indentation > supervisor->limits.indentation ? blame(state, NTF_REASON_INDENTATION, NTF_RETRACT)
                                                               : NTF_RUN;
}

/* A hand that is no longer heard of: the stage stays, the force fades. Nothing says that the tip is in danger. */
static ntf_state judge_master_age(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample)
{
    const float age = sample->master_age; /* below 0: its clock has jumped */
    const int is_fresh = age >= 0.0f && age <= STALE_HOLD_PERIODS * supervisor->master_period;
    return !is_fresh ? blame(state, NTF_REASON_MASTER_STALE, NTF_HOLD) : NTF_RUN;
}

static ntf_state judge_age(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample)
{
    if (sample->age <= STALE_HOLD_PERIODS * supervisor->period)
        return judge_master_age(supervisor, state, sample);
    const int retracts = sample->age > STALE_RETRACT_PERIODS * supervisor->period;
    return blame(state, NTF_REASON_STALE, retracts ? NTF_RETRACT : NTF_HOLD);
}

/* NaN is late. */
static ntf_state judge_lateness(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample)
{
    const int is_late = !(sample->lateness <= LATE_PERIODS * supervisor->period);
    const int held = state->late_run > LATE_TICKS;
    if (is_late) {
        ++state->late_ticks;
        state->late_run = state->late_run + 1 < LATE_TICKS ? state->late_run + 1 : 2u * LATE_TICKS;
    } else if (held) {
        --state->late_run;
    } else {
        state->late_run = 0;
    }
    return state->late_run > LATE_TICKS ? blame(state, NTF_REASON_LATE, NTF_HOLD) : NTF_RUN;
}

/* HOLD steps the probe away (touch.c); if that changes nothing for as many samples again: LATCHED. */
static ntf_state judge_stuck(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample,
                            int saturated)
{
    const ntf_state verdict = ntf_stuck_judge(supervisor, state, sample, saturated);
    return verdict == NTF_RUN ? NTF_RUN : blame(state, NTF_REASON_STUCK, verdict);
}

/* NaN or infinite: nobody knows how late, and nothing is made up for. */
static float known_lateness(const ntf_supervisor *supervisor, const ntf_sample *sample)
{
    return sample->lateness > 0.0f && isfinite(sample->lateness)
               ? lesser(sample->lateness, MOST_LATE * supervisor->period)
               : 0.0f;
}

static ntf_state judge_follow(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample)
{
    const float position = sample->stage_position[NTF_Z];
    const ntf_state found = ntf_follow_judge(supervisor, state, position, tells_force(supervisor, state, sample));
    const ntf_state place = found == NTF_RUN ? NTF_RUN : blame(state, NTF_REASON_FOLLOW, found);
    return ntf_lift_rises(supervisor, state, position) ? place
                                                      : worse(place, blame(state, NTF_REASON_FOLLOW, NTF_LATCHED));
}

static ntf_state judge_growth(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample)
{
    const float force = supervisor->spring_constant * sample->deflection[NTF_Z];
    const int helps = ntf_lift_helps(supervisor, state, force, sample->stage_position[NTF_Z]);
    return helps ? NTF_RUN : blame(state, NTF_REASON_FOLLOW, NTF_LATCHED);
}

/* Does it move as it is told, and does lifting help? */
static ntf_state judge_motion(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample)
{
    if (sample->age > STALE_HOLD_PERIODS * supervisor->period)
        return NTF_RUN;
    const ntf_state growth = judge_growth(supervisor, state, sample);
    return worse(growth, judge_follow(supervisor, state, sample));
}

/* Of a sample that is not valid only this is used, and only to stop: a reading that is a number may say that it does
 * not move as it is told. */
static ntf_state judge_remains(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample)
{
    const int is_fresh = sample->age >= 0.0f && sample->age <= STALE_HOLD_PERIODS * supervisor->period;
    if (!is_fresh || sample->flags & (NTF_SAMPLE_INVALID | NTF_SAMPLE_DEVICE_LOST))
        return NTF_RUN;
    const int has_force = isfinite(sample->deflection[NTF_Z]);
    const ntf_state growth = has_force ? judge_growth(supervisor, state, sample) : NTF_RUN;
    return is_within(sample->stage_position[NTF_Z], supervisor->stage_range)
               ? worse(growth, judge_follow(supervisor, state, sample))
               : growth;
}

/* In a stop: is there force at the tip, or may there be? */
static int may_press(const ntf_supervisor *supervisor, const ntf_supervisor_state *state, const ntf_sample *sample)
{
    const int reads = state->invalid_run == 0 && sample->age <= STALE_HOLD_PERIODS * supervisor->period &&
                      !(state->reasons & NTF_REASON_STUCK);
    return !reads || fabsf(supervisor->spring_constant * sample->deflection[NTF_Z]) > supervisor->free_force;
}

static ntf_state judge_stops(ntf_supervisor_state *state, const ntf_sample *sample)
{
    ntf_state verdict = NTF_RUN;
    if (sample->flags & NTF_SAMPLE_LIMIT_SWITCH)
        verdict = blame(state, NTF_REASON_LIMIT_SWITCH, NTF_RETRACT);
    if (sample->flags & NTF_SAMPLE_EMERGENCY_STOP)
        verdict = blame(state, NTF_REASON_EMERGENCY_STOP, NTF_LATCHED);
    if (sample->flags & NTF_SAMPLE_DEVICE_LOST)
        verdict = blame(state, NTF_REASON_DEVICE, NTF_LATCHED);
    return verdict;
}

/* What only a valid sample can tell. */
static ntf_state judge_measured(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample,
                               const ntf_situation *situation)
{
    const int saturated = is_saturated(supervisor, sample);
    ntf_state verdict = judge_force(supervisor, state, sample, saturated);
    verdict = worse(verdict, judge_indentation(supervisor, state, sample, situation->moves_sideways));
    verdict = worse(verdict, judge_age(supervisor, state, sample));
    verdict = worse(verdict, judge_motion(supervisor, state, sample));
    return worse(verdict, judge_stuck(supervisor, state, sample, saturated));
}

/* RETRACT and LATCHED are not left by themselves. */
static ntf_state take(ntf_supervisor_state *state, ntf_state verdict)
{
    state->state = state->state >= NTF_RETRACT ? worse(state->state, verdict) : verdict;
    return state->state;
}

ntf_state ntf_supervisor_step(const ntf_supervisor *supervisor, ntf_supervisor_state *state, const ntf_sample *sample,
                            const ntf_situation *situation)
{
    if (state->state < NTF_RETRACT) /* else the reason that led there stays */
        state->reasons = 0;
    state->late = known_lateness(supervisor, sample);
    ntf_follow_expect(supervisor, state, situation->reference);
    ntf_state verdict = judge_stops(state, sample);
    const ntf_state validity = judge_validity(supervisor, state, sample);
    verdict = worse(verdict, validity);
    verdict = worse(verdict, validity == NTF_RUN ? judge_measured(supervisor, state, sample, situation)
                                                : judge_remains(supervisor, state, sample));
    verdict = worse(verdict, judge_lateness(supervisor, state, sample));
    if (situation->unstable)
        verdict = worse(verdict, blame(state, NTF_REASON_UNSTABLE, NTF_HOLD));
    state->presses = may_press(supervisor, state, sample);
    return take(state, verdict);
}

ntf_state ntf_supervisor_fail_law(ntf_supervisor_state *state)
{
    return take(state, blame(state, NTF_REASON_LAW, ++state->law_run > 1 ? NTF_RETRACT : NTF_HOLD));
}

ntf_status ntf_supervisor_arm(ntf_supervisor_state *state, int confirmed)
{
    if (state->state == NTF_LATCHED && !confirmed)
        return NTF_E_STATE;
    ntf_supervisor_state fresh = ntf_supervisor_start();
    fresh.stuck_deflection = state->stuck_deflection;
    fresh.surface = state->surface;
    fresh.indentation = state->indentation;
    fresh.late_ticks = state->late_ticks;
    fresh.expected = state->expected;
    fresh.stuck_band = state->stuck_band;
    fresh.noise_samples = state->noise_samples;
    fresh.noise_sum = state->noise_sum;
    fresh.noise = state->noise;
    fresh.last_deflection = state->last_deflection;
    *state = fresh;
    return NTF_OK;
}

#undef STALE_HOLD_PERIODS
#undef STALE_RETRACT_PERIODS
#undef LATE_PERIODS
#undef MOST_LATE
#undef LATE_TICKS

/* --- control/modes.c --- */
/* The modes: who moves the stage, and what the operator feels of it. */



#define FADE_TIME 0.05f  /* uncoupled, the force is gone after this [s] */
#define FADED 1e-6f      /* engaged by no more than this it is gone: rounding shall not decide in which tick */
#define FOUND_SHARE 0.9f /* of the set-point: the surface is found */

/* Moves the reference towards `wanted`, no faster than the stage may go and inside its travel; 1 if it is there. */
static int move_reference(const ntf_touch *touch, ntf_touch_state *state, ntf_sum wanted)
{
    const ntf_sum slewed = clamp(wanted, state->reference - touch->stage_step, state->reference + touch->stage_step);
    state->reference = clamp(slewed, -touch->stage_end, touch->stage_end);
    if (state->reference == wanted)
        return 1;
    state->supervisor.reasons |= NTF_REASON_COMMAND_LIMITED;
    return 0;
}

static float step_of(const ntf_touch *touch, float speed)
{
    return speed * touch->period;
}

/* A virtual tool without mass: a spring holds it to the master, a damper to the ground, the tip's force acts on it, and
 * the stage follows it. The operator feels the spring, never a contact stiffer than it, and what comes late through the
 * stage moves the tool alone. At rest the spring's force is alpha_f f_s. One implicit step; the spring's force [N]. */
static float couple(const ntf_touch *touch, ntf_touch_state *state)
{
    const ntf_gains *gains = &touch->settings.gains;
    const ntf_signals *signals = &state->signals;
    const float reflected = signals->scaling.alpha_f * state->projected_force;
    if (gains->coupling_stiffness == 0.0f)
        return reflected;
    const float drag = gains->coupling_damping * gains->rate; /* over a period [N/m] */
    const float stretch = state->stretch + signals->master_speed * touch->period;
    state->stretch = (drag * stretch + reflected) / (gains->coupling_stiffness + drag);
    return gains->coupling_stiffness * state->stretch;
}

static void engage(const ntf_touch *touch, ntf_touch_state *state)
{
    const float ramp = touch->settings.gains.ramp_time;
    state->engaged = ramp > 0.0f ? lesser(1.0f, state->engaged + touch->period / ramp) : 1.0f;
}

static float run_touch(const ntf_touch *touch, ntf_touch_state *state)
{
    ntf_signals *signals = &state->signals;
    signals->felt_force = couple(touch, state) / signals->scaling.alpha_f;
    signals->target = signals->scaling.alpha_p * (signals->master_position - state->stretch) + state->offset;
    const ntf_effort effort = touch->law(touch->settings.control.context, &touch->settings.gains, signals);
    if (!isfinite(effort.motor_force) || !isfinite(effort.stage))
        return NAN;
    move_reference(touch, state, effort.stage);
    engage(touch, state);
    return state->engaged * effort.motor_force + ntf_passivity_damping_force(&touch->passivity, &state->passivity);
}

/* How far the height servo would go in this period towards the set-point [m]. */
static float height_step(const ntf_touch *touch, const ntf_touch_state *state)
{
    const ntf_gains *gains = &touch->settings.gains;
    const float error = (gains->set_point - state->signals.slave_force) / touch->rig.probe.spring_constant;
    return step_of(touch, gains->height_gain * error);
}

static float run_topography(const ntf_touch *touch, ntf_touch_state *state)
{
    move_reference(touch, state, state->reference + height_step(touch, state));
    engage(touch, state);
    const float height_position = (state->reference - state->offset) / state->signals.scaling.alpha_p;
    return state->engaged * ntf_motor_height(&touch->settings.gains, height_position, state->signals.master_position);
}

static float run_approach(const ntf_touch *touch, ntf_touch_state *state)
{
    const float most = step_of(touch, touch->settings.gains.approach_speed);
    const int is_free = state->signals.slave_force <= touch->supervisor.free_force; /* or drawn in */
    const float step = is_free ? most : clamp(height_step(touch, state), -most, most);
    move_reference(touch, state, state->reference + step);
    if (state->signals.slave_force >= FOUND_SHARE * touch->settings.gains.set_point)
        state->phase = NTF_PHASE_DONE;
    return ntf_mode_release(touch, state);
}

static float run_curve(const ntf_touch *touch, ntf_touch_state *state)
{
    const ntf_gains *gains = &touch->settings.gains;
    const float step = step_of(touch, gains->approach_speed);
    if (state->phase == NTF_PHASE_DOWN) {
        const int moved = move_reference(touch, state, state->reference + step);
        state->turn = state->reference;
        if (!moved || state->signals.slave_force >= gains->set_point)
            state->phase = NTF_PHASE_UP;
    } else if (state->phase == NTF_PHASE_UP) {
        const ntf_sum end = state->turn - gains->curve_length;
        const int moved = move_reference(touch, state, greater(end, state->reference - step));
        if (!moved || state->reference <= end)
            state->phase = NTF_PHASE_DONE;
    }
    return ntf_mode_release(touch, state);
}

/* A mode is left as a stop is: the force fades out where the stage stands. */
static float leave(const ntf_touch *touch, ntf_touch_state *state)
{
    const float force = ntf_mode_release(touch, state);
    if (state->engaged > 0.0f)
        return force;
    state->mode = state->wanted_mode;
    state->phase = NTF_PHASE_DOWN;
    return force;
}

float ntf_mode_run(const ntf_touch *touch, ntf_touch_state *state)
{
    if (state->mode != state->wanted_mode)
        return leave(touch, state);
    if (state->clutch_open)
        return ntf_mode_release(touch, state);
    switch (state->mode) {
    case NTF_MODE_TOUCH:
        return run_touch(touch, state);
    case NTF_MODE_TOPOGRAPHY:
        return run_topography(touch, state);
    case NTF_MODE_APPROACH:
        return run_approach(touch, state);
    case NTF_MODE_CURVE:
        return run_curve(touch, state);
    }
    return NAN;
}

float ntf_mode_release(const ntf_touch *touch, ntf_touch_state *state)
{
    const ntf_signals *signals = &state->signals;
    state->stretch = 0.0f;
    state->offset = state->reference - signals->scaling.alpha_p * signals->master_position;
    const ntf_sum engaged = state->engaged - touch->period / FADE_TIME;
    if (!(engaged > FADED))
        return state->engaged = state->coupled_force = 0.0f;
    state->coupled_force *= engaged / state->engaged; /* linear in time */
    state->engaged = engaged;
    return ntf_motor_fade(&touch->rig.master, state->coupled_force, signals->smooth_speed);
}

float ntf_mode_stop(const ntf_touch *touch, ntf_touch_state *state, float distance)
{
    if (state->retracted < distance) {
        const float time = touch->period + state->supervisor.late;
        const float step = lesser(touch->settings.limits.retract_speed * time, distance - state->retracted);
        state->retracted += step;
        state->reference = greater(state->reference - step, -touch->stage_end);
    }
    return ntf_mode_release(touch, state);
}

#undef FADE_TIME
#undef FADED
#undef FOUND_SHARE

/* --- control/sideways.c --- */
/* x and y of a touch: where the tip goes, and what the hand feels of what holds it. */



void ntf_sideways_follow_hand(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample)
{
    for (int i = NTF_X; i < NTF_Z; ++i) {
        const float step = sample->master_position[i] - state->hand_at[i];
        if (isfinite(step)) {
            const float speed = step * touch->settings.gains.rate;
            state->hand_speed[i] += touch->speed_filter * (speed - state->hand_speed[i]);
        }
        if (isfinite(step) && state->engaged > 0.0f && !state->clutch_open)
            state->sideways[i] += step; /* nothing while they are uncoupled */
        state->hand_at[i] = sample->master_position[i];
    }
}

/* What the hand shall feel of a force along an axis, before the motor's limits [N]. */
static float felt_of(const ntf_touch_state *state, int axis, float force)
{
    return state->passivity_sideways[axis].gain * state->engaged * force;
}

/* x and y back off together. */
static void tie(ntf_passivity_state of[2])
{
    of[NTF_X].gain = of[NTF_Y].gain = lesser(of[NTF_X].gain, of[NTF_Y].gain);
    of[NTF_X].damping = of[NTF_Y].damping = greater(of[NTF_X].damping, of[NTF_Y].damping);
}

void ntf_sideways_watch(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample, int closed)
{
    const ntf_passivity *passivity = &touch->passivity_sideways;
    const uint64_t acting = state->ticks + NTF_TOUCH_SENT - 1u - touch->delay; /* the tick whose force has been held */
    for (int i = NTF_X; i < NTF_Z; ++i) {
        ntf_passivity_state *of = &state->passivity_sideways[i];
        const float step = (sample->stage_position[i] - state->stage_at[i]) / state->signals.scaling.alpha_p;
        const ntf_port hand = {-state->sent[acting % NTF_TOUCH_SENT][i], sample->master_position[i]};
        const float force = state->signals.scaling.alpha_f * state->lateral_force[i];
        const ntf_port tip = {-felt_of(state, i, force), of->last_tip.position + (isfinite(step) ? step : 0.0f)};
        state->stage_at[i] = sample->stage_position[i];
        if (closed && isfinite(step) && isfinite(hand.position))
            ntf_passivity_step(passivity, of, &hand, &tip);
        of->last_hand = hand;
        of->last_tip = tip;
    }
    tie(state->passivity_sideways);
}

void ntf_sideways_read(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample)
{
    const ntf_gains *gains = &touch->settings.gains;
    const float stiffness = touch->rig.probe.lateral_stiffness;
    const float shares[] = {gains->projection_x, gains->projection_y};
    state->projected_force = state->signals.slave_force;
    for (int i = NTF_X; i < NTF_Z && stiffness > 0.0f; ++i) {
        state->lateral_force[i] = stiffness * sample->deflection[i];
        if (shares[i] != 0.0f)
            state->projected_force += shares[i] * state->lateral_force[i];
    }
}

/* A master of three axes leads the tip sideways, as it presses: from where it was last coupled, no faster than the
 * lateral limit. */
static void follow(const ntf_touch *touch, ntf_touch_state *state)
{
    const float most = touch->settings.limits.lateral_speed * touch->period;
    float *stage = state->command.stage_position, way[2];
    for (int i = NTF_X; i < NTF_Z; ++i)
        way[i] = state->signals.scaling.alpha_p * state->sideways[i];
    const float length = hypotenuse(way[NTF_X], way[NTF_Y]), share = length > most ? most / length : 1.0f;
    for (int i = NTF_X; i < NTF_Z; ++i) {
        const float wanted = stage[i] + share * way[i];
        stage[i] = clamp(wanted, touch->borders[i][0], touch->borders[i][1]);
        if (stage[i] != wanted)
            state->supervisor.reasons |= NTF_REASON_COMMAND_LIMITED;
        state->sideways[i] *= 1.0f - share; /* what is left is owed */
    }
    state->target_x = stage[NTF_X];
    state->target_y = stage[NTF_Y];
}

void ntf_sideways_move(const ntf_touch *touch, ntf_touch_state *state)
{
    if (touch->leads_sideways) {
        follow(touch, state);
        return;
    }
    const ntf_sum left = state->target_time;
    const float share = left > touch->period ? touch->period / left : 1.0f;
    state->command.stage_position[NTF_X] += share * (state->target_x - state->command.stage_position[NTF_X]);
    state->command.stage_position[NTF_Y] += share * (state->target_y - state->command.stage_position[NTF_Y]);
    state->target_time = greater(0.0f, left - touch->period);
}

void ntf_sideways_drive(const ntf_touch *touch, ntf_touch_state *state)
{
    if (!touch->feels_sideways)
        return;
    const int coupled = state->supervisor.state == NTF_RUN && state->mode == NTF_MODE_TOUCH &&
                        state->wanted_mode == NTF_MODE_TOUCH && !state->clutch_open;
    for (int i = NTF_X; i < NTF_Z; ++i) {
        if (coupled)
            state->coupled_sideways[i] = state->signals.scaling.alpha_f * state->lateral_force[i];
        else if (!(state->engaged > 0.0f))
            state->coupled_sideways[i] = 0.0f;
        const float felt = felt_of(state, i, state->coupled_sideways[i]), speed = state->hand_speed[i];
        const int fades = !coupled && felt != 0.0f;
        const float damped =
            felt + ntf_passivity_damping_force(&touch->passivity_sideways, &state->passivity_sideways[i]);
        const float wanted = fades ? ntf_motor_fade(&touch->rig.master, felt, speed) : damped;
        state->command.motor_force[i] =
            ntf_motor_limit(&touch->settings.limits, touch->motor_step, state->command.motor_force[i], wanted, speed);
    }
}


/* --- control/touch.c --- */
/* One control period: supervisor, observation, mode and law, limits, stage loop. */



#define PROBE_STEPS 20.0f /* a sensor that seems stuck is tried by stepping away by this many of the stage's steps */

ntf_touch_state ntf_touch_start(const ntf_touch *touch, float master_position, float x, float y)
{
    const ntf_gains *gains = &touch->settings.gains;
    const ntf_scaling scaling = {gains->alpha_p, gains->alpha_f};
    ntf_touch_state state = {.mode = touch->mode,
                            .wanted_mode = touch->mode,
                            .supervisor = ntf_supervisor_start(),
                            .passivity = {.gain = 1.0f, .last_hand = {.position = master_position}},
                            .passivity_sideways = {{.gain = 1.0f}, {.gain = 1.0f}},
                            .rescale = ntf_rescale_start(&touch->rescale, &scaling),
                            .signals = {.period = touch->period,
                                        .master_position = master_position,
                                        .master_damping = touch->rig.master.damping,
                                        .gain_factor = 1.0f},
                            .target_x = x,
                            .target_y = y,
                            .command = {.stage_position = {x, y}}};
    state.signals.scaling = state.rescale.now;
    state.hand_at[NTF_X] = state.hand_at[NTF_Y] = NAN; /* until it is seen */
    state.stage_at[NTF_X] = state.stage_at[NTF_Y] = NAN;
    state.offset = -gains->alpha_p * master_position; /* the stage begins at 0 */
    return state;
}

/* A single reading that nothing real can have made gives way to the one between it and the last two; a true jump shows
 * one period late. */
static float without_spike(const ntf_touch *touch, ntf_touch_state *state, float deflection)
{
    const float last = state->deflections[0], before = state->deflections[1];
    state->deflections[1] = last;
    state->deflections[0] = deflection;
    if (fabsf(deflection - last) <= touch->spike)
        return deflection;
    return greater(lesser(deflection, last), lesser(greater(deflection, last), before));
}

/* Positions, and speeds by differences. */
static void follow_motion(const ntf_touch *touch, ntf_signals *signals, const ntf_sample *sample)
{
    const float rate = touch->settings.gains.rate;
    signals->master_speed = (sample->master_position[NTF_Z] - signals->master_position) * rate;
    signals->smooth_speed += touch->speed_filter * (signals->master_speed - signals->smooth_speed);
    signals->stage_speed = (sample->stage_position[NTF_Z] - signals->stage_position) * rate;
    signals->master_position = sample->master_position[NTF_Z];
    signals->stage_position = sample->stage_position[NTF_Z];
}

/* A new alpha_p counts from where the master is: no bump. */
static void rescale(const ntf_touch *touch, ntf_touch_state *state)
{
    ntf_signals *signals = &state->signals;
    const float alpha_p = state->rescale.now.alpha_p;
    ntf_rescale_step(&touch->rescale, &state->rescale, signals->slave_force, signals->stage_position,
                    signals->smooth_speed);
    signals->scaling = state->rescale.now;
    state->offset += (alpha_p - signals->scaling.alpha_p) * signals->master_position;
}

/* What goes in at the hand, and what comes out at the tip at the operator's scale; behind a virtual coupling, whose
 * spring stores energy, what goes into that. */
static void watch_energy(const ntf_touch *touch, ntf_touch_state *state, float stage_step)
{
    const ntf_signals *signals = &state->signals;
    const ntf_scaling *scaling = &signals->scaling;
    ntf_passivity_state *passivity = &state->passivity;
    const uint64_t acting = state->ticks + NTF_TOUCH_SENT - 1u - touch->delay; /* the tick whose force has been held */
    const float hand_force =
        touch->rig.master.gauge ? signals->operator_force : -state->sent[acting % NTF_TOUCH_SENT][NTF_Z];
    const ntf_port hand = {hand_force, signals->master_position};
    const int coupled = touch->settings.gains.coupling_stiffness > 0.0f;
    const float tip_step =
        coupled ? signals->master_position - passivity->last_hand.position : stage_step / scaling->alpha_p;
    const ntf_port tip = {scaling->alpha_f * (coupled ? signals->felt_force : state->projected_force),
                         passivity->last_tip.position + tip_step};
    if (state->supervisor.reasons & NTF_REASON_OPERATOR_CLIPPED) { /* the hand gives more than the gauge can tell */
        passivity->last_hand = hand;
        passivity->last_tip = tip;
        return;
    }
    ntf_passivity_step(&touch->passivity, passivity, &hand, &tip);
    state->signals.gain_factor = passivity->gain;
}

static void observe(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample)
{
    ntf_signals *signals = &state->signals;
    const float stage_step = sample->stage_position[NTF_Z] - signals->stage_position;
    follow_motion(touch, signals, sample);
    if (touch->leads_sideways)
        ntf_sideways_follow_hand(touch, state, sample);
    signals->operator_force = touch->rig.master.gauge ? sample->operator_force[NTF_Z] : 0.0f;
    signals->smooth_force += touch->force_filter * (signals->operator_force - signals->smooth_force);
    signals->slave_force = touch->rig.probe.spring_constant * without_spike(touch, state, sample->deflection[NTF_Z]);
    ntf_sideways_read(touch, state, sample);
    rescale(touch, state);
    const int closes = touch->rig.master.motor; /* without a motor no loop closes through the hand */
    if (closes && state->mode == NTF_MODE_TOUCH) /* a servo is meant to move the hand */
        watch_energy(touch, state, stage_step);
    if (touch->feels_sideways)
        ntf_sideways_watch(touch, state, sample, closes && state->mode == NTF_MODE_TOUCH);
}

static int moves_sideways(const ntf_touch_state *state)
{
    return state->sideways[NTF_X] != 0.0f || state->sideways[NTF_Y] != 0.0f ||
           state->target_x != state->command.stage_position[NTF_X] ||
           state->target_y != state->command.stage_position[NTF_Y];
}

static int is_exhausted(const ntf_touch_state *state)
{
    return ntf_passivity_is_exhausted(&state->passivity) || ntf_passivity_is_exhausted(&state->passivity_sideways[NTF_X]);
}

static ntf_state supervise(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample)
{
    const ntf_situation situation = {.reference = state->reference,
                                    .moves_sideways = moves_sideways(state),
                                    .unstable = state->mode == NTF_MODE_TOUCH && is_exhausted(state)};
    return ntf_supervisor_step(&touch->supervisor, &state->supervisor, sample, &situation);
}

/* How far a stop lifts in all [m]. */
static float lift_of(const ntf_touch *touch, ntf_touch_state *state)
{
    if (state->supervisor.state >= NTF_RETRACT)
        return ntf_lift_distance(touch, state);
    return state->supervisor.reasons & NTF_REASON_STUCK ? PROBE_STEPS * touch->rig.stage.resolution : 0.0f;
}

/* Mode and law, or what a stop leaves; the motor force that is wanted. */
static float act(const ntf_touch *touch, ntf_touch_state *state)
{
    if (state->supervisor.state == NTF_RUN) {
        const float force = ntf_mode_run(touch, state);
        if (isfinite(force)) {
            state->supervisor.law_run = 0;
            state->retracted = 0.0f;
            ntf_sideways_move(touch, state);
            return force;
        }
        ntf_supervisor_fail_law(&state->supervisor);
    }
    return ntf_mode_stop(touch, state, lift_of(touch, state));
}

static void drive_motor(const ntf_touch *touch, ntf_touch_state *state, float wanted)
{
    state->motor_force = ntf_motor_limit(&touch->settings.limits, touch->motor_step, state->motor_force, wanted,
                                        state->signals.smooth_speed);
    const int coupled = state->supervisor.state == NTF_RUN && state->mode == state->wanted_mode && !state->clutch_open;
    if (coupled && state->mode <= NTF_MODE_TOPOGRAPHY)
        state->coupled_force = state->motor_force;
}

/* A read-out that cannot be trusted (not RUN) or that follow_error calls a fault takes no part: the integral stands
 * still. */
static float drive_stage(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample)
{
    const float error = state->reference - sample->stage_position[NTF_Z];
    const int trusted = state->supervisor.state == NTF_RUN && fabsf(error) <= touch->settings.limits.follow_error;
    const ntf_sum measured = trusted ? sample->stage_position[NTF_Z] : state->reference;
    const ntf_sum wanted = ntf_stage_loop_step(&touch->stage_loop, &state->stage_loop, state->reference, measured);
    const float most = touch->supervisor.correction_most; /* it shall hide no stage that does not follow */
    state->stage_loop.correction = clamp(state->stage_loop.correction, -most, most);
    const ntf_sum command = clamp(wanted, -touch->stage_end, touch->stage_end);
    if (command != wanted)
        state->supervisor.reasons |= NTF_REASON_COMMAND_LIMITED;
    return command;
}

void ntf_touch_step(const ntf_touch *touch, ntf_touch_state *state, const ntf_sample *sample, ntf_command *command)
{
    supervise(touch, state, sample);
    if (state->supervisor.invalid_run == 0)
        observe(touch, state, sample);
    drive_motor(touch, state, act(touch, state));
    ntf_sideways_drive(touch, state);
    state->command.stage_position[NTF_Z] = drive_stage(touch, state, sample);
    if (state->passivity.gain < 1.0f || state->passivity_sideways[NTF_X].gain < 1.0f)
        state->supervisor.reasons |= NTF_REASON_BACKED_OFF;
    state->command.motor_force[NTF_Z] = state->motor_force;
    for (int i = 0; i < NTF_AXES; ++i)
        state->sent[state->ticks % NTF_TOUCH_SENT][i] = state->command.motor_force[i];
    state->command.state = (uint32_t)state->supervisor.state;
    state->command.reasons = state->supervisor.reasons;
    ++state->ticks;
    *command = state->command;
}

#undef PROBE_STEPS

/* --- control/requests.c --- */
/* What may be asked of a running touch from outside, between two steps. */


ntf_status ntf_touch_aim(const ntf_touch *touch, ntf_touch_state *state, float x, float y, float duration)
{
    if (!isfinite(x) || !isfinite(y) || !isfinite(duration))
        return NTF_E_NOT_FINITE;
    if (duration < 0.0f)
        return NTF_E_RANGE;
    const float distance =
        hypotenuse(x - state->command.stage_position[NTF_X], y - state->command.stage_position[NTF_Y]);
    state->target_x = x;
    state->target_y = y;
    state->target_time = greater(duration, distance / touch->settings.limits.lateral_speed);
    return NTF_OK;
}

ntf_status ntf_touch_arm(ntf_touch_state *state, int confirmed)
{
    const ntf_status status = ntf_supervisor_arm(&state->supervisor, confirmed);
    if (status != NTF_OK)
        return status;
    ntf_passivity_state *watched[] = {&state->passivity, &state->passivity_sideways[NTF_X],
                                     &state->passivity_sideways[NTF_Y]};
    for (int i = 0; i < NTF_AXES; ++i) {
        watched[i]->gain = 1.0f;
        watched[i]->damping = 0.0f;
        watched[i]->energy = 0.0f;
    }
    state->retracted = 0.0f;
    state->phase = NTF_PHASE_DOWN;
    state->target_x =
        state->command.stage_position[NTF_X]; /* the path that a stop has cut short does not go on by itself */
    state->target_y = state->command.stage_position[NTF_Y];
    state->target_time = 0.0f;
    return NTF_OK;
}

ntf_status ntf_touch_set_mode(ntf_touch_state *state, ntf_mode mode)
{
    if (mode > NTF_MODE_CURVE)
        return NTF_E_ARGUMENT;
    state->wanted_mode = mode;
    if (mode == state->mode)
        state->phase = NTF_PHASE_DOWN; /* once more */
    return NTF_OK;
}

ntf_status ntf_touch_rescale(ntf_touch_state *state, const ntf_scaling *scaling)
{
    if (!isfinite(scaling->alpha_p) || !isfinite(scaling->alpha_f))
        return NTF_E_NOT_FINITE;
    if (scaling->alpha_p <= 0.0f || scaling->alpha_f <= 0.0f)
        return NTF_E_RANGE;
    state->rescale.wanted = *scaling;
    return NTF_OK;
}

void ntf_touch_clutch(ntf_touch_state *state, int open)
{
    state->clutch_open = open;
}

void ntf_touch_index(ntf_touch_state *state, float master_position)
{
    ntf_signals *signals = &state->signals;
    state->offset += signals->scaling.alpha_p * (signals->master_position - master_position);
    signals->master_position = master_position;
    state->passivity.last_hand.position = master_position;
    state->hand_at[NTF_X] = state->hand_at[NTF_Y] = NAN; /* until it is seen */
}


/* --- scene/force_table.c --- */
/* The force of a plan from a table of cubics, in single precision. */


/* The last piece that begins at or below a gap; of what lies before all of them the first. */
static const ntf_force_piece *piece_at(const ntf_force_piece *pieces, int count, float gap)
{
    int low = 0, high = count;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (pieces[middle].gap <= gap)
            low = middle;
        else
            high = middle;
    }
    return &pieces[low];
}

static ntf_force_here eval_piece(const ntf_force_piece *piece, float gap)
{
    const float *c = piece->cubic, u = (gap - piece->gap) * piece->per_width;
    if (u < 0.0f) /* deeper than the table */
        return (ntf_force_here){c[0] + u * c[1], -c[1] * piece->per_width};
    return (ntf_force_here){c[0] + u * (c[1] + u * (c[2] + u * c[3])),
                           -(c[1] + u * (2.0f * c[2] + u * 3.0f * c[3])) * piece->per_width};
}

ntf_force_here ntf_force_table_eval(const ntf_force_table *table, int *attached, float gap)
{
    if (isnan(gap))
        return (ntf_force_here){gap, gap};
    *attached = gap <= table->capture_gap || (*attached && gap <= table->release_gap);
    if (*attached)
        return eval_piece(piece_at(table->pieces, table->contact, gap), gap);
    if (table->apart == 0 || gap > table->farthest)
        return (ntf_force_here){0.0f, 0.0f};
    return eval_piece(piece_at(table->pieces + table->contact, table->apart, gap), gap);
}

