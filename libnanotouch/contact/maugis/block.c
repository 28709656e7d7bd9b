/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale over a block of indentations, exact: the bits of nt_maugis_eval on its stable branches.
 *
 * Newton's method (newton.h) runs in all lanes until the last has converged; what has, stays. The loops hold no calls
 * and no jumps, so that compilers make vector code of them, for several instruction sets where the toolchain can. */
#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "contact/block.h"
#include "contact/maugis/apart.h"
#include "contact/maugis/folds.h"
#include "contact/maugis/newton.h"
#include "contact/maugis/solve.h"
#include "core/variants.h"
#include "internal/contact.h"

#define VARIANTS NT_TARGETS("default", "arch=x86-64-v3", "arch=x86-64-v4")
#ifdef __GNUC__ /* into each of its variants, or it would have none itself */
#define WITHIN static inline __attribute__((always_inline))
#else
#define WITHIN static inline
#endif

/* Where each lane starts, if not all at the same place. */
typedef struct {
    double lambda[NT_BLOCK], y[NT_BLOCK], a[NT_BLOCK], d[NT_BLOCK]; /* nt_maugis_start */
} starts;

/* Of lane i: its own, or `one` for all, which comes as a value: a loop reads it once. */
WITHIN nt_maugis_start start_at(nt_maugis_start one, const starts *each, int i)
{
    return each == NULL ? one : (nt_maugis_start){each->lambda[i], each->y[i], each->a[i], each->d[i]};
}

/* nt_maugis_newton, lane by lane. */
typedef struct {
    double d[NT_BLOCK], Z[NT_BLOCK];
    double y[NT_BLOCK], step[NT_BLOCK], from[NT_BLOCK];
    double low[NT_BLOCK], high[NT_BLOCK];
    double best[NT_BLOCK], best_y[NT_BLOCK], scale[NT_BLOCK];
    int64_t done[NT_BLOCK], outside[NT_BLOCK];
    double U[NT_BLOCK], P[NT_BLOCK], k[NT_BLOCK], a[NT_BLOCK]; /* reduced, at last */
} lanes;

WITHIN void lanes_start_at(nt_maugis_start one, const starts *each, lanes *l)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const nt_maugis_start start = start_at(one, each, i);
        const nt_maugis_newton at = nt_maugis_newton_start(&start, l->d[i]);
        l->Z[i] = at.Z;
        l->y[i] = at.y;
        l->step[i] = at.step;
        l->low[i] = at.low;
        l->high[i] = at.high;
        l->best[i] = at.best;
        l->best_y[i] = at.y;
        l->scale[i] = at.scale;
        l->done[i] = 0;
    }
}

/* One evaluation in every lane; bits: 1 some are not done, 2 some have left their bracket. */
WITHIN int lanes_next_at(nt_maugis_start one, const starts *each, lanes *l)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const nt_maugis_start start = start_at(one, each, i);
        nt_maugis_newton at = {l->d[i],    l->Z[i],    l->y[i],      l->step[i], l->low[i],
                               l->high[i], l->best[i], l->best_y[i], l->scale[i]};
        int64_t left;
        const int64_t stop = nt_maugis_newton_next(&start, &at, &left), was = l->done[i];
        l->from[i] = l->y[i];
        l->y[i] = at.y;
        l->step[i] = at.step;
        l->low[i] = at.low;
        l->high[i] = at.high;
        l->best[i] = at.best;
        l->best_y[i] = was ? l->best_y[i] : at.best_y;
        l->scale[i] = at.scale;
        l->done[i] = was | stop;
        l->outside[i] = left & ~(was | stop);
    }
    int64_t open = 0, outside = 0;
    for (int i = 0; i < NT_BLOCK; i++) { /* on its own, or the loop above stays scalar */
        open |= ~l->done[i];
        outside |= l->outside[i];
    }
    return (open ? 1 : 0) | (outside ? 2 : 0);
}

