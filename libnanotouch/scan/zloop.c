/* SPDX-License-Identifier: BSD-3-Clause
 * The description of a scan, and the stability of its z loop: integral x stage x answer of the tap
 * x lock-in amplifier, tick after tick (loop.h). */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "internal/field.h"
#include "internal/scan.h"
#include "loop.h"
#include "nanotouch/advanced/scan.h"
#include "nanotouch/material.h"

#define FIELD(path, ...) NT_FIELD(nt_scan, path, __VA_ARGS__)
#define GAIN_MARGIN 2.0
#define PHASE_MARGIN (0.25 * NT_PI)
#define BELOW 1e-3 /* all corners */
enum { FREQUENCIES = 2000 };

static const nt_field scan_fields[] = {
    FIELD(zloop.mode, "contact|tapping|phase", 0.0, 2.0,
          "what the loop keeps: the deflection, or in tapping mode the amplitude or the phase"),
    FIELD(zloop.set_force, "N", 1e-12, 1e-4, "set point of contact mode: force of the deflection, which is 0 far out"),
    FIELD(zloop.set_amplitude, "", 0.05, 0.99, "set point of tapping mode, over the free amplitude"),
    FIELD(zloop.set_phase, "rad", 0.1, 1.5, "set point of phase feedback: lag of a tip that is repelled, below pi/2"),
    FIELD(zloop.integral, "1/s", 0.0, 1e7,
          "integral gain K_I, 0 for the largest with a gain margin of 2 and 45 degrees"),
    FIELD(zloop.rate, "Hz", 1e2, 1e7, "ticks of the loop per second"),
    FIELD(zloop.lock_in, "s", 0.0, 1.0, "time constant of the lock-in amplifier"),
    FIELD(zloop.noise, "m", 0.0, 1e-7, "noise of one reading of deflection or amplitude, standard deviation"),
    FIELD(raster.x, "m", -1e-3, 1e-3, "x of the first pixel"),
    FIELD(raster.y, "m", -1e-3, 1e-3, "y of the first pixel"),
    FIELD(raster.width, "m", 1e-9, 1e-3, "width of the scan"),
    FIELD(raster.height, "m", 1e-9, 1e-3, "height of the scan, across the lines"),
    FIELD(raster.pixels, "", 4.0, 8192.0, "pixels of a line"),
    FIELD(raster.lines, "", 1.0, 8192.0, "lines"),
    FIELD(raster.line_rate, "Hz", 1e-3, 1e4, "lines, there and back, per second"),
    FIELD(raster.tilt_x, "", -0.2, 0.2, "slope of the sample along x, against the scanner"),
    FIELD(raster.tilt_y, "", -0.2, 0.2, "slope of the sample along y, against the scanner"),
    FIELD(raster.drift, "m/s", -1e-6, 1e-6, "drift of the sample towards the tip"),
    FIELD(raster.drift_x, "m/s", -1e-6, 1e-6, "drift of the sample along x"),
    FIELD(raster.drift_y, "m/s", -1e-6, 1e-6, "drift of the sample along y"),
    FIELD(raster.hysteresis, "", 0.0, 0.4, "opening of the scanner's loop in x and y over the stroke, open loop"),
    FIELD(readout.lateral_per_normal, "", -1.0, 1.0, "share of the normal force that is read as a lateral force"),
    FIELD(readout.normal_per_lateral, "", -0.5, 0.5, "share of the lateral force that is read as a normal force"),
    FIELD(readout.lateral_noise, "N", 0.0, 1e-4, "noise of one reading of the lateral force, standard deviation"),
};

enum { SCAN_FIELDS = (int)(sizeof scan_fields / sizeof scan_fields[0]) };

nt_scan nt_scan_defaults(void)
{
    return (nt_scan){.zloop = {.mode = NT_ZLOOP_TAPPING,
                               .set_force = 1e-9,
                               .set_amplitude = 0.7,
                               .set_phase = 0.25 * NT_PI,
                               .rate = 50e3,
                               .lock_in = 20e-6,
                               .noise = 20e-12},
                     .raster = {.width = 1e-6, .height = 1e-6, .pixels = 256.0, .lines = 256.0, .line_rate = 1.0}};
}

const nt_field *nt_scan_fields(int *count)
{
    if (count != NULL)
        *count = SCAN_FIELDS;
    return scan_fields;
}

nt_status nt_scan_check(const nt_scan *scan, nt_problem *problem)
{
    return nt_field_check(scan_fields, SCAN_FIELDS, scan, problem);
}

