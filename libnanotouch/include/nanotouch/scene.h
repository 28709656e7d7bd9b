/* SPDX-License-Identifier: BSD-3-Clause
 * What there is between tip and sample, and over which ranges it will be visited. A description only: what is computed
 * for it is decided by a plan (plan.h), the force at a pose is given by an interaction (interaction.h). */
#ifndef NANOTOUCH_SCENE_H
#define NANOTOUCH_SCENE_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/advanced/geometry.h"
#include "nanotouch/contact.h"
#include "nanotouch/forces.h"
#include "nanotouch/rheology.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- The laws of a scene, each once. One line of NT_TERMS_BESIDE and one file in scene/terms/ make a law: what plans,
 * warnings, bindings and documentation know of it, they read from its row. --- */

/* Van der Waals and electrostatic forces of the apex sphere, and of the sphere with the cone above it. */
typedef struct nt_vdw_term {
    nt_vdw sphere;
    nt_vdw_tip tip;
    nt_tip_angle angle;
} nt_vdw_term;

typedef struct nt_electrostatic_term {
    nt_electrostatic sphere;
    nt_electrostatic_tip tip;
    nt_tip_angle angle;
} nt_electrostatic_term;

/* Matter that interacts by exp(-r/length)/r, in sphere and flat. */
typedef struct nt_yukawa_term {
    double energy;      /* W at gap 0 of flats that by Derjaguin's relation make the force of the sphere [J/m^2] */
    double length;      /* decay length [m] */
    double force;       /* of the sphere at gap 0 [N] */
    double minimum_gap; /* [m] */
} nt_yukawa_term;

/* --- A law of one's own --- */

enum { NT_CUSTOM_TERMS = 4, NT_CUSTOM_NAME = 32, NT_CUSTOM_CELLS = 128 };

/* {U, F, k, a = 0} at a gap [m]: U falls to 0 at infinite gap, F = -dU/dh, k = -dF/dh. */
typedef nt_law_value nt_custom_law(const void *context, double gap);
/* What |F| never exceeds at this gap and all larger ones [N]. */
typedef double nt_custom_bound(const void *context, double gap);

/* A scene's description of it. Both functions are called while a plan is made, and never by what runs: the plan keeps a
 * table. What they state is compared with samples, and refused where it is wrong. */
typedef struct nt_custom_term {
    char name[NT_CUSTOM_NAME]; /* ends with 0; "": no such law */
    nt_custom_law *law;
    nt_custom_bound *bound;
    const void *context; /* borrowed while plans are made */
} nt_custom_term;

/* The table of a plan: U between the gaps h[i] and h[i + 1] is a polynomial of the fifth degree, so that U, F and k are
 * those of the law at both. Below the first gap F stays; beyond the last there is no force. */
typedef struct nt_custom_table {
    char name[NT_CUSTOM_NAME];
    int count;                                     /* of cells; 0: no such law */
    double radius;                                 /* R of the tip [m] */
    double gap[NT_CUSTOM_CELLS + 1];               /* h where cells begin [m] */
    double U[NT_CUSTOM_CELLS][6];                  /* coefficients over (h - h[i])/(h[i + 1] - h[i]) [J] */
    double largest_force[NT_CUSTOM_CELLS + 1];     /* from h[i] on, as stated [N] */
    double largest_stiffness[NT_CUSTOM_CELLS + 1]; /* the same, of samples [N/m] */
    double force_error, stiffness_error;           /* largest of the table [N, N/m] */
} nt_custom_table;

/* Every law beside contact: its number NT_PLAN_x, its name, and the type of its parameters in a plan. */
#define NT_TERMS_BESIDE(ROW)                                                                                           \
    ROW(VDW, vdw, nt_vdw_term)                                                                                         \
    ROW(ELECTROSTATIC, electrostatic, nt_electrostatic_term)                                                           \
    ROW(CHARGE, charge, nt_point_charge)                                                                               \
    ROW(DOUBLE_LAYER, double_layer, nt_double_layer)                                                                   \
    ROW(HYDRATION, hydration, nt_hydration)                                                                            \
    ROW(STERIC, steric, nt_steric)                                                                                     \
    ROW(YUKAWA, yukawa, nt_yukawa_term)

