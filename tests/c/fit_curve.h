/* SPDX-License-Identifier: BSD-3-Clause
 * Force curves with a known answer, for the tests of fit/. */
#ifndef FIT_CURVE_H
#define FIT_CURVE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "internal/fit.h"
#include "nanotouch/advanced/random.h"
#include "nanotouch/fit.h"

enum { POINTS = 250 };

static const double truth[NT_FIT_PARAMETERS] = {5e6, 0.05, 2e-9, 300e-9, 3e-9, 0.0, 0.0, 1.0}; /* lambda = 7.1 */

typedef struct {
    double position[POINTS], force[POINTS];
} curve;

static inline nt_fit_data data_of(const curve *made)
{
    return (nt_fit_data){made->position, made->force, POINTS, 1, 1};
}

static inline nt_fit_options options_of(nt_fit_model model, double spring_constant)
{
    nt_fit_options options = nt_fit_defaults(model);
    options.spring_constant = spring_constant;
    options.parameter[NT_FIT_COHESIVE_RANGE].initial = truth[NT_FIT_COHESIVE_RANGE];
    options.parameter[NT_FIT_FOURTH].initial = truth[NT_FIT_FOURTH];
    return options;
}

/* The model's forces at the positions of a curve. */
static inline void fill(const nt_fit_options *options, const double *value, curve *made)
{
    const nt_fit_data data = data_of(made);
    nt_fit_point points[POINTS];
    assert_int_equal(nt_fit_model_n(options, value, &data, points), NT_OK);
    for (int i = 0; i < POINTS; i++)
        made->force[i] = points[i].force;
}

/* A retraction from 80 nm to the smallest force, with white noise [N]. */
static inline void synthesise(const nt_fit_options *options, double noise, uint64_t seed, curve *made)
{
    nt_random random = nt_random_seed(seed);
    double last = options->model == NT_FIT_HERTZ || options->model >= NT_FIT_CONE ? -10e-9 : -5e-9;
    if (nt_fit_tear_position(options, truth, &last) == NT_OK)
        last += 1e-9; /* before the steep end */
    for (int i = 0; i < POINTS; i++)
        made->position[i] = 80e-9 + (last - 80e-9) * i / (POINTS - 1);
    fill(options, truth, made);
    for (int i = 0; i < POINTS; i++)
        made->force[i] += noise * nt_random_normal(&random);
}

static inline const char *name_of(const nt_fit_options *options, int parameter)
{
    return nt_fit_quantity_of(options, (nt_fit_parameter)parameter).name;
}

static inline int is_free(const nt_fit_options *options, int parameter)
{
    return name_of(options, parameter) != NULL && !options->parameter[parameter].fixed;
}

static inline nt_fit_result run(const nt_fit_options *options, const curve *made)
{
    const nt_fit_data data = data_of(made);
    nt_fit_result result;
    assert_int_equal(nt_fit_run(options, &data, &result, NULL), NT_OK);
    return result;
}

static inline void assert_relative(double value, double expected, double tolerance, const char *what)
{
    if (!(fabs(value - expected) <= tolerance * fabs(expected)))
        fail_msg("%s: %.12g, expected %.12g within %g", what, value, expected, tolerance);
}

#endif
