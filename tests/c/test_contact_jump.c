/* SPDX-License-Identifier: BSD-3-Clause
 * Jumps under dead weight, springs and grips: folds by their definition, landings by their balance, limits by the other
 * functions and by published numbers. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "contact/contact_equilibrium.h"
#include "internal/contact.h"
#include "maugis_fixture.h"
#include "nanotouch/advanced/contact_equilibrium.h"

static nt_contact_law law_of(nt_model model, double lambda)
{
    nt_contact_law law = {.model = model};
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    assert_int_equal(nt_maugis_init_lambda(&law.maugis, &contact, lambda), NT_OK);
    return law;
}

static nt_jump jump_of(const nt_contact_law *law, double spring)
{
    nt_jump jump;
    assert_int_equal(nt_contact_law_jump(law, spring, &jump), NT_OK);
    return jump;
}

/* At a fold of D = delta + F/k_c the stiffness is -k_c, and D is larger on both sides. The landing has the D of the
 * onset, lies above the fold and is stable: k > -k_c. */
static void maugis_under_springs(void **state)
{
    (void)state;
    int apart = 0, in_contact = 0;
    for (double lambda = 0.01; lambda < 1e3; lambda *= 1.31)
        for (double spring = 1e-2; spring < 1e4; spring *= 3.7) {
            const nt_contact_law law = law_of(NT_MAUGIS, lambda);
            const nt_jump jump = jump_of(&law, spring);
            const nt_contact_state *last = &jump.last, *landed = &jump.landed;
            assert_true(last->value.k == -spring);
            if (spring < 30.0) /* stiffer ones fold where a double of delta hardly tells k */
                assert_within(eval(&law.maugis, last->indentation, NT_BRANCH_STABLE).k, -spring, 2e-4 * spring);
            apart += last->value.a == 0.0;
            in_contact += last->value.a > 0.0;
            const double D = last->indentation + last->value.F / spring;
            assert_within(jump.pull_off_gap, -D, 1e-15 * fabs(D));
            for (double h = 1e-3; h > 1e-5; h *= 0.1) {
                nt_law_value beside;
                assert_int_equal(nt_maugis_eval(&law.maugis, last->indentation + h, NT_BRANCH_STABLE, &beside, NULL),
                                 NT_OK);
                assert_true(last->indentation + h + beside.F / spring > D);
                if (last->indentation - h < law.maugis.folds.grip_indentation)
                    continue;
                assert_int_equal(nt_maugis_eval(&law.maugis, last->indentation - h, NT_BRANCH_STABLE, &beside, NULL),
                                 NT_OK);
                assert_true(last->indentation - h + beside.F / spring > D);
            }
            assert_within(landed->indentation + landed->value.F / spring, law.maugis.folds.onset_indentation,
                          1e-13 * (1.0 + fabs(D) + 2.0 / spring));
            assert_within(jump.jump_in_gap, nt_maugis_onset_gap(&law.maugis), 0.0);
            const nt_law_value held = eval(&law.maugis, landed->indentation, NT_BRANCH_STABLE);
            assert_within(landed->value.F, held.F, 1e-11 * (1.0 + fabs(held.k)));
            assert_true(landed->value.k > -spring && landed->indentation > last->indentation);
            assert_true(jump.pull_off_gap > jump.jump_in_gap);
        }
    assert_true(apart > 20 && in_contact > 20); /* both kinds of fold were met */
}

/* A spring of 0 is load control, an infinite one grips; finite ones lie between. */
static void springs_end_at_weights_and_grips(void **state)
{
    (void)state;
    for (double lambda = 1e-3; lambda < 1e6; lambda *= 2.3) {
        const nt_contact_law law = law_of(NT_MAUGIS, lambda);
        const nt_maugis_folds *folds = &law.maugis.folds;
        const nt_jump weight = jump_of(&law, 0.0), grips = jump_of(&law, INFINITY);
        assert_within(weight.last.value.F, folds->pull_off_load, 1e-14);
        assert_within(weight.landed.value.F, 0.0, 1e-13);
        assert_within(weight.landed.indentation, folds->zero_load_indentation, 1e-13);
        assert_true(isnan(weight.pull_off_gap));
        assert_within(grips.last.indentation, folds->grip_indentation, 1e-13 * fabs(folds->grip_indentation));
        assert_within(grips.last.value.F, folds->grip_load, 1e-11 * (1.0 + fabs(folds->grip_load)));
        assert_within(grips.landed.indentation, folds->onset_indentation,
                      1e-12 * fabs(folds->onset_indentation) + 1e-14);
        const nt_jump soft = jump_of(&law, 1e-9), stiff = jump_of(&law, 1e12);
        assert_within(soft.last.value.F, folds->pull_off_load, 1e-8);
        assert_within(stiff.last.indentation, grips.last.indentation, 1e-9 * (1.0 + fabs(folds->grip_indentation)));
        double force = folds->pull_off_load;
        for (double spring = 1e-3; spring < 1e6; spring *= 10.0) {
            const double next = jump_of(&law, spring).last.value.F;
            assert_true(next >= force - 1e-14); /* the stiffer, the less force is left at the end */
            force = next;
        }
    }
}

