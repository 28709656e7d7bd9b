/* SPDX-License-Identifier: BSD-3-Clause
 * Scaling factors between hand and tip (paper, Sec. IV-C). */
#ifndef NANOTOUCH_SCALING_H
#define NANOTOUCH_SCALING_H

#include "nanotouch/rig.h"

#ifdef __cplusplus
extern "C" {
#endif

/* x_s = alpha_p x_m, f_m = alpha_f f_s (Eq. 16). */
typedef struct nt_scaling {
    double alpha_p; /* stage metres per master metre [m/m] */
    double alpha_f; /* operator newtons per tip newton [N/N] */
} nt_scaling;
/* The paper's heuristic rule (Eq. 19, 21 in SI; errata E17): the slave's path (clearance L + indentation and relief)
 * over the master's travel; the gauge's range over the probe's, from -attraction to the saturation of the electronics.
 */
NT_API nt_scaling nt_scaling_heuristic(const nt_rig *rig, double slave_path, double attraction);
/* Goldfarb's rules for l = alpha_p << 1: structure dominated 1/l, surface dominated 1/l^2 (Sec. IV-C). */
NT_API nt_scaling nt_scaling_structure(double alpha_p);
NT_API nt_scaling nt_scaling_surface(double alpha_p);

#ifdef __cplusplus
}
#endif
#endif
