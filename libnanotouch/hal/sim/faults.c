/* SPDX-License-Identifier: BSD-3-Clause
 * Faults of the simulated rig: a schedule, and what each kind does to a sample, an actuator or the surface. Numbers of
 * rows are those of the fault table in docs/evidence/safety.md. */
#include "nanotouch/advanced/sim.h"

#include <math.h>
#include <stddef.h>

#include "dynamics/dynamics.h"
#include "hal/reading.h"
#include "parts.h"

enum { SENSORS = NT_CHANNEL_OPERATOR_FORCE + 1 };
#define ON(channel) (1u << (channel))
#define ON_SENSORS (ON(SENSORS) - 1u)
#define ON_POSITIONS (ON(NT_CHANNEL_DEFLECTION) | ON(NT_CHANNEL_STAGE_POSITION) | ON(NT_CHANNEL_MASTER_POSITION))

/* Beyond these numbers nothing is simulated any more; a stage may creep and turn as the rig's own may (rig.c). */
#define ANY -1e6, 1e6
#define NO_VALUE 0.0, ANY

static const nt_fault_description descriptions[] = {
    [NT_FAULT_NAN] = {"nan", "", "the reading is not a number", NO_VALUE, 1, ON_SENSORS},
    [NT_FAULT_INFINITE] = {"infinite", "", "the reading is infinite, with the sign of the value", 1.0, ANY, 1,
                           ON_SENSORS},
    [NT_FAULT_SATURATED] = {"saturated", "", "the reading is at the end of its range, with the sign of the value", 1.0,
                            ANY, 2, ON_SENSORS},
    [NT_FAULT_STUCK] = {"stuck", "", "the reading stays as it was", NO_VALUE, 3, ON_SENSORS},
    [NT_FAULT_STALE] = {"stale", "", "the link repeats its last sample, which ages", NO_VALUE, 4, ON(NT_CHANNEL_RIG)},
    [NT_FAULT_DROPOUT] = {"dropout", "", "frames arrive marked bad, without numbers", NO_VALUE, 4, ON(NT_CHANNEL_RIG)},
    [NT_FAULT_NOISE] = {"noise", "", "more noise: this many times the sensor's noise or step", 100.0, 0.0, 1e6, 5,
                        ON_SENSORS},
    [NT_FAULT_JUMP] = {"jump", "m", "the surface rises by the value at once", 5e-9, -1e-3, 1e-3, 6, ON(NT_CHANNEL_RIG)},
    [NT_FAULT_LATE] = {"late", "periods", "every tick is late by the value", 1.0, 0.0, NT_SIM_LOST_MAX, 11,
                       ON(NT_CHANNEL_RIG)},
    [NT_FAULT_CLOCK] = {"clock", "s", "the clock jumps: the sample is this old", -3600.0, -1e9, 1e9, 12,
                        ON(NT_CHANNEL_RIG)},
    [NT_FAULT_LIMIT] = {"limit", "m", "it goes no farther than the value beyond where it stands", 0.0, 0.0, 1e-3, 13,
                        ON(NT_CHANNEL_STAGE)},
    [NT_FAULT_GAIN] = {"gain", "", "reading, stage travel from here, or motor force times the value", -1.0, ANY, 14,
                       ON_SENSORS | ON(NT_CHANNEL_STAGE) | ON(NT_CHANNEL_MOTOR)},
    [NT_FAULT_DRIFT] = {"drift", "", "drifts by the value per second, the stage unseen by its read-out", 1e-6, ANY, 15,
                        ON_SENSORS | ON(NT_CHANNEL_STAGE)},
    [NT_FAULT_HYSTERESIS] = {"hysteresis", "", "the stage's hysteresis becomes the value", 0.3, 0.0, 0.4, 15,
                             ON(NT_CHANNEL_STAGE)},
    [NT_FAULT_PUSH] = {"push", "N", "the operator pushes with this besides", 5.0, ANY, 16, ON(NT_CHANNEL_RIG)},
    [NT_FAULT_EMERGENCY_STOP] = {"emergency-stop", "", "pressed, or its line is lost", NO_VALUE, 34,
                                 ON(NT_CHANNEL_RIG)},
    [NT_FAULT_LIMIT_SWITCH] = {"limit-switch", "", "the stage stands at its end switch", NO_VALUE, 13,
                               ON(NT_CHANNEL_RIG)},
    [NT_FAULT_DEVICE_LOST] = {"device-lost", "", "a device is gone", NO_VALUE, 9, ON(NT_CHANNEL_RIG)},
    [NT_FAULT_POWER] = {"power", "m", "without power the stage goes to the value, where it rests; the motor lets go",
                        -1e-3, -1e-3, 1e-3, 36, ON(NT_CHANNEL_STAGE) | ON(NT_CHANNEL_MOTOR)},
    [NT_FAULT_CLOCK_DRIFT] = {"clock-drift", "s/s",
                              "the clocks drift apart: samples seem older by the value each second", 1e-3, -1.0, 1.0,
                              37, ON(NT_CHANNEL_RIG)},
    [NT_FAULT_SLIP] = {"slip", "m", "the reading slips by the value at once", 1e-6, -1e-2, 1e-2, 40, ON_POSITIONS},
};
enum { KINDS = (int)(sizeof descriptions / sizeof *descriptions) };

