/* SPDX-License-Identifier: BSD-3-Clause
 * A plan: which forces matter for a silicon tip on silicon in humid air, computed how, for two demands. */
#include <stdio.h>

#include "nanotouch/plan.h"

static int print_plan(double accuracy)
{
    static nt_plan plan;
    const nt_scene scene = nt_scene_defaults();
    nt_demand demand = nt_demand_defaults();
    demand.relative_accuracy = accuracy;
    nt_problem problem = {0};
    char text[200];
    const nt_status status = nt_plan_make(&plan, &(nt_plan_inputs){.scene = &scene, .demand = &demand}, &problem);
    if (status != NT_OK) {
        fprintf(stderr, "%s: %s\n", nt_status_message(status), nt_problem_print(&problem, text, sizeof text));
        return 1;
    }
    printf("forces within %g %%: pull-off %.2f nN\n", 100.0 * accuracy, plan.pull_off_force * 1e9);
    for (int i = 0; i < NT_PLAN_TERMS; ++i)
        if (plan.terms[i].form != NT_FORM_OFF)
            printf("  %-14s %s\n", nt_term_words_of(i)->title, nt_form_name(plan.terms[i].form));
    return 0;
}

int main(void)
{
    return print_plan(0.1) || print_plan(1e-3);
}
