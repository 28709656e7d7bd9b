/* SPDX-License-Identifier: BSD-3-Clause
 * The hand's promise against an account of its own: hands that move as they like, and events of every kind. What the
 * motor gives is added up here from the commands alone, held and late as they act. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "internal/control.h"
#include "larger.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"

enum { LATE_MOST = 8, AXES = NT_AXES };

/* What befalls: a number that is none in each channel, marks of a frame, stops, silence of a link. */
enum event {
    MASTER_NAN,
    MASTER_X_NAN,
    OPERATOR_NAN,
    DEFLECTION_NAN,
    LATERAL_NAN,
    STAGE_NAN,
    STAGE_X_NAN,
    BAD_FRAME,
    BAD_MASTER,
    BAD_SLAVE,
    MASTER_LOST,
    SLAVE_LOST,
    MASTER_SILENT,
    SLAVE_SILENT,
    STOP,
    LIMIT_SWITCH,
    SATURATED,
    LATE,
    CLUTCH,
    MODE,
    EVENTS
};

typedef struct ride {
    nt_touch touch;
    nt_touch_state state;
    nt_motor_bound bound;
    nt_random random;
    nt_sample sample, given;
    nt_command command;
    double position[AXES], speed[AXES]; /* of the hand [m], [m/s] */
    double sent[LATE_MOST][AXES];       /* the last commands [N] */
    int late;                           /* ticks after which a command acts */
    int released;                       /* let go: the motor alone moves a handle of `mass` [kg] */
    double mass;
    double energy; /* that the motor has given since the event [J] */
} ride;

static double between(ride *r, double low, double high)
{
    return low + (high - low) * nt_random_uniform(&r->random);
}

static double decades(ride *r, double low, double high)
{
    return low * pow(high / low, nt_random_uniform(&r->random));
}

static int one_of(ride *r, int count)
{
    const int i = (int)between(r, 0.0, count);
    return i < count ? i : count - 1;
}

