/* SPDX-License-Identifier: BSD-3-Clause
 * From recorded curves to their answers, reading, baseline, fit and sigma: `bench_curves jkr 64`. Processor time of one
 * thread, or the instructions, which do not depend on the load: `valgrind --tool=callgrind bench_curves jkr 16`. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "internal/fit.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/fit.h"

enum { POINTS = 1000, MOST = 4096 }; /* of one branch; curves */

static const double radius = 20e-9, modulus = 1e9, work_of_adhesion = 0.015,
                    spring_constant = 1.0;                                         /* m, Pa, J/m^2, N/m */
static const double depth = 20e-9, clearance = 80e-9, noise = 30e-12, tilt = 1e-4; /* m, m, N, N/m */

/* Positions of the base, into the sample and out again; what the law says there, apart beyond the tear, and noise. */
static nt_curve synthesise(const nt_fit_options *options, uint64_t seed)
{
    const double value[NT_FIT_PARAMETERS] = {modulus, work_of_adhesion, 0.2e-9, 0.0, 0.0, 0.0, 0.0, 1.0};
    double *z[2], *force[2], position[POINTS];
    static nt_fit_point points[POINTS];
    nt_random random = nt_random_seed(seed);
    for (int i = 0; i < POINTS; i++)
        position[i] = depth - (depth + clearance) * i / (POINTS - 1);
    const nt_fit_data data = {position, NULL, POINTS, 1, 1};
    double tear = 0.0;
    if (nt_fit_model_n(options, value, &data, points) != NT_OK)
        exit(EXIT_FAILURE);
    const int adheres = nt_fit_tear_position(options, value, &tear) == NT_OK;
    for (int branch = 0; branch < 2; branch++) {
        z[branch] = malloc(POINTS * sizeof(double));
        force[branch] = malloc(POINTS * sizeof(double));
        for (int i = 0; i < POINTS; i++) {
            const int at = branch ? i : POINTS - 1 - i;
            const int apart = adheres && position[at] < (branch ? tear : 0.0);
            z[branch][i] = -position[at];
            force[branch][i] =
                (apart ? 0.0 : points[at].force) - tilt * position[at] + noise * nt_random_normal(&random);
        }
    }
    const nt_curve curve = {{z[0], force[0], POINTS}, {z[1], force[1], POINTS}, spring_constant, 0.0, 0.0};
    return curve;
}

static int model_of(const char *name)
{
    static const char *const names[] = {"hertz", "jkr", "maugis"};
    static const nt_fit_model models[] = {NT_FIT_HERTZ, NT_FIT_JKR, NT_FIT_MAUGIS};
    for (int i = 0; i < 3; i++)
        if (!strcmp(name, names[i]))
            return models[i];
    return -1;
}

int main(int count, char **argument)
{
    const int model = count == 3 ? model_of(argument[1]) : -1;
    const long curves = count == 3 ? strtol(argument[2], NULL, 10) : 0;
    if (model < 0 || curves < 1 || curves > MOST) {
        fprintf(stderr, "usage: bench_curves hertz|jkr|maugis CURVES (1 to %d)\n", MOST);
        return EXIT_FAILURE;
    }
    static nt_curve curve[MOST];
    static nt_fit_outcome outcome[MOST];
    nt_fit_recipe recipe = nt_fit_recipe_defaults((nt_fit_model)model);
    recipe.options.radius = radius;
    recipe.options.parameter[NT_FIT_COHESIVE_RANGE].initial = 0.2e-9;
    nt_fit_options truth = nt_fit_defaults((nt_fit_model)model);
    truth.radius = radius;
    truth.spring_constant = spring_constant;
    for (long i = 0; i < curves; i++)
        curve[i] = synthesise(&truth, (uint64_t)i + 1);
    const nt_fit_curves all = {curve, curves, 1};
    const clock_t start = clock();
    const nt_status status = nt_fit_batch(&recipe, &all, outcome);
    const double taken = (double)(clock() - start) / CLOCKS_PER_SEC;
    double sum[2] = {0.0, 0.0};
    long good = 0;
    for (long i = 0; i < curves; i++)
        if (outcome[i].status == NT_OK) {
            sum[0] += outcome[i].fit.value[NT_FIT_EFFECTIVE_MODULUS];
            sum[1] += outcome[i].fit.sigma[NT_FIT_EFFECTIVE_MODULUS];
            good++;
        }
    printf("%s: %.3f ms a curve; %ld of %ld fitted; mean E* = %.15g Pa, mean sigma = %.15g Pa\n", argument[1],
           1e3 * taken / (double)curves, good, curves, sum[0] / (double)good, sum[1] / (double)good);
    return status == NT_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
