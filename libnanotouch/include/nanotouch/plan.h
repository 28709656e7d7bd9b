/* SPDX-License-Identifier: BSD-3-Clause
 * What has to be computed for a scene, and why. Every term of the scene's potential has forms of rising cost, from
 * "left out" to exact; each form's error is bounded over the whole range that the scene says will be visited. The plan
 * is the cheapest choice whose bounds add up to no more than the demand. */
#ifndef NANOTOUCH_PLAN_H
#define NANOTOUCH_PLAN_H

#include "nanotouch/advanced/maugis.h"
#include "nanotouch/advanced/plasticity.h"
#include "nanotouch/friction.h"
#include "nanotouch/rheology.h"
#include "nanotouch/rig.h"
#include "nanotouch/scene.h"
#include "nanotouch/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_quantity {
    NT_QUANTITY_FORCE,
    NT_QUANTITY_STIFFNESS,
    NT_QUANTITY_RADIUS,
    NT_QUANTITY_FOLDS
} nt_quantity;

/* What a plan's bound is held to. Of a real slave it has to be known: nt_session_open. */
typedef enum nt_bound {
    NT_BOUND_KEPT,  /* it is no more than what is demanded, or there is no plan */
    NT_BOUND_EXACT, /* every law in full, with the bound of that: infinite where none is known */
    NT_BOUND_ANY    /* what is demanded, or else the least there is, or infinite: not known, which is warned of */
} nt_bound;

/* How true the felt force must be, and what it may cost. */
typedef struct nt_demand {
    double relative_accuracy; /* of the quantity, over max(|it|, its scale) [-], 0 .. 0.5; kept from some 1e-11 on */
    double force_floor;       /* forces below this cannot be felt [N], >= 0 */
    nt_quantity quantity;     /* "force|stiffness|radius|folds" */
    nt_bound bound;           /* "kept|exact|any" */
    double budget;            /* of one evaluation, in Hertz evaluations; 0: none [-] */
} nt_demand;
/* 1 % of the force, no floor, no budget. */
NT_API nt_demand nt_demand_defaults(void);
/* The table of the demand's fields, with units and ranges; *count (NULL allowed) its length. */
NT_API const nt_field *nt_demand_fields(int *count);
/* NT_OK, or the first field that is out of its range, in *problem (NULL allowed). */
NT_API nt_status nt_demand_check(const nt_demand *demand, nt_problem *problem);

/* One term of the plan, in or out. */
typedef struct nt_plan_term {
    const char *name;  /* "contact", "vdw", "electrostatic", ...; static storage, as the words */
    const char *title; /* "van der Waals" */
    const char *words; /* how it is computed: "Maugis-Dugdale table", "in Derjaguin's form"; "left out" */
    nt_form form;
    double force;   /* the largest force it has in the scene's range; 0: the scene has no such term [N] */
    double bound;   /* of what this form errs by, in the norm of the demand [-] */
    double cost;    /* of one evaluation [Hertz evaluations] */
    double latency; /* where each waits for the last [Hertz evaluations] */
} nt_plan_term;

/* Something that the bound does not cover. */
typedef struct nt_plan_warning {
    const char *text;    /* what; static storage */
    const char *unit;    /* of the two numbers */
    double value, limit; /* limit: NaN where it is not a matter of size [unit] */
} nt_plan_warning;
enum { NT_PLAN_WARNINGS_MAX = 30 };

/* Models that the plan did not take: largest |dF|/max(|F|, S) at equal indentation, from 0.9 of that
 * of the pull-off (Hertz and DMT: from first touch) to the largest load. */
typedef struct nt_plan_rivals {
    double hertz, dmt, jkr; /* [-] */
} nt_plan_rivals;

enum { NT_PLAN_CELLS = 256 };

