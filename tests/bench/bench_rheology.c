/* SPDX-License-Identifier: BSD-3-Clause
 * A viscoelastic contact: nanoseconds per point of a curve and per tick of a loop, the least of many runs. Instructions
 * of a point, which do not depend on the load: `valgrind --tool=callgrind --toggle-collect=nt_viscoelastic_run
 * bench_rheology curve` over 2001 points (2000 of which are steps), once. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "../c/larger.h"
#include "internal/rheology.h"
#include "nanotouch/rheology.h"

enum { POINTS = 2001, RUNS = 200, TICKS = 200, ROOM = 400000 };

static double times[POINTS], positions[POINTS], forces[POINTS], derivatives[POINTS * 8], workspace[ROOM];

static double now(void)
{
    struct timespec time;
    timespec_get(&time, TIME_UTC);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

/* ns per point of a triangle, 1000 points down and back. */
static double curve(const nt_viscoelastic *contact, int runs, int with_derivatives)
{
    const nt_viscoelastic_path path = {times, positions, 0.0, POINTS, workspace};
    nt_viscoelastic_result result = {.forces = forces, .derivatives = with_derivatives ? derivatives : NULL};
    nt_problem problem;
    double least = INFINITY;
    for (int i = 0; i < POINTS; i++) {
        times[i] = 1e-3 * i;
        positions[i] = 1e-9 * (i <= 1000 ? i : 2000 - i);
    }
    if (nt_viscoelastic_workspace(contact, POINTS, with_derivatives) > ROOM)
        return NAN;
    for (int i = 0; i < runs; i++) {
        const double before = now();
        if (nt_viscoelastic_run(contact, &path, &result, &problem) != NT_OK)
            return NAN;
        least = smaller(least, (now() - before) / POINTS);
    }
    return least;
}

/* ns per tick in contact, with most of the springs pressed. */
static double loop(const nt_viscoelastic *contact, int springs)
{
    nt_viscoelastic_demand demand = nt_viscoelastic_demand_defaults();
    nt_viscoelastic_state state;
    nt_viscoelastic_bed bed;
    nt_problem problem;
    double least = INFINITY;
    memset(&state, 0, sizeof state);
    demand.springs = springs;
    demand.longest_time = 10.0;
    if (nt_viscoelastic_bed_make(contact, &demand, &bed, &problem) != NT_OK)
        return NAN;
    for (int i = 0; i < RUNS; i++) {
        const double before = now();
        for (int j = 0; j < TICKS; j++)
            (void)nt_viscoelastic_advance(&bed, &state, 0.9e-6 + 1e-9 * (j % 7));
        least = smaller(least, (now() - before) / TICKS);
    }
    return least;
}

int main(int count, char **words)
{
    nt_viscoelastic power = nt_viscoelastic_defaults(), series = power;
    power.spring_constant = 0.05;
    if (count > 1 && strcmp(words[1], "curve") == 0)
        return !(curve(&power, 1, 0) > 0.0);
    series.rheology.kind = NT_RHEOLOGY_PRONY;
    series.rheology.arm_count = 5;
    for (int k = 0; k < 5; k++) {
        series.rheology.arm_moduli[k] = 400.0 + 100.0 * k;
        series.rheology.relaxation_times[k] = 3e-3 * pow(5.0, k);
    }
    printf("curve, power law: %.0f ns a point, with derivatives %.0f\n", curve(&power, RUNS, 0),
           curve(&power, RUNS, 1));
    for (int springs = 64; springs <= NT_LOOP_SPRINGS; springs *= 2)
        printf("loop, %3d springs: %.0f ns a tick with five arms, %.0f of a power law\n", springs,
               loop(&series, springs), loop(&power, springs));
    return 0;
}