const nt_fault_description *nt_fault_descriptions(int *count)
{
    if (count != NULL)
        *count = KINDS;
    return descriptions;
}

const char *nt_channel_name(nt_channel channel)
{
    static const char *const names[] = {
        "deflection", "stage_position", "master_position", "operator_force", "stage", "motor", "rig"};
    return (unsigned)channel < sizeof names / sizeof names[0] ? names[channel] : "";
}

nt_status nt_faults_add(nt_faults *faults, const nt_fault *fault)
{
    const int kind = (int)fault->kind, channel = (int)fault->channel;
    if (kind < 0 || kind >= KINDS || channel < 0 || channel > NT_CHANNEL_RIG)
        return NT_E_ARGUMENT;
    if (!(descriptions[kind].channels & ON(channel)))
        return NT_E_ARGUMENT;
    if (!isfinite(fault->start) || !isfinite(fault->value) || isnan(fault->duration))
        return NT_E_NOT_FINITE;
    const nt_fault_description *known = &descriptions[kind];
    if (fault->start < 0.0 || fault->duration <= 0.0 || fault->value < known->minimum || fault->value > known->maximum)
        return NT_E_RANGE;
    if (faults->count >= NT_FAULTS_MAX)
        return NT_E_CAPACITY;
    faults->list[faults->count++] = *fault;
    return NT_OK;
}

/* Half a period of slack: a start that is a multiple of T begins in that tick, however it was rounded. */
static double elapsed(const nt_sim_link *link, const nt_fault *fault)
{
    return (double)link->tick * link->period - fault->start + 0.5 * link->period;
}

/* One that is no longer than a period acts in one tick, the nearest to its start, and not between two. */
static int is_active(const nt_sim_link *link, const nt_fault *fault)
{
    if (fault->duration <= link->period * (1.0 + 1e-9))
        return (double)link->tick == floor(fault->start / link->period + 0.5);
    const double since = elapsed(link, fault);
    return since >= 0.0 && since < fault->duration;
}

/* The next fault of this kind that acts now; from: where to go on. NULL: no more. */
static const nt_fault *next_active(const nt_sim_link *link, nt_fault_kind kind, int *from)
{
    while (*from < link->faults.count) {
        const nt_fault *fault = &link->faults.list[(*from)++];
        if (fault->kind == kind && is_active(link, fault))
            return fault;
    }
    return NULL;
}

double nt_sim_sum_of_faults(const nt_sim_link *link, nt_fault_kind kind)
{
    double sum = 0.0;
    const nt_fault *fault;
    for (int i = 0; (fault = next_active(link, kind, &i)) != NULL;)
        sum += fault->value;
    return sum;
}

static nt_half half_of(nt_channel channel)
{
    return channel >= NT_CHANNEL_MASTER_POSITION ? NT_HALF_MASTER : NT_HALF_SLAVE;
}

