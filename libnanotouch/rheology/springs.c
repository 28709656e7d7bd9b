/* SPDX-License-Identifier: BSD-3-Clause
 * A history by springs, for a contact that shrinks and grows again, where Ting's integral has no single end: each
 * spring keeps its own s_k, pressed or not, as in loop.c. */
#include "rheology/springs.h"

#include <math.h>
#include <string.h>

#include "core/variants.h"

enum { SPRINGS = 128, HALVINGS = 100, ITERATIONS = 200, ROWS = 4 };
#define CONVERGED 1e-12
#define FLOOR 1e-25 /* added and taken away: no denormal numbers */

typedef double row[SPRINGS];

/* Within the caller's workspace. `by` are derivatives: of s_k, then of what is held and of the way. */
typedef struct springs {
    int count, width, parameters;
    double deepest; /* max of the base's positions over first touch [m] */
    row *place;     /* depth, weight, held, way */
    row *s;         /* one row an arm; that of arm 0, of rate 0, is the spring's length u */
    row *by;        /* width + 2 rows for each parameter */
} springs;

enum { DEPTH, WEIGHT, HELD, WAY };

long nt_springs_workspace(int parameters)
{
    return (long)SPRINGS * (ROWS + NT_ARMS + (long)parameters * (NT_ARMS + 2));
}

/* Where the slope has come to a value. */
static double depth_at(const nt_profile *profile, double deepest, double slope)
{
    double low = 0.0, high = deepest;
    for (int j = 0; j < HALVINGS; j++) {
        const double middle = 0.5 * (low + high);
        *(nt_profile_at(profile, middle).slope < slope ? &low : &high) = middle;
    }
    return 0.5 * (low + high);
}

void nt_springs_place(const nt_profile *profile, double deepest, double grading, int count, double *depth,
                      double *weight)
{
    const double whole = nt_profile_at(profile, deepest).slope;
    double from = 0.0;
    for (int i = 0; i < count; i++) {
        const double to = i + 1 < count ? whole * pow((i + 1.0) / count, grading) : whole;
        depth[i] = profile->kind == NT_SHAPE_PUNCH ? 0.0 : depth_at(profile, deepest, 0.5 * (from + to));
        weight[i] = to - from;
        from = to;
    }
}

static springs laid_out(const nt_run *run, double deepest, double *workspace)
{
    springs of = {.count = run->profile.kind == NT_SHAPE_PUNCH ? 1 : SPRINGS,
                  .width = run->arms.width,
                  .parameters = run->arms.parameters,
                  .deepest = deepest,
                  .place = (row *)workspace};
    of.s = of.place + ROWS;
    of.by = of.s + of.width;
    memset(workspace, 0, sizeof(double) * (size_t)nt_springs_workspace(of.parameters));
    nt_springs_place(&run->profile, fmin(deepest, run->profile.deepest), 1.0, of.count, of.place[DEPTH],
                     of.place[WEIGHT]);
    return of;
}

static row *by_of(const springs *of, int p)
{
    return of->by + (size_t)p * (size_t)(of->width + 2);
}

/* All springs relax; what they hold, if they stayed. */
NT_VARIANTS static void relax(const nt_run *run, const springs *of, double *restrict held)
{
    memset(held, 0, sizeof(row));
    for (int k = 0; k < of->width; k++) {
        const double decay = run->step.decay[k], E = run->arms.modulus[k];
        double *restrict s = of->s[k];
        for (int i = 0; i < of->count; i++) {
            s[i] = (s[i] * decay + FLOOR) - FLOOR;
            held[i] += E * s[i];
        }
    }
}

/* Derivatives of that; before it, as the arm's s_k of the last point are needed. */
NT_VARIANTS static void relax_by(const nt_run *run, const springs *of, int p)
{
    row *by = by_of(of, p);
    double *restrict held = by[of->width];
    const int arm = run->arms.arm[p];
    memset(held, 0, sizeof(row));
    for (int k = 0; k < of->width; k++) {
        const double decay = run->step.decay[k], E = run->arms.modulus[k], E_by = run->arms.by[p][k] * decay;
        const double later = k == arm ? run->step.h * run->arms.rate_by[p] : 0.0;
        double *restrict s_by = by[k];
        const double *restrict s = of->s[k];
        for (int i = 0; i < of->count; i++) {
            s_by[i] = (s_by[i] - later * s[i]) * decay;
            held[i] += E * s_by[i] + E_by * s[i];
        }
    }
}

/* Of a spring that went with a tip at this depth: its force. */
static double with_tip(const nt_run *run, const springs *of, double tip, int i)
{
    return of->place[HELD][i] + run->step.sum[0] * (tip - of->place[DEPTH][i] - of->s[0][i]);
}

