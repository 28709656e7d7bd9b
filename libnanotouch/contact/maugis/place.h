/* SPDX-License-Identifier: BSD-3-Clause
 * Where an indentation lies in a table of Maugis-Dugdale; private to contact/. One text for the scalar functions and
 * the array kernels, so that both give the same bits. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_PLACE_H
#define NANOTOUCH_CONTACT_MAUGIS_PLACE_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "contact/maugis/functions.h"
#include "contact/reduced.h"
#include "nanotouch/advanced/maugis.h"

/* How a force is wanted. */
typedef struct nt_maugis_query {
    nt_tier tier;
    nt_branch branch;
} nt_maugis_query;

/* Force alone, in the tier TABLE or POLISHED; the exact solver where the table does not reach. */
nt_status nt_maugis_force_find(const nt_maugis_table *table, const nt_maugis_query *query, double indentation,
                               double *force);

/* The cells in front of the tabulated contact. */
enum { NT_CELL_APART, NT_CELL_ATTRACTED, NT_CELL_CONTACT };

/* What the lookup needs of a table. */
typedef struct nt_maugis_grid {
    double first; /* apart below it: the onset on approach, the fold on retraction [m] */
    double start; /* contact from it [m] */
    double grip;  /* where Z of the attracted state is counted from [m] */
    double rate, u_end;
    uint64_t mask; /* the bits of u that name a cell */
    int64_t bias;  /* those bits, shifted, of the cell NT_CELL_CONTACT at u = 1, less its index */
    int shift;
} nt_maugis_grid;

