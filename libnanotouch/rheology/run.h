/* SPDX-License-Identifier: BSD-3-Clause
 * A contact on its way along a history; private to rheology/.
 *
 * By springs under the tip (Popov's method of dimensionality reduction): the one that the contact reached when the
 * indentation was D carries Sum E_k s_k, s_k = Int exp(-r_k (t - s)) d(delta) since then, and F = C Sum E_k Z_k with
 * Z_k = Int s_k dg'(D). While the contact grows Z_k = Int exp(-r_k (t - s)) dg (Lee and Radok); a spring leaves where
 * its force is 0 (Ting's t_1). Derivatives are carried along beside each number ("_by"). */
#ifndef NANOTOUCH_RHEOLOGY_RUN_H
#define NANOTOUCH_RHEOLOGY_RUN_H

#include "nanotouch/rheology.h"
#include "rheology/arms.h"
#include "rheology/profile.h"

typedef enum nt_run_phase {
    NT_RUN_OUT,     /* never touched */
    NT_RUN_GROWING, /* the contact is larger than ever */
    NT_RUN_SHRINKING,
    NT_RUN_LEFT /* out of contact, above a dent */
} nt_run_phase;

typedef struct nt_run {
    nt_profile profile;
    nt_arms arms;
    nt_step step, past; /* of the step that is done; of one that is looked back at */
    double factor;      /* 1/(1 - nu^2) */
    double compliance;  /* 1/k_c [m/N] */
    nt_run_phase phase;
    double time, base, depth; /* of the last point; base over the position of first touch [s], [m], [m] */
    nt_profile_value value;   /* of the profile there */
    double force;
    double follows; /* share of the base's last step that the tip went along, to begin the next solution */
    double depth_by[NT_ARM_PARAMETERS], force_by[NT_ARM_PARAMETERS];
    double Z[NT_ARMS], Z_by[NT_ARM_PARAMETERS][NT_ARMS];
    double S[NT_ARMS], S_by[NT_ARM_PARAMETERS][NT_ARMS]; /* s_k of the spring at the edge, which is records[edge] */
    double past_decay[NT_ARMS];                          /* exp(-r_k (t - time of the edge)) */
    double dent;                                         /* of the centre, out of contact [m] */
    double *records;                                     /* rows: see NT_RUN_TIME .. */
    long edge, capacity;
} nt_run;

/* Times that increase, finite positions, the first out of contact; the range of times that the kernel must serve. */
nt_status nt_viscoelastic_check_path(const nt_viscoelastic_path *path, nt_time_range *range, nt_problem *problem);

/* A record of the first loading: time [s], depth D [m], the profile there, derivatives of the depth. */
enum { NT_RUN_TIME, NT_RUN_DEPTH, NT_RUN_G, NT_RUN_SLOPE, NT_RUN_CURVATURE, NT_RUN_BY };
static inline double *nt_run_record_at(const nt_run *run, long index)
{
    return run->records + index * (NT_RUN_BY + run->arms.parameters);
}

/* Lets the sums of Z or S relax over the step; returns Sum E_k x_k, with its derivatives. */
double nt_run_relax(const nt_run *run, double *x, double (*x_by)[NT_ARMS], double *sum_by);
/* Polynomial of dg/dy along a straight piece of the indentation, y 0 .. 1: d[0] + d[1] y + d[2] y^2. Right at both ends
 * and in its integral. */
void nt_run_piece(const nt_profile_value *from, const nt_profile_value *to, double length, double d[3]);
/* Its derivative, for derivatives of both ends. */
void nt_run_piece_by(const nt_profile_value *from, const nt_profile_value *to, double length, const double ends_by[2],
                     double d_by[3]);
/* One straight piece of the base's way, to (time, base), of a contact that grows; one that would shrink turns. */
nt_status nt_run_grow(nt_run *run, double time, double base);
/* The first step of a contact that shrinks; Z has relaxed, and `held` is Sum E_k Z_k. */
nt_status nt_run_turn(nt_run *run, double time, double base, double held, const double *held_by);
/* The other ones. */
nt_status nt_run_shrink(nt_run *run, double time, double base);

#endif
