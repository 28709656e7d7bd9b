/* SPDX-License-Identifier: BSD-3-Clause
 * Made by tools/single.py from nanotouch 0.1.0: do not edit. Constants in single precision, as C. */


#ifndef NANOTOUCH_SINGLE_TEXT_HPP
#define NANOTOUCH_SINGLE_TEXT_HPP

#include <cmath>
#include <cstdio>
#include <string>

#include "nanotouch/touch.h"

/* So many digits that reading them gives the same number. */
static inline std::string nt_digits_text(double value, int digits, const char *suffix)
{
    if (!std::isfinite(value))
        return std::isnan(value) ? "NAN" : value > 0.0 ? "INFINITY" : "-INFINITY";
    char text[40];
    (void)std::snprintf(text, sizeof text, "%.*e%s", digits - 1, value, suffix);
    return text;
}
static inline std::string nt_number_text(float value)
{
    return nt_digits_text((double)value, 9, "f");
}
static inline std::string nt_number_text(double value)
{
    return nt_digits_text(value, 17, "");
}
template <typename kept> static inline std::string nt_row_text(const double *values, int count)
{
    std::string text = "{";
    for (int i = 0; i < count; ++i)
        text += (i ? ", " : "") + nt_number_text((kept)values[i]);
    return text + "}";
}
static inline std::string nt_rows_text(const double (*values)[2], int rows, int columns)
{
    std::string text = "{";
    for (int i = 0; i < rows; ++i)
        text += (i ? ", " : "") + nt_row_text<float>(values[i], columns);
    return text + "}";
}
static inline std::string nt_law_text(nt_control_choice choice)
{
    return choice == NT_CONTROL_PAPER       ? "ntf_servo_paper"
           : choice == NT_CONTROL_IMPEDANCE ? "ntf_servo_impedance"
                                            : "ntf_servo_default";
}

