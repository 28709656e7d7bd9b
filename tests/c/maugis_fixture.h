/* SPDX-License-Identifier: BSD-3-Clause
 * What the tests of Maugis-Dugdale share: contacts in reduced units, checked evaluation. Include after cmocka.h. */
#ifndef TESTS_MAUGIS_FIXTURE_H
#define TESTS_MAUGIS_FIXTURE_H

#include "assertions.h"
#include "internal/contact.h"
#include "nanotouch/contact.h"
#include "nanotouch/material.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define UNIT_ROUNDING (0.5 * DBL_EPSILON)

/* A contact whose Maugis units are exactly 1 (K = R = pi w = 1): reduced numbers go in and come out unrounded. */
static inline nt_maugis reduced(double lambda)
{
    const nt_contact contact = {1.0, 0.75, 1.0 / NT_PI, 0.5 * lambda};
    nt_maugis maugis;
    assert_int_equal(nt_maugis_init(&maugis, &contact), NT_OK);
    assert_true(maugis.load_scale == 1.0 && maugis.radius_scale == 1.0 && maugis.indentation_scale == 1.0);
    assert_true(maugis.lambda == lambda);
    return maugis;
}

static inline nt_law_value eval(const nt_maugis *maugis, double indentation, nt_branch branch)
{
    nt_law_value value;
    nt_solve_info info;
    assert_int_equal(nt_maugis_eval(maugis, indentation, branch, &value, &info), NT_OK);
    assert_in_range(info.iterations, 0, 20);
    return value;
}

static inline nt_branch branch_of(int unstable)
{
    return unstable ? NT_BRANCH_UNSTABLE : NT_BRANCH_STABLE;
}

#endif
