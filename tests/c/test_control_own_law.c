/* SPDX-License-Identifier: BSD-3-Clause
 * Laws of one's own: those that amount to the default law have its margins, the others have none. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/control.h"
#include "larger.h"
#include "nanotouch/control.h"
#include "nanotouch/margins.h"

/* tau = -reflection alpha_f f_s + raw f_m + smooth f_m' + share b v; the rest is what the rules do not know. */
typedef struct mine {
    double reflection, raw, smooth, share;
    double spring, raw_speed, follows, memory, bend, cubic;
    double kept;
} mine;

static nt_effort own(void *context, const nt_gains *gains, const nt_signals *s)
{
    mine *law = context;
    (void)gains;
    law->kept += law->memory * (s->felt_force - law->kept);
    const double f = s->scaling.alpha_f * (s->felt_force + law->kept);
    const double force = -law->reflection * f - law->cubic * f * f * f + law->raw * s->operator_force +
                         law->smooth * s->smooth_force + law->share * s->master_damping * s->smooth_speed -
                         law->spring * s->master_position + law->raw_speed * s->master_speed -
                         law->bend * larger(0.0, f - 0.25 * 5.0);
    return (nt_effort){force, s->target + law->follows * s->stage_position};
}

static nt_settings with(const nt_rig *rig, mine *law)
{
    nt_settings settings = nt_settings_defaults(rig);
    settings.control = (nt_control){NT_CONTROL_OWN, own, law};
    return settings;
}

static const double stiffness = 1e3;

/* A law with other constants than the settings is judged by its own. */
static void a_law_is_judged_by_its_own_gains(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    static const mine laws[] = {{.reflection = 3.0, .smooth = 2.0}, {.reflection = 41.0, .smooth = 40.0},
                                {.reflection = 41.0, .raw = 40.0},  {.reflection = 1.0},
                                {.reflection = 2.0, .smooth = 7.0}, {.reflection = 3.0, .smooth = 2.0, .share = 0.8}};
    for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
        mine law = laws[i];
        const nt_settings settings = with(&rig, &law);
        nt_settings same = nt_settings_defaults(&rig);
        same.gains.force_gain = larger(law.raw, law.smooth);
        same.gains.alpha_f *= law.reflection / (1.0 + same.gains.force_gain);
        same.gains.velocity_feedforward = law.share;
        if (law.raw > 0.0)
            same.gains.force_filter = 1e6;
        nt_margins mine_found, expected;
        const nt_verdict verdict = nt_margins_judge(&rig, &settings, stiffness, NT_MODE_TOUCH, &mine_found);
        const nt_verdict wanted = nt_margins_judge(&rig, &same, stiffness, NT_MODE_TOUCH, &expected);
        /* slopes by differences of 1e-6 of a range: rounding leaves 1e-9 of them */
        assert_true(fabs(verdict.margin / wanted.margin - 1.0) < 1e-7);
        assert_string_equal(verdict.rule, wanted.rule);
        assert_true(fabs(mine_found.loop_stiffness / expected.loop_stiffness - 1.0) < 1e-7);
        assert_true(fabs(mine_found.exact_limit / expected.exact_limit - 1.0) < 1e-7);
    }
}

/* The library's own default law, given as somebody's, is what it is; with and without regions. */
static void the_default_law_amounts_to_itself(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.alpha_f_retract = 2.0;
    settings.gains.velocity_feedforward = 0.3;
    nt_margins margins, expected;
    const double wanted = nt_margins_judge(&rig, &settings, stiffness, NT_MODE_TOUCH, &expected).margin;
    settings.control = (nt_control){NT_CONTROL_OWN, nt_servo_default, NULL};
    const double found = nt_margins_judge(&rig, &settings, stiffness, NT_MODE_TOUCH, &margins).margin;
    assert_true(fabs(found / wanted - 1.0) < 1e-7);
    settings.gains.coupling_stiffness = 500.0;
    settings.gains.coupling_damping = 20.0;
    nt_settings amounts;
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(fabs(amounts.gains.alpha_f / (2.0 * settings.gains.alpha_f) - 1.0) < 1e-7);
    settings.control.choice = NT_CONTROL_DEFAULT;
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_E_ARGUMENT);
}

