/* SPDX-License-Identifier: BSD-3-Clause
 * Tables of Maugis-Dugdale: their grid, and their error against the exact branch.
 *
 * On the contact branch load and radius are smooth functions of Z = sqrt(d - d_start), with d_start the fold or, where
 * that is not in contact, the end a = 0: both are square roots of d - d_start there. Far up P ~ Z^3 and a ~ Z. So cells
 * of equal width in log(1 + Z/Zs) serve, and with u = 1 + Z/Zs the exponent and leading bits of u name the cell.
 How the
 * cells are made: maugis_cells.c. */
#include <stddef.h>

#include "contact/maugis/cells.h"
#include "contact/maugis_table.h"
#include "internal/contact.h"
#include "internal/maugis.h"
#include "nanotouch/material.h"

#define DEFAULT_REACH 1000.0 /* reduced */

enum { MAX_CELLS_PER_OCTAVE = 64, MANTISSA_BITS = 52, CHECKS = 3, SLOPE_CHECKS = 7 };

/* The worst of CHECKS states per cell is measured; between them the error can be a little larger. */
#define BETWEEN_CHECKS 1.25

/* Indentation scales from a fold, within which its conditioning and not the polish is measured. */
#define AWAY_FROM_FOLD 1e-4
/* And within which rounding of the indentation, and not the table, is measured in k: it does eps/(2 of this) there. */
#define BESIDE_FOLD 1e-8

/* Maugis-Dugdale to Lennard-Jones, in pull-off force, worst over lambda (docs/evidence/contact.md). */
#define MODEL_ERROR 0.056

static int log2_of(int cells_per_octave)
{
    for (int k = 0; 1 << k <= MAX_CELLS_PER_OCTAVE; k++)
        if (1 << k == cells_per_octave)
            return k;
    return -1;
}

/* The grid without its cells; count = 0 for invalid options. */
static nt_maugis_table grid_of(const nt_maugis *maugis, const nt_maugis_table_options *options)
{
    nt_maugis_table table = {.maugis = *maugis};
    const int k = log2_of(options->cells_per_octave);
    if (k < 0 || !isfinite(options->largest_indentation) || !(options->largest_indentation >= 0.0))
        return table;
    nt_maugis_equilibrium start;
    nt_maugis_equilibrium_at(maugis->lambda, maugis->fold_y, &start);
    const double unit = maugis->indentation_scale, reach = fmax(start.d, 0.0) + DEFAULT_REACH;
    table.start = start.d * unit;
    table.largest_indentation = options->largest_indentation > 0.0 ? options->largest_indentation : reach * unit;
    table.rate = 1.0 / (nt_maugis_cell_scale(maugis, options->cells_per_octave) * sqrt(unit));
    table.shift = MANTISSA_BITS - k;
    const double u = 1.0 + sqrt(fmax(table.largest_indentation - table.start, 0.0)) * table.rate;
    const uint64_t end = (nt_bits_of(u) >> table.shift) + 1;
    table.u_end = nt_double_of(end << table.shift);
    table.count = (int)(end - (nt_bits_of(1.0) >> table.shift)) + NT_CELL_CONTACT + 1;
    return table;
}

nt_maugis_table_options nt_maugis_table_defaults(void)
{
    return (nt_maugis_table_options){.cells_per_octave = 8, .largest_indentation = 0.0};
}

int nt_maugis_table_cells(const nt_maugis *maugis, const nt_maugis_table_options *options)
{
    return maugis->load_scale == 0.0 ? 0 : grid_of(maugis, options).count;
}

/* P = -pi/2 lambda (c* + sqrt(2) Z)^2, a parabola in Z = sqrt(d - d_grip) [m^1/2] */
static void attracted_fill(const nt_maugis *maugis, nt_maugis_cell *cell)
{
    if (maugis->folds.grip_in_contact)
        return;
    const double c = 8.0 / (3.0 * NT_PI) * maugis->lambda, factor = -0.5 * NT_PI * maugis->lambda * maugis->load_scale;
    const double root = sqrt(2.0 / maugis->indentation_scale);
    cell->F[0] = factor * c * c;
    cell->F[1] = factor * 2.0 * c * root;
    cell->F[2] = factor * root * root;
}

static nt_status cells_fill(const nt_maugis_table *table, nt_maugis_cell *cells)
{
    nt_maugis_builder builder;
    nt_status status = NT_OK;
    nt_maugis_builder_start(&builder, table);
    for (int i = NT_CELL_CONTACT; i < table->count - 1 && status == NT_OK; i++)
        status = nt_maugis_builder_next(&builder, &cells[i]);
    cells[NT_CELL_APART] = cells[NT_CELL_ATTRACTED] = (nt_maugis_cell){.U = 0.0};
    attracted_fill(&table->maugis, &cells[NT_CELL_ATTRACTED]);
    cells[table->count - 1] = (nt_maugis_cell){.F = {NAN, NAN, NAN, NAN}, .u = table->u_end};
    return status;
}

