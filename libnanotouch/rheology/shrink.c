/* SPDX-License-Identifier: BSD-3-Clause
 * A step of a contact that shrinks. All springs up to the edge go with the tip; pieces of the first loading whose
 * springs pull are taken off from the outside (their s_k follow from those of the edge), and of the last piece a part,
 * whose force is a cubic in between. As the force is 0 where a spring leaves, an error of that place counts squared. */
#include <math.h>
#include <string.h>

#include "core/variants.h"
#include "rheology/run.h"

enum { ITERATIONS = 60, GAUSS = 3 };
#define CONVERGED 1e-8

/* The piece of the first loading inside the edge: f(y) of its springs, y = 0 at the edge, 1 at the piece's start. */
typedef struct piece {
    const double *inner, *outer; /* records */
    double length;               /* of the piece [m] */
    double more, first, last;    /* f(1) - f(0), f'(0), f'(1) */
    const nt_step *step;
} piece;

/* Sums that a step is solved with, before the tip moves; `by` are derivatives. */
typedef struct sums {
    double held, edge, stiffness; /* Sum E Z, Sum E S, Sum E psi_0 */
    double held_by[NT_ARM_PARAMETERS], edge_by[NT_ARM_PARAMETERS];
} sums;

static nt_profile_value profile_of(const double *record)
{
    return (nt_profile_value){record[NT_RUN_G], record[NT_RUN_SLOPE], record[NT_RUN_CURVATURE]};
}

NT_VARIANTS static piece inside_edge(nt_run *run)
{
    const double *outer = nt_run_record_at(run, run->edge), *inner = nt_run_record_at(run, run->edge - 1);
    const double h = outer[NT_RUN_TIME] - inner[NT_RUN_TIME];
    const nt_step *step = &run->step;
    if (!(fabs(h - step->h) <= NT_SAME_STEP * h)) {
        nt_step_to(&run->past, &run->arms, h);
        step = &run->past;
    }
    const double length = outer[NT_RUN_DEPTH] - inner[NT_RUN_DEPTH];
    const double more = nt_arms_sum_late(run->arms.width, run->arms.modulus, run->past_decay, step->psi[0]);
    return (piece){inner, outer, length, length * more, 0.0, 0.0, step};
}

/* The slopes, where the edge is known to be inside. */
NT_VARIANTS static void add_slopes(const nt_run *run, piece *of)
{
    const double *E = run->arms.modulus;
    of->first = of->length * nt_arms_sum(run->arms.width, E, run->past_decay);
    of->last = of->length * nt_arms_sum_late(run->arms.width, E, run->past_decay, of->step->decay);
}

/* Hermite's cubic from 0 to `more`, with slopes at both ends; its slope at y. */
static double cubic(double more, const double slopes[2], double y, double *slope)
{
    const double c2 = 3.0 * more - 2.0 * slopes[0] - slopes[1], c3 = slopes[0] + slopes[1] - 2.0 * more;
    *slope = slopes[0] + y * (2.0 * c2 + 3.0 * y * c3);
    return y * (slopes[0] + y * (c2 + y * c3));
}

/* f(y) - f(0). */
static double rise(const piece *of, double y, double *slope)
{
    return cubic(of->more, (double[2]){of->first, of->last}, y, slope);
}

/* Where f = 0, if f(0) < 0 < f(1): Newton inside a bracket. */
static double place_of_zero(const piece *of, double edge)
{
    double low = 0.0, high = 1.0, y = -edge / of->more, slope;
    if (!(edge < 0.0))
        return 0.0;
    for (int i = 0; i < ITERATIONS; i++) {
        const double f = edge + rise(of, y, &slope);
        *(f < 0.0 ? &low : &high) = y;
        double next = y - f / slope;
        if (!(next > low && next < high))
            next = 0.5 * (low + high);
        const double change = fabs(next - y);
        y = next;
        if (change < CONVERGED) /* what is left counts squared */
            break;
    }
    return y;
}

/* g' at the edge over that at y, and its slope in y. */
static double narrower(const piece *of, double y, double *slope)
{
    const double more = of->outer[NT_RUN_SLOPE] - of->inner[NT_RUN_SLOPE];
    const double first = of->length * of->outer[NT_RUN_CURVATURE];
    const int begins = !(of->inner[NT_RUN_DEPTH] > 0.0); /* no curvature there */
    const double last = begins ? 2.0 * more - first : of->length * of->inner[NT_RUN_CURVATURE];
    return cubic(more, (double[2]){first, last}, y, slope);
}

