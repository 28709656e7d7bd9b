/* SPDX-License-Identifier: BSD-3-Clause
 * A touch of round numbers, with none of a rig's own filters in the way. */
#ifndef TESTS_PLAIN_TOUCH_H
#define TESTS_PLAIN_TOUCH_H

#include "nanotouch/touch.h"

#define PERIOD 0.125

static inline nt_touch plain(nt_mode mode)
{
    const nt_rig rig = nt_rig_defaults();
    const nt_settings settings = nt_settings_defaults(&rig);
    nt_touch touch;
    assert_int_equal(nt_touch_make(&touch, &rig, &settings, NT_MODE_TOUCH, NULL), NT_OK);
    touch.mode = mode;
    touch.period = PERIOD;
    touch.settings.gains.rate = 1.0 / PERIOD;
    touch.rig.probe.spring_constant = 2.0;
    touch.spike = 4.0;
    touch.force_filter = 0.25;
    touch.speed_filter = 0.5;
    touch.stage_step = 1.0;
    touch.stage_end = 50.0;
    touch.settings.gains.ramp_time = 0.5;
    touch.rescale = (nt_rescale){.share = 1.0, .threshold = 1e9, .factors = {1.0, 1.0, 1.0}, .spring_constant = 2.0};
    touch.passivity = (nt_passivity){.dead_zone = 1e9, .period = PERIOD, .speed_filter = 1.0, .speed_limit = 1e9};
    touch.passivity_sideways = touch.passivity;
    return touch;
}

static inline nt_touch_state begun(const nt_touch *touch)
{
    nt_touch_state state = nt_touch_start(touch, 0.0, 0.0, 0.0);
    state.signals.scaling = state.rescale.now = state.rescale.wanted = (nt_scaling){0.5, 4.0};
    state.offset = 0.0;
    state.supervisor.seen = NT_SEES_ALL;
    state.fade.left = 1.0;
    return state;
}

static inline nt_sample read_of(double master, double force, double stage, double deflection)
{
    nt_sample sample = {.flags = 0u};
    sample.master_position[NT_Z] = master;
    sample.operator_force[NT_Z] = force;
    sample.stage_position[NT_Z] = stage;
    sample.deflection[NT_Z] = deflection;
    return sample;
}

#endif
