/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale from a bank of tables for contacts in SI: one, one with the slope over its radius, many.
 *
 * U = U_s u(d, lambda) with U_s ~ R^(4/3), d = delta/delta_s ~ R^(-1/3), lambda ~ R^(1/3):
 *     dU/dR = (4 U - F delta + lambda U_s du/dlambda)/(3 R). */
#include <math.h>
#include <stddef.h>

#include "contact/maugis/bank.h"
#include "contact/maugis_bank.h"

/* {lambda, d} and the units they are counted in. */
typedef struct {
    nt_reduced_units units;
    double at[2];
} scaled;

static scaled scaled_of(const nt_contact *contact, double indentation)
{
    const nt_reduced_units units = nt_reduced_units_of(contact);
    const double K = 4.0 / 3.0 * contact->effective_modulus; /* lambda = 2 sigma0 R/(K a_s), a_s the unit of radius */
    return (scaled){
        .units = units,
        .at = {2.0 * contact->cohesive_stress / K * (contact->radius / units.radius), indentation / units.indentation},
    };
}

/* w = 0. */
static nt_status hertz_eval(const nt_contact *contact, double indentation, nt_branch branch, nt_bank_value *value)
{
    nt_maugis maugis;
    nt_status status = nt_maugis_init(&maugis, contact);
    if (status == NT_OK)
        status = nt_maugis_eval(&maugis, indentation, branch, &value->law, NULL);
    if (status == NT_OK)
        value->dU_dR = 0.5 * value->law.U / contact->radius;
    return status;
}

nt_status nt_maugis_bank_eval_contact(const nt_maugis_bank *bank, const nt_contact *contact, double indentation,
                                      nt_branch branch, nt_law_value *value)
{
    nt_bank_state state;
    nt_bank_value hertz = {{0}, 0.0};
    const int adhesive = contact->work_of_adhesion != 0.0;
    const scaled made = scaled_of(contact, indentation);
    const nt_status status = adhesive ? nt_bank_state_find(bank, made.at, branch, 0, &state)
                                      : hertz_eval(contact, indentation, branch, &hertz);
    if (status == NT_OK)
        *value = adhesive ? nt_reduced_to_si(&state.value, &made.units) : hertz.law;
    return status;
}

nt_status nt_maugis_bank_eval_radius(const nt_maugis_bank *bank, const nt_contact *contact, double indentation,
                                     nt_branch branch, nt_bank_value *value)
{
    if (contact->work_of_adhesion == 0.0)
        return hertz_eval(contact, indentation, branch, value);
    nt_bank_state state;
    const scaled made = scaled_of(contact, indentation);
    const nt_status status = nt_bank_state_find(bank, made.at, branch, 1, &state);
    if (status != NT_OK)
        return status;
    const double sum = 4.0 * state.value.U - state.value.F * made.at[1] + made.at[0] * state.slope;
    value->law = nt_reduced_to_si(&state.value, &made.units);
    value->dU_dR = sum / 3.0 * (made.units.load / contact->radius) * made.units.indentation;
    return NT_OK;
}

double nt_maugis_bank_grip_indentation(const nt_maugis_bank *bank, const nt_contact *contact)
{
    double d;
    if (contact->work_of_adhesion == 0.0)
        return 0.0;
    const scaled made = scaled_of(contact, 0.0);
    return nt_bank_grip_find(bank, made.at[0], &d) == NT_OK ? d * made.units.indentation : (double)NAN;
}

static void store(double *out, long index, double value)
{
    if (out != NULL)
        out[index] = value;
}

nt_status nt_maugis_bank_pairs_n(const nt_maugis_bank *bank, nt_branch branch, const nt_bank_pairs *pairs)
{
    nt_status first = NT_OK;
    for (long i = 0; i < pairs->count; i++) {
        const nt_contact *contact = pairs->contacts + i * pairs->contact_stride;
        const double indentation = pairs->indentation[i * pairs->in_stride];
        nt_bank_value value = {{NAN, NAN, NAN, NAN}, NAN};
        nt_status status = nt_contact_check(contact, NULL);
        if (status == NT_OK)
            status = pairs->dU_dR != NULL ? nt_maugis_bank_eval_radius(bank, contact, indentation, branch, &value)
                                          : nt_maugis_bank_eval_contact(bank, contact, indentation, branch, &value.law);
        first = first == NT_OK ? status : first;
        const long j = i * pairs->out_stride;
        store(pairs->U, j, value.law.U);
        store(pairs->F, j, value.law.F);
        store(pairs->k, j, value.law.k);
        store(pairs->a, j, value.law.a);
        store(pairs->dU_dR, j, value.dU_dR);
    }
    return first;
}
