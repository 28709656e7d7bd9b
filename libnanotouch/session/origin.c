/* SPDX-License-Identifier: BSD-3-Clause
 * Two sessions are the same when nothing that they were opened with, or have been changed to, differs. */
#include "session/origin.h"
#include "core/problem.h"

#include <math.h>
#include <string.h>

#define FIELD(path, unit, doc) NT_FIELD(nt_origin, path, unit, -INFINITY, INFINITY, doc)

static const nt_field origin_fields[] = {
    FIELD(mode, NT_MODE_WORDS, "at opening"),
    FIELD(x, "m", "where it starts"),
    FIELD(y, "m", "where it starts"),
    FIELD(clearance, "m", "at opening"),
    FIELD(rise, "m", "that the master may draw back for"),
    FIELD(probe_model, NT_PROBE_WORDS, "of the cantilever"),
    FIELD(substep, "rad", "of the cantilever"),
    FIELD(preflight, "no|yes", "before the first tick"),
    FIELD(path, "", "check sum of its points"),
    FIELD(faults, "", "check sum of those from switching on"),
    FIELD(particles, "", "check sum of what they are like"),
    FIELD(rod, "", "check sum of what it is like"),
};

/* FNV-1a over the bytes of numbers. */
static double check_sum(double sum, const double *numbers, long count)
{
    uint32_t hash = (uint32_t)sum;
    for (long i = 0; i < count; ++i) {
        unsigned char bytes[sizeof *numbers];
        memcpy(bytes, &numbers[i], sizeof bytes);
        for (size_t k = 0; k < sizeof bytes; ++k)
            hash = (hash ^ bytes[k]) * 16777619u;
    }
    return (double)(hash % 999983u); /* six digits can be told apart */
}

static double check_sum_of_faults(const nt_faults *faults)
{
    double sum = 2166136261.0;
    for (int i = 0; faults && i < faults->count; ++i) {
        const nt_fault *fault = &faults->list[i];
        const double numbers[] = {(double)fault->kind, (double)fault->channel, fault->start, fault->duration,
                                  fault->value};
        sum = check_sum(sum, numbers, 5);
    }
    return sum;
}

static double check_sum_of_particles(const nt_particles *particles)
{
    if (!particles)
        return 0.0;
    const nt_particle_contact *contacts[] = {&particles->pushing.particle.contacts[NT_AT_SUBSTRATE],
                                             &particles->pushing.particle.contacts[NT_AT_TIP], &particles->between};
    const nt_particle *of = &particles->pushing.particle;
    const double own[] = {of->radius, of->tip_radius, of->tip_half_angle, of->step};
    double sum = check_sum(2166136261.0, own, 4);
    for (int i = 0; i < 3; ++i) {
        const nt_particle_contact *c = contacts[i];
        const double numbers[] = {c->model,           c->effective_modulus,       c->work_of_adhesion,
                                  c->cohesive_stress, c->effective_shear_modulus, c->shear_strength,
                                  c->coefficient,     c->rolling_distance};
        sum = check_sum(sum, numbers, 8);
    }
    return sum;
}

static double check_sum_of_rod(const nt_rod *rod)
{
    int count;
    const nt_field *fields = nt_rod_fields(&count);
    double sum = 2166136261.0;
    for (int i = 0; rod && i < count; ++i)
        sum = check_sum(sum, (double[]){nt_field_get(&fields[i], rod)}, 1);
    return rod ? sum : 0.0;
}

nt_origin nt_origin_of(const nt_session_setup *setup)
{
    return (nt_origin){.seed = setup->seed,
                       .demand = setup->demand,
                       .mode = setup->mode,
                       .x = setup->x,
                       .y = setup->y,
                       .clearance = setup->clearance,
                       .rise = setup->rise,
                       .probe_model = setup->probe_model,
                       .substep = setup->substep,
                       .preflight = setup->preflight != 0,
                       .path = check_sum(2166136261.0, setup->path, setup->path ? 2 * setup->path_count : 0),
                       .faults = check_sum_of_faults(setup->faults),
                       .particles = check_sum_of_particles(setup->particles),
                       .rod = check_sum_of_rod(setup->rod)};
}

static nt_status differ(nt_problem *problem, const char *field, const char *unit, double kept, double own)
{
    if (problem)
        *problem = nt_problem_of(field, unit, kept, own, own);
    return NT_E_STATE;
}

static int is_same(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* The scales do not count. */
static nt_status compare(const nt_field *fields, int count, const void *kept, const void *own, nt_problem *problem)
{
    for (int i = 0; i < count; ++i) {
        const double a = nt_field_get(&fields[i], kept), b = nt_field_get(&fields[i], own);
        const int is_scale =
            strcmp(fields[i].name, "gains.alpha_p") == 0 || strcmp(fields[i].name, "gains.alpha_f") == 0;
        if (!is_scale && !is_same(a, b))
            return differ(problem, fields[i].name, fields[i].unit, a, b);
    }
    return NT_OK;
}

nt_status nt_origin_check(const nt_origin *kept, const nt_origin *own, nt_problem *problem)
{
    int count;
    if (kept->seed != own->seed)
        return differ(problem, "seed", "", (double)kept->seed, (double)own->seed);
    const nt_field *fields = nt_demand_fields(&count);
    const nt_status status = compare(fields, count, &kept->demand, &own->demand, problem);
    if (status != NT_OK)
        return status;
    return compare(origin_fields, (int)(sizeof origin_fields / sizeof *origin_fields), kept, own, problem);
}

nt_status nt_origin_check_setup(const nt_session_setup *kept, const nt_session_setup *own, nt_problem *problem)
{
    int count;
    const nt_field *fields = nt_scene_fields(&count);
    nt_status status = compare(fields, count, &kept->scene, &own->scene, problem);
    fields = nt_settings_fields(&count);
    if (status == NT_OK)
        status = compare(fields, count, &kept->settings, &own->settings, problem);
    fields = nt_rig_fields(&count);
    if (status == NT_OK)
        status = compare(fields, count, &kept->rig, &own->rig, problem);
    const nt_control_choice a = kept->settings.control.choice, b = own->settings.control.choice;
    if (status == NT_OK && a != b)
        status = differ(problem, "control.choice", NT_CONTROL_WORDS, (double)a, (double)b);
    if (status == NT_OK &&
        (kept->surface != own->surface || kept->map.heights != own->map.heights || kept->properties != own->properties))
        status = differ(problem, "another surface", "", 1.0, 0.0);
    return status;
}