static void begin(ride *r, uint64_t seed)
{
    *r = (ride){.random = nt_random_seed(seed)};
    nt_rig rig = nt_rig_defaults();
    rig.master.axes = one_of(r, 2) ? 3.0 : 1.0;
    rig.master.gauge = one_of(r, 2);
    rig.probe.lateral_stiffness = one_of(r, 2) ? 50.0 : 0.0;
    rig.master.max_force = decades(r, 0.3, 30.0);
    rig.master.max_speed = decades(r, 0.01, 2.0);
    rig.master.mass = decades(r, 0.02, 1.0);
    rig.master.damping = decades(r, 1.0, 300.0);
    rig.master.travel = 10.0; /* no end stop in the way */
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.rate = decades(r, 200.0, 20e3);
    settings.gains.delay = one_of(r, LATE_MOST - 1);
    settings.gains.ramp_time = one_of(r, 2) ? 0.0 : 0.01;
    settings.limits.motor_rate = decades(r, 20.0, 1e5);
    assert_int_equal(nt_touch_make(&r->touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    r->bound = nt_motor_bound_compute(&rig, &settings);
    r->state = nt_touch_start(&r->touch, 0.0, 0.0, 0.0);
    r->late = (int)settings.gains.delay;
    r->mass = smaller(0.1, rig.master.mass);
}

/* The hand goes on for a period under what acts; what that gives it is added up. */
static void pass(ride *r)
{
    const double period = r->touch.period;
    const double *acting = r->sent[r->late];
    for (int i = 0; i < AXES; ++i) {
        const double gained = r->released ? acting[i] / r->mass * period : 0.0;
        const double way = (r->speed[i] + 0.5 * gained) * period; /* exact of a held force */
        r->energy += acting[i] * way;
        r->position[i] += way;
        r->speed[i] += gained;
    }
}

static void tick(ride *r, const nt_sample *sample)
{
    nt_touch_step(&r->touch, &r->state, sample, &r->command);
    for (int k = LATE_MOST - 1; k > 0; --k)
        for (int i = 0; i < AXES; ++i)
            r->sent[k][i] = r->sent[k - 1][i];
    for (int i = 0; i < AXES; ++i)
        r->sent[0][i] = r->command.motor_force[i];
    ++r->sample.tick;
}

static void read(ride *r)
{
    nt_sample *sample = &r->sample;
    const double q = r->touch.rig.master.resolution;
    for (int i = 0; i < AXES; ++i)
        sample->master_position[i] =
            r->touch.rig.master.axes > 1.0 || i == NT_Z ? q * round(r->position[i] / q) : (double)NAN;
    sample->stage_position[NT_Z] = r->command.stage_position[NT_Z];
    sample->deflection[NT_Z] += 1e-10 * nt_random_normal(&r->random);
}

/* A hand no faster than declared, any way; what it feels and presses with is anything, too. */
static void turn(ride *r)
{
    const double most = r->touch.rig.master.max_speed, z = between(r, -1.0, 1.0), round = between(r, 0.0, 6.283);
    const int axes = (int)r->touch.rig.master.axes;
    const double speed = most * between(r, 0.0, 1.0), flat = axes == 3 ? sqrt(1.0 - z * z) : 0.0;
    r->speed[NT_X] = speed * flat * cos(round);
    r->speed[NT_Y] = speed * flat * sin(round);
    r->speed[NT_Z] = axes == 3 ? speed * z : z < 0.0 ? -speed : speed;
    const nt_probe *probe = &r->touch.rig.probe;
    const double felt = r->touch.settings.limits.force * between(r, -0.9, 0.9);
    r->sample.deflection[NT_Z] = felt / probe->spring_constant;
    r->sample.operator_force[NT_Z] = between(r, -4.0, 4.0);
    for (int i = 0; i < NT_Z; ++i)
        r->sample.deflection[i] =
            probe->lateral_stiffness > 0.0
                ? between(r, -1.0, 1.0) * 0.5 * r->touch.settings.limits.lateral_force / probe->lateral_stiffness
                : 0.0;
}

static void spoil_channel(enum event event, nt_sample *s)
{
    switch (event) {
    case MASTER_NAN:
        s->master_position[NT_Z] = NAN;
        break;
    case MASTER_X_NAN:
        s->master_position[NT_X] = NAN;
        break;
    case OPERATOR_NAN:
        s->operator_force[NT_Z] = NAN;
        break;
    case DEFLECTION_NAN:
        s->deflection[NT_Z] = NAN;
        break;
    case LATERAL_NAN:
        s->deflection[NT_X] = NAN;
        break;
    case STAGE_NAN:
        s->stage_position[NT_Z] = NAN;
        break;
    case STAGE_X_NAN:
        s->stage_position[NT_X] = NAN;
        break;
    default:
        break;
    }
}

static void befall(ride *r, enum event event, nt_sample *s)
{
    const double old = 3.0 * larger(r->touch.period, r->touch.supervisor.master_period);
    switch (event) {
    case BAD_FRAME:
        s->flags = NT_SAMPLE_INVALID;
        break;
    case BAD_MASTER:
        s->flags = NT_SAMPLE_INVALID | NT_SAMPLE_MASTER_ALONE;
        s->master_position[NT_Z] = 0.1;
        break;
    case BAD_SLAVE:
        s->flags = NT_SAMPLE_INVALID | NT_SAMPLE_SLAVE_ALONE;
        s->deflection[NT_Z] = 1e-3;
        break;
    case MASTER_LOST:
        s->flags = NT_SAMPLE_DEVICE_LOST | NT_SAMPLE_INVALID | NT_SAMPLE_MASTER_ALONE;
        break;
    case SLAVE_LOST:
        s->flags = NT_SAMPLE_DEVICE_LOST | NT_SAMPLE_INVALID | NT_SAMPLE_SLAVE_ALONE;
        break;
    case MASTER_SILENT:
        s->master_age = old;
        break;
    case SLAVE_SILENT:
        s->age = old;
        break;
    case STOP:
        s->flags = NT_SAMPLE_EMERGENCY_STOP;
        break;
    case LIMIT_SWITCH:
        s->flags = NT_SAMPLE_LIMIT_SWITCH;
        break;
    case SATURATED:
        s->flags = NT_SAMPLE_SATURATED;
        break;
    case LATE:
        s->lateness = 2.0 * r->touch.period;
        break;
    default:
        spoil_channel(event, s);
        break;
    }
}

static double size_of(const double force[AXES])
{
    return sqrt(force[0] * force[0] + force[1] * force[1] + force[2] * force[2]);
}

/* The promise, from the rig's fields alone [s]. */
static double longest_fade(const ride *r, const double force[AXES])
{
    const double v = r->touch.rig.master.max_speed, W = 1e-3;
    const double with_handle = 0.5 * (v + sqrt(v * v + 2.0 * W / r->mass));
    const double size = size_of(force), largest = larger(larger(fabs(force[0]), fabs(force[1])), fabs(force[2]));
    const double wanted = size > 0.0 ? smaller(0.05, 2.0 * W / (size * with_handle)) : 0.05;
    return larger(wanted, largest / r->touch.settings.limits.motor_rate);
}

static int is_uncoupled(const ride *r, enum event event)
{
    return event == CLUTCH || event == MODE || r->command.state != NT_RUN;
}

/* One event, and what the motor does until it is gone. Returns the energy over what is promised. */
static double ride_on(ride *r, enum event event, int lasting)
{
    const double period = r->touch.period, rounding = 1e-9;
    const int before = (int)between(r, 5.0, 400.0);
    for (int k = 0; k < before; ++k) {
        if (k % 50 == 0)
            turn(r);
        read(r);
        tick(r, &r->sample);
        pass(r);
    }
    if (r->command.state != NT_RUN)
        return 0.0; /* a limit came first */
    double from[AXES], last[AXES];
    for (int i = 0; i < AXES; ++i)
        last[i] = from[i] = r->command.motor_force[i];
    turn(r); /* in the very moment the hand may turn and be let go */
    r->released = one_of(r, 2);
    r->energy = 0.0;
    const double fade = longest_fade(r, from);
    const int ticks = (int)ceil(fade / period) + r->late + 3;
    if (event == CLUTCH)
        nt_touch_clutch(&r->state, 1);
    if (event == MODE)
        assert_int_equal(nt_touch_set_mode(&r->state, NT_MODE_APPROACH), NT_OK);
    for (int k = 0; k < ticks; ++k) {
        read(r);
        nt_sample sample = r->sample;
        if (k == 0 || lasting)
            befall(r, event, &sample);
        tick(r, &sample);
        if (!is_uncoupled(r, event)) /* it goes on, or comes back: promised no more */
            return 0.0;
        pass(r);
        for (int i = 0; i < AXES; ++i) {
            const double force = r->command.motor_force[i];
            assert_true(fabs(force) <= fabs(last[i])); /* nor does it rise again: another event may come meanwhile */
            assert_true(force * from[i] >= 0.0);       /* and it is not turned round */
            assert_true(fabs(force - last[i]) <= r->touch.settings.limits.motor_rate * period * (1.0 + rounding));
            last[i] = force;
        }
        if ((k + 1) * period >= fade * (1.0 + rounding))
            assert_true(size_of(last) == 0.0);
    }
    assert_true(size_of(last) == 0.0);
    assert_true(r->energy <= r->bound.energy * (1.0 + 1e-6));
    return r->energy / r->bound.energy;
}

static void the_hand_is_given_no_more_than_is_promised(void **state)
{
    (void)state;
    const char *asked = getenv("NANOTOUCH_HAND_RIDES");
    const int rides = asked ? atoi(asked) : 4000;
    double nearest = 0.0;
    int counted = 0;
    for (int i = 0; i < rides; ++i) {
        ride r;
        begin(&r, 37u + (uint64_t)i);
        const double share = ride_on(&r, (enum event)(i % EVENTS), i / EVENTS % 2);
        counted += share != 0.0;
        nearest = larger(nearest, share);
    }
    print_message("| %d rides, %d with a force that fades | energy at most %.3f of the promise |\n", rides, counted,
                  nearest);
    assert_true(counted > rides / 8 && nearest > 0.1); /* it is tried, and the bound is no idle one */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hand_is_given_no_more_than_is_promised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
