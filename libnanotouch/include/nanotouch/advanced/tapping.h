/* SPDX-License-Identifier: BSD-3-Clause
 * Tapping mode at one place: a driven lever over a surface, and what its lock-in amplifier shows. One mode of the
 * lever, m q'' + (m w0/Q) q' + k_c q = F(h) - 2 eta a h' + k_c D cos(w t),   h = z_b + q cos(alpha) - z_s, q the way of
 * the tip along its own direction. Driven at the tip, the deflection is q. Driven at the base by D cos(w t), k_c D is
 * the same drive (the medium rests), and the deflection is q - D cos(w t). */
#ifndef NANOTOUCH_ADVANCED_TAPPING_H
#define NANOTOUCH_ADVANCED_TAPPING_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/interaction.h"
#include "nanotouch/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How the lever is driven. */
typedef enum nt_drive_at { NT_DRIVE_TIP, NT_DRIVE_BASE } nt_drive_at;
typedef struct nt_drive {
    nt_drive_at at;        /* "tip|base" */
    double frequency;      /* f, 0: at the free resonance [Hz] */
    double free_amplitude; /* A0, of the deflection far from the surface [m] */
} nt_drive;
/* At the base, at the free resonance, 20 nm. */
NT_API nt_drive nt_drive_defaults(void);
/* The table of the drive's fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_drive_fields(int *count);
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_drive_check(const nt_drive *drive, nt_problem *problem);

/* Below this quality the second eigenmode takes part in every tap, and one mode is not the truth [-]. */
#define NT_TAPPING_QUALITY_MIN 10.0

/* A lever with its drive, prepared. Immutable after nt_tapping_init. */
typedef struct nt_tapping {
    double spring_constant, quality; /* k_c [N/m], Q [-] */
    double rate;                     /* w0 [rad/s] */
    double ratio;                    /* w/w0 [-] */
    double strength;                 /* D [m] */
    double cosine;                   /* cos(alpha) [-] */
    double viscosity;                /* eta of the contact [Pa s] */
    double free_amplitude;           /* A0 [m] */
    int at_base;                     /* 1: driven at the base */
    double tolerance;                /* local error of a step over A0 [-] */
} nt_tapping;
/* tolerance: of a step's error over A0, 1e-13 .. 1e-3; 1e-9 keeps energy and virial to 1e-6 (docs/scan.md).
 * NT_E_RANGE or NT_E_NOT_FINITE with the field of rig or drive in *problem (NULL allowed): "probe.quality" below
 * NT_TAPPING_QUALITY_MIN, "drive.frequency" outside 0.1 .. 3 f_0. */
NT_API nt_status nt_tapping_init(nt_tapping *tapping, const nt_probe *probe, const nt_drive *drive, double tolerance,
                                 nt_problem *problem);

/* Where the lever is. Copyable; it begins a period of the drive, w t = 0. */
typedef struct nt_tapping_state {
    double position; /* q [m] */
    double speed;    /* q'/w0 [m] */
    double step;     /* the last step, a guess for the next one [rad of w0 t]; 0: none */
    nt_interaction_state contact;
} nt_tapping_state;
/* Swinging freely with A0, far from the surface; and at rest. */
NT_API nt_tapping_state nt_tapping_free(const nt_tapping *tapping);

/* Over what it taps: the place and the height of the base, which both stay. */
typedef struct nt_tapping_over {
    const nt_plan *plan;
    const nt_place *place; /* NULL: a flat at z = 0 */
    double base_height;    /* z_b at rest, without the drive [m] */
} nt_tapping_over;

