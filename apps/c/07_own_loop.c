/* SPDX-License-Identifier: BSD-3-Clause
 * A loop of one's own around the touch step: it takes what was measured and says what motor and stage shall do. Here a
 * dynamic cantilever over an elastic surface answers; on a rig the sample comes from converters. */
#include <stdio.h>

#include "nanotouch/dynamics.h"
#include "nanotouch/touch.h"

enum { STEPS = 30000 };
#define START 5e-9 /* of the lever's base above the surface [m] */
#define GIVES 1.0  /* stiffness of the surface [N/m] */

static nt_law_value elastic(void *context, double height)
{
    (void)context;
    const double depth = height < 0.0 ? -height : 0.0; /* [m] */
    return (nt_law_value){.U = 0.5 * GIVES * depth * depth, .F = GIVES * depth, .k = depth > 0.0 ? GIVES : 0.0};
}

int main(void)
{
    static nt_touch touch;
    static nt_touch_state state;
    static nt_cantilever_model lever;
    nt_rig rig = nt_rig_defaults();
    rig.probe.temperature = 0.0; /* no thermal motion: no noise source is needed */
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_status status = nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL);
    if (status == NT_OK)
        status = nt_cantilever_model_init(&lever, &rig.probe, touch.period, 0.25);
    if (status != NT_OK) {
        fprintf(stderr, "%s\n", nt_status_message(status));
        return 1;
    }
    state = nt_touch_start(&touch, 0.0, 0.0, 0.0);
    nt_cantilever_state tip = nt_cantilever_at(START);
    const nt_force_field field = {.eval = elastic, .length = 1e-9};
    nt_command command = {0};
    for (long i = 0; i < STEPS && status == NT_OK; ++i) {
        nt_sample sample = {.tick = (uint64_t)i};
        sample.master_position[NT_Z] = 4e-3 * (double)i / STEPS; /* the hand moves down by 4 mm */
        sample.stage_position[NT_Z] = command.stage_position[NT_Z];
        sample.deflection[NT_Z] = tip.deflection;
        nt_touch_step(&touch, &state, &sample, &command);
        status = nt_cantilever_step(&lever, &tip, &field, START - command.stage_position[NT_Z], NULL);
        if (i % (STEPS / 6) == 0)
            printf("%5.2f s: stage %7.1f nm, probe %7.2f nN, motor %6.3f N, state %u\n", (double)i * touch.period,
                   command.stage_position[NT_Z] * 1e9, rig.probe.spring_constant * tip.deflection * 1e9,
                   command.motor_force[NT_Z], command.state);
    }
    return status == NT_OK && command.state == NT_RUN ? 0 : 1;
}
