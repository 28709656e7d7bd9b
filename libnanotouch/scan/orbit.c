/* SPDX-License-Identifier: BSD-3-Clause
 * One period of a tapping tip: harmonics of the force by Gauss points between its kinks and jumps (edges.h), and
 * Newton's method for the harmonics of the way. The loss is not integrated: jumps lose what their law says, the damping
 * of the contact has the area of its own loop, and what the medium takes from the higher harmonics came through the
 * force. */
#include "orbit.h"

#include <math.h>
#include <string.h>

#include "core/same_bits.h"
#include "edges.h"
#include "nanotouch/material.h"

#define STILL 1e-11 /* of the harmonics, over A0 */
#define ASIDE 1e-15 /* on either side of a jump [m] */
#define WAVES 6.0   /* longest piece of a quadrature, over the order of the highest harmonic [rad] */
enum { NEWTON_MAX = 25, HALVINGS = 6, SIZE = 2 * (NT_HARMONICS_MAX - 1), BISECTIONS = 60, GRID = 64 };

/* The gap at an angle, and its derivative. */
static double way_at(const orbit *o, double angle, double *derivative)
{
    const double c = cos(angle), s = sin(angle), cosine = o->balance->lever->cosine;
    double x = 0.0, y = 0.0, dx = 0.0; /* of the sum u_n z^n, and the real part of i n u_n z^n */
    double real = c, imaginary = s;
    for (int n = 2; n <= o->balance->harmonics; n++) {
        const double next = c * real - s * imaginary;
        imaginary = c * imaginary + s * real;
        real = next;
        x += o->at.real[n] * real - o->at.imaginary[n] * imaginary;
        y = o->at.real[n] * imaginary + o->at.imaginary[n] * real;
        dx -= n * y;
    }
    *derivative = cosine * (dx - o->at.swing * s);
    return o->middle + cosine * (o->at.swing * c + x);
}

static void find_lowest(orbit *o)
{
    double ignored;
    o->low_angle = NT_PI;
    o->lowest = way_at(o, NT_PI, &ignored);
    if (o->balance->harmonics == 1)
        return;
    double best = NT_PI;
    for (int i = 0; i <= GRID; i++) {
        const double angle = NT_PI * (0.5 + (double)i / GRID), gap = way_at(o, angle, &ignored);
        if (gap < o->lowest) {
            o->lowest = gap;
            best = angle;
        }
    }
    double low = best - NT_PI / GRID, high = best + NT_PI / GRID;
    for (int i = 0; i < 40; i++) {
        double slope;
        const double middle = 0.5 * (low + high);
        way_at(o, middle, &slope);
        *(slope < 0.0 ? &low : &high) = middle;
    }
    o->low_angle = 0.5 * (low + high);
    o->lowest = way_at(o, o->low_angle, &ignored);
}

/* Where the gap is passed between the lowest point and an angle beyond. */
static double angle_of(const orbit *o, double from, double end, double gap)
{
    const double c = (gap - o->middle) / (o->balance->lever->cosine * o->at.swing);
    const double first = acos(fmax(-1.0, fmin(1.0, c)));
    double near = from, far = end, angle = end > from ? 2.0 * NT_PI - first : first;
    if (o->balance->harmonics == 1)
        return angle;
    for (int i = 0; i < BISECTIONS; i++) {
        double slope;
        const double off = way_at(o, angle, &slope) - gap;
        if (fabs(off) < 1e-7 * fabs(slope) + 1e-18)
            break;
        *(off < 0.0 ? &near : &far) = angle;
        const double step = angle - off / slope;
        const int inside = (step - near) * (far - step) > 0.0;
        angle = inside ? step : 0.5 * (near + far);
    }
    return angle;
}

static nt_law_value law_at(const orbit *o, int attached, double gap)
{
    const nt_interaction_state history = {attached, 0.0, 0.0};
    return nt_interaction_eval_gap(o->balance->plan, &history, o->balance->place, gap);
}

/* Adds amount e^(-i n psi) to the sums of 0 .. count. */
static void add_wave(double sums[][2], int count, double angle, double amount)
{
    const double c = cos(angle), s = sin(angle);
    double x = amount, y = 0.0;
    for (int n = 0; n <= count; n++) {
        sums[n][0] += x;
        sums[n][1] -= y;
        const double next = c * x - s * y;
        y = c * y + s * x;
        x = next;
    }
}

