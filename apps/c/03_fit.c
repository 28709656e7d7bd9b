/* SPDX-License-Identifier: BSD-3-Clause
 * Example 3: a JKR retraction with noise, as a cantilever of 0.5 N/m would measure it, and what a fit makes of it.
 * Build: cc 03_fit.c $(pkg-config --cflags --libs nanotouch-fit) */
#include <stdio.h>

#include "nanotouch/advanced/random.h"
#include "nanotouch/fit.h"

enum { POINTS = 500 };

static int complain(nt_status status, const nt_problem *problem)
{
    char text[200];
    if (problem->field != NULL)
        fprintf(stderr, "%s\n", nt_problem_print(problem, text, sizeof text));
    else
        fprintf(stderr, "%s\n", nt_status_message(status));
    return 1;
}

static void print_result(const nt_fit_options *options, const nt_fit_result *result, const double *truth)
{
    printf("%-18s %14s %12s %14s\n", "", "fitted", "sigma", "true");
    for (int i = 0; i < NT_FIT_PARAMETERS; i++) {
        const nt_fit_quantity quantity = nt_fit_quantity_of(options, (nt_fit_parameter)i);
        if (result->sigma[i] > 0.0)
            printf("%-18s %14.6g %12.2g %14.6g %s\n", quantity.name, result->value[i], result->sigma[i], truth[i],
                   quantity.unit);
    }
    printf("pull-off %.3f nN, residual %.1f pN; %s\n", result->pull_off_force * 1e9, result->residual_rms * 1e12,
           result->message);
}

int main(void)
{
    /* E*, w, h0 (not in JKR), -, delta0, F0, G, s */
    const double truth[NT_FIT_PARAMETERS] = {5e6, 0.05, 0.2e-9, 0.0, 3e-9, 0.0, 0.0, 1.0};
    const double noise = 50e-12; /* [N] */
    double position[POINTS], force[POINTS];
    nt_random random = nt_random_seed(1);
    nt_problem problem = {0};
    nt_fit_result result;

    nt_fit_options options = nt_fit_defaults(NT_FIT_JKR);
    options.spring_constant = 0.5;
    for (int i = 0; i < POINTS; i++)
        position[i] = 80e-9 - 81e-9 * i / (POINTS - 1); /* out of contact, to just before the pull-off */

    const nt_fit_data data = {
        .position = position, .force = force, .count = POINTS, .position_stride = 1, .force_stride = 1};
    nt_fit_point points[POINTS];
    nt_status status = nt_fit_model_n(&options, truth, &data, points);
    for (int i = 0; i < POINTS && status == NT_OK; i++)
        force[i] = points[i].force + noise * nt_random_normal(&random);

    if (status == NT_OK)
        status = nt_fit_run(&options, &data, &result, &problem);
    if (status != NT_OK)
        return complain(status, &problem);
    print_result(&options, &result, truth);
    return 0;
}