/* Force over 1/(1 - nu^2), and its slope, of a tip at this depth. */
static double pressed(const nt_run *run, const springs *of, double tip, double *stiffness)
{
    const double *w = of->place[WEIGHT];
    double force = 0.0, reached = 0.0;
    for (int i = 0; i < of->count; i++) {
        const double f = with_tip(run, of, tip, i);
        force += f > 0.0 ? w[i] * f : 0.0;
        reached += f > 0.0 ? w[i] : 0.0;
    }
    *stiffness = run->step.sum[0] * reached;
    return force;
}

/* The tip's depth in balance with the lever. The force is convex in it: Newton's steps come from one side. */
static nt_status balance(nt_run *run, const springs *of, double base)
{
    const double softness = run->compliance * run->factor;
    double stiffness, tip = base;
    for (int i = 0; i < ITERATIONS && softness > 0.0; i++) {
        const double force = pressed(run, of, tip, &stiffness);
        const double change = (tip + softness * force - base) / (1.0 + softness * stiffness);
        tip -= change;
        if (fabs(change) <= CONVERGED * of->deepest) {
            run->depth = tip;
            return NT_OK;
        }
    }
    run->depth = base;
    return softness > 0.0 ? NT_E_NO_CONVERGENCE : NT_OK;
}

/* Derivatives of depth and force, and of the springs' ways. */
static void derive(nt_run *run, const springs *of, int p)
{
    row *by = by_of(of, p);
    const double A = run->step.sum[0], A_by = run->step.sum_by[p][0], *w = of->place[WEIGHT], *way = of->place[WAY];
    const double *held_by = by[of->width], *u_by = by[0];
    double *way_by = by[of->width + 1], rest = 0.0, reached = 0.0;
    for (int i = 0; i < of->count; i++)
        if (with_tip(run, of, run->depth, i) > 0.0) {
            rest += w[i] * (held_by[i] + A_by * way[i] - A * u_by[i]);
            reached += w[i];
        }
    const double softness = run->compliance * run->factor, position = p == 0 ? -1.0 : 0.0;
    run->depth_by[p] = (position - softness * rest) / (1.0 + softness * A * reached);
    run->force_by[p] = run->factor * (rest + A * reached * run->depth_by[p]);
    for (int i = 0; i < of->count; i++)
        way_by[i] =
            with_tip(run, of, run->depth, i) > 0.0 ? run->depth_by[p] - u_by[i] : -(held_by[i] + A_by * way[i]) / A;
    for (int k = 0; k < of->width; k++) {
        const double psi = run->step.psi[0][k], psi_by = k == run->arms.arm[p] ? run->step.psi_by[p][0] : 0.0;
        for (int i = 0; i < of->count; i++)
            by[k][i] += psi * way_by[i] + psi_by * way[i];
    }
}

static nt_status step(nt_run *run, const springs *of, double time, double base)
{
    double stiffness, *held = of->place[HELD], *way = of->place[WAY];
    nt_step_to(&run->step, &run->arms, time - run->time);
    for (int p = 0; p < of->parameters; p++)
        relax_by(run, of, p);
    relax(run, of, held);
    const nt_status status = balance(run, of, base);
    run->force = run->factor * pressed(run, of, run->depth, &stiffness);
    const double A = run->step.sum[0];
    for (int i = 0; i < of->count; i++) {
        const double along = run->depth - of->place[DEPTH][i] - of->s[0][i];
        way[i] = with_tip(run, of, run->depth, i) > 0.0 ? along : -held[i] / A;
    }
    for (int p = 0; p < of->parameters; p++)
        derive(run, of, p);
    for (int k = 0; k < of->width; k++)
        nt_arms_add(of->count, of->s[k], run->step.psi[0][k], way);
    run->time = time;
    return status;
}

nt_status nt_springs_run(nt_run *run, const nt_viscoelastic_path *path, nt_springs_put *put,
                         const nt_viscoelastic_result *result)
{
    double deepest = 0.0;
    for (long i = 0; i < path->count; i++)
        deepest = fmax(deepest, path->positions[i] - path->contact);
    const springs of = laid_out(run, deepest, path->workspace);
    nt_status status = NT_OK;
    run->time = path->times[0];
    for (long i = 1; i < path->count && status == NT_OK; i++) {
        status = step(run, &of, path->times[i], path->positions[i] - path->contact);
        if (run->depth > run->profile.deepest)
            return NT_E_RANGE;
        put(run, result, i);
    }
    return status;
}
