/* SPDX-License-Identifier: BSD-3-Clause
 * The probe of the simulated rig while it taps: amplitude and lag by the slow flow (scan/flow.c), behind a lock-in
 * amplifier of one time constant. A lever that is not driven and has rung down is the one of probe.c. */
#include <math.h>

#include "core/same_bits.h"
#include "dynamics/dynamics.h"
#include "internal/tapping.h"
#include "nanotouch/material.h"
#include "parts.h"
#include "scan/flow.h"

#define AT_REST 1e-6 /* of the free amplitude */
#define TOLERANCE 1e-9

nt_status nt_sim_tap_init(nt_sim_slave *slave, const nt_sim_lock_in *lock_in)
{
    nt_sim_tap *tap = &slave->tap;
    if (lock_in == NULL)
        return NT_OK;
    if (slave->plan->history != NT_HISTORY_NONE)
        return NT_E_UNSUPPORTED; /* which the slow flow does not know */
    const nt_status status = nt_tapping_init(&tap->lever, &slave->link.rig.probe, &lock_in->drive, TOLERANCE, NULL);
    if (status != NT_OK)
        return status;
    tap->is_there = 1;
    tap->lock_in = *lock_in;
    tap->strength = tap->lever.strength;
    tap->lever.strength = 0.0;
    tap->lag = 0.5 * NT_PI;
    for (int i = 0; i < NT_SIM_SLOTS; i++)
        tap->moments[i][1] = tap->lag;
    return NT_OK;
}

static double swing(const nt_sim_tap *tap)
{
    return hypotenuse(tap->flow.real, tap->flow.imaginary);
}

int nt_sim_tap_swings(const nt_sim_tap *tap)
{
    return tap->lever.strength > 0.0 || swing(tap) > AT_REST * tap->lever.free_amplitude;
}

/* Another frequency is another lever. */
static nt_status tune(nt_sim_slave *slave, double frequency)
{
    nt_sim_tap *tap = &slave->tap;
    if (frequency == tap->lever.ratio * slave->link.rig.probe.resonance)
        return NT_OK;
    nt_drive drive = tap->lock_in.drive;
    drive.frequency = frequency;
    const nt_status status = nt_tapping_init(&tap->lever, &slave->link.rig.probe, &drive, TOLERANCE, NULL);
    tap->strength = tap->lever.strength;
    tap->table = (nt_flow_table){.cell = {{.is_made = 0}}}; /* the contact's damping depends on it */
    return status;
}

nt_status nt_sim_tap_drive(nt_sim_slave *slave, double amplitude, double frequency)
{
    nt_sim_tap *tap = &slave->tap;
    if (!isfinite(amplitude) || !isfinite(frequency))
        return NT_E_NOT_FINITE;
    if (amplitude < 0.0 || amplitude > tap->lock_in.sensor.range)
        return NT_E_RANGE;
    const nt_status status = amplitude > 0.0 ? tune(slave, frequency) : NT_OK;
    if (status == NT_OK)
        tap->lever.strength = tap->strength * amplitude / tap->lever.free_amplitude;
    return status;
}

static nt_flow_value flow_on(nt_sim_slave *slave, const nt_tapping_over *over, double *peak)
{
    nt_sim_tap *tap = &slave->tap;
    const nt_tapping *lever = &tap->lever;
    const double period = slave->link.period;
    const int steps = nt_flow_steps(lever, period);
    nt_flow_value now = {.amplitude = 0.0};
    *peak = -HUGE_VAL;
    for (int i = 0; i < steps; i++) {
        now = nt_flow_step_in(lever, &tap->flow, over, period / steps, &tap->table);
        *peak = fmax(*peak, now.peak_force);
    }
    return now;
}

nt_status nt_sim_tap_step(nt_sim_slave *slave, double base, double surface)
{
    nt_sim_tap *tap = &slave->tap;
    nt_place place = slave->place;
    place.surface.z = 0.0; /* heights count from the surface */
    const nt_tapping_over over = {slave->plan, &place, base};
    double peak;
    const nt_flow_value now = flow_on(slave, &over, &peak);
    if (!isfinite(now.amplitude))
        return NT_E_NOT_FINITE;
    const nt_interaction_state free = {.attached = 0}; /* gap and contact are told of the lowest point */
    const nt_law_value deepest = nt_interaction_eval_gap(slave->plan, &free, &place, now.lowest_gap);
    const double share = tap->lock_in.time > 0.0 ? -expm1(-slave->link.period / tap->lock_in.time) : 1.0;
    tap->amplitude += share * (now.amplitude - tap->amplitude);
    tap->lag += share * (now.phase - tap->lag);
    slave->cantilever.deflection = tap->flow.mean;
    slave->cantilever.tip_height = base + tap->lever.cosine * tap->flow.mean;
    slave->truth = (nt_truth){.gap = now.lowest_gap,
                              .tip_force = {0.0, 0.0, tap->lever.spring_constant * tap->flow.mean},
                              .peak_force = peak,
                              .deepest_gap = now.lowest_gap,
                              .contact_radius = deepest.a,
                              .surface_height = surface,
                              .tip_height = slave->cantilever.tip_height + surface,
                              .friction_heat = slave->slide.friction.dissipated};
    slave->law = (nt_law_value){.F = slave->truth.tip_force[NT_Z]};
    slave->law_gap = NAN; /* of a lever at rest nothing is known now */
    return NT_OK;
}

void nt_sim_tap_read(nt_sim_slave *slave, nt_reading *reading)
{
    nt_sim_tap *tap = &slave->tap;
    double seen[2];
    nt_sim_moment_before(&slave->link, tap->moments, seen);
    const double amplitude =
        nt_sensor_read(&tap->lock_in.sensor, seen[0], nt_sim_noise_now(&slave->link, NT_SIM_NOISE_LOCK_IN));
    reading->amplitude = amplitude;
    reading->lag = seen[1];
}
