/* SPDX-License-Identifier: BSD-3-Clause
 * The rig of the paper (Sec. II, IV and VI): default values, valid ranges, derived ranges of the probe. */
#include "internal/rig.h"
#include "internal/field.h"
#include "nanotouch/rig.h"

#include <math.h>
#include <stddef.h>

#include "core/rig.h"
#include "core/same_bits.h"
#include "nanotouch/material.h"

#define FIELD(path, ...) NT_FIELD(nt_rig, path, __VA_ARGS__)

static const nt_field rig_fields[] = {
    FIELD(probe.spring_constant, "N/m", 1e-4, 1e4, "spring constant k_c of the cantilever"),
    FIELD(probe.tilt, "rad", 0.0, 0.7, "tilt alpha of the cantilever against the sample plane"),
    FIELD(probe.sensitivity, "m/V", 1e-11, 1e-4, "deflection per volt S of the bridge"),
    FIELD(probe.range, "V", 1e-3, 1e3, "the electronics saturate at +- this"),
    FIELD(probe.noise, "V", 0.0, 1e2, "deflection noise, peak to peak (6 sigma)"),
    FIELD(probe.resolution, "V", 0.0, 1e2, "step of the deflection converter, 0 for none"),
    FIELD(probe.resonance, "Hz", 1.0, 1e9, "free resonance f_0 of the cantilever"),
    FIELD(probe.quality, "", 0.05, 1e7, "free quality factor Q of the cantilever"),
    FIELD(probe.temperature, "K", 0.0, 5e3, "temperature of the dynamic cantilever's thermal motion, 0 for none"),
    FIELD(probe.contact_viscosity, "Pa s", 0.0, 1e9, "viscosity eta of the contact: 2 m b_i = 2 eta a"),
    FIELD(probe.spring_constant_sigma, "", 0.0, 0.2, "standard deviation of the calibration of k_c, over k_c"),
    FIELD(probe.sensitivity_sigma, "", 0.0, 0.2, "standard deviation of the calibration of S, over S"),
    FIELD(probe.drift, "m/s", 0.0, 1e-3, "drift of the deflection's zero, at most"),
    FIELD(probe.lateral_stiffness, "N/m", 0.0, 1e6, "lateral stiffness k_l of the lever at the apex; 0: rigid"),
    FIELD(stage.resonance, "Hz", 1.0, 1e6, "resonance f_n of the stage"),
    FIELD(stage.quality, "", 0.05, 1e6, "quality factor Q of the stage"),
    FIELD(stage.stiffness, "N/m", 1.0, 1e12, "stiffness k_stage of the stage against the tip force"),
    FIELD(stage.travel, "m", 1e-8, 1e-1, "range of travel of the stage"),
    FIELD(stage.resolution, "m", 0.0, 1e-5, "step of the stage's read-out, 0 for none"),
    FIELD(stage.command_resolution, "m", 0.0, 1e-5, "step of the stage's command, 0 for none"),
    FIELD(stage.max_speed, "m/s", 1e-10, 1e1, "slew limit of the stage's command"),
    FIELD(stage.noise, "m", 0.0, 1e-5, "standard deviation of the stage's read-out"),
    FIELD(stage.hysteresis, "", 0.0, 0.4, "hysteresis of the stage at full stroke, over the stroke"),
    FIELD(stage.creep, "", 0.0, 0.2, "creep of the stage per decade of time, over the step"),
    FIELD(stage.axes, "", 1.0, 3.0, "axes that it has: 1 is z, x and y stay where a session starts; 3 are all"),
    FIELD(stage.drift, "m/s", 0.0, 1e-3, "drift of the frame, tip against sample, at most"),
    FIELD(stage.slip, "m", 0.0, 1e-3, "largest jump of the surface that is reckoned with"),
    FIELD(stage.travel_sigma, "", 0.0, 0.2, "standard deviation of the calibration of the stage's travel, over it"),
    FIELD(stage.position_sigma, "", 0.0, 0.2, "the same of the stage's read-out"),
    FIELD(master.mass, "kg", 1e-4, 1e2, "moving mass m_m of the master"),
    FIELD(master.damping, "N s/m", 0.0, 1e5, "damping b_m of the master"),
    FIELD(master.friction, "N", 0.0, 1e2, "Coulomb friction of the master"),
    FIELD(master.travel, "m", 1e-5, 1e1, "travel of the master between its end stops"),
    FIELD(master.resolution, "m", 0.0, 1e-2, "step of the master's position sensor, 0 for none"),
    FIELD(master.max_force, "N", 1e-3, 1e3, "motor limit, +- this"),
    FIELD(master.max_speed, "m/s", 1e-4, 1e1, "of the hand that holds it: the shorter a stop's fade of the force"),
    FIELD(master.gauge, "no|yes", 0.0, 1.0, "whether an operator force sensor is fitted"),
    FIELD(master.gauge_range, "N", 1e-3, 1e3, "the strain gauge saturates at +- this"),
    FIELD(master.gauge_noise, "N", 0.0, 1e2, "standard deviation of the strain gauge"),
    FIELD(master.gauge_resolution, "N", 0.0, 1e2, "step of the strain gauge, 0 for none"),
    FIELD(master.motor, "no|yes", 0.0, 1.0,
          "whether it can push back; without a motor it is a position device, as a mouse is"),
    FIELD(master.rate, "Hz", 0.0, 1e6, "rate of its own measurements, 0 for that of the loop"),
    FIELD(master.axes, "", 1.0, 3.0, "axes that it has: 1 presses, 3 move the tip sideways, too"),
    FIELD(hand.mass, "kg", 0.0, 1e2, "mass m_h that moves with the master"),
    FIELD(hand.damping, "N s/m", 0.0, 1e5, "damping b_h of hand or finger pad"),
    FIELD(hand.stiffness, "N/m", 0.0, 1e7, "stiffness k_h of hand or finger pad"),
    FIELD(hand.relaxation, "s", 0.0, 1e3, "time in which the hand's rest position follows, 0 for never"),
    FIELD(hand.random_force, "N", 0.0, 1e3, "adversarial random force, +- this"),
    FIELD(hand.random_rate, "1/s", 0.0, 1e6, "changes of the random force per second"),
    FIELD(converters.adc_bits, "", 0.0, 32.0, "bits of the sensors' converters, 0 for no step of their own"),
    FIELD(converters.adc_rate, "Hz", 0.0, 1e9, "conversions per second, 0 for one in every period"),
    FIELD(converters.adc_latency, "s", 0.0, 1.0, "age of a sample"),
    FIELD(converters.dac_bits, "", 0.0, 32.0, "bits of the actuators' converters, 0 for no step of their own"),
    FIELD(converters.dac_latency, "s", 0.0, 1.0, "time from a command to its effect"),
};

