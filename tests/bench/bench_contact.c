/* SPDX-License-Identifier: BSD-3-Clause
 * What contact laws cost, in nanoseconds and in multiples of an inlined Hertz of the same build: JSON on stdout.
 *
 * Each figure is the least of many runs, as whatever else a machine does only adds. Throughput is per element of an
 * array of 4096 that stays in cache; latency feeds every result into the next argument, as a control loop does. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "../c/larger.h"
#include "contact/maugis_table.h"
#include "internal/contact.h"
#include "internal/maugis.h"
#include "internal/surface.h"
#include "nanotouch/advanced/maugis.h"
#include "nanotouch/material.h"
#include "nanotouch/surface.h"

enum { COUNT = 4096, RUNS = 60, CELLS = 2000, PANELS = 120, BANK_CELLS = 7000, PIXELS = 128 };

typedef struct {
    nt_maugis maugis;
    nt_maugis_table table;
    double low, reach; /* of the indentations */
    double in[COUNT], out[COUNT];
} setting;

static nt_maugis_cell cells[CELLS];
static nt_maugis_panel panels[PANELS];
static nt_maugis_bank_cell bank_cells[BANK_CELLS];
static nt_maugis_bank bank;
static double lambdas[COUNT]; /* one for every element */
static setting now;
static double heights[PIXELS * PIXELS], ratios[PIXELS * PIXELS];
static nt_surface surface;
static nt_radius_map radii;
static volatile double sink;

static double seconds(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static inline double hertz(double d)
{
    return d > 0.0 ? d * sqrt(d) : 0.0;
}

/* JKR in closed form: Ferrari's solution of s^4 - 4/sqrt(6) s = d (contact/jkr.c) over Cardano's of m^3 + d m = 1/3. */
static inline double jkr_closed(double d)
{
    const double root = sqrt(1.0 / 36.0 + d * d * d / 27.0);
    const double m = cbrt(1.0 / 6.0 + root) + cbrt(1.0 / 6.0 - root), r = sqrt(2.0 * m);
    const double s = 0.5 * (r + sqrt(8.0 / 2.44948974278317809820 / r - 2.0 * m)), s3 = s * s * s;
    return s3 * s3 - 2.44948974278317809820 * s3;
}

#define ARRAY(name, expression)                                                                                        \
    static void name(void)                                                                                             \
    {                                                                                                                  \
        for (int i = 0; i < COUNT; i++) {                                                                              \
            const double d = now.in[i];                                                                                \
            now.out[i] = (expression);                                                                                 \
        }                                                                                                              \
    }
/* The next argument depends on the last result, by less than rounding leaves of it; in contact throughout, as a state
 * that is known beforehand would break the chain. */
#define CHAIN(name, expression)                                                                                        \
    static void name(void)                                                                                             \
    {                                                                                                                  \
        double d = fabs(now.in[0]), F = 0.0;                                                                           \
        for (int i = 0; i < COUNT; i++) {                                                                              \
            F = (expression);                                                                                          \
            d = fabs(now.in[i]) + 1e-18 * F;                                                                           \
        }                                                                                                              \
        sink = F;                                                                                                      \
    }

static double exact(double d)
{
    nt_law_value value = {.F = NAN};
    (void)nt_maugis_eval(&now.maugis, d, NT_BRANCH_STABLE, &value, NULL);
    return value.F;
}

ARRAY(hertz_array, hertz(d))
CHAIN(hertz_chain, hertz(d))
ARRAY(jkr_closed_array, jkr_closed(d))
CHAIN(jkr_closed_chain, jkr_closed(d))
ARRAY(exact_one_by_one, exact(d))
CHAIN(exact_chain, exact(d))
CHAIN(table_chain, nt_maugis_table_force(&now.table, d))
CHAIN(polished_chain, nt_maugis_table_polish(&now.table, d))

static void table_array(void)
{
    (void)nt_maugis_table_force_n(&now.table, NT_BRANCH_STABLE, now.in, now.out, COUNT);
}

static void polished_array(void)
{
    (void)nt_maugis_table_polish_n(&now.table, NT_BRANCH_STABLE, now.in, now.out, COUNT);
}

static void law_over(nt_model model, int all)
{
    static double U[COUNT], k[COUNT], a[COUNT];
    const nt_contact_law law = {model, now.maugis};
    const nt_strided arrays = {now.in, all ? U : NULL, now.out, all ? k : NULL, all ? a : NULL, COUNT, 1, 1};
    (void)nt_contact_law_eval_n(&law, NT_BRANCH_STABLE, &arrays);
}

static void hertz_law_array(void)
{
    law_over(NT_HERTZ, 0);
}

static void jkr_law_array(void)
{
    law_over(NT_JKR, 0);
}

static void exact_array(void)
{
    law_over(NT_MAUGIS, 0);
}

static void exact_values(void)
{
    law_over(NT_MAUGIS, 1);
}

static void values_of(nt_tier tier)
{
    static double U[COUNT], k[COUNT], a[COUNT];
    const nt_strided arrays = {now.in, U, now.out, k, a, COUNT, 1, 1};
    (void)nt_maugis_table_eval_n(&now.table, tier, NT_BRANCH_STABLE, &arrays);
}

static void table_values(void)
{
    values_of(NT_TIER_TABLE);
}

static void polished_values(void)
{
    values_of(NT_TIER_POLISHED);
}

static void bank_array(void)
{
    (void)nt_maugis_bank_load_n(&bank, lambdas, now.in, now.out, COUNT);
}

/* The next call's argument hangs on the last one's result by a rounding that does not change it. */
static void bank_slope_chain(void)
{
    nt_bank_value value = {{0}, 0.0};
    for (int i = 0; i < COUNT; i++) {
        const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.5 * lambdas[i]};
        (void)nt_maugis_bank_eval_radius(&bank, &contact, now.in[i] + 1e-300 * value.law.F, NT_BRANCH_STABLE, &value);
        now.out[i] = value.dU_dR;
    }
}

