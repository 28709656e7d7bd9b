/* SPDX-License-Identifier: BSD-3-Clause
 * Any shape, any indentation and force, with adhesion, on any lever: a status, or a finite answer that can be undone.
 */
#include "input.h"
#include "internal/geometry.h"
#include "nanotouch/advanced/geometry.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check_finite(nt_law_value value)
{
    REQUIRE(isfinite(value.U) && isfinite(value.F) && isfinite(value.k) && isfinite(value.a) && value.a >= 0.0);
}

static void check_law(const nt_shape *shape, double modulus, double indentation)
{
    const nt_law_value value = nt_shape_eval(shape, modulus, indentation);
    if (!isfinite(indentation) || fabs(indentation) > 1.0) /* a metre: powers may overflow beyond */
        return;
    check_finite(value);
    REQUIRE(value.F >= 0.0 && (indentation > 0.0 || value.F == 0.0));
    if (indentation > 1e-30) { /* forces below are denormal */
        const double back = nt_shape_indentation(shape, modulus, value.F);
        REQUIRE(fabs(back - indentation) <= 1e-12 * indentation);
    }
    nt_contact_validity validity;
    REQUIRE(nt_contact_validity_of(shape, value.a, indentation, INFINITY, &validity) == NT_OK);
}

static void check_lever(const nt_shape *shape, double modulus, const nt_lever *lever, double displacement)
{
    nt_stage_displacement solved;
    if (fabs(displacement) > 1.0 || lever->spring_constant > 1e6 || lever->spring_constant < 1e-6)
        return;
    const nt_status status = nt_stage_displacement_solve(shape, modulus, lever, displacement, &solved);
    REQUIRE(status != NT_E_NO_CONVERGENCE);
    if (status != NT_OK || displacement < 1e-30)
        return;
    check_finite(solved.value);
    const double sum = solved.indentation + cos(lever->angle) * solved.deflection;
    REQUIRE(fabs(sum - displacement) <= 1e-12 * displacement);
}

static void check_adhesive(const nt_jkr_shape *contact, double indentation)
{
    if (nt_jkr_shape_check(contact, NULL) != NT_OK ||
        (contact->work_of_adhesion > 0.0 && contact->work_of_adhesion < 1e-12))
        return;
    for (int branch = NT_BRANCH_STABLE; branch <= NT_BRANCH_UNSTABLE; branch++) {
        nt_law_value value;
        if (nt_jkr_shape_eval(contact, indentation, (nt_branch)branch, &value) != NT_OK || fabs(indentation) > 1.0)
            continue;
        check_finite(value);
        REQUIRE(value.F >= -nt_jkr_shape_pull_off_force(contact) * (1.0 + 1e-9) - 1e-300);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size};
    uint8_t kind[2];
    fuzz_take(&in, kind, sizeof kind);
    nt_shape shape = {.kind = (nt_shape_kind)(kind[0] % 7), .sides = kind[1] % 6};
    shape.radius = fuzz_double(&in, 1e-10, 1.0);
    shape.half_angle = fuzz_double(&in, 0.01, 1.56);
    shape.transition = fuzz_double(&in, 0.0, 1e-7);
    const double modulus = fuzz_double(&in, 1e2, 1e13), indentation = fuzz_double(&in, 1e-15, 1.0);
    const nt_lever lever = {fuzz_double(&in, 1e-3, 1e3), fuzz_double(&in, 0.0, 1.5)};
    const nt_jkr_shape adhesive = {shape, modulus, fuzz_double(&in, 1e-9, 10.0)};
    if (nt_shape_check(&shape, NULL) != NT_OK || !(modulus >= 1.0 && modulus <= 1e15))
        return 0;
    if (shape.kind == NT_SHAPE_BLUNTED && shape.transition > 0.0 && shape.transition < 1e-6 * shape.radius)
        return 0; /* a cap that is not there */
    check_law(&shape, modulus, indentation);
    check_lever(&shape, modulus, &lever, indentation);
    check_adhesive(&adhesive, indentation);
    check_adhesive(&adhesive, -indentation);
    return 0;
}
