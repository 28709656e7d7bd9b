/* SPDX-License-Identifier: BSD-3-Clause
 * The panels of a bank of tables of Maugis-Dugdale: see maugis.h.
 *
 * At every border of panels five tables side by side give value and slope over v of all numbers of a cell; both panels
 * that meet there take them. */
#include "contact/maugis/bank_panels.h"

#define GAP 0.0078125   /* v below which there is no panel: 2^-7, a border of panels of every width */
#define STEP 0.00390625 /* between the tables at a border, of its v: truncation 1e-10, rounding 1e-13 of the slope */

enum { STENCIL = 5, NUMBERS = 9, CENTRE = 2 }; /* numbers of a cell: F, a, U */

double nt_bank_lambda(double distance, int above)
{
    return above ? NT_BANK_CENTRE * (1.0 + distance) : NT_BANK_CENTRE / (1.0 + distance);
}

static double start_of(const nt_maugis *maugis)
{
    return maugis->folds.grip_in_contact ? maugis->folds.grip_indentation : maugis->folds.touch_indentation;
}

/* f at v (1 + (i - 2) STEP): its slope over v, to fourth order. */
static double slope_of(const double f[STENCIL], double v)
{
    return (8.0 * (f[3] - f[1]) - (f[4] - f[0])) / (12.0 * STEP * v);
}

/* Value and slope at 0 and at 1 into the coefficients of the cubic, in place. */
static void hermite(double c[4])
{
    const double low = c[0], low_slope = c[1], high = c[2], high_slope = c[3], mean = high - low;
    c[0] = low;
    c[1] = low_slope;
    c[2] = 3.0 * mean - 2.0 * low_slope - high_slope;
    c[3] = low_slope + high_slope - 2.0 * mean;
}

void nt_bank_names(const nt_maugis_bank_options *options, int above, uint64_t names[2])
{
    const int shift = nt_bank_shift(options->panels_per_octave);
    const double near = nt_bank_distance(above ? options->lambda_min : options->lambda_max, above);
    const double far = nt_bank_distance(above ? options->lambda_max : options->lambda_min, above);
    names[0] = names[1] = nt_bits_of(GAP) >> shift;
    if (!(far > GAP))
        return;
    if (near > GAP)
        names[0] = (nt_bits_of(near) >> shift) - (nt_bits_of(near) >> shift > names[0]);
    names[1] = (nt_bits_of(far) >> shift) + 2;
}

nt_status nt_bank_rate_find(const nt_maugis_bank_options *options, int above, double *rate)
{
    uint64_t names[2];
    nt_maugis maugis;
    nt_bank_names(options, above, names);
    const double low = nt_double_of(names[0] << nt_bank_shift(options->panels_per_octave));
    const nt_status status = nt_bank_prepare(nt_bank_lambda(low, above), &maugis);
    if (status == NT_OK)
        *rate = 1.0 / nt_maugis_cell_scale(&maugis, options->cells_per_octave);
    return status;
}

nt_status nt_bank_panel_plan(const nt_maugis_bank_options *options, int above, uint64_t name, nt_maugis_panel *panel)
{
    const int shift = nt_bank_shift(options->panels_per_octave);
    const int cell_shift = nt_bank_shift(options->cells_per_octave);
    double deepest = 0.0;
    panel->low = nt_double_of(name << shift);
    panel->high = nt_double_of((name + 1) << shift);
    for (int i = 0; i < 2; i++) {
        nt_maugis maugis;
        const nt_status status = nt_bank_prepare(nt_bank_lambda(i == 0 ? panel->low : panel->high, above), &maugis);
        if (status != NT_OK)
            return status;
        deepest = fmax(deepest, NT_BANK_DEEP * options->largest_indentation - start_of(&maugis));
    }
    const uint64_t end = (nt_bits_of(1.0 + sqrt(deepest) * panel->rate) >> cell_shift) + 1;
    panel->u_end = nt_double_of(end << cell_shift);
    panel->count = (int)(end - (nt_bits_of(1.0) >> cell_shift));
    return NT_OK;
}

/* The fold: value and slope at both ends, values between, into divided differences. */
static nt_status start_fill(nt_maugis_panel *panel, int above)
{
    const double *x = nt_bank_start_nodes, width = panel->high - panel->low;
    double *f = panel->start, slopes[2];
    for (int i = 0; i < NT_BANK_START_NODES; i++) {
        const double distance = panel->low + x[i] * width;
        double near[STENCIL];
        for (int n = 0; n < STENCIL; n++) {
            nt_maugis maugis;
            const double v = distance * (1.0 + (n - CENTRE) * STEP);
            const nt_status status = nt_bank_prepare(nt_bank_lambda(v, above), &maugis);
            if (status != NT_OK)
                return status;
            near[n] = start_of(&maugis);
        }
        f[i] = near[CENTRE];
        if (x[i] == 0.0 || x[i] == 1.0)
            slopes[x[i] == 1.0] = slope_of(near, distance) * width;
    }
    for (int order = 1; order < NT_BANK_START_NODES; order++)
        for (int i = NT_BANK_START_NODES - 1; i >= order; i--) {
            const double span = x[i] - x[i - order];
            f[i] = span > 0.0 ? (f[i] - f[i - 1]) / span : slopes[x[i] == 1.0];
        }
    return NT_OK;
}

