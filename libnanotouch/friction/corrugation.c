/* SPDX-License-Identifier: BSD-3-Clause
 * Prandtl's and Tomlinson's tip: see friction.h.
 *
 * Reduced: phi = 2 pi x/a, theta = 2 pi X/a, energies in E0/2, forces in pi E0/a, times in gamma a^2/(2 pi^2 E0):
 *     u = -cos(phi) + (phi - theta)^2/(2 eta),  phi' = -du/dphi + noise of variance 2 t,  t = 2 kT/E0,
 *     theta' = gamma v a/(pi E0). */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "core/problem.h"
#include "core/roots.h"
#include "internal/corrugation.h"
#include "internal/field.h"
#include "nanotouch/friction.h"

#define FIELD(path, ...) NT_FIELD(nt_corrugation, path, __VA_ARGS__)
#define TURN (2.0 * NT_PI)
#define TOLERANCE 1e-6 /* of a step of phi */
#define REPEATS 1e-9   /* the motion, from period to period */
#define LARGEST_SPEED 10.0
#define SLOWEST 1e-12
#define LEAST_ONSET 3.0 /* thermal: barriers of some kT */
#define LEAST_HEAT 4e-3
#define LARGEST_HEAT (2.0 / 13.0) /* 2 kT/E0 */
#define ATHERMAL 0.1              /* times t^1.5: quicker, and the tip leaves its well before heat takes it out */
#define GONE 1e9                  /* rate out of a well that is none */

enum { PERIODS = 400, STEPS = 2000000, WELLS = 9, MIDDLE = WELLS / 2, PARTS = 512, POINTS = 96 };

static const nt_field corrugation_fields[] = {
    FIELD(energy, "J", 1e-24, 1e-15, "E0, corrugation from valley to top"),
    FIELD(period, "m", 1e-11, 1e-6, "a, of the lattice"),
    FIELD(stiffness, "N/m", 1e-6, 1e6, "k, of contact and lever in series"),
    FIELD(damping, "N s/m", 1e-15, 1e3, "gamma, of the sliding tip"),
    FIELD(temperature, "K", 0.0, 3000.0, "T, 0 for none"),
};

enum { CORRUGATION_FIELDS = (int)(sizeof corrugation_fields / sizeof corrugation_fields[0]) };

nt_corrugation nt_corrugation_defaults(void)
{
    return (nt_corrugation){
        .energy = 0.4 * NT_ELEMENTARY_CHARGE, .period = 0.5e-9, .stiffness = 1.0, .damping = 1e-6, .temperature = 0.0};
}

const nt_field *nt_corrugation_fields(int *count)
{
    if (count != NULL)
        *count = CORRUGATION_FIELDS;
    return corrugation_fields;
}

nt_status nt_corrugation_check(const nt_corrugation *corrugation, nt_problem *problem)
{
    return nt_field_check(corrugation_fields, CORRUGATION_FIELDS, corrugation, problem);
}

double nt_corrugation_onset(const nt_corrugation *corrugation)
{
    return 2.0 * NT_PI * NT_PI * corrugation->energy /
           (corrugation->stiffness * corrugation->period * corrugation->period);
}

double nt_corrugation_largest_force(const nt_corrugation *corrugation)
{
    return NT_PI * corrugation->energy / corrugation->period;
}

/* A corrugation reduced; unit: pi E0/(a gamma) [m/s]. */
typedef struct reduced {
    double eta, heat, unit;
} reduced;

/* --- athermal: phi' = (theta - phi)/eta - sin(phi) --- */

typedef struct support {
    double eta, speed; /* theta' */
} support;

/* One step h of Rosenbrock's method of order 2 (L-stable; Verwer, Spee, Blom, Hundsdorfer 1999) in phi from (theta,
 * phi); *error: beside its first order. */
static double rosenbrock(const support *of, double theta, double phi, double h, double *error)
{
    const double g = 1.0 - sqrt(0.5), slope = -cos(phi) - 1.0 / of->eta, ahead = of->speed / of->eta;
    const double left = 1.0 - g * h * slope;
    const double first = ((theta - phi) / of->eta - sin(phi) + g * h * ahead) / left;
    const double there = phi + h * first;
    const double rate = (theta + h * of->speed - there) / of->eta - sin(there);
    const double second = (rate - 2.0 * first - g * h * ahead) / left;
    *error = fabs(0.5 * h * (first + second));
    return phi + h * (1.5 * first + 0.5 * second);
}

