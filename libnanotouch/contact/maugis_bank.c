/* SPDX-License-Identifier: BSD-3-Clause
 * Makes a bank of tables of Maugis-Dugdale and measures its error: see maugis_bank.h. */
#include <math.h>
#include <stddef.h>

#include "contact/maugis_bank.h"

#define GAP 0.0078125       /* v below which there is no panel: 2^-7, a border of panels of every width */
#define BETWEEN_CHECKS 1.25 /* errors between the points that are measured can be a little larger */
#define AWAY_FROM_FOLD 1e-4 /* reduced indentations */
#define MODEL_ERROR 0.056   /* Maugis-Dugdale to Lennard-Jones, in pull-off force (docs/contact.md) */

static double lambda_of(double distance, int above)
{
    return above ? NT_BANK_CENTRE * (1.0 + distance) : NT_BANK_CENTRE / (1.0 + distance);
}

/* f[i] at x[i] into divided differences, in place. */
static void divide(double *f, const double *x, int count)
{
    for (int order = 1; order < count; order++)
        for (int i = count - 1; i >= order; i--)
            f[i] = (f[i] - f[i - 1]) / (x[i] - x[i - order]);
}

static double start_of(const nt_maugis *maugis)
{
    return maugis->folds.grip_in_contact ? maugis->folds.grip_indentation : maugis->folds.touch_indentation;
}

/* The bits of v that name its first panel and the one after its last, of a side; equal if there is none. */
static void names_of(const nt_maugis_bank_options *options, int above, uint64_t names[2])
{
    const int shift = nt_bank_shift(options->panels_per_octave);
    const double near = above ? options->lambda_min : options->lambda_max;
    const double far = above ? options->lambda_max : options->lambda_min;
    const double low = fmax(nt_bank_distance(near, above), GAP), high = nt_bank_distance(far, above);
    names[0] = names[1] = nt_bits_of(low) >> shift;
    if (high > low)
        names[1] = (nt_bits_of(high) >> shift) + 1;
}

/* Range, scale and cells of a panel; its cells are counted from first. */
static nt_status panel_plan(const nt_maugis_bank_options *options, int above, uint64_t name, nt_maugis_panel *panel)
{
    const int shift = nt_bank_shift(options->panels_per_octave);
    panel->low = nt_double_of(name << shift);
    panel->high = nt_double_of((name + 1) << shift);
    double scale = HUGE_VAL, start = HUGE_VAL;
    for (int i = 0; i < NT_BANK_NODES; i++) {
        nt_maugis maugis;
        const nt_status status =
            nt_bank_prepare(lambda_of(panel->low + nt_bank_nodes[i] * (panel->high - panel->low), above), &maugis);
        if (status != NT_OK)
            return status;
        scale = fmin(scale, nt_maugis_cell_scale(&maugis, options->cells_per_octave));
        start = fmin(start, start_of(&maugis));
    }
    const int cell_shift = nt_bank_shift(options->cells_per_octave);
    const double u = 1.0 + sqrt(fmax(options->largest_indentation - start, 0.0)) / scale;
    const uint64_t end = (nt_bits_of(u) >> cell_shift) + 1;
    panel->rate = 1.0 / scale;
    panel->u_end = nt_double_of(end << cell_shift);
    panel->count = (int)(end - (nt_bits_of(1.0) >> cell_shift));
    return NT_OK;
}

static nt_status start_fill(nt_maugis_panel *panel, int above)
{
    for (int i = 0; i < NT_BANK_START_NODES; i++) {
        nt_maugis maugis;
        const double distance = panel->low + nt_bank_start_nodes[i] * (panel->high - panel->low);
        const nt_status status = nt_bank_prepare(lambda_of(distance, above), &maugis);
        if (status != NT_OK)
            return status;
        panel->start[i] = start_of(&maugis);
    }
    divide(panel->start, nt_bank_start_nodes, NT_BANK_START_NODES);
    return NT_OK;
}

static nt_status cells_fill(const nt_maugis_panel *panel, int above, int cell_shift, nt_maugis_bank_cell *cells)
{
    nt_maugis_table tables[NT_BANK_NODES];
    nt_maugis_builder builders[NT_BANK_NODES];
    for (int n = 0; n < NT_BANK_NODES; n++) {
        tables[n] = (nt_maugis_table){.rate = panel->rate, .shift = cell_shift};
        const double distance = panel->low + nt_bank_nodes[n] * (panel->high - panel->low);
        const nt_status status = nt_bank_prepare(lambda_of(distance, above), &tables[n].maugis);
        if (status != NT_OK)
            return status;
        nt_maugis_builder_start(&builders[n], &tables[n]);
    }
    for (int i = 0; i < panel->count; i++) {
        nt_maugis_bank_cell *cell = &cells[panel->first + i];
        for (int n = 0; n < NT_BANK_NODES; n++) {
            nt_maugis_cell one;
            const nt_status status = nt_maugis_builder_next(&builders[n], &one);
            if (status != NT_OK)
                return status;
            for (int j = 0; j < 4; j++) {
                cell->F[j][n] = one.F[j];
                cell->a[j][n] = one.a[j];
            }
            cell->U[n] = one.U;
        }
        for (int j = 0; j < 4; j++) {
            divide(cell->F[j], nt_bank_nodes, NT_BANK_NODES);
            divide(cell->a[j], nt_bank_nodes, NT_BANK_NODES);
        }
        divide(cell->U, nt_bank_nodes, NT_BANK_NODES);
    }
    return NT_OK;
}

