/* SPDX-License-Identifier: BSD-3-Clause
 * The parts of the simulated rig. Private. */
#ifndef NANOTOUCH_HAL_SIM_PARTS_H
#define NANOTOUCH_HAL_SIM_PARTS_H

#include <math.h>

#include "core/noise.h"
#include "dynamics/sensor.h"
#include "nanotouch/advanced/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- link.c: what both halves have --- */

nt_status nt_sim_check_setup(const nt_sim_setup *setup);
/* own_rate: of this half's measurements beside the converters', 0: none [Hz]. */
nt_status nt_sim_link_init(nt_sim_link *link, const nt_sim_setup *setup, double own_rate);
/* Does a conversion end in this tick? */
static inline int nt_sim_is_converted(const nt_sim_link *link)
{
    const double per_tick = link->per_tick;
    if (per_tick == 0.0 || per_tick >= 1.0 || link->tick == 0)
        return 1;
    return floor((double)link->tick * per_tick) > floor((double)(link->tick - 1u) * per_tick);
}
/* The stream of a channel at the beginning of this tick. */
static inline nt_noise *nt_sim_noise_now(nt_sim_link *link, int stream)
{
    noise_seek(&link->noise[stream], link->tick);
    return &link->noise[stream];
}
/* The two sensors of a half: of its position, and of what it feels. */
typedef struct nt_sim_sensors {
    nt_half half;
    const nt_sensor *position, *felt;
} nt_sim_sensors;
/* What a sensor gives its converter, in steps. The converter's range ends it where faults have had their say
 * (nt_sim_give): a zero that drifts, drifts before that. */
static inline double nt_sim_sense(nt_sim_link *link, const nt_sensor *sensor, nt_channel channel, double value)
{
    return nt_sensor_sense(sensor, value, nt_sim_noise_now(link, (int)channel));
}
/* What was sensed goes on its way: spoilt by faults, at its range, numbered, stamped, kept for a fault that lasts. */
void nt_sim_give(nt_sim_link *link, const nt_sim_sensors *sensors, nt_reading *reading);
/* A pair of values as it was a latency ago: that of this tick, or between two ticks on a straight line. */
void nt_sim_moment_between(const nt_sim_link *link, double (*moments)[2], double seen[2]);
static inline void nt_sim_moment_before(const nt_sim_link *link, double (*moments)[2], double seen[2])
{
    if (link->rig.converters.adc_latency != 0.0) {
        nt_sim_moment_between(link, moments, seen);
        return;
    }
    for (int i = 0; i < 2; i++)
        seen[i] = moments[link->tick % NT_SIM_SLOTS][i];
}
/* The command that acts in the first (0) or second (1) part of this period. */
static inline const double *nt_sim_acting(const nt_sim_link *link, double (*pending)[NT_AXES], int part)
{
    const uint64_t newest = link->tick + NT_SIM_SLOTS - (uint64_t)link->delay;
    return pending[(part == 0 ? newest - 1u : newest) % NT_SIM_SLOTS];
}
static inline double nt_sim_in_steps(double value, double step)
{
    return step > 0.0 ? step * round(value / step) : value;
}
static inline int nt_sim_is_finite(const nt_action *action)
{
    return isfinite(action->target[NT_X]) && isfinite(action->target[NT_Y]) && isfinite(action->target[NT_Z]);
}

/* --- channels.c: what a half reads and drives; its sensors and delay are known --- */

void nt_sim_list_master(nt_sim_master *master);
void nt_sim_list_slave(nt_sim_slave *slave);

/* --- probe.c: one period of the cantilever, base and surface where they are now --- */

double nt_sim_surface_height(const nt_sim_slave *slave);
nt_status nt_sim_move_probe(nt_sim_slave *slave);

/* --- tap.c: the same of a lever that taps --- */

