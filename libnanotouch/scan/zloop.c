/* SPDX-License-Identifier: BSD-3-Clause
 * The description of a scan, and the stability of its z loop: K_I/(i w) x S(i w) x P(i w) x lock-in x delay. */
#include <math.h>
#include <stddef.h>

#include "core/problem.h"
#include "core/same_bits.h"
#include "nanotouch/material.h"
#include "nanotouch/scan.h"

#define FIELD(path, ...) NT_FIELD(nt_scan, path, __VA_ARGS__)
#define GAIN_MARGIN 2.0
#define PHASE_MARGIN (0.25 * NT_PI)
#define ROUNDED 1e-9 /* of a gain of 1 */
#define STIFFER 2.0  /* than a flat: a hollow of four times the radius */
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

/* The amplitude follows the base at once where a hard sample holds it, and as slowly as 2 Q/w0 where nothing does; at
 * the set point it answers as the slow flow says, here and where the sample is STIFFER. The loop has to bear all of
 * them. Contact mode has the first alone. */
enum { AT_ONCE, FREELY, AT_SET_POINT, ANSWERS = AT_SET_POINT + 2 * NT_TAP_ANSWERS }; /* the odd ones: STIFFER */

static int has(const nt_scanner *s, int answer)
{
    const nt_zloop_mode mode = s->scan.zloop.mode;
    if (mode == NT_ZLOOP_CONTACT || answer < AT_SET_POINT)
        return mode == NT_ZLOOP_CONTACT ? answer == AT_ONCE : 1;
    return s->answer[(answer - AT_SET_POINT) / 2].amplitude > 0.0;
}

/* The slow flow about a motion, S = i w/w0, with a and p the changes of A and phi for one of the height:
 *     (2 r S + r/Q + fs_A) a - D cos(phi) p = -fs_z,    (2 r A S + D sin(phi)) p + (g_A + 1 - r^2) a = -g_z.
 * Phase feedback reads A0 cos(phi) p. */
static double of_set_point(const nt_scanner *s, const nt_tap_answer *at, double w, double *lag)
{
    const nt_tapping *t = &s->lever;
    const double r = t->ratio, S = w / t->rate, A = at->amplitude;
    const double x = r / t->quality + at->loss_swing, y = 2.0 * r * S, u = at->sine, v = y * A;
    const double k = at->force_swing + 1.0 - r * r;
    double real = -at->loss_height * u - at->cosine * at->force_height, imaginary = -at->loss_height * v, scale = 1.0;
    if (s->scan.zloop.mode == NT_ZLOOP_PHASE) {
        real = at->loss_height * k - x * at->force_height;
        imaginary = -y * at->force_height;
        scale = t->free_amplitude * at->cosine / t->strength;
    }
    const double below = x * u - y * v + at->cosine * k, beside = x * v + y * u;
    *lag = atan2(beside, below) - atan2(imaginary, real);
    return scale * hypotenuse(real, imaginary) / hypotenuse(below, beside);
}

static double answer_of(const nt_scanner *s, double w, int answer, double *lag)
{
    *lag = 0.0;
    if (answer == AT_ONCE)
        return 1.0;
    if (answer == FREELY) {
        const double slow = 2.0 * w * s->lever.quality / s->lever.rate;
        *lag = atan(slow);
        return 1.0 / hypotenuse(1.0, slow);
    }
    nt_tap_answer at = s->answer[(answer - AT_SET_POINT) / 2];
    if (answer % 2) {
        at.force_swing += (1.0 - STIFFER) * s->lever.cosine * at.force_height;
        at.force_height *= STIFFER;
    }
    return of_set_point(s, &at, w, lag);
}

/* Size and lag of the open loop with K_I = 1, at a frequency [rad/s]. */
static double open_loop(const nt_scanner *s, double w, int answer, double *lag)
{
    const nt_stage *stage = &s->stage.stage;
    const double r = w / (2.0 * NT_PI * stage->resonance), real = 1.0 - r * r, imaginary = r / stage->quality;
    double size = answer_of(s, w, answer, lag) / w / hypotenuse(real, imaginary);
    *lag += 0.5 * NT_PI + atan2(imaginary, real) + w * s->period;
    if (s->scan.zloop.mode != NT_ZLOOP_CONTACT) {
        const double amplifier = w * s->scan.zloop.lock_in;
        size /= hypotenuse(1.0, amplifier);
        *lag += atan(amplifier);
    }
    return size;
}

static double frequency_at(const nt_scanner *s, int i)
{
    const double first = 1e-3, last = NT_PI / s->period;
    return first * pow(last / first, (double)i / (FREQUENCIES - 1));
}

/* Largest size of the open loop with K_I = 1 where its lag is at least this. */
static double largest_beyond(const nt_scanner *s, double least_lag)
{
    double most = 0.0;
    for (int i = 0; i < FREQUENCIES * ANSWERS; i++) {
        double lag;
        if (!has(s, i / FREQUENCIES))
            continue;
        const double size = open_loop(s, frequency_at(s, i % FREQUENCIES), i / FREQUENCIES, &lag);
        if (lag >= least_lag)
            most = fmax(most, size);
    }
    return most;
}

double nt_scanner_gain(const nt_scanner *scanner)
{
    const double by_gain = 1.0 / (GAIN_MARGIN * largest_beyond(scanner, NT_PI));
    const double by_phase = 1.0 / largest_beyond(scanner, NT_PI - PHASE_MARGIN);
    return fmin(by_gain, by_phase);
}

nt_zloop_margins nt_scanner_margins(const nt_scanner *scanner)
{
    nt_zloop_margins found = {1.0 / (scanner->integral * largest_beyond(scanner, NT_PI)), NT_PI, 0.0};
    for (int i = 0; i < FREQUENCIES * ANSWERS; i++) {
        double lag;
        const double w = frequency_at(scanner, i % FREQUENCIES);
        if (!has(scanner, i / FREQUENCIES) ||
            scanner->integral * open_loop(scanner, w, i / FREQUENCIES, &lag) < 1.0 + ROUNDED)
            continue;
        found.phase = fmin(found.phase, NT_PI - lag);
        found.speed = fmax(found.speed, w);
    }
    return found;
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

/* |K_I/(i w)/(1 + L)|^2, with the mean over a pixel. */
static double noise_gain(const nt_scanner *s, double w)
{
    double lag;
    const double size = s->integral * open_loop(s, w, AT_ONCE, &lag), stage_free = s->integral / w;
    const double real = 1.0 + size * cos(lag), imaginary = size * sin(lag);
    const double half = 0.5 * w * s->period * (double)s->ticks / s->scan.raster.pixels;
    const double mean = half > 1e-6 ? sin(half) / half : 1.0;
    return stage_free * stage_free / (real * real + imaginary * imaginary) * mean * mean;
}

double nt_scanner_noise(const nt_scanner *scanner)
{
    double sum = 0.0;
    for (int i = 1; i < FREQUENCIES; i++) { /* white up to half the rate: sigma^2 T/pi per rad/s */
        const double from = frequency_at(scanner, i - 1), to = frequency_at(scanner, i);
        sum += 0.5 * (noise_gain(scanner, from) + noise_gain(scanner, to)) * (to - from);
    }
    return scanner->scan.zloop.noise * sqrt(sum * scanner->period / NT_PI);
}
