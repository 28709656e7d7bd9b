/* SPDX-License-Identifier: BSD-3-Clause
 * A sample that deforms: a rigid paraboloid before and on an elastic half-space or layer under any pressure of the gap,
 * gap and displacement solved together (docs/deformation.md). Private to scene/.
 *
 *     g(r) = h + r^2/(2 R) + u(r) >= 0        p(r) = p(g) where g > 0        u = K p        F = 2 pi Int p r dr
 *
 * The solver is some 270 kB; a plan has it on the stack while its sample is found to deform, and keeps a table. */
#ifndef NANOTOUCH_SCENE_DEFORM_H
#define NANOTOUCH_SCENE_DEFORM_H

#include "internal/maugis.h"
#include "nanotouch/plan.h"
#include "scene/parts.h"

/* Two flats at a gap [m] above that of a pole. */
typedef nt_pressure nt_pressure_law(const void *context, double gap);

enum { NT_DEFORM_ORDER = 8, NT_DEFORM_PANELS = 16, NT_DEFORM_NODES = 128, NT_DEFORM_WAVES = 48, NT_DEFORM_ENDS = 8 };

/* What deforms, under what. */
typedef struct nt_deform_sample {
    double radius;        /* R [m] */
    double modulus;       /* E* [Pa] */
    double thickness;     /* of a layer bonded to rigid ground; 0: a half-space [m] */
    double poisson_ratio; /* of that layer [-] */
    double share;         /* of the compliance 1/E* that is the layer's, the rest is the tip's [-] */
    nt_pressure_law *law;
    const void *context;
    double (*reach)(const void *context, double gap); /* how far in a step from a gap may go; NULL: anywhere [m] */
    double length;               /* over which the law falls where the sample begins to deform [m] */
    double pole;                 /* the gap where the law diverges, <= 0; contact is at gap 0 [m] */
    double ends[NT_DEFORM_ENDS]; /* gaps where the law has a kink, as where a brush ends [m] */
    int end_count;
    double stress, range; /* sigma0, h0 of adhesion in contact, beside the law; 0: none [Pa, m] */
} nt_deform_sample;

/* mesh.c: panels of x = r^2 - a^2, on each of which p is a polynomial, and what pressures at their nodes do. */
typedef struct nt_deform_mesh {
    int panels, count;
    double a;                                   /* radius of contact [m] */
    double edges[NT_DEFORM_PANELS + 1];         /* [m^2] */
    double x[NT_DEFORM_NODES];                  /* [m^2] */
    double area[NT_DEFORM_NODES];               /* [m^2] */
    double L[NT_DEFORM_ORDER][NT_DEFORM_ORDER]; /* Legendre coefficients of a panel, from values at its nodes [-] */
    double K[NT_DEFORM_NODES][NT_DEFORM_NODES]; /* u = K p [m/Pa] */
    double K0[NT_DEFORM_NODES];                 /* u(0) = K0 . p; in contact 2 q(a)/E* = K0 . p [m/Pa] */
    double K1[NT_DEFORM_NODES];                 /* u at the first edge, where adhesion ends [m/Pa] */
    double load[NT_DEFORM_NODES];               /* 4 Int q dt = load . p [m^2] */
    /* What the contact of a layer adds at h, value and slope in h; 0 on a half-space. */
    double bend[2][NT_DEFORM_NODES];    /* to u [m, -] */
    double edge[2];                     /* to 2 q(a)/E* [m, -] */
    double push[2];                     /* to F [N, N/m] */
    double under[2];                    /* to the pressure under the apex [Pa, Pa/m]; */
    double under_load[NT_DEFORM_NODES]; /* and by each pressure outside [-] */
} nt_deform_mesh;
/* From edges, panels and a; `waves` is room for 2 times NT_DEFORM_WAVES times NT_DEFORM_NODES numbers. */
void nt_deform_mesh_make(nt_deform_mesh *mesh, const nt_deform_sample *sample, double *waves);
/* Values at the nodes, taken to an x; beyond the mesh they fall as 1/r. */
double nt_deform_mesh_at(const nt_deform_mesh *mesh, const double *values, double x);
/* The last two Legendre coefficients of values on a panel, the larger. */
double nt_deform_mesh_tail(const nt_deform_mesh *mesh, const double *values, int panel);

