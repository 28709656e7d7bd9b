/* SPDX-License-Identifier: BSD-3-Clause
 * The loops of plot_33_a_dent.py, one after the other: indentation (nm), force (nN). */
#include <stdio.h>

#include "nanotouch/advanced/plasticity.h"

enum { POINTS = 200 };

int main(void)
{
    const nt_indentation gold = {.radius = 20e-9, .effective_modulus = 77e9, .yield_strength = 0.35e9};
    const double loads[] = {50e-9, 100e-9, 200e-9};
    for (int i = 0; i < 3; ++i) {
        const double radius = nt_indentation_radius_at_load(&gold, loads[i]);
        const double deepest = nt_indentation_first(&gold, radius).indentation;
        nt_indentation_state state = {0};
        for (int k = 0; k < 2 * POINTS; ++k) {
            const double share = k < POINTS ? (double)k / (POINTS - 1) : (double)(2 * POINTS - 1 - k) / (POINTS - 1);
            if (nt_indentation_advance(&gold, &state, deepest * share) != NT_OK)
                return 1;
            printf("%.12g %.12g\n", 1e9 * state.indentation, 1e9 * state.force);
        }
    }
    return 0;
}
