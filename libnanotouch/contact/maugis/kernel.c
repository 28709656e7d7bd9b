/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale over arrays: the table, and the table polished.
 *
 * Blocks small enough for the first cache go through in steps: place in the table, then the cubic (then the exact
 * branch). The steps are plain loops without calls and branches, which compilers turn into vector code; where the
 * toolchain can, they are compiled for several instruction sets, of which the machine picks one. There is no fused
 * multiply-add in any
 * (-ffp-contract=off), so that all give the same bits. Only the cubic needs help: four cells are loaded whole and
 * transposed, which beats gathering their numbers one by one. */
#include <stddef.h>

#include "contact/maugis/place.h"
#include "contact/maugis_table.h"
#include "core/strided.h"
#include "core/variants.h"

#define VARIANTS NT_TARGETS("default", "arch=x86-64-v2", "arch=x86-64-v3", "arch=x86-64-v4")

#if defined(__has_builtin) && (defined(__x86_64__) || defined(__aarch64__))
#if __has_builtin(__builtin_shufflevector)
#define TRANSPOSED 1
#endif
#endif

#if defined(__x86_64__)
enum { BLOCK = 256 }; /* the work on a block's edge is then below 3 % */
#else
enum { BLOCK = 64 }; /* a small stack matters more */
#endif

/* One block, from step to step. */
typedef struct {
    int64_t cell[BLOCK];
    double s[BLOCK];
    double d[BLOCK], Z[BLOCK], y[BLOCK], P_Z[BLOCK], P_ZZ[BLOCK]; /* nt_maugis_rough */
} block;

#ifdef TRANSPOSED
typedef double four __attribute__((vector_size(32)));

/* Cubics of four cells at once. */
static inline void cubics(const nt_maugis_cell *cells, const int64_t cell[4], const double s[4], double force[4])
{
    four q0, q1, q2, q3, x;
    memcpy(&q0, cells[cell[0]].F, sizeof q0);
    memcpy(&q1, cells[cell[1]].F, sizeof q1);
    memcpy(&q2, cells[cell[2]].F, sizeof q2);
    memcpy(&q3, cells[cell[3]].F, sizeof q3);
    memcpy(&x, s, sizeof x);
    const four even_01 = __builtin_shufflevector(q0, q1, 0, 4, 2, 6),
               odd_01 = __builtin_shufflevector(q0, q1, 1, 5, 3, 7);
    const four even_23 = __builtin_shufflevector(q2, q3, 0, 4, 2, 6),
               odd_23 = __builtin_shufflevector(q2, q3, 1, 5, 3, 7);
    const four c0 = __builtin_shufflevector(even_01, even_23, 0, 1, 4, 5);
    const four c1 = __builtin_shufflevector(odd_01, odd_23, 0, 1, 4, 5);
    const four c2 = __builtin_shufflevector(even_01, even_23, 2, 3, 6, 7);
    const four c3 = __builtin_shufflevector(odd_01, odd_23, 2, 3, 6, 7);
    const four result = (c0 + x * c1) + x * x * (c2 + x * c3); /* as nt_cubic */
    memcpy(force, &result, sizeof result);
}
#else
static inline void cubics(const nt_maugis_cell *cells, const int64_t cell[4], const double s[4], double force[4])
{
    for (int i = 0; i < 4; i++)
        force[i] = nt_cubic(cells[cell[i]].F, s[i]);
}
#endif

/* The forces of a block from the table; 0 where some indentation lies outside it. */
VARIANTS static int table_find(const nt_maugis_table *table, nt_branch branch, const double *indentation, double *force)
{
    block at;
    const nt_maugis_grid grid = nt_maugis_grid_of(table, branch);
    const double largest = table->largest_indentation;
    int64_t outside = 0;
    for (int i = 0; i < BLOCK; i++) {
        const nt_maugis_place place = nt_maugis_place_of(&grid, indentation[i]);
        at.cell[i] = place.cell;
        at.s[i] = place.s;
        outside |= -(int64_t)!(indentation[i] <= largest);
    }
    if (outside)
        return 0;
    for (int i = 0; i < BLOCK; i += 4)
        cubics(table->cells, &at.cell[i], &at.s[i], &force[i]);
    return 1;
}

