/* SPDX-License-Identifier: BSD-3-Clause
 * Each check on records made by hand: what holds, what does not and in which words, what makes no sense. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "nanotouch/control.h"
#include "nanotouch/testing.h"

enum { ROWS = 6 };

/* Rows of 0.1 ms from 1.2 s on, in RUN, without force. */
static void make(nt_record *records)
{
    memset(records, 0, ROWS * sizeof *records);
    for (int i = 0; i < ROWS; ++i) {
        records[i].tick = (uint64_t)i;
        records[i].time = 1.2 + 1e-4 * i;
        records[i].gap = 1e-9 * i;
        records[i].amplitude = NAN;
    }
}

static void a_stop_is_told(void **state)
{
    (void)state;
    nt_record records[ROWS];
    nt_finding finding;
    make(records);
    assert_int_equal(nt_testing_runs(records, ROWS, &finding), NT_OK);
    assert_string_equal(finding.text, "");
    records[4].state = NT_HOLD;
    records[4].reasons = NT_REASON_FORCE_LIMIT | NT_REASON_STALE;
    records[5].state = NT_RETRACT;
    assert_int_equal(nt_testing_runs(records, ROWS, &finding), NT_E_STATE);
    char words[200];
    snprintf(words, sizeof words, "HOLD at 1.2004 s: %s, %s; it was in RUN in 4 of 6 periods and ended in RETRACT",
             nt_reason_name(NT_REASON_FORCE_LIMIT), nt_reason_name(NT_REASON_STALE));
    assert_string_equal(finding.text, words);
}

static void a_force_above_its_limit_is_told(void **state)
{
    (void)state;
    nt_record records[ROWS];
    nt_finding finding;
    make(records);
    const double forces[ROWS] = {0.0, 399e-9, -405e-9, 412e-9, 300e-9, 0.0};
    for (int i = 0; i < ROWS; ++i)
        records[i].tip_force[2] = forces[i];
    assert_int_equal(nt_testing_force_below(records, ROWS, 412e-9, &finding), NT_OK);
    assert_int_equal(nt_testing_force_below(records, ROWS, 400e-9, &finding), NT_E_STATE);
    assert_non_null(strstr(finding.text, "; nothing stopped it"));
    records[5].state = NT_HOLD;
    assert_int_equal(nt_testing_force_below(records, ROWS, 400e-9, &finding), NT_E_STATE);
    assert_string_equal(finding.text, "tip force 4.12e-07 N exceeded 4e-07 N at 1.2002 s, and most at 1.2003 s; HOLD "
                                      "came 3 ticks later");
    records[1].tip_force[2] = NAN;
    assert_int_equal(nt_testing_force_below(records, ROWS, 1.0, &finding), NT_E_STATE);
    assert_string_equal(finding.text, "tip force is not known at 1.2001 s");
    assert_int_equal(nt_testing_force_below(records, ROWS, 0.0, &finding), NT_E_RANGE);
    assert_int_equal(nt_testing_force_below(records, ROWS, NAN, &finding), NT_E_RANGE);
    assert_int_equal(nt_testing_force_below(records, 0, 1.0, &finding), NT_E_ARGUMENT);
    assert_int_equal(nt_testing_force_below(NULL, ROWS, 1.0, &finding), NT_E_ARGUMENT);
}

static void a_reaction_has_its_time(void **state)
{
    (void)state;
    nt_record records[ROWS];
    nt_finding finding;
    make(records);
    nt_reaction wanted = {NT_HOLD, 1.2001, 2e-4};
    assert_int_equal(nt_testing_reacts(records, ROWS, &wanted, &finding), NT_E_STATE);
    assert_string_equal(finding.text, "no HOLD within 0.0002 s of 1.2001 s; it ended in RUN");
    records[3].state = records[4].state = records[5].state = NT_RETRACT; /* stronger: it counts */
    assert_int_equal(nt_testing_reacts(records, ROWS, &wanted, &finding), NT_OK);
    wanted.within = 1.7e-4; /* not rounded up to the next period */
    assert_int_equal(nt_testing_reacts(records, ROWS, &wanted, &finding), NT_E_STATE);
    records[2].state = 7; /* no state, so no reaction */
    wanted.within = 1e-4;
    assert_int_equal(nt_testing_reacts(records, ROWS, &wanted, &finding), NT_E_STATE);
    records[2].state = NT_RUN;
    assert_int_equal(nt_testing_reacts(records, ROWS, &wanted, &finding), NT_E_STATE);
    assert_string_equal(finding.text, "no HOLD within 0.0001 s of 1.2001 s; RETRACT at 1.2003 s");
    wanted.after = 1.2004;
    assert_int_equal(nt_testing_reacts(records, ROWS, &wanted, &finding), NT_E_STATE);
    assert_string_equal(finding.text, "RETRACT at 1.2003 s, before 1.2004 s");
    for (int i = 0; i < 3; ++i) {
        wanted = (nt_reaction){NT_HOLD, 1.2001, 1e-4};
        if (i == 0)
            wanted.state = NT_RUN;
        else if (i == 1)
            wanted.within = 0.0;
        else
            wanted.after = 1.3;
        assert_int_equal(nt_testing_reacts(records, ROWS, &wanted, &finding), NT_E_RANGE);
    }
    assert_int_equal(nt_testing_reacts(records, ROWS, NULL, &finding), NT_E_ARGUMENT);
}