/* A period of theta from *phi: *phi after it, relative to theta, and the integral of the spring's force over theta. */
static nt_status athermal_period(const support *of, double *phi, double *h, double *sum)
{
    const double period = TURN / of->speed;
    double time = 0.0;
    *sum = 0.0;
    for (int i = 0; i < STEPS; ++i) {
        const double step = fmin(*h, period - time), theta = of->speed * time;
        double error;
        const double after = rosenbrock(of, theta, *phi, step, &error);
        const double scale = 0.9 * sqrt(TOLERANCE / fmax(error, 1e-3 * TOLERANCE));
        if (error <= TOLERANCE) {
            const double begin = theta - *phi, end = theta + of->speed * step - after;
            *sum += 0.5 * (begin + end) / of->eta * of->speed * step;
            *phi = after;
            time += step;
            if (time >= period) {
                *phi -= TURN;
                return NT_OK;
            }
        }
        *h = step * fmin(fmax(scale, 0.2), 2.0);
    }
    return NT_E_NO_CONVERGENCE;
}

static nt_status athermal_force(const reduced *r, double speed, double *force)
{
    const support of = {r->eta, speed};
    double phi = 0.0, h = 1e-3, sum = 0.0;
    for (int i = 0; i < PERIODS; ++i) {
        const double before = sum, from = phi;
        const nt_status status = athermal_period(&of, &phi, &h, &sum);
        if (status != NT_OK)
            return status;
        if (i > 0 && fabs(phi - from) <= 10.0 * TOLERANCE && fabs(sum - before) <= 100.0 * TOLERANCE * TURN) {
            *force = sum / TURN;
            return NT_OK;
        }
    }
    return NT_E_NO_CONVERGENCE;
}

/* --- thermal: hops between wells --- */

typedef struct wells {
    double eta, heat, edge; /* edge: phi where a well ends, cos = -1/eta */
} wells;

/* The well at 0, with the support at y from it. */
typedef struct well {
    double lowest, mean; /* phi */
    double up, down;     /* rates to the next ones */
} well;

typedef struct pulled {
    double eta, y;
} pulled;

static double slope_of(double phi, const void *context)
{
    const pulled *p = context;
    return sin(phi) + (phi - p->y) / p->eta;
}

static double energy_at(double phi, const pulled *p)
{
    return -cos(phi) + 0.5 * (phi - p->y) * (phi - p->y) / p->eta;
}

/* The well's lowest point. 0: there is none, the support is too far. */
static int find_lowest(const wells *of, double y, double *phi)
{
    const pulled p = {of->eta, y};
    return slope_of(-of->edge, &p) < 0.0 && slope_of(of->edge, &p) > 0.0 &&
           nt_root_find(slope_of, &p, (double[]){-of->edge, of->edge}, phi, NULL) == NT_OK;
}

/* The top before the next well, and that well's lowest point. 0: there is no next well yet. */
static int find_top(const wells *of, double y, double *top, double *next)
{
    const pulled p = {of->eta, y};
    if (!find_lowest(of, y - TURN, next))
        return 0;
    *next += TURN;
    return nt_root_find(slope_of, &p, (double[]){of->edge, TURN - of->edge}, top, NULL) == NT_OK;
}

/* The integrals of exp(sign (u - u(at))/t), and of phi times that, by the midpoint rule. */
static void integrate(const wells *of, const pulled *p, double sign, const double range[3], double sums[2])
{
    const double h = (range[1] - range[0]) / POINTS, reference = energy_at(range[2], p);
    sums[0] = sums[1] = 0.0;
    for (int i = 0; i < POINTS; ++i) {
        const double phi = range[0] + (i + 0.5) * h;
        const double weight = h * exp(sign * (energy_at(phi, p) - reference) / of->heat);
        sums[0] += weight;
        sums[1] += weight * phi;
    }
}

/* The rate over a top (Kramers 1940, with both integrals as they are): t/(well's of exp(-u/t) x top's of exp(u/t)). */
static double rate_over(const wells *of, double y, const double ends[3], double share)
{
    const pulled p = {of->eta, y};
    const double lowest = ends[0], top = ends[1], next = ends[2];
    double barrier[2];
    integrate(of, &p, 1.0, (double[]){lowest, next, top}, barrier);
    return of->heat / (share * barrier[0]) * exp(-(energy_at(top, &p) - energy_at(lowest, &p)) / of->heat);
}

static well well_at(const wells *of, double y)
{
    const pulled p = {of->eta, y};
    double lowest, top[2] = {NT_PI, NT_PI}, next[2], share[2];
    if (!find_lowest(of, y, &lowest))
        return (well){y, y, y > 0.0 ? GONE : 0.0, y > 0.0 ? 0.0 : GONE};
    const int has[2] = {find_top(of, y, &top[0], &next[0]), find_top(of, -y, &top[1], &next[1])};
    integrate(of, &p, -1.0, (double[]){-top[1], top[0], lowest}, share);
    well found = {lowest, share[1] / share[0], 0.0, 0.0};
    if (has[0])
        found.up = rate_over(of, y, (double[]){lowest, top[0], next[0]}, share[0]);
    if (has[1])
        found.down = rate_over(of, -y, (double[]){-lowest, top[1], next[1]}, share[0]);
    return found;
}

