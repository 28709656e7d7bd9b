/* SPDX-License-Identifier: BSD-3-Clause
 * Three faults at once, a quarter of all threes of the table, and with NANOTOUCH_ALL_DRAWS=1 every three: the force
 * stays below the guarantee unless a turned stage is lifted unseen, for which there is no bound. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "fault_cases.h"
#include "larger.h"

/* Beside those that blind it, any that takes the reading of the force, with another that keeps this from being seen. */
static int takes(const nt_fault *fault, nt_channel channel)
{
    return fault->channel == channel && fault->duration > ONE_TICK;
}

static int is_unseen(const fault_case *const three[3])
{
    int turned = 0, blind = 0, deflection = 0;
    for (int i = 0; i < 3; i++) {
        const nt_fault *fault = &three[i]->fault;
        turned |= turns_the_stage(fault);
        blind |= blinds(fault);
        deflection |= takes(fault, NT_CHANNEL_DEFLECTION);
    }
    return turned && (blind || deflection);
}

static void three_faults_keep_the_bounds(void **state)
{
    (void)state;
    const int share = getenv("NANOTOUCH_ALL_DRAWS") ? 1 : 4;
    static loop l;
    double worst = 0.0, unseen = 0.0;
    int triples = 0;
    for (int i = 0; i < FAULT_CASES; i++)
        for (int j = 0; j < i; j++)
            for (int k = 0; k < j; k++) {
                const fault_case *const three[3] = {&fault_cases[i], &fault_cases[j], &fault_cases[k]};
                if ((i + j + k) % share != 0 || is_slow(three[0]) || is_slow(three[1]) || is_slow(three[2]))
                    continue;
                outcome o;
                start(&l, three[0], three[1]);
                nt_fault third = three[2]->fault;
                third.start = (double)l.sim.slave.link.tick * l.sim.slave.link.period;
                assert_int_equal(nt_sim_inject(&l.sim, &third), NT_OK);
                assert_int_equal(observe(&l, 1500, &o), NT_OK);
                const nt_guarantee bound = promise(&l, 0.0);
                double *kept = is_unseen(three) ? &unseen : &worst;
                *kept = larger(*kept, o.worst_force);
                if (!o.finite || o.late_motor != 0.0 || !(o.worst_indentation >= 0.0) ||
                    !(*kept < (kept == &worst ? bound.force : (double)INFINITY)))
                    fail_msg("%s, %s, %s: %.0f nN", three[0]->name, three[1]->name, three[2]->name,
                             1e9 * o.worst_force);
                triples++;
            }
    print_message("%d triples: worst force %.0f nN, %.0f nN where a turned stage is lifted unseen\n", triples,
                  1e9 * worst, 1e9 * unseen);
    assert_true(worst > 0.9e-6 && unseen > 4e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(three_faults_keep_the_bounds)};
    return cmocka_run_group_tests(tests, press, NULL);
}