/* The tables at a border. */
typedef struct border {
    double v, rate;
    nt_maugis_table tables[STENCIL];
    nt_maugis_builder builders[STENCIL];
    nt_bank_touch touch[STENCIL]; /* 0 above lambda_0 */
} border;

static nt_status border_start(border *b, int above, int cell_shift)
{
    for (int n = 0; n < STENCIL; n++) {
        const double v = b->v * (1.0 + (n - CENTRE) * STEP);
        b->tables[n] = (nt_maugis_table){.rate = b->rate, .shift = cell_shift};
        const nt_status status = nt_bank_prepare(nt_bank_lambda(v, above), &b->tables[n].maugis);
        if (status != NT_OK)
            return status;
        nt_maugis_builder_start(&b->builders[n], &b->tables[n]);
        b->touch[n] = above ? (nt_bank_touch){0} : nt_bank_touch_at(b->tables[n].maugis.lambda);
    }
    return NT_OK;
}

/* The next cell: values of its numbers and their slopes over v. */
static nt_status border_next(border *b, double values[NUMBERS], double slopes[NUMBERS])
{
    double numbers[NUMBERS][STENCIL];
    for (int n = 0; n < STENCIL; n++) {
        nt_maugis_cell cell;
        const nt_status status = nt_maugis_builder_next(&b->builders[n], &cell);
        if (status != NT_OK)
            return status;
        const double Z = (cell.u - 1.0) / b->rate;
        cell.F[0] -= b->touch[n].P;
        for (int j = 0; j < 4; j++) {
            numbers[j][n] = cell.F[j];
            numbers[4 + j][n] = cell.a[j];
        }
        numbers[8][n] = cell.U - b->touch[n].U - b->touch[n].P * Z * Z;
    }
    for (int k = 0; k < NUMBERS; k++) {
        values[k] = numbers[k][CENTRE];
        slopes[k] = slope_of(numbers[k], b->v);
    }
    return NT_OK;
}

/* The cubic of number k of a cell. */
static double *cubic_of(nt_maugis_bank_cell *cell, int k)
{
    return k < 4 ? cell->F[k] : k < 8 ? cell->a[k - 4] : cell->U;
}

/* Between the panels `sides`, either of which may be NULL: the end of the first, the start of the second. */
static nt_status border_fill(const nt_maugis_bank_options *options, int above, nt_maugis_panel *const sides[2],
                             nt_maugis_bank_cell *cells)
{
    const nt_maugis_panel *one = sides[1] != NULL ? sides[1] : sides[0];
    border b = {.v = sides[1] != NULL ? one->low : one->high, .rate = one->rate};
    const int counts[2] = {sides[0] != NULL ? sides[0]->count : 0, sides[1] != NULL ? sides[1]->count : 0};
    nt_status status = border_start(&b, above, nt_bank_shift(options->cells_per_octave));
    for (int i = 0; (i < counts[0] || i < counts[1]) && status == NT_OK; i++) {
        double values[NUMBERS], slopes[NUMBERS];
        status = border_next(&b, values, slopes);
        for (int side = 0; side < 2 && status == NT_OK; side++) {
            if (i >= counts[side])
                continue;
            const double width = sides[side]->high - sides[side]->low;
            const int place = side == 0 ? 2 : 0;
            for (int k = 0; k < NUMBERS; k++) {
                double *c = cubic_of(&cells[sides[side]->first + i], k);
                c[place] = values[k];
                c[place + 1] = slopes[k] * width;
                if (side == 0)
                    hermite(c);
            }
        }
    }
    return status;
}

nt_status nt_bank_panels_fill(const nt_maugis_bank_options *options, int above, nt_maugis_panel *panels, int count,
                              nt_maugis_bank_cell *cells)
{
    nt_status status = NT_OK;
    for (int i = 0; i <= count && status == NT_OK && count > 0; i++) {
        nt_maugis_panel *const sides[2] = {i > 0 ? &panels[i - 1] : NULL, i < count ? &panels[i] : NULL};
        status = border_fill(options, above, sides, cells);
        if (status == NT_OK && above && i < count)
            status = start_fill(&panels[i], above);
    }
    return status;
}
