/* SPDX-License-Identifier: BSD-3-Clause
 * One law on an array: force, stiffness and contact radius of Hertz and of an adhesive contact over indentation. */
#include <stdio.h>

#include "nanotouch/contact.h"

enum { POINTS = 9 };

int main(void)
{
    const nt_contact contact = nt_contact_defaults();
    double indentation[POINTS], force[POINTS], stiffness[POINTS], radius[POINTS]; /* [m], [N], [N/m], [m] */
    for (int i = 0; i < POINTS; ++i)
        indentation[i] = i * 0.25e-9;
    nt_contact_law law;
    nt_status status = nt_contact_law_init(&law, NT_JKR, &contact);
    if (status == NT_OK)
        status = nt_contact_law_eval_n(&law, NT_BRANCH_STABLE,
                                       &(nt_strided){.in = indentation,
                                                     .F = force,
                                                     .k = stiffness,
                                                     .a = radius,
                                                     .count = POINTS,
                                                     .in_stride = 1,
                                                     .out_stride = 1});
    if (status != NT_OK) {
        fprintf(stderr, "%s\n", nt_status_message(status));
        return 1;
    }
    printf("%12s %12s %12s %12s %12s\n", "indentation", "Hertz", "JKR", "stiffness", "radius");
    for (int i = 0; i < POINTS; ++i)
        printf("%9.2f nm %9.3f nN %9.3f nN %8.2f N/m %9.3f nm\n", indentation[i] * 1e9,
               nt_hertz_force(&contact, indentation[i]) * 1e9, force[i] * 1e9, stiffness[i], radius[i] * 1e9);
    return 0;
}
