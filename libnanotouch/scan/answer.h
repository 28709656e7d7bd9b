/* SPDX-License-Identifier: BSD-3-Clause
 * Inside scan: how a tap answers to the z loop. */
#ifndef NANOTOUCH_SCAN_ANSWER_H
#define NANOTOUCH_SCAN_ANSWER_H

#include "nanotouch/scan.h"

/* Fills in scanner->answer, of its lever, its plan's flat and its set point. */
void nt_tap_answers(nt_scanner *scanner);

#endif
