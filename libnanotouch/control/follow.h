/* SPDX-License-Identifier: BSD-3-Clause
 * Private to control/: where the stage should be, and what follows if it is not there. */
#ifndef NANOTOUCH_CONTROL_FOLLOW_H
#define NANOTOUCH_CONTROL_FOLLOW_H

#include "nanotouch/control.h"

/* Where the stage should be by now, told to be at the reference [m], whatever it shows. */
void nt_follow_expect(const nt_supervisor *supervisor, nt_supervisor_state *state, nt_sum reference);
/* Of where it is read to be [m]: has it not been where it should be for some samples? */
int nt_follow_is_off(const nt_supervisor *supervisor, nt_supervisor_state *state, double position);
/* Then: hold; for follow_time: latched, and it stays there. So does a lift whose force cannot be read, until it can be
 * and grows; one that was a second try is given up. */
nt_state nt_follow_judge(const nt_supervisor *supervisor, nt_supervisor_state *state, int tells_force);

#endif
