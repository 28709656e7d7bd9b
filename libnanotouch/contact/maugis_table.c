/* SPDX-License-Identifier: BSD-3-Clause
 * Tables of Maugis-Dugdale and their evaluation at one indentation.
 *
 * On the contact branch load and radius are smooth functions of Z = sqrt(d - d_start), with d_start the fold or, where
 * that is not in contact, the end a = 0: both are square roots of d - d_start there. Far up P ~ Z^3 and a ~ Z. So cells
 * of equal width in log(1 + Z/Zs) serve, and with u = 1 + Z/Zs the exponent and leading bits of u name the cell.
 *
 * Zs is the scale on which the branch leaves its fold. With d - d_start = a2 v^2 + a3 v^3 + .., v = y - y_start, it is
 * a2^1.5/a3: it vanishes at lambda = 0.9379, where fold and end meet.
 *
 * In each cell a cubic takes value and slope at both ends (Hermite), so that force and stiffness are continuous; the
 * slopes are those of the exact branch, at the fold by its second derivative. */
#include <float.h>
#include <stddef.h>

#include "contact/maugis_place.h"
#include "contact/maugis_solve.h"
#include "nanotouch/material.h"

#define DEFAULT_REACH 1000.0 /* reduced */
#define SCALE_FRACTION 0.25  /* Zs in units of a2^1.5/a3 */
#define SCALE_MAX 0.25       /* with it the worst error over lambda is 1.3e-6; more costs error, less costs cells */
#define SCALE_MIN 1e-6       /* times the cells per octave: what a double of d still resolves at the first border */

enum { MAX_CELLS_PER_OCTAVE = 64, MANTISSA_BITS = 52, CHECKS = 3 };

/* The worst of CHECKS states per cell is measured; between them the error can be a little larger. */
#define BETWEEN_CHECKS 1.25

/* Indentation scales from a fold, within which its conditioning and not the polish is measured. */
#define AWAY_FROM_FOLD 1e-4

/* Maugis-Dugdale to Lennard-Jones, in pull-off force, worst over lambda (docs/contact.md). */
#define MODEL_ERROR 0.056

/* A border of cells. */
typedef struct {
    double Z;
    double P, a, y;       /* reduced; y above that at the start */
    double P_Z, a_Z, y_Z; /* their slopes */
    double U;
} border;

static int log2_of(int cells_per_octave)
{
    for (int k = 0; 1 << k <= MAX_CELLS_PER_OCTAVE; k++)
        if (1 << k == cells_per_octave)
            return k;
    return -1;
}

/* Zs; slope is dZ/dy at the start. */
static double scale_of(double lambda, const nt_maugis_equilibrium *start, int cells_per_octave, double *slope)
{
    const double bend = nt_maugis_equilibrium_curvature(lambda, start);
    const double a2 = 0.5 * (start->y > 0.0 ? start->y * bend : start->d1), a3 = bend / 3.0;
    *slope = sqrt(a2);
    return fmax(fmin(SCALE_MAX, SCALE_FRACTION * a2 * *slope / fabs(a3)), SCALE_MIN * cells_per_octave);
}

/* The grid without its cells; count = 0 for invalid options. */
static nt_maugis_table grid_of(const nt_maugis *maugis, const nt_maugis_table_options *options, double *slope)
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
    table.rate = 1.0 / (scale_of(maugis->lambda, &start, options->cells_per_octave, slope) * sqrt(unit));
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
    double slope;
    return maugis->load_scale == 0.0 ? 0 : grid_of(maugis, options, &slope).count;
}

static nt_status border_find(const nt_maugis *maugis, const nt_maugis_equilibrium *start, double slope, border *at)
{
    nt_maugis_equilibrium point = *start;
    double y_Z = 1.0 / slope;
    if (at->Z > 0.0) {
        const nt_maugis_goal goal = {NT_GIVEN_INDENTATION, start->d + at->Z * at->Z, start, 0, at->y + start->y};
        const nt_status status = nt_maugis_point_find(maugis->lambda, &goal, &point, NULL);
        if (status != NT_OK)
            return status;
        y_Z = 2.0 * at->Z / (point.y * point.d1);
    }
    at->P = point.P;
    at->a = point.a;
    at->y = point.y - start->y;
    at->P_Z = point.y * point.P1 * y_Z;
    at->a_Z = point.a1 * y_Z;
    at->y_Z = y_Z;
    return NT_OK;
}

/* Value and slope at both ends of a cell of a width. */
static void hermite(const double value[2], const double slope[2], double width, double c[4])
{
    const double mean = (value[1] - value[0]) / width;
    c[0] = value[0];
    c[1] = slope[0];
    c[2] = (3.0 * mean - 2.0 * slope[0] - slope[1]) / width;
    c[3] = (slope[0] + slope[1] - 2.0 * mean) / (width * width);
}

