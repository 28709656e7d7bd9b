/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_SCAN_FLOW_PRIVATE_H
#define NANOTOUCH_SCAN_FLOW_PRIVATE_H

#include "internal/tapping.h"
#include "nanotouch/advanced/tapping.h"

/* Of a period of amplitude A of q [m] that goes down to a gap [m], attached before or not. base_height is not used. */
NT_REALTIME nt_flow_average nt_flow_average_at(const nt_tapping *tapping, const nt_tapping_over *over, int attached,
                                               double amplitude, double low);
/* The same with a table. NULL: nt_flow_step. */
NT_REALTIME nt_flow_value nt_flow_step_in(const nt_tapping *tapping, nt_flow_state *state, const nt_tapping_over *over,
                                          double time, nt_flow_table *table);
/* In how many steps a time [s] is to be taken, of up to 0.25 sqrt(Q) periods each. */
int nt_flow_steps(const nt_tapping *tapping, double time);

#endif