/* What happened in whole periods of the drive. Works and losses are per period, means over the time. */
typedef struct nt_tapping_value {
    double amplitude;    /* A of the deflection at w [m] */
    double phase;        /* phi, its lag behind the drive: A cos(w t - phi); pi/2 free at resonance [rad] */
    double mean;         /* deflection [m] */
    double peak_force;   /* largest force [N] */
    double pull;         /* largest attraction, positive [N] */
    double lowest_gap;   /* [m] */
    double contact_time; /* share of the period with a contact area [-] */
    double drive_work;   /* done by the drive on the lever [J] */
    double medium_loss;  /* taken by the medium, all harmonics [J] */
    double tip_loss;     /* taken by the contact, -closed integral of F dq [J] */
    double jump_loss;    /* of that, what the law says that its jumps took [J] */
    double mean_force;   /* <F> [N] */
    double virial;       /* <F q> [J] */
    double energy_error; /* of the balance of all energies, over what the drive put in or the lever stores/Q [-] */
    double virial_error; /* of <m q'^2> - k_c <q^2> + <(F + drive - damping) q> = change of m q q', over k_c A0^2 [-] */
    double change;       /* of the state from the first to the last period's end, over A0 [-] */
    long steps;          /* accepted */
    long evaluations;    /* of the force */
} nt_tapping_value;

/* `periods` >= 1 of the drive, from w t = 0 to w t = 0. NT_OK; NT_E_ARGUMENT; NT_E_NOT_FINITE where the force is, with
 * the state left where it was last finite. Bounded: at most 20 000 steps a period, NT_E_NO_CONVERGENCE beyond. */
NT_API nt_status nt_tapping_run(const nt_tapping *tapping, nt_tapping_state *state, const nt_tapping_over *over,
                                long periods, nt_tapping_value *value);

/* Runs until the motion repeats: as it would by itself, then by Newton's method on the map of one period. *value is of
 * one period of that motion. NT_E_NO_CONVERGENCE: it does not repeat within 30 Q periods (a motion of two periods, or
 * between two branches); *state and *value are then its last period. info: periods, and the state's change over A0. */
NT_API nt_status nt_tapping_settle(const nt_tapping *tapping, nt_tapping_state *state, const nt_tapping_over *over,
                                   nt_tapping_value *value, nt_solve_info *info);

/* --- Tapping by its slow flow: amplitude and lag of a lever change little in one period, so that only what the force
 * does over a whole period counts (Krylov, Bogoliubov). With q = q0 + Re(Z e^(i w t)), t in 1/w0, r = w/w0: Z' = i/(2
 * r) [(1 - r^2 + i r/Q) Z - D - (fc - i fs) Z/|Z|], fc = 1/pi of the integral of F/k cos(psi) d(psi), fs = loss per
 * period/(pi k |Z|), q = q0 + |Z| cos(psi). One step costs some 40 forces and may last several periods; the time domain
 * (tapping.h) needs 1000 in one. --- */

/* Amplitude and lag, slowly changing. Copyable. */
typedef struct nt_flow_state {
    double real, imaginary; /* Z, of the tip's way q [m] */
    double mean;            /* q0 [m] */
    int attached;           /* 1: a contact holds through the whole period */
} nt_flow_state;

/* What the force does in a period of amplitude A of q. */
typedef struct nt_flow_average {
    double cosine; /* fc [m] */
    double sine;   /* fs [m] */
    double mean;   /* <F>/k_c [m] */
    double low;    /* gap at the lowest point [m] */
    double peak;   /* the larger force of those at the lowest and the highest point [N] */
    double loss;   /* [J] */
    int attached;  /* at the top, afterwards */
} nt_flow_average;

/* Averages at the corners of cells of amplitude and lowest gap, made where steps come and kept for the next ones: a
 * step costs a tenth. Between the corners they are bilinear, and linear in the radius of the place. Zero: none yet.
 * Caller-owned, of one lever and plan; copyable. There is none across the capture gap, of a lever that stays attached,
 * or where a sample's properties change from place to place. */
enum { NT_FLOW_CELLS = 64 };
typedef struct nt_flow_cell {
    double low, amplitude, radius; /* of its first corner, and of the place [m] */
    int is_made;
    nt_flow_average corner[5]; /* low, low + width; the same at the next amplitude; the first at a larger radius */
} nt_flow_cell;
typedef struct nt_flow_table {
    nt_flow_cell cell[NT_FLOW_CELLS];
} nt_flow_table;

#ifdef __cplusplus
}
#endif
#endif