/* layer.c: wave numbers [1/m], and weights times X(k t) - 1, of a bonded layer. */
typedef struct nt_deform_spectrum {
    double k[NT_DEFORM_WAVES], weight[NT_DEFORM_WAVES];
} nt_deform_spectrum;
/* Adds what a layer answers; `waves`: Int cos(k t) q dt of each node, at each k, and as much room behind them. */
void nt_deform_layer_add(nt_deform_mesh *mesh, const nt_deform_sample *sample, const nt_deform_spectrum *s,
                         double *waves);

/* solve.c: what is held while the gaps are found. */
typedef enum nt_deform_hold {
    NT_DEFORM_GAP,    /* h of the undeformed bodies */
    NT_DEFORM_CENTRE, /* the gap under the apex, through the folds of an attraction, too */
    NT_DEFORM_CONTACT /* the radius of contact */
} nt_deform_hold;

/* One equilibrium. */
typedef struct nt_deform_point {
    double h;      /* gap of the undeformed bodies [m] */
    double F;      /* on the tip, + repulsive [N] */
    double k;      /* -dF/dh [N/m] */
    double centre; /* the gap under the apex [m] */
    double slope;  /* d(centre)/dh; of contact 0 [-] */
    double a;      /* radius of contact [m] */
    double peak;   /* the largest pressure on the sample, without adhesion [Pa] */
} nt_deform_point;

typedef struct nt_deform_solver {
    const nt_deform_sample *sample;
    double tolerance;            /* of the force, of the mesh, over max(|F|, scale) [-] */
    double scale;                /* [N] */
    int graded;                  /* edges at kinks have not come to rest: panels beside them are cut */
    double rough;                /* the worst panel, in what it must resolve [-] */
    double h;                    /* [m] */
    double reach;                /* of the law outside an adhesive contact [m] */
    double end;                  /* r^2 - a^2 where its adhesion ends [m^2] */
    int left;                    /* meshes that may still be made */
    double *work;                /* nt_deform_tried */
    double end_slope;            /* of the gap there over h0, over ln of it; 0: not known [-] */
    double share;                /* of the law that acts, on the way to all of it [-] */
    double kink[NT_DEFORM_ENDS]; /* x of the ends of the law [m^2] */
    nt_deform_mesh mesh;
    double gap[NT_DEFORM_NODES]; /* [m] */
    double A[NT_DEFORM_NODES + 1][NT_DEFORM_NODES + 1];
    int pivot[NT_DEFORM_NODES + 1];
    int factored, factored_held; /* of a contact: equations less one that A has the factors of, 0: none; held is h */
} nt_deform_solver;
#define NT_DEFORM_MESH_WORK 1.0 /* of a full one [work of nt_deform_tried] */
#define NT_DEFORM_LAYER_WORK 2.0
/* Whether another mesh may be made. */
static inline int nt_deform_may_mesh(nt_deform_solver *s)
{
    const double of_full = (double)s->mesh.count / NT_DEFORM_NODES;
    if (s->work)
        *s->work -= of_full * of_full * (s->sample->thickness > 0.0 ? NT_DEFORM_LAYER_WORK : NT_DEFORM_MESH_WORK);
    return --s->left > 0 && (!s->work || *s->work > 0.0);
}
/* The law of the sample at a gap [m]. */
static inline nt_pressure nt_deform_law(const nt_deform_solver *s, double gap)
{
    return s->sample->law(s->sample->context, gap);
}