/* {U, F, k} of a sample that deforms, over the gap: cubics between nodes (docs/deformation.md). */
enum { NT_DEFORM_TABLE = 160 };
typedef struct nt_deform_node {
    double v;     /* grows inwards: -h, or the root of the distance to where the bodies touch or jump [m, m^(1/2)] */
    double F;     /* [N] */
    double slope; /* dF/dv [N/m, N/m^(1/2)] */
    double k;     /* [N/m] */
    double U;     /* [J] */
    double a;     /* radius of contact [m] */
    double peak;  /* the largest pressure on the sample, under the apex [Pa] */
} nt_deform_node;
typedef struct nt_deform_table {
    int count;         /* of nodes; 0: the sample does not deform */
    int apart;         /* of them before contact; those after it are of contact */
    int jumps;         /* 1: apart ends in a jump */
    double touch;      /* h where the bodies touch or jump; -inf: never [m] */
    double first;      /* the largest h; farther out the laws add on the undeformed gap [m] */
    double last;       /* the smallest h [m] */
    double shift;      /* of the gap there, by which force and table meet [m] */
    double hold;       /* in contact the gap below which laws keep their force [m] */
    double offset;     /* of U of an adhesive contact that the surface jumps into [J] */
    double jump_error; /* of the gap of the jump, and of that where contact lets go [m] */
    int holds;         /* 1: the nodes from `apart` on are an adhesive contact and all that acts around it ... */
    double release;    /* ... that lets go at this h [m] */
    double ratio;      /* of the effective radius it is of to the tip's own [-] */
    int layered;       /* 1: of a layer bonded to rigid ground */
    double doubt;      /* of w that may be wrong, because the tail's share of it is no better [-] */
    double beside;     /* from this far from folds and first touch on that is in the bound [m] */
    double share;      /* of w, what the tail pulls in contact that the surface does not jump into [J/m^2] */
    nt_deform_node node[NT_DEFORM_TABLE];
} nt_deform_table;

/* The same over a surface: a table for each of some effective radii, evenly over their logarithm. Places between them
 * have a cubic of four tables, so that U(h, R) is one potential with continuous slopes. */
enum { NT_DEFORM_RADII = 25 };
typedef struct nt_deform_relief {
    int count;             /* of tables; 0: one radius is that of all places */
    double first;          /* the least of those radii [m] */
    double step;           /* of their logarithm [-] */
    nt_deform_table *room; /* borrowed, for NT_DEFORM_RADII tables; NULL: none */
    const nt_deform_table *table[NT_DEFORM_RADII];
} nt_deform_relief;

/* Friction: no potential of the gap but a history in the plane (nt_interaction_slide), so that the vertical force has
 * the same bits with it and without. */
typedef struct nt_plan_friction {
    nt_plan_term term;     /* form: NT_FORM_ON or NT_FORM_OFF. force: its largest limit. bound: of the friction force,
                              over max(|F|, S) of forces; NaN where not known */
    nt_friction law;       /* of the plan's own sample; with the compliance of tip and lever */
    double tip_compliance; /* (2 - nu_t)/G_t [1/Pa] */
    double sample_factor;  /* 2 (1 + nu_s) (2 - nu_s): 1/G* = tip_compliance + sample_factor/E_s [-] */
} nt_plan_friction;

/* What a session computes in place of the contact, because it depends on all that was done before. */
typedef enum nt_plan_history {
    NT_HISTORY_NONE,
    NT_HISTORY_DENTS,  /* a sample that yields (advanced/plasticity.h) */
    NT_HISTORY_RELAXES /* a sample that relaxes (rheology.h) */
} nt_plan_history;

/* Of a scene with a rheology that is not elastic: whether time matters. */
typedef struct nt_plan_relaxation {
    int relaxes;             /* the scene's sample does; 0: the rest is 0 */
    double modulus;          /* E that the plan's own contact has: over one period, or slow_modulus where time does not
                                matter [Pa] */
    double slow_modulus;     /* E at the end of range.duration [Pa] */
    double error;            /* part of the bound: of springs and arms, or of taking slow_modulus at all times [-] */
    nt_viscoelastic_bed bed; /* springs 0: time does not matter */
} nt_plan_relaxation;

