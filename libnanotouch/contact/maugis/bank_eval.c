/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale from a bank of tables, reduced: see maugis.h.
 *
 * With U = U_h + P_h Z^2 + E(t, Z), Z^2 = d - start, and G = dE/dd the slope at constant d is
 *     dU/dlambda = U_h,lambda|d + P_h,lambda Z^2 + t_lambda E_t - G start_lambda,
 * U_h and P_h at a = 0 below lambda_0 and 0 above it. */
#include <math.h>
#include <stddef.h>

#include "contact/maugis/bank.h"
#include "contact/maugis_bank.h"
#include "internal/contact.h"
#include "internal/maugis.h"

/* A place in the bank. */
typedef struct {
    const nt_maugis_panel *panel;
    double t, t_lambda;
    double Z2; /* d - start */
    double start, start_lambda;
    double P, P_lambda, U, U_lambda; /* at the start; U_lambda at constant d */
} place;

/* The panel of a lambda; NULL in the gap and outside the range. */
static const nt_maugis_panel *panel_of(const nt_maugis_bank *bank, double distance, int above)
{
    const int shift = nt_bank_shift(bank->options.panels_per_octave), count = bank->panel_count[above];
    if (count == 0)
        return NULL;
    const nt_maugis_panel *panels = bank->panels + (above ? bank->panel_count[0] : 0);
    if (!(distance >= panels[0].low && distance < panels[count - 1].high))
        return NULL;
    return panels + ((nt_bits_of(distance) >> shift) - (nt_bits_of(panels[0].low) >> shift));
}

/* 0 where the bank does not reach. */
static int place_find(const nt_maugis_bank *bank, double lambda, double d, place *at)
{
    const int above = lambda > NT_BANK_CENTRE;
    const double distance = nt_bank_distance(lambda, above);
    *at = (place){.panel = panel_of(bank, distance, above)};
    if (at->panel == NULL)
        return 0;
    const double width = at->panel->high - at->panel->low;
    at->t = (distance - at->panel->low) / width;
    at->t_lambda = (above ? 1.0 / NT_BANK_CENTRE : -NT_BANK_CENTRE / (lambda * lambda)) / width;
    if (above) {
        at->start = nt_bank_interpolate(at->panel->start, at->t, &at->start_lambda);
        at->start_lambda *= at->t_lambda;
    } else {
        const nt_bank_touch touch = nt_bank_touch_at(lambda);
        at->start = touch.d;
        at->start_lambda = touch.d_lambda;
        at->P = touch.P;
        at->P_lambda = touch.P_lambda;
        at->U = touch.U;
        at->U_lambda = touch.U_lambda;
    }
    at->Z2 = d - at->start;
    return 1;
}

/* Not in contact: apart, or attracted (lambda < lambda_0); 0 where the contact branch holds. */
static int apart_find(double lambda, double d, double start, nt_branch branch, nt_bank_state *state)
{
    const nt_maugis maugis = {.lambda = lambda, .folds.onset_indentation = -2.0 / (NT_PI * lambda)};
    const double onset = maugis.folds.onset_indentation, c_fold = nt_maugis_apart_fold(lambda);
    const double grip = lambda > NT_BANK_CENTRE ? start : onset - 0.5 * c_fold * c_fold;
    if (d < grip || (branch == NT_BRANCH_APPROACH && d < onset))
        *state = (nt_bank_state){0};
    else if (d < start) {
        const double root = sqrt(fmax(c_fold * c_fold + 2.0 * (d - onset), 0.0));
        state->value = nt_maugis_apart_value(&maugis, c_fold + root, root);
        state->slope = nt_maugis_apart_slope(lambda, c_fold + root);
    } else
        return 0;
    return 1;
}

/* The cell at u and t, as a table would hold it; without y, which only polishing needs. */
static nt_maugis_cell cell_at(const nt_maugis_bank_cell *cell, double u, double t)
{
    nt_maugis_cell made = {.u = u, .U = nt_cubic(cell->U, t)};
    for (int j = 0; j < 4; j++) {
        made.F[j] = nt_cubic(cell->F[j], t);
        made.a[j] = nt_cubic(cell->a[j], t);
    }
    return made;
}

