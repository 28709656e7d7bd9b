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
#include "internal/maugis.h"

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

/* Four numbers of each of four cells, from this offset on; column j of the result holds number j of each. */
static inline void transpose(const nt_maugis_cell *const from[4], size_t offset, four to[4])
{
    four q0, q1, q2, q3;
    memcpy(&q0, (const char *)from[0] + offset, sizeof q0);
    memcpy(&q1, (const char *)from[1] + offset, sizeof q1);
    memcpy(&q2, (const char *)from[2] + offset, sizeof q2);
    memcpy(&q3, (const char *)from[3] + offset, sizeof q3);
    const four even_01 = __builtin_shufflevector(q0, q1, 0, 4, 2, 6),
               odd_01 = __builtin_shufflevector(q0, q1, 1, 5, 3, 7);
    const four even_23 = __builtin_shufflevector(q2, q3, 0, 4, 2, 6),
               odd_23 = __builtin_shufflevector(q2, q3, 1, 5, 3, 7);
    to[0] = __builtin_shufflevector(even_01, even_23, 0, 1, 4, 5);
    to[1] = __builtin_shufflevector(odd_01, odd_23, 0, 1, 4, 5);
    to[2] = __builtin_shufflevector(even_01, even_23, 2, 3, 6, 7);
    to[3] = __builtin_shufflevector(odd_01, odd_23, 2, 3, 6, 7);
}

/* Cubics of four cells at once. */
static inline void cubics(const nt_maugis_cell *cells, const int64_t cell[4], const double s[4], double force[4])
{
    const nt_maugis_cell *const from[] = {&cells[cell[0]], &cells[cell[1]], &cells[cell[2]], &cells[cell[3]]};
    four c[4], x;
    transpose(from, offsetof(nt_maugis_cell, F), c);
    memcpy(&x, s, sizeof x);
    const four result = (c[0] + x * c[1]) + x * x * (c[2] + x * c[3]); /* as nt_cubic */
    memcpy(force, &result, sizeof result);
}

/* The same numbers into four arrays of a block that follow each other. */
static inline void gather(const nt_maugis_cell *const from[4], size_t offset, double *to)
{
    four c[4];
    transpose(from, offset, c);
    memcpy(to, &c[0], sizeof c[0]); /* a loop of four is not unrolled, and c then stands in memory */
    memcpy(to + BLOCK, &c[1], sizeof c[1]);
    memcpy(to + 2 * BLOCK, &c[2], sizeof c[2]);
    memcpy(to + 3 * BLOCK, &c[3], sizeof c[3]);
}
#else
static inline void cubics(const nt_maugis_cell *cells, const int64_t cell[4], const double s[4], double force[4])
{
    for (int i = 0; i < 4; i++)
        force[i] = nt_cubic(cells[cell[i]].F, s[i]);
}

static inline void gather(const nt_maugis_cell *const from[4], size_t offset, double *to)
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            memcpy(&to[j * BLOCK + i], (const char *)from[i] + offset + (size_t)j * sizeof *to, sizeof *to);
}
#endif

_Static_assert(offsetof(nt_maugis_cell, u) == offsetof(nt_maugis_cell, U) + sizeof(double) &&
                   offsetof(nt_maugis_cell, U) + 4 * sizeof(double) <= sizeof(nt_maugis_cell),
               "U and u are the first two of four numbers");

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

/* {U, F, k, a} of a block. */
typedef struct {
    double U[BLOCK], F[BLOCK], k[BLOCK], a[BLOCK];
} values;

/* The numbers of the cells of a block, one array for each: gathered on their own, the rest is plain vector code. */
typedef struct {
    double F[4][BLOCK], a[4][BLOCK], rest[4][BLOCK]; /* of the rest the first two, U and u */
} cell_block;

VARIANTS static void cells_gather(const nt_maugis_cell *cells, const int64_t *cell, cell_block *restrict to)
{
    for (int i = 0; i < BLOCK; i += 4) {
        const nt_maugis_cell *from[4];
        for (int j = 0; j < 4; j++)
            from[j] = &cells[cell[i + j]];
        gather(from, offsetof(nt_maugis_cell, F), &to->F[0][i]);
        gather(from, offsetof(nt_maugis_cell, a), &to->a[0][i]);
        gather(from, offsetof(nt_maugis_cell, U), &to->rest[0][i]);
    }
}