/* The gap at the end of the mesh, beyond which bodies count as rigid [m]. */
static inline double nt_deform_outer_gap(const nt_deform_solver *s)
{
    return nt_deform_mesh_at(&s->mesh, s->gap, s->mesh.edges[s->mesh.panels]);
}

/* What the pressure in contact does at x outside [m], and its slope in h. */
double nt_deform_rim(const nt_deform_solver *s, double h, double x, double *slope);
/* Factors A, n x n, in place: Gauss with row pivots; 0 where it is singular, or no work is left. Then solves A y = b in
 * place. Both. */
int nt_deform_factor(nt_deform_solver *s, int n);
void nt_deform_back(const nt_deform_solver *s, double *b, int n);
double nt_deform_dot(const double *row, const double *by, int n);
int nt_deform_eliminate(nt_deform_solver *s, double *b, int n);

/* Pressures at the nodes, and their slopes. */
typedef struct nt_deform_pressed {
    double pressure[NT_DEFORM_NODES], slope[NT_DEFORM_NODES];
} nt_deform_pressed;
/* How far a step of Newton went: over the largest gap, NaN where it cannot; at most of what is left to the pole. */
typedef struct nt_deform_step {
    double far, near;
} nt_deform_step;

/* What an equilibrium is on its mesh. */
typedef struct nt_deform_state {
    double gap[NT_DEFORM_NODES], edges[NT_DEFORM_PANELS + 1], h, a, end;
    int panels;
} nt_deform_state;
nt_deform_state nt_deform_keep(const nt_deform_solver *s);
void nt_deform_restore(nt_deform_solver *s, const nt_deform_state *state);

/* contact.c: the sample has adhesion and touches over a radius [m]. */
nt_status nt_deform_begin_contact(nt_deform_solver *s, const nt_deform_sample *sample, double a);
/* From a guess of where adhesion ends, r^2 - a^2 [m^2]. */
nt_status nt_deform_settle_contact(nt_deform_solver *s, double a, double guess);
int nt_deform_report_contact(nt_deform_solver *s, nt_deform_point *point);
double nt_deform_energy_in_contact(const nt_deform_solver *s);

/* follow.c. */
/* Edges in rising order, in the making. */
typedef struct nt_deform_edges {
    double at[2 * NT_DEFORM_PANELS + NT_DEFORM_ENDS + 2];
    int count;
} nt_deform_edges;
/* Puts gaps and mesh on other edges [m^2], at a radius of contact [m]. */
void nt_deform_move(nt_deform_solver *s, const double *edges, int panels, double a);
/* Edges that resolve more; whether there are any. */
int nt_deform_refine(nt_deform_solver *s, nt_deform_edges *list);
/* Joins panels that are far finer than they need to be; whether there were any. */
int nt_deform_coarsen(nt_deform_solver *s);

/* Apart, at a gap so large that the sample hardly deforms. */
nt_status nt_deform_begin(nt_deform_solver *solver, const nt_deform_sample *sample, double gap);
/* The next equilibrium, not far from the last one, and what it is (NULL: not asked); on failure the last one stands. */
nt_status nt_deform_go(nt_deform_solver *solver, nt_deform_hold hold, double value, nt_deform_point *point);

#define NT_DEFORM_STIFFER 0.05 /* of the tolerance: meshes of a stiffness, whose error grows beside a jump */

/* table.c: {U, F, k} over h, from `farthest` inwards until the force is `load` or the gap `nearest`. */
typedef struct nt_deform_range {
    double farthest, nearest; /* [m] */
    double centre;            /* above 0: ends where this gap is left under the apex, or in a jump before [m] */
    double load;              /* [N] */
    double tolerance;         /* of F, over max(|F|, scale) [-] */
    double scale;             /* [N] */
    int attracts;             /* ends in a jump, or at `nearest` */
    int stiffness;            /* k is held to the tolerance, too, over max(|k|, stiffness_scale); a finer mesh */
    double stiffness_scale;   /* [N/m] */
    double radius_scale;      /* above 0: so is a, over max(a, radius_scale) [m] */
    double *work;             /* nt_deform_tried */
    int touches;              /* goes on to where the bodies touch, at a larger load, too */
} nt_deform_range;
nt_status nt_deform_table_make(nt_deform_table *table, const nt_deform_sample *sample, const nt_deform_range *range);
/* Adds the contact of a sample with adhesion, from where it lets go to the load; it touches over some `radius` [m]. */
nt_status nt_deform_table_hold(nt_deform_table *table, const nt_deform_sample *sample, const nt_deform_range *range,
                               double radius);
