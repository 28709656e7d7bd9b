/* SPDX-License-Identifier: BSD-3-Clause
 * A sample that keeps its dents: beside the law at rest, a ploughing tip, a tip that is rolled over the dent, and its
 * own account of energy. */
#include <math.h>
#include <stdlib.h>

#include "assertions.h"
#include "larger.h"
#include "nanotouch/nanotouch.h"
#include "plasticity/dents.h"

static const nt_indentation gold = {20e-9, 77e9, 0.35e9};

/* As the simulated probe does it: the gap counts from the surface with its dents. */
static double press(const nt_indentation *law, nt_dents *dents, double load)
{
    double low = -0.5 * law->radius, high = 1e-9;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        *(nt_dents_eval(law, dents, middle).F > load ? &low : &high) = middle;
    }
    nt_dents_advance(law, dents, low);
    return low;
}

static void let_go(const nt_indentation *law, nt_dents *dents, double x, double y)
{
    nt_dents_advance(law, dents, 1e-9);
    nt_dents_place(law, dents, x, y);
}

static void up_and_down_is_the_law_at_rest(void **state)
{
    (void)state;
    nt_dents dents = {0};
    nt_indentation_state alone = {0};
    nt_dents_place(&gold, &dents, 0.0, 0.0);
    for (int i = 0; i <= 400; ++i) {
        const double depth = 1e-9 * (i < 200 ? i : i < 300 ? 400 - i : i - 200) / 200.0;
        nt_dents_advance(&gold, &dents, -depth);
        assert_int_equal(nt_indentation_advance(&gold, &alone, depth), NT_OK);
        assert_true(dents.contact.force == alone.force && dents.dissipated == alone.dissipated);
        assert_within(dents.contact.stored, alone.stored, 1e-12 * alone.stored + 1e-40);
        assert_within(nt_dents_eval(&gold, &dents, -depth).F, alone.force, 1e-12 * alone.force);
    }
    assert_int_equal(dents.count, 0);
    nt_dents_advance(&gold, &dents, 1e-9);
    assert_int_equal(nt_dents_place(&gold, &dents, 1e-6, 0.0), 1);
    assert_true(dents.made[0].imprint.radius == alone.dent_radius && dents.made[0].before == -1);
    assert_true(nt_dents_lowered(&gold, &dents, 0.0, 0.0) == dents.made[0].imprint.depth);
}

/* F = -dU/dh, k = -dF/dh at trial gaps, at rest and ploughed, of a flat and of a dent. */
static void the_law_is_a_potential(void **state)
{
    (void)state;
    nt_dents dents = {0};
    nt_dents_place(&gold, &dents, 0.0, 0.0);
    for (int stage = 0; stage < 3; ++stage) {
        for (double gap = -13e-12; gap > -2e-9; gap -= 13e-12) {
            const double h = 1e-15, k = nt_dents_eval(&gold, &dents, gap).k, F = nt_dents_eval(&gold, &dents, gap).F;
            const nt_law_value up = nt_dents_eval(&gold, &dents, gap + h), down = nt_dents_eval(&gold, &dents, gap - h);
            assert_within((down.U - up.U) / (2.0 * h), F, 1e-4 * F + 1e-12);
            assert_within((down.F - up.F) / (2.0 * h), k, 1e-2 * k + 1e-3);
        }
        press(&gold, &dents, 60e-9);
        if (stage == 1)
            nt_dents_slide(&gold, &dents, 3e-9, 1e-9);
    }
}

