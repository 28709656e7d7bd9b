/* SPDX-License-Identifier: BSD-3-Clause
 * What both halves of the simulated rig have: a clock, converters, a delay. */
#include <math.h>
#include <stddef.h>

#include "internal/random.h"
#include "parts.h"

#define FIRST_CLEAR_DISTANCE 1e-9 /* a rig starts at least this clear of the surface [m] */

nt_status nt_sim_check_setup(const nt_sim_setup *setup)
{
    if (!setup->plan || !setup->rig)
        return NT_E_ARGUMENT;
    if (!isfinite(setup->x) || !isfinite(setup->y) || !isfinite(setup->clearance) ||
        !isfinite(setup->master_position) || !isfinite(setup->period) || !isfinite(setup->delay) ||
        !isfinite(setup->substep))
        return NT_E_NOT_FINITE;
    if (setup->clearance < FIRST_CLEAR_DISTANCE || setup->period <= 0.0 || setup->delay < 0.0 || setup->substep < 0.0)
        return NT_E_RANGE;
    const nt_status status = nt_rig_check(setup->rig, NULL);
    if (status == NT_OK && fabs(setup->master_position) > 0.5 * setup->rig->master.travel)
        return NT_E_RANGE;
    return status;
}

static double slower(double a, double b)
{
    return a > 0.0 && (b == 0.0 || a < b) ? a : b;
}

nt_status nt_sim_link_init(nt_sim_link *link, const nt_sim_setup *setup, double own_rate)
{
    *link = (nt_sim_link){.rig = *setup->rig, .period = setup->period};
    const nt_converters *converters = &link->rig.converters;
    const double total = setup->delay + converters->dac_latency / link->period; /* a command acts after that */
    if (!(total >= 0.0 && total <= NT_SIM_DELAY_MAX) || converters->adc_latency / link->period > NT_SIM_DELAY_MAX)
        return NT_E_RANGE;
    link->delay = (int)total;
    link->fraction = total - link->delay;
    link->per_tick = slower(own_rate, converters->adc_rate) * link->period;
    for (uint32_t i = 0; i < NT_SIM_NOISES; i++)
        link->noise[i] = nt_noise_of(setup->seed, i);
    nt_status status = NT_OK;
    for (int i = 0; setup->faults && i < setup->faults->count && status == NT_OK; i++)
        status = nt_faults_add(&link->faults, &setup->faults->list[i]);
    return status;
}

void nt_sim_moment_between(const nt_sim_link *link, double (*moments)[2], double seen[2])
{
    const double back = link->rig.converters.adc_latency / link->period;
    const uint64_t whole = (uint64_t)back;
    const double share = back - (double)whole;
    const uint64_t at = link->tick + 2u * NT_SIM_SLOTS - whole;
    const double *newer = moments[at % NT_SIM_SLOTS], *older = moments[(at - 1u) % NT_SIM_SLOTS];
    for (int i = 0; i < 2; i++)
        seen[i] = newer[i] + share * (older[i] - newer[i]);
}

static int64_t time_now(const nt_sim_link *link)
{
    return link->host ? link->host->now(link->host) : llround((double)link->tick * link->period * 1e9);
}

/* NaN stays. */
static double within_range(double value, double range)
{
    return value > range ? range : value < -range ? -range : value;
}

void nt_sim_give(nt_sim_link *link, const nt_sim_sensors *sensors, nt_reading *reading)
{
    double age = link->rig.converters.adc_latency + (double)(int64_t)(link->tick - link->converted) * link->period;
    reading->size = sizeof *reading;
    reading->sequence = link->converted + 1u;
    reading->valid = link->valid;
    reading->lateness = link->lateness;
    if (link->faults.count > 0)
        nt_sim_spoil_signals(link, sensors, reading);
    reading->position[NT_Z] = within_range(reading->position[NT_Z], sensors->position->range);
    reading->felt[NT_Z] = within_range(reading->felt[NT_Z], sensors->felt->range);
    const int is_stale = link->faults.count > 0 && nt_sim_spoil(link, sensors, reading, &age);
    reading->time = time_now(link) - (age == 0.0 ? 0 : llround(age * 1e9));
    const nt_sim_memory memory = {reading->position[NT_Z], reading->felt[NT_Z], age, reading->sequence, link->tick};
    link->last = memory;
    if (!is_stale)
        link->fresh = memory;
}
