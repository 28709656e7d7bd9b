/* SPDX-License-Identifier: BSD-3-Clause
 * Inside scan, and for sessions that tap: the z loop as its samples see it, exact under the holds, and how far it is
 * from ringing. */
#ifndef NANOTOUCH_SCAN_LOOP_H
#define NANOTOUCH_SCAN_LOOP_H

#include "core/complex_number.h"
#include "core/lti.h"
#include "nanotouch/advanced/scan.h"

/* From the height of the base, held over a tick, to the reading of the lever; order 0: at once. */
typedef struct nt_loop_answer {
    int order;
    nt_lti tick, part; /* over a tick, and from its begin to the moment of the reading */
    double read[2];    /* of the states */
} nt_loop_answer;

enum { NT_LOOP_ANSWERS = 13 };
/* All answers of a tap that a loop has to bear, and the lock-in amplifier behind each. */
typedef struct nt_tap_loop {
    nt_loop_answer answer[NT_LOOP_ANSWERS];
    int count;
    int at_set_point; /* the first of those at the set point, over a flat; 0: none */
    double share;     /* of a deviation that the amplifier takes in a tick [-] */
} nt_tap_loop;
/* At once, as a hard sample holds the amplitude; as a free lever, 1/(1 + i w 2 Q/w0); and as the slow flow says at the
 * set point, over a flat, where the sample is twice as stiff, and by phase also where it seems softer. Read at the end
 * of a tick, and in the middle of the slow flow's last step in it, as that tells it. */
nt_tap_loop nt_tap_loop_make(const nt_tapping *lever, const nt_zloop *zloop,
                             const nt_tap_answer answer[NT_TAP_ANSWERS]);
/* The one of contact mode. */
nt_tap_loop nt_tap_loop_at_once(void);
/* Answer and amplifier at z = exp(j theta). */
double complex nt_tap_loop_at(const nt_tap_loop *loop, int answer, double theta);

/* An open loop with K_I = 1: from the reading through integral and stage to the reading. */
typedef struct nt_open_loop {
    const nt_tap_loop *tap;
    double complex (*stage)(const void *context, double theta); /* integral and stage [s] */
    const void *context;
    double first;        /* angle below all corners [rad] */
    double angle, width; /* of the stage's resonance [rad] */
} nt_open_loop;
/* The K_I from which on it rings, and that with a phase margin [rad], both [1/s]. */
typedef struct nt_loop_limits {
    double rings, phase;
} nt_loop_limits;
nt_loop_limits nt_open_loop_limits(const nt_open_loop *loop, double phase_margin);
/* Least distance of the loop with a K_I [1/s] from lag pi where its gain is 1 and more [rad], and the last such angle
 * [rad]. */
typedef struct nt_loop_phase {
    double margin, angle;
} nt_loop_phase;
nt_loop_phase nt_open_loop_phase(const nt_open_loop *loop, double integral);
double complex nt_open_loop_at(const nt_open_loop *loop, int answer, double theta);

#endif
