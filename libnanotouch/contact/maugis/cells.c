/* SPDX-License-Identifier: BSD-3-Clause
 * The cells of tables of Maugis-Dugdale.
 *
 * Zs is the scale on which the branch leaves its fold. With d - d_start = a2 v^2 + a3 v^3 + .., v = y - y_start, it is
 * a2^1.5/a3: it vanishes at lambda = 0.9379, where fold and end meet.
 *
 * In each cell a cubic takes value and slope at both ends (Hermite), so that force and stiffness are continuous; the
 * slopes are those of the exact branch, at the fold by its second derivative. */
#include "contact/maugis/cells.h"

#include <math.h>
#include <stddef.h>

#define SCALE_FRACTION 0.25 /* Zs in units of a2^1.5/a3 */
#define SCALE_MAX 0.25      /* with it the worst error over lambda is 1.3e-6; more costs error, less costs cells */
#define SCALE_MIN 1e-6      /* times the cells per octave: what a double of d still resolves at the first border */

/* a2; *bend = d(d1)/dy, about 3 a3. */
static double curvature_at(double lambda, const nt_maugis_equilibrium *start, double *bend)
{
    *bend = nt_maugis_equilibrium_curvature(lambda, start);
    return 0.5 * (start->y > 0.0 ? start->y * *bend : start->d1);
}

double nt_maugis_cell_scale(const nt_maugis *maugis, int cells_per_octave)
{
    nt_maugis_equilibrium start;
    nt_maugis_equilibrium_at(maugis->lambda, maugis->fold_y, &start);
    double bend;
    const double a2 = curvature_at(maugis->lambda, &start, &bend);
    const double scale = SCALE_FRACTION * a2 * sqrt(a2) / fabs(bend / 3.0);
    return fmax(fmin(SCALE_MAX, scale), SCALE_MIN * cells_per_octave);
}

/* With y and dy/dZ there. */
static void border_set(const nt_maugis_equilibrium *start, const nt_maugis_equilibrium *point, double y_Z,
                       nt_maugis_border *at)
{
    at->P = point->P;
    at->a = point->a;
    at->y = point->y - start->y;
    at->P_Z = point->y * point->P1 * y_Z;
    at->a_Z = point->a1 * y_Z;
    at->y_Z = y_Z;
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

static void cell_fill(const nt_maugis_table *table, const nt_maugis_border ends[2], double width, nt_maugis_cell *cell)
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

void nt_maugis_builder_start(nt_maugis_builder *builder, const nt_maugis_table *table)
{
    const nt_maugis *maugis = &table->maugis;
    *builder = (nt_maugis_builder){.table = table, .name = nt_bits_of(1.0) >> table->shift};
    nt_maugis_equilibrium_at(maugis->lambda, maugis->fold_y, &builder->start);
    const nt_maugis_equilibrium *start = &builder->start;
    double bend;
    border_set(start, start, 1.0 / sqrt(curvature_at(maugis->lambda, start, &bend)), &builder->at);
    builder->U = nt_maugis_equilibrium_energy(maugis->lambda, start) * maugis->load_scale * maugis->indentation_scale;
}

nt_status nt_maugis_builder_next(nt_maugis_builder *builder, nt_maugis_cell *cell)
{
    const nt_maugis_table *table = builder->table;
    const nt_maugis_equilibrium *start = &builder->start;
    const double Zs = 1.0 / (table->rate * sqrt(table->maugis.indentation_scale));
    const double u = nt_double_of(builder->name << table->shift),
                 next = nt_double_of((builder->name + 1) << table->shift);
    nt_maugis_border ends[2] = {builder->at, {.Z = (next - 1.0) * Zs}};
    const double guess = u == 1.0 ? ends[0].y_Z * ends[1].Z : nt_cubic_y(builder->last.y, next - builder->last.u);
    const nt_maugis_goal goal = {NT_GIVEN_INDENTATION, start->d + ends[1].Z * ends[1].Z, start, 0, guess + start->y};
    nt_maugis_equilibrium point;
    const nt_status status = nt_maugis_point_find(table->maugis.lambda, &goal, &point, NULL);
    if (status != NT_OK)
        return status;
    border_set(start, &point, 2.0 * ends[1].Z / (point.y * point.d1), &ends[1]);
    *cell = (nt_maugis_cell){.u = u, .U = builder->U};
    cell_fill(table, ends, next - u, cell);
    builder->U += work(cell, next - u, table->rate);
    builder->at = ends[1];
    builder->last = *cell;
    builder->name++;
    return NT_OK;
}
