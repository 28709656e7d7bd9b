/* SPDX-License-Identifier: BSD-3-Clause
 * Light that the sample reflects interferes with that of the cantilever and adds a wave over z, one period for half a
 * wavelength of height. It is looked for in the spectrum of what the line leaves over, and kept where it is evident. */
#include <math.h>
#include <string.h>

#include "curves/line.h"
#include "curves/robust.h"

enum {
    TERMS = 4, /* level, slope, cosine, sine */
    ROUNDS = 3 /* of Tukey's weights */
};
static const double two_pi = 6.28318530717958647693;
static const double shortest_period = 160e-9, longest_period = 800e-9; /* m: half of common lasers', inclined beams */
static const double cycles = 1.5;                                      /* periods that have to be seen */
static const double share = 0.3;                       /* of the variance of the residuals that a wave has to make */
static const double evidence = 10.0;                   /* difference in BIC: very strong */
static const double seen = 2.5;                        /* periods from which on less has to be explained */
static const double clearer = 1.5, much_clearer = 5.0; /* scatter about the line over that about the wave */

typedef struct waved {
    double level, slope; /* [N], [N/m] */
    nt_curve_wave wave;
    double squares; /* that they leave */
} waved;

double nt_curve_wave_at(const nt_curve_wave *wave, double x)
{
    if (wave->cosine == 0.0 && wave->sine == 0.0)
        return 0.0;
    const double phase = two_pi / wave->period * x;
    return wave->cosine * cos(phase) + wave->sine * sin(phase);
}

static double rest_of(const nt_curve_free *free, const waved *found, long i)
{
    return free->force[i] - found->level - found->slope * free->x[i] - nt_curve_wave_at(&found->wave, free->x[i]);
}

/* Weighted least squares at one period. */
static waved terms_at(const nt_curve_free *free, double inverse_period)
{
    const double scale = fmax(nt_curve_highest(free->x, free->count), -nt_curve_lowest(free->x, free->count));
    double normal[TERMS * TERMS] = {0.0}, right[TERMS] = {0.0};
    for (long i = 0; i < free->count; i++) {
        const double phase = two_pi * inverse_period * free->x[i];
        const double row[TERMS] = {1.0, free->x[i] / scale, cos(phase), sin(phase)};
        for (int j = 0; j < TERMS; j++) {
            const double weighted = free->weight[i] * row[j];
            right[j] += weighted * free->force[i];
            for (int k = 0; k <= j; k++)
                normal[j * TERMS + k] += weighted * row[k];
        }
    }
    waved found = {.squares = INFINITY};
    if (!nt_curve_solve(normal, right, TERMS))
        return found;
    found = (waved){right[0], right[1] / scale, {1.0 / inverse_period, right[2], right[3]}, 0.0};
    for (long i = 0; i < free->count; i++) {
        const double rest = rest_of(free, &found, i);
        found.squares += free->weight[i] * rest * rest;
    }
    return found;
}

/* The residuals at even steps of z, their mean taken off; room: 4 count doubles. */
static void at_even_steps(const nt_curve_free *free, double even[NT_WAVE_GRID], double *room)
{
    nt_curve_point *points = (nt_curve_point *)(void *)room;
    double mean = 0.0;
    for (long i = 0; i < free->count; i++)
        points[i] = (nt_curve_point){free->x[i], free->rest[i]};
    nt_curve_sort(points, free->count, points + free->count);
    const double first = points[0].z, travel = points[free->count - 1].z - first;
    for (long i = 0, next = 1; i < NT_WAVE_GRID; i++) {
        const double x = first + travel * (double)i / (NT_WAVE_GRID - 1);
        while (next + 1 < free->count && points[next].z < x)
            next++;
        const nt_curve_point low = points[next - 1], high = points[next];
        const double width = high.z - low.z, part = width > 0.0 ? fmin((x - low.z) / width, 1.0) : 1.0;
        even[i] = low.force + part * (high.force - low.force);
        mean += even[i] / NT_WAVE_GRID;
    }
    for (long i = 0; i < NT_WAVE_GRID; i++)
        even[i] -= mean;
}

/* |sum of even[i] exp(-i 2 pi k i/(4 grid))|^2 (Goertzel). */
static double power_at(const double even[NT_WAVE_GRID], long k)
{
    const double turn = two_pi * (double)k / (4.0 * NT_WAVE_GRID), twice = 2.0 * cos(turn);
    double last = 0.0, before = 0.0;
    for (long i = 0; i < NT_WAVE_GRID; i++) {
        const double next = even[i] + twice * last - before;
        before = last;
        last = next;
    }
    return last * last + before * before - twice * last * before;
}