nt_maugis_bank_options nt_maugis_bank_defaults(void)
{
    return (nt_maugis_bank_options){
        .lambda_min = 0.01,
        .lambda_max = 100.0,
        .largest_indentation = 100.0,
        .panels_per_octave = 2,
        .cells_per_octave = 4,
    };
}

static int are_valid(const nt_maugis_bank_options *options)
{
    return options->lambda_min >= NT_MAUGIS_LAMBDA_MIN && options->lambda_min < options->lambda_max &&
           options->lambda_max <= NT_MAUGIS_LAMBDA_MAX && options->largest_indentation > 0.0 &&
           isfinite(options->largest_indentation) && nt_bank_shift(options->panels_per_octave) > 0 &&
           nt_bank_shift(options->cells_per_octave) > 0;
}

nt_status nt_maugis_bank_size(const nt_maugis_bank_options *options, nt_maugis_bank_memory *memory)
{
    if (!are_valid(options))
        return NT_E_RANGE;
    int panels = 0, cells = 0;
    for (int above = 0; above < 2; above++) {
        uint64_t names[2];
        names_of(options, above, names);
        for (uint64_t name = names[0]; name < names[1]; name++) {
            nt_maugis_panel panel;
            const nt_status status = panel_plan(options, above, name, &panel);
            if (status != NT_OK)
                return status;
            panels++;
            cells += panel.count;
        }
    }
    memory->panel_capacity = panels;
    memory->cell_capacity = cells;
    return NT_OK;
}

/* In a panel, between the lambdas it was made from: every cell at two indentations. */
static nt_status measure(nt_maugis_bank *bank, const nt_maugis_panel *panel, int above)
{
    static const double between[] = {0.13, 0.5, 0.87};
    const int shift = nt_bank_shift(bank->options.cells_per_octave);
    for (int n = 0; n < 3; n++) {
        nt_maugis maugis;
        const double distance = panel->low + between[n] * (panel->high - panel->low);
        nt_status status = nt_bank_prepare(lambda_of(distance, above), &maugis);
        const double shifted =
            start_of(&maugis) - nt_bank_interpolate(panel->start, nt_bank_start_nodes, NT_BANK_START_NODES, between[n]);
        bank->accuracy.fold_shift = fmax(bank->accuracy.fold_shift, fabs(shifted));
        for (int i = 0; i < 2 * panel->count && status == NT_OK; i++) {
            const uint64_t name = (nt_bits_of(1.0) >> shift) + (uint64_t)(i / 2);
            const double low = nt_double_of(name << shift), high = nt_double_of((name + 1) << shift);
            const double Z = (low - 1.0 + (i % 2 ? 0.7 : 0.4) * (high - low)) / panel->rate;
            const double d = start_of(&maugis) + Z * Z;
            nt_law_value exact, banked;
            status = nt_maugis_eval(&maugis, d, NT_BRANCH_STABLE, &exact, NULL);
            if (status == NT_OK)
                status = nt_maugis_bank_eval(bank, maugis.lambda, d, NT_BRANCH_STABLE, &banked);
            if (status != NT_OK || Z * Z < AWAY_FROM_FOLD)
                continue;
            const double error = fabs(banked.F - exact.F) / fmax(fabs(exact.F), -maugis.folds.pull_off_load);
            bank->accuracy.force_error = fmax(bank->accuracy.force_error, BETWEEN_CHECKS * error);
        }
        if (status != NT_OK)
            return status;
    }
    return NT_OK;
}

static nt_status panels_fill(nt_maugis_bank *bank, const nt_maugis_bank_memory *memory)
{
    const int shift = nt_bank_shift(bank->options.cells_per_octave);
    int first = 0, count = 0;
    for (int above = 0; above < 2; above++) {
        uint64_t names[2];
        names_of(&bank->options, above, names);
        for (uint64_t name = names[0]; name < names[1]; name++) {
            nt_maugis_panel *panel = &memory->panels[count];
            nt_status status = panel_plan(&bank->options, above, name, panel);
            panel->first = first;
            if (status == NT_OK)
                status = start_fill(panel, above);
            if (status == NT_OK)
                status = cells_fill(panel, above, shift, memory->cells);
            if (status != NT_OK)
                return status;
            first += panel->count;
            count++;
            bank->panel_count[above]++;
        }
    }
    return NT_OK;
}

nt_status nt_maugis_bank_init(nt_maugis_bank *bank, const nt_maugis_bank_options *options,
                              const nt_maugis_bank_memory *memory)
{
    nt_maugis_bank_memory needed;
    nt_status status = nt_maugis_bank_size(options, &needed);
    if (status != NT_OK)
        return status;
    if (needed.panel_capacity > memory->panel_capacity || needed.cell_capacity > memory->cell_capacity)
        return NT_E_CAPACITY;
    nt_maugis_bank made = {.options = *options, .panels = memory->panels, .cells = memory->cells};
    made.accuracy.model_error = MODEL_ERROR;
    status = panels_fill(&made, memory);
    for (int i = 0; i < needed.panel_capacity && status == NT_OK; i++)
        status = measure(&made, &made.panels[i], i >= made.panel_count[0]);
    if (status == NT_OK)
        *bank = made;
    return status;
}
