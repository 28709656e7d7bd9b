/* SPDX-License-Identifier: BSD-3-Clause
 * A law of one's own: a soft repulsion A exp(-h/L) beside the library's laws, planned like one of them. */
#include <math.h>
#include <stdio.h>

#include "nanotouch/interaction.h"

typedef struct repulsion {
    double force, length; /* A [N], L [m] */
} repulsion;

static nt_law_value law(const void *context, double gap)
{
    const repulsion *one = context;
    const double force = one->force * exp(-gap / one->length);
    return (nt_law_value){.U = force * one->length, .F = force, .k = force / one->length};
}

/* It falls with the gap: nowhere beyond is |F| larger than here. */
static double bound(const void *context, double gap)
{
    return law(context, gap).F;
}

int main(void)
{
    static nt_plan plan;
    const repulsion soft = {2e-9, 5e-9};
    nt_scene scene = nt_scene_defaults();
    scene.custom[0] = (nt_custom_term){.name = "soft repulsion", .law = law, .bound = bound, .context = &soft};
    nt_problem problem = {0};
    char text[200];
    const nt_status status = nt_plan_make(&plan, &(nt_plan_inputs){.scene = &scene}, &problem);
    if (status != NT_OK) {
        fprintf(stderr, "%s: %s\n", nt_status_message(status), nt_problem_print(&problem, text, sizeof text));
        return 1;
    }
    const nt_interaction_state state = {0};
    for (int i = 2; i <= 10; i += 2) {
        const nt_pose pose = {.z = i * 1e-9};
        const double whole = nt_interaction_eval(&plan, &state, &pose).Fz;
        printf("gap %2d nm: %7.3f nN in all, %6.3f nN of this law\n", i, whole * 1e9, law(&soft, i * 1e-9).F * 1e9);
    }
    return 0;
}
