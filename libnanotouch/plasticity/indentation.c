/* SPDX-License-Identifier: BSD-3-Clause
 * A round tip on a sample that yields: see plasticity.h.
 *
 * In units of the yield strain, x = E* a/(Y R), d = delta E*^2/(Y^2 R), f = F E*^2/(Y^3 R^2), everything is a function
 * of x alone. g = p_m/Y is 4x/(3 pi) (Hertz) up to x_Y = 0.8 pi, where the peak pressure is 1.6 Y (Johnson 1985, Sec.
 * 6.2). Above, g = 16/15 + (2/3) ln(x/x_Y), the cavity of Johnson (1985, Sec. 6.3) with the constant that joins Hertz
 * at x_Y; Studman, Moore and Jones (1977) have one that is 2 % lower. It ends at g = 3 (Tabor 1951).
 *
 * Depth: the contact circle lies (delta + delta_r)/2 deep (Field and Swain 1993), and a^2/(2R) by the shape of the tip.
 * What unloads is Hertz' contact with the radius R' that has F at a: delta - delta_r = a^2/R' = 3F/(4 E* a). Then
 * d = x^2/2 + (3 pi/8) x g and d_r = x^2/2 - (3 pi/8) x g. */
#include <math.h>
#include <stddef.h>

#include "core/same_bits.h"
#include "internal/field.h"
#include "internal/plasticity.h"
#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/material.h"

#define FIELD(path, ...) NT_FIELD(nt_indentation, path, __VA_ARGS__)

static const nt_field indentation_fields[] = {
    FIELD(radius, "m", 1e-10, 1e-2, "R, of tip and sample together"),
    FIELD(effective_modulus, "Pa", 1e2, 1e13, "E* of tip and sample"),
    FIELD(yield_strength, "Pa", 1.0, 1e12, "Y, of the sample"),
};

enum { INDENTATION_FIELDS = (int)(sizeof indentation_fields / sizeof indentation_fields[0]) };

#define ONSET (0.8 * NT_PI)            /* x_Y */
#define AT_ONSET (16.0 / 15.0)         /* g there */
#define RISE (2.0 / 3.0)               /* dg/d(ln x) */
#define PLASTIC 3.0                    /* g at most */
#define PLASTIC_FROM 45.67660926233222 /*  x where it is reached: x_Y exp(2.9) */
#define EIGHTH (3.0 * NT_PI / 8.0)

nt_indentation nt_indentation_defaults(void)
{
    return (nt_indentation){.radius = 20e-9, .effective_modulus = 77e9, .yield_strength = 0.35e9};
}

const nt_field *nt_indentation_fields(int *count)
{
    if (count != NULL)
        *count = INDENTATION_FIELDS;
    return indentation_fields;
}

nt_status nt_indentation_check(const nt_indentation *indentation, nt_problem *problem)
{
    return nt_field_check(indentation_fields, INDENTATION_FIELDS, indentation, problem);
}

/* g, and its rise with ln x */
static double pressure(double x, double *rise)
{
    *rise = x <= ONSET ? x * 4.0 / (3.0 * NT_PI) : x <= PLASTIC_FROM ? RISE : 0.0;
    return x <= ONSET ? *rise : x <= PLASTIC_FROM ? AT_ONSET + RISE * log(x / ONSET) : PLASTIC;
}

static double depth_at(double x, double *slope)
{
    double rise;
    const double g = pressure(x, &rise);
    *slope = x + EIGHTH * (g + rise);
    return 0.5 * x * x + EIGHTH * x * g;
}

static double force_at(double x, double *slope)
{
    double rise;
    const double g = pressure(x, &rise);
    *slope = NT_PI * x * (2.0 * g + rise);
    return NT_PI * x * x * g;
}

/* x of a value between onset and full plasticity. Both functions are convex: from the right Newton only falls. */
static double between(double (*function)(double, double *), double value)
{
    double x = PLASTIC_FROM, slope;
    for (int i = 0; i < 60; ++i) {
        const double excess = function(x, &slope) - value;
        const double next = fmax(x - excess / slope, ONSET);
        if (!(next < x))
            break;
        x = next;
    }
    return x;
}

static double x_at_depth(double d)
{
    double unused;
    const double linear = EIGHTH * PLASTIC;
    if (!(d > ONSET * ONSET))
        return sqrt(d);
    if (d >= depth_at(PLASTIC_FROM, &unused))
        return 2.0 * d / (linear + sqrt(linear * linear + 2.0 * d));
    return between(depth_at, d);
}

static double x_at_force(double f)
{
    double unused;
    if (!(f > 4.0 / 3.0 * ONSET * ONSET * ONSET))
        return cube_root(0.75 * f);
    if (f >= force_at(PLASTIC_FROM, &unused))
        return sqrt(f / (NT_PI * PLASTIC));
    return between(force_at, f);
}

/* Integral of f dd = pi x^2 g (x + (3 pi/8)(g + g')) dx between two ends of a piece where g' = rise is constant. */
static double work_integral(double x, double g, double rise)
{
    const double cube = x * x * x;
    const double wide = NT_PI * x * cube * (g / 4.0 - rise / 16.0);
    return wide + NT_PI * NT_PI / 8.0 * cube * (g * g + rise * g / 3.0 - rise * rise / 9.0);
}

