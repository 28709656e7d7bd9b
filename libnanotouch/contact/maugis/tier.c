/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale at one indentation, in tiers: see maugis.h. */
#include <math.h>
#include <stddef.h>

#include "contact/maugis/place.h"
#include "contact/maugis/solve.h"
#include "contact/maugis_table.h"
#include "contact/reduced.h"
#include "internal/contact.h"
#include "internal/maugis.h"

/* What the table does not cover, or has in closed form. */
static nt_status exact_eval(const nt_maugis_table *table, double indentation, nt_branch branch, nt_law_value *value)
{
    return nt_maugis_eval(&table->maugis, indentation, branch, value, NULL);
}

static int is_tabulated(const nt_maugis_table *table, double indentation, nt_branch branch)
{
    const int held = branch == NT_BRANCH_STABLE || branch == NT_BRANCH_APPROACH;
    return held && table->cells != NULL && indentation <= table->largest_indentation;
}

static nt_maugis_rough rough_of(const nt_maugis_polish *polish, const nt_maugis_cell *cell, nt_maugis_place place,
                                double indentation)
{
    nt_maugis_rough rough = nt_maugis_rough_of(polish, cell, place);
    rough.d = indentation / polish->unit;
    return rough;
}

#define RESOLVED 1e-2 /* the Z above which what is left of it is no rounding */

/* All of it at rounding level takes a second evaluation, at the corrected y; what is left of d goes to first order:
 * dk/dZ = (P_ZZ/2 - k)/Z of k = P_Z/(2 Z). */
static nt_law_value polished_value(const nt_maugis_table *table, const nt_maugis_cell *cell, nt_maugis_place place,
                                   double indentation)
{
    const nt_maugis_polish polish = nt_maugis_polish_of(table);
    const nt_maugis_rough rough = rough_of(&polish, cell, place, indentation);
    const double s = place.s, Zs = polish.Zs;
    const double y_Z = ((double)cell->y[1] + s * (2.0 * (double)cell->y[2] + s * 3.0 * (double)cell->y[3])) / Zs;
    const double y_ZZ = (2.0 * (double)cell->y[2] + s * 6.0 * (double)cell->y[3]) / (Zs * Zs);
    nt_maugis_equilibrium at;
    nt_maugis_equilibrium_at(polish.lambda, rough.y, &at);
    const double dZ = nt_maugis_polish_step(&polish, &rough, &at);
    const double y = rough.y + dZ * (y_Z + 0.5 * y_ZZ * dZ);
    nt_maugis_equilibrium_at(polish.lambda, y, &at);
    const double rest = nt_maugis_polish_step(&polish, &rough, &at);
    const double k = at.P1 / at.d1, k_Z = rough.Z < RESOLVED ? 0.0 : (0.5 * rough.P_ZZ - k) / rough.Z;
    const double slope = rough.Z < polish.near ? rough.P_Z : 2.0 * (rough.Z - rest) * k;
    const nt_law_value reduced = {
        .U = nt_maugis_equilibrium_energy(polish.lambda, &at) + at.P * (rough.d - at.d),
        .F = at.P + slope * rest,
        .k = k + k_Z * rest,
        .a = at.a + at.a1 * y_Z * rest,
    };
    const nt_reduced_units units = {table->maugis.load_scale, table->maugis.radius_scale, polish.unit};
    nt_law_value value = nt_reduced_to_si(&reduced, &units);
    if (rough.Z < polish.near)
        value.k = nt_maugis_cell_value(cell, place, table->rate, table->start).k;
    return value;
}

nt_status nt_maugis_table_eval(const nt_maugis_table *table, nt_tier tier, double indentation, nt_branch branch,
                               nt_law_value *value)
{
    if (tier != NT_TIER_TABLE && tier != NT_TIER_POLISHED && tier != NT_TIER_EXACT)
        return NT_E_ARGUMENT;
    if (tier == NT_TIER_EXACT || isinf(indentation) || !is_tabulated(table, indentation, branch))
        return exact_eval(table, indentation, branch, value);
    const nt_maugis_grid grid = nt_maugis_grid_of(table, branch);
    const nt_maugis_place place = nt_maugis_place_of(&grid, indentation);
    const nt_maugis_cell *cell = &table->cells[place.cell];
    if (place.cell < NT_CELL_CONTACT) {
        const nt_status status = exact_eval(table, indentation, branch, value);
        if (status == NT_OK)
            value->F = nt_cubic(cell->F, place.s);
        return status;
    }
    *value = tier == NT_TIER_TABLE ? nt_maugis_cell_value(cell, place, table->rate, table->start)
                                   : polished_value(table, cell, place, indentation);
    return NT_OK;
}

nt_status nt_maugis_force_find(const nt_maugis_table *table, const nt_maugis_query *query, double indentation,
                               double *force)
{
    if (!is_tabulated(table, indentation, query->branch)) {
        nt_law_value value;
        const nt_status status = exact_eval(table, indentation, query->branch, &value);
        if (status == NT_OK)
            *force = value.F;
        return status;
    }
    const nt_maugis_grid grid = nt_maugis_grid_of(table, query->branch);
    const nt_maugis_place place = nt_maugis_place_of(&grid, indentation);
    const nt_maugis_cell *cell = &table->cells[place.cell];
    *force = nt_cubic(cell->F, place.s);
    if (query->tier == NT_TIER_POLISHED && place.cell >= NT_CELL_CONTACT) {
        const nt_maugis_polish polish = nt_maugis_polish_of(table);
        const nt_maugis_rough rough = rough_of(&polish, cell, place, indentation);
        *force = polish.load * nt_maugis_polished_load(&polish, &rough);
    }
    return NT_OK;
}

double nt_maugis_table_force(const nt_maugis_table *table, double indentation)
{
    const nt_maugis_query query = {NT_TIER_TABLE, NT_BRANCH_STABLE};
    double force = NAN;
    (void)nt_maugis_force_find(table, &query, indentation, &force);
    return force;
}

double nt_maugis_table_polish(const nt_maugis_table *table, double indentation)
{
    const nt_maugis_query query = {NT_TIER_POLISHED, NT_BRANCH_STABLE};
    double force = NAN;
    (void)nt_maugis_force_find(table, &query, indentation, &force);
    return force;
}
