/* SPDX-License-Identifier: BSD-3-Clause
 * Whichever allocation of a fit fails, the process lives, nothing leaks, and the answer is NT_E_NO_MEMORY or that of a
 * machine with memory. Two ways to fail: one allocation, and a heap that stays full. A heap that gives nothing back
 * when something is freed is not among them: Ceres allocates in destructors (reserve.hpp). */
#include <string.h>

#include "failing_heap.h"
#include "fit_curve.h"
#include "internal/fit.h"

enum { EXHAUSTIVE = 600, TRIED = 199 }; /* each of so many allocations is tried; of more, so many; or "every" one */
static int every;

static nt_fit_options options;
static curve measured;

enum { CURVES = 3 };
static nt_fit_recipe recipe;
static double heights[2][POINTS], forces[2][POINTS];
static int threads;

typedef struct call {
    const char *name;
    nt_status (*run)(void *out);
    size_t size, compared; /* of what it writes; of its beginning without padding [byte] */
} entry;

static nt_status run_fit(void *out)
{
    const nt_fit_data data = data_of(&measured);
    return nt_fit_run(&options, &data, out, NULL);
}

static nt_status run_model(void *out)
{
    const nt_fit_data data = data_of(&measured);
    return nt_fit_model_n(&options, truth, &data, out);
}

static nt_status run_tear(void *out)
{
    return nt_fit_tear_position(&options, truth, out);
}

/* Each curve that has met no failure is as it is alone; out is those outcomes' values, in which failures are undone. */
static nt_status run_batch(void *out)
{
    static nt_fit_outcome outcome[CURVES];
    nt_curve recorded[CURVES];
    for (int i = 0; i < CURVES; i++)
        recorded[i] = (nt_curve){{heights[0], forces[0], POINTS}, {heights[1], forces[1], POINTS}, 1.0, 0.0, 0.0};
    const nt_fit_curves curves = {recorded, CURVES, threads};
    memset(outcome, 0xa5, sizeof outcome);
    const nt_status status = nt_fit_batch(&recipe, &curves, outcome);
    double *value = out;
    nt_status worst = status;
    for (int i = 0; i < CURVES && status == NT_OK; i++)
        if (outcome[i].status != NT_OK)
            worst = outcome[i].status;
    for (int i = 0; i < CURVES && worst == NT_OK; i++)
        value[i] = outcome[i].fit.value[NT_FIT_EFFECTIVE_MODULUS];
    return worst;
}

static const entry fit = {"nt_fit_run", run_fit, sizeof(nt_fit_result), offsetof(nt_fit_result, message)};
static const entry model_n = {"nt_fit_model_n", run_model, POINTS * sizeof(nt_fit_point), offsetof(nt_fit_point, held)};
static const entry tear = {"nt_fit_tear_position", run_tear, sizeof(double), sizeof(double)};
static const entry batch = {"nt_fit_batch", run_batch, CURVES * sizeof(double), CURVES * sizeof(double)};

static unsigned char expected[POINTS * sizeof(nt_fit_point)];

static void fail_at(const entry *call, long n, heap_failure failure)
{
    static unsigned char out[sizeof expected], untouched[sizeof expected];
    memset(out, 0xa5, call->size);
    memset(untouched, 0xa5, call->size);
    const long before = heap_blocks();
    heap_fail(n, failure);
    const nt_status status = call->run(out);
    heap_recover();
    const long leaked = call == &batch && threads > 1 ? 0 : heap_blocks() - before; /* glibc keeps stacks of threads */
    if (leaked != 0 || (status != NT_OK && status != NT_E_NO_MEMORY) ||
        (status == NT_OK ? memcmp(out, expected, call->compared) : memcmp(out, untouched, call->size)) != 0)
        fail_msg("%s, allocation %ld, way %d: %s, %ld blocks leaked", call->name, n, (int)failure,
                 nt_status_message(status), leaked);
}

static void fail_everywhere(const entry *call)
{
#if !HEAP_CAN_FAIL
    skip();
#endif
    memset(expected, 0xa5, call->size);
    assert_int_equal(call->run(expected), NT_OK); /* now there is, too, what is made once in a process */
    heap_fail(0, HEAP_ONCE);
    assert_int_equal(call->run(expected), NT_OK);
    const long total = heap_recover(), slower = heap_is_sanitized() ? 4 : 1;
    const long stride = every || total <= EXHAUSTIVE / slower ? 1 : total * slower / TRIED;
    assert_true(total > 0);
    for (int failure = HEAP_ONCE; failure <= HEAP_FULL; failure++)
        for (long n = 1; n <= total; n += stride)
            fail_at(call, n, (heap_failure)failure);
}

static void fits_of_every_model(void **state)
{
    (void)state;
    for (int model = 0; model < NT_FIT_CUSTOM; model++)
        for (int loss = NT_LOSS_SQUARES; loss <= NT_LOSS_HUBER; loss++) {
            options = options_of((nt_fit_model)model, 1.0);
            synthesise(&options, 10e-12, 1, &measured);
            options.loss = (nt_fit_loss)loss;
            options.loss_scale = 30e-12;
            fail_everywhere(&fit);
        }
}

static void a_fit_in_closed_form(void **state)
{
    (void)state;
    options = options_of(NT_FIT_HERTZ, 0.0);
    synthesise(&options, 10e-12, 1, &measured);
    options.parameter[NT_FIT_CONTACT_POINT].initial = truth[NT_FIT_CONTACT_POINT];
    options.parameter[NT_FIT_CONTACT_POINT].fixed = 1;
    fail_everywhere(&fit);
}