/* The error of a force in the norm of nt_accuracy. */
static double error_of(double force, double exact, double pull_off)
{
    return fabs(force - exact) / fmax(fabs(exact), pull_off);
}

/* Both tiers against the exact branch, which is explicit in y: nothing has to be solved. */
static void measure(nt_maugis_table *table)
{
    const nt_maugis *maugis = &table->maugis;
    const double pull_off = nt_maugis_pull_off_force(maugis), unit = maugis->indentation_scale;
    const nt_maugis_grid grid = nt_maugis_grid_of(table, NT_BRANCH_STABLE);
    double worst[2] = {0.0, 0.0};
    for (int i = NT_CELL_CONTACT; i < table->count - 1; i++)
        for (int j = 0; j < CHECKS; j++) {
            const nt_maugis_cell *cell = &table->cells[i];
            const double s = (cell[1].u - cell->u) * (j + 0.5) / CHECKS;
            nt_maugis_equilibrium point;
            nt_maugis_equilibrium_at(maugis->lambda, maugis->fold_y + nt_cubic_y(cell->y, s), &point);
            const double exact = point.P * maugis->load_scale, indentation = point.d * unit;
            const nt_maugis_place place = nt_maugis_place_of(&grid, indentation); /* the last cell may go deeper */
            const double force[2] = {nt_cubic(table->cells[place.cell].F, place.s),
                                     nt_maugis_table_polish(table, indentation)};
            const int away = indentation - table->start > AWAY_FROM_FOLD * unit;
            for (int tier = NT_TIER_TABLE; tier <= (away ? NT_TIER_POLISHED : NT_TIER_TABLE); tier++)
                worst[tier] = fmax(worst[tier], error_of(force[tier], exact, pull_off));
        }
    for (int tier = NT_TIER_TABLE; tier <= NT_TIER_POLISHED; tier++)
        table->accuracy[tier] = (nt_accuracy){.force_error = BETWEEN_CHECKS * worst[tier], .model_error = MODEL_ERROR};
}

nt_status nt_maugis_table_init(nt_maugis_table *table, const nt_maugis *maugis, const nt_maugis_table_options *options,
                               nt_maugis_cell *cells, int capacity)
{
    const nt_maugis_table_options defaults = nt_maugis_table_defaults();
    nt_maugis_table made = {.maugis = *maugis};
    if (maugis->load_scale > 0.0) {
        made = grid_of(maugis, options != NULL ? options : &defaults);
        if (made.count == 0)
            return NT_E_RANGE;
        if (made.count > capacity)
            return NT_E_CAPACITY;
        const nt_status status = cells_fill(&made, cells);
        if (status != NT_OK)
            return status;
        made.cells = cells;
        measure(&made);
    }
    *table = made;
    return NT_OK;
}

/* Stiffness and radius of the table, where a cubic that takes value and slope at both ends of its cell has them worst:
 * k at its start (divided by Z, which is 0 there in the first cell), at (1 -+ 1/sqrt 3)/2 and at its end, a in its
 * middle. At a fold k goes as 1/Z and both divide by the same Z, so that its relative error is that of dF/dZ. */
nt_table_error nt_maugis_table_error(const nt_maugis_table *table)
{
    static const double within[SLOPE_CHECKS] = {0.01, 0.2113, 0.35, 0.5, 0.65, 0.7887, 0.99};
    const nt_maugis *maugis = &table->maugis;
    const nt_maugis_grid grid = nt_maugis_grid_of(table, NT_BRANCH_STABLE);
    const double unit = maugis->indentation_scale, hardness = maugis->load_scale / unit;
    const double least_a = maugis->folds.zero_load_radius * maugis->radius_scale;
    double k_worst = 0.0, a_worst = 0.0;
    for (int i = NT_CELL_CONTACT; i < table->count - 1; i++)
        for (int j = 0; j < SLOPE_CHECKS; j++) {
            const nt_maugis_cell *cell = &table->cells[i];
            nt_maugis_equilibrium point;
            nt_maugis_equilibrium_at(maugis->lambda,
                                     maugis->fold_y + nt_cubic_y(cell->y, within[j] * (cell[1].u - cell->u)), &point);
            const double k = point.P1 / point.d1 * hardness, a = point.a * maugis->radius_scale, d = point.d * unit;
            const nt_maugis_place place = nt_maugis_place_of(&grid, d);
            const nt_law_value value =
                nt_maugis_cell_value(&table->cells[place.cell], place, table->rate, table->start);
            if (d - table->start < BESIDE_FOLD * fabs(table->start))
                continue;
            k_worst = fmax(k_worst, fabs(value.k - k) / fmax(fabs(k), hardness));
            a_worst = fmax(a_worst, fabs(value.a - a) / fmax(a, least_a));
        }
    return (nt_table_error){BETWEEN_CHECKS * k_worst, BETWEEN_CHECKS * a_worst};
}