/* Two records are missing before the first that is in HOLD: what depends on them is not known. */
static void records_that_are_missing_are_not_passed_over(void **state)
{
    (void)state;
    nt_record records[ROWS];
    nt_finding finding;
    make(records);
    for (int i = 3; i < ROWS; ++i) {
        records[i].tick += 2;
        records[i].time += 2e-4;
        records[i].state = NT_HOLD; /* recorded at 1.2005 s, and perhaps so from 1.2003 s on */
    }
    const struct {
        double after, within;
        nt_status status;
    } cases[] = {
        {1.2002, 3e-4, NT_OK},        {1.2003, 2e-4, NT_OK},      {1.2004, 1e-4, NT_E_RANGE},
        {1.2002, 2.9e-4, NT_E_RANGE}, {1.2002, 1e-4, NT_E_RANGE}, {1.2001, 1e-4, NT_E_STATE},
        {1.2006, 1e-4, NT_E_STATE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const nt_reaction wanted = {NT_HOLD, cases[i].after, cases[i].within};
        const nt_status status = nt_testing_reacts(records, ROWS, &wanted, &finding);
        if (status != cases[i].status)
            fail_msg("case %d: status %d: %s", (int)i, (int)status, finding.text);
    }
    const nt_reaction before = {NT_HOLD, 1.2004, 1e-4};
    nt_testing_reacts(records, ROWS, &before, &finding);
    assert_string_equal(finding.text,
                        "no records between 1.2002 s and 1.2005 s: whether HOLD came before 1.2004 s is not "
                        "known; give every period");
    records[2].tick = records[1].tick;
    assert_int_equal(nt_testing_reacts(records, ROWS, &before, &finding), NT_E_RANGE);
    assert_string_equal(finding.text, "tick: it must rise from record to record");
}

static void records_are_compared(void **state)
{
    (void)state;
    nt_record records[ROWS], expected[ROWS], tolerance = {0};
    nt_finding finding;
    make(records);
    make(expected);
    assert_int_equal(nt_testing_same(records, expected, ROWS, NULL, &finding), NT_OK);
    records[2].stage_position[1] = 3e-9;
    assert_int_equal(nt_testing_same(records, expected, ROWS, NULL, &finding), NT_E_STATE);
    assert_string_equal(finding.text, "stage_position y at 1.2002 s: 3e-09 m, expected 0 m");
    tolerance.stage_position[1] = 4e-9;
    assert_int_equal(nt_testing_same(records, expected, ROWS, &tolerance, &finding), NT_OK);
    records[3].gap = NAN;
    assert_int_equal(nt_testing_same(records, expected, ROWS, &tolerance, &finding), NT_E_STATE);
    assert_non_null(strstr(finding.text, "gap at 1.2003 s: "));
    records[3].gap = expected[3].gap;
    records[5].flags = 1;
    assert_int_equal(nt_testing_same(records, expected, ROWS, &tolerance, &finding), NT_E_STATE);
    assert_non_null(strstr(finding.text, "differ at 1.2005 s"));
    assert_int_equal(nt_testing_same(records, NULL, ROWS, &tolerance, &finding), NT_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stop_is_told),          cmocka_unit_test(a_force_above_its_limit_is_told),
        cmocka_unit_test(a_reaction_has_its_time), cmocka_unit_test(records_that_are_missing_are_not_passed_over),
        cmocka_unit_test(records_are_compared),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