/* Slides on until nothing changes: width, depth and both forces of Bowden and Tabor (nt_scratch, H = 3 Y). */
static void a_tip_that_slides_ploughs(void **state)
{
    (void)state;
    const nt_indentation soft = {20e-9, 77e9, 0.005e9}; /* plastic from 0.1 nN on */
    const nt_scratching scratching = {20e-9, 0.015e9, 0.0, 0.0, 0.0};
    for (double load = 0.2e-9; load < 1.1e-9; load *= 1.5) {
        nt_dents dents = {0};
        nt_groove groove;
        nt_dents_place(&soft, &dents, 0.0, 0.0);
        press(&soft, &dents, load);
        const double at_rest = dents.contact.contact_radius;
        double x = 0.0;
        for (; x < 200e-9; x += 0.5e-9) {
            nt_dents_slide(&soft, &dents, x, 0.0);
            press(&soft, &dents, load);
        }
        assert_int_equal(nt_scratch(&scratching, load, &groove, NULL), NT_OK);
        const double share = dents.ploughed; /* the elastic part of the depth comes back */
        assert_true(share > 0.98 && share < 1.0);
        assert_within(dents.contact.contact_radius, sqrt(2.0 / (2.0 - share)) * at_rest, 1e-6 * at_rest);
        assert_within(2.0 * dents.contact.contact_radius, groove.width, 0.01 * groove.width);
        assert_within(nt_dents_ploughing(&soft, &dents), groove.ploughing, 0.02 * groove.ploughing);
        let_go(&soft, &dents, x, 50e-9);
        assert_int_equal(dents.count, 1);
        assert_true(dents.made[0].imprint.start[0] == 0.0 && dents.made[0].imprint.end[0] > 190e-9);
        assert_within(2.0 * dents.made[0].imprint.radius, groove.width, 0.01 * groove.width);
    }
}

/* Stays elastic: no heat, no groove. */
static void a_light_tip_leaves_nothing(void **state)
{
    (void)state;
    nt_dents dents = {0};
    nt_dents_place(&gold, &dents, 0.0, 0.0);
    press(&gold, &dents, 0.9 * nt_indentation_yield_load(&gold));
    nt_dents_slide(&gold, &dents, 50e-9, 0.0);
    let_go(&gold, &dents, 0.0, 0.0);
    assert_true(dents.count == 0 && dents.dissipated == 0.0);
}

/* The apex of a paraboloid over the dent and the flat around it, tried point by point. */
static double rolled(const nt_imprint *dent, double radius, double s)
{
    double highest = 0.0; /* of dent minus tip; far away the flat */
    highest = -HUGE_VAL;
    for (double r = -2.0 * dent->radius; r <= 2.0 * dent->radius; r += 1e-4 * dent->radius) {
        const double u = r / dent->radius, z = fabs(u) < 1.0 ? -dent->depth * (1.0 - u * u) : 0.0;
        highest = larger(highest, z - 0.5 * (r - s) * (r - s) / radius);
    }
    return highest;
}

static void a_dent_lowers_the_apex_as_a_rolling_tip_says(void **state)
{
    (void)state;
    nt_dents dents = {0};
    nt_dents_place(&gold, &dents, 0.0, 0.0);
    press(&gold, &dents, 20e-9);
    let_go(&gold, &dents, 0.0, 0.0);
    const nt_imprint *dent = &dents.made[0].imprint;
    for (double s = 0.0; s < 1.5 * dent->radius; s += 0.03 * dent->radius) {
        const double lowered = nt_dents_lowered(&gold, &dents, 0.6 * s, -0.8 * s);
        assert_within(lowered, -rolled(dent, gold.radius, s), 1e-4 * dent->depth);
    }
}

static void a_dent_remembers_its_load(void **state)
{
    (void)state;
    nt_dents dents = {0};
    nt_dents_place(&gold, &dents, 0.0, 0.0);
    press(&gold, &dents, 50e-9);
    let_go(&gold, &dents, 0.0, 0.0);
    const double heat = dents.dissipated;
    press(&gold, &dents, 49.9e-9);
    let_go(&gold, &dents, 0.0, 0.0);
    assert_true(dents.dissipated == heat && dents.count == 1);
    press(&gold, &dents, 80e-9);
    let_go(&gold, &dents, 0.0, 0.0);
    assert_true(dents.dissipated > heat && dents.count == 1 && dents.made[0].grown == 1);
    nt_dents once = {0};
    nt_dents_place(&gold, &once, 0.0, 0.0);
    press(&gold, &once, 80e-9);
    assert_within(once.dissipated, dents.dissipated, 1e-12 * heat); /* at once or in two steps */
    assert_int_equal(nt_dents_undo(&dents), 1);
    assert_int_equal(nt_dents_undo(&dents), 0);
    nt_dents_place(&gold, &dents, 0.0, 0.0);
    assert_true(dents.began == 0.0 && dents.inside == -1);
}

