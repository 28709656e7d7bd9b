/* SPDX-License-Identifier: BSD-3-Clause
 * The models of contact that nt_fit_run knows. A new one is a line here and a file of its name, with all that is known
 * of it, in libnanotouch/fit/models/. */
#ifndef NANOTOUCH_FIT_MODELS_H
#define NANOTOUCH_FIT_MODELS_H

#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_FIT_MODEL_LIST(X)                                                                                           \
    X(HERTZ, hertz)                                                                                                    \
    X(DMT, dmt)                                                                                                        \
    X(JKR, jkr)                                                                                                        \
    X(MAUGIS, maugis)                                                                                                  \
    X(CONE, cone)                                                                                                      \
    X(PYRAMID, pyramid)                                                                                                \
    X(PUNCH, punch)                                                                                                    \
    X(SPHERE, sphere)                                                                                                  \
    X(PYRAMID3, pyramid3)                                                                                              \
    X(LAYER, layer)                                                                                                    \
    X(LAYER_CONE, layer_cone)

typedef enum nt_fit_model {
#define NT_FIT_ENTRY(constant, name) NT_FIT_##constant,
    NT_FIT_MODEL_LIST(NT_FIT_ENTRY)
#undef NT_FIT_ENTRY
        NT_FIT_CUSTOM /* nt_fit_options.law */
} nt_fit_model;

/* What a model is, in words and numbers. */
typedef struct nt_fit_description {
    const char *name;    /* "hertz"; "custom" for a law of the user's own, with all other words "" */
    const char *title;   /* for sentences and pictures */
    const char *law;     /* force over indentation delta */
    const char *valid;   /* where it holds */
    const char *scaling; /* what an error of the tip's size or angle does to the result */
    const char *tip;     /* its shape, as a scene calls it: "paraboloid", "sphere", "cone", "punch" */
    int sides;           /* of a sharp tip, which has an angle and no radius: 0 of a cone; -1: not sharp */
    double exponent;     /* n of F ~ E* delta^n without adhesion [-]; 0: not known */
    double pull_off;     /* pull-off over pi w R with which a fit begins [-]; 0: no adhesion */
    double lambda;       /* Maugis' parameter that stands for its range of adhesion [-]; 0: it has one, or none */
} nt_fit_description;
/* Of a model; name NULL for none. */
NT_API nt_fit_description nt_fit_describe(nt_fit_model model);

#ifdef __cplusplus
}
#endif
#endif
