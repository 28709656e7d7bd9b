/* SPDX-License-Identifier: BSD-3-Clause
 * The curves of plot_01_four_models.py: gap (nm), then the force (nN) of each model. */
#include <stdio.h>

#include "nanotouch/contact.h"

enum { POINTS = 800 };

int main(void)
{
    const nt_contact contact = {20e-9, 3e9, 0.048, 0.048 / 0.2e-9};
    nt_contact_law laws[4];
    for (int m = 0; m < 4; ++m)
        if (nt_contact_law_init(&laws[m], (nt_model)m, &contact) != NT_OK)
            return 1;
    for (int i = 0; i < POINTS; ++i) {
        const double gap = 2e-9 - 3.5e-9 * i / (POINTS - 1);
        printf("%.12g", 1e9 * gap);
        for (int m = 0; m < 4; ++m) {
            nt_law_value law;
            if (nt_contact_law_eval(&laws[m], -gap, NT_BRANCH_STABLE, &law) != NT_OK)
                return 1;
            printf(" %.12g", 1e9 * law.F);
        }
        printf("\n");
    }
    return 0;
}