static void leave_at(nt_dents *dents, double x, double load)
{
    nt_dents_place(&gold, dents, x, 0.0);
    press(&gold, dents, load);
    let_go(&gold, dents, x, 1e-3);
}

/* Only the last of the list grows in its place: what an older one has become is taken back alone. */
static void an_older_dent_grows_as_a_new_one(void **state)
{
    (void)state;
    nt_dents dents = {0};
    leave_at(&dents, 0.0, 50e-9);
    leave_at(&dents, 1e-6, 50e-9);
    leave_at(&dents, 0.0, 60e-9);
    assert_true(dents.count == 3 && dents.made[2].before == 0 && dents.made[2].grown == 0);
    leave_at(&dents, 2e-9, 70e-9); /* inside it, but not in its middle */
    assert_true(dents.count == 3 && dents.made[2].before == 0 && dents.made[2].grown == 1);
    assert_true(dents.made[2].imprint.start[0] == 0.0 && dents.made[2].imprint.end[0] == 0.0);
    assert_int_equal(nt_dents_undo(&dents), 1);
    nt_dents_place(&gold, &dents, 0.0, 0.0);
    assert_true(dents.count == 2 && dents.began == dents.made[0].imprint.radius);
}

/* A lever that rings: a thousand contacts in one place, each a little harder, make one dent and the heat of one press.
 */
static void taps_add_up_to_one_dent(void **state)
{
    (void)state;
    nt_dents dents = {0}, once = {0};
    for (int i = 0; i < NT_DENTS; ++i)
        leave_at(&dents, 1e-6 * i, 5e-9);
    assert_true(dents.count == NT_DENTS && !dents.full);
    const double before = dents.dissipated;
    const double last = 1e-6 * (NT_DENTS - 1);
    for (int i = 1; i <= 1000; ++i) {
        nt_dents_place(&gold, &dents, last, 0.0);
        press(&gold, &dents, 5e-9 + 95e-9 * i / 1000.0);
        nt_dents_advance(&gold, &dents, 1e-9);
    }
    nt_dents_place(&gold, &dents, last, 1e-3);
    assert_true(dents.count == NT_DENTS && !dents.full && dents.made[NT_DENTS - 1].grown > 300);
    leave_at(&once, 0.0, 5e-9);
    const double first = once.dissipated;
    leave_at(&once, 0.0, 100e-9);
    const double heat = once.dissipated - first;
    assert_within(dents.dissipated - before, heat, 1e-9 * heat);
    assert_within(dents.made[NT_DENTS - 1].imprint.radius, once.made[0].imprint.radius,
                  2e-3 * once.made[0].imprint.radius);
    leave_at(&dents, 1.0, 5e-9);
    assert_true(dents.full && dents.count == NT_DENTS);
    assert_int_equal(nt_dents_undo(&dents), 1);
    assert_false(dents.full);
}

/* Work of a way in depth, by Gauss' sums between kinks that are not known: many pieces. */
static double work_of(const nt_indentation *law, const nt_dents *dents, double from, double to)
{
    static const double at[] = {0.1127016653792583, 0.5, 0.8872983346207417}, weight[] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
    const int pieces = 2000;
    double sum = 0.0;
    for (int i = 0; i < pieces; ++i)
        for (int j = 0; j < 3; ++j)
            sum += weight[j] * nt_dents_eval(law, dents, from + (to - from) * (i + at[j]) / pieces).F;
    return -sum * (to - from) / pieces;
}