static void lanes_bisect(lanes *l)
{
    for (int i = 0; i < NT_BLOCK; i++)
        if (l->outside[i]) {
            nt_maugis_newton at = {.low = l->low[i], .high = l->high[i]};
            nt_maugis_newton_bisect(&at, l->from[i]);
            l->y[i] = at.y;
            l->step[i] = at.step;
        }
}

/* The contact branch in every lane. */
WITHIN void values_at(nt_maugis_start one, const starts *each, lanes *l)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const nt_maugis_start start = start_at(one, each, i);
        const nt_maugis_functions f = nt_maugis_functions_at(l->best_y[i]);
        const nt_maugis_equilibrium point = nt_maugis_equilibrium_of(start.lambda, f);
        const nt_maugis_rest rest = nt_maugis_rest_of(&start, &point, l->d[i], NT_FOLD_RESOLUTION * start.y);
        l->U[i] = nt_maugis_energy_of(start.lambda, &point, f) + rest.U;
        l->P[i] = point.P + rest.P;
        l->k[i] = point.P1 / point.d1;
        l->a[i] = point.a + rest.a;
    }
}

/* Its load alone. */
WITHIN void loads_at(nt_maugis_start one, const starts *each, lanes *l)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const nt_maugis_start start = start_at(one, each, i);
        const nt_maugis_functions f = nt_maugis_functions_at(l->best_y[i]);
        const nt_maugis_equilibrium point = nt_maugis_equilibrium_of(start.lambda, f);
        l->P[i] = point.P + nt_maugis_rest_of(&start, &point, l->d[i], NT_FOLD_RESOLUTION * start.y).P;
    }
}

/* For one start of all lanes, and where each has its own; apart, as two loops in a function compete for registers. */
VARIANTS static void lanes_start(const nt_maugis_start *one, lanes *l)
{
    lanes_start_at(*one, NULL, l);
}

VARIANTS static void lanes_start_each(const starts *each, lanes *l)
{
    lanes_start_at((nt_maugis_start){0}, each, l);
}

VARIANTS static int lanes_next(const nt_maugis_start *one, lanes *l)
{
    return lanes_next_at(*one, NULL, l);
}

VARIANTS static int lanes_next_each(const starts *each, lanes *l)
{
    return lanes_next_at((nt_maugis_start){0}, each, l);
}

VARIANTS static void values_fill(const nt_maugis_start *one, lanes *l)
{
    values_at(*one, NULL, l);
}

VARIANTS static void values_fill_each(const starts *each, lanes *l)
{
    values_at((nt_maugis_start){0}, each, l);
}

VARIANTS static void loads_fill(const nt_maugis_start *one, lanes *l)
{
    loads_at(*one, NULL, l);
}

VARIANTS static void loads_fill_each(const starts *each, lanes *l)
{
    loads_at((nt_maugis_start){0}, each, l);
}

/* Beside the fold, where the stiffness is infinite: as nt_maugis_value_of reports it. */
static void fold_fill(const nt_maugis_start *one, const starts *each, lanes *l)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const nt_maugis_start start = each == NULL ? *one : start_at((nt_maugis_start){0}, each, i);
        const double resolution = NT_FOLD_RESOLUTION * start.y;
        if (fabs(l->best_y[i] - start.y) < resolution) {
            nt_maugis_equilibrium slope;
            nt_maugis_equilibrium_at(start.lambda, start.y + resolution, &slope);
            l->k[i] = slope.P1 / slope.d1;
        }
    }
}

/* What a lane is. */
typedef struct {
    int64_t apart[NT_BLOCK]; /* bodies apart: 0 */
    int64_t other[NT_BLOCK]; /* attracted, not in contact: closed form, one by one */
} kinds;

/* Indentations that are wanted on the contact branch; where another holds, some that is on it. Returns 0 where one is
 * so deep that it is Hertz. */
