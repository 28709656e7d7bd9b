/* SPDX-License-Identifier: BSD-3-Clause
 * What there is between tip and sample, and over which ranges it will be visited. A description only: what is computed
 * for it is decided by a plan (plan.h), the force at a pose is given by an interaction (interaction.h). */
#ifndef NANOTOUCH_SCENE_H
#define NANOTOUCH_SCENE_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/advanced/geometry.h"
#include "nanotouch/contact.h"
#include "nanotouch/rheology.h"
#include "nanotouch/terms.h"

#ifdef __cplusplus
extern "C" {
#endif

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
    /* those of one law alone: terms.h */
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
    nt_custom_term custom[NT_CUSTOM_TERMS]; /* laws of one's own (terms.h), checked when a plan is made */
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