static int products_of(const orbit *o)
{
    return o->balance->harmonics > 1 ? 2 * o->balance->harmonics : 0;
}

enum { DOWN = 1, UP = 2 };

/* Of 2 x 2, row by row. */
static void multiply(const double a[4], const double b[4], double product[4])
{
    const double c[4] = {a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
                         a[2] * b[1] + a[3] * b[3]};
    memcpy(product, c, sizeof c);
}

/* Deviations over a piece of the way; pieces come from the lowest point on, on either side. */
static void add_passage(orbit *o, int sides, const double passage[4])
{
    if (sides & DOWN)
        multiply(o->down, passage, o->down);
    if (sides & UP)
        multiply(passage, o->up, o->up);
}

/* r^2 y'' + (r/Q + d) y' + (1 + stiffness) y = 0 over a width [rad], stiffness and d over k_c. */
static void add_drift(orbit *o, int sides, double stiffness, double damper, double width)
{
    const nt_tapping *lever = o->balance->lever;
    const double r = lever->ratio, g = 0.5 * (1.0 / (r * lever->quality) + damper / (r * r));
    const double square = (1.0 + stiffness) / (r * r) - g * g, w = sqrt(fabs(square));
    const double c = square > 0.0 ? cos(w * width) : cosh(w * width);
    const double s = w * width < 1e-9 ? width : (square > 0.0 ? sin(w * width) : sinh(w * width)) / w;
    const double drift[4] = {c + g * s, s, -(square + g * g) * s, c - g * s};
    add_passage(o, sides, drift);
    o->decay += 2.0 * g * width * (sides == (DOWN | UP) ? 2.0 : 1.0);
}

int nt_orbit_returns(const orbit *o)
{
    double period[4];
    multiply(o->up, o->down, period);
    const double shrunk = exp(-0.5 * o->decay);
    return shrunk < 1.0 && fabs(period[0] + period[3]) * shrunk < 1.0 + shrunk * shrunk;
}

/* One Gauss point of a width [rad] on the way down, up, or both. */
static void add_point(orbit *o, int sides, double angle, double width)
{
    const int attached = sides == UP && o->captured;
    const double weight = (sides == (DOWN | UP) ? 2.0 : 1.0) * width / NT_PI;
    const nt_tapping *lever = o->balance->lever;
    double derivative;
    const double gap = way_at(o, angle, &derivative), k = lever->spring_constant;
    const nt_law_value law = law_at(o, attached, gap);
    const double damper = 2.0 * lever->viscosity * law.a * lever->cosine * lever->rate * lever->ratio;
    const double v = derivative / lever->cosine, force = law.F - damper * v;
    o->evaluations++;
    add_wave(o->force, o->orders, angle, weight * force / k);
    o->loss += weight * damper * v * v / k;
    o->peak = fmax(o->peak, force);
    o->contact_time += law.a > 0.0 ? 0.5 * weight : 0.0;
    if (o->is_complete)
        add_drift(o, sides, law.k * lever->cosine / k, damper / k, width);
    if (products_of(o) > 0) {
        add_wave(o->slope, products_of(o), angle, -weight * law.k / k);
        if (damper > 0.0)
            add_wave(o->damper, products_of(o), angle, weight * damper / k);
    }
}

/* A jump of the force, as a slope of no width. */
static void add_jump(orbit *o, int sides, double angle, double gap)
{
    double derivative;
    way_at(o, angle, &derivative);
    const nt_tapping *lever = o->balance->lever;
    const double rise = law_at(o, 0, gap + ASIDE).F - law_at(o, 1, gap).F;
    const double slope = rise / (fabs(derivative) * lever->spring_constant);
    if (products_of(o) > 0)
        add_wave(o->slope, products_of(o), angle, slope / NT_PI);
    const double kick[4] = {1.0, 0.0, slope * lever->cosine / (lever->ratio * lever->ratio), 1.0};
    if (o->is_complete)
        add_passage(o, sides, kick);
}

