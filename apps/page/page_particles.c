/* SPDX-License-Identifier: BSD-3-Clause
 * Particles and the rod of the page's session: what they are like (page.h). */
#include "page.h"

static nt_particles made;
static nt_rod rod;
static int are_given, rod_is_given;

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

/* The same of a rod: the values of nt_rod_fields; 0 of them: none. */
PAGE_API(page_rod) int page_rod(const double *values, int count)
{
    int fields_count;
    const nt_field *fields = nt_rod_fields(&fields_count);
    page_the_world()->problem = (nt_problem){0};
    rod_is_given = 0;
    if (count == 0)
        return NT_OK;
    if (count != fields_count)
        return NT_E_ARGUMENT;
    for (int i = 0; i < count; ++i)
        nt_field_set(&fields[i], &rod, values[i]);
    const nt_status status = nt_rod_check(&rod, &page_the_world()->problem);
    rod_is_given = status == NT_OK;
    return (int)status;
}

const nt_rod *page_given_rod(void)
{
    return rod_is_given ? &rod : NULL;
}
