/* SPDX-License-Identifier: BSD-3-Clause
 * Laws of one's own: what a scene describes by functions (nt_scene.custom) enters a plan as a table, one row for each
 * place. */
#include <math.h>
#include <string.h>

#include "forces/law.h"
#include "scene/terms/term.h"

/* Refusals are by place, since a problem's words must outlive the scene. */
static nt_status tabulate(void *law, const nt_scene *scene, int place, nt_problem *problem)
{
    static const char *const fields[NT_CUSTOM_TERMS][2] = {{"custom[0].law", "custom[0].bound"},
                                                           {"custom[1].law", "custom[1].bound"},
                                                           {"custom[2].law", "custom[2].bound"},
                                                           {"custom[3].law", "custom[3].bound"}};
    static const nt_custom_table none = {.count = 0};
    nt_custom_table *table = law;
    const nt_custom_term *custom = &scene->custom[place];
    *table = none;
    if (custom->name[0] == '\0')
        return NT_OK;
    nt_problem found = {.field = fields[place][0], .unit = ""};
    nt_status status = NT_E_ARGUMENT;
    if (custom->law && custom->bound && memchr(custom->name, '\0', NT_CUSTOM_NAME)) {
        memcpy(table->name, custom->name, strlen(custom->name) + 1u);
        table->radius = scene->tip.radius;
        status = nt_custom_tabulate(table, custom, scene, &found);
    }
    if (status != NT_OK && problem) {
        *problem = found;
        problem->field = fields[place][found.field == NULL];
    }
    return status;
}

static nt_form full_form(const void *law)
{
    return ((const nt_custom_table *)law)->count == 0 ? NT_FORM_OFF : NT_FORM_TABLE;
}

static nt_law_value eval(const void *law, nt_form form, double gap)
{
    (void)form;
    const nt_custom_table *table = law;
    const double hold = table->gap[0], h = nt_law_gap(gap, hold);
    if (isnan(gap))
        return (nt_law_value){gap, gap, gap, gap};
    const int i = nt_custom_cell(table, h);
    if (i < 0)
        return (nt_law_value){0};
    const double per_width = 1.0 / (table->gap[i + 1] - table->gap[i]), t = (h - table->gap[i]) * per_width;
    const double *c = table->U[i];
    const double U = c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5]))));
    const double slope = c[1] + t * (2.0 * c[2] + t * (3.0 * c[3] + t * (4.0 * c[4] + t * 5.0 * c[5])));
    const double curvature = 2.0 * c[2] + t * (6.0 * c[3] + t * (12.0 * c[4] + t * 20.0 * c[5]));
    const nt_law_value value = {.U = U, .F = -slope * per_width, .k = curvature * per_width * per_width};
    return nt_law_hold(value, hold - gap);
}

static double hold(const void *law)
{
    return ((const nt_custom_table *)law)->gap[0];
}

/* What is stated from the cell on; nothing is known of the stiffness beyond the last gap, where there is no force. */
static nt_law_value limit(const void *law, double gap)
{
    const nt_custom_table *table = law;
    const int cell = nt_custom_cell(table, fmax(gap, table->gap[0])), i = cell < 0 ? table->count : cell;
    return (nt_law_value){.F = table->largest_force[i], .k = table->largest_stiffness[i]};
}

static double error(const void *law, nt_quantity quantity)
{
    const nt_custom_table *table = law;
    return quantity == NT_QUANTITY_FORCE       ? table->force_error
           : quantity == NT_QUANTITY_STIFFNESS ? table->stiffness_error
                                               : 0.0;
}

static int edges(const void *law, const double **gaps)
{
    const nt_custom_table *table = law;
    *gaps = table->gap;
    return table->count == 0 ? 0 : table->count + 1;
}

/* By Derjaguin's relation from the sphere's F = 2 pi R W; inside the first gap that of the first gap. */
static nt_pressure pressure(const void *law, double gap)
{
    const nt_custom_table *table = law;
    const double h = fmax(gap, table->gap[0]), per_area = 2.0 * NT_PI * table->radius;
    const int i = nt_custom_cell(table, h);
    if (i < 0)
        return (nt_pressure){0.0, 0.0, 0.0};
    const nt_law_value value = eval(law, NT_FORM_TABLE, h);
    const double width = table->gap[i + 1] - table->gap[i], t = (h - table->gap[i]) / width;
    const double *c = table->U[i], third = 6.0 * c[3] + t * (24.0 * c[4] + t * 60.0 * c[5]);
    return (nt_pressure){value.F / per_area, value.k / per_area, third / (width * width * width) / per_area};
}

static const char *name_of(const void *law)
{
    const nt_custom_table *table = law;
    return table->count == 0 ? "" : table->name;
}

static const nt_term_form forms[] = {{NT_FORM_TABLE, 1.1, 0.95, "tabulated"}};

#define CUSTOM(ID, name_, type)                                                                                        \
    static nt_status tabulate_##name_(void *law, const nt_scene *scene, nt_problem *problem)                           \
    {                                                                                                                  \
        return tabulate(law, scene, NT_PLAN_##ID - NT_PLAN_CUSTOM_1, problem);                                         \
    }                                                                                                                  \
    NT_TERM_BESIDE(name_, NULL, full_form, eval, hold, pressure,                                                       \
                   .words = {#name_, #name_, "a law of one's own", NULL, forms, 1, 1}, .limit = limit,                 \
                   .tabulate = tabulate_##name_, .error = error, .edges = edges, .name_of = name_of,                   \
                   .noun = "a law of its own");
NT_TERMS_CUSTOM(CUSTOM)