/* JKR: -3/2 under dead weight; between grips -5/6 at -0.9086 (Maugis 1992), jump-in at first touch to 8/9 of the
 * pull-off force at delta = 0: a^3 = (8/3), F = -4/3 in units of pi w R. */
static void jkr_by_its_known_numbers(void **state)
{
    (void)state;
    const nt_contact contact = nt_contact_defaults();
    nt_contact_law law;
    assert_int_equal(nt_contact_law_init(&law, NT_JKR, &contact), NT_OK);
    const double unit = NT_PI * contact.work_of_adhesion * contact.radius;
    const nt_jump weight = jump_of(&law, 0.0), grips = jump_of(&law, INFINITY), spring = jump_of(&law, 1.0);
    assert_within(weight.last.value.F, -nt_jkr_pull_off_force(&contact), 1e-14 * unit);
    assert_within(grips.last.value.F, -5.0 / 6.0 * unit, 1e-13 * unit);
    assert_within(grips.last.indentation, nt_jkr_pull_off_indentation(&contact), 1e-24);
    assert_within(grips.landed.value.F, -4.0 / 3.0 * unit, 1e-13 * unit);
    assert_within(grips.jump_in_gap, 0.0, 1e-24);
    assert_within(spring.last.value.k, -1.0, 1e-7);
    nt_contact_state at;
    nt_law_value value;
    assert_int_equal(nt_contact_law_at_load(&law, 3.0 * unit, NT_BRANCH_STABLE, &at), NT_OK);
    assert_int_equal(nt_jkr_eval(&contact, at.indentation, NT_BRANCH_STABLE, &value), NT_OK);
    assert_within(value.F, 3.0 * unit, 1e-13 * unit);
    assert_within(at.value.a, value.a, 1e-13 * value.a);
}

/* DMT holds until first touch with its whole attraction, and jumps in there. */
static void dmt_and_hertz(void **state)
{
    (void)state;
    const nt_contact contact = nt_contact_defaults();
    nt_contact_law dmt, hertz;
    assert_int_equal(nt_contact_law_init(&dmt, NT_DMT, &contact), NT_OK);
    assert_int_equal(nt_contact_law_init(&hertz, NT_HERTZ, &contact), NT_OK);
    const double pull_off = nt_dmt_pull_off_force(&contact);
    for (double spring = 0.01; spring < 1e4; spring *= 7.0) {
        const nt_jump jump = jump_of(&dmt, spring);
        assert_true(jump.last.value.F == -pull_off && jump.last.indentation == 0.0 && jump.jump_in_gap == 0.0);
        assert_within(jump.pull_off_gap, pull_off / spring, 1e-15 * pull_off / spring);
        assert_within(spring * jump.landed.indentation, -jump.landed.value.F, 1e-13 * pull_off);
        assert_true(jump.landed.indentation > 0.0);
    }
    for (double radius = 1e-9; radius < 1e-6; radius *= 1.01) { /* whatever way the root of a dead weight is rounded */
        nt_contact_law heavy = dmt;
        heavy.maugis.contact.radius = radius;
        const double scale = nt_dmt_pull_off_force(&heavy.maugis.contact);
        assert_within(jump_of(&heavy, 0.0).landed.value.F, 0.0, 1e-14 * scale);
    }
    assert_true(jump_of(&dmt, INFINITY).landed.indentation == 0.0);
    const nt_jump none = jump_of(&hertz, 1.0);
    assert_true(none.jump_in_gap == 0.0 && none.pull_off_gap == 0.0 && none.last.value.F == 0.0);
    nt_contact_state at;
    assert_int_equal(nt_contact_law_at_load(&dmt, 1e-9, NT_BRANCH_STABLE, &at), NT_OK);
    assert_within(at.value.F, 1e-9, 1e-14 * (1e-9 + pull_off));
    assert_int_equal(nt_contact_law_at_load(&dmt, -1.01 * pull_off, NT_BRANCH_STABLE, &at), NT_E_NO_SOLUTION);
    assert_int_equal(nt_contact_law_at_load(&hertz, 1e-9, NT_BRANCH_UNSTABLE, &at), NT_E_NO_SOLUTION);
    assert_int_equal(nt_contact_law_at_load(&hertz, NAN, NT_BRANCH_STABLE, &at), NT_E_NOT_FINITE);
}

static void refuses_bad_springs(void **state)
{
    (void)state;
    const nt_contact_law law = law_of(NT_MAUGIS, 1.0);
    nt_jump jump = {.jump_in_gap = 7.0};
    assert_int_equal(nt_contact_law_jump(&law, -1.0, &jump), NT_E_RANGE);
    assert_int_equal(nt_contact_law_jump(&law, NAN, &jump), NT_E_NOT_FINITE);
    assert_true(jump.jump_in_gap == 7.0);
    nt_contact_state at;
    assert_int_equal(nt_maugis_spring_fold(&law.maugis, -1.0, &at), NT_E_RANGE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maugis_under_springs),     cmocka_unit_test(springs_end_at_weights_and_grips),
        cmocka_unit_test(jkr_by_its_known_numbers), cmocka_unit_test(dmt_and_hertz),
        cmocka_unit_test(refuses_bad_springs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