/* Where the table holds, h <= its first; deeper than its last F goes on with the last slope. Apart from that contact;
 * in it. */
nt_law_value nt_deform_table_eval(const nt_deform_table *table, double h);
nt_law_value nt_deform_table_held(const nt_deform_table *table, double h);

#define NT_DEFORM_FARTHEST 1e-2 /* gaps that are looked at [m] */
#define NT_DEFORM_DEEPER 1.05   /* tables reach beyond the largest load by */

/* law.c: all beside contact by a table, at a gap of the plan; where contact holds or does not. */
nt_law_value nt_deform_apart(const nt_plan *plan, const nt_deform_table *table, double gap);
nt_law_value nt_deform_around(const nt_plan *plan, const nt_deform_table *table, int attached, double gap);
/* Pull-off, stiffnesses and depth of a plan as it is now, without adhesion, up to a load [N]. */
void nt_deform_facts(nt_plan *plan, double load);
/* Force and table meet at the first gap, and U begins there as that of the laws. */
void nt_deform_join(const nt_plan *plan, nt_deform_table *table);

/* What tables are made for. */
typedef struct nt_deform_wanted {
    nt_quantity quantity; /* of the demand; tables themselves are of forces or stiffnesses */
    double tolerance;     /* a rung of the ladder */
    double finest;        /* the last rung */
    double around;        /* error of laws around an adhesive contact that are not in the table */
    double radius_scale;  /* 0: not demanded [m] */
    double load;          /* where a table without adhesion ends [N] */
    int touches;          /* nt_deform_range */
    nt_deform_tried *tried;
} nt_deform_wanted;
/* deform.c: a table of the plan's own radius, with that tolerance or finer; then, with no force of its own yet, its
 * laws turned on and contact beside it, which knows the work of adhesion [J/m^2] (0: that of the scene). */
nt_status nt_plan_deform_table(nt_plan *plan, const nt_scene *scene, const nt_deform_wanted *of);
nt_status nt_plan_deform_compose(nt_plan *plan, const nt_scene *scene, double work_of_adhesion);
/* adhere.c: the contact of that. */
nt_status nt_plan_deform_contact(nt_plan *plan, const nt_scene *scene, double work_of_adhesion);

/* radii.c: a refusal, because no one kind of table spans the effective radii of a surface: one that has none, and those
 * that have [m]. */
nt_problem nt_deform_spread(double radius, double minimum, double maximum);

/* radii.c: what the tables of all effective radii of a surface come to. */
typedef struct nt_deform_worst {
    double error;             /* of what lies between them, as a share of the demand */
    double moved;             /* where the surface jumps or contact lets go [m] */
    double pull_off_force;    /* the largest of all radii, as the next two [N] */
    double minimum_spring;    /* [N/m] */
    double maximum_stiffness; /* [N/m] */
} nt_deform_worst;
/* Makes them for a plan that has the table of its own radius; no more than `most` will do of that error. On failure
 * *problem names the radius that has no table like the others. */
nt_status nt_plan_deform_over(nt_plan *plan, const nt_scene *scene, const nt_deform_wanted *of, double most,
                              nt_deform_worst *worst, nt_problem *problem);
