/* SPDX-License-Identifier: BSD-3-Clause
 * The steps of nt_plan_make. */
#ifndef NANOTOUCH_INTERNAL_PLAN_H
#define NANOTOUCH_INTERNAL_PLAN_H

#include "nanotouch/plan.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The same in two steps, from the same inputs, for a bank that is made between them: nt_plan_begin finds the contact
 * and does not read inputs->bank, nt_plan_decide chooses. Each fails as nt_plan_make. */
NT_API nt_status nt_plan_begin(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem);
/* The second step; of a plan that nt_plan_begin has left with NT_OK. */
NT_API nt_status nt_plan_decide(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem);
/* Of a plan that was begun: 1 and the options of the bank that serves its contact at every place of the surface, 0 if
 * none could be of use (a flat, or adhesion that is none or has no range). The range of lambda is that of all
 * places, and the indentation that of the largest load at the sharpest place, in decades with a
 * factor of 1.5 to spare; twice as fine below a demand of 1e-4. */
NT_API int nt_plan_wants_bank(const nt_plan *plan, nt_maugis_bank_options *options);

#ifdef __cplusplus
}
#endif
#endif
