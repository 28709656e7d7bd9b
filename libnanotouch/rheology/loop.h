/* SPDX-License-Identifier: BSD-3-Clause
 * A tick in three steps, for a loop that has to find where its tip comes to rest: all springs relax, any indentation is
 * tried, one is taken. Private to the library. */
#ifndef NANOTOUCH_RHEOLOGY_LOOP_H
#define NANOTOUCH_RHEOLOGY_LOOP_H

#include "internal/rheology.h"
#include "nanotouch/rheology.h"

/* nt_viscoelastic_bed_make with springs that are closer to each other near the apex, for forces that are small beside
 * the max one: at (i/count)^grading of the contact radius. */
nt_status nt_viscoelastic_bed_graded(const nt_viscoelastic *contact, const nt_viscoelastic_demand *demand,
                                     double grading, nt_viscoelastic_bed *bed, nt_problem *problem);
/* A tick begins. held: what each of the bed's springs would push with if it stayed where it is. */
NT_REALTIME void nt_viscoelastic_begin(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double *held);
/* {0, F, k, a} at the end of that tick, if the tip went straight to an indentation; past the max one the springs are
 * all there are. NaN gives NaN. Pure. */
NT_REALTIME nt_law_value nt_viscoelastic_at(const nt_viscoelastic_bed *bed, const nt_viscoelastic_state *state,
                                            const double *held, double indentation);
/* It went there. `held` is used up. */
NT_REALTIME void nt_viscoelastic_end(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double *held,
                                     double indentation);
/* The state of a bed's springs goes over to other springs: by depth, with the arms of one kernel, at rest under another
 * one. `from` NULL: never touched. */
NT_REALTIME void nt_viscoelastic_carry(const nt_viscoelastic_bed *from, const nt_viscoelastic_state *state,
                                       const nt_viscoelastic_bed *to, nt_viscoelastic_state *carried);
/* A tip that has stood at an indentation for ever: all arms have relaxed. */
NT_REALTIME void nt_viscoelastic_rest(const nt_viscoelastic_bed *bed, nt_viscoelastic_state *state, double indentation);

#endif
