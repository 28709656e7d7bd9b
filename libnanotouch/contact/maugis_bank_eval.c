/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale from a bank of tables: see maugis_bank.h. */
#include <math.h>
#include <stddef.h>

#include "contact/maugis_apart.h"
#include "contact/maugis_bank.h"

static nt_status exact_eval(double lambda, double d, nt_branch branch, nt_law_value *reduced)
{
    nt_maugis maugis;
    const nt_status status = nt_bank_prepare(lambda, &maugis);
    return status == NT_OK ? nt_maugis_eval(&maugis, d, branch, reduced, NULL) : status;
}

/* The panel of a lambda; NULL in the gap and outside the range. */
static const nt_maugis_panel *panel_of(const nt_maugis_bank *bank, double distance, int above)
{
    const int shift = nt_bank_shift(bank->options.panels_per_octave);
    const nt_maugis_panel *panels = bank->panels + (above ? bank->panel_count[0] : 0);
    const int count = bank->panel_count[above];
    if (count == 0 || !(distance >= panels[0].low && distance < panels[count - 1].high))
        return NULL;
    return panels + ((nt_bits_of(distance) >> shift) - (nt_bits_of(panels[0].low) >> shift));
}

/* The cell at u and t, as a table would hold it; without y, which only polishing needs. */
static nt_maugis_cell cell_at(const nt_maugis_bank_cell *cell, double u, double t)
{
    nt_maugis_cell made = {.u = u, .U = nt_bank_interpolate(cell->U, nt_bank_nodes, NT_BANK_NODES, t)};
    for (int j = 0; j < 4; j++) {
        made.F[j] = nt_bank_interpolate(cell->F[j], nt_bank_nodes, NT_BANK_NODES, t);
        made.a[j] = nt_bank_interpolate(cell->a[j], nt_bank_nodes, NT_BANK_NODES, t);
    }
    return made;
}

/* Not in contact: apart, or attracted (lambda < lambda_0); 0 where the contact branch holds. */
static int apart_eval(double lambda, double d, double start, nt_branch branch, nt_law_value *reduced)
{
    const nt_maugis maugis = {.lambda = lambda, .folds.onset_indentation = -2.0 / (NT_PI * lambda)};
    const double onset = maugis.folds.onset_indentation, c_fold = nt_maugis_apart_fold(lambda);
    const double grip = lambda > NT_BANK_CENTRE ? start : onset - 0.5 * c_fold * c_fold;
    if (d < grip || (branch == NT_BRANCH_APPROACH && d < onset))
        *reduced = (nt_law_value){0};
    else if (d < start) {
        const double root = sqrt(fmax(c_fold * c_fold + 2.0 * (d - onset), 0.0));
        *reduced = nt_maugis_apart_value(&maugis, c_fold + root, root);
    } else
        return 0;
    return 1;
}

nt_status nt_maugis_bank_eval(const nt_maugis_bank *bank, double lambda, double d, nt_branch branch,
                              nt_law_value *reduced)
{
    const int above = lambda > NT_BANK_CENTRE, held = branch == NT_BRANCH_STABLE || branch == NT_BRANCH_APPROACH;
    const double distance = nt_bank_distance(lambda, above);
    const nt_maugis_panel *panel = held && isfinite(d) ? panel_of(bank, distance, above) : NULL;
    if (panel == NULL || d > bank->options.largest_indentation)
        return exact_eval(lambda, d, branch, reduced);
    const double t = (distance - panel->low) / (panel->high - panel->low);
    const double start = nt_bank_interpolate(panel->start, nt_bank_start_nodes, NT_BANK_START_NODES, t);
    if (apart_eval(lambda, d, start, branch, reduced))
        return NT_OK;
    const int shift = nt_bank_shift(bank->options.cells_per_octave);
    const double Z = sqrt(d - start), u = 1.0 + Z * panel->rate;
    if (!(u < panel->u_end))
        return exact_eval(lambda, d, branch, reduced);
    const uint64_t name = nt_bits_of(u) >> shift;
    const double low = nt_double_of(name << shift);
    const int64_t index = (int64_t)(name - (nt_bits_of(1.0) >> shift));
    const nt_maugis_cell cell = cell_at(&bank->cells[panel->first + index], low, t);
    const nt_maugis_place place = {.s = u - low, .Z = Z};
    *reduced = nt_maugis_cell_value(&cell, place, panel->rate, start);
    return NT_OK;
}

nt_status nt_maugis_bank_eval_contact(const nt_maugis_bank *bank, const nt_contact *contact, double indentation,
                                      nt_branch branch, nt_law_value *value)
{
    if (contact->work_of_adhesion == 0.0) {
        nt_maugis maugis;
        const nt_status status = nt_maugis_init(&maugis, contact);
        return status == NT_OK ? nt_maugis_eval(&maugis, indentation, branch, value, NULL) : status;
    }
    const nt_reduced_units units = nt_reduced_units_of(contact);
    const double lambda = nt_maugis_lambda(contact);
    nt_law_value reduced;
    const nt_status status = nt_maugis_bank_eval(bank, lambda, indentation / units.indentation, branch, &reduced);
    if (status == NT_OK)
        *value = nt_reduced_to_si(&reduced, &units);
    return status;
}

nt_status nt_maugis_bank_load_n(const nt_maugis_bank *bank, const double *lambda, const double *d, double *load,
                                long count)
{
    nt_status first = NT_OK;
    for (long i = 0; i < count; i++) {
        nt_law_value value = {.F = NAN};
        const nt_status status = nt_maugis_bank_eval(bank, lambda[i], d[i], NT_BRANCH_STABLE, &value);
        first = first == NT_OK ? status : first;
        load[i] = value.F;
    }
    return first;
}
