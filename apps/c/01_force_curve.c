/* SPDX-License-Identifier: BSD-3-Clause
 * Example 1: the force on a silicon tip over its indentation into silicon, by four contact models, on retraction.
 * Build: cc 01_force_curve.c $(pkg-config --cflags --libs nanotouch) */
#include <stdio.h>

#include "nanotouch/contact.h"

enum { MODELS = 4 };

static int complain(nt_status status, const char *doing)
{
    fprintf(stderr, "%s: %s\n", doing, nt_status_message(status));
    return 1;
}

static nt_status print_row(const nt_contact_law *laws, double indentation)
{
    printf("%8.2f", indentation * 1e9);
    for (int i = 0; i < MODELS; i++) {
        nt_law_value value;
        const nt_status status = nt_contact_law_eval(&laws[i], indentation, NT_BRANCH_STABLE, &value);
        if (status != NT_OK)
            return status;
        printf(" %10.3f", value.F * 1e9);
    }
    printf("\n");
    return NT_OK;
}

int main(void)
{
    const nt_contact contact = nt_contact_defaults();
    nt_contact_law laws[MODELS];
    nt_problem problem;
    char text[200];

    nt_status status = nt_contact_check(&contact, &problem);
    if (status != NT_OK)
        return complain(status, nt_problem_print(&problem, text, sizeof text));

    printf("R = %.3g nm, E* = %.3g GPa, w = %.3g J/m2, Maugis' lambda = %.3g\n\n", contact.radius * 1e9,
           contact.effective_modulus * 1e-9, contact.work_of_adhesion, nt_maugis_lambda(&contact));
    printf("%8s", "");
    for (int i = 0; i < MODELS; i++) {
        status = nt_contact_law_init(&laws[i], (nt_model)i, &contact);
        if (status != NT_OK)
            return complain(status, nt_model_name((nt_model)i));
        printf(" %10s", nt_model_name((nt_model)i));
    }
    printf("\n%8s", "nm");
    for (int i = 0; i < MODELS; i++)
        printf(" %10s", "nN");
    printf("\n");

    for (int i = -4; i <= 8; i++) {
        status = print_row(laws, i * 0.1e-9);
        if (status != NT_OK)
            return complain(status, "force curve");
    }
    printf("\n%8s", "pull-off");
    for (int i = 0; i < MODELS; i++)
        printf(" %10.3f", nt_contact_law_pull_off_force(&laws[i]) * 1e9);
    printf("\n");
    return 0;
}