/* The same, polished; outside of contact the table is closed-form already. */
VARIANTS static int polished_find(const nt_maugis_table *table, nt_branch branch, const double *indentation,
                                  double *force)
{
    block at;
    const nt_maugis_grid grid = nt_maugis_grid_of(table, branch);
    const nt_maugis_polish polish = nt_maugis_polish_of(table);
    for (int i = 0; i < BLOCK; i++) {
        const nt_maugis_place place = nt_maugis_place_of(&grid, indentation[i]);
        at.cell[i] = place.cell;
        at.s[i] = place.s;
        at.Z[i] = place.Z / polish.root;
        at.d[i] = indentation[i] / polish.unit;
    }
    if (!table_find(table, branch, indentation, force))
        return 0;
    for (int i = 0; i < BLOCK; i++) {
        const nt_maugis_place place = {.s = at.s[i]};
        const nt_maugis_rough rough = nt_maugis_rough_of(&polish, &table->cells[at.cell[i]], place);
        at.y[i] = rough.y;
        at.P_Z[i] = rough.P_Z;
        at.P_ZZ[i] = rough.P_ZZ;
    }
    for (int i = 0; i < BLOCK; i++) {
        const nt_maugis_rough rough = {at.d[i], at.Z[i], at.y[i], at.P_Z[i], at.P_ZZ[i]};
        const double polished = polish.load * nt_maugis_polished_load(&polish, &rough);
        force[i] = at.cell[i] < NT_CELL_CONTACT ? force[i] : polished;
    }
    return 1;
}

static nt_status one_by_one(const nt_maugis_table *table, const nt_maugis_query *query, const double *indentation,
                            double *force, long count)
{
    nt_status first = NT_OK;
    for (long i = 0; i < count; i++) {
        double value = NAN;
        const nt_status status = nt_maugis_force_find(table, query, indentation[i], &value);
        first = first == NT_OK ? status : first;
        force[i] = value;
    }
    return first;
}

static nt_status force_n(const nt_maugis_table *table, const nt_maugis_query *query, const double *indentation,
                         double *force, long count)
{
    const int held = query->branch == NT_BRANCH_STABLE || query->branch == NT_BRANCH_APPROACH;
    const long whole = table->cells != NULL && held ? count - count % BLOCK : 0;
    nt_status first = NT_OK;
    for (long i = 0; i < whole; i += BLOCK) {
        const double *in = indentation + i;
        const int found = query->tier == NT_TIER_TABLE ? table_find(table, query->branch, in, force + i)
                                                       : polished_find(table, query->branch, in, force + i);
        const nt_status status = found ? NT_OK : one_by_one(table, query, in, force + i, BLOCK);
        first = first == NT_OK ? status : first;
    }
    const nt_status status = one_by_one(table, query, indentation + whole, force + whole, count - whole);
    return first == NT_OK ? status : first;
}

nt_status nt_maugis_table_force_n(const nt_maugis_table *table, nt_branch branch, const double *indentation,
                                  double *force, long count)
{
    const nt_maugis_query query = {NT_TIER_TABLE, branch};
    return force_n(table, &query, indentation, force, count);
}

nt_status nt_maugis_table_polish_n(const nt_maugis_table *table, nt_branch branch, const double *indentation,
                                   double *force, long count)
{
    const nt_maugis_query query = {NT_TIER_POLISHED, branch};
    return force_n(table, &query, indentation, force, count);
}

nt_status nt_maugis_table_eval_n(const nt_maugis_table *table, nt_tier tier, nt_branch branch, const nt_strided *arrays)
{
    nt_status first = NT_OK;
    for (long i = 0; i < arrays->count; i++) {
        nt_law_value value = {NAN, NAN, NAN, NAN};
        const double indentation = arrays->in[i * arrays->in_stride];
        const nt_status status = nt_maugis_table_eval(table, tier, indentation, branch, &value);
        first = first == NT_OK ? status : first;
        nt_strided_store(arrays, i, value);
    }
    return first;
}
