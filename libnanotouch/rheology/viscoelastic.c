/* SPDX-License-Identifier: BSD-3-Clause
 * A history of the base, point by point. The first steps of a contact are made shorter, in equal ratios: g(delta) is no
 * polynomial there. */
#include "internal/field.h"
#include "internal/rheology.h"
#include "nanotouch/rheology.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"
#include "rheology/run.h"
#include "rheology/springs.h"

#define RATIO 1.6               /* of the base over first touch, from step to step, at most */
enum { FIRST = 14, MORE = 64 }; /* steps between first touch and the next point; records beyond the points' own */
#define KERNEL_ERROR 2e-5
#define FRACTION 0.25 /* of the shortest step: E(t) is right from there on */

nt_viscoelastic nt_viscoelastic_defaults(void)
{
    return (nt_viscoelastic){.shape = {.kind = NT_SHAPE_PARABOLOID, .radius = 5e-6, .half_angle = 0.35},
                             .rheology = nt_rheology_defaults(),
                             .poisson_ratio = 0.5};
}

static const nt_field fields[] = {
    NT_FIELD(nt_viscoelastic, poisson_ratio, "", -0.99, 0.5, "Poisson ratio of the sample"),
    NT_FIELD(nt_viscoelastic, thickness, "m", 0.0, 1.0, "of a layer bonded to rigid ground; 0: a half-space"),
    NT_FIELD(nt_viscoelastic, spring_constant, "N/m", 0.0, 1e6, "k_c of the lever; 0: rigid"),
};

static nt_status refuse(nt_problem *problem, const char *field, double value, double valid)
{
    if (problem != NULL)
        *problem = nt_problem_of(field, "", value, valid, valid);
    return NT_E_RANGE;
}

nt_status nt_viscoelastic_check(const nt_viscoelastic *contact, nt_problem *problem)
{
    nt_status status = nt_field_check(fields, (int)(sizeof fields / sizeof fields[0]), contact, problem);
    if (status == NT_OK)
        status = nt_shape_check(&contact->shape, problem);
    if (status == NT_OK)
        status = nt_rheology_check(&contact->rheology, problem);
    if (status != NT_OK)
        return status;
    const nt_shape_kind kind = contact->shape.kind;
    if (kind > NT_SHAPE_PUNCH)
        return refuse(problem, "shape.kind", (double)kind, NT_SHAPE_PUNCH);
    if (contact->thickness > 0.0 && kind != NT_SHAPE_PARABOLOID && kind != NT_SHAPE_CONE)
        return refuse(problem, "thickness", contact->thickness, 0.0);
    if (contact->thickness > 0.0 && contact->poisson_ratio < 0.5)
        return refuse(problem, "poisson_ratio", contact->poisson_ratio, 0.5);
    return NT_OK;
}

static int parameters(const nt_viscoelastic *contact, int with_derivatives)
{
    return with_derivatives ? 1 + nt_rheology_parameter_count(&contact->rheology) : 0;
}

long nt_viscoelastic_workspace(const nt_viscoelastic *contact, long count, int with_derivatives)
{
    const int count_by = parameters(contact, with_derivatives);
    const long records = (count + MORE) * (NT_RUN_BY + count_by), springs = nt_springs_workspace(count_by);
    return records > springs ? records : springs;
}

static nt_status wrong(nt_problem *problem, nt_status status, nt_problem found)
{
    if (problem != NULL)
        *problem = found;
    return status;
}

nt_status nt_viscoelastic_check_path(const nt_viscoelastic_path *path, nt_time_range *range, nt_problem *problem)
{
    const double *t = path->times, *z = path->positions, inf = (double)INFINITY;
    if (path->count < 2)
        return wrong(problem, NT_E_RANGE, nt_problem_of("count", "", (double)path->count, 2.0, inf));
    if (!isfinite(path->contact))
        return wrong(problem, NT_E_NOT_FINITE, nt_problem_of("contact", "m", path->contact, -inf, inf));
    range->shortest = inf;
    for (long i = 0; i < path->count; i++) {
        if (!isfinite(t[i]))
            return wrong(problem, NT_E_NOT_FINITE, nt_problem_of("times", "s", t[i], -inf, inf));
        if (!isfinite(z[i]))
            return wrong(problem, NT_E_NOT_FINITE, nt_problem_of("positions", "m", z[i], -inf, inf));
        if (i > 0 && !(t[i] > t[i - 1]))
            return wrong(problem, NT_E_RANGE, nt_problem_of("times", "s", t[i], t[i - 1], inf));
        if (i > 0)
            range->shortest = fmin(range->shortest, t[i] - t[i - 1]);
    }
    if (!(z[0] <= path->contact))
        return wrong(problem, NT_E_RANGE, nt_problem_of("positions[0]", "m", z[0], -inf, path->contact));
    range->longest = t[path->count - 1] - t[0];
    range->shortest *= FRACTION;
    return NT_OK;
}

/* The contact begins: record 0 is its first touch. */
static void touch(nt_run *run, double time)
{
    run->phase = NT_RUN_GROWING;
    run->time = time;
    run->base = run->depth = 0.0;
    run->edge = 0;
    memset(run->Z, 0, sizeof run->Z);
    memset(run->Z_by, 0, sizeof run->Z_by);
    memset(run->depth_by, 0, sizeof run->depth_by);
    double *record = nt_run_record_at(run, 0);
    memset(record, 0, (NT_RUN_BY + (size_t)run->arms.parameters) * sizeof *record);
    record[NT_RUN_TIME] = time;
    run->value = nt_profile_at(&run->profile, 0.0);
    record[NT_RUN_SLOPE] = run->value.slope;
    run->follows = 1.0;
    if (run->arms.parameters == 0)
        return;
    run->depth_by[0] = record[NT_RUN_BY] = -1.0; /* by the position of first touch; a punch is there at once */
    for (int k = 0; k < run->arms.width; k++)
        run->Z_by[0][k] = -run->value.slope;
}

