/* SPDX-License-Identifier: BSD-3-Clause
 * What the simulated halves read and drive, made from the rig that is simulated. */
#include <math.h>
#include <stddef.h>

#include "nanotouch/material.h"
#include "parts.h"

static const char *const position_names[] = {"position x", "position y", "position z"};

static const char *const deflection_names[] = {"deflection x", "deflection y"};

static void add(nt_sim_link *link, const nt_channel_row *row)
{
    link->channels[link->channel_count++] = *row;
}

/* Through a converter, which sees what was a latency ago. */
static void add_sensor(nt_sim_link *link, const char *name, const char *unit, const nt_sensor *sensor)
{
    add(link, &(nt_channel_row){.name = name,
                                .unit = unit,
                                .axis = NT_Z,
                                .minimum = -sensor->range,
                                .maximum = sensor->range,
                                .step = sensor->resolution,
                                .noise = sensor->noise,
                                .latency = link->rig.converters.adc_latency,
                                .safe = NAN});
}

/* Sideways a position is read as it is. */
static void add_sideways(nt_sim_link *link, double range)
{
    for (int i = NT_X; i < NT_Z; i++) {
        add(link,
            &(nt_channel_row){
                .name = position_names[i], .unit = "m", .axis = i, .minimum = -range, .maximum = range, .safe = NAN});
        link->valid |= 1u << (NT_READS_POSITION + i);
    }
}

/* From a write to its effect [s]. */
static double effect_latency(const nt_sim_link *link)
{
    return (link->delay + link->fraction) * link->period;
}

void nt_sim_list_master(nt_sim_master *master)
{
    static const char *const motor_names[] = {"motor force x", "motor force y", "motor force z"};
    nt_sim_link *link = &master->link;
    const nt_master *arm = &link->rig.master;
    const int first = arm->axes > 1.0 ? NT_X : NT_Z;
    link->channel_count = 0;
    link->valid = 1u << (NT_READS_POSITION + NT_Z);
    if (first == NT_X)
        add_sideways(link, 0.5 * arm->travel);
    add_sensor(link, position_names[NT_Z], "m", &master->position_sensor);
    if (arm->gauge) {
        add_sensor(link, "operator force z", "N", &master->gauge);
        link->valid |= 1u << (NT_READS_FELT + NT_Z);
    }
    for (int i = first; i < NT_AXES && arm->motor; i++)
        add(link, &(nt_channel_row){.name = motor_names[i],
                                    .unit = "N",
                                    .driven = 1,
                                    .axis = i,
                                    .minimum = -arm->max_force,
                                    .maximum = arm->max_force,
                                    .step = master->motor_step,
                                    .latency = effect_latency(link),
                                    .safe = 0.0});
}

/* Drive and lock-in amplifier. */
static void add_tapping(nt_sim_slave *slave)
{
    nt_sim_link *link = &slave->link;
    const nt_sensor *sensor = &slave->tap.lock_in.sensor;
    const double latency = link->rig.converters.adc_latency, resonance = link->rig.probe.resonance;
    const nt_channel_row rows[] = {
        {"amplitude", "m", 0, NT_AXES, -sensor->range, sensor->range, sensor->resolution, sensor->noise, latency, NAN},
        {"lag", "rad", 0, NT_AXES, -NT_PI, NT_PI, 0.0, 0.0, latency, NAN},
        {"drive amplitude", "m", 1, NT_AXES, 0.0, sensor->range, 0.0, 0.0, link->period, 0.0},
        {"drive frequency", "Hz", 1, NT_AXES, 0.1 * resonance, 3.0 * resonance, 0.0, 0.0, link->period, NAN}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        add(link, &rows[i]);
    link->valid |= 1u << NT_READS_AMPLITUDE | 1u << NT_READS_LAG;
}

/* Sideways the simulated stage goes as far as any stage does, which is the most that a rig may state of its travel in z
 * [m]. */
#define LATERAL_RANGE 0.1

void nt_sim_list_slave(nt_sim_slave *slave)
{
    static const char *const command_names[] = {"stage x", "stage y", "stage travel"};
    nt_sim_link *link = &slave->link;
    const int first = link->rig.stage.axes > 1.0 ? NT_X : NT_Z;
    link->channel_count = 0;
    link->valid = 1u << (NT_READS_POSITION + NT_Z) | 1u << (NT_READS_FELT + NT_Z);
    if (first == NT_X)
        add_sideways(link, LATERAL_RANGE);
    add_sensor(link, position_names[NT_Z], "m", &slave->stage_sensor);
    for (int i = NT_X; i < NT_Z && link->rig.probe.lateral_stiffness > 0.0; i++) {
        add(link, &(nt_channel_row){.name = deflection_names[i],
                                    .unit = "m",
                                    .axis = i,
                                    .minimum = -HUGE_VAL,
                                    .maximum = HUGE_VAL,
                                    .safe = NAN});
        link->valid |= 1u << (NT_READS_FELT + i);
    }
    add_sensor(link, "deflection", "m", &slave->deflection_sensor);
    for (int i = first; i < NT_AXES; i++) {
        const double range = i == NT_Z ? 0.5 * link->rig.stage.travel : LATERAL_RANGE;
        add(link, &(nt_channel_row){.name = command_names[i],
                                    .unit = "m",
                                    .driven = 1,
                                    .axis = i,
                                    .minimum = -range,
                                    .maximum = range,
                                    .step = i == NT_Z ? slave->command_step : 0.0,
                                    .latency = effect_latency(link),
                                    .safe = i == NT_Z ? -range : (double)NAN}); /* drawn back, where it is */
    }
    if (slave->tap.is_there)
        add_tapping(slave);
}
