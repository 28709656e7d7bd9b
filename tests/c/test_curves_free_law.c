/* SPDX-License-Identifier: BSD-3-Clause
 * curves/free_law.c: what is even on both branches is a bow, what is odd a film, and what is neither is no film of
 * both. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "curves/free_law.h"
#include "nanotouch/advanced/random.h"

enum { POINTS = 1600, SEEDS = 40 };

static const double noise = 8e-12, length = 3e-6; /* N, m */

/* Of the free parts: forces at z = 0 of a film of the approach and of the retraction, bow at the far end, and forces
 * of both branches that halve within 2 % of the length [N]. */
typedef struct forces {
    double film, back, bow, near, near_back;
} forces;

static double z_[POINTS], force_[2][POINTS];

/* Branches with lines of their own from 0 to `length`; the retraction's counts from `held` of that on. */
static nt_free_record record_of(const forces *f, double held, uint64_t seed)
{
    nt_random random = nt_random_seed(seed);
    nt_free_record record = {.middle = 0.5 * length, .half = 0.5 * length, .foot = -1.02};
    for (int i = 0; i < POINTS; i++) {
        const double u = (double)i / (POINTS - 1), decay = 1.0 / (1.0 + u / 0.08), soon = 1.0 / (1.0 + u / 0.02);
        z_[i] = u * length;
        force_[0][i] = 30e-12 - 20e-12 * u + f->bow * u * u + f->film * decay + noise * nt_random_normal(&random);
        force_[0][i] += f->near * soon;
        force_[1][i] = f->near_back * soon - 40e-12 + 10e-12 * u + f->bow * u * u + f->back * decay +
                       noise * nt_random_normal(&random);
    }
    const nt_curve_branch on = {.z = z_, .force = force_[0], .count = POINTS};
    const nt_curve_branch back = {.z = z_, .force = force_[1], .count = POINTS};
    const long first = (long)(held * POINTS);
    record.approach = nt_free_means_of(&on, 0, &record);
    if (first < POINTS)
        record.tail = nt_free_means_of(&back, first, &record);
    return record;
}

static void a_line_is_a_line(void **state)
{
    (void)state;
    int bent = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const nt_free_record record = record_of(&(forces){.bow = 0.0}, 0.0, seed);
        nt_curve_bend_doubts doubts;
        const nt_free_law law = nt_free_judge(&record, &doubts);
        bent += law.has_bow || law.has_film;
        assert_true(doubts.level < 4e-12 * 4e-12); /* a line through 1600 points is known to 0.4 pN at its end */
    }
    assert_true(bent <= 1); /* chi^2 gains 9 by chance once in 370 */
}

/* Of a bow of 60 pN and of none beside a film of 60 pN: within its sigma as often as it should. */
static void a_bow_is_known_to_its_sigma(void **state)
{
    (void)state;
    for (int film = 0; film < 2; film++) {
        double squares = 0.0;
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            const nt_free_record record =
                record_of(&(forces){.film = film * 60e-12, .back = film * -60e-12, .bow = 60e-12}, 0.0, seed);
            nt_curve_bend_doubts doubts;
            const nt_free_law law = nt_free_judge(&record, &doubts);
            const double off = law.bow / (record.half * record.half) - 60e-12 / (length * length);
            assert_true(law.has_bow && law.has_film == film && law.confirmed);
            squares += off * off / (doubts.bow_sigma * doubts.bow_sigma) / SEEDS;
        }
        assert_true(sqrt(squares) > 0.5 && sqrt(squares) < 1.5);
    }
}

/* On the approach alone a film of 40 pN looks much like a bow; the free retraction tells. */
static void the_retraction_tells_film_from_bow(void **state)
{
    (void)state;
    int right = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const nt_free_record record = record_of(&(forces){.film = 40e-12, .back = -40e-12}, 0.0, seed);
        nt_curve_bend_doubts doubts;
        const nt_free_law law = nt_free_judge(&record, &doubts);
        right += law.has_film && !law.has_bow && fabs(nt_free_film_at(&law, &record, -1.0) - 40e-12) < 12e-12;
        assert_true(doubts.film > 0.9);
    }
    assert_true(right >= SEEDS - 3);
}

/* Ions repel on both branches: no film explains that, and the retraction is left out. */
static void a_repulsion_of_both_is_not_confirmed(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const nt_free_record record = record_of(&(forces){.film = 80e-12, .back = 80e-12}, 0.0, seed);
        nt_curve_bend_doubts doubts;
        assert_false(nt_free_judge(&record, &doubts).confirmed);
    }
}

/* What decays at once is the foot of a soft contact where nothing of it is seen on the retraction, a film where that
 * shows it with the other sign. A foot bends nothing, and leaves no film open. */
static void a_foot_is_no_film(void **state)
{
    (void)state;
    static const double held[] = {1.0, 0.5, 0.0};
    int films[3] = {0}, bows = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++)
        for (int i = 0; i < 3; i++) {
            const nt_free_record record = record_of(&(forces){.near = 200e-12, .near_back = -200e-12}, held[i], seed);
            nt_curve_bend_doubts doubts;
            const nt_free_law law = nt_free_judge(&record, &doubts);
            films[i] += law.has_film;
            bows += law.has_bow;
            assert_true(law.has_film == (doubts.film > 0.0) && law.has_film == (doubts.film_force > 0.0));
        }
    assert_true(films[0] <= 4 && films[1] <= 4); /* one whose fit makes it longer than the shortest */
    assert_int_equal(films[2], SEEDS);
    assert_true(bows <= 4);
}

/* Without a tail, and with one that begins so far out that bow and film cannot be told apart on it. */
static void a_short_tail_does_no_harm(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        nt_curve_bend_doubts alone, doubts;
        const nt_free_record without = record_of(&(forces){.bow = 90e-12}, 1.0, seed);
        const nt_free_law one = nt_free_judge(&without, &alone);
        const nt_free_record with = record_of(&(forces){.bow = 90e-12}, 0.9, seed);
        const nt_free_law other = nt_free_judge(&with, &doubts);
        assert_true(one.has_bow && other.has_bow && !one.confirmed);
        assert_true(fabs(one.bow - other.bow) < 0.2 * one.bow);
        assert_true(isfinite(doubts.bow_sigma) && isfinite(doubts.level) && isfinite(doubts.film_sigma));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_line_is_a_line),
        cmocka_unit_test(a_bow_is_known_to_its_sigma),
        cmocka_unit_test(the_retraction_tells_film_from_bow),
        cmocka_unit_test(a_repulsion_of_both_is_not_confirmed),
        cmocka_unit_test(a_foot_is_no_film),
        cmocka_unit_test(a_short_tail_does_no_harm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