static const double node[GAUSS] = {0.1127016653792583, 0.5, 0.8872983346207417};
static const double weight[GAUSS] = {0.2777777777777778, 0.4444444444444444, 0.2777777777777778};

/* Int f dg' over the springs between the edge and y, which is below 0: - Int f' (g'(edge) - g') dy. */
static double pulled(const piece *of, double y)
{
    double sum = 0.0, slope, unused;
    for (int i = 0; i < GAUSS && y > 0.0; i++) {
        (void)rise(of, y * node[i], &slope);
        sum -= weight[i] * y * slope * narrower(of, y * node[i], &unused);
    }
    return sum;
}

/* g' where the contact ends. */
static double slope_at(const piece *of, double y)
{
    double unused;
    return of->outer[NT_RUN_SLOPE] - (y > 0.0 ? narrower(of, y, &unused) : 0.0);
}

/* The tip's motion in balance with the lever, with the contact's edge inside this piece. 0: the piece leaves as a
 * whole.
 */
static int balance(const nt_run *run, const sums *of, piece *inside, double base, double *moved)
{
    const double A = of->stiffness, softness = run->compliance * run->factor, outer = inside->outer[NT_RUN_SLOPE];
    double way = (base - run->depth - softness * of->held) / (1.0 + softness * outer * A);
    if (of->edge + A * way + inside->more < 0.0)
        return 0;
    add_slopes(run, inside);
    for (int i = 0; i < ITERATIONS && softness > 0.0; i++) {
        const double edge = of->edge + A * way;
        if (edge + inside->more < 0.0)
            return 0;
        const double y = place_of_zero(inside, edge);
        if (y == 0.0)
            break;
        const double force = of->held + outer * A * way - pulled(inside, y);
        const double change = (run->depth + way + softness * force - base) / (1.0 + softness * A * slope_at(inside, y));
        way -= change;
        if (fabs(change) <= CONVERGED * fabs(run->depth)) /* what is left is its square */
            break;
    }
    *moved = way;
    return of->edge + A * way + inside->more >= 0.0;
}

/* d(past_decay)/d(parameter) of the arm whose rate it changes, over past_decay. */
static double late_by(const nt_run *run, int p)
{
    return -(run->time - nt_run_record_at(run, run->edge)[NT_RUN_TIME]) * run->arms.rate_by[p];
}

/* Derivatives of the piece that leaves: of the s_k, then of Z. */
static void drop_by(nt_run *run, const piece *of, const double d[3], int p)
{
    const double outer_by = of->outer[NT_RUN_BY + p], inner_by = of->inner[NT_RUN_BY + p];
    const double length_by = outer_by - inner_by, outer_slope = of->outer[NT_RUN_SLOPE];
    const double inner_slope = of->inner[NT_RUN_SLOPE];
    const double outer_slope_by = of->outer[NT_RUN_CURVATURE] * outer_by;
    const double inner_slope_by = of->inner[NT_RUN_CURVATURE] * inner_by;
    const nt_profile_value inner = profile_of(of->inner), outer = profile_of(of->outer);
    const double (*psi)[NT_ARMS] = of->step->psi;
    const double *restrict w = run->past_decay, *restrict S = run->S;
    const double *restrict psi0 = psi[0], *restrict psi1 = psi[1], *restrict psi2 = psi[2];
    double *restrict Z_by = run->Z_by[p], *restrict S_by = run->S_by[p], d_by[3];
    const int arm = run->arms.arm[p];
    nt_run_piece_by(&inner, &outer, of->length, (double[2]){inner_by, outer_by}, d_by);
    for (int k = 0; k < run->arms.width; k++) {
        const double gone = d_by[0] * psi0[k] + d_by[1] * psi1[k] + d_by[2] * psi2[k], leaves = w[k] * psi0[k];
        const double inner_S = S[k] + of->length * leaves, inner_S_by = S_by[k] + length_by * leaves;
        Z_by[k] -= w[k] * gone + outer_slope_by * S[k] + outer_slope * S_by[k];
        Z_by[k] += inner_slope_by * inner_S + inner_slope * inner_S_by;
        S_by[k] = inner_S_by;
    }
    if (arm < 0)
        return;
    const double late = late_by(run, p);
    const double more = w[arm] * of->length * (late * psi[0][arm] + of->step->psi_by[p][0]);
    S_by[arm] += more;
    Z_by[arm] += inner_slope * more;
    for (int j = 0; j < 3; j++)
        Z_by[arm] -= w[arm] * d[j] * (late * psi[j][arm] + of->step->psi_by[p][j]);
}

