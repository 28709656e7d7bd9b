/* SPDX-License-Identifier: BSD-3-Clause
 * A table in the making; private to scene/deformation/. */
#ifndef NANOTOUCH_SCENE_MARCH_H
#define NANOTOUCH_SCENE_MARCH_H

#include "scene/deformation/deform.h"

typedef struct nt_deform_maker {
    nt_deform_table *table;
    nt_deform_solver solver;
    const nt_deform_range *range;
    nt_deform_hold hold;
    double end;  /* of what is held */
    double pull; /* at the jump [N] */
    nt_deform_point last;
} nt_deform_maker;

/* table.c: point after point until what is held is at its end, or the range is; the first step of it. */
nt_status nt_deform_march(nt_deform_maker *m, int part, double step);
/* U of each node; of a contact that holds it begins with `energy`. */
void nt_deform_integrate(nt_deform_table *table, double energy);

#endif