VARIANTS static int lanes_sort(const nt_maugis *maugis, double first, double contact, const double *in, lanes *l,
                               kinds *of)
{
    const double unit = maugis->indentation_scale, grip = maugis->folds.grip_indentation;
    int64_t deep = 0;
    for (int i = 0; i < NT_BLOCK; i++) {
        const double reduced = in[i] / unit, d = reduced > grip ? reduced : grip; /* rounding only */
        of->apart[i] = -(int64_t)(in[i] < first);
        of->other[i] = ~of->apart[i] & -(int64_t)(d < contact);
        deep |= -(int64_t)(in[i] > NT_REDUCED_HERTZ * unit);
        l->d[i] = of->apart[i] | of->other[i] ? contact + 1.0 : d;
    }
    return deep == 0;
}

VARIANTS static void block_fill(const nt_reduced_units *units, const kinds *of, const lanes *l,
                                nt_law_block *restrict block)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const nt_law_value reduced = {l->U[i], l->P[i], l->k[i], l->a[i]};
        const nt_law_value value = nt_reduced_to_si(&reduced, units);
        block->U[i] = of->apart[i] ? 0.0 : value.U;
        block->F[i] = of->apart[i] ? 0.0 : value.F;
        block->k[i] = of->apart[i] ? 0.0 : value.k;
        block->a[i] = of->apart[i] ? 0.0 : value.a;
    }
}

static void others_fill(const nt_maugis *maugis, nt_branch branch, const kinds *restrict of,
                        nt_law_block *restrict block)
{
    for (int i = 0; i < NT_BLOCK; i++)
        if (of->other[i]) {
            nt_law_value value;
            if (nt_maugis_eval(maugis, block->in[i], branch, &value, NULL) != NT_OK)
                continue; /* no number: marked by the caller */
            block->U[i] = value.U;
            block->F[i] = value.F;
            block->k[i] = value.k;
            block->a[i] = value.a;
        }
}

/* The contact branch in every lane; 0 where one does not converge. `each` is NULL where all start at `one`. */
static int lanes_solve(const nt_maugis_start *one, const starts *each, lanes *l)
{
    int found = 1;
    if (each == NULL)
        lanes_start(one, l);
    else
        lanes_start_each(each, l);
    for (int n = 0; n < NT_NEWTON_MAX && found; n++) {
        found = each == NULL ? lanes_next(one, l) : lanes_next_each(each, l);
        if (found & 2)
            lanes_bisect(l);
    }
    return !(found & 1);
}

/* Values, or loads alone, where the lanes have come to. */
static void lanes_fill(const nt_maugis_start *one, const starts *each, int load_alone, lanes *l)
{
    if (load_alone && each == NULL)
        loads_fill(one, l);
    else if (load_alone)
        loads_fill_each(each, l);
    else if (each == NULL)
        values_fill(one, l);
    else
        values_fill_each(each, l);
    if (!load_alone)
        fold_fill(one, each, l);
}

int nt_maugis_block(const nt_maugis *maugis, nt_branch branch, int load_alone, nt_law_block *block)
{
    const nt_maugis_start start = nt_maugis_start_of(maugis);
    const nt_maugis_folds *folds = &maugis->folds;
    const nt_reduced_units units = {maugis->load_scale, maugis->radius_scale, maugis->indentation_scale};
    const int on_approach = branch == NT_BRANCH_APPROACH && folds->onset_indentation > folds->grip_indentation;
    const double first = (on_approach ? folds->onset_indentation : folds->grip_indentation) * units.indentation;
    lanes l = {.U = {0.0}, .k = {0.0}, .a = {0.0}};
    kinds of;
    if (!lanes_sort(maugis, first, start.d, block->in, &l, &of) || !lanes_solve(&start, NULL, &l))
        return 0;
    lanes_fill(&start, NULL, load_alone, &l);
    block_fill(&units, &of, &l, block);
    others_fill(maugis, branch, &of, block);
    return 1;
}

/* Where the stable states of each lane end: the displacement fold, in contact or not [reduced]. */
typedef struct {
    double grip[NT_BLOCK], onset[NT_BLOCK];
} ends;