static void a_fit_from_several_starts(void **state)
{
    (void)state;
    options = options_of(NT_FIT_MAUGIS, 1.0);
    synthesise(&options, 10e-12, 1, &measured);
    options.parameter[NT_FIT_COHESIVE_RANGE].initial = NAN;
    options.parameter[NT_FIT_COHESIVE_RANGE].fixed = 0;
    fail_everywhere(&fit);
}

static nt_status square(const nt_fit_options *own, const double *value, long count, const double *indentation,
                        double *force)
{
    (void)own;
    for (long i = 0; i < count; i++)
        force[i] = indentation[i] > 0.0 ? value[0] * indentation[i] * indentation[i] : 0.0;
    return NT_OK;
}

static void a_law_of_ones_own(void **state)
{
    (void)state;
    const nt_fit_law law = {"square", 1, {{"stiffness", "N/m^2", 1e5, 1e3, 1e9}}, square, NULL};
    options = nt_fit_defaults_for(&law);
    options.spring_constant = 1.0;
    synthesise(&options, 10e-12, 1, &measured);
    fail_everywhere(&fit);
    fail_everywhere(&model_n);
}

/* Every tenth time this law has a fit of its own, whose end does not matter to it. */
static nt_status square_that_fits(const nt_fit_options *own, const double *value, long count, const double *indentation,
                                  double *force)
{
    static curve other;
    int *calls = own->law->context;
    if (++*calls % 10 == 0) {
        nt_fit_options inner = options_of(NT_FIT_CONE, 0.0);
        nt_fit_data data = data_of(&other);
        nt_fit_result result;
        inner.max_iterations = 2;
        data.count = 20;
        for (int i = 0; i < POINTS; i++) {
            other.position[i] = 1e-9 * (i - 5);
            other.force[i] = i > 5 ? 1e-12 * (i - 5) * (i - 5) : 0.0;
        }
        (void)nt_fit_run(&inner, &data, &result, NULL);
    }
    return square(own, value, count, indentation, force);
}

static void a_law_that_fits(void **state)
{
    (void)state;
    int calls = 0;
    const nt_fit_law law = {"square", 1, {{"stiffness", "N/m^2", 1e5, 1e3, 1e9}}, square_that_fits, &calls};
    options = nt_fit_defaults_for(&law);
    options.spring_constant = 1.0;
    synthesise(&options, 10e-12, 1, &measured);
    fail_everywhere(&fit);
}

static long handled;

static void find_memory(void)
{
    handled++;
    heap_recover();
}

static heap_new_handler *kept;

static nt_status square_that_keeps(const nt_fit_options *own, const double *value, long count,
                                   const double *indentation, double *force)
{
    heap_new_handler *const found = heap_set_new_handler(NULL);
    kept = found ? found : kept;
    return square(own, value, count, indentation, force);
}

/* It is called, is there after each fit, and does no harm where a program sets that of a fit again. */
static void the_new_handler_of_a_program(void **state)
{
    (void)state;
    options = options_of(NT_FIT_HERTZ, 1.0);
    synthesise(&options, 10e-12, 1, &measured);
    heap_set_new_handler(find_memory);
    fail_everywhere(&fit);
    assert_true(!HEAP_CAN_FAIL || handled > 0);
    assert_true(heap_set_new_handler(NULL) == find_memory);
    const nt_fit_law law = {"square", 1, {{"stiffness", "N/m^2", 1e5, 1e3, 1e9}}, square_that_keeps, NULL};
    options = nt_fit_defaults_for(&law);
    options.spring_constant = 1.0;
    synthesise(&options, 10e-12, 1, &measured);
    nt_fit_result result;
    assert_int_equal(run_fit(&result), NT_OK);
    assert_non_null(kept);
    heap_set_new_handler(kept);
    options = options_of(NT_FIT_HERTZ, 1.0);
    synthesise(&options, 10e-12, 1, &measured);
    fail_everywhere(&fit);
    heap_set_new_handler(NULL);
}

static void models_and_tears(void **state)
{
    (void)state;
    for (int model = NT_FIT_DMT; model <= NT_FIT_MAUGIS; model++) {
        options = options_of((nt_fit_model)model, 1.0);
        synthesise(&options, 0.0, 1, &measured);
        fail_everywhere(&model_n);
        fail_everywhere(&tear);
    }
}

static void batches_in_one_and_several_threads(void **state)
{
    (void)state;
    nt_random random = nt_random_seed(3);
    recipe = nt_fit_recipe_defaults(NT_FIT_HERTZ);
    options = options_of(NT_FIT_HERTZ, 1.0);
    for (int branch = 0; branch < 2; branch++) {
        for (int i = 0; i < POINTS; i++)
            measured.position[i] = 80e-9 - 300e-9 * (branch ? i : POINTS - 1 - i) / (POINTS - 1);
        fill(&options, truth, &measured);
        for (int i = 0; i < POINTS; i++) {
            heights[branch][i] = -measured.position[i];
            forces[branch][i] = measured.force[i] + 20e-12 * nt_random_normal(&random);
        }
    }
    for (threads = 1; threads <= (heap_is_sanitized() ? 1 : CURVES); threads += 2)
        fail_everywhere(&batch);
}

int main(int count, char **arguments)
{
    every = count == 2 && strcmp(arguments[1], "every") == 0;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fits_of_every_model),       cmocka_unit_test(a_fit_in_closed_form),
        cmocka_unit_test(a_fit_from_several_starts), cmocka_unit_test(a_law_of_ones_own),
        cmocka_unit_test(a_law_that_fits),           cmocka_unit_test(the_new_handler_of_a_program),
        cmocka_unit_test(models_and_tears),          cmocka_unit_test(batches_in_one_and_several_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
