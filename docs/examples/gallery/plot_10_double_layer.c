/* SPDX-License-Identifier: BSD-3-Clause
 * The curves of plot_10_double_layer.py: gap (nm), then the repulsion (pN) in 1, 10 and 100 mM. */
#include <stdio.h>

#include "nanotouch/forces.h"

enum { POINTS = 300 };

int main(void)
{
    for (int i = 0; i < POINTS; ++i) {
        const double gap = 0.5e-9 + 39.5e-9 * i / (POINTS - 1);
        printf("%.12g", 1e9 * gap);
        for (double salt = 1.0; salt <= 100.0; salt *= 10.0) { /* mol/m^3 */
            const nt_double_layer layer = {.radius = 30e-9,
                                           .debye_length = nt_debye_length(salt, 78.5, 298.15),
                                           .relative_permittivity = 78.5,
                                           .tip_potential = -0.02,
                                           .sample_potential = -0.02,
                                           .minimum_gap = 0.2e-9};
            printf(" %.12g", 1e12 * nt_double_layer_potential_eval(&layer, gap).F);
        }
        printf("\n");
    }
    return 0;
}