static void bank_pairs(void)
{
    static nt_contact contacts[COUNT];
    static double U[COUNT], k[COUNT], a[COUNT], slope[COUNT];
    if (contacts[0].radius == 0.0)
        for (int i = 0; i < COUNT; i++)
            contacts[i] = (nt_contact){1.0, 0.75, 1.0 / NT_PI, 0.5 * lambdas[i]};
    const nt_bank_pairs pairs = {contacts, now.in, U, now.out, k, a, slope, COUNT, 1, 1, 1};
    (void)nt_maugis_bank_pairs_n(&bank, NT_BRANCH_STABLE, &pairs);
}

static void each_exact(void)
{
    static nt_contact contacts[COUNT];
    static const nt_maugis_bank exact;
    for (int i = 0; i < COUNT && contacts[i].radius == 0.0; i++)
        contacts[i] = (nt_contact){1.0, 0.75, 1.0 / NT_PI, 0.5 * lambdas[i]};
    const nt_bank_pairs pairs = {contacts, now.in, NULL, now.out, NULL, NULL, NULL, COUNT, 1, 1, 1};
    (void)nt_maugis_bank_pairs_n(&exact, NT_BRANCH_STABLE, &pairs);
}

static void surface_chain(void)
{
    double z = 0.0;
    for (int i = 0; i < COUNT; i++) {
        z = nt_surface_eval(&surface, (i % 251) * 3.1e-10 + 1e-300 * z, (i % 97) * 7.3e-10).z;
        now.out[i] = z;
    }
}

static void radius_chain(void)
{
    double R = 0.0;
    for (int i = 0; i < COUNT; i++) {
        R = nt_radius_map_eval(&radii, (i % 251) * 3.1e-10 + 1e-300 * R, (i % 97) * 7.3e-10).radius;
        now.out[i] = R;
    }
}

static void load_array(void)
{
    for (int i = 0; i < COUNT; i++)
        (void)nt_maugis_indentation(&now.maugis, now.in[i] * sqrt(fabs(now.in[i])), NT_BRANCH_STABLE, &now.out[i],
                                    NULL);
}

/* Least time of one call [s]. */
static double least(void (*work)(void))
{
    double best = HUGE_VAL;
    for (int i = 0; i < RUNS; i++) {
        const double start = seconds();
        work();
        best = smaller(best, seconds() - start);
    }
    sink = now.out[COUNT / 2];
    return best;
}

static void set(double lambda, double lowest)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.0};
    if (nt_maugis_init_lambda(&now.maugis, &contact, lambda) != NT_OK ||
        nt_maugis_table_init(&now.table, &now.maugis, NULL, cells, CELLS) != NT_OK)
        exit(1);
    unsigned random = 1;
    for (int i = 0; i < COUNT; i++) {
        random = random * 1664525u + 1013904223u;
        now.in[i] = lowest + 10.0 * (double)(random >> 8) / 16777216.0;
    }
}