VARIANTS static void starts_fill(starts *each, ends *of)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const double lambda = each->lambda[i], c = nt_maugis_apart_fold(lambda), onset = -2.0 / (NT_PI * lambda);
        const nt_maugis_equilibrium at = nt_maugis_equilibrium_of(lambda, nt_maugis_functions_at(each->y[i]));
        each->a[i] = at.a;
        each->d[i] = at.d;
        of->onset[i] = onset;
        of->grip[i] = each->y[i] > 0.0 ? at.d : onset - 0.5 * c * c;
    }
}

/* lanes_sort, each by its own. */
VARIANTS static int lanes_sort_each(const nt_block_contacts *contacts, const starts *each, const ends *end,
                                    int approaches, nt_law_block *restrict block, lanes *restrict l, kinds *restrict of)
{
    int64_t deep = 0;
    for (int i = 0; i < NT_BLOCK; i++) {
        const double unit = contacts->indentation[i], in = block->in[i], grip = end->grip[i], onset = end->onset[i];
        const double first = (approaches && onset > grip ? onset : grip) * unit, contact = each->d[i];
        const double reduced = in / unit, d = reduced > grip ? reduced : grip;
        of->apart[i] = -(int64_t)(in < first);
        of->other[i] = ~of->apart[i] & -(int64_t)(d < contact);
        deep |= -(int64_t)(in > NT_REDUCED_HERTZ * unit);
        l->d[i] = of->apart[i] | of->other[i] ? contact + 1.0 : d;
    }
    return deep == 0;
}

/* What is attracted and not in contact, reduced. */
static void others_fill_each(const nt_block_contacts *contacts, const ends *end, const kinds *of, lanes *l,
                             const nt_law_block *block)
{
    for (int i = 0; i < NT_BLOCK; i++)
        if (of->other[i]) {
            const nt_maugis maugis = {.lambda = contacts->lambda[i], .folds.onset_indentation = end->onset[i]};
            const double reduced = block->in[i] / contacts->indentation[i];
            const nt_law_value value = nt_maugis_apart_stable(&maugis, reduced > end->grip[i] ? reduced : end->grip[i]);
            l->U[i] = value.U;
            l->P[i] = value.F;
            l->k[i] = value.k;
            l->a[i] = value.a;
        }
}

VARIANTS static void block_fill_each(const nt_block_contacts *contacts, const kinds *of, const lanes *l,
                                     nt_law_block *restrict block)
{
    for (int i = 0; i < NT_BLOCK; i++) {
        const nt_reduced_units units = {contacts->load[i], contacts->radius[i], contacts->indentation[i]};
        const nt_law_value reduced = {l->U[i], l->P[i], l->k[i], l->a[i]};
        const nt_law_value value = nt_reduced_to_si(&reduced, &units);
        block->U[i] = of->apart[i] ? 0.0 : value.U;
        block->F[i] = of->apart[i] ? 0.0 : value.F;
        block->k[i] = of->apart[i] ? 0.0 : value.k;
        block->a[i] = of->apart[i] ? 0.0 : value.a;
    }
}

int nt_maugis_block_each(const nt_block_contacts *contacts, nt_branch branch, int load_alone, nt_law_block *block)
{
    starts each;
    ends end;
    lanes l = {.U = {0.0}, .k = {0.0}, .a = {0.0}};
    kinds of;
    for (int i = 0; i < NT_BLOCK; i++) {
        each.lambda[i] = contacts->lambda[i];
        each.y[i] = nt_maugis_grip_parameter(each.lambda[i]);
    }
    starts_fill(&each, &end);
    if (!lanes_sort_each(contacts, &each, &end, branch == NT_BRANCH_APPROACH, block, &l, &of) ||
        !lanes_solve(NULL, &each, &l))
        return 0;
    lanes_fill(NULL, &each, load_alone, &l);
    others_fill_each(contacts, &end, &of, &l, block);
    block_fill_each(contacts, &of, &l, block);
    return 1;
}