/* tau = -f - c f^3 is steepest at the largest force that is tried, the gauge's 5 N: 1 + 3 c 25. */
static void a_bent_law_is_judged_where_it_is_steepest(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    mine law = {.reflection = 1.0, .cubic = 0.1};
    const nt_settings settings = with(&rig, &law);
    nt_settings amounts;
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(fabs(amounts.gains.alpha_f / settings.gains.alpha_f - 8.5) < 1e-4);
    assert_true(amounts.gains.force_gain < 1e-9);
}

/* What hears its target as well, or is tried without a gauge. */
typedef struct heard {
    double target, most_raw, slave, share;
} heard;

static nt_effort hears(void *context, const nt_gains *gains, const nt_signals *s)
{
    heard *law = context;
    (void)gains;
    law->most_raw = larger(law->most_raw, fabs(s->operator_force));
    const double drag = law->share * s->master_damping * s->smooth_speed;
    return (nt_effort){-law->slave * s->scaling.alpha_f * s->slave_force - law->target * s->target + drag, s->target};
}

static void borders_of_a_law(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.master.max_force = 4.0; /* less than the gauge tells */
    nt_settings settings = nt_settings_defaults(&rig), amounts;
    settings.gains.alpha_f_approach = 3.0;
    heard law = {.target = 0.0};
    settings.control = (nt_control){NT_CONTROL_OWN, hears, &law};
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK); /* it reflects nothing */
    assert_true(amounts.gains.alpha_f == 1e-3 && amounts.gains.force_gain == 0.0);
    assert_true(amounts.gains.alpha_f_approach == 1.0 && amounts.limits.force == settings.limits.force);
    assert_int_equal(amounts.control.choice, NT_CONTROL_DEFAULT);
    /* pressed with what gauge and motor both reach, scaled as the largest region is, and moved by a millionth of 4 N */
    const double pressed = 3.0 * smaller(settings.gains.alpha_f * settings.limits.force, 4.0);
    assert_true(fabs(law.most_raw - pressed - 1e-6 * rig.master.max_force) < 1e-12);
    law.slave = 2.0; /* of f_s as it is, not as it is felt */
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(fabs(amounts.gains.alpha_f / (6.0 * settings.gains.alpha_f) - 1.0) < 1e-7);
    settings.gains.coupling_stiffness = 0.5; /* behind any coupling the session's alpha_f counts */
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_E_UNSUPPORTED);
    settings.gains.coupling_stiffness = 0.0;
    law.target = 1e9; /* [N/m]: by far more than a step of the stage may make */
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_E_UNSUPPORTED);
    law.target = 0.0;
    rig.master.gauge = 0;
    law.most_raw = 0.0;
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(law.most_raw == 0.0); /* no f_m is asked about */
    law.share = -0.9e-4;              /* rounding of no share, and of the largest one */
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(amounts.gains.velocity_feedforward == 0.0);
    law.share = 0.8 + 0.9e-4;
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(amounts.gains.velocity_feedforward == 0.8);
}

/* Three times as steep about a quarter of the largest force, of one sign; or a stage that goes to one side alone. */
static nt_effort steep(void *context, const nt_gains *gains, const nt_signals *s)
{
    const int kind = *(const int *)context;
    (void)gains;
    const double f = s->scaling.alpha_f * s->felt_force, more = larger(0.0, smaller(f, 1.5) - 1.0);
    const double pulled = kind == 2 ? smaller(0.0, f + 4.0) : 0.0; /* or where it pulls the most */
    return (nt_effort){-f - 2.0 * (kind == 2 ? pulled : more), kind == 1 ? s->target + fabs(s->target) : s->target};
}

static void the_worst_of_all_points_counts(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig), amounts;
    int kind = 0;
    settings.control = (nt_control){NT_CONTROL_OWN, steep, &kind};
    assert_true(settings.gains.alpha_f * settings.limits.force > 5.0); /* 1.25 N are a quarter */
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(fabs(amounts.gains.alpha_f / (3.0 * settings.gains.alpha_f) - 1.0) < 1e-7);
    kind = 2;
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(fabs(amounts.gains.alpha_f / (3.0 * settings.gains.alpha_f) - 1.0) < 1e-7);
    kind = 1;
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_E_UNSUPPORTED);
}

static nt_effort no_number(void *unused, const nt_gains *gains, const nt_signals *s)
{
    (void)unused;
    (void)gains;
    return (nt_effort){NAN, s->target};
}

