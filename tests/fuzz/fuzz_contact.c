/* SPDX-License-Identifier: BSD-3-Clause
 * Any contact, any indentation, every law and branch: a status or a finite answer, never more attraction than pull-off.
 */
#include "input.h"
#include "nanotouch/contact.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_value(const nt_contact_law *law, double indentation, nt_branch branch)
{
    nt_law_value value;
    if (nt_contact_law_eval(law, indentation, branch, &value) != NT_OK)
        return;
    REQUIRE(isfinite(indentation));
    if (fabs(indentation) > 1.0) /* a metre: powers may overflow beyond */
        return;
    REQUIRE(isfinite(value.U) && isfinite(value.F) && isfinite(value.k) && value.a >= 0.0 && isfinite(value.a));
    REQUIRE(value.F >= -nt_contact_law_pull_off_force(law) * (1.0 + 1e-9) - 1e-300); /* forces below are denormal */
    if (branch != NT_BRANCH_UNSTABLE)
        REQUIRE(value.k >= 0.0 || value.a == 0.0 || value.F < 0.0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    const nt_contact contact = {.radius = fuzz_double(&in, 1e-10, 1e-3),
                                .effective_modulus = fuzz_double(&in, 1e2, 1e13),
                                .work_of_adhesion = fuzz_double(&in, 0.0, 10.0),
                                .cohesive_stress = fuzz_double(&in, 1e3, 1e12)};
    const double indentation = fuzz_double(&in, -1e-7, 1e-7);
    /* Adhesion that is not 0 and yet nothing: its powers underflow. */
    if ((contact.work_of_adhesion > 0.0 && contact.work_of_adhesion < 1e-12) || contact.cohesive_stress < 1e-6)
        return 0;
    const nt_status checked = nt_contact_check(&contact, NULL);
    for (int model = NT_HERTZ; model <= NT_MAUGIS; model++) {
        nt_contact_law law;
        const nt_status made = nt_contact_law_init(&law, (nt_model)model, &contact);
        REQUIRE(checked == NT_OK || made != NT_OK);
        if (made != NT_OK)
            continue;
        for (int branch = NT_BRANCH_STABLE; branch <= NT_BRANCH_UNSTABLE; branch++)
            check_value(&law, indentation, (nt_branch)branch);
    }
    return 0;
}
