/* SPDX-License-Identifier: BSD-3-Clause
 * What a fit has to know of a model: its row. Each file of this folder ends with one; private to fit/.
 *
 * A law is an explicit function of one parameter s, from its deepest point through its load fold to its displacement
 * fold, the last that any cantilever could hold. A fit asks for the force at positions of the base, thousands of times:
 * without an inner search for the indentation that is one Newton iteration in s instead of two, one inside the other.
 */
#ifndef NANOTOUCH_FIT_MODELS_ROW_H
#define NANOTOUCH_FIT_MODELS_ROW_H

#include <math.h>
#include <stddef.h>

#include "nanotouch/fit.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A law with the values of its parameters. */
typedef struct nt_fit_branch {
    nt_contact_law law;       /* of paraboloids */
    double modulus;           /* E* of the others [Pa] */
    double size;              /* half angle of an equivalent cone [rad], radius of a punch [m] */
    double lambda;            /* Maugis' [-]; NaN: the law has none */
    double load, indentation; /* Maugis' units [N], [m] */
    double prefactor;         /* of F = prefactor delta^exponent */
    double thickness;         /* t of a layer [m] */
    double pull_off;          /* force at the load fold, positive [N] */
    double touch_c;           /* Maugis-Dugdale: c at a = 0, reduced */
    double load_fold;         /* s there: the lowest force */
    double grip_fold;         /* s <= load_fold, where the indentation turns */
    double unit;              /* a step of s of the size of the contact */
} nt_fit_branch;

typedef struct nt_fit_state {
    double F, indentation;   /* [N], [m] */
    double F1, indentation1; /* their derivatives by s: never both 0 */
    double range; /* lambda dF/dlambda at constant indentation [N] (contact_model.cpp); of a layer -t dF/dt */
} nt_fit_state;

enum { NT_FIT_BLOCK = 64 };

/* The same at so many places s at once. */
typedef struct nt_fit_block {
    int count;
    double s[NT_FIT_BLOCK], F[NT_FIT_BLOCK], indentation[NT_FIT_BLOCK], F1[NT_FIT_BLOCK], indentation1[NT_FIT_BLOCK],
        range[NT_FIT_BLOCK];
} nt_fit_block;

typedef struct nt_fit_row {
    nt_fit_description words;
    const nt_fit_quantity *parameter; /* NT_FIT_OWN of them, in the order of nt_fit_parameter; name NULL: not there */
    unsigned held;                    /* bit i: parameter i is held by default */
    /* The law of these values, in SI; NT_E_RANGE where there is none. */
    nt_status (*prepare)(const nt_fit_options *options, const double *value, nt_fit_branch *branch);
    /* At s > grip_fold. */
    nt_fit_state (*at)(const nt_fit_branch *branch, double s);
    /* The same of a block, of paraboloids; range stays 0 where the law has none. NULL: point by point. */
    void (*many)(const nt_fit_branch *branch, nt_fit_block *block);
    /* dF/dparameter at constant indentation, by the logarithm of those with minimum > 0; stiffness is dF/ddelta. */
    void (*derive)(const nt_fit_state *state, double stiffness, double own[NT_FIT_OWN]);
    /* On the stable branch; NT_E_NO_SOLUTION where the force is too low. */
    nt_status (*indentation)(const nt_fit_branch *branch, double force, double *indentation);
    /* Radius and stiffness of the contact at an indentation. */
    nt_law_value (*contact)(const nt_fit_branch *branch, double indentation);
    /* Force at an indentation > 0 where it is linear in E*; NULL where it is not. */
    double (*shape)(const nt_fit_branch *branch, double indentation);
    /* nt_fit_flag of what the law cannot describe in this result. */
    unsigned (*doubts)(const nt_fit_options *options, const nt_fit_result *result);
} nt_fit_row;

/* The row of a built-in model. */
const nt_fit_row *nt_fit_row_of(nt_fit_model model);

/* A row, field by field: NT_FIT_ROW(hertz, .words.name = "hertz", ...). The macro takes as many arguments as a row has
 * fields: one that is forgotten does not compile. */
#define NT_FIT_ROW(model, f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12, f13, f14, f15, f16, f17, f18, f19, f20)   \
    extern const nt_fit_row nt_fit_row_##model;                                                                        \
    const nt_fit_row nt_fit_row_##model = {f1,  f2,  f3,  f4,  f5,  f6,  f7,  f8,  f9,  f10,                           \
                                           f11, f12, f13, f14, f15, f16, f17, f18, f19, f20}

/* Parameters that models share. */
#define NT_FIT_MODULUS {"effective_modulus", "Pa", NAN, 1.0, 1e14}
#define NT_FIT_ADHESION {"work_of_adhesion", "J/m^2", NAN, 1e-9, 1e3}
#define NT_FIT_OF_LAYER {"thickness", "m", 1.0, 1e-9, 1.0} /* until it is given: a half-space */
#define NT_FIT_RANGE {"cohesive_range", "m", 0.2e-9, 1e-12, 1e-5}

/* Of a law that is linear in E*. */
static inline void nt_fit_derive_linear(const nt_fit_state *state, double stiffness, double own[NT_FIT_OWN])
{
    (void)stiffness;
    own[NT_FIT_EFFECTIVE_MODULUS] = state->F;
}

static inline unsigned nt_fit_no_doubt(const nt_fit_options *options, const nt_fit_result *result)
{
    (void)options;
    (void)result;
    return 0U;
}

#ifdef __cplusplus
}
#endif
#endif
