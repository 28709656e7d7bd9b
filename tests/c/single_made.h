/* SPDX-License-Identifier: BSD-3-Clause
 * For tests of the double step that tools/single.py turns into tests of the single one: what is made before the first
 * step is made in double, of a rig and settings whose numbers single precision holds. */
#ifndef TESTS_SINGLE_MADE_H
#define TESTS_SINGLE_MADE_H

#include "internal/control.h"
#include "nanotouch/advanced/control.h"
#include "nanotouch/margins.h"
#include "nanotouch/touch.h"
#include "nanotouch_single_of.h"

/* Structs of nothing but numbers, in the same order. */
static inline void widen(double *to, const float *from, size_t count)
{
    for (size_t i = 0; i < count; ++i)
        to[i] = (double)from[i];
}
#define WIDEN(to, from)                                                                                                \
    do {                                                                                                               \
        _Static_assert(sizeof(to) / sizeof(double) == sizeof(from) / sizeof(float), "numbers alone");                  \
        widen((double *)&(to), (const float *)&(from), sizeof(to) / sizeof(double));                                   \
    } while (0)

/* It holds choices beside its numbers. */
static inline nt_master widened_master(const ntf_master *from)
{
    return (nt_master){.mass = (double)from->mass,
                       .damping = (double)from->damping,
                       .friction = (double)from->friction,
                       .travel = (double)from->travel,
                       .resolution = (double)from->resolution,
                       .max_force = (double)from->max_force,
                       .max_speed = (double)from->max_speed,
                       .gauge = from->gauge,
                       .gauge_range = (double)from->gauge_range,
                       .gauge_noise = (double)from->gauge_noise,
                       .gauge_resolution = (double)from->gauge_resolution,
                       .motor = from->motor,
                       .rate = (double)from->rate,
                       .axes = (double)from->axes};
}

static inline nt_rig widened_rig(const ntf_rig *from)
{
    nt_rig rig = {.master = widened_master(&from->master)};
    WIDEN(rig.probe, from->probe);
    WIDEN(rig.stage, from->stage);
    WIDEN(rig.hand, from->hand);
    WIDEN(rig.converters, from->converters);
    return rig;
}

/* It holds choices, too. */
static inline nt_tap widened_tap(const ntf_tap *from)
{
    return (nt_tap){.at = from->at,
                    .frequency = (double)from->frequency,
                    .free_amplitude = (double)from->free_amplitude,
                    .tolerance = (double)from->tolerance,
                    .hold = from->hold,
                    .set_amplitude = (double)from->set_amplitude,
                    .set_phase = (double)from->set_phase,
                    .lock_in = (double)from->lock_in,
                    .noise = (double)from->noise,
                    .resolution = (double)from->resolution};
}

static inline nt_settings widened_settings(const ntf_settings *from)
{
    nt_settings settings = {.control.choice = (nt_control_choice)from->control.choice, .tap = widened_tap(&from->tap)};
    WIDEN(settings.gains, from->gains);
    WIDEN(settings.limits, from->limits);
    return settings;
}

static inline ntf_rig ntf_rig_defaults(void)
{
    const nt_rig rig = nt_rig_defaults();
    return ntf_rig_of(&rig);
}

static inline ntf_settings ntf_settings_defaults(const ntf_rig *rig)
{
    const nt_rig wide = widened_rig(rig);
    const nt_settings settings = nt_settings_defaults(&wide);
    return ntf_settings_of(&settings);
}

static inline ntf_status ntf_touch_make(ntf_touch *touch, const ntf_rig *rig, const ntf_settings *settings,
                                        ntf_mode mode, nt_problem *problem)
{
    const nt_rig wide_rig = widened_rig(rig);
    const nt_settings wide_settings = widened_settings(settings);
    nt_touch made;
    const nt_status status = nt_touch_make(&made, &wide_rig, &wide_settings, (nt_mode)mode, problem);
    if (status == NT_OK)
        *touch = ntf_touch_of(&made);
    return (ntf_status)status;
}

static inline ntf_supervisor ntf_supervisor_make(const ntf_rig *rig, const ntf_settings *settings)
{
    const nt_rig wide_rig = widened_rig(rig);
    const nt_settings wide_settings = widened_settings(settings);
    const nt_supervisor made = nt_supervisor_make(&wide_rig, &wide_settings);
    return ntf_supervisor_of(&made);
}

static inline float ntf_probe_deflection_range(const ntf_probe *probe)
{
    return probe->range * probe->sensitivity;
}

#define ntf_reason_name nt_reason_name
#define ntf_problem nt_problem
#endif
