/* SPDX-License-Identifier: BSD-3-Clause
 * The curves of plot_06_van_der_waals.py: gap (nm), then the attraction (nN) of Derjaguin, sphere, sphere and cone. */
#include <math.h>
#include <stdio.h>

#include "nanotouch/forces.h"

enum { POINTS = 200 };

int main(void)
{
    const nt_vdw sphere = {.radius = 30e-9, .hamaker_constant = 1e-19, .minimum_gap = 0.2e-9};
    const nt_vdw_tip tip = {30e-9, 1e-19, 0.35, 10e-6, 0.0, 0.2e-9};
    nt_problem problem;
    if (nt_vdw_check(&sphere, &problem) != NT_OK || nt_vdw_tip_check(&tip, &problem) != NT_OK)
        return 1;
    for (int i = 0; i < POINTS; ++i) {
        const double gap = 0.3e-9 * pow(100.0 / 0.3, (double)i / (POINTS - 1));
        printf("%.12g %.12g %.12g %.12g\n", 1e9 * gap, -1e9 * nt_vdw_derjaguin_eval(&sphere, gap).F,
               -1e9 * nt_vdw_eval(&sphere, gap).F, -1e9 * nt_vdw_tip_eval(&tip, gap).F);
    }
    return 0;
}
