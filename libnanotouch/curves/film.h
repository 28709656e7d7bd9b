/* SPDX-License-Identifier: BSD-3-Clause
 * The squeeze film of a lever that comes near the sample in a fluid; private to curves/. */
#ifndef NANOTOUCH_CURVES_FILM_H
#define NANOTOUCH_CURVES_FILM_H

#include "nanotouch/curves.h"

/* strength/(z - pole) on the approach; nearer than `contact` it is not known and goes on as it was there. */
typedef struct nt_curve_film {
    double strength; /* [N m]; 0: none is evident */
    double pole;     /* z [m] */
    double contact;  /* z from which on it is seen [m] */
    double sigma;    /* of the strength [N m] */
} nt_curve_film;

/* Of a branch whose baseline is taken off, from its free part. */
nt_curve_film nt_curve_find_film(const nt_curve_branch *approach);
/* By how much it repels on the approach at z [N]. */
double nt_curve_film_at(const nt_curve_film *film, double z);
/* Whether the retraction beyond `start` shows the same with the other sign, as drag does and no force of surfaces. */
int nt_curve_film_is_odd(const nt_curve_film *film, const double *z, const double *force, long count, double start);

#endif