/* From the lowest point to the top, down (backwards), up, or both where they are alike. */
static void add_side(orbit *o, const nt_edges *edges, int sides)
{
    const nt_plan *plan = o->balance->plan;
    const int up = sides == UP;
    const double end = up ? 2.0 * NT_PI : 0.0,
                 jump = up ? plan->release_gap : nt_plan_capture_gap(plan, o->balance->place);
    double from = o->low_angle;
    for (int i = 0; i < edges->count; i++) {
        const int last = i == edges->count - 1;
        const double to = last ? end : angle_of(o, o->low_angle, end, edges->at[i]);
        const int pieces = 1 + (int)(fabs(to - from) * o->orders / WAVES);
        const double step = (to - from) / pieces;
        for (int p = 0; p < pieces * POINTS; p++)
            add_point(o, sides, from + (p / POINTS + points[p % POINTS]) * step, weights[p % POINTS] * fabs(step));
        if (!last && o->captured && edges->at[i] == jump)
            add_jump(o, sides, to, jump);
        from = to;
    }
}

/* All harmonics of the force; 0 where the contact never lets go. */
static int integrate(orbit *o)
{
    const nt_plan *plan = o->balance->plan;
    const nt_tapping *lever = o->balance->lever;
    double turned = -o->at.swing; /* the way where the first harmonic is lowest */
    for (int n = 2; n <= o->balance->harmonics; n++)
        turned += (n % 2 ? -1.0 : 1.0) * o->at.real[n];
    o->middle = o->at.depth - lever->cosine * turned;
    memset(o->force, 0, sizeof o->force);
    if (products_of(o) > 0) {
        memset(o->slope, 0, sizeof o->slope);
        memset(o->damper, 0, sizeof o->damper);
    }
    find_lowest(o);
    double ignored;
    const double top = o->top = way_at(o, 0.0, &ignored);
    nt_interaction_state history = {0, 0.0, 0.0};
    nt_interaction_advance_gap(plan, &history, o->balance->place, o->lowest);
    o->captured = history.attached;
    nt_interaction_advance_gap(plan, &history, o->balance->place, top);
    if (history.attached || !(o->lowest < top))
        return 0;
    o->loss = history.dissipated / (lever->cosine * NT_PI * lever->spring_constant);
    o->peak = law_at(o, o->captured, o->lowest).F;
    o->contact_time = 0.0;
    const nt_tapping_over over = {plan, o->balance->place, 0.0};
    const nt_edges edges = nt_edges_of(&over, o->lowest, top, o->captured);
    const int alike = o->balance->harmonics == 1 && !o->captured && lever->viscosity == 0.0;
    add_side(o, &edges, alike ? DOWN | UP : DOWN);
    if (!alike)
        add_side(o, &edges, UP);
    return isfinite(o->force[0][0]);
}

/* The lever's stiffness to a harmonic, over k_c. */
static void stiffness_of(const nt_tapping *lever, int n, double c[2])
{
    const double r = lever->ratio;
    c[0] = 1.0 - n * n * r * r;
    c[1] = n * r / lever->quality;
}

/* What is not in balance, as a way; the rests go to *rest, rows of real and imaginary parts. */
static double rest_of(const orbit *o, double rest[SIZE])
{
    double sum = 0.0;
    const int N = o->balance->harmonics;
    for (int n = 2; n <= N; n++) {
        double c[2];
        stiffness_of(o->balance->lever, n, c);
        const double x = c[0] * o->at.real[n] - c[1] * o->at.imaginary[n] - o->force[n][0];
        const double y = c[0] * o->at.imaginary[n] + c[1] * o->at.real[n] - o->force[n][1];
        rest[2 * (n - 2)] = x;
        rest[2 * (n - 2) + 1] = y;
        sum += (x * x + y * y) / (c[0] * c[0]);
    }
    return sqrt(sum);
}

/* Derivatives of the rests by the harmonics: F_n changes by 1/2 sum (K_(n-m) du_m + K_(n+m) du_m*), and by K_n where
 * the middle follows them, as the depth stays. */
