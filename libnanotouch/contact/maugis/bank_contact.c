/* SPDX-License-Identifier: BSD-3-Clause
 * Maugis-Dugdale from a bank of tables for contacts in SI: one, one with the slope over its radius, many.
 *
 * U = U_s u(d, lambda) with U_s ~ R^(4/3), d = delta/delta_s ~ R^(-1/3), lambda ~ R^(1/3):
 *     dU/dR = (4 U - F delta + lambda U_s du/dlambda)/(3 R). */
#include <math.h>
#include <stddef.h>

#include "contact/block.h"
#include "contact/maugis/bank.h"
#include "contact/maugis_bank.h"
#include "internal/contact.h"
#include "internal/maugis.h"

/* {lambda, d} and the units they are counted in. */
typedef struct {
    nt_reduced_units units;
    double at[2];
} scaled;

static scaled scaled_of(const nt_contact *contact, double indentation)
{
    const nt_reduced_units units = nt_reduced_units_of(contact);
    return (scaled){
        .units = units,
        .at = {nt_reduced_lambda(contact, &units), indentation / units.indentation},
    };
}

/* Without a bank; dU/dR is that of w = 0. */
static nt_status direct_eval(const nt_contact *contact, double indentation, nt_branch branch, nt_bank_value *value)
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
                                      : direct_eval(contact, indentation, branch, &hertz);
    if (status == NT_OK)
        *value = adhesive ? nt_reduced_to_si(&state.value, &made.units) : hertz.law;
    return status;
}

nt_status nt_maugis_bank_eval_radius(const nt_maugis_bank *bank, const nt_contact *contact, double indentation,
                                     nt_branch branch, nt_bank_value *value)
{
    if (contact->work_of_adhesion == 0.0)
        return direct_eval(contact, indentation, branch, value);
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

static int is_empty(const nt_maugis_bank *bank)
{
    return bank->panel_count[0] + bank->panel_count[1] == 0;
}

static void store(double *out, long index, double value)
{
    if (out != NULL)
        out[index] = value;
}

/* A block of pairs without a bank, so exact; 0 where one of them is not a contact with adhesion in the valid range. */
static int block_find(const nt_bank_pairs *pairs, nt_branch branch, long from, nt_law_block *block)
{
    nt_block_contacts each;
    for (int j = 0; j < NT_BLOCK; j++) { /* beyond the end the last is repeated */
        const long i = from + j < pairs->count ? from + j : pairs->count - 1;
        const nt_contact *contact = pairs->contacts + i * pairs->contact_stride;
        if (nt_contact_check(contact, NULL) != NT_OK)
            return 0;
        const nt_reduced_units units = nt_reduced_units_of(contact);
        each.lambda[j] = nt_reduced_lambda(contact, &units);
        each.load[j] = units.load;
        each.radius[j] = units.radius;
        each.indentation[j] = units.indentation;
        block->in[j] = pairs->indentation[i * pairs->in_stride];
        if (!(each.lambda[j] >= NT_MAUGIS_LAMBDA_MIN && each.lambda[j] <= NT_MAUGIS_LAMBDA_MAX) ||
            !isfinite(block->in[j]))
            return 0;
    }
    return nt_maugis_block_each(&each, branch, !pairs->U && !pairs->k && !pairs->a, block);
}

/* Does a block of pairs at once, and returns how many; 0: they are to be done one by one. */
static long block_eval(nt_branch branch, const nt_bank_pairs *pairs, long from)
{
    nt_law_block block;
    const long left = pairs->count - from, count = left < NT_BLOCK ? left : NT_BLOCK;
    const int held = branch == NT_BRANCH_STABLE || branch == NT_BRANCH_APPROACH;
    if (!held || count < NT_BLOCK / 8 || !block_find(pairs, branch, from, &block))
        return 0;
    for (long j = 0; j < count; j++) {
        const long to = (from + j) * pairs->out_stride;
        store(pairs->U, to, block.U[j]);
        store(pairs->F, to, block.F[j]);
        store(pairs->k, to, block.k[j]);
        store(pairs->a, to, block.a[j]);
    }
    return count;
}

static nt_status pair_eval(const nt_maugis_bank *bank, nt_branch branch, const nt_bank_pairs *pairs, long i)
{
    const nt_contact *contact = pairs->contacts + i * pairs->contact_stride;
    const double indentation = pairs->indentation[i * pairs->in_stride];
    nt_bank_value value = {{NAN, NAN, NAN, NAN}, NAN};
    nt_status status = nt_contact_check(contact, NULL);
    if (status == NT_OK && pairs->dU_dR != NULL)
        status = nt_maugis_bank_eval_radius(bank, contact, indentation, branch, &value);
    else if (status == NT_OK && is_empty(bank)) /* as in a block, to the bit */
        status = direct_eval(contact, indentation, branch, &value);
    else if (status == NT_OK)
        status = nt_maugis_bank_eval_contact(bank, contact, indentation, branch, &value.law);
    const long j = i * pairs->out_stride;
    store(pairs->U, j, value.law.U);
    store(pairs->F, j, value.law.F);
    store(pairs->k, j, value.law.k);
    store(pairs->a, j, value.law.a);
    store(pairs->dU_dR, j, value.dU_dR);
    return status;
}

nt_status nt_maugis_bank_pairs_n(const nt_maugis_bank *bank, nt_branch branch, const nt_bank_pairs *pairs)
{
    const int in_blocks = is_empty(bank) && pairs->dU_dR == NULL;
    nt_status first = NT_OK;
    long i = 0, single = 0; /* one by one up to there */
    while (i < pairs->count) {
        const long done = in_blocks && i >= single ? block_eval(branch, pairs, i) : 0;
        if (done > 0) {
            i += done;
            continue;
        }
        if (i >= single)
            single = i + NT_BLOCK;
        const nt_status status = pair_eval(bank, branch, pairs, i++);
        first = first == NT_OK ? status : first;
    }
    return first;
}