static inline uint64_t nt_bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline double nt_double_of(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline nt_maugis_grid nt_maugis_grid_of(const nt_maugis_table *table, nt_branch branch)
{
    const nt_maugis *maugis = &table->maugis;
    const double grip = maugis->folds.grip_indentation * maugis->indentation_scale;
    const double onset = maugis->folds.onset_indentation * maugis->indentation_scale;
    return (nt_maugis_grid){
        .first = branch == NT_BRANCH_APPROACH && onset > grip ? onset : grip,
        .start = table->start,
        .grip = grip,
        .rate = table->rate,
        .u_end = table->u_end,
        .mask = ~(((uint64_t)1 << table->shift) - 1),
        .bias = (int64_t)(nt_bits_of(1.0) >> table->shift) - NT_CELL_CONTACT,
        .shift = table->shift,
    };
}

typedef struct nt_maugis_place {
    int64_t cell;
    double s; /* variable of the cell */
    double Z; /* sqrt(indentation - start of its branch) [m^1/2] */
} nt_maugis_place;

/* NaN keeps to s and so to every result; beyond the end is the last cell, which is NaN. */
static inline nt_maugis_place nt_maugis_place_of(const nt_maugis_grid *grid, double indentation)
{
    const int64_t held = -(int64_t)(indentation >= grid->first),
                  contact = held & -(int64_t)(indentation >= grid->start);
    double above = indentation - (contact ? grid->start : grid->grip);
    above = above < 0.0 ? 0.0 : above;
    const double Z = sqrt(above);
    double u = 1.0 + Z * grid->rate;
    u = u < grid->u_end ? u : grid->u_end;
    const uint64_t bits = nt_bits_of(u);
    return (nt_maugis_place){
        .cell = contact ? (int64_t)(bits >> grid->shift) - grid->bias : -held,
        .s = contact ? u - nt_double_of(bits & grid->mask) : Z,
        .Z = Z,
    };
}

/* In pairs: a shorter chain than Horner's. */
static inline double nt_cubic(const double c[4], double s)
{
    return (c[0] + s * c[1]) + s * s * (c[2] + s * c[3]);
}

/* U is the integral of F d(delta), delta = delta_start + Z^2, Z = (u - 1)/rate; k is dF/dZ/(2 Z). In the first cell the
 * parts of dF/dZ that are of the order of Z are divided on their own, so that k has its limit at a = 0; at a fold it is
 * infinite and reported at the nearest distance that a double resolves. */
static inline nt_law_value nt_maugis_cell_value(const nt_maugis_cell *cell, nt_maugis_place place, double rate,
                                                double start)
{
    const double s = place.s, *c = cell->F, w = cell->u - 1.0;
    const double sum =
        w * c[0] + s * ((c[0] + w * c[1]) / 2.0 +
                        s * ((c[1] + w * c[2]) / 3.0 + s * ((c[2] + w * c[3]) / 4.0 + s * (c[3] / 5.0))));
    const double resolved = NT_FOLD_RESOLUTION * sqrt(fabs(start)), Z = place.Z > resolved ? place.Z : resolved;
    const double bend = 2.0 * c[2] + 3.0 * c[3] * s;
    const double rise = w == 0.0 ? c[1] : c[1] + s * bend, limit = w == 0.0 ? rate * bend : 0.0;
    return (nt_law_value){
        .U = cell->U + 2.0 * s * sum / (rate * rate),
        .F = nt_cubic(c, s),
        .k = 0.5 * rate * (rise / Z + limit),
        .a = nt_cubic(cell->a, s),
    };
}

/* y above its value at the start of the table. */
static inline double nt_cubic_y(const float c[4], double s)
{
    return (double)c[0] + s * ((double)c[1] + s * ((double)c[2] + s * (double)c[3]));
}

/* What polishing needs of a table besides; reduced but for the scales. */
typedef struct nt_maugis_polish {
    double lambda, y_start, d_start;
    double load, unit, root; /* load scale [N], indentation scale [m] and its root */
    double Zs;
    double near; /* the Z below which the slope of the table is the better one */
} nt_maugis_polish;

static inline nt_maugis_polish nt_maugis_polish_of(const nt_maugis_table *table)
{
    const nt_maugis *maugis = &table->maugis;
    const double root = sqrt(maugis->indentation_scale), Zs = 1.0 / (table->rate * root);
    return (nt_maugis_polish){
        .lambda = maugis->lambda,
        .y_start = maugis->fold_y,
        .d_start = maugis->folds.grip_in_contact ? maugis->folds.grip_indentation : maugis->folds.touch_indentation,
        .load = maugis->load_scale,
        .unit = maugis->indentation_scale,
        .root = root,
        .Zs = Zs,
        .near = maugis->folds.grip_in_contact ? 1e-3 * Zs : 0.0,
    };
}

/* What the table says of a place in contact: reduced, with derivatives by Z. */
typedef struct nt_maugis_rough {
    double d, Z;
    double y;
    double P_Z, P_ZZ;
} nt_maugis_rough;

static inline nt_maugis_rough nt_maugis_rough_of(const nt_maugis_polish *polish, const nt_maugis_cell *cell,
                                                 nt_maugis_place place)
{
    const double s = place.s, *F = cell->F, per_Z = 1.0 / polish->Zs;
    return (nt_maugis_rough){
        .Z = place.Z / polish->root,
        .y = polish->y_start + nt_cubic_y(cell->y, s),
        .P_Z = (F[1] + s * (2.0 * F[2] + s * 3.0 * F[3])) * per_Z / polish->load,
        .P_ZZ = (2.0 * F[2] + s * 6.0 * F[3]) * per_Z * per_Z / polish->load,
    };
}

/* The difference in Z from an exact state to where the load is wanted. */
static inline double nt_maugis_polish_step(const nt_maugis_polish *polish, const nt_maugis_rough *rough,
                                           const nt_maugis_equilibrium *at)
{
    const double above = at->d - polish->d_start, sum = rough->Z + sqrt(above < 0.0 ? 0.0 : above);
    return (rough->d - at->d) / (sum > 1e-150 ? sum : 1e-150); /* both at the fold: 0 */
}

/* The load at d: one exact evaluation at the y of the table, from there second order in Z, in which the branch is
 * smooth also at its fold. The slope of the exact branch is 0/0 at the fold; next to it the table's is as good. */
static inline double nt_maugis_polished_load(const nt_maugis_polish *polish, const nt_maugis_rough *rough)
{
    const nt_maugis_equilibrium at = nt_maugis_equilibrium_of(polish->lambda, nt_maugis_functions_at(rough->y));
    const double dZ = nt_maugis_polish_step(polish, rough, &at);
    const double slope = 2.0 * (rough->Z - dZ) * at.P1 / at.d1;
    const double P_Z = rough->Z < polish->near ? rough->P_Z : slope;
    return at.P + dZ * (P_Z + 0.5 * rough->P_ZZ * dZ);
}

#endif