static void jacobian_of(const orbit *o, double j[SIZE][SIZE + 1])
{
    const int N = o->balance->harmonics;
    const double cosine = o->balance->lever->cosine;
    for (int n = 2; n <= N; n++)
        for (int m = 2; m <= N; m++) {
            const int d = n > m ? n - m : m - n, s = n + m;
            const double sign = n >= m ? 1.0 : -1.0;
            const double px = 0.5 * (cosine * o->slope[d][0] + m * sign * o->damper[d][1]);
            const double py = 0.5 * (cosine * sign * o->slope[d][1] - m * o->damper[d][0]);
            const double qx = 0.5 * (cosine * o->slope[s][0] - m * o->damper[s][1]);
            const double qy = 0.5 * (cosine * o->slope[s][1] + m * o->damper[s][0]);
            double *x = &j[2 * (n - 2)][2 * (m - 2)], *y = &j[2 * (n - 2) + 1][2 * (m - 2)], c[2] = {0.0, 0.0};
            if (n == m)
                stiffness_of(o->balance->lever, n, c);
            const double follows = m % 2 ? -cosine : cosine;
            x[0] = c[0] - px - qx + follows * o->slope[n][0];
            x[1] = -c[1] + py - qy;
            y[0] = c[1] - py - qy + follows * o->slope[n][1];
            y[1] = c[0] - px + qx;
        }
}

/* Gauss' elimination with pivots; the right side is the last column and becomes the solution. 0: singular. */
static int eliminate(double a[SIZE][SIZE + 1], int size)
{
    for (int i = 0; i < size; i++) {
        int pivot = i;
        for (int row = i + 1; row < size; row++)
            pivot = fabs(a[row][i]) > fabs(a[pivot][i]) ? row : pivot;
        if (!(fabs(a[pivot][i]) > 0.0))
            return 0;
        for (int column = i; column <= SIZE && pivot != i; column++) {
            const double kept = a[i][column];
            a[i][column] = a[pivot][column];
            a[pivot][column] = kept;
        }
        for (int row = i + 1; row < size; row++) {
            const double share = a[row][i] / a[i][i];
            for (int column = i + 1; column < size; column++)
                a[row][column] -= share * a[i][column];
            a[row][SIZE] -= share * a[i][SIZE];
        }
    }
    for (int i = size - 1; i >= 0; i--) {
        for (int column = i + 1; column < size; column++)
            a[i][SIZE] -= a[i][column] * a[column][SIZE];
        a[i][SIZE] /= a[i][i];
    }
    return 1;
}

/* One of Newton's steps, halved until the rest falls; 0 where it does not. */
static int improve(orbit *o, double *rest)
{
    double j[SIZE][SIZE + 1], rests[SIZE];
    const int size = 2 * (o->balance->harmonics - 1);
    const nt_balance_state begun = o->at;
    rest_of(o, rests);
    jacobian_of(o, j);
    for (int i = 0; i < size; i++)
        j[i][SIZE] = -rests[i];
    if (!eliminate(j, size))
        return 0;
    double share = 1.0;
    for (int half = 0; half < HALVINGS; half++, share *= 0.5) {
        for (int i = 0; i < size / 2; i++) {
            o->at.real[i + 2] = begun.real[i + 2] + share * j[2 * i][SIZE];
            o->at.imaginary[i + 2] = begun.imaginary[i + 2] + share * j[2 * i + 1][SIZE];
        }
        if (!integrate(o))
            continue;
        const double now = rest_of(o, rests);
        if (now < *rest) {
            *rest = now;
            return 1;
        }
    }
    o->at = begun;
    return 0;
}

int nt_orbit_find(orbit *o)
{
    const nt_tapping *lever = o->balance->lever;
    const int N = o->balance->harmonics;
    double rests[SIZE];
    o->orders = N;
    if (!(o->at.swing > 0.0) || !integrate(o))
        return 0;
    const double still = STILL * lever->free_amplitude;
    double rest = rest_of(o, rests);
    for (int i = 0; i < NEWTON_MAX && rest > still; i++)
        if (!improve(o, &rest))
            return rest < 1e4 * still && integrate(o); /* on a kink the last digits do not come */
    return rest <= still;
}

void nt_orbit_complete(orbit *o)
{
    static const double none[4] = {1.0, 0.0, 0.0, 1.0};
    o->orders = o->balance->harmonics + NEGLECTED;
    o->is_complete = 1;
    o->decay = 0.0;
    memcpy(o->down, none, sizeof none);
    memcpy(o->up, none, sizeof none);
    integrate(o);
}
