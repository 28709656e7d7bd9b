/* SPDX-License-Identifier: BSD-3-Clause
 * The laws over arrays of gaps, for the Python package. */
#ifndef NANOTOUCH_INTERNAL_FORCES_H
#define NANOTOUCH_INTERNAL_FORCES_H

#include "nanotouch/forces.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The same over arrays of gaps [m]. */
NT_API void nt_vdw_eval_n(const nt_vdw *vdw, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_vdw_derjaguin_eval_n(const nt_vdw *vdw, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_vdw_tip_eval_n(const nt_vdw_tip *tip, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_capillary_eval_n(const nt_capillary *capillary, const nt_strided *arrays);
/* The force along a path: gaps in order, *bridged before the first and, on return, after the last. */
NT_API void nt_capillary_trace_n(const nt_capillary *capillary, int *bridged, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_electrostatic_eval_n(const nt_electrostatic *electrostatic, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_electrostatic_plate_eval_n(const nt_electrostatic_plate *plate, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_electrostatic_tip_eval_n(const nt_electrostatic_tip *tip, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_electrostatic_lever_eval_n(const nt_electrostatic_lever *lever, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_point_charge_eval_n(const nt_point_charge *charge, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_lennard_jones_eval_n(const nt_lennard_jones *lennard_jones, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_double_layer_potential_eval_n(const nt_double_layer *layer, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_double_layer_charge_eval_n(const nt_double_layer *layer, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_hydration_eval_n(const nt_hydration *hydration, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_steric_eval_n(const nt_steric *steric, const nt_strided *arrays);
/* The same over arrays of gaps [m]. */
NT_API void nt_steric_exponential_eval_n(const nt_steric *steric, const nt_strided *arrays);

#ifdef __cplusplus
}
#endif
#endif