/* Presses, slides, lets go, somewhere else: what goes in is stored and heat, whatever the way. */
static void energy_is_kept(void **state)
{
    (void)state;
    const char *asked = getenv("NANOTOUCH_INDENTATION_PATHS");
    const long paths = asked ? atol(asked) : 30;
    nt_random random = nt_random_seed(3);
    double worst = 0.0;
    for (long i = 0; i < paths; ++i) {
        const nt_indentation law = {20e-9, 77e9, 77e9 * pow(10.0, -4.0 + 3.0 * nt_random_uniform(&random))};
        nt_dents dents = {0};
        double gap = 1e-10, work = 0.0, turnover = 0.0;
        nt_dents_place(&law, &dents, 0.0, 0.0);
        for (int k = 0; k < 30; ++k) {
            const double to = nt_random_uniform(&random) < 0.3 ? 1e-10 : -1.5e-9 * nt_random_uniform(&random);
            const double heat = dents.dissipated, step = work_of(&law, &dents, gap, to);
            const double x = 20e-9 * nt_random_uniform(&random), y = 20e-9 * nt_random_uniform(&random);
            nt_dents_advance(&law, &dents, gap = to);
            work += step;
            turnover += fabs(step);
            worst = larger(worst, fabs(dents.contact.stored + dents.dissipated - work) / (turnover + 1e-30));
            assert_true(dents.dissipated >= heat && dents.contact.stored >= 0.0);
            if (dents.touches)
                nt_dents_slide(&law, &dents, x, y);
            else if (nt_dents_place(&law, &dents, x, y) >= 0)
                gap = 1e-10; /* over another place */
            assert_true(dents.dissipated >= heat && nt_dents_ploughing(&law, &dents) >= 0.0);
            worst = larger(worst, fabs(dents.contact.stored + dents.dissipated - work) / (turnover + 1e-30));
        }
    }
    print_message("%ld paths: stored + dissipated beside the work within %.2g of the turnover\n", paths, worst);
    assert_true(worst < 2e-6); /* the kinks lie anywhere in 2000 pieces */
}

/* Presses, drags, taps, goes elsewhere, takes back, at random: the list stays whole, and what is told of it, one dent
 * at a time as a session does, leads to the same list. */
static void the_list_stays_whole(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(11);
    for (int i = 0; i < 60; ++i) {
        nt_dents dents = {0};
        nt_dent told[NT_DENTS];
        int count = 0;
        nt_dents_place(&gold, &dents, 0.0, 0.0);
        for (int k = 0; k < 400 && !dents.full; ++k) {
            const double x = 60e-9 * nt_random_uniform(&random), heat = dents.dissipated;
            const double what = nt_random_uniform(&random);
            nt_dents_advance(&gold, &dents, what < 0.4 ? 1e-9 : -2e-9 * nt_random_uniform(&random));
            if (dents.touches && nt_random_uniform(&random) < 0.3)
                nt_dents_slide(&gold, &dents, dents.at[0] + 10e-9 * nt_random_uniform(&random), 0.0);
            const int left = nt_dents_place(&gold, &dents, what < 0.2 ? dents.at[0] : x, 0.0);
            for (int m = dents.count - left; m < dents.count; ++m) {
                assert_true(m == count || (m == count - 1 && dents.made[m].grown > 0));
                told[m] = dents.made[m];
                count = m + 1;
            }
            if (nt_random_uniform(&random) < 0.1)
                count -= nt_dents_undo(&dents);
            assert_true(dents.count == count && dents.dissipated >= heat && dents.inside < NT_DENTS);
        }
        for (int m = 0; m < count; ++m) {
            const nt_dent *dent = &dents.made[m];
            assert_true(dent->before < m && dent->imprint.depth > 0.0 && dent->load > 0.0);
            assert_memory_equal(&told[m].imprint, &dent->imprint, sizeof dent->imprint);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(up_and_down_is_the_law_at_rest),
        cmocka_unit_test(the_law_is_a_potential),
        cmocka_unit_test(a_tip_that_slides_ploughs),
        cmocka_unit_test(a_light_tip_leaves_nothing),
        cmocka_unit_test(a_dent_lowers_the_apex_as_a_rolling_tip_says),
        cmocka_unit_test(a_dent_remembers_its_load),
        cmocka_unit_test(an_older_dent_grows_as_a_new_one),
        cmocka_unit_test(taps_add_up_to_one_dent),
        cmocka_unit_test(the_list_stays_whole),
        cmocka_unit_test(energy_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