nt_status nt_sim_tap_init(nt_sim_slave *slave, const nt_sim_lock_in *lock_in);
/* Asks a lever that is driven for another drive. NT_E_NOT_FINITE, NT_E_RANGE. */
nt_status nt_sim_tap_drive(nt_sim_slave *slave, double amplitude, double frequency);
/* Does the lever swing, or shall it? */
int nt_sim_tap_swings(const nt_sim_tap *tap);
static inline int nt_sim_taps(const nt_sim_slave *slave)
{
    return slave->tap.is_there && nt_sim_tap_swings(&slave->tap);
}
/* Over a place whose height is that of the surface now; base: z_b above that [m]. */
nt_status nt_sim_tap_step(nt_sim_slave *slave, double base, double surface);
/* What a lock-in amplifier that is there shows in this tick. */
void nt_sim_tap_read(nt_sim_slave *slave, nt_reading *reading);

/* --- pushed.c: what lies on the surface --- */

nt_status nt_sim_begin_pushed(nt_sim_slave *slave, const nt_sim_setup *setup);
/* The state as if the tip stood at a height over the flat [m]: in *to. */
nt_status nt_sim_lead_pushed(const nt_sim_slave *slave, double height, nt_pushed_state *to);
/* The tip has come there: the state holds from now on. */
void nt_sim_keep_pushed(nt_sim_slave *slave, const nt_pushed_state *state);

/* --- faults.c: what each fault does, where it acts; most rigs have none --- */

/* The values of all faults of a kind that act now. */
double nt_sim_sum_of_faults(const nt_sim_link *link, nt_fault_kind kind);
static inline double nt_sim_sum_of(const nt_sim_link *link, nt_fault_kind kind)
{
    return link->faults.count > 0 ? nt_sim_sum_of_faults(link, kind) : 0.0;
}

/* What becomes of what a sensor gives its converter. */
void nt_sim_spoil_signals(nt_sim_link *link, const nt_sim_sensors *sensors, nt_reading *reading);
/* What becomes of a reading on its way; age: of what was measured [s]. 1: the link has brought old news. */
int nt_sim_spoil(nt_sim_link *link, const nt_sim_sensors *sensors, nt_reading *reading, double *age);
/* Periods that are lost before this command arrives, of several faults. */
static inline int nt_sim_lost_periods(const nt_sim_link *link)
{
    return link->faults.count > 0 ? (int)fmin(nt_sim_sum_of(link, NT_FAULT_LATE), NT_SIM_LOST_MAX) : 0;
}
/* What stage, in this time [s], and motor make of what they are told [m], [N]. */
double nt_sim_stage_by_faults(nt_sim_slave *slave, double drive, double time);
static inline double nt_sim_spoil_stage(nt_sim_slave *slave, double drive, double time)
{
    if (slave->link.faults.count > 0)
        return nt_sim_stage_by_faults(slave, drive, time);
    slave->stood = slave->driven = drive;
    return drive;
}
double nt_sim_motor_by_faults(const nt_sim_link *link, double force);
static inline double nt_sim_spoil_motor(const nt_sim_link *link, double force)
{
    return link->faults.count > 0 ? nt_sim_motor_by_faults(link, force) : force;
}
double nt_sim_hysteresis_by_faults(const nt_sim_link *link);
static inline double nt_sim_stage_hysteresis(const nt_sim_link *link)
{
    return link->faults.count > 0 ? nt_sim_hysteresis_by_faults(link) : link->rig.stage.hysteresis;
}
/* Of the whole frame, unseen by the read-out [m]. */
double nt_sim_drift_of_faults(const nt_sim_link *link);
static inline double nt_sim_stage_drift(const nt_sim_link *link)
{
    return link->faults.count > 0 ? nt_sim_drift_of_faults(link) : 0.0;
}
/* By how much the surface has risen [m]. */
static inline double nt_sim_surface_jump(const nt_sim_link *link)
{
    return nt_sim_sum_of(link, NT_FAULT_JUMP);
}
/* The operator's own [N]. */
static inline double nt_sim_push(const nt_sim_link *link)
{
    return nt_sim_sum_of(link, NT_FAULT_PUSH);
}

#ifdef __cplusplus
}
#endif
#endif