/* And the places for laws of one's own, nt_scene.custom. */
#define NT_TERMS_CUSTOM(ROW)                                                                                           \
    ROW(CUSTOM_1, custom_1, nt_custom_table)                                                                           \
    ROW(CUSTOM_2, custom_2, nt_custom_table)                                                                           \
    ROW(CUSTOM_3, custom_3, nt_custom_table)                                                                           \
    ROW(CUSTOM_4, custom_4, nt_custom_table)

/* Fields of the section `medium` of a scene that belong to one law alone: name, unit, smallest, largest and usual
 * value, meaning. Usually there is no such force. */
#define NT_TERM_FIELDS(FIELD)                                                                                          \
    FIELD(yukawa_energy, "J/m^2", -1.0, 1.0, 0.0, "energy W of flats at gap 0 by a Yukawa force; below 0: attraction") \
    FIELD(yukawa_length, "m", 0.0, 1e-6, 0.0, "decay length of the Yukawa force; 0: none")

#define NT_TERM_NUMBER(ID, name, type) NT_PLAN_##ID,
enum { NT_PLAN_CONTACT, NT_TERMS_BESIDE(NT_TERM_NUMBER) NT_TERMS_CUSTOM(NT_TERM_NUMBER) NT_PLAN_TERMS };
#undef NT_TERM_NUMBER

#define NT_TERM_MEMBER(ID, name, type) type name;
typedef struct nt_plan_laws {
    NT_TERMS_BESIDE(NT_TERM_MEMBER)
    NT_TERMS_CUSTOM(NT_TERM_MEMBER)
} nt_plan_laws;
#undef NT_TERM_MEMBER

/* How a term is computed: its number NT_FORM_x, its name, and what it is. */
#define NT_FORMS(FORM)                                                                                                 \
    FORM(OFF, "off", "left out")                                                                                       \
    FORM(ON, "on", "the law as it is")                                                                                 \
    FORM(DERJAGUIN, "derjaguin", "van der Waals: the paper's form for gaps << R")                                      \
    FORM(SPHERE, "sphere", "of the apex sphere")                                                                       \
    FORM(TIP, "tip", "of sphere and cone")                                                                             \
    FORM(PARABOLOID, "paraboloid", "contact of a sphere or cap without adhesion, as Hertz' paraboloid")                \
    FORM(SERIES, "series", "contact of a sphere without adhesion, in powers of delta/R")                               \
    FORM(SHAPE, "shape", "contact without adhesion; of a paraboloid, Hertz")                                           \
    FORM(JKR, "jkr", "contact of cone and punch, adhesion of no range")                                                \
    FORM(TABLE, "table", "contact by Maugis-Dugdale, the coarse tier (advanced/maugis.h); a law of one's own")         \
    FORM(POLISHED, "polished", "contact by Maugis-Dugdale, the table made exact")                                      \
    FORM(EXACT, "exact", "contact by Maugis-Dugdale, solved")                                                          \
    FORM(LOCAL, "local", "contact with the radius of each place: Hertz, or Maugis-Dugdale out of a bank over lambda")  \
    FORM(LOCAL_EXACT, "local exact", "the same by the exact solver")                                                   \
    FORM(DEFORMED, "deformed", "contact and all beside it, gap and displacement solved together")

#define NT_FORM_NUMBER(ID, name, what) NT_FORM_##ID,
typedef enum nt_form { NT_FORMS(NT_FORM_NUMBER) } nt_form;
#undef NT_FORM_NUMBER
#define NT_FORM_ONE(ID, name, what) +1
enum { NT_FORM_COUNT = 0 NT_FORMS(NT_FORM_ONE) };
#undef NT_FORM_ONE
/* "off", "on", "derjaguin", ... */
NT_API const char *nt_form_name(nt_form form);

/* One way to compute a law. */
typedef struct nt_term_form {
    nt_form form;
    double cost;       /* of one evaluation in contact, measured (tests/bench/bench_plan.c) [Hertz evaluations] */
    double latency;    /* the same where each evaluation waits for the last [Hertz evaluations] */
    const char *words; /* "in Derjaguin's form" */
} nt_term_form;

