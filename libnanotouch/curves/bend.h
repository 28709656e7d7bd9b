/* SPDX-License-Identifier: BSD-3-Clause
 * What bends the free approach towards the sample; private to curves/. */
#ifndef NANOTOUCH_CURVES_BEND_H
#define NANOTOUCH_CURVES_BEND_H

#include "nanotouch/curves.h"

/* What the free approach leaves open of a bow of the baseline and of a squeeze film. */
typedef struct nt_curve_bend_doubts {
    double level;        /* variance of the force where contact begins [N^2] */
    double film;         /* how likely there is a film, 0 to 1; 1 where the free part is too short to say */
    double film_force;   /* its force where contact begins, RMS over the likely laws [N] */
    double film_sigma;   /* of that force about the one that was taken off [N] */
    double bow_sigma;    /* of the bow about the one that was taken off [N/m^2] */
    double middle, half; /* of the free part: its middle, half of its length [m] */
} nt_curve_bend_doubts;

/* Takes a bow, and the repulsion of a squeeze film, off an approach that was read, where its free part shows them: its
 * baseline has them from then on. tail: what is free of the retraction, over the approach's baseline; of it count, z,
 * force, noise and visible are read. work: where the approach's arrays lie, and 6 doubles for each of its points. */
nt_curve_bend_doubts nt_curve_unbend(const nt_curve_segment *segment, const nt_curve_branch *tail, double *work[2],
                                     nt_curve_branch *approach);
/* Makes the approach's level as uncertain as these doubts say. */
void nt_curve_doubt_level(const nt_curve_bend_doubts *doubts, nt_curve_branch *approach);
/* At z, x from the middle of the baseline [N]. */
double nt_curve_bend_at(const nt_curve_bend *bend, double z, double x);

#endif
