/* SPDX-License-Identifier: BSD-3-Clause
 * What a measured force curve shows before any model is fitted: noise, baseline, snap-in, pull-off, contact point.
 *
 * z is the height of the cantilever's base and grows away from the sample [m]; forces are positive where tip and sample
 * repel [N]. A branch is one movement of the base: the approach or the retraction.
 *
 * All functions: thread-safe, no state, no heap. Memory comes from the caller: `work` holds nt_curve_work_size()
 * doubles. Not real-time (time grows with the points). Uncertainties are standard ones and statistical: those of spring
 * constant and deflection sensitivity are not in them. */
#ifndef NANOTOUCH_CURVES_H
#define NANOTOUCH_CURVES_H

#include "nanotouch/status.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { NT_CURVE_FEWEST = 16 }; /* points of a branch that is read */

/* One movement of the base in the order of time. */
typedef struct nt_curve_segment {
    const double *z;     /* height of the base [m], |z| <= 1 */
    const double *force; /* + repulsive, baseline still in it [N], |force| <= 1 */
    long count;          /* fewer than NT_CURVE_FEWEST: as if there were none */
} nt_curve_segment;

/* A recorded curve. */
typedef struct nt_curve {
    nt_curve_segment approach, retract;
    double spring_constant; /* k_c [N/m]; NaN: unknown */
    /* How far drag puts the free retraction below the free approach, 2 D of a lever that moves with +-v [N]. It cannot
     * be told from two free branches; lever and medium, or curves at two speeds, bound it. most_drag 0: unknown. */
    double least_drag, most_drag; /* [N] */
} nt_curve;

/* Doubles of work that a curve of so many points, both branches together, needs. */
NT_API long nt_curve_work_size(long points);

/* --- Noise --- */

/* The mean of n neighbouring points has the variance white/n + flicker [N^2]. */
typedef struct nt_curve_noise {
    double white, flicker; /* [N^2] */
} nt_curve_noise;

/* --- Baseline: the force of the free cantilever --- */

/* Interference of light from the sample with that from the cantilever: cosine cos(phase) + sine sin(phase), phase
 * 2 pi x/period. */
typedef struct nt_curve_wave {
    double period;       /* half a wavelength of the light, 160 .. 800 nm [m] */
    double cosine, sine; /* [N]; both 0: no wave */
} nt_curve_wave;

/* What bends the line of a free cantilever: film/(max(z, nearest) - pole) + bow x^2. */
typedef struct nt_curve_bend {
    double film;          /* [N m]; 0: no squeeze film is evident */
    double pole, nearest; /* z [m]; nearer than the latter it is not seen and goes on as it was there */
    double bow;           /* [N/m^2]; 0: none is evident */
} nt_curve_bend;

/* force + slope x + wave(x) + bend with x = z - z_mean. */
typedef struct nt_curve_baseline {
    double force;                          /* at z_mean [N] */
    double slope;                          /* [N/m] */
    double z_mean;                         /* mean of the points it was fitted to [m] */
    double nearest;                        /* least z of these [m] */
    double scatter;                        /* robust standard deviation of these about it [N] */
    double force_variance, slope_variance; /* [N^2], [N^2/m^2]; flicker noise included */
    nt_curve_noise noise;                  /* of the free cantilever; with NT_CURVE_AUTO that of both branches,
                                              unless they contradict each other */
    nt_curve_wave wave;
    nt_curve_bend bend; /* with NT_CURVE_AUTO: of an approach; its bow alone of the retraction beside it */
} nt_curve_baseline;

typedef enum nt_curve_baseline_kind {
    NT_CURVE_AUTO, /* a line, with a wave where there is very strong evidence for one (BIC); of a curve with both
                      branches the retraction's is judged beside the approach's */
    NT_CURVE_LINE, /* of each branch alone: a line by Tukey's weights through the far half of the travel, then through
                      all that it can explain */
    NT_CURVE_WAVE, /* a line and the strongest wave */
    NT_CURVE_CONSTANT, /* the median of the far half: tilt stays in the force */
    NT_CURVE_BETWEEN   /* a line through the points with lowest <= z <= highest */
} nt_curve_baseline_kind;

/* Which baseline is taken off. */
typedef struct nt_curve_choice {
    nt_curve_baseline_kind kind;
    double lowest, highest; /* z [m], of NT_CURVE_BETWEEN */
} nt_curve_choice;

/* --- Events of a branch --- */

typedef struct nt_curve_measured {
    double value, sigma; /* [SI]; NaN where the curve does not show it */
} nt_curve_measured;