static nt_contact made = {1.0, 0.75, 1.0 / NT_PI, 0.0};

/* One after another, each at another lambda. */
static void folds(void)
{
    for (int i = 0; i < COUNT; i++) {
        nt_maugis maugis = {.lambda = 0.0};
        const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.5 * lambdas[i]};
        (void)nt_maugis_init(&maugis, &contact);
        now.out[i] = maugis.folds.grip_indentation + maugis.folds.pull_off_load;
    }
}

static void folds_and_table(void)
{
    made.cohesive_stress = 0.5 * now.maugis.lambda;
    (void)nt_maugis_init(&now.maugis, &made);
    (void)nt_maugis_table_init(&now.table, &now.maugis, NULL, cells, CELLS);
}

typedef struct {
    const char *name;
    void (*work)(void);
    void (*unit)(void); /* what its ratio is to */
} benchmark;

static void print(const char *name, double lambda, double ns, double ratio)
{
    static const char *separator = "";
    printf("%s\n    {\"name\": \"%s\", \"lambda\": %g, \"ns\": %.4g, \"hertz\": %.4g}", separator, name, lambda, ns,
           ratio);
    separator = ",";
}

static void run(double lambda)
{
    static const benchmark all[] = {
        {"hertz array", hertz_array, hertz_array},
        {"hertz law array", hertz_law_array, hertz_array},
        {"hertz latency", hertz_chain, hertz_chain},
        {"maugis table array", table_array, hertz_array},
        {"maugis table latency", table_chain, hertz_chain},
        {"maugis table array U F k a", table_values, hertz_array},
        {"maugis polished array", polished_array, hertz_array},
        {"maugis polished latency", polished_chain, hertz_chain},
        {"maugis polished array U F k a", polished_values, hertz_array},
        {"maugis exact array", exact_array, hertz_array},
        {"maugis exact array U F k a", exact_values, hertz_array},
        {"maugis exact one by one", exact_one_by_one, hertz_array},
        {"maugis exact, a contact each", each_exact, hertz_array},
        {"maugis exact latency", exact_chain, hertz_chain},
        {"maugis exact indentation array", load_array, hertz_array},
        {"maugis bank array", bank_array, hertz_array},
        {"maugis bank latency, with dU/dR", bank_slope_chain, hertz_chain},
        {"maugis bank pairs, checked, with dU/dR", bank_pairs, hertz_chain},
        {"surface latency", surface_chain, hertz_chain},
        {"radius map latency", radius_chain, hertz_chain},
        {"jkr law array", jkr_law_array, hertz_array},
        {"jkr closed form array", jkr_closed_array, hertz_array},
        {"jkr closed form latency", jkr_closed_chain, hertz_chain},
    };
    set(lambda, lambda >= 1e9 ? -0.9 : -1.0);
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        const double time = least(all[i].work), unit = least(all[i].unit);
        print(all[i].name, lambda, time / COUNT * 1e9, time / unit);
    }
    const double unit = least(hertz_array) / COUNT;
    double time = least(folds) / COUNT;
    print("maugis folds", lambda, time * 1e9, time / unit);
    time = least(folds_and_table);
    print("maugis folds and table", lambda, time * 1e9, time / unit);
}

int main(int count, char **arguments)
{
    static const double settings[] = {0.27, 1.0, 5.8, 1e9};
    const nt_maugis_bank_memory memory = {panels, bank_cells, PANELS, BANK_CELLS};
    const nt_maugis_bank_options options = nt_maugis_bank_defaults();
    if (nt_maugis_bank_init(&bank, &options, &memory) != NT_OK)
        return 1;
    for (int i = 0; i < COUNT; i++)
        lambdas[i] = 0.01 * pow(10.0, 4.0 * (i * 37 % COUNT) / COUNT);
    const nt_height_map map = {heights, PIXELS, PIXELS, 1e-9, 1e-9};
    for (int i = 0; i < PIXELS * PIXELS; i++)
        heights[i] = 1e-9 * sin(0.1 * (i % PIXELS)) * cos(0.07 * (double)(i / PIXELS));
    if (nt_surface_init(&surface, &map, heights) != NT_OK || //
        nt_radius_map_init(&radii, &surface, 20e-9, NULL, ratios) != NT_OK)
        return 1;
    printf("{\n  \"instructions\": \"%s\",\n  \"benchmarks\": [", count > 1 ? arguments[1] : "dispatched");
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++)
        run(settings[i]);
    printf("\n  ]\n}\n");
    return 0;
}
