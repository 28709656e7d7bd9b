/* SPDX-License-Identifier: BSD-3-Clause
 * The loops of plot_31_friction_loop.py, one after the other: way of the support (nm), lateral force (nN). */
#include <stdio.h>

#include "nanotouch/advanced/contact_equilibrium.h"
#include "nanotouch/contact.h"
#include "nanotouch/friction.h"

static void leg(const nt_friction *friction, nt_friction_state *state, const nt_friction_contact *contact,
                const double ends[2], int points, double *x)
{
    for (int i = 0; i < points; ++i) {
        const double next = ends[0] + (ends[1] - ends[0]) * i / (points - 1);
        const double way[2] = {next - *x, 0.0};
        if (nt_friction_advance(friction, state, contact, way) == NT_OK)
            printf("%.12g %.12g\n", 1e9 * next, -1e9 * state->force[0]);
        *x = next;
    }
}

int main(void)
{
    const nt_contact contact = {20e-9, 5e9, 0.05, 1e9};
    const nt_friction friction = {1e9, 0.02, 100e6, 0.1};
    const double loads[] = {-4e-9, 0.0, 20e-9}, turns[] = {0.0, 5e-9, -5e-9, 5e-9};
    const int points[] = {200, 400, 400};
    nt_contact_law law;
    if (nt_contact_law_init(&law, NT_JKR, &contact) != NT_OK)
        return 1;
    for (int i = 0; i < 3; ++i) {
        double x = 0.0;
        nt_contact_state pressed;
        if (nt_contact_law_at_load(&law, loads[i], NT_BRANCH_STABLE, &pressed) != NT_OK)
            return 1;
        const nt_friction_contact touched = {pressed.value.a, nt_compressive_load(NT_JKR, &contact, pressed.value)};
        nt_friction_state state = {0};
        for (int k = 0; k < 3; ++k)
            leg(&friction, &state, &touched, &turns[k], points[k], &x);
    }
    return 0;
}