VARIANTS static void values_fill(const block *at, const cell_block *cells, const double scales[2], values *restrict out)
{
    for (int i = 0; i < BLOCK; i++) {
        const nt_maugis_cell cell = {
            .F = {cells->F[0][i], cells->F[1][i], cells->F[2][i], cells->F[3][i]},
            .a = {cells->a[0][i], cells->a[1][i], cells->a[2][i], cells->a[3][i]},
            .U = cells->rest[0][i],
            .u = cells->rest[1][i],
        };
        const nt_maugis_place place = {.s = at->s[i], .Z = at->Z[i]};
        const nt_law_value value = nt_maugis_cell_value(&cell, place, scales[0], scales[1]);
        const int64_t apart = -(int64_t)(at->cell[i] == NT_CELL_APART);
        out->U[i] = apart ? 0.0 : value.U;
        out->F[i] = apart ? 0.0 : value.F;
        out->k[i] = apart ? 0.0 : value.k;
        out->a[i] = apart ? 0.0 : value.a;
    }
}

/* Where a block lies; 0 where some indentation lies outside the table. */
VARIANTS static int places_find(const nt_maugis_table *table, nt_branch branch, const double *in, block *restrict at)
{
    const nt_maugis_grid grid = nt_maugis_grid_of(table, branch);
    const double largest = table->largest_indentation;
    int64_t outside = 0;
    for (int i = 0; i < BLOCK; i++) {
        const nt_maugis_place place = nt_maugis_place_of(&grid, in[i]);
        at->cell[i] = place.cell;
        at->s[i] = place.s;
        at->Z[i] = place.Z;
        outside |= -(int64_t)!(in[i] <= largest);
    }
    return outside == 0;
}

static nt_status values_one_by_one(const nt_maugis_table *table, const nt_maugis_query *query, const nt_strided *arrays,
                                   long from, long count)
{
    nt_status first = NT_OK;
    for (long i = from; i < from + count; i++) {
        nt_law_value value = {NAN, NAN, NAN, NAN};
        const double indentation = arrays->in[i * arrays->in_stride];
        const nt_status status = nt_maugis_table_eval(table, query->tier, indentation, query->branch, &value);
        first = first == NT_OK ? status : first;
        nt_strided_store(arrays, i, value);
    }
    return first;
}

/* A whole block; what is attracted and not in contact has its closed form. */
static nt_status values_block(const nt_maugis_table *table, const nt_maugis_query *query, const nt_strided *arrays,
                              long from)
{
    const double scales[2] = {table->rate, table->start};
    double in[BLOCK];
    _Alignas(64) block at; /* a cache line: half of the loads would else lie on two, as chance has it */
    _Alignas(64) cell_block cells;
    _Alignas(64) values found;
    int finite = 1;
    for (int i = 0; i < BLOCK; i++) {
        in[i] = arrays->in[(from + i) * arrays->in_stride];
        finite &= isfinite(in[i]) != 0;
    }
    if (!finite || !places_find(table, query->branch, in, &at))
        return values_one_by_one(table, query, arrays, from, BLOCK);
    cells_gather(table->cells, at.cell, &cells);
    values_fill(&at, &cells, scales, &found);
    for (int i = 0; i < BLOCK; i++)
        if (at.cell[i] == NT_CELL_ATTRACTED) {
            nt_law_value value = {0};
            (void)nt_maugis_table_eval(table, query->tier, in[i], query->branch, &value);
            found.U[i] = value.U;
            found.F[i] = value.F;
            found.k[i] = value.k;
            found.a[i] = value.a;
        }
    const double *const columns[] = {found.U, found.F, found.k, found.a};
    double *const to[] = {arrays->U, arrays->F, arrays->k, arrays->a};
    for (int j = 0; j < 4; j++)
        for (int i = 0; to[j] && i < BLOCK; i++)
            to[j][(from + i) * arrays->out_stride] = columns[j][i];
    return NT_OK;
}

nt_status nt_maugis_table_eval_n(const nt_maugis_table *table, nt_tier tier, nt_branch branch, const nt_strided *arrays)
{
    const nt_maugis_query query = {tier, branch};
    const int held = branch == NT_BRANCH_STABLE || branch == NT_BRANCH_APPROACH;
    const int has_blocks = table->cells != NULL && held && tier == NT_TIER_TABLE;
    const long whole = has_blocks ? arrays->count - arrays->count % BLOCK : 0;
    nt_status first = NT_OK;
    for (long i = 0; i < whole; i += BLOCK) {
        const nt_status status = values_block(table, &query, arrays, i);
        first = first == NT_OK ? status : first;
    }
    const nt_status status = values_one_by_one(table, &query, arrays, whole, arrays->count - whole);
    return first == NT_OK ? status : first;
}
