/* SPDX-License-Identifier: BSD-3-Clause
 * Particles of the page's session: what they are like, where they lie (page.h). */
#include <string.h>

#include "page.h"

static nt_particles made;
static int are_given;

/* For the next page_open: the values of nt_particle_fields, then those of nt_particles_fields; 0 of them: none. */
PAGE_API(page_particles) int page_particles(const double *values, int count)
{
    int of_one, of_all;
    const nt_field *fields = nt_particle_fields(&of_one), *others = nt_particles_fields(&of_all);
    nt_particles_setup setup = nt_particles_defaults();
    page_the_world()->problem = (nt_problem){0};
    are_given = 0;
    if (count == 0)
        return NT_OK;
    if (count != of_one + of_all)
        return NT_E_ARGUMENT;
    for (int i = 0; i < of_one; ++i)
        nt_field_set(&fields[i], &setup.particle, values[i]);
    for (int i = 0; i < of_all; ++i)
        nt_field_set(&others[i], &setup, values[of_one + i]);
    const nt_status status = nt_particles_init(&made, &setup, &page_the_world()->problem);
    are_given = status == NT_OK;
    return (int)status;
}

const nt_particles *page_given_particles(void)
{
    return are_given ? &made : NULL;
}

/* Lays one at rest at (x, y) [m]. */
PAGE_API(page_lay) int page_lay(int number, double x, double y)
{
    page_the_world()->problem = (nt_problem){0};
    return (int)nt_session_lay(page_the_session(), number, (double[2]){x, y});
}

/* Of each that lies there: x, y, z of its middle [m], its force on the tip [N], touches, losses. How many; 0 without
 * any. */
PAGE_API(page_laid) int page_laid(double found[PAGE_LAID * NT_PARTICLES])
{
    nt_session_particles laid;
    if (nt_session_read_particles(page_the_session(), &laid) != NT_OK)
        return 0;
    for (int i = 0; i < laid.count; ++i, found += PAGE_LAID) {
        memcpy(found, laid.position[i], sizeof laid.position[i]);
        memcpy(found + 3, laid.force[i], sizeof laid.force[i]);
        found[6] = laid.touches[i];
        found[7] = laid.losses[i];
    }
    return laid.count;
}
