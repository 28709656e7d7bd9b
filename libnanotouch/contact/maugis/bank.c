/* SPDX-License-Identifier: BSD-3-Clause
 * Makes a bank of tables of Maugis-Dugdale and measures its error: see maugis.h. */
#include <float.h>
#include <math.h>
#include <stddef.h>

#include "contact/maugis/bank_panels.h"
#include "contact/maugis_bank.h"
#include "internal/contact.h"
#include "internal/maugis.h"

#define BETWEEN_CHECKS 1.25 /* errors between the points that are measured can be a little larger */
#define AWAY_FROM_FOLD 1e-4 /* reduced indentations */
#define MODEL_ERROR 0.056   /* Maugis-Dugdale to Lennard-Jones, in pull-off force (docs/evidence/contact.md) */

nt_maugis_bank_options nt_maugis_bank_defaults(void)
{
    return (nt_maugis_bank_options){
        .lambda_min = 0.01,
        .lambda_max = 100.0,
        .largest_indentation = 100.0,
        .panels_per_octave = 4,
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

/* Plans the panels of both sides; writes them where there is memory for them, and counts what is needed. */
static nt_status plan(const nt_maugis_bank_options *options, nt_maugis_bank_memory *memory, int counts[2])
{
    int panels = 0, cells = 0;
    for (int above = 0; above < 2; above++) {
        uint64_t names[2];
        double rate;
        nt_bank_names(options, above, names);
        nt_status status = nt_bank_rate_find(options, above, &rate);
        for (uint64_t name = names[0]; name < names[1] && status == NT_OK; name++) {
            nt_maugis_panel panel = {.rate = rate, .first = cells};
            status = nt_bank_panel_plan(options, above, name, &panel);
            if (memory->panels != NULL && panels < memory->panel_capacity)
                memory->panels[panels] = panel;
            panels++;
            cells += panel.count;
        }
        if (status != NT_OK)
            return status;
        counts[above] = (int)(names[1] - names[0]);
    }
    memory->panel_capacity = panels;
    memory->cell_capacity = cells;
    return NT_OK;
}

nt_status nt_maugis_bank_size(const nt_maugis_bank_options *options, nt_maugis_bank_memory *memory)
{
    nt_maugis_bank_memory needed = {.panels = NULL};
    int counts[2];
    if (!are_valid(options))
        return NT_E_RANGE;
    const nt_status status = plan(options, &needed, counts);
    if (status == NT_OK) {
        memory->panel_capacity = needed.panel_capacity;
        memory->cell_capacity = needed.cell_capacity;
    }
    return status;
}

static nt_bank_error worse_of(nt_bank_error a, nt_bank_error b)
{
    return (nt_bank_error){
        .force = fmax(a.force, b.force),
        .stiffness = fmax(a.stiffness, b.stiffness),
        .radius = fmax(a.radius, b.radius),
        .fold_shift = fmax(a.fold_shift, b.fold_shift),
    };
}

/* The bank against the exact law, at a place of a cell of a table of its rate. */
static nt_status measure_at(const nt_maugis_bank *bank, const nt_maugis *maugis, double Z, nt_bank_error *worst)
{
    const nt_maugis_folds *folds = &maugis->folds;
    const double start = folds->grip_in_contact ? folds->grip_indentation : folds->touch_indentation;
    const double d = start + Z * Z;
    nt_law_value exact, banked;
    nt_status status = nt_maugis_eval(maugis, d, NT_BRANCH_STABLE, &exact, NULL);
    if (status == NT_OK)
        status = nt_maugis_bank_eval(bank, maugis->lambda, d, NT_BRANCH_STABLE, &banked);
    if (status != NT_OK || Z * Z < AWAY_FROM_FOLD)
        return status;
    const nt_bank_error here = {
        .force = BETWEEN_CHECKS * fabs(banked.F - exact.F) / fmax(fabs(exact.F), -folds->pull_off_load),
        .stiffness = BETWEEN_CHECKS * fabs(banked.k - exact.k) / fmax(fabs(exact.k), 1.0),
        .radius = BETWEEN_CHECKS * fabs(banked.a - exact.a) / fmax(exact.a, 1.0),
    };
    *worst = worse_of(*worst, here);
    return NT_OK;
}

/* In a panel, where a cubic that takes value and slope at both ends is worst: in its middle, its slope at 0.2 and 0.8;
 * and next to a border, where the other variable is alone. */
static nt_status measure(const nt_maugis_bank *bank, nt_maugis_panel *panel, int above)
{
    static const double between[] = {0.02, 0.2, 0.5, 0.8}, within[] = {0.03, 0.2, 0.5};
    const int shift = nt_bank_shift(bank->options.cells_per_octave);
    panel->error = (nt_bank_error){0};
    for (int n = 0; n < 4; n++) {
        nt_maugis maugis;
        const double distance = panel->low + between[n] * (panel->high - panel->low);
        nt_status status = nt_bank_prepare(nt_bank_lambda(distance, above), &maugis);
        double grip = 0.0;
        if (status == NT_OK)
            status = nt_bank_grip_find(bank, maugis.lambda, &grip);
        if (status == NT_OK)
            panel->error.fold_shift =
                fmax(panel->error.fold_shift,
                     BETWEEN_CHECKS * fabs(grip - maugis.folds.grip_indentation) + DBL_EPSILON * fabs(grip));
        for (int i = 0; i < 3 * panel->count && status == NT_OK; i++) {
            const uint64_t name = (nt_bits_of(1.0) >> shift) + (uint64_t)(i / 3);
            const double low = nt_double_of(name << shift), high = nt_double_of((name + 1) << shift);
            const double Z = (low - 1.0 + within[i % 3] * (high - low)) / panel->rate;
            status = measure_at(bank, &maugis, Z, &panel->error);
        }
        if (status != NT_OK)
            return status;
    }
    return NT_OK;
}

nt_status nt_maugis_bank_init(nt_maugis_bank *bank, const nt_maugis_bank_options *options,
                              const nt_maugis_bank_memory *memory)
{
    if (!are_valid(options))
        return NT_E_RANGE;
    nt_maugis_bank made = {.options = *options, .panels = memory->panels, .cells = memory->cells};
    nt_maugis_bank_memory needed = *memory;
    nt_status status = plan(options, &needed, made.panel_count);
    if (status != NT_OK)
        return status;
    if (needed.panel_capacity > memory->panel_capacity || needed.cell_capacity > memory->cell_capacity)
        return NT_E_CAPACITY;
    for (int above = 0; above < 2 && status == NT_OK; above++)
        status = nt_bank_panels_fill(options, above, memory->panels + (above ? made.panel_count[0] : 0),
                                     made.panel_count[above], memory->cells);
    nt_bank_error worst = {0};
    for (int i = 0; i < needed.panel_capacity && status == NT_OK; i++) {
        status = measure(&made, &memory->panels[i], i >= made.panel_count[0]);
        worst = worse_of(worst, memory->panels[i].error);
    }
    made.accuracy = (nt_accuracy){worst.force, worst.fold_shift, MODEL_ERROR};
    if (status == NT_OK)
        *bank = made;
    return status;
}

nt_bank_error nt_maugis_bank_error(const nt_maugis_bank *bank, double lambda_min, double lambda_max)
{
    nt_bank_error worst = {0};
    for (int i = 0; i < bank->panel_count[0] + bank->panel_count[1]; i++) {
        const int above = i >= bank->panel_count[0];
        const double one = nt_bank_lambda(bank->panels[i].low, above);
        const double other = nt_bank_lambda(bank->panels[i].high, above);
        if (fmax(one, other) >= lambda_min && fmin(one, other) <= lambda_max)
            worst = worse_of(worst, bank->panels[i].error);
    }
    return worst;
}