/* A branch with its baseline taken off, from the deepest point outwards. */
typedef struct nt_curve_branch {
    const double *z;     /* growing [m]; in the caller's work */
    const double *force; /* above the baseline [N]; in the caller's work */
    long count;          /* 0: there is no such branch */
    nt_curve_baseline baseline;
    double noise;   /* standard deviation from point to point [N] */
    double visible; /* smallest force that can be told from the baseline: five times the noise, three times the scatter,
                       whichever is more [N] */
    long lowest;    /* index of the smallest force, not within the last tenth of the travel */
    int dips;       /* 1: it lies visibly below the baseline, alone or together with its neighbours */
    long torn;      /* index of the last point before the tip is torn off, found by the jump; -1: the force comes back
                       gradually, or not at all */
    long repulsive; /* how many points a law without attraction can describe: up to where the force is 0, and where
                       nothing dips half as far again; only those in contact where a squeeze film is likely */
    nt_curve_measured dip;           /* depth below the baseline, positive [N]; 0 where nothing dips */
    double dip_z;                    /* z there [m]; NaN where nothing dips */
    nt_curve_measured adhesion_work; /* area below the baseline up to the last visible dip [J]; 0 where nothing dips */
    nt_curve_measured contact_slope; /* -dF/dz over the upper half of the load [N/m] */
} nt_curve_branch;

/* --- The whole curve --- */

/* Methods for the contact point, none of which is right for every curve. */
typedef enum nt_curve_contact_method {
    NT_CURVE_CROSSING,  /* after a snap-in: the force crosses the baseline */
    NT_CURVE_DEVIATION, /* without one: the last point above the noise */
    NT_CURVE_HERTZ,     /* foot of F^(2/3) over the indentation */
    NT_CURVE_TWO_LINES, /* baseline and a line through the lower half of the load meet */
    NT_CURVE_GRADIENT,  /* without a snap-in: the slope leaves that of the baseline */
    NT_CURVE_METHODS    /* how many there are */
} nt_curve_contact_method;
/* "crossing", "deviation", ...; NULL for no method. */
NT_API const char *nt_curve_contact_method_name(nt_curve_contact_method method);

/* One tearing-off on the retraction. */
typedef struct nt_curve_rupture {
    double z;     /* of the base [m] */
    double force; /* depth below the baseline right before it, positive [N] */
    double slope; /* dF/dz of the straight piece before it [N/m]; about -k_c where the tip was held fast */
    double step;  /* by which the force rises within a few points [N] */
} nt_curve_rupture;
enum { NT_CURVE_RUPTURES = 64 };

/* What the baseline of the retraction, and so its pull-off, rests on. */
typedef enum nt_curve_support {
    NT_CURVE_ALONE,  /* the retraction's own far half, not judged beside an approach */
    NT_CURVE_TAIL,   /* a free tail whose level drag explains */
    NT_CURVE_SHARED, /* the level of a short free tail, with the approach's tilt */
    NT_CURVE_BOUND   /* the approach less drag: nothing of the retraction is free, or it was offset by more than drag */
} nt_curve_support;

/* What a curve shows. The first branch is the approach, or the retraction where there is no approach. */
typedef struct nt_curve_reading {
    nt_curve_branch approach, retract;
    double contact_points[NT_CURVE_METHODS]; /* z of the first branch [m]; NaN: the method cannot say */
    nt_curve_measured contact_point;         /* their median [m]; their spread is in its sigma */
    nt_curve_support support;
    /* Depth of the retraction's lowest point if the tail is free, and if all of its offset is a tether that held to the
     * end [N]: the two cannot be told apart. least is no more than the force of a rupture that ends a slow decline, and
     * than what the approach does not repel by (a squeeze film). retract.dip.sigma contains the distances as those of
     * rectangular errors. */
    double pull_off_least, pull_off_most; /* what it grows by from the last point before a rupture to the next is in */
    double pull_off_sigma;                /* standard uncertainty of both ends [N] */
    double ringing;      /* amplitude at the lowest point, which both ends leave open; 0: none is evident [N] */
    double offset;       /* of the tail below the approach [N]; NaN where there is no tail or no approach */
    double offset_sigma; /* [N] */
    nt_curve_rupture rupture[NT_CURVE_RUPTURES]; /* from the sample outwards */
    int ruptures;                                /* how many */
} nt_curve_reading;

/* Reads a curve of which at least one branch has NT_CURVE_FEWEST points, else NT_E_RANGE. Arrays of *reading lie in
 * work. Errors of nt_curve_segment_check and nt_curve_fit_baseline. */
NT_API nt_status nt_curve_read(const nt_curve *curve, const nt_curve_choice *choice, double *work,
                               nt_curve_reading *reading, nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