static void what_the_rules_do_not_know_has_no_margin(void **state)
{
    (void)state;
    const nt_rig rig = nt_rig_defaults();
    static const mine laws[] = {
        {.reflection = 3.0, .smooth = 2.0, .memory = 0.1},      {.reflection = 3.0, .smooth = 2.0, .spring = 10.0},
        {.reflection = 3.0, .smooth = 2.0, .raw_speed = -10.0}, {.reflection = 3.0, .smooth = 2.0, .follows = 0.1},
        {.reflection = 3.0, .smooth = 2.0, .raw = 2.0},         {.reflection = 3.0, .smooth = 2.0, .share = -1.0},
        {.reflection = 3.0, .smooth = 2.0, .share = 0.9},       {.reflection = -1.0},
        {.reflection = 3.0, .smooth = 2.0, .raw = -0.5},        {.reflection = 1.0, .bend = 5.0}};
    for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
        mine law = laws[i];
        const nt_settings settings = with(&rig, &law);
        nt_settings amounts;
        nt_margins margins;
        assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_E_UNSUPPORTED);
        const nt_verdict verdict = nt_margins_judge(&rig, &settings, stiffness, NT_MODE_TOUCH, &margins);
        assert_true(isnan(verdict.margin) && isnan(margins.exact_limit) && isnan(margins.margin));
        assert_true(margins.height_margin > 0.0); /* the height servo knows no law */
        assert_true(nt_margins_judge(&rig, &settings, stiffness, NT_MODE_CURVE, &margins).margin == (double)INFINITY);
    }
    nt_settings broken = nt_settings_defaults(&rig);
    broken.control = (nt_control){NT_CONTROL_OWN, no_number, NULL};
    nt_settings amounts;
    assert_int_equal(nt_margins_own_law(&rig, &broken, stiffness, &amounts), NT_E_UNSUPPORTED);
    /* behind a virtual coupling alpha_f has to be the session's */
    mine law = {.reflection = 2.0};
    nt_settings coupled = with(&rig, &law);
    assert_int_equal(nt_margins_own_law(&rig, &coupled, stiffness, &amounts), NT_OK);
    coupled.gains.coupling_stiffness = 500.0;
    assert_int_equal(nt_margins_own_law(&rig, &coupled, stiffness, &amounts), NT_E_UNSUPPORTED);
}

/* The largest of each signal that was asked about. */
typedef struct asked {
    double target, master, stage, master_speed, stage_speed;
} asked;

static nt_effort note(void *context, const nt_gains *gains, const nt_signals *s)
{
    asked *most = context;
    (void)gains;
    most->target = larger(most->target, fabs(s->target));
    most->master = larger(most->master, fabs(s->master_position));
    most->stage = larger(most->stage, fabs(s->stage_position));
    most->master_speed = larger(most->master_speed, fabs(s->master_speed));
    most->stage_speed = larger(most->stage_speed, fabs(s->stage_speed));
    return (nt_effort){-s->scaling.alpha_f * s->felt_force, s->target};
}

/* A millionth of the travel, at the stage scaled by alpha_p, and speeds that go it in a period. */
static void signals_are_moved_by_a_millionth_of_their_range(void **state)
{
    (void)state;
    nt_rig rig = nt_rig_defaults();
    rig.master.travel = 0.3;
    nt_settings settings = nt_settings_defaults(&rig);
    settings.gains.alpha_p = 7e-7;
    settings.gains.rate = 5e3;
    asked most = {0.0, 0.0, 0.0, 0.0, 0.0};
    settings.control = (nt_control){NT_CONTROL_OWN, note, &most};
    nt_settings amounts;
    assert_int_equal(nt_margins_own_law(&rig, &settings, stiffness, &amounts), NT_OK);
    assert_true(fabs(most.target / 2.1e-13 - 1.0) < 1e-12 && fabs(most.stage / 2.1e-13 - 1.0) < 1e-12);
    assert_true(fabs(most.master / 3e-7 - 1.0) < 1e-12);
    assert_true(fabs(most.stage_speed / 1.05e-9 - 1.0) < 1e-12 && fabs(most.master_speed / 1.5e-3 - 1.0) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(borders_of_a_law),
        cmocka_unit_test(the_worst_of_all_points_counts),
        cmocka_unit_test(a_law_is_judged_by_its_own_gains),
        cmocka_unit_test(the_default_law_amounts_to_itself),
        cmocka_unit_test(a_bent_law_is_judged_where_it_is_steepest),
        cmocka_unit_test(what_the_rules_do_not_know_has_no_margin),
        cmocka_unit_test(signals_are_moved_by_a_millionth_of_their_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