/* What is said of a law. */
typedef struct nt_term_words {
    const char *name;          /* in plans and in Python: "double_layer" */
    const char *title;         /* in sentences: "double layer" */
    const char *doc;           /* what it is, and by whom */
    const char *tail;          /* the field of the scene that scales it, if what it pulls in contact is a part of w
                                  (erratum E5b); NULL: it is none */
    const nt_term_form *forms; /* of rising cost; the last that a scene has is its fullest */
    int form_count;
    int has_pressure; /* 1: nt_plan_term_pressure has it */
} nt_term_words;
/* Those of a term, 0 .. NT_PLAN_TERMS - 1; static storage. NULL for other numbers. */
NT_API const nt_term_words *nt_term_words_of(int term);

/* Two flats at a gap under one law. */
typedef struct nt_pressure {
    double energy;   /* W, 0 at infinite gap [J/m^2] */
    double pressure; /* p = -dW/dh, + repulsive [Pa] */
    double slope;    /* dp/dh [Pa/m] */
} nt_pressure;

typedef struct nt_tip {
    nt_shape_kind shape;      /* "paraboloid|sphere|cone|punch|blunted|truncated" */
    double sides;             /* of CONE, BLUNTED, TRUNCATED: 0 round, 3 or 4 a pyramid [-] */
    double radius;            /* R of the apex, or of the flat end [m] */
    double half_angle;        /* psi of the cone above it [rad] */
    double height;            /* L of that cone, for long-range forces; 0: a sphere alone [m] */
    double youngs_modulus;    /* E_t [Pa] */
    double poisson_ratio;     /* nu_t [-] */
    double yield_strength;    /* Y_t [Pa]; 0: not known */
    int conducting;           /* "no|yes" */
    double work_function;     /* phi_t/e [V]; 0: not known */
    double surface_potential; /* psi_t in the liquid, where no pH is given [V] */
    double isoelectric_point; /* pH without charge, where a pH is given [-] */
} nt_tip;

typedef struct nt_specimen {
    double youngs_modulus;    /* E_s [Pa] */
    double poisson_ratio;     /* nu_s [-] */
    double yield_strength;    /* Y_s [Pa]; 0: not known */
    int dents;                /* "no|yes": it yields while a session touches it, and keeps dents */
    double thickness;         /* t of the layer that is pressed; 0: a half-space [m] */
    double roughness;         /* b, peak to peak, below what the surface map shows [m] */
    int conducting;           /* "no|yes" */
    int grounded;             /* "no|yes": connected to the tip's circuit */
    double work_function;     /* phi_s/e [V]; 0: not known */
    double charge;            /* q, trapped on the surface under the tip [C] */
    double surface_potential; /* psi_s in the liquid, where no pH is given [V] */
    double isoelectric_point; /* [-] */
} nt_specimen;

typedef enum nt_medium_kind { NT_MEDIUM_AIR, NT_MEDIUM_VACUUM, NT_MEDIUM_LIQUID } nt_medium_kind;

#define NT_TERM_FIELD_MEMBER(name, unit, least, most, usual, doc) double name;
typedef struct nt_medium {
    nt_medium_kind kind;          /* "air|vacuum|liquid" */
    double temperature;           /* T [K] */
    double relative_humidity;     /* of air [-]; 0: no meniscus */
    double surface_tension;       /* gamma_L of the condensed liquid [N/m]; 0: no meniscus */
    double molar_volume;          /* V_m of it [m^3/mol] */
    double meniscus_radius;       /* r1 [m]; 0: from the Kelvin equation */
    double film_thickness;        /* e of the adsorbed film on each surface [m] */
    double relative_permittivity; /* of the liquid [-] */
    double ionic_strength;        /* I of the liquid [mol/m^3]; 0: no double layer */
    double ph;                    /* of the liquid; 0: surface potentials as given [-] */
    double potential_per_ph;      /* psi = this (isoelectric point - pH) [V] */
    double hydration_energy;      /* W of plates at gap 0; < 0: hydrophobic attraction [J/m^2] */
    double hydration_length;      /* decay length of it [m] */
    double brush_thickness;       /* T, of the free polymer brushes of both bodies together; 0: none [m] */
    double brush_spacing;         /* s, distance of grafted chains [m] */
    /* those of one law alone */
    NT_TERM_FIELDS(NT_TERM_FIELD_MEMBER)
} nt_medium;
#undef NT_TERM_FIELD_MEMBER