/* Immutable after nt_plan_make. It refers to itself: share it by pointer; copy it with nt_plan_copy only. */
typedef struct nt_plan {
    nt_plan_term terms[NT_PLAN_TERMS];
    nt_accuracy bound;    /* force_error: of the demanded quantity; model_error: of Maugis-Dugdale beside Lennard-Jones,
                             NaN where not known */
    double fold_distance; /* from this far from a fold and from first touch on the bound holds [m] */
    double cost;          /* of one evaluation in contact, in evaluations of Hertz' contact by nt_interaction_eval_gap,
                             when they do not wait for each other [Hertz evaluations] */
    double latency;       /* and when each waits for the last, as in a loop [Hertz evaluations] */
    double full_cost;     /* of everything on, exact [Hertz evaluations] */
    double scale; /* S: errors are over max(|it|, S); of the force max(F_pull-off, floor/accuracy), a thousandth of the
                   * largest load where nothing pulls [N, N/m, m] */
    nt_demand demand;     /* as given */
    double accuracy;      /* what this candidate is held to; 0: everything exact [-] */
    int drops_tails;      /* 1: adhesion without its tail, which alone exceeds it; no bound is known */
    nt_quantity quantity; /* what its errors are of; tables of a sample are of forces, whatever is demanded */
    double probe_noise;   /* of the force, RMS: what is weaker the probe cannot tell; 0: no probe [N] */
    nt_plan_rivals rivals;
    nt_plan_warning warnings[NT_PLAN_WARNINGS_MAX];
    int warning_count;

    nt_plan_friction friction;
    nt_plan_history history;
    nt_indentation indentation; /* of dents */
    nt_plan_relaxation relaxation;

    nt_adhesion_source source;
    nt_contact contact; /* w: what the tail leaves of it (E5b). Of a surface with properties the softest modulus and
                           the least w on it, with the tip's own radius */
    double lambda;      /* Maugis' parameter of the contact [-]; +inf without adhesion or its range */
    nt_shape shape;
    nt_jkr_shape jkr;
    nt_maugis maugis;
    nt_maugis_table table;
    nt_maugis_cell cells[NT_PLAN_CELLS];
    nt_plan_laws laws;     /* beside contact */
    int on[NT_PLAN_TERMS]; /* those of them that are computed, ... */
    int on_count;          /* ... and how many */

    double capture_gap;            /* on approach adhesion takes hold here [m] */
    double release_gap;            /* on retraction under grips it lets go here [m] */
    double capture_energy;         /* that is lost when it takes hold, >= 0 [J] */
    double release_energy;         /* that is lost when it lets go, >= 0 [J] */
    double contact_pull;           /* the strongest pull in contact, everything on, positive [N] */
    double pull_off_force;         /* and wherever it is: what a load must overcome to come free, positive [N] */
    double largest_pull_off_force; /* the same over all places of the surface [N] */
    int visits_contact;         /* 0: no gap of the scene's range comes to contact. Then, at those gaps on rigid ... */
    double visited_pull;        /* ... bodies: the strongest pull [N], */
    double visited_push;        /* ... push [N], */
    double visited_stiffness;   /* ... and |k| [N/m]; 0 where there is contact */
    double minimum_spring;      /* a softer k_c jumps in; infinite where the force itself jumps [N/m] */
    double maximum_stiffness;   /* k of the contact at the largest load [N/m] */
    double largest_indentation; /* at that load [m] */
    double length;              /* the shortest distance over which the force changes its shape [m] */
    nt_contact_validity validity; /* of the contact law at the largest load */

    const nt_surface *surface;       /* dilated surface, borrowed; NULL: flat at z = 0 */
    const nt_radius_map *radii;      /* borrowed; NULL: the tip's own radius everywhere */
    const nt_radius_map *followed;   /* the same where the contact can follow them, NULL otherwise */
    const nt_maugis_bank *bank;      /* borrowed; NULL: none */
    const nt_properties *properties; /* borrowed; NULL: those of the scene everywhere */
    nt_contact least, most;          /* of each of R, E* and w over the surface; one range of adhesion */
    double tip_compliance;           /* (1 - nu_t^2)/E_t [1/Pa] */
    double sample_factor;            /* 1 - nu_s^2: 1/E* = tip_compliance + sample_factor/E_s [-] */
    double tail;                     /* what the tails pull of w at each place (E5b) [J/m^2] */
    int corner;                      /* while it is made: NT_CORNER_* of the surface at which `contact` is */
    double ratio;                    /* while it is made: the effective radius it is made for, over the tip's own [-] */
    nt_deform_table deformation;     /* of a sample that deforms under forces beside contact, at the tip's own radius */
    nt_deform_relief relief;         /* and at the radius of each place */
    double elastic_number;           /* e of the terms beside contact, the largest in the range [-] */
    double rigid_error;              /* of adding them on the undeformed gap, in the norm of the demand [-] */
    double around_error;             /* of the same around an adhesive contact, but for tails [-] */
    double curvature_error;          /* of leaving the curvature of the surface out, in the norm of the demand [-] */
} nt_plan;

