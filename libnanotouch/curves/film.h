/* SPDX-License-Identifier: BSD-3-Clause
 * What the squeeze film of a lever that comes near the sample in a fluid does to the pull-off; private to curves/. */
#ifndef NANOTOUCH_CURVES_FILM_H
#define NANOTOUCH_CURVES_FILM_H

#include "nanotouch/curves.h"

/* By how much the film of an approach's baseline repels at z [N]. */
double nt_curve_film_at(const nt_curve_bend *film, double z);
/* Whether the retraction beyond `start` shows the same with the other sign, as drag does and no force of surfaces. */
int nt_curve_film_is_odd(const nt_curve_bend *film, const double *z, const double *force, long count, double start);
/* What of a pull-off of that depth is more than the approach repels by at the same height, known to that doubt: no film
 * makes it [N]. */
double nt_curve_held_beyond_film(double depth, double doubt, const nt_curve_reading *reading);

#endif
