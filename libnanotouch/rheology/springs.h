/* SPDX-License-Identifier: BSD-3-Clause
 * Springs under the tip; private to rheology/. */
#ifndef NANOTOUCH_RHEOLOGY_SPRINGS_H
#define NANOTOUCH_RHEOLOGY_SPRINGS_H

#include "rheology/run.h"

/* Springs in the middle of parts of the contact radius (of the stiffness on a layer) that end at (i/count)^grading: the
 * indentations [m] that reach them, and their shares of the stiffness over E [m]. */
void nt_springs_place(const nt_profile *profile, double deepest, double grading, int count, double *depth,
                      double *weight);

/* Doubles that a history by springs needs. */
long nt_springs_workspace(int parameters);
/* A whole history, from its first point on; `put` takes what is found at a point. */
typedef void nt_springs_put(const nt_run *run, const nt_viscoelastic_result *result, long point);
nt_status nt_springs_run(nt_run *run, const nt_viscoelastic_path *path, nt_springs_put *put,
                         const nt_viscoelastic_result *result);

#endif