enum { RIG_FIELDS = (int)(sizeof rig_fields / sizeof rig_fields[0]) };

nt_rig nt_rig_defaults(void)
{
    return (nt_rig){
        .probe =
            {
                .spring_constant = 8.0,
                .tilt = 0.0,
                .sensitivity = 0.033e-6,
                .range = 10.0,
                .noise = 50e-3,
                .resolution = 20.0 / 65536.0, /* a 16-bit converter over +-10 V: far below the noise */
                .resonance = 100e3,           /* not in the paper, nor are Q and T: a lever of 8 N/m in air */
                .quality = 100.0,
                .temperature = 295.0,
                /* not in the paper: a thermal calibration, a resistive bridge that has warmed up */
                .spring_constant_sigma = 0.05,
                .sensitivity_sigma = 0.02,
                .drift = 0.1e-9,
            },
        .stage =
            {
                .resonance = 450.0,
                .quality = 20.0,
                .stiffness = 1e6, /* not in the paper; with f_n it stands for a moving mass of 0.125 kg */
                .travel = 100e-6, /* not in the paper; its alpha_p = 4e-3 (Fig. 17) asks for 80 um from a 2 cm master */
                .resolution = 1e-9, /* open loop; the closed loop's 10 nm is what the paper found insufficient */
                .command_resolution =
                    1e-10,           /* a 20-bit converter over the travel: 1 nm steps make the resonance ring */
                .max_speed = 100e-6, /* not in the paper; 10 nm per tick at 10 kHz */
                .axes = 3.0,
                .drift = 1e-9, /* not in the paper: of an instrument at rest in a room */
                .slip = 10e-9, /* not in the paper */
            },
        .master =
            {
                .mass = 0.1,
                .damping = 100.0,
                .travel = 0.02,
                .resolution = 4e-5,
                .max_force = 5.0,
                .max_speed = 0.3, /* not in the paper: of a hand that feels its way */
                .gauge = 1,
                .gauge_range = 5.0,
                .gauge_noise = 0.02 / 6.0, /* the paper's 0.02 N include the noise: peak to peak within one step */
                .gauge_resolution = 0.02,
                .motor = 1,
                .axes = 1.0,
            },
    };
}

nt_status nt_rig_check(const nt_rig *rig, nt_problem *problem)
{
    return nt_field_check(rig_fields, RIG_FIELDS, rig, problem);
}

const nt_field *nt_rig_fields(int *count)
{
    if (count != NULL)
        *count = RIG_FIELDS;
    return rig_fields;
}

/* Bits over +-range. */
static double coarser(double own, double range, double bits)
{
    return bits > 0.0 ? fmax(own, range * power_of_two(1.0 - bits)) : own;
}

nt_rig nt_rig_with_steps(const nt_rig *rig)
{
    const double in = rig->converters.adc_bits, out = rig->converters.dac_bits;
    const double half_stage = 0.5 * rig->stage.travel, half_master = 0.5 * rig->master.travel;
    nt_rig made = *rig;
    made.probe.resolution = coarser(made.probe.resolution, made.probe.range, in);
    made.stage.resolution = coarser(made.stage.resolution, half_stage, in);
    made.stage.command_resolution = coarser(made.stage.command_resolution, half_stage, out);
    made.master.resolution = coarser(made.master.resolution, half_master, in);
    made.master.gauge_resolution = coarser(made.master.gauge_resolution, made.master.gauge_range, in);
    return made;
}

nt_stage nt_stage_open_loop(void)
{
    nt_stage stage = nt_rig_defaults().stage;
    stage.hysteresis = 0.15;
    stage.creep = 0.01;
    return stage;
}

nt_stage nt_stage_closed_loop(void)
{
    nt_stage stage = nt_rig_defaults().stage;
    stage.resolution = stage.command_resolution = 10e-9;
    return stage;
}

double nt_probe_effective_mass(const nt_probe *probe)
{
    const double rate = 2.0 * NT_PI * probe->resonance;
    return probe->spring_constant / (rate * rate);
}

double nt_probe_deflection_range(const nt_probe *probe)
{
    return probe->range * probe->sensitivity;
}

double nt_probe_force_noise(const nt_probe *probe)
{
    return probe->spring_constant * probe->sensitivity * probe->noise / 6.0;
}