static int is_position(nt_channel channel)
{
    return channel == NT_CHANNEL_STAGE_POSITION || channel == NT_CHANNEL_MASTER_POSITION;
}

static double noise_of(nt_sim_link *link, const nt_fault *fault, const nt_sensor *sensor, double value)
{
    const nt_sensor loud = {fault->value * fmax(sensor->noise, sensor->resolution), sensor->resolution, HUGE_VAL};
    return nt_sensor_read(&loud, value, nt_sim_noise_now(link, NT_SIM_NOISE_FAULT + (int)fault->channel));
}

/* Of what the converter is given; else of what it gives. */
static int is_analogue(nt_fault_kind kind)
{
    return kind == NT_FAULT_NOISE || kind == NT_FAULT_GAIN || kind == NT_FAULT_DRIFT || kind == NT_FAULT_SLIP;
}

/* One reading of one sensor. */
static void spoil_channel(nt_sim_link *link, const nt_sim_sensors *sensors, const nt_fault *fault, nt_reading *reading)
{
    const int of_position = is_position(fault->channel);
    double *value = of_position ? &reading->position[NT_Z] : &reading->felt[NT_Z];
    const nt_sensor *sensor = of_position ? sensors->position : sensors->felt;
    const double sign = fault->value < 0.0 ? -1.0 : 1.0;
    switch (fault->kind) {
    case NT_FAULT_NAN:
        *value = NAN;
        break;
    case NT_FAULT_INFINITE:
        *value = sign * HUGE_VAL;
        break;
    case NT_FAULT_SATURATED:
        *value = sign * sensor->range;
        break;
    case NT_FAULT_STUCK:
        *value = of_position ? link->last.position : link->last.felt;
        break;
    case NT_FAULT_NOISE:
        *value = noise_of(link, fault, sensor, *value);
        break;
    case NT_FAULT_GAIN:
        *value *= fault->value;
        break;
    case NT_FAULT_DRIFT:
        *value += fault->value * elapsed(link, fault);
        break;
    case NT_FAULT_SLIP:
        *value += fault->value;
        break;
    default:
        break;
    }
}

static void spoil_frame(const nt_sim_link *link, const nt_fault *fault, nt_reading *reading, double *age)
{
    switch (fault->kind) {
    case NT_FAULT_STALE:
        *age = link->fresh.age + (double)(link->tick - link->fresh.tick) * link->period;
        reading->position[NT_Z] = link->fresh.position;
        reading->felt[NT_Z] = link->fresh.felt;
        reading->sequence = link->fresh.sequence;
        break;
    case NT_FAULT_DROPOUT:
        reading->position[NT_Z] = reading->felt[NT_Z] = NAN;
        reading->flags |= NT_SAMPLE_INVALID;
        break;
    case NT_FAULT_CLOCK:
        *age = fault->value;
        break;
    case NT_FAULT_CLOCK_DRIFT:
        *age += fault->value * elapsed(link, fault);
        break;
    case NT_FAULT_EMERGENCY_STOP:
        reading->flags |= NT_SAMPLE_EMERGENCY_STOP;
        break;
    case NT_FAULT_LIMIT_SWITCH:
        reading->flags |= NT_SAMPLE_LIMIT_SWITCH;
        break;
    case NT_FAULT_DEVICE_LOST:
        reading->flags |= NT_SAMPLE_DEVICE_LOST;
        reading->valid = 0;
        break;
    default:
        break;
    }
}

/* Of what is valid: what a fault has made no number is not; what is not is no number. */
static void mark(nt_reading *reading)
{
    for (int i = 0; i < NT_READS; i++) {
        double *value = nt_reading_channel(reading, i);
        if (isnan(*value))
            reading->valid &= ~(1u << i);
        else if (!(reading->valid >> i & 1u))
            *value = NAN;
    }
}

static void spoil_sensors(nt_sim_link *link, const nt_sim_sensors *sensors, int analogue, nt_reading *reading)
{
    for (int i = 0; i < link->faults.count; i++) {
        const nt_fault *fault = &link->faults.list[i];
        if ((int)fault->channel < SENSORS && half_of(fault->channel) == sensors->half &&
            is_analogue(fault->kind) == analogue && is_active(link, fault))
            spoil_channel(link, sensors, fault, reading);
    }
}