/* relief.c: of a place {U, F, k, a} and dU/dR of all beside contact; the gap where the surface jumps or touches, or
 * where contact lets go that is in the tables [m]; what the tail takes of w [J/m^2], and its slope over R. */
nt_bank_value nt_deform_relief_at(const nt_plan *plan, const nt_place *place, int attached, double gap);
double nt_deform_relief_fold(const nt_plan *plan, double radius, int attached);
double nt_deform_relief_share(const nt_plan *plan, double radius, double *slope);

/* peak.c: the largest pressure on the sample, of an equilibrium with a gap under the apex [Pa]. */
double nt_deform_peak_of(const nt_deform_solver *s, double centre);
/* Between two nodes of a table, at a load: a power of it; NaN where that is not defined. */
double nt_deform_peak_between(const nt_deform_node ends[2], double load);
/* Of a node of a table without adhesion: the largest pressure, the mean [Pa]. */
typedef double nt_deform_pressure(const nt_deform_table *table, const nt_deform_node *node);
nt_deform_pressure nt_deform_peak_at, nt_deform_mean_at;
/* It at a load, and the load at which it is that [N]: infinite beyond the table. Between nodes it is a power of the
 * load. */
double nt_deform_table_pressure(const nt_deform_table *table, double load, nt_deform_pressure *of);
double nt_deform_table_load(const nt_deform_table *table, double pressure, nt_deform_pressure *of);

/* terms.c: the pressures of all terms, at a gap that is counted from `hold` [m]. */
typedef struct nt_deform_terms {
    const nt_plan *plan;
    double hold;
    int around; /* only those around an adhesive contact: tails are part of w */
} nt_deform_terms;
/* What deforms under them; `farthest`: the gap where it begins to [m]. */
nt_deform_sample nt_deform_sample_of(const nt_deform_terms *in, const nt_scene *scene, double farthest);

/* adhere.c: adds the contact with all that acts around it to the table of a surrounded contact. */
nt_status nt_plan_deform_hold(nt_plan *plan, const nt_scene *scene, const nt_deform_range *range);

/* terms.c: all terms beside contact at a gap of undeformed bodies. */
typedef struct nt_elastic_sum {
    double F, k;           /* net [N, N/m] */
    double here_F, here_k; /* of the sizes there */
    double all_F, all_k;   /* of nt_elastic_sizes */
    int pulls;
} nt_elastic_sum;
nt_elastic_sum nt_elastic_sum_at(const nt_plan *plan, double gap);
/* Sizes of F and k of one of them. The pressure of a law of one's own need not fall with the gap, and is felt nearer,
 * too: so they are the largest from there on. */
nt_law_value nt_elastic_sizes(const nt_plan *plan, int term, double gap);
/* The largest sizes from a gap on: a law whose parts cancel there, as a double layer of unlike surfaces, presses more
 * farther out. */
nt_law_value nt_elastic_most(const nt_plan *plan, int term, double gap);
/* The next gap inwards that is to be looked at: a tenth nearer, or less where a law of one's own may change before [m].
 */
double nt_elastic_nearer(const nt_plan *plan, double gap);
/* The largest gap inside which one of them keeps its force [m]. */
double nt_elastic_hold(const nt_plan *plan);
/* elastic.c: what rigid bodies err by there, as a share of the demand. */
double nt_elastic_error(const nt_plan *plan, const nt_elastic_sum *s);
/* By how much the pressure around a contact moves the surface there, at most; with tails or without [m]. */
double nt_elastic_under(const nt_plan *plan, int tails);
/* By which share of w the tail pulls more than on a surface that keeps still; the largest effective radius over the
 * tip's own, where the surface is curved. */
double nt_elastic_more_of_w(const nt_plan *plan);
double nt_elastic_bluntest(const nt_plan *plan);

#define NT_ELASTIC_SLOPE 3.0 /* the stiffness is off by so much more than the force, at most */
#define NT_ELASTIC_HALF 0.55 /* of F: what is lost in deep contact, at most */

#endif