static inline std::string nt_text_of(const nt_probe &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.spring_constant) + ", /* spring_constant */\n";
    text += in + nt_number_text((float)from.tilt) + ", /* tilt */\n";
    text += in + nt_number_text((float)from.sensitivity) + ", /* sensitivity */\n";
    text += in + nt_number_text((float)from.range) + ", /* range */\n";
    text += in + nt_number_text((float)from.noise) + ", /* noise */\n";
    text += in + nt_number_text((float)from.resolution) + ", /* resolution */\n";
    text += in + nt_number_text((float)from.resonance) + ", /* resonance */\n";
    text += in + nt_number_text((float)from.quality) + ", /* quality */\n";
    text += in + nt_number_text((float)from.temperature) + ", /* temperature */\n";
    text += in + nt_number_text((float)from.contact_viscosity) + ", /* contact_viscosity */\n";
    text += in + nt_number_text((float)from.spring_constant_sigma) + ", /* spring_constant_sigma */\n";
    text += in + nt_number_text((float)from.sensitivity_sigma) + ", /* sensitivity_sigma */\n";
    text += in + nt_number_text((float)from.drift) + ", /* drift */\n";
    text += in + nt_number_text((float)from.lateral_stiffness) + ", /* lateral_stiffness */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_stage &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.resonance) + ", /* resonance */\n";
    text += in + nt_number_text((float)from.quality) + ", /* quality */\n";
    text += in + nt_number_text((float)from.stiffness) + ", /* stiffness */\n";
    text += in + nt_number_text((float)from.travel) + ", /* travel */\n";
    text += in + nt_number_text((float)from.resolution) + ", /* resolution */\n";
    text += in + nt_number_text((float)from.command_resolution) + ", /* command_resolution */\n";
    text += in + nt_number_text((float)from.max_speed) + ", /* max_speed */\n";
    text += in + nt_number_text((float)from.noise) + ", /* noise */\n";
    text += in + nt_number_text((float)from.hysteresis) + ", /* hysteresis */\n";
    text += in + nt_number_text((float)from.creep) + ", /* creep */\n";
    text += in + nt_number_text((float)from.axes) + ", /* axes */\n";
    text += in + nt_number_text((float)from.drift) + ", /* drift */\n";
    text += in + nt_number_text((float)from.slip) + ", /* slip */\n";
    text += in + nt_number_text((float)from.travel_sigma) + ", /* travel_sigma */\n";
    text += in + nt_number_text((float)from.position_sigma) + ", /* position_sigma */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_master &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.mass) + ", /* mass */\n";
    text += in + nt_number_text((float)from.damping) + ", /* damping */\n";
    text += in + nt_number_text((float)from.friction) + ", /* friction */\n";
    text += in + nt_number_text((float)from.travel) + ", /* travel */\n";
    text += in + nt_number_text((float)from.resolution) + ", /* resolution */\n";
    text += in + nt_number_text((float)from.max_force) + ", /* max_force */\n";
    text += in + std::to_string(from.gauge) + ", /* gauge */\n";
    text += in + nt_number_text((float)from.gauge_range) + ", /* gauge_range */\n";
    text += in + nt_number_text((float)from.gauge_noise) + ", /* gauge_noise */\n";
    text += in + nt_number_text((float)from.gauge_resolution) + ", /* gauge_resolution */\n";
    text += in + std::to_string(from.motor) + ", /* motor */\n";
    text += in + nt_number_text((float)from.rate) + ", /* rate */\n";
    text += in + nt_number_text((float)from.axes) + ", /* axes */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_hand &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.mass) + ", /* mass */\n";
    text += in + nt_number_text((float)from.damping) + ", /* damping */\n";
    text += in + nt_number_text((float)from.stiffness) + ", /* stiffness */\n";
    text += in + nt_number_text((float)from.relaxation) + ", /* relaxation */\n";
    text += in + nt_number_text((float)from.random_force) + ", /* random_force */\n";
    text += in + nt_number_text((float)from.random_rate) + ", /* random_rate */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_converters &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.adc_bits) + ", /* adc_bits */\n";
    text += in + nt_number_text((float)from.adc_rate) + ", /* adc_rate */\n";
    text += in + nt_number_text((float)from.adc_latency) + ", /* adc_latency */\n";
    text += in + nt_number_text((float)from.dac_bits) + ", /* dac_bits */\n";
    text += in + nt_number_text((float)from.dac_latency) + ", /* dac_latency */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_rig &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_text_of(from.probe, in) + ", /* probe */\n";
    text += in + nt_text_of(from.stage, in) + ", /* stage */\n";
    text += in + nt_text_of(from.master, in) + ", /* master */\n";
    text += in + nt_text_of(from.hand, in) + ", /* hand */\n";
    text += in + nt_text_of(from.converters, in) + ", /* converters */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_control &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + "(ntf_control_choice)" + std::to_string((int)from.choice) + ", /* choice */\n";
    text += in + "0, /* none */\n";
    text += in + "0, /* none */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_gains &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.rate) + ", /* rate */\n";
    text += in + nt_number_text((float)from.alpha_p) + ", /* alpha_p */\n";
    text += in + nt_number_text((float)from.alpha_f) + ", /* alpha_f */\n";
    text += in + nt_number_text((float)from.alpha_f_approach) + ", /* alpha_f_approach */\n";
    text += in + nt_number_text((float)from.alpha_f_retract) + ", /* alpha_f_retract */\n";
    text += in + nt_number_text((float)from.force_gain) + ", /* force_gain */\n";
    text += in + nt_number_text((float)from.force_filter) + ", /* force_filter */\n";
    text += in + nt_number_text((float)from.velocity_feedforward) + ", /* velocity_feedforward */\n";
    text += in + nt_number_text((float)from.stage_damping) + ", /* stage_damping */\n";
    text += in + nt_number_text((float)from.stage_integral) + ", /* stage_integral */\n";
    text += in + nt_number_text((float)from.stage_proportional) + ", /* stage_proportional */\n";
    text += in + nt_number_text((float)from.stage_derivative) + ", /* stage_derivative */\n";
    text += in + nt_number_text((float)from.coupling_stiffness) + ", /* coupling_stiffness */\n";
    text += in + nt_number_text((float)from.coupling_damping) + ", /* coupling_damping */\n";
    text += in + nt_number_text((float)from.projection_x) + ", /* projection_x */\n";
    text += in + nt_number_text((float)from.projection_y) + ", /* projection_y */\n";
    text += in + nt_number_text((float)from.ramp_time) + ", /* ramp_time */\n";
    text += in + nt_number_text((float)from.set_point) + ", /* set_point */\n";
    text += in + nt_number_text((float)from.height_gain) + ", /* height_gain */\n";
    text += in + nt_number_text((float)from.height_stiffness) + ", /* height_stiffness */\n";
    text += in + nt_number_text((float)from.approach_speed) + ", /* approach_speed */\n";
    text += in + nt_number_text((float)from.curve_length) + ", /* curve_length */\n";
    text += in + nt_number_text((float)from.delay) + ", /* delay */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_limits &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.force) + ", /* force */\n";
    text += in + nt_number_text((float)from.lateral_force) + ", /* lateral_force */\n";
    text += in + nt_number_text((float)from.indentation) + ", /* indentation */\n";
    text += in + nt_number_text((float)from.stage_speed) + ", /* stage_speed */\n";
    text += in + nt_number_text((float)from.lateral_speed) + ", /* lateral_speed */\n";
    text += in + nt_number_text((float)from.motor_force) + ", /* motor_force */\n";
    text += in + nt_number_text((float)from.motor_rate) + ", /* motor_rate */\n";
    text += in + nt_number_text((float)from.motor_power) + ", /* motor_power */\n";
    text += in + nt_number_text((float)from.retract_distance) + ", /* retract_distance */\n";
    text += in + nt_number_text((float)from.retract_speed) + ", /* retract_speed */\n";
    text += in + nt_number_text((float)from.follow_error) + ", /* follow_error */\n";
    text += in + nt_number_text((float)from.follow_time) + ", /* follow_time */\n";
    text += in + nt_number_text((float)from.deflection_bias) + ", /* deflection_bias */\n";
    text += in + nt_number_text((float)from.deflection_drift) + ", /* deflection_drift */\n";
    text += in + nt_number_text((float)from.gauge_bias) + ", /* gauge_bias */\n";
    text += in + nt_number_text((float)from.gauge_drift) + ", /* gauge_drift */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_settings &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_text_of(from.gains, in) + ", /* gains */\n";
    text += in + nt_text_of(from.limits, in) + ", /* limits */\n";
    text += in + nt_text_of(from.control, in) + ", /* control */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_rescale &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.share) + ", /* share */\n";
    text += in + nt_number_text((float)from.threshold) + ", /* threshold */\n";
    text += in + nt_number_text((float)from.spring_constant) + ", /* spring_constant */\n";
    text += in + nt_number_text((float)from.income) + ", /* income */\n";
    text += in + nt_number_text((float)from.capacity) + ", /* capacity */\n";
    text += in + nt_row_text<float>(from.factors, 3) + ", /* factors */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_passivity &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.dead_zone) + ", /* dead_zone */\n";
    text += in + nt_number_text((float)from.due) + ", /* due */\n";
    text += in + nt_number_text((float)from.force_gain) + ", /* force_gain */\n";
    text += in + nt_number_text((float)from.damping) + ", /* damping */\n";
    text += in + nt_number_text((float)from.credit) + ", /* credit */\n";
    text += in + nt_number_text((float)from.speed_filter) + ", /* speed_filter */\n";
    text += in + nt_number_text((float)from.speed_floor) + ", /* speed_floor */\n";
    text += in + nt_number_text((float)from.speed_limit) + ", /* speed_limit */\n";
    text += in + nt_number_text((float)from.period) + ", /* period */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_stage_loop &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_row_text<double>(from.b, 3) + ", /* b */\n";
    text += in + nt_row_text<double>(from.a, 3) + ", /* a */\n";
    text += in + nt_number_text(from.integral) + ", /* integral */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_supervisor &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_number_text((float)from.master_period) + ", /* master_period */\n";
    text += in + nt_number_text((float)from.period) + ", /* period */\n";
    text += in + nt_number_text((float)from.spring_constant) + ", /* spring_constant */\n";
    text += in + nt_number_text((float)from.lateral_stiffness) + ", /* lateral_stiffness */\n";
    text += in + nt_number_text((float)from.deflection_range) + ", /* deflection_range */\n";
    text += in + nt_number_text((float)from.free_force) + ", /* free_force */\n";
    text += in + nt_number_text((float)from.master_range) + ", /* master_range */\n";
    text += in + std::to_string(from.leads_sideways) + ", /* leads_sideways */\n";
    text += in + nt_number_text((float)from.gauge_range) + ", /* gauge_range */\n";
    text += in + nt_number_text((float)from.stage_range) + ", /* stage_range */\n";
    text += in + nt_number_text((float)from.stuck_distance) + ", /* stuck_distance */\n";
    text += in + nt_number_text((float)from.noise) + ", /* noise */\n";
    text += in + nt_number_text((float)from.stage_share) + ", /* stage_share */\n";
    text += in + nt_number_text((float)from.stage_slack) + ", /* stage_slack */\n";
    text += in + nt_number_text((float)from.stage_most) + ", /* stage_most */\n";
    text += in + nt_number_text((float)from.correction_most) + ", /* correction_most */\n";
    text += in + nt_number_text((float)from.turn_slack) + ", /* turn_slack */\n";
    text += in + nt_number_text((float)from.lift_share) + ", /* lift_share */\n";
    text += in + nt_number_text((float)from.path_kept) + ", /* path_kept */\n";
    text += in + nt_text_of(from.limits, in) + ", /* limits */\n";
    return text + outside + "}";
}

