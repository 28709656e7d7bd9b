/* SPDX-License-Identifier: BSD-3-Clause
 * One contact law out of several, chosen at run time, for one indentation; arrays of them: contact/arrays.c. */
#include <math.h>
#include <stddef.h>

#include "contact/reduced.h"
#include "internal/contact.h"

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