/* Base of the part-way point i of `count`: from 0 in ratios that begin with a small one. */
static double way_point(double from, double to, int i, int count)
{
    return from > 0.0 ? from * pow(to / from, (double)i / count) : to * pow(RATIO, (double)(i - count));
}

static nt_status step_to(nt_run *run, double time, double base)
{
    return run->phase == NT_RUN_GROWING ? nt_run_grow(run, time, base) : nt_run_shrink(run, time, base);
}

/* Straight from the last point to the next one, with the contact growing. */
static nt_status grow(nt_run *run, double time, double base)
{
    const double t0 = run->time, from = run->base;
    int count = 1;
    if (run->profile.kind != NT_SHAPE_PUNCH && base > from && from < base / RATIO)
        count = from > 0.0 ? (int)ceil(log(base / from) / log(RATIO)) : FIRST;
    if (count > MORE / 2)
        count = MORE / 2;
    nt_status status = NT_OK;
    for (int i = 1; i < count && status == NT_OK; i++) {
        const double part = way_point(from, base, i, count);
        status = step_to(run, t0 + (time - t0) * (part - from) / (base - from), part);
    }
    return status == NT_OK ? step_to(run, time, base) : status;
}

/* Out of contact: the dent recovers without force. */
static nt_status stay_out(nt_run *run, double time, double base)
{
    double unused[NT_ARM_PARAMETERS];
    nt_step_to(&run->step, &run->arms, time - run->time);
    const double pull = nt_run_relax(run, run->S, run->S_by, unused) / run->step.sum[0];
    for (int k = 0; k < run->arms.width; k++)
        run->S[k] -= pull * run->step.psi[0][k];
    run->dent -= pull;
    run->time = time;
    run->base = run->depth = base;
    return base > run->dent ? NT_E_NO_SOLUTION : NT_OK;
}

static nt_status advance(nt_run *run, double time, double base)
{
    switch (run->phase) {
    case NT_RUN_OUT:
        if (base > 0.0) {
            touch(run, run->time + (time - run->time) * (0.0 - run->base) / (base - run->base));
            return grow(run, time, base);
        }
        run->time = time;
        run->base = run->depth = base;
        return NT_OK;
    case NT_RUN_GROWING:
        return grow(run, time, base);
    case NT_RUN_SHRINKING:
        return nt_run_shrink(run, time, base);
    default:
        return stay_out(run, time, base);
    }
}

static void put(const nt_run *run, const nt_viscoelastic_result *result, long i)
{
    if (result->forces != NULL)
        result->forces[i] = run->force;
    if (result->indentations != NULL)
        result->indentations[i] = run->depth;
    for (int p = 0; p < run->arms.parameters; p++)
        result->derivatives[i * run->arms.parameters + p] = run->force_by[p];
}

/* Out of contact, at the first point. */
static void begin(nt_run *run, const nt_viscoelastic_path *path)
{
    run->phase = NT_RUN_OUT;
    run->time = path->times[0];
    run->base = run->depth = path->positions[0] - path->contact;
    run->force = 0.0;
    memset(run->force_by, 0, sizeof run->force_by);
    run->records = path->workspace;
    run->capacity = path->count + MORE;
}

/* By Ting's law; NT_E_NO_SOLUTION where a contact that has shrunk grows again. */
static nt_status follow(nt_run *run, const nt_viscoelastic_path *path, const nt_viscoelastic_result *result)
{
    nt_status status = NT_OK;
    for (long i = 1; i < path->count && status == NT_OK; i++) {
        status = advance(run, path->times[i], path->positions[i] - path->contact);
        if (run->depth > run->profile.deepest)
            return NT_E_RANGE;
        put(run, result, i);
    }
    return status;
}

nt_status nt_viscoelastic_run(const nt_viscoelastic *contact, const nt_viscoelastic_path *path,
                              nt_viscoelastic_result *result, nt_problem *problem)
{
    nt_time_range range;
    nt_spectrum spectrum;
    nt_run run;
    nt_status status = nt_viscoelastic_check(contact, problem);
    if (status == NT_OK)
        status = nt_viscoelastic_check_path(path, &range, problem);
    if (status != NT_OK)
        return status;
    (void)nt_rheology_discretize(&contact->rheology, &range, KERNEL_ERROR, &spectrum); /* its error is reported */
    nt_arms_make(&run.arms, &contact->rheology, &spectrum, result->derivatives != NULL);
    run.profile = nt_profile_make(&contact->shape, contact->thickness);
    run.step.h = run.past.h = 0.0;
    run.factor = 1.0 / (1.0 - contact->poisson_ratio * contact->poisson_ratio);
    run.compliance = contact->spring_constant > 0.0 ? 1.0 / contact->spring_constant : 0.0;
    result->arms = spectrum.count;
    result->kernel_error = spectrum.error;
    begin(&run, path);
    put(&run, result, 0);
    status = follow(&run, path, result);
    result->by_springs = status == NT_E_NO_SOLUTION;
    if (result->by_springs) {
        begin(&run, path);
        status = nt_springs_run(&run, path, put, result);
    }
    if (status == NT_E_RANGE)
        return wrong(problem, status, nt_problem_of("indentation", "m", run.depth, 0.0, run.profile.deepest));
    return status;
}