/* The piece leaves: Z, S and past_decay of the springs inside of it. */
NT_VARIANTS static void drop_sums(nt_run *run, const piece *of, const double d[3])
{
    const double *restrict psi0 = of->step->psi[0], *restrict psi1 = of->step->psi[1],
                           *restrict psi2 = of->step->psi[2];
    const double *restrict past = of->step->decay;
    double *restrict Z = run->Z, *restrict S = run->S, *restrict w = run->past_decay;
    const double outer = of->outer[NT_RUN_SLOPE], inner = of->inner[NT_RUN_SLOPE], length = of->length;
    const double a = d[0], b = d[1], c = d[2];
    for (int k = 0; k < run->arms.width; k++) {
        const double inner_S = S[k] + length * w[k] * psi0[k];
        Z[k] += inner * inner_S - outer * S[k] - w[k] * (a * psi0[k] + b * psi1[k] + c * psi2[k]);
        S[k] = inner_S;
        w[k] *= past[k];
    }
}

/* The same with derivatives, and what the step is solved with. */
static void drop(nt_run *run, const piece *of, sums *left)
{
    const double *E = run->arms.modulus, *Z = run->Z, *S = run->S;
    const nt_profile_value inner = profile_of(of->inner), outer = profile_of(of->outer);
    const int width = run->arms.width;
    double d[3];
    nt_run_piece(&inner, &outer, of->length, d);
    for (int p = 0; p < run->arms.parameters; p++)
        drop_by(run, of, d, p);
    drop_sums(run, of, d);
    run->edge--;
    left->held = nt_arms_sum(width, E, Z);
    left->edge = nt_arms_sum(width, E, S);
    for (int p = 0; p < run->arms.parameters; p++) {
        left->held_by[p] = nt_arms_sum(width, run->arms.by[p], Z) + nt_arms_sum(width, E, run->Z_by[p]);
        left->edge_by[p] = nt_arms_sum(width, run->arms.by[p], S) + nt_arms_sum(width, E, run->S_by[p]);
    }
}

/* d/d(parameter) of f(1) - f(0), f'(0), f'(1). */
static void piece_by(const nt_run *run, const piece *of, int p, double by[3])
{
    const double *w = run->past_decay, *E_by = run->arms.by[p], *decay = of->step->decay;
    const double length_by = of->outer[NT_RUN_BY + p] - of->inner[NT_RUN_BY + p];
    const double relative = of->length > 0.0 ? length_by / of->length : 0.0 /* a pause */;
    const int arm = run->arms.arm[p], width = run->arms.width;
    by[0] = of->length * nt_arms_sum_late(width, E_by, w, of->step->psi[0]) + relative * of->more;
    by[1] = of->length * nt_arms_sum(width, E_by, w) + relative * of->first;
    by[2] = of->length * nt_arms_sum_late(width, E_by, w, decay) + relative * of->last;
    if (arm >= 0) {
        const double late = late_by(run, p), scale = of->length * run->arms.modulus[arm] * w[arm];
        by[0] += scale * (late * of->step->psi[0][arm] + of->step->psi_by[p][0]);
        by[1] += scale * late;
        by[2] += scale * (late - of->step->h * run->arms.rate_by[p]) * decay[arm];
    }
}

/* Derivative of `pulled`, its end moving with the place where f = 0. */
static double pulled_by(const nt_run *run, const piece *of, double y, int p, double edge_by)
{
    const double outer = of->outer[NT_RUN_BY + p], length = outer - of->inner[NT_RUN_BY + p];
    double by[3], slope, slope_by, steep;
    if (!(y > 0.0))
        return 0.0;
    piece_by(run, of, p, by);
    const double f_by = edge_by + cubic(by[0], by + 1, y, &slope_by);
    double sum = f_by * narrower(of, y, &steep);
    for (int i = 0; i < GAUSS; i++) {
        const double at = y * node[i], wider = narrower(of, at, &steep);
        const double slopes_by = of->outer[NT_RUN_CURVATURE] * outer - steep / of->length * (outer - length * at);
        (void)rise(of, at, &slope);
        (void)cubic(by[0], by + 1, at, &slope_by);
        sum -= weight[i] * y * (slope_by * wider + slope * slopes_by);
    }
    return sum;
}

