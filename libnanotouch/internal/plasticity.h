/* SPDX-License-Identifier: BSD-3-Clause
 * Tables of fields, and many steps at once. */
#ifndef NANOTOUCH_INTERNAL_PLASTICITY_H
#define NANOTOUCH_INTERNAL_PLASTICITY_H

#include "nanotouch/advanced/plasticity.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A tip of 20 nm on gold (E* = 77 GPa, Y = 0.35 GPa). */
NT_API nt_indentation nt_indentation_defaults(void);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_indentation_fields(int *count);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_displacement_fields(int *count);
/* A tip of 20 nm on gold (H = 1.05 GPa), tau = 50 MPa, no layer. */
NT_API nt_scratching nt_scratching_defaults(void);
/* The table of its fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_scratching_fields(int *count);
/* Many steps: the state after each; stops at the first that is refused. */
NT_API nt_status nt_indentation_run_n(const nt_indentation *indentation, nt_indentation_state *state,
                                      const double *depths, nt_indentation_state *states, long count);
/* The pixels that an imprint with its ridge lies in; the volumes are 0. NT_OK; NT_E_ARGUMENT; NT_E_NOT_FINITE;
 * NT_E_RANGE with a problem: radius below NT_IMPRINT_PIXELS pixels, a ridge narrower than 2, beyond the map. */
NT_API nt_status nt_imprint_extent(const nt_imprint *imprint, const nt_displacement *displacement,
                                   const nt_height_map *map, nt_edit *edit, nt_problem *problem);

#ifdef __cplusplus
}
#endif
#endif
