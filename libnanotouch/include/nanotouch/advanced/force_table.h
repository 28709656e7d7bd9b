/* SPDX-License-Identifier: BSD-3-Clause
 * The force of a plan in single precision: cubics over the gap, as constants, for a controller that has no time to
 * plan. Also in tools/single.py's sources, where a header that `nanotouch plan --c-header` wrote gives the constants.
 */
#ifndef NANOTOUCH_FORCE_TABLE_H
#define NANOTOUCH_FORCE_TABLE_H

#include "nanotouch/plan.h"

#ifdef __cplusplus
extern "C" {
#endif

/* F = c[0] + u (c[1] + u (c[2] + u c[3])), u = (h - gap) per_width from 0 to 1. */
typedef struct nt_force_piece {
    float gap;       /* h where it begins; it ends where the next one does [m] */
    float per_width; /* 1 over its width [1/m] */
    float cubic[4];  /* c [N] */
} nt_force_piece;

/* Immutable after nt_force_table_make. */
typedef struct nt_force_table {
    const nt_force_piece *pieces; /* borrowed; by rising gap: first those in contact, then those apart */
    int contact, apart;           /* how many of each */
    float capture_gap;            /* at and below it the tip is in contact, from wherever it comes [m] ... */
    float release_gap;            /* ... and a tip in contact stays so up to here [m] */
    float farthest;               /* apart there is no force beyond this gap [m] */
    float scale;                  /* S: errors are over max(|F|, S) [N] */
    float bound;                  /* largest error beside the plan, over max(|F|, S) [-] */
    float fold_distance;          /* from this far from a fold, a jump or first touch on it holds [m] */
} nt_force_table;

enum { NT_FORCE_PIECES = 1024 }; /* enough for nt_force_table_make in nearly every scene */

/* Makes the table of a plan in pieces[capacity], which must outlive it: from the indentation at the largest load to
 * where less force is left than may be missed. The error is looked for at 68 gaps of each piece; it is at most a tenth
 * of the plan's relative accuracy, of a finer plan 4e-6, and by what the plan's own tables jump between their cells,
 * some 1e-6. Of a plan for another quantity than force it is 4e-6. *problem (NULL allowed) says in words what has no
 * table. NT_E_RANGE: a plan over a surface, of a sample that keeps dents, a force that is too large or too small for
 * single precision, one that is felt beyond 1 mm. NT_E_NO_SOLUTION: the plan has no force at some gap. NT_E_CAPACITY:
 * it needs more pieces. Allocates nothing; some milliseconds. */
NT_API nt_status nt_force_table_make(nt_force_table *table, nt_force_piece *pieces, int capacity, const nt_plan *plan,
                                     nt_problem *problem);

/* Force on the tip, + away from the sample, and dF/d(delta) = -dF/dh. */
typedef struct nt_force_here {
    float force;     /* [N] */
    float stiffness; /* [N/m] */
} nt_force_here;

/* At a gap h of the undeformed bodies [m], from far away or from contact: *attached is 0 at first, and kept between
 * calls. Deeper than the largest load the force goes on with its last slope. NaN gives NaN and changes nothing. */
NT_API NT_REALTIME nt_force_here nt_force_table_eval(const nt_force_table *table, int *attached, float gap);

#ifdef __cplusplus
}
#endif
#endif