static inline std::string nt_text_of(const nt_touch &from, const std::string &outside)
{
    const std::string in = outside + "    ";
    std::string text = "{\n";
    text += in + nt_text_of(from.rig, in) + ", /* rig */\n";
    text += in + nt_text_of(from.settings, in) + ", /* settings */\n";
    text += in + "(ntf_mode)" + std::to_string((int)from.mode) + ", /* mode */\n";
    text += in + nt_number_text((float)from.period) + ", /* period */\n";
    text += in + nt_law_text(from.settings.control.choice) + ", /* law */\n";
    text += in + nt_text_of(from.stage_loop, in) + ", /* stage_loop */\n";
    text += in + std::to_string(from.leads_sideways) + ", /* leads_sideways */\n";
    text += in + std::to_string(from.feels_sideways) + ", /* feels_sideways */\n";
    text += in + nt_rows_text(from.borders, 2, 2) + ", /* borders */\n";
    text += in + nt_number_text((float)from.force_filter) + ", /* force_filter */\n";
    text += in + std::to_string(from.delay) + "u" + ", /* delay */\n";
    text += in + nt_number_text((float)from.speed_filter) + ", /* speed_filter */\n";
    text += in + nt_number_text((float)from.stage_step) + ", /* stage_step */\n";
    text += in + nt_number_text((float)from.stage_end) + ", /* stage_end */\n";
    text += in + nt_number_text((float)from.motor_step) + ", /* motor_step */\n";
    text += in + nt_number_text((float)from.spike) + ", /* spike */\n";
    text += in + nt_text_of(from.passivity, in) + ", /* passivity */\n";
    text += in + nt_text_of(from.passivity_sideways, in) + ", /* passivity_sideways */\n";
    text += in + nt_text_of(from.rescale, in) + ", /* rescale */\n";
    text += in + nt_text_of(from.supervisor, in) + ", /* supervisor */\n";
    return text + outside + "}";
}

#endif