/* Its derivative in t at constant u. */
static nt_maugis_cell cell_slope_at(const nt_maugis_bank_cell *cell, double u, double t)
{
    nt_maugis_cell made = {.u = u, .U = nt_cubic_slope(cell->U, t)};
    for (int j = 0; j < 4; j++)
        made.F[j] = nt_cubic_slope(cell->F[j], t);
    return made;
}

/* The contact branch from the tables; 0 beyond their end. */
static int table_find(const nt_maugis_bank *bank, const place *at, int sloped, nt_bank_state *state)
{
    const nt_maugis_panel *panel = at->panel;
    const int shift = nt_bank_shift(bank->options.cells_per_octave);
    const double Z = sqrt(at->Z2), u = 1.0 + Z * panel->rate;
    if (!(u < panel->u_end))
        return 0;
    const uint64_t name = nt_bits_of(u) >> shift;
    const double low = nt_double_of(name << shift);
    const nt_maugis_bank_cell *cell = &bank->cells[panel->first + (int64_t)(name - (nt_bits_of(1.0) >> shift))];
    const nt_maugis_place in = {.s = u - low, .Z = Z};
    const nt_maugis_cell now = cell_at(cell, low, at->t);
    const nt_law_value above = nt_maugis_cell_value(&now, in, panel->rate, at->start);
    state->value = above;
    state->value.U += at->U + at->P * at->Z2;
    state->value.F += at->P;
    if (sloped) {
        const nt_maugis_cell by_t = cell_slope_at(cell, low, at->t);
        const double E_t = nt_maugis_cell_value(&by_t, in, panel->rate, at->start).U;
        state->slope = at->U_lambda + at->P_lambda * at->Z2 + at->t_lambda * E_t - above.F * at->start_lambda;
    }
    return 1;
}

static double exact_slope(const nt_maugis *maugis, double d, nt_branch branch, const nt_law_value *value)
{
    nt_maugis_equilibrium point;
    if (value->F == 0.0 && value->U == 0.0)
        return 0.0;
    if (value->a == 0.0)
        return nt_maugis_apart_slope(maugis->lambda, nt_maugis_apart_radius(maugis, value->F));
    if (d > NT_REDUCED_HERTZ)
        return 0.0;
    if (nt_maugis_contact_find(maugis, d, branch != NT_BRANCH_UNSTABLE, &point, NULL) != NT_OK)
        return NAN;
    return nt_maugis_equilibrium_energy_slope(maugis->lambda, &point);
}

static nt_status exact_find(const double at[2], nt_branch branch, int sloped, nt_bank_state *state)
{
    nt_maugis maugis;
    nt_law_value value;
    nt_status status = nt_bank_prepare(at[0], &maugis);
    if (status == NT_OK)
        status = nt_maugis_eval(&maugis, at[1], branch, &value, NULL);
    if (status != NT_OK)
        return status;
    *state = (nt_bank_state){.value = value, .slope = sloped ? exact_slope(&maugis, at[1], branch, &value) : 0.0};
    return NT_OK;
}

/* The contact branch by the exact solver, on the side of the fold of the bank: where its fold lies a little above d, on
 * its tangent. */
static nt_status exact_contact_find(const double at[2], int sloped, nt_bank_state *state)
{
    nt_maugis maugis;
    const nt_status status = nt_bank_prepare(at[0], &maugis);
    if (status != NT_OK)
        return status;
    const double held[2] = {at[0], fmax(at[1], maugis.folds.grip_indentation)}, beyond = at[1] - held[1];
    const nt_status found = exact_find(held, NT_BRANCH_STABLE, sloped, state);
    if (found == NT_OK)
        state->value.U += state->value.F * beyond;
    return found;
}

/* A weight that goes from 0 to 1 over x = 0 .. 1 (C2), with its derivatives. */
typedef struct {
    double value, slope, bend;
} weight;

static weight weight_at(double x)
{
    if (x <= 0.0 || x >= 1.0)
        return (weight){.value = x >= 1.0};
    return (weight){
        .value = x * x * x * (10.0 + x * (6.0 * x - 15.0)),
        .slope = 30.0 * x * x * (1.0 - x) * (1.0 - x),
        .bend = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x),
    };
}

