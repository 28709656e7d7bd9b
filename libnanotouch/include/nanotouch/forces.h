/* SPDX-License-Identifier: BSD-3-Clause
 * Non-contact forces between a spherical tip and a flat, at gap h of the undeformed bodies (paper, Eq. 1, corrected:
 * docs/errata.md). Each law returns {U, F, k, a = 0}; U is 0 at infinite gap, F = -dU/dh, k = -dF/dh.
 * All functions: thread-safe, real-time safe; NaN in, NaN out. Parameters are checked once by nt_x_check(). */
#ifndef NANOTOUCH_FORCES_H
#define NANOTOUCH_FORCES_H

#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Van der Waals. */
typedef struct nt_vdw {
    double radius;           /* R of the tip [m] */
    double hamaker_constant; /* H [J], >= 0 */
    double roughness;        /* b, peak to peak [m], >= 0: the effective gap is h + b/2 (erratum E2) */
    double minimum_gap;      /* a0, the closest approach of the atoms [m], > 0: below it F stays at its value there (E1) */
} nt_vdw;
NT_API nt_status nt_vdw_check(const nt_vdw *vdw, nt_problem *problem);
/* Exact Hamaker sphere: F = -2 H R^3/(3 s^2 (s + 2R)^2), s = max(h, a0) + b/2. */
NT_API nt_law_value nt_vdw_eval(const nt_vdw *vdw, double gap);
/* The paper's Derjaguin form -H R/(6 s^2), valid for s << R: +36 % at h = 10 nm for R = 30 nm (erratum E1). */
NT_API nt_law_value nt_vdw_derjaguin_eval(const nt_vdw *vdw, double gap);

/* Capillary meniscus of a water film. */
typedef struct nt_capillary {
    double radius;          /* R of the tip [m] */
    double surface_tension; /* gamma_L [N/m], >= 0 */
    double meniscus_radius; /* r1 of the meniscus [m], > 0 */
    double film_thickness;  /* e of the film on each surface [m], >= 0 */
} nt_capillary;
NT_API nt_status nt_capillary_check(const nt_capillary *capillary, nt_problem *problem);
/* F = -4 pi gamma_L R [1 - (h - 2e)/(2 r1)], the bracket clamped to [0, 1] (errata E3): constant below 2e, 0 beyond
 * 2e + 2 r1. Whether there is a bridge at all is history: it forms at h <= 2e and ruptures beyond 2e + 2 r1; the caller
 * keeps that (scene.h, nt_interaction). */
NT_API nt_law_value nt_capillary_eval(const nt_capillary *capillary, double gap);
/* Kelvin radius of a meniscus: -gamma_L V_m/(R_gas T ln(RH)), relative_humidity in (0, 1), temperature [K]. */
NT_API double nt_kelvin_radius(double surface_tension, double molar_volume, double temperature, double relative_humidity);

/* Electrostatic force of a conducting sphere at potential difference U against a conducting plane. */
typedef struct nt_electrostatic {
    double radius;      /* R [m] */
    double potential;   /* U: contact potential (phi_1 - phi_2)/e plus any bias [V] */
    double minimum_gap; /* a0 [m], > 0: below it F stays at its value there */
} nt_electrostatic;
NT_API nt_status nt_electrostatic_check(const nt_electrostatic *electrostatic, nt_problem *problem);
/* F = -pi eps0 U^2 R^2/(h (h + R)) (Hudlet 1998; within 5.2 % of the exact image series for 0.2..100 nm, R = 30 nm; the
 * paper's plate law with S = 4 pi R r1 is 10.8 times too large at a0: erratum E5). */
NT_API nt_law_value nt_electrostatic_eval(const nt_electrostatic *electrostatic, double gap);

#ifdef __cplusplus
}
#endif
#endif