/* 1/period of the strongest interference in the residuals [1/m]; 0 if it makes too little of them. */
static double likely_wave(const nt_curve_free *free, double travel)
{
    const double finest = 4.0 * travel / (double)(free->count < NT_WAVE_GRID ? free->count : NT_WAVE_GRID);
    const double most = 1.0 / fmax(shortest_period, finest), least = 1.0 / fmin(longest_period, travel / cycles);
    if (most <= least)
        return 0.0;
    double *even = free->room, total = 0.0, strongest = 0.0, found = 0.0;
    at_even_steps(free, even, free->room + NT_WAVE_GRID);
    for (long i = 0; i < NT_WAVE_GRID; i++)
        total += even[i] * even[i];
    for (long k = 1; k <= 2 * NT_WAVE_GRID; k++) {
        const double inverse = (double)k / (4.0 * travel);
        if (inverse < least || inverse > most)
            continue;
        const double power = power_at(even, k);
        if (power > strongest) {
            strongest = power;
            found = inverse;
        }
    }
    return 2.0 * strongest > share * NT_WAVE_GRID * total ? found : 0.0;
}

static double refined(const nt_curve_free *free, double inverse, double step)
{
    for (int round = 0; round < 4; round++, step /= 3.0) {
        double best = inverse, least = INFINITY;
        for (int i = 0; i < 5; i++) {
            const double tried = inverse + step * (0.5 * i - 1.0), squares = terms_at(free, tried).squares;
            if (squares < least) {
                least = squares;
                best = tried;
            }
        }
        inverse = best;
    }
    return inverse;
}

/* Whether the wave is one, and not the wandering of a drifting force, which has no period: by the BIC of the line over
 * that of the wave, with as many points as the residuals of the wave are worth; and by how much scatter it explains, of
 * which drift leaves more, the more periods are seen. */
static int is_evident(const nt_curve_free *free, double before, double after, double periods)
{
    if (after == 0.0)
        return 1;
    const double gain = before / after, worth = (double)free->count / nt_curve_correlation(free, after);
    const double bic = worth * 2.0 * log(gain) - 3.0 * log(fmax(worth, 1.0));
    return gain >= (periods >= seen ? clearer : much_clearer) && bic >= evidence;
}

/* Whether the outer half is straight by itself: a wave through it that fits no better is the contact that reaches into
 * the inner half. */
static int is_straight_outside(const nt_curve_free *free)
{
    double n = 0.0, sum[2] = {0.0}, square[2] = {0.0}, product = 0.0, wave = 0.0;
    for (long i = 0; i < free->count; i++) {
        if (!(free->x[i] > 0.0))
            continue;
        const double row[2] = {free->x[i], free->force[i]};
        n += 1.0;
        wave += free->rest[i] * free->rest[i];
        product += row[0] * row[1];
        for (int j = 0; j < 2; j++) {
            sum[j] += row[j];
            square[j] += row[j] * row[j];
        }
    }
    if (n < 3.0)
        return 0;
    const double across = square[0] - sum[0] * sum[0] / n, along = product - sum[0] * sum[1] / n;
    return square[1] - sum[1] * sum[1] / n - along * along / across < wave;
}

nt_curve_baseline nt_curve_with_wave(nt_curve_free *free, const nt_curve_baseline *line, int asked)
{
    const double travel = nt_curve_highest(free->x, free->count) - nt_curve_lowest(free->x, free->count);
    const double start = likely_wave(free, travel);
    if (!(start > 0.0) || !(line->scatter > 0.0))
        return *line;
    nt_curve_weigh(free->rest, free->count, line->scatter, free->weight);
    const double inverse = refined(free, start, 0.25 / travel);
    nt_curve_baseline baseline = *line;
    for (int round = 0; round < ROUNDS; round++) {
        const waved found = terms_at(free, inverse);
        for (long i = 0; i < free->count; i++)
            free->rest[i] = rest_of(free, &found, i);
        baseline.force = found.level;
        baseline.slope = found.slope;
        baseline.wave = found.wave;
        baseline.scatter = NT_MAD_SIGMA * nt_curve_median_size(free->rest, free->count, free->scratch);
        if (baseline.scatter == 0.0)
            break;
        nt_curve_weigh(free->rest, free->count, baseline.scatter, free->weight);
    }
    nt_curve_judge(free, &baseline);
    const int kept =
        asked || (is_evident(free, line->scatter, baseline.scatter, travel * inverse) && !is_straight_outside(free));
    return kept ? baseline : *line;
}
