/* SPDX-License-Identifier: BSD-3-Clause
 * The hard guarantee against random operators on random scenes, rigs and gains (adversary.h): force and indentation, as
 * they truly are, never pass what was promised before arming. Some runs of each kind by default;
 * tests/heavy/guarantee.py calls the same program for all of them:
 *
 *     test_session_adversary KIND FIRST COUNT      KIND quasi-static, dynamic or fault; one line for each seed
 *     test_session_adversary search KIND SEED RUNS the default rig: runs that come ever closer */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "adversary.h"

static const char *const kinds[ATTACKS] = {"quasi-static", "dynamic", "fault"};

static closeness run_seed(attack kind, long seed)
{
    static plot p;
    dice d = {.random = nt_random_seed((uint64_t)seed * ATTACKS + (uint64_t)kind)};
    p = (plot){.kind = kind};
    return run_plot(&p, &d);
}

static void no_operator_breaks_the_guarantee(void **state)
{
    (void)state;
    static const long runs[ATTACKS] = {60, 4, 60};
    for (int kind = 0; kind < ATTACKS; kind++) {
        double force = 0.0, indentation = 0.0;
        int stops = 0, opened = 0;
        for (long seed = 0; seed < runs[kind]; seed++) {
            const closeness found = run_seed((attack)kind, seed);
            if (!(found.force < 1.0 && found.indentation < 1.0))
                print_message("%s, seed %ld: force %.3f, indentation %.3f of what was promised; %s %g\n", kinds[kind],
                              seed, found.force, found.indentation, found.fault, found.value);
            force = larger(force, found.force);
            indentation = larger(indentation, found.indentation);
            stops += found.stops;
            opened += found.opened;
        }
        print_message("%s: %d runs, %d stops: at worst %.3f of the promised force, %.3f of the indentation\n",
                      kinds[kind], opened, stops, force, indentation);
        assert_true(2 * opened > runs[kind]); /* few are refused before arming */
        assert_true(force < 1.0 && indentation < 1.0);
        assert_true(force > 0.1); /* they did try */
    }
}

static int print_runs(attack kind, long first, long count)
{
    for (long seed = first; seed < first + count; seed++) {
        const closeness found = run_seed(kind, seed);
        printf("%ld %d %.4f %.4f %d %s %.3g\n", seed, found.opened, found.force, found.indentation, found.stops,
               found.fault[0] ? found.fault : "-", found.value);
    }
    return 0;
}

/* Genes are changed, a few at a time; what comes closer stays. */
static int search(attack kind, long seed, long runs)
{
    static plot p;
    static double best_genes[GENES], genes[GENES];
    closeness best = {.fault = ""};
    nt_random random = nt_random_seed((uint64_t)seed);
    for (long run = 0; run < runs; run++) {
        const int fresh = run < runs / 4;
        const double share = 0.3 * pow(0.02, nt_random_uniform(&random));
        for (int i = 0; i < GENES; i++) {
            const int changes = fresh || nt_random_uniform(&random) < share;
            genes[i] = changes ? nt_random_uniform(&random) : best_genes[i];
        }
        p = (plot){.kind = kind, .plain = 1};
        dice d = {.genes = genes};
        const closeness found = run_plot(&p, &d);
        if (!found.opened || !(found.force >= best.force))
            continue;
        best = found;
        memcpy(best_genes, genes, sizeof genes);
        printf("%ld: %.1f nN of %.1f nN, %.3f; %.3f of the indentation; %s %.3g\n", run, 1e9 * best.worst_force,
               1e9 * best.promised_force, best.force, best.indentation, best.fault, best.value);
    }
    return 0;
}

static int kind_of(const char *name)
{
    int kind = 0;
    while (kind < ATTACKS && strcmp(name, kinds[kind]) != 0)
        kind++;
    return kind;
}

int main(int count, char **words)
{
    const int searches = count == 5 && strcmp(words[1], "search") == 0;
    const int kind = count > 2 ? kind_of(words[count == 5 ? 2 : 1]) : ATTACKS;
    if (searches && kind < ATTACKS)
        return search((attack)kind, strtol(words[3], NULL, 10), strtol(words[4], NULL, 10));
    if (count == 4 && kind < ATTACKS)
        return print_runs((attack)kind, strtol(words[2], NULL, 10), strtol(words[3], NULL, 10));
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_operator_breaks_the_guarantee)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