/* Heat of a first loading up to x: work minus what is stored. */
static double heat_at(double x)
{
    if (x <= ONSET)
        return 0.0;
    double rise;
    const double g = pressure(x, &rise), end = fmin(x, PLASTIC_FROM), at_end = pressure(end, &rise);
    double work =
        8.0 / 15.0 * pow(ONSET, 5.0) + work_integral(end, at_end, RISE) - work_integral(ONSET, AT_ONSET, RISE);
    if (x > PLASTIC_FROM)
        work += work_integral(x, PLASTIC, 0.0) - work_integral(PLASTIC_FROM, PLASTIC, 0.0);
    return fmax(work - 0.3 * NT_PI * NT_PI * x * x * x * g * g, 0.0);
}

/* [Pa/Pa] Y/E*, and with it the units of length and force. */
typedef struct units {
    double strain, radius, depth, force;
} units;

static units of(const nt_indentation *indentation)
{
    const double strain = indentation->yield_strength / indentation->effective_modulus;
    const double radius = strain * indentation->radius;
    return (units){strain, radius, strain * radius, indentation->yield_strength * radius * radius};
}

nt_first_loading nt_indentation_first(const nt_indentation *indentation, double contact_radius)
{
    const units unit = of(indentation);
    const double x = contact_radius / unit.radius;
    double rise;
    const double g = pressure(x, &rise), half = 0.5 * x * x, elastic = EIGHTH * x * g;
    const double residual = x <= ONSET ? 0.0 : half - elastic;
    return (nt_first_loading){
        .contact_radius = contact_radius,
        .indentation = (half + elastic) * unit.depth,
        .force = NT_PI * x * x * g * unit.force,
        .mean_pressure = g * indentation->yield_strength,
        .residual_depth = residual * unit.depth,
        .effective_radius = x <= ONSET ? indentation->radius : indentation->radius * 4.0 * x / (3.0 * NT_PI * g),
        .stored = 0.3 * NT_PI * NT_PI * x * x * x * g * g * unit.force * unit.depth,
        .dissipated = heat_at(x) * unit.force * unit.depth,
        .stiffness =
            x > 0.0 ? NT_PI * x * (2.0 * g + rise) / (x + EIGHTH * (g + rise)) * unit.force / unit.depth : 0.0};
}

double nt_indentation_radius_at_depth(const nt_indentation *indentation, double depth)
{
    const units unit = of(indentation);
    return x_at_depth(depth / unit.depth) * unit.radius;
}

double nt_indentation_radius_at_load(const nt_indentation *indentation, double load)
{
    const units unit = of(indentation);
    return x_at_force(load / unit.force) * unit.radius;
}

double nt_indentation_yield_load(const nt_indentation *indentation)
{
    return 4.0 / 3.0 * ONSET * ONSET * ONSET * of(indentation).force;
}

double nt_indentation_plastic_load(const nt_indentation *indentation)
{
    return NT_PI * PLASTIC_FROM * PLASTIC_FROM * PLASTIC * of(indentation).force;
}

/* Hertz' contact with the radius R' in a dent, `pressed` deeper than where it lets go [m]. */
static void press_dent(const nt_indentation *indentation, nt_indentation_state *state, double radius, double pressed)
{
    const double a = sqrt(radius * fmax(pressed, 0.0));
    state->contact_radius = a;
    state->force = 4.0 / 3.0 * indentation->effective_modulus * a * fmax(pressed, 0.0);
    state->stored = 0.4 * state->force * fmax(pressed, 0.0);
}

nt_status nt_indentation_advance(const nt_indentation *indentation, nt_indentation_state *state, double depth)
{
    if (!isfinite(depth) || !isfinite(state->dent_radius) || !isfinite(state->dissipated))
        return NT_E_NOT_FINITE;
    if (!(state->dent_radius >= 0.0 && state->dent_radius <= NT_INDENTATION_LARGEST_RADIUS * indentation->radius))
        return NT_E_RANGE;
    const nt_first_loading dent = nt_indentation_first(indentation, state->dent_radius);
    if (depth <= fmax(dent.indentation, 0.0)) {
        state->indentation = depth;
        press_dent(indentation, state, dent.effective_radius, depth - dent.residual_depth);
        return NT_OK;
    }
    const double a = nt_indentation_radius_at_depth(indentation, depth);
    if (a > NT_INDENTATION_LARGEST_RADIUS * indentation->radius)
        return NT_E_RANGE;
    const nt_first_loading now = nt_indentation_first(indentation, a);
    const int yields = a > ONSET * of(indentation).radius;
    *state = (nt_indentation_state){
        depth,      now.force,
        a,          yields ? a : 0.0,
        now.stored, fmax(now.dissipated, state->dissipated)}; /* it falls by a rounding at most */
    return NT_OK;
}

nt_status nt_indentation_run_n(const nt_indentation *indentation, nt_indentation_state *state, const double *depths,
                               nt_indentation_state *states, long count)
{
    for (long i = 0; i < count; ++i) {
        const nt_status status = nt_indentation_advance(indentation, state, depths[i]);
        if (status != NT_OK)
            return status;
        states[i] = *state;
    }
    return NT_OK;
}
