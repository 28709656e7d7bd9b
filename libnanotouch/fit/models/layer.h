/* SPDX-License-Identifier: BSD-3-Clause
 * An incompressible layer of thickness t, bonded to rigid ground: the law of the half-space times C(q), its contact
 * radius times A(q), q = (g delta)^m/t with g = R or tan(psi); private to fit/.
 *
 * contact/bonded_layer.h has both polynomials and where they end. Beyond a = 2 t C goes on as a power of q, for the
 * search alone. */
#ifndef NANOTOUCH_FIT_MODELS_LAYER_H
#define NANOTOUCH_FIT_MODELS_LAYER_H

#include "contact/bonded_layer.h"
#include "fit/models/row.h"

#define NT_FIT_THINNEST 2.0 /* contact radius over t up to which the polynomials hold */
#define NT_FIT_BONDED                                                                                                  \
    "no adhesion, incompressible layer bonded to rigid ground, contact radius up to twice its thickness"

typedef struct nt_fit_layer {
    double c[NT_LAYER_C]; /* C = 1 + c1 q + c2 q^2 .. */
    double a[NT_LAYER_A];
    double last; /* q at a = 2 t */
    double m;    /* 1/2: q = sqrt(R delta)/t; 1: q = delta tan(psi)/t */
} nt_fit_layer;

/* 1 + Sum c_i q^i, and its logarithmic slope. */
static inline double nt_fit_polynomial(const double *c, int count, double q, double *slope)
{
    double sum = 0.0, steep = 0.0;
    for (int i = count - 1; i >= 0; i--) {
        sum = (sum + c[i]) * q;
        steep = steep * q + (i + 1) * c[i];
    }
    *slope = steep * q / (1.0 + sum);
    return 1.0 + sum;
}

/* branch: prefactor and exponent of the half-space's law, size R or tan(psi). */
static inline nt_fit_state nt_fit_layer_at(const nt_fit_layer *layer, const nt_fit_branch *branch, double exponent,
                                           double s)
{
    const double q = pow(s * branch->size, layer->m) / branch->thickness;
    double slope;
    const double inside = nt_fit_polynomial(layer->c, NT_LAYER_C, fmin(q, layer->last), &slope);
    const double C = q > layer->last ? inside * pow(q / layer->last, slope) : inside;
    const double per_depth = branch->prefactor * pow(s, exponent - 1.0) * C; /* F/delta */
    return (nt_fit_state){.F = per_depth * s,
                          .indentation = s,
                          .F1 = per_depth * (exponent + layer->m * slope),
                          .indentation1 = 1.0,
                          .range = per_depth * s * slope};
}

/* a over that of the half-space. */
static inline double nt_fit_layer_wider(const nt_fit_layer *layer, const nt_fit_branch *branch, double indentation)
{
    double slope;
    const double q = pow(indentation * branch->size, layer->m) / branch->thickness;
    return nt_fit_polynomial(layer->a, NT_LAYER_A, fmin(q, layer->last), &slope);
}

/* t in the fourth place; .range is -dF/d ln t. */
static inline void nt_fit_layer_derive(const nt_fit_state *state, double stiffness, double own[NT_FIT_OWN])
{
    (void)stiffness;
    own[NT_FIT_EFFECTIVE_MODULUS] = state->F;
    own[NT_FIT_FOURTH] = -state->range;
}

static inline nt_status nt_fit_layer_check(const double *value)
{
    const double E = value[NT_FIT_EFFECTIVE_MODULUS], t = value[NT_FIT_FOURTH];
    if (!isfinite(E) || !isfinite(t))
        return NT_E_NOT_FINITE;
    return E > 0.0 && t > 0.0 ? NT_OK : NT_E_RANGE;
}

/* Newton's steps in ln F over ln delta, which is nearly straight. */
static inline nt_status nt_fit_layer_indentation(nt_fit_state (*at)(const nt_fit_branch *, double),
                                                 const nt_fit_branch *branch, double force, double *indentation)
{
    double delta = branch->unit;
    for (int i = 0; i < 100 && force > 0.0; i++) {
        const nt_fit_state state = at(branch, delta);
        const double factor = pow(force / state.F, state.F / (state.F1 * delta));
        delta *= factor;
        if (fabs(factor - 1.0) < 1e-14)
            break;
    }
    *indentation = force > 0.0 ? delta : 0.0;
    return force >= 0.0 ? NT_OK : NT_E_NO_SOLUTION;
}

static inline unsigned nt_fit_layer_doubts(const nt_fit_options *options, const nt_fit_result *result)
{
    (void)options;
    return result->contact_radius > NT_FIT_THINNEST * result->value[NT_FIT_FOURTH] ? (unsigned)NT_FIT_WIDE : 0U;
}

#endif