/* Derivatives of indentation and force; those of Z and S. */
static void derive(nt_run *run, const sums *of, const piece *inside, double way, double y)
{
    const double A = of->stiffness, C = run->factor, slope = inside->outer[NT_RUN_SLOPE];
    for (int p = 0; p < run->arms.parameters; p++) {
        const double position = p == 0 ? -1.0 : 0.0;
        const double slope_by = inside->outer[NT_RUN_CURVATURE] * inside->outer[NT_RUN_BY + p];
        const double still = run->step.sum_by[p][0] * way - A * run->depth_by[p];
        const double rest =
            of->held_by[p] + slope_by * A * way + slope * still - pulled_by(run, inside, y, p, of->edge_by[p] + still);
        const double stiffness = A * slope_at(inside, y), softness = run->compliance * C;
        const double to_by = (position - softness * rest) / (1.0 + softness * stiffness);
        const double way_by = to_by - run->depth_by[p], *psi = run->step.psi[0];
        const int arm = run->arms.arm[p];
        double *S_by = run->S_by[p], *Z_by = run->Z_by[p];
        nt_arms_add(run->arms.width, S_by, way_by, psi);
        nt_arms_add(run->arms.width, Z_by, slope_by * way + slope * way_by, psi);
        if (arm >= 0) {
            S_by[arm] += way * run->step.psi_by[p][0];
            Z_by[arm] += slope * way * run->step.psi_by[p][0];
        }
        run->depth_by[p] = to_by;
        run->force_by[p] = C * (rest + stiffness * to_by);
    }
}

/* The contact ends; the dent goes on to recover. */
static void leave(nt_run *run, const sums *of)
{
    run->dent = run->depth - of->edge / of->stiffness;
    for (int k = 0; k < run->arms.width; k++)
        run->S[k] -= of->edge / of->stiffness * run->step.psi[0][k];
    run->phase = NT_RUN_LEFT;
    run->depth = run->base;
    run->force = 0.0;
    for (int p = 0; p < run->arms.parameters; p++)
        run->force_by[p] = 0.0;
}

/* The tip moves, after all springs have relaxed. */
NT_VARIANTS static nt_status move(nt_run *run, sums *of, double time, double base)
{
    of->stiffness = run->step.sum[0];
    run->time = time;
    run->base = base;
    double way = 0.0;
    piece inside = inside_edge(run);
    while (!balance(run, of, &inside, base, &way)) {
        drop(run, &inside, of);
        if (run->edge == 0) {
            leave(run, of);
            return NT_OK;
        }
        inside = inside_edge(run);
    }
    const double edge = of->edge + of->stiffness * way, y = place_of_zero(&inside, edge);
    const double slope = inside.outer[NT_RUN_SLOPE], *psi = run->step.psi[0];
    run->force = fmax(run->factor * (of->held + slope * of->stiffness * way - pulled(&inside, y)), 0.0);
    derive(run, of, &inside, way, y);
    nt_arms_add(run->arms.width, run->S, way, psi);
    nt_arms_add(run->arms.width, run->Z, slope * way, psi);
    run->depth = run->compliance > 0.0 ? run->depth + way : base;
    return edge > 0.0 && way > 0.0 ? NT_E_NO_SOLUTION : NT_OK;
}

nt_status nt_run_turn(nt_run *run, double time, double base, double held, const double *held_by)
{
    sums of = {.held = held, .edge = 0.0};
    run->phase = NT_RUN_SHRINKING;
    memset(run->S, 0, sizeof run->S);
    memcpy(run->past_decay, run->step.decay, sizeof run->past_decay);
    for (int p = 0; p < run->arms.parameters; p++) {
        memset(run->S_by[p], 0, sizeof run->S_by[p]);
        of.held_by[p] = held_by[p];
        of.edge_by[p] = 0.0;
    }
    return move(run, &of, time, base);
}

nt_status nt_run_shrink(nt_run *run, double time, double base)
{
    sums of;
    nt_step_to(&run->step, &run->arms, time - run->time);
    of.held = nt_run_relax(run, run->Z, run->Z_by, of.held_by);
    of.edge = nt_run_relax(run, run->S, run->S_by, of.edge_by);
    nt_arms_multiply(run->arms.width, run->past_decay, run->step.decay);
    return move(run, &of, time, base);
}
