/* SPDX-License-Identifier: BSD-3-Clause
 * The force on a tip whose base is moved slowly: a contact law on a spring, at many stage indentations at once.
 *
 * D = delta + F(delta)/k_c has to be inverted on its rising branch, from the fold of D upwards. With
 * delta = grip + s^2, where F is a smooth function of s even at the law's own fold, D(s) is tabulated in NODES cells
 * with its derivative, and each D is looked up there. One Newton step with the exact law follows. */
#include <math.h>
#include <stddef.h>

#include "contact/block.h"
#include "core/roots.h"
#include "core/strided.h"
#include "internal/contact_equilibrium.h"
#include "nanotouch/advanced/contact_equilibrium.h"

enum { CELLS = 127, NODES = CELLS + 1, STEPS = 40 };
static const double close = 1e-7; /* of the distance from the fold: the error after such a step is its square */

typedef struct ramp_branch {
    const nt_contact_law *law;
    double spring, grip; /* k_c [N/m]; indentation where s = 0 [m] */
    double first, last;  /* s of the fold of D and of the largest D [m^(1/2)] */
    double D[NODES];     /* [m] */
    double slope[NODES]; /* dD/ds times the width of a cell [m] */
} ramp_branch;

typedef struct end_context {
    const nt_contact_law *law;
    double spring, stage;
} end_context;

static double end_excess(double delta, const void *context)
{
    const end_context *end = context;
    nt_law_value value = {.F = NAN};
    (void)nt_contact_law_eval(end->law, delta, NT_BRANCH_STABLE, &value);
    return delta + value.F / end->spring - end->stage;
}

/* Indentation at a stage indentation D above that of the fold. */
static nt_status end_find(const nt_contact_law *law, double spring, double fold, double stage, double *delta)
{
    const end_context context = {law, spring, stage};
    const double bracket[2] = {fold, stage + (1.0 + 1e-9) * nt_contact_law_pull_off_force(law) / spring};
    if (!(end_excess(fold, &context) < 0.0)) {
        *delta = fold;
        return NT_OK;
    }
    return nt_root_find(end_excess, &context, bracket, delta, NULL);
}

static double branch_at(const ramp_branch *branch, double s)
{
    return branch->grip + s * s;
}

static double cell_width(const ramp_branch *branch)
{
    return (branch->last - branch->first) / CELLS;
}

static nt_status branch_tabulate(ramp_branch *branch)
{
    double delta[NODES], force[NODES], stiffness[NODES];
    const double width = cell_width(branch);
    for (int j = 0; j < NODES; j++)
        delta[j] = branch_at(branch, branch->first + j * width);
    const nt_strided arrays = {
        .in = delta, .F = force, .k = stiffness, .count = NODES, .in_stride = 1, .out_stride = 1};
    const nt_status status = nt_contact_law_eval_n(branch->law, NT_BRANCH_STABLE, &arrays);
    for (int j = 0; j < NODES; j++) {
        branch->D[j] = delta[j] + force[j] / branch->spring;
        branch->slope[j] = 2.0 * (branch->first + j * width) * (1.0 + stiffness[j] / branch->spring) * width;
    }
    branch->slope[0] = 0.0; /* the fold of D, or s = 0 */
    return status;
}

/* The part of a cell, 0 .. 1, at which its cubic reaches D. */
static double cubic_invert(const double D[2], const double slope[2], double wanted)
{
    const double rise = D[1] - D[0], above = wanted - D[0];
    const double c2 = 3.0 * rise - 2.0 * slope[0] - slope[1], c3 = slope[0] + slope[1] - 2.0 * rise;
    double low = 0.0, high = 1.0, x = above / rise;
    for (int i = 0; i < STEPS; i++) {
        const double excess = x * (slope[0] + x * (c2 + x * c3)) - above;
        *(excess > 0.0 ? &high : &low) = x;
        double next = x - excess / (slope[0] + x * (2.0 * c2 + 3.0 * x * c3));
        if (!(next >= low && next <= high))
            next = 0.5 * (low + high);
        if (fabs(next - x) <= 1e-12)
            return next;
        x = next;
    }
    return x;
}

/* Indentation at a stage indentation on the branch, near to the last one found: *cell is where to look first. */
static double branch_indentation(const ramp_branch *branch, double stage, int *cell)
{
    while (*cell > 0 && stage < branch->D[*cell])
        (*cell)--;
    while (*cell < CELLS - 1 && stage > branch->D[*cell + 1])
        (*cell)++;
    const double part = cubic_invert(&branch->D[*cell], &branch->slope[*cell], stage);
    return branch_at(branch, branch->first + (*cell + part) * cell_width(branch));
}

