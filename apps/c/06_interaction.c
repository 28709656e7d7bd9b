/* SPDX-License-Identifier: BSD-3-Clause
 * An interaction: the force at poses on the way down and up again. It remembers contact and meniscus, so the way up
 * differs, and what the jumps dissipate is the area between both. */
#include <stdio.h>

#include "nanotouch/interaction.h"

enum { STEPS = 8 };

static void move(const nt_plan *plan, nt_interaction_state *state, double height)
{
    const nt_pose pose = {.z = height};
    nt_interaction_advance(plan, state, &pose); /* commits history: once per accepted step */
    const nt_interaction_value value = nt_interaction_eval(plan, state, &pose); /* pure: any pose may be asked */
    printf("%8.2f nm %10.3f nN %10.3f N/m\n", height * 1e9, value.Fz * 1e9, value.k);
}

int main(void)
{
    static nt_plan plan;
    const nt_scene scene = nt_scene_defaults();
    nt_problem problem = {0};
    const nt_status status = nt_plan_make(&plan, &(nt_plan_inputs){.scene = &scene}, &problem);
    if (status != NT_OK) {
        fprintf(stderr, "%s\n", nt_status_message(status));
        return 1;
    }
    nt_interaction_state state = {0}; /* never touched */
    for (int i = 0; i <= STEPS; ++i)
        move(&plan, &state, 3e-9 - 0.5e-9 * i);
    for (int i = STEPS; i >= 0; --i)
        move(&plan, &state, 3e-9 - 0.5e-9 * i);
    printf("dissipated by jumps: %.3g J\n", state.dissipated);
    return 0;
}