/* Integral and stage of a scanner, one tick after the other: computing takes one. */
static double complex integral_and_stage(const void *context, double theta)
{
    const nt_scanner *s = context;
    const nt_oscillator *o = &s->stage.oscillator;
    const double complex less = nt_complex_from_one(theta), x = less + o->xf, v = less + 1.0 - o->vv;
    return s->period / less * (v * o->xf + o->xv * o->vf) / (x * v + o->xv * o->vf);
}

static nt_tap_loop tap_loop_of(const nt_scanner *s)
{
    return s->scan.zloop.mode == NT_ZLOOP_CONTACT ? nt_tap_loop_at_once()
                                                  : nt_tap_loop_make(&s->lever, &s->scan.zloop, s->answer);
}

static nt_open_loop open_loop_of(const nt_scanner *s, const nt_tap_loop *tap)
{
    const nt_stage *stage = &s->stage.stage;
    const double turn = 2.0 * NT_PI * stage->resonance * s->period, folded = fmod(turn, 2.0 * NT_PI);
    double corner = fmin(1.0, turn * fmin(1.0, stage->quality));
    if (s->scan.zloop.mode != NT_ZLOOP_CONTACT)
        corner = fmin(corner, fmin(tap->share, 0.5 * s->lever.rate * s->period / s->lever.quality));
    return (nt_open_loop){.tap = tap,
                          .stage = integral_and_stage,
                          .context = s,
                          .first = BELOW * corner,
                          .angle = fmin(folded, 2.0 * NT_PI - folded),
                          .width = 0.5 * turn / stage->quality};
}

double nt_scanner_gain(const nt_scanner *scanner)
{
    const nt_tap_loop tap = tap_loop_of(scanner);
    const nt_open_loop loop = open_loop_of(scanner, &tap);
    const nt_loop_limits limits = nt_open_loop_limits(&loop, PHASE_MARGIN);
    return fmin(limits.rings / GAIN_MARGIN, limits.phase);
}

nt_zloop_margins nt_scanner_margins(const nt_scanner *scanner)
{
    const nt_tap_loop tap = tap_loop_of(scanner);
    nt_open_loop loop = open_loop_of(scanner, &tap);
    const nt_loop_limits limits = nt_open_loop_limits(&loop, PHASE_MARGIN);
    loop.first = fmin(loop.first, BELOW * scanner->integral * scanner->period); /* its gain is 1 farther up */
    const nt_loop_phase phase = nt_open_loop_phase(&loop, scanner->integral);
    return (nt_zloop_margins){limits.rings / scanner->integral, phase.margin, phase.angle / scanner->period};
}

double nt_scanner_speed(const nt_scanner *scanner, double slope, double error)
{
    return scanner->integral * error / fabs(slope);
}

double nt_scanner_parachute(const nt_scanner *scanner, double height, double speed)
{
    const nt_zloop *loop = &scanner->scan.zloop;
    const double A0 = scanner->lever.free_amplitude;
    const double error = loop->mode == NT_ZLOOP_CONTACT ? loop->set_force / scanner->probe.spring_constant
                         : loop->mode == NT_ZLOOP_PHASE ? (1.0 - sin(loop->set_phase)) * A0
                                                        : (1.0 - loop->set_amplitude) * A0;
    return speed * height / (scanner->integral * error);
}

/* |K_I T/(z - 1)/(1 + L)|^2, with the mean over the ticks of a pixel. */
static double noise_gain(const nt_open_loop *loop, int answer, double theta)
{
    const nt_scanner *s = loop->context;
    const double complex one = 1.0 + s->integral * nt_open_loop_at(loop, answer, theta);
    const double half = sin(0.5 * theta), ticks = (double)s->ticks / s->scan.raster.pixels;
    const double mean = sin(0.5 * theta * ticks) / (ticks * half), gain = 0.5 * s->integral * s->period / half;
    return gain * gain * mean * mean / (creal(one) * creal(one) + cimag(one) * cimag(one));
}

double nt_scanner_noise(const nt_scanner *scanner)
{
    const nt_tap_loop tap = tap_loop_of(scanner);
    const nt_open_loop loop = open_loop_of(scanner, &tap);
    const double first = fmin(loop.first, BELOW * scanner->integral * scanner->period);
    double sum = first * noise_gain(&loop, tap.at_set_point, first); /* white: sigma^2/pi per rad of the circle */
    for (int i = 1; i < FREQUENCIES; i++) {
        const double from = first * pow(NT_PI / first, (double)(i - 1) / (FREQUENCIES - 1));
        const double to = first * pow(NT_PI / first, (double)i / (FREQUENCIES - 1));
        sum +=
            0.5 * (noise_gain(&loop, tap.at_set_point, from) + noise_gain(&loop, tap.at_set_point, to)) * (to - from);
    }
    return scanner->scan.zloop.noise * sqrt(sum / NT_PI);
}