void nt_sim_spoil_signals(nt_sim_link *link, const nt_sim_sensors *sensors, nt_reading *reading)
{
    spoil_sensors(link, sensors, 1, reading);
}

/* Sensors first, then the link that carries them. */
int nt_sim_spoil(nt_sim_link *link, const nt_sim_sensors *sensors, nt_reading *reading, double *age)
{
    int stale = 0;
    spoil_sensors(link, sensors, 0, reading);
    for (int i = 0; i < link->faults.count; i++) {
        const nt_fault *fault = &link->faults.list[i];
        if (fault->channel == NT_CHANNEL_RIG && is_active(link, fault)) {
            spoil_frame(link, fault, reading, age);
            stale |= fault->kind == NT_FAULT_STALE;
        }
    }
    mark(reading);
    return stale;
}

/* Whatever its gain, a driver keeps to the stage's travel and speed. */
static double driven_by(const nt_sim_slave *slave, double drive, double time)
{
    const nt_stage *stage = &slave->link.rig.stage;
    const double way = stage->max_speed * time, half = 0.5 * stage->travel;
    return fmax(-half, fmin(half, fmax(slave->driven - way, fmin(slave->driven + way, drive))));
}

/* Without power the stage goes where it rests; when that is back, to where it is told: never faster than it can. */
static double powered(nt_sim_slave *slave, double driven, double time)
{
    int from = 0;
    const nt_fault *fault;
    while ((fault = next_active(&slave->link, NT_FAULT_POWER, &from)) != NULL)
        if (fault->channel == NT_CHANNEL_STAGE) {
            slave->was_off = 1;
            return driven_by(slave, fault->value, time);
        }
    if (!slave->was_off)
        return driven;
    const double reached = driven_by(slave, driven, time);
    slave->was_off = reached != driven;
    return reached;
}

double nt_sim_stage_by_faults(nt_sim_slave *slave, double drive, double time)
{
    const nt_sim_link *link = &slave->link;
    double driven = drive;
    int spoilt = 0;
    for (int i = 0; i < link->faults.count; i++) {
        const nt_fault *fault = &link->faults.list[i];
        if (fault->channel != NT_CHANNEL_STAGE || !is_active(link, fault))
            continue;
        spoilt |= fault->kind == NT_FAULT_GAIN || fault->kind == NT_FAULT_LIMIT;
        const double stood = slave->stood;
        if (fault->kind == NT_FAULT_GAIN)
            driven = driven_by(slave, stood + fault->value * (driven - stood), time);
        if (fault->kind == NT_FAULT_LIMIT)
            driven = fmin(driven, stood + fault->value);
    }
    if (!spoilt)
        slave->stood = drive;
    slave->driven = powered(slave, driven, time);
    return slave->driven;
}

double nt_sim_hysteresis_by_faults(const nt_sim_link *link)
{
    int from = 0;
    const nt_fault *fault = next_active(link, NT_FAULT_HYSTERESIS, &from);
    return fault != NULL ? fault->value : link->rig.stage.hysteresis;
}

double nt_sim_motor_by_faults(const nt_sim_link *link, double force)
{
    double pushed = force;
    for (int i = 0; i < link->faults.count; i++) {
        const nt_fault *fault = &link->faults.list[i];
        if (fault->channel == NT_CHANNEL_MOTOR && is_active(link, fault))
            pushed *= fault->kind == NT_FAULT_POWER ? 0.0 : fault->value;
    }
    return pushed;
}

double nt_sim_drift_of_faults(const nt_sim_link *link)
{
    double sum = 0.0;
    const nt_fault *fault;
    for (int i = 0; (fault = next_active(link, NT_FAULT_DRIFT, &i)) != NULL;)
        sum += fault->channel == NT_CHANNEL_STAGE ? fault->value * elapsed(link, fault) : 0.0;
    return sum;
}