/* p after a time h, implicitly: (1 - h M) p' = p, tridiagonal, by elimination without pivots (an M-matrix). */
static void hop(const well row[WELLS], double h, double p[WELLS])
{
    double back[WELLS], diagonal = 1.0 + h * row[0].up;
    for (int j = 1; j < WELLS; ++j) {
        const double up = h * row[j - 1].up, down = h * row[j].down;
        const double ratio = up / diagonal;
        back[j] = down / diagonal;
        p[j] += ratio * p[j - 1];
        p[j - 1] /= diagonal;
        diagonal = 1.0 + down * (1.0 - ratio) + (j + 1 < WELLS ? h * row[j].up : 0.0);
    }
    p[WELLS - 1] /= diagonal;
    for (int j = WELLS - 2; j >= 0; --j)
        p[j] += back[j + 1] * p[j + 1];
}

/* A period of the support. Returns the mean force; the wells go one back. */
static double thermal_period(const wells *of, double speed, double p[WELLS])
{
    const double part = TURN / PARTS;
    double sum = 0.0;
    for (int n = 1; n <= PARTS; ++n) {
        well row[WELLS];
        for (int j = 0; j < WELLS; ++j)
            row[j] = well_at(of, part * n - TURN * (j - MIDDLE));
        hop(row, part / speed, p);
        for (int j = 0; j < WELLS; ++j)
            sum += p[j] * (part * n - TURN * (j - MIDDLE) - row[j].mean) / of->eta;
    }
    for (int j = 0; j + 1 < WELLS; ++j)
        p[j] = p[j + 1];
    p[WELLS - 1] = 0.0;
    return sum / PARTS;
}

static nt_status thermal_force(const reduced *r, double speed, double *force)
{
    const wells of = {r->eta, r->heat, acos(-1.0 / r->eta)};
    double p[WELLS] = {0.0};
    p[MIDDLE] = 1.0;
    for (int i = 0; i < PERIODS; ++i) {
        double before[WELLS], change = 0.0;
        memcpy(before, p, sizeof before);
        const double mean = thermal_period(&of, speed, p);
        for (int j = 0; j < WELLS; ++j)
            change += fabs(p[j] - before[j]);
        if (change <= REPEATS) {
            *force = mean;
            return NT_OK;
        }
    }
    return NT_E_NO_CONVERGENCE;
}

/* What the methods hold for. */
static nt_status check_range(const reduced *r, double speed, nt_problem *problem)
{
    const int hot = r->heat > 0.0;
    const double least = hot ? LEAST_ONSET : 0.0, slowest = SLOWEST * r->unit;
    const double quickest = (hot ? ATHERMAL * r->heat * sqrt(r->heat) : LARGEST_SPEED) * r->unit;
    if (!(r->eta >= least && r->eta <= NT_CORRUGATION_ONSET_MAX))
        return nt_problem_set(problem, "eta = 2 pi^2 E0/(k a^2)", "", r->eta, least, NT_CORRUGATION_ONSET_MAX);
    if (hot && !(r->heat >= LEAST_HEAT && r->heat <= LARGEST_HEAT))
        return nt_problem_set(problem, "kT/E0", "", 0.5 * r->heat, 0.5 * LEAST_HEAT, 0.5 * LARGEST_HEAT);
    if (!(speed >= slowest && speed <= quickest))
        return nt_problem_set(problem, "speed", "m/s", speed, slowest, quickest);
    return NT_OK;
}

nt_status nt_corrugation_mean_force(const nt_corrugation *corrugation, double speed, double *force, nt_problem *problem)
{
    const double largest = nt_corrugation_largest_force(corrugation);
    const reduced r = {.eta = nt_corrugation_onset(corrugation),
                       .heat = 2.0 * NT_BOLTZMANN * corrugation->temperature / corrugation->energy,
                       .unit = largest / corrugation->damping};
    nt_status status = nt_corrugation_check(corrugation, problem);
    if (status == NT_OK)
        status = check_range(&r, speed, problem);
    if (status != NT_OK)
        return status;
    double mean;
    status = r.heat > 0.0 ? thermal_force(&r, speed / r.unit, &mean) : athermal_force(&r, speed / r.unit, &mean);
    if (status == NT_OK)
        *force = mean * largest;
    return status;
}
