/* SPDX-License-Identifier: BSD-3-Clause
 * A lateral reading that fails while a hand rubs. One that gives no number is found, and what is promised sideways
 * holds. One that lies is not found: then friction and slope hold the tip with what they can, and the vertical promise
 * holds, whatever the lateral loop does. */
#include <stdlib.h>

#include "internal/margins.h"
#include "session/hazard.h"
#include "sideways_draws.h"

typedef enum lateral_fault_kind {
    NOT_A_NUMBER,
    INFINITE,
    INVALID, /* the whole frame, marked so */
    FOUND,   /* the kinds before this one show themselves */
    STUCK = FOUND,
    GAIN,
    OFFSET,
    NOISE,
    KINDS
} lateral_fault_kind;

typedef struct lateral_fault {
    lateral_fault_kind kind;
    int both;       /* axes, or x alone */
    long from, to;  /* ticks */
    double gain;    /* [-] */
    double offset;  /* [m] */
    double held[2]; /* [m] */
    long tick;
    int run; /* samples in a row without a number */
    nt_random random;
} lateral_fault;

static void spoil(nt_sample *sample, void *context)
{
    lateral_fault *fault = context;
    const long now = fault->tick++;
    fault->run = now >= fault->from && now < fault->to && fault->kind < FOUND ? fault->run + 1 : 0;
    for (int i = NT_X; i <= (fault->both ? NT_Y : NT_X); ++i) {
        double *read = &sample->deflection[i];
        if (now < fault->from || now >= fault->to) {
            fault->held[i] = *read;
            continue;
        }
        switch (fault->kind) {
        case NOT_A_NUMBER:
            *read = (double)NAN;
            break;
        case INFINITE:
            *read = fault->gain < 0.0 ? -HUGE_VAL : HUGE_VAL;
            break;
        case INVALID:
            sample->flags |= NT_SAMPLE_INVALID;
            break;
        case STUCK:
            *read = fault->held[i];
            break;
        case GAIN:
            *read *= fault->gain;
            break;
        case OFFSET:
            *read += fault->offset;
            break;
        default:
            *read += fault->offset * noise(&fault->random);
            break;
        }
    }
}

static lateral_fault draw_fault(const loop *l, const drawn *d, nt_random *random)
{
    const double rate = 1.0 / l->touch.period;
    const long from = (long)(rate * (0.4 + 0.2 * nt_random_uniform(random))); /* it pushes sideways from 0.5 to 0.6 s */
    const double force = between(random, 0.01, 10.0) * d->load;
    return (lateral_fault){.kind = (lateral_fault_kind)(KINDS * nt_random_uniform(random)),
                           .both = nt_random_uniform(random) < 0.7,
                           .from = from,
                           .to = from + (long)between(random, 1.0, 0.4 * rate),
                           .gain = 3.0 * noise(random),
                           .offset = force * (noise(random) < 0.0 ? -1.0 : 1.0) / l->touch.rig.probe.lateral_stiffness,
                           .random = nt_random_seed(17)};
}

typedef struct forces {
    double vertical, sideways; /* the largest [N] */
} forces;

/* The observer's hands are tied, as in test_session_sideways. */
static void go(loop *l, lateral_fault *fault, double time, forces *worst)
{
    for (double t = 0.0; t < time; t += l->touch.period) {
        l->touch.passivity.due = 0.0;
        l->state.passivity.energy = l->state.passivity.gain = 1.0;
        assert_int_equal(loop_tick(l, spoil, fault), NT_OK);
        if (fault->run == 1)
            assert_true(l->command.state != NT_RUN);
        if (fault->run > 1)
            assert_true(l->command.state == NT_RETRACT || l->command.state == NT_LATCHED);
        for (int i = 0; i < NT_AXES; ++i)
            assert_true(isfinite(l->command.motor_force[i]));
        const double *force = l->sim.slave.truth.tip_force;
        worst->vertical = larger(worst->vertical, force[NT_Z]);
        worst->sideways = larger(worst->sideways, hypot(force[NT_X], force[NT_Y]));
    }
}

/* Landed gently, pushed sideways at once and pulled off, with a fault at any time of it. */
static forces rubbed_with(loop *l, const drawn *d, lateral_fault *fault, nt_random *random)
{
    const double press = l->touch.settings.gains.alpha_f * d->load, most = 3.0 * press;
    forces worst = {0.0, 0.0};
    assert_int_equal(nt_touch_arm(&l->state, 1), NT_OK);
    push(l, 0.0, 0.0, 0.7 * press, 0.3);
    go(l, fault, 0.5, &worst);
    push(l, most * noise(random), most * noise(random), (0.7 + 0.3 * noise(random)) * press, 0.0);
    go(l, fault, 0.1, &worst);
    push(l, 0.0, 0.0, -0.3 * press, 0.0);
    go(l, fault, 0.2, &worst);
    return worst;
}

/* NANOTOUCH_SIDEWAYS_SCENES of them, six faults each. */
static void a_lateral_reading_that_fails_breaks_no_promise(void **state)
{
    (void)state;
    const char *asked = getenv("NANOTOUCH_SIDEWAYS_SCENES");
    const int scenes = asked ? atoi(asked) : 40;
    nt_random random = nt_random_seed(11);
    int ways[2] = {0, 0}, past = 0;
    double nearest[2] = {0.0, 0.0}, vertical = 0.0, over = 0.0;
    for (int i = 0; i < scenes; ++i) {
        static drawn d;
        static loop l;
        double parts[3];
        draw(&d, &random);
        d.setup.settings.gains.alpha_f = scale_at_the_limit(&d, parts) / 3.0;
        d.setup.settings.limits.stage_speed = 1e-6;
        d.setup.settings.limits.lateral_speed = between(&random, 1e-7, 1e-5);
        d.setup.settings.limits.lateral_force = between(&random, 0.02, 0.5) * d.load;
        for (int way = 0; way < 6; ++way) {
            assert_int_equal(loop_open(&l, &d.setup), NT_OK);
            const nt_hazard hazard = nt_hazard_of(&l.plan, &l.touch.rig, &l.touch.settings, d.slope, l.clearance);
            const nt_guarantee promised = nt_guarantee_compute(&l.touch.rig, &l.touch.settings, &hazard);
            lateral_fault fault = draw_fault(&l, &d, &random);
            const int lies = fault.kind >= FOUND;
            const double bound = lies ? hazard.friction + hazard.slope * promised.force : promised.lateral_force;
            const forces worst = rubbed_with(&l, &d, &fault, &random);
            if (worst.sideways > bound || worst.vertical > promised.force)
                print_message("scene %d, way %d, fault %d: %.3g of %.3g N sideways, %.3g of %.3g N\n", i, way,
                              (int)fault.kind, worst.sideways, bound, worst.vertical, promised.force);
            assert_true(worst.sideways <= bound && worst.vertical <= promised.force);
            nearest[lies] = larger(nearest[lies], worst.sideways / bound);
            vertical = larger(vertical, worst.vertical / promised.force);
            past += lies && worst.sideways > promised.lateral_force;
            over = larger(over, lies ? worst.sideways / promised.lateral_force : 0.0);
            ++ways[lies];
        }
    }
    print_message(
        "%d ways without a number: at most %.2f of the promise; %d with a lie: at most %.2f of what friction and "
        "slope hold, %d past the promise, at most %.2f of it; vertical at most %.2f\n",
        ways[0], nearest[0], ways[1], nearest[1], past, over, vertical);
    assert_true(ways[0] > scenes && ways[1] > scenes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_lateral_reading_that_fails_breaks_no_promise)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
