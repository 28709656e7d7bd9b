/* SPDX-License-Identifier: BSD-3-Clause
 * Scanning: a raster over a surface at a finite speed, with a z loop that keeps the deflection (contact mode) or the
 * amplitude (tapping mode), through a real stage. Tapping goes by its slow flow (tapping.h), contact by the lever at
 * rest (dynamics.h). */
#ifndef NANOTOUCH_SCAN_H
#define NANOTOUCH_SCAN_H

#include "nanotouch/advanced/tapping.h"
#include "nanotouch/dynamics.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_zloop_mode { NT_ZLOOP_CONTACT, NT_ZLOOP_TAPPING, NT_ZLOOP_PHASE } nt_zloop_mode;

/* What keeps the tip at the surface: z_b' = K_I (set point - amplitude), or K_I (deflection - set point). Phase
 * feedback taps, too. It reads the lag as the amplitude that a contact without loss would have, A0 sin(phi), beyond 90
 * degrees as A0 (2 - sin(phi)): far from the surface it reads A0, so that rules and gain are those of the amplitude. */
typedef struct nt_zloop {
    nt_zloop_mode mode;   /* "contact|tapping|phase" */
    double set_force;     /* of contact mode, above 0: at 0 and below nothing brings the tip down [N] */
    double set_amplitude; /* of tapping mode, over the free amplitude [-] */
    double set_phase;     /* of phase feedback [rad] */
    double integral;      /* K_I; 0: nt_scan_gain's [1/s] */
    double rate;          /* ticks per second [Hz] */
    double lock_in;       /* time constant of the lock-in amplifier [s] */
    double noise;         /* of one reading of deflection or amplitude, standard deviation [m] */
} nt_zloop;

/* Lines along x, each there (trace) and back (retrace), from y upwards. */
typedef struct nt_raster {
    double x, y;           /* of the first pixel: the mean over half a pixel on either side [m] */
    double width, height;  /* [m] */
    double pixels, lines;  /* [-] */
    double line_rate;      /* lines, there and back, per second [Hz] */
    double tilt_x, tilt_y; /* of the sample against the scanner: slopes [-] */
    double drift;          /* of the sample towards the tip [m/s] */
    double drift_x;        /* of the sample along x [m/s] */
    double drift_y;        /* along y [m/s] */
    double hysteresis;     /* of the scanner in x and y: opening of its loop over the stroke [-] */
} nt_raster;

/* What the read-outs of contact mode take from each other, and the noise of the lateral one. The z loop keeps what the
 * normal one shows. */
typedef struct nt_readout {
    double lateral_per_normal; /* share of the normal force that is read as a lateral one [-] */
    double normal_per_lateral; /* the other way: along a lever 3h/2L in deflection, 2h/L in angle [-] */
    double lateral_noise;      /* of one reading of the lateral force, standard deviation [N] */
} nt_readout;

typedef struct nt_scan {
    nt_zloop zloop;
    nt_raster raster;
    nt_readout readout;
} nt_scan;
/* Tapping at 0.7 A0 (45 degrees), 1 nN, gain by rule, 50 kHz, 20 us, 20 pm; 256 x 256 over 1 um x 1 um, 1 line per
 * second. */
NT_API nt_scan nt_scan_defaults(void);
/* The table of the fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_scan_fields(int *count);
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_scan_check(const nt_scan *scan, nt_problem *problem);

/* How a tap that holds the set point over a flat answers to small changes: slopes of the slow flow (tapping.h), at a
 * constant height of the base. */
typedef struct nt_tap_answer {
    double amplitude;                 /* A of q, 0: no such motion [m] */
    double sine, cosine;              /* D sin(phi), D cos(phi) [m] */
    double force_height, force_swing; /* of -fc, with the height and with A [-] */
    double loss_height, loss_swing;   /* of fs [-] */
} nt_tap_answer;
enum { NT_TAP_REPELLED, NT_TAP_ATTRACTED, NT_TAP_ANSWERS };

/* Prepared. Immutable after nt_scanner_init; plan borrowed. */
typedef struct nt_scanner {
    nt_scan scan;
    nt_probe probe;
    nt_tapping lever;                     /* of tapping mode */
    nt_tap_answer answer[NT_TAP_ANSWERS]; /* of tapping mode; phase feedback has the first */
    const nt_plan *plan;
    nt_stage_model stage;
    double period;   /* of a tick [s] */
    double integral; /* K_I in use [1/s] */
    long ticks;      /* of half a line */
    int steps;       /* of the slow flow in a tick */
} nt_scanner;
typedef struct nt_scanner_inputs {
    const nt_scan *scan;
    const nt_rig *rig;
    const nt_drive *drive; /* NULL in contact mode */
    const nt_plan *plan;   /* over the surface that is scanned */
} nt_scanner_inputs;
/* NT_E_RANGE or NT_E_NOT_FINITE with the field in *problem: "raster.line_rate" where half a line has less ticks than
 * pixels; "zloop.integral" where the loop would not be stable (gain margin below 1); "drive.frequency" where phase
 * feedback is driven off the free resonance. */
NT_API nt_status nt_scanner_init(nt_scanner *scanner, const nt_scanner_inputs *inputs, nt_problem *problem);

/* Copyable. */
typedef struct nt_scanner_state {
    nt_flow_state flow;
    nt_flow_table table;
    nt_cantilever_state lever;
    nt_interaction_state contact;
    nt_slide slide; /* of contact mode */
    nt_stage_state stage;
    double command;  /* z of the base that the loop asks for [m] */
    double measured; /* amplitude behind the lock-in, or deflection [m] */
    double lag;      /* phase behind the lock-in [rad] */
    double time;     /* since the beginning [s] */
    long line;       /* where the tip stands */
    nt_noise noise;
} nt_scanner_state;
/* Comes down from above at the beginning of a line, until the loop holds its set point. */
NT_API nt_status nt_scanner_engage(const nt_scanner *scanner, nt_scanner_state *state, long line, uint64_t seed);

/* The channels of one direction of one line, `pixels` values each; any may be NULL. */
typedef struct nt_scan_row {
    double *height;     /* that the loop asked for, mean over the pixel [m] */
    double *error;      /* set point - measured [m] */
    double *signal;     /* amplitude, or deflection [m] */
    double *phase;      /* of tapping mode [rad] */
    double *peak_force; /* largest in the pixel [N] */
    double *lateral;    /* as it is read: force of the lever on the tip along x, against friction (friction.h) and up
                           slopes; 0 tapping [N] */
} nt_scan_row;
/* To the line's beginning at the speed of a line; there and back. NT_E_NOT_FINITE, or what nt_cantilever_settle says.
 */
NT_API nt_status nt_scanner_line(const nt_scanner *scanner, nt_scanner_state *state, long line, nt_scan_row *trace,
                                 nt_scan_row *retrace);

#ifdef __cplusplus
}
#endif
#endif
