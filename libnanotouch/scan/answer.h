/* SPDX-License-Identifier: BSD-3-Clause
 * Inside scan: how a tap answers to the z loop. */
#ifndef NANOTOUCH_SCAN_ANSWER_H
#define NANOTOUCH_SCAN_ANSWER_H

#include "nanotouch/advanced/scan.h"

/* Of a lever over a plan's flat, at the loop's set point; phase feedback has the repelled one alone. */
void nt_tap_answers(const nt_tapping *lever, const nt_plan *plan, const nt_zloop *zloop,
                    nt_tap_answer answer[NT_TAP_ANSWERS]);
/* Whether a motion stays at one height, and reads more from higher up: only such a one can be held. */
int nt_tap_can_be_held(const nt_tapping *lever, nt_zloop_mode mode, const nt_tap_answer *at);

#endif
