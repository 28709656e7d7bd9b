/* SPDX-License-Identifier: BSD-3-Clause
 * Contact of a rigid axisymmetric shape at one contact radius a, private to contact/. Galin's integrals for a profile
 * f(r) are those of a one-dimensional profile g(x) = x Int_0^x f'(r)/sqrt(x^2 - r^2) dr (Galin 1961; Sneddon 1965):
 *
 *     delta = g(a)     F = 2 E* Int_0^a (delta - g(x)) dx     U = E* Int_0^a (delta - g(x))^2 dx     k = 2 E* a
 *
 * Each shape gives the point in units of its own length L, as a function of a parameter p >= 0 in which nothing is
 * singular and no digits are lost. */
#ifndef NANOTOUCH_CONTACT_PROFILE_H
#define NANOTOUCH_CONTACT_PROFILE_H

typedef struct nt_profile_point {
    double radius; /* a/L */
    double depth;  /* delta/L */
    double force;  /* F/(2 E* L^2) */
    double energy; /* U/(E* L^3) */
} nt_profile_point;

/* Sphere, L = R, p = artanh(a/R). */
nt_profile_point nt_sphere_point(double p);
double nt_sphere_find_depth(double depth);
double nt_sphere_find_force(double force);

/* Cone with a rounded or flat end, L = b, the radius of its rim; p = arcosh(a/b), a >= b. */
typedef struct nt_rim {
    double cap;   /* slope b/R of the cap at the rim; 0: flat */
    double flank; /* slope cot(psi) of the cone, >= cap */
} nt_rim;
nt_profile_point nt_rim_point(const nt_rim *rim, double p);
double nt_rim_find_depth(const nt_rim *rim, double depth);
double nt_rim_find_force(const nt_rim *rim, double force);

#endif
