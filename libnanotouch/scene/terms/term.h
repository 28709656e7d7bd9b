/* SPDX-License-Identifier: BSD-3-Clause
 * A law as a row: the table of operations that the steps of a plan call, so that none of them names a law. Private to
 * scene/. An operation gets the parameters that `prepare` made, `law`; of contact, which is spread over it, the plan.
 */
#ifndef NANOTOUCH_SCENE_TERM_H
#define NANOTOUCH_SCENE_TERM_H

#include "scene/parts.h"

/* What a step of a history comes to [J]. */
typedef struct nt_term_step {
    double stored;     /* energy that the law holds after it beside the U of eval */
    double dissipated; /* by the step, >= 0 */
} nt_term_step;

/* What the scene gives and nothing takes up, because of what else it says. */
typedef struct nt_term_fact {
    int used;
    const char *text, *unit;
    double value; /* 0: not given */
} nt_term_fact;
enum { NT_TERM_FACTS_MAX = 4 };

typedef struct nt_term_row {
    nt_term_words words;

    /* --- What every law has --- */

    /* Its parameters in this scene; adhesion takes hold at `capture_gap` [m]. */
    void (*prepare)(void *law, const nt_scene *scene, double capture_gap);
    /* The fullest form that the scene has; NT_FORM_OFF: the law does not apply. */
    nt_form (*full_form)(const void *law);
    /* {U, F, k, a} in one of its forms, not NT_FORM_OFF, at a gap [m]; real-time safe. */
    nt_law_value (*eval)(const void *law, nt_form form, double gap);

    /* --- What a law beside contact has --- */

    /* The gap below which its force stays [m]. */
    double (*hold)(const void *law);
    /* Whose |F| and |k| no larger gap exceeds. NULL: the law itself. */
    nt_law_value (*limit)(const void *law, double gap);
    /* Two flats (scene.h), where words.has_pressure. */
    nt_pressure (*pressure)(const void *law, double gap);

    /* What it is in the sentence of a refusal, as what presses or pulls; of a law with a pressure. */
    const char *noun;

    /* --- Each of these may be NULL --- */

    /* What takes long, may fail and does not depend on the adhesion, once for a plan. */
    nt_status (*tabulate)(void *law, const nt_scene *scene, nt_problem *problem);
    /* What its fullest form errs by itself [N or N/m]. */
    double (*error)(const void *law, nt_quantity quantity);
    /* Gaps between which it is smooth, that sweeps over gaps would pass over [m]: their number, 0 if there are none. */
    int (*edges)(const void *law, const double **gaps);
    /* Its name and title, where the scene gives them. */
    const char *(*name_of)(const void *law);

    /* Offers its forms with their errors, where not by the rule for laws beside contact; `beside`: the largest that
     * these come to. */
    void (*offer)(nt_plan *plan, const nt_scene *scene, nt_plan_options *options, double beside);
    /* The words and cost of a form, where they depend on more than the form. */
    const nt_term_form *(*form_of)(const void *law, nt_form form);
    /* Warns where it is outside its validity. */
    void (*warn)(nt_plan *plan, const nt_scene *scene);
    /* Facts that are for this law alone: writes at most NT_TERM_FACTS_MAX of them, returns how many. */
    int (*facts)(const nt_scene *scene, nt_term_fact *facts);
    /* The history: its size [byte], and a step of `dt` [s] that ends at a gap over a place (NULL: a flat). */
    size_t state_size;
    nt_term_step (*advance)(const void *law, void *state, const nt_place *place, double gap, double dt);
} nt_term_row;

/* The row nt_term_NAME of a law beside contact. What every such law has goes by its place, so that one that is
 * forgotten does not compile; NULL says that there is none. After it what may be missing, by name. */
#define NT_TERM_BESIDE(NAME, PREPARE, FULL_FORM, EVAL, HOLD, PRESSURE, ...)                                            \
    const nt_term_row nt_term_##NAME = {.prepare = (PREPARE),                                                          \
                                        .full_form = (FULL_FORM),                                                      \
                                        .eval = (EVAL),                                                                \
                                        .hold = (HOLD),                                                                \
                                        .pressure = (PRESSURE),                                                        \
                                        __VA_ARGS__}

#define NT_TERM_ROW(ID, name, type) extern const nt_term_row nt_term_##name;
NT_TERM_ROW(CONTACT, contact, )
NT_TERMS_BESIDE(NT_TERM_ROW)
NT_TERMS_CUSTOM(NT_TERM_ROW)
#undef NT_TERM_ROW

/* Row and parameters of each term, by its number. */
extern const nt_term_row *const nt_term_rows[NT_PLAN_TERMS];
extern const unsigned nt_term_offsets[NT_PLAN_TERMS]; /* of the parameters in a plan [byte] */

static inline const void *nt_term_law(const nt_plan *plan, int term)
{
    return (const char *)plan + nt_term_offsets[term];
}

const char *nt_term_name_of(const nt_plan *plan, int term);
/* Words and cost of a form. */
const nt_term_form *nt_term_form_of(const nt_plan *plan, int term, nt_form form);

/* custom_table.c: the table of a law of one's own from the interatomic distance on; it is resolved where the largest
 * load reaches. NT_E_NOT_FINITE, NT_E_RANGE: what it states is wrong, with problem->field left to the caller. */
nt_status nt_custom_tabulate(nt_custom_table *table, const nt_custom_term *custom, const nt_scene *scene,
                             nt_problem *problem);
/* The cell of a gap that is not below the first one; -1 beyond the last. */
int nt_custom_cell(const nt_custom_table *table, double gap);

/* capillary.c: a meniscus is no law beside contact but the source of its adhesion. */
void nt_capillary_warn(nt_plan *plan, const nt_scene *scene);

#endif