/* Of the bank, over lambda: the first and the last panel of a side lead over to the exact law. */
static weight lambda_weight(const nt_maugis_bank *bank, const place *at)
{
    const nt_maugis_panel *below = bank->panels, *above = below + bank->panel_count[0], *panel = at->panel;
    const nt_maugis_panel *end = above + bank->panel_count[1];
    const int first = panel == below || panel == above, last = panel + 1 == above || panel + 1 == end;
    if (!first && !last)
        return (weight){.value = 1.0};
    weight w = weight_at(first ? at->t : 1.0 - at->t);
    w.slope *= first ? at->t_lambda : -at->t_lambda;
    return w;
}

/* Over d: beyond the largest indentation. */
static weight depth_weight(const nt_maugis_bank *bank, double d)
{
    const double largest = bank->options.largest_indentation, per_d = -1.0 / ((NT_BANK_DEEP - 1.0) * largest);
    if (d <= largest)
        return (weight){.value = 1.0};
    weight w = weight_at(1.0 + (d - largest) * per_d);
    w.slope *= per_d;
    w.bend *= per_d * per_d;
    return w;
}

/* W bank + (1 - W) exact, W the product of both weights. */
static void blend(weight over_lambda, weight over_d, const nt_bank_state *exact, nt_bank_state *state)
{
    const double W = over_lambda.value * over_d.value, W_d = over_lambda.value * over_d.slope;
    const double dU = state->value.U - exact->value.U, dF = state->value.F - exact->value.F;
    state->value.U = exact->value.U + W * dU;
    state->value.F = exact->value.F + W * dF + W_d * dU;
    state->value.k =
        exact->value.k + W * (state->value.k - exact->value.k) + 2.0 * W_d * dF + over_lambda.value * over_d.bend * dU;
    state->value.a = exact->value.a + W * (state->value.a - exact->value.a);
    state->slope = exact->slope + W * (state->slope - exact->slope) + over_lambda.slope * over_d.value * dU;
}

nt_status nt_bank_state_find(const nt_maugis_bank *bank, const double at[2], nt_branch branch, int sloped,
                             nt_bank_state *state)
{
    const double lambda = at[0], d = at[1];
    const int held = branch == NT_BRANCH_STABLE || branch == NT_BRANCH_APPROACH;
    place here;
    if (!held || !isfinite(d) || !(d < NT_BANK_DEEP * bank->options.largest_indentation) ||
        !place_find(bank, lambda, d, &here))
        return exact_find(at, branch, sloped, state);
    const weight over_lambda = lambda_weight(bank, &here), over_d = depth_weight(bank, d);
    if (over_lambda.value * over_d.value == 0.0)
        return exact_find(at, branch, sloped, state);
    nt_bank_state exact, made = {0};
    if (!apart_find(lambda, d, here.start, branch, &made)) {
        if (!table_find(bank, &here, sloped, &made))
            return exact_find(at, branch, sloped, state);
        if (over_lambda.value * over_d.value < 1.0) {
            const nt_status status = exact_contact_find(at, sloped, &exact);
            if (status != NT_OK)
                return status;
            blend(over_lambda, over_d, &exact, &made);
        }
    }
    *state = made;
    return NT_OK;
}

nt_status nt_bank_grip_find(const nt_maugis_bank *bank, double lambda, double *d)
{
    place here;
    nt_maugis maugis;
    if (lambda <= NT_BANK_CENTRE && lambda >= NT_MAUGIS_LAMBDA_MIN) {
        const double c = nt_maugis_apart_fold(lambda);
        *d = -2.0 / (NT_PI * lambda) - 0.5 * c * c;
        return NT_OK;
    }
    if (place_find(bank, lambda, 0.0, &here) && lambda_weight(bank, &here).value > 0.0) {
        *d = here.start;
        return NT_OK;
    }
    const nt_status status = nt_bank_prepare(lambda, &maugis);
    if (status == NT_OK)
        *d = maugis.folds.grip_indentation;
    return status;
}

nt_status nt_maugis_bank_eval(const nt_maugis_bank *bank, double lambda, double d, nt_branch branch,
                              nt_law_value *reduced)
{
    const double at[2] = {lambda, d};
    nt_bank_state state;
    const nt_status status = nt_bank_state_find(bank, at, branch, 0, &state);
    if (status == NT_OK)
        *reduced = state.value;
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
