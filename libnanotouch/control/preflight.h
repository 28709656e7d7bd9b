/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what the public header does not have. */
#ifndef NANOTOUCH_CONTROL_PREFLIGHT_PRIVATE_H
#define NANOTOUCH_CONTROL_PREFLIGHT_PRIVATE_H

#include "nanotouch/advanced/control.h"

/* What preflight does and allows on this rig, from its noise, ranges and rate. */
nt_preflight nt_preflight_make(const nt_rig *rig, const nt_settings *settings);
/* How long it takes in all [s]. Nobody touches meanwhile, and nobody watches the force: it ends clear of the surface.
 */
double nt_preflight_time(const nt_preflight *preflight);
/* The limit that a verdict is about, its value and range; "" for none. */
nt_problem nt_preflight_problem(const nt_preflight *preflight, const nt_preflight_state *state);
/* Takes it off a sample. A deflection at the end of its range keeps NT_SAMPLE_SATURATED. */
NT_REALTIME void nt_tare_apply(const nt_tare *tare, const nt_probe *probe, nt_sample *sample);

#endif
