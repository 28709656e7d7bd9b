/* SPDX-License-Identifier: BSD-3-Clause
 * The contact branch of Maugis-Dugdale as an explicit function of one parameter; private to contact/. */
#ifndef NANOTOUCH_CONTACT_MAUGIS_BRANCH_H
#define NANOTOUCH_CONTACT_MAUGIS_BRANCH_H

#include "nanotouch/contact.h"

/* One equilibrium in reduced units (reduced.h). */
typedef struct nt_maugis_equilibrium {
    double y;      /* a/b, the branch parameter */
    double a, b;   /* radius of contact; b = sqrt(c^2 - a^2), c the outer radius of the cohesive zone */
    double P, d;   /* load, indentation */
    double P1, d1; /* (dP/dy)/y and (dd/dy)/y: both finite at y = 0, so that dP/dd = P1/d1 is too */
    double a1, b1; /* da/dy and (db/dy)/y */
} nt_maugis_equilibrium;

/* The equilibrium at y >= 0; no iteration. */
void nt_maugis_equilibrium_at(double lambda, double y, nt_maugis_equilibrium *point);

/* d(d1)/dy there: what curves d(y) at its fold, where d1 = 0. */
double nt_maugis_equilibrium_curvature(double lambda, const nt_maugis_equilibrium *point);

/* Its energy U, with dU/dd = P and U = 0 for bodies apart. */
double nt_maugis_equilibrium_energy(double lambda, const nt_maugis_equilibrium *point);

/* dU/dlambda there at constant d. */
double nt_maugis_equilibrium_energy_slope(double lambda, const nt_maugis_equilibrium *point);

/* y at a contact radius, within some 30 %: where the solvers start. */
double nt_maugis_parameter_guess(double lambda, double a);

#endif