/* What a plan is made from. */
typedef struct nt_plan_inputs {
    const nt_scene *scene;
    const nt_demand *demand; /* NULL: nt_demand_defaults */
    const nt_probe *probe;   /* adds probe_noise, which the plan tells, and gives way to friction; NULL: none, rigid */
    const nt_surface *surface;  /* dilated by the tip, borrowed for the life of the plan; NULL: a flat at z = 0 */
    const nt_radius_map *radii; /* of that surface, borrowed; NULL: its curvature is not asked for */
    const nt_maugis_bank *bank; /* for adhesive contact with the radius of each place, borrowed; NULL: exact only */
    const nt_properties *properties; /* of that surface, borrowed; NULL: those of the scene everywhere. They stand in
                                        place of sample.youngs_modulus and of all that gives w */
    nt_deform_table *room; /* for NT_DEFORM_RADII tables of a sample that deforms over those radii, borrowed for the
                             life of the plan; NULL: such a sample has the tip's own radius everywhere, or is refused */
    double period;         /* of the loop that will run it, which a sample that relaxes depends on; 0: 0.1 ms [s] */
} nt_plan_inputs;

/* Corners of what a surface goes through; together they are a number. */
enum { NT_CORNER_BLUNT = 1, NT_CORNER_STIFF = 2, NT_CORNER_STICKY = 4, NT_CORNERS = 8 };

/* Decides. Some 100 us, some milliseconds where a pull-off force was measured. On failure *plan is not to be used and
 * *problem (NULL allowed) names the field of scene, demand or probe, or what the demand would have to be: NT_E_RANGE
 * with "demand.relative_accuracy" and the best bound as its minimum, or "demand.budget" and the smallest cost. */
NT_API nt_status nt_plan_make(nt_plan *plan, const nt_plan_inputs *inputs, nt_problem *problem);

/* A copy that stands by itself: its pointers lead into the copy. Both share scene, bank and surface. */
NT_API void nt_plan_copy(nt_plan *copy, const nt_plan *plan);

/* One law of the scene in its fullest form, in the plan or not, at a gap [m]; of contact what holds on retraction. Zero
 * where the scene has no such law, NaN for a term that is none. */
NT_API nt_law_value nt_plan_term_eval(const nt_plan *plan, int term, double gap);
/* Two flats at a gap > 0 [m] under one law of the scene, by Derjaguin's relation F = 2 pi R W where the law is one of
 * spheres; without the hold inside minimum gaps. NaN for contact and for laws that flats do not have (a charge). */
NT_API nt_pressure nt_plan_term_pressure(const nt_plan *plan, int term, double gap);

/* Beyond this gap |F| is at most `force` >= 0 [N] on any history [m]; +inf if there is no such gap. */
NT_API double nt_plan_cutoff_gap(const nt_plan *plan, double force);
/* Explicit (symplectic) integration of a free mass m [kg] is stable below this step, 2 sqrt(m/k), up to the largest
 * load [s]. At a fold, where k is infinite and the force is not, it lets go. */
NT_API double nt_plan_stable_step(const nt_plan *plan, double mass);

#ifdef __cplusplus
}
#endif
#endif
