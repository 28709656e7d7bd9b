/* SPDX-License-Identifier: BSD-3-Clause
 * The curve of plot_26_margins.py: rate of the loop (Hz), stability margin. */
#include <math.h>
#include <stdio.h>

#include "nanotouch/margins.h"
#include "nanotouch/plan.h"

enum { POINTS = 40 };

int main(void)
{
    const nt_scene scene = nt_scene_defaults();
    const nt_rig rig = nt_rig_defaults();
    nt_settings settings = nt_settings_defaults(&rig);
    static nt_plan plan;
    nt_problem problem;
    if (nt_plan_make(&plan, &(nt_plan_inputs){.scene = &scene}, &problem) != NT_OK)
        return 1;
    for (int i = 0; i < POINTS; ++i) {
        settings.gains.rate = 300.0 * pow(100.0, (double)i / (POINTS - 1));
        printf("%.12g %.12g\n", settings.gains.rate,
               nt_margins_compute(&rig, &settings.gains, plan.maximum_stiffness).margin);
    }
    return 0;
}