/* Places of a block that are in contact. */
typedef struct held_block {
    double stage[NT_BLOCK], delta[NT_BLOCK], force[NT_BLOCK], stiffness[NT_BLOCK];
    int where[NT_BLOCK]; /* in the block */
    long count;
} held_block;

/* Force and stiffness of the block, and the Newton step of one of its indentations. */
static nt_status held_eval(const ramp_branch *branch, held_block *held)
{
    const nt_strided arrays = {.in = held->delta,
                               .F = held->force,
                               .k = held->stiffness,
                               .count = held->count,
                               .in_stride = 1,
                               .out_stride = 1};
    return nt_contact_law_eval_n(branch->law, NT_BRANCH_STABLE, &arrays);
}

static double held_step(const ramp_branch *branch, const held_block *held, long i)
{
    const double excess = held->delta[i] + held->force[i] / branch->spring - held->stage[i];
    return -excess / (1.0 + held->stiffness[i] / branch->spring);
}

/* By bisection and its like, where Newton's steps are too long: beside the fold, and at the bend where a weak
 * attraction ends. */
static nt_status held_search(const ramp_branch *branch, held_block *held, long i)
{
    nt_law_value value;
    nt_status status =
        end_find(branch->law, branch->spring, branch_at(branch, branch->first), held->stage[i], &held->delta[i]);
    if (status == NT_OK)
        status = nt_contact_law_eval(branch->law, held->delta[i], NT_BRANCH_STABLE, &value);
    if (status == NT_OK)
        held->force[i] = value.F;
    return status;
}

/* The forces, from indentations that are nearly right. */
static nt_status held_force(const ramp_branch *branch, held_block *held)
{
    nt_status status = held->count ? held_eval(branch, held) : NT_OK;
    const double fold = branch_at(branch, branch->first);
    for (long i = 0; i < held->count && status == NT_OK; i++) {
        const double step = held_step(branch, held, i);
        if (fabs(step) <= close * (held->delta[i] - fold))
            held->force[i] += held->stiffness[i] * step;
        else
            status = held_search(branch, held, i);
    }
    return status;
}

/* Where contact begins: the stage indentation below which the tip is free on this branch. */
static nt_status branch_prepare(ramp_branch *branch, const nt_ramp *ramp, double *free)
{
    nt_jump jump;
    nt_status status = nt_contact_law_jump(branch->law, ramp->spring, &jump);
    if (status != NT_OK)
        return status;
    *free = ramp->branch == NT_BRANCH_APPROACH ? -jump.jump_in_gap : -jump.pull_off_gap;
    double deepest = *free, delta;
    for (long i = 0; i < ramp->count; i++)
        deepest = fmax(deepest, ramp->stage[i]);
    status = end_find(branch->law, ramp->spring, jump.last.indentation, deepest, &delta);
    branch->grip = fmin(nt_contact_law_grip_indentation(branch->law), jump.last.indentation);
    branch->first = sqrt(jump.last.indentation - branch->grip);
    branch->last = sqrt(fmax(delta, jump.last.indentation) - branch->grip);
    if (status != NT_OK || !(branch->last > branch->first))
        return status;
    return branch_tabulate(branch);
}

static nt_status block_force(const ramp_branch *branch, double free, const double stage[], double force[], long count)
{
    held_block held = {.count = 0};
    int cell = 0;
    for (long i = 0; i < count; i++) {
        force[i] = 0.0;
        if (!(stage[i] > free) || !(branch->last > branch->first))
            continue;
        held.where[held.count] = (int)i;
        held.stage[held.count] = stage[i];
        held.delta[held.count++] = branch_indentation(branch, stage[i], &cell);
    }
    const nt_status status = held_force(branch, &held);
    for (long i = 0; i < held.count; i++)
        force[held.where[i]] = held.force[i];
    return status;
}

nt_status nt_contact_law_ramp(const nt_contact_law *law, const nt_ramp *ramp)
{
    if (ramp->branch != NT_BRANCH_APPROACH && ramp->branch != NT_BRANCH_STABLE)
        return NT_E_ARGUMENT;
    if (!isfinite(ramp->spring))
        return NT_E_NOT_FINITE;
    if (!(ramp->spring > 0.0))
        return NT_E_RANGE;
    for (long i = 0; i < ramp->count; i++)
        if (!isfinite(ramp->stage[i]))
            return NT_E_NOT_FINITE;
    ramp_branch branch = {.law = law, .spring = ramp->spring};
    double free;
    nt_status status = branch_prepare(&branch, ramp, &free);
    for (long i = 0; status == NT_OK && i < ramp->count; i += NT_BLOCK) {
        const long count = ramp->count - i < NT_BLOCK ? ramp->count - i : NT_BLOCK;
        status = block_force(&branch, free, ramp->stage + i, ramp->force + i, count);
    }
    return status;
}