/* The integral of F d(delta) from the start of a cell, with delta = delta_start + ((u - 1)/rate)^2. */
static double work(const nt_maugis_cell *cell, double s, double rate)
{
    const double *c = cell->F, w = cell->u - 1.0;
    const double sum =
        w * c[0] + s * ((c[0] + w * c[1]) / 2.0 +
                        s * ((c[1] + w * c[2]) / 3.0 + s * ((c[2] + w * c[3]) / 4.0 + s * (c[3] / 5.0))));
    return 2.0 * s * sum / (rate * rate);
}

static void cell_fill(const nt_maugis_table *table, const border ends[2], double width, nt_maugis_cell *cell)
{
    const double Zs = 1.0 / (table->rate * sqrt(table->maugis.indentation_scale));
    const double load = table->maugis.load_scale, radius = table->maugis.radius_scale;
    double c[4];
    hermite((double[]){ends[0].P * load, ends[1].P * load},
            (double[]){ends[0].P_Z * Zs * load, ends[1].P_Z * Zs * load}, width, cell->F);
    hermite((double[]){ends[0].a * radius, ends[1].a * radius},
            (double[]){ends[0].a_Z * Zs * radius, ends[1].a_Z * Zs * radius}, width, cell->a);
    hermite((double[]){ends[0].y, ends[1].y}, (double[]){ends[0].y_Z * Zs, ends[1].y_Z * Zs}, width, c);
    for (int i = 0; i < 4; i++)
        cell->y[i] = (float)c[i];
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

static nt_status cells_fill(const nt_maugis_table *table, double slope, nt_maugis_cell *cells)
{
    const nt_maugis *maugis = &table->maugis;
    const uint64_t first = nt_bits_of(1.0) >> table->shift;
    const double Zs = 1.0 / (table->rate * sqrt(maugis->indentation_scale));
    nt_maugis_equilibrium start;
    nt_maugis_equilibrium_at(maugis->lambda, maugis->fold_y, &start);
    border ends[2] = {{.Z = 0.0}};
    nt_status status = border_find(maugis, &start, slope, &ends[0]);
    double U = nt_maugis_equilibrium_energy(maugis->lambda, &start) * maugis->load_scale * maugis->indentation_scale;
    for (int i = NT_CELL_CONTACT; i < table->count - 1 && status == NT_OK; i++) {
        const uint64_t name = first + (uint64_t)(i - NT_CELL_CONTACT);
        const double u = nt_double_of(name << table->shift), next = nt_double_of((name + 1) << table->shift);
        ends[1] = (border){.Z = (next - 1.0) * Zs};
        ends[1].y = i == NT_CELL_CONTACT ? ends[0].y_Z * ends[1].Z : nt_cubic_y(cells[i - 1].y, next - cells[i - 1].u);
        status = border_find(maugis, &start, slope, &ends[1]);
        cells[i] = (nt_maugis_cell){.u = u, .U = U};
        cell_fill(table, ends, next - u, &cells[i]);
        U += work(&cells[i], next - u, table->rate);
        ends[0] = ends[1];
    }
    cells[NT_CELL_APART] = cells[NT_CELL_ATTRACTED] = (nt_maugis_cell){.U = 0.0};
    attracted_fill(maugis, &cells[NT_CELL_ATTRACTED]);
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
    double worst[2] = {0.0, 0.0};
    for (int i = NT_CELL_CONTACT; i < table->count - 1; i++)
        for (int j = 0; j < CHECKS; j++) {
            const nt_maugis_cell *cell = &table->cells[i];
            const double s = (cell[1].u - cell->u) * (j + 0.5) / CHECKS;
            nt_maugis_equilibrium point;
            nt_maugis_equilibrium_at(maugis->lambda, maugis->fold_y + nt_cubic_y(cell->y, s), &point);
            const double exact = point.P * maugis->load_scale, indentation = point.d * unit;
            const double force[2] = {nt_maugis_table_force(table, indentation),
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
    double slope;
    nt_maugis_table made = {.maugis = *maugis};
    if (maugis->load_scale > 0.0) {
        made = grid_of(maugis, options != NULL ? options : &defaults, &slope);
        if (made.count == 0)
            return NT_E_RANGE;
        if (made.count > capacity)
            return NT_E_CAPACITY;
        const nt_status status = cells_fill(&made, slope, cells);
        if (status != NT_OK)
            return status;
        made.cells = cells;
        measure(&made);
    }
    *table = made;
    return NT_OK;
}
