/* SPDX-License-Identifier: BSD-3-Clause
 * Dents of the page's session, of a sample that keeps them (page.h). */
#include <string.h>

#include "page.h"

/* Those that are there, the oldest first: start, end of each [m], radius, depth [m], load [N], the one that it has
 * grown from or -1. How many. */
PAGE_API(page_dents) int page_dents(double rows[PAGE_DENT * NT_DENTS])
{
    const nt_dents *dents = nt_session_dents(page_the_session());
    if (!dents)
        return 0;
    for (int i = 0; i < dents->count; ++i, rows += PAGE_DENT) {
        const nt_dent *made = &dents->made[i];
        memcpy(rows, made->imprint.start, sizeof made->imprint.start);
        memcpy(rows + 2, made->imprint.end, sizeof made->imprint.end);
        rows[4] = made->imprint.radius;
        rows[5] = made->imprint.depth;
        rows[6] = made->load;
        rows[7] = made->before;
    }
    return dents->count;
}

/* Takes the last one back. */
PAGE_API(page_undent) int page_undent(void)
{
    page_the_world()->problem = (nt_problem){0};
    return (int)nt_session_undent(page_the_session());
}

/* How deep the dent is that a load [N] leaves [m]; 0: the sample stays elastic. */
PAGE_API(page_dent_depth) double page_dent_depth(double load)
{
    const nt_indentation *law = &page_the_world()->plan.indentation;
    return nt_indentation_first(law, nt_indentation_radius_at_load(law, load)).residual_depth;
}
