/* SPDX-License-Identifier: BSD-3-Clause
 * One contact law out of several, chosen at run time, for one indentation or an array of them. */
#include <math.h>
#include <stddef.h>

#include "contact/reduced.h"
#include "nanotouch/field.h"
#include "nanotouch/material.h"

#define FIELD(path, unit, minimum, maximum, doc)                                                                       \
    {#path, unit, minimum, maximum, (unsigned)offsetof(nt_contact, path), doc}

static const nt_field contact_fields[] = {
    FIELD(radius, "m", 1e-10, 1.0, "radius R of the tip"),
    FIELD(effective_modulus, "Pa", 0.1, 1e15, "effective modulus E*"),
    FIELD(work_of_adhesion, "J/m^2", 0.0, 1e3, "work of adhesion w"),
    FIELD(cohesive_stress, "Pa", 0.0, 1e18, "cohesive stress sigma0 of the Dugdale zone"),
};

enum { CONTACT_FIELDS = (int)(sizeof contact_fields / sizeof contact_fields[0]) };

nt_contact nt_contact_defaults(void)
{
    const double work_of_adhesion = 0.144; /* 2 gamma_L of water */
    return (nt_contact){
        .radius = 20e-9,
        .effective_modulus = 76.9e9,
        .work_of_adhesion = work_of_adhesion,
        .cohesive_stress = nt_cohesive_stress_atomic(work_of_adhesion, 0.2e-9),
    };
}

nt_status nt_contact_check(const nt_contact *contact, nt_problem *problem)
{
    return nt_field_check(contact_fields, CONTACT_FIELDS, contact, problem);
}

const char *nt_model_name(nt_model model)
{
    switch (model) {
    case NT_HERTZ:
        return "hertz";
    case NT_DMT:
        return "dmt";
    case NT_JKR:
        return "jkr";
    case NT_MAUGIS:
        return "maugis";
    }
    return "unknown";
}

nt_status nt_contact_law_init(nt_contact_law *law, nt_model model, const nt_contact *contact)
{
    nt_contact_law made = {.model = model};
    nt_status status = NT_E_ARGUMENT;
    switch (model) {
    case NT_HERTZ:
    case NT_DMT:
    case NT_JKR:
        made.maugis.contact = *contact;
        status = nt_contact_check(contact, NULL);
        break;
    case NT_MAUGIS:
        status = nt_maugis_init(&made.maugis, contact);
        break;
    }
    if (status == NT_OK)
        *law = made;
    return status;
}

nt_status nt_contact_law_eval(const nt_contact_law *law, double indentation, nt_branch branch, nt_law_value *value)
{
    const nt_contact *contact = &law->maugis.contact;
    if (!nt_branch_is_known(branch))
        return NT_E_ARGUMENT;
    if (!isfinite(indentation))
        return NT_E_NOT_FINITE;
    switch (law->model) {
    case NT_HERTZ:
    case NT_DMT: /* one equilibrium at every indentation */
        if (branch == NT_BRANCH_UNSTABLE)
            return NT_E_NO_SOLUTION;
        *value = law->model == NT_HERTZ ? nt_hertz_eval(contact, indentation) : nt_dmt_eval(contact, indentation);
        return NT_OK;
    case NT_JKR:
        return nt_jkr_eval(contact, indentation, branch, value);
    case NT_MAUGIS:
        return nt_maugis_eval(&law->maugis, indentation, branch, value, NULL);
    }
    return NT_E_ARGUMENT;
}

double nt_contact_law_pull_off_force(const nt_contact_law *law)
{
    switch (law->model) {
    case NT_HERTZ:
        return 0.0;
    case NT_DMT:
        return nt_dmt_pull_off_force(&law->maugis.contact);
    case NT_JKR:
        return nt_jkr_pull_off_force(&law->maugis.contact);
    case NT_MAUGIS:
        return nt_maugis_pull_off_force(&law->maugis);
    }
    return NAN;
}

double nt_contact_law_grip_indentation(const nt_contact_law *law)
{
    switch (law->model) {
    case NT_HERTZ:
    case NT_DMT:
        return 0.0;
    case NT_JKR:
        return nt_jkr_pull_off_indentation(&law->maugis.contact);
    case NT_MAUGIS:
        return law->maugis.folds.grip_indentation * law->maugis.indentation_scale;
    }
    return NAN;
}

static void store(double *out, long index, double value)
{
    if (out != NULL)
        out[index] = value;
}

nt_status nt_contact_law_eval_n(const nt_contact_law *law, nt_branch branch, const nt_strided *arrays)
{
    nt_status first = NT_OK;
    for (long i = 0; i < arrays->count; i++) {
        nt_law_value value = {NAN, NAN, NAN, NAN};
        const nt_status status = nt_contact_law_eval(law, arrays->in[i * arrays->in_stride], branch, &value);
        if (first == NT_OK)
            first = status;
        const long j = i * arrays->out_stride;
        store(arrays->U, j, value.U);
        store(arrays->F, j, value.F);
        store(arrays->k, j, value.k);
        store(arrays->a, j, value.a);
    }
    return first;
}