typedef enum nt_adhesion_given {
    NT_ADHESION_GIVEN_WORK,     /* w as given */
    NT_ADHESION_GIVEN_ENERGIES, /* w = 2 sqrt(gamma_t gamma_s) (nt_work_of_adhesion) */
    NT_ADHESION_GIVEN_PULL_OFF  /* the w with which the whole pulls off as was measured; a meniscus, too */
} nt_adhesion_given;

typedef struct nt_adhesion {
    nt_adhesion_given given;      /* "work_of_adhesion|surface_energies|pull_off_force" */
    double work_of_adhesion;      /* w of the dry solids [J/m^2] */
    double tip_surface_energy;    /* gamma_t [J/m^2] */
    double sample_surface_energy; /* gamma_s [J/m^2] */
    double pull_off_force;        /* measured under load control, a positive magnitude [N] */
    double equilibrium_distance;  /* z0 (the paper's a0): atoms in contact [m] */
    double hamaker_constant;      /* H through the medium [J] */
    double contact_potential;     /* U, bias included; that of the work functions adds to it [V] */
} nt_adhesion;

/* Of the contact when the tip slides (friction.h); what is stiff sideways follows from the materials. */
typedef struct nt_scene_friction {
    double shear_strength;     /* tau0, friction per contact area [Pa]; 0 with the next one: no friction */
    double coefficient;        /* alpha, friction per load inside the contact [-] */
    double lateral_compliance; /* of the tip, at its apex; 0: rigid [m/N] */
} nt_scene_friction;

/* What will be visited; a plan's bound holds inside. */
typedef struct nt_range {
    double minimum_gap;  /* h; below 0: contact, as deep as the load allows [m] */
    double maximum_load; /* the largest load [N] */
    double speed;        /* the fastest approach [m/s] */
    double viscosity;    /* of the medium, for the drag that a plan leaves out [Pa s] */
    double warming;      /* the temperature may move by +- this [K] */
    double duration;     /* the longest touch, over which the memory of a sample that relaxes counts [s] */
} nt_range;

typedef struct nt_scene {
    nt_tip tip;
    nt_specimen sample;
    nt_medium medium;
    nt_adhesion adhesion;
    nt_scene_friction friction;
    nt_range range;
    nt_rheology rheology; /* of the sample; a kind that relaxes stands in place of sample.youngs_modulus */
    nt_custom_term custom[NT_CUSTOM_TERMS]; /* laws of one's own, checked when a plan is made */
} nt_scene;

/* The paper's scene: silicon tip (R = 20 nm) on silicon (E = 135 GPa, nu = 0.35) in air of 40 % humidity. */
NT_API nt_scene nt_scene_defaults(void);
/* Every field once: dotted name, unit, range, offset. One table for checks, bindings, TOML and docs. */
NT_API const nt_field *nt_scene_fields(int *count);
/* NT_OK, or the first offending field in *problem (NULL allowed). What belongs together is checked together: the shape
 * of the tip, and that every quantity that another one needs is given. */
NT_API nt_status nt_scene_check(const nt_scene *scene, nt_problem *problem);

/* Where the adhesion in contact comes from. One source at a time: the van der Waals and capillary forces at contact are
 * the same adhesion that w already puts into the contact law (erratum E5b). */
typedef enum nt_adhesion_source {
    NT_ADHESION_NONE,    /* w = 0 */
    NT_ADHESION_SOLID,   /* atoms against atoms: w, over the range of the atomic potential */
    NT_ADHESION_MENISCUS /* water bridge: w = 2 gamma_L over h0 = 2 r1, the Laplace pressure (erratum E12) */
} nt_adhesion_source;

#ifdef __cplusplus
}
#endif
#endif
