/* SPDX-License-Identifier: BSD-3-Clause
 * A round tip on a sample that yields: force and heat along any path, the dent that stays, and the groove of a scratch.
 *
 * Elastic (Hertz) up to a peak pressure of 1.6 Y. Then the mean pressure grows with ln(E* a/(Y R)) to 3 Y, where all
 * around the contact is plastic. What unloads is elastic, from a dent with a radius of its own (docs/indentation.md has
 * the equations). Ideally plastic, without rate, without adhesion. All functions: thread-safe, no state but the
 * caller's. */
#ifndef NANOTOUCH_ADVANCED_PLASTICITY_H
#define NANOTOUCH_ADVANCED_PLASTICITY_H

#include "nanotouch/advanced/field.h"
#include "nanotouch/contact.h"
#include "nanotouch/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A tip, and the sample that it dents. */
typedef struct nt_indentation {
    double radius;            /* R, of tip and sample together [m] */
    double effective_modulus; /* E* [Pa] */
    double yield_strength;    /* Y, of the sample [Pa] */
} nt_indentation;
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with the first offending field in *problem (NULL allowed). */
NT_API nt_status nt_indentation_check(const nt_indentation *indentation, nt_problem *problem);

/* The contact radius is at most this share of R: a sphere is no paraboloid beyond (its depth is 7 % more there). */
#define NT_INDENTATION_LARGEST_RADIUS 0.5

/* A contact that is loaded for the first time, at its contact radius. */
typedef struct nt_first_loading {
    double contact_radius;   /* a [m] */
    double indentation;      /* delta [m] */
    double force;            /* F [N] */
    double mean_pressure;    /* p_m = F/(pi a^2) [Pa] */
    double residual_depth;   /* delta_r, of the dent that stays if it is unloaded from here [m] */
    double effective_radius; /* R', of tip and dent together: 4 E* a^3/(3 F) [m] */
    double stored;           /* elastic energy, which unloading gives back [J] */
    double dissipated;       /* heat [J] */
    double stiffness;        /* dF/d(delta) of going on; of unloading it is 2 E* a [N/m] */
} nt_first_loading;
/* At a contact radius a [m], 0 .. R/2. NaN in, NaN out. */
NT_API NT_REALTIME nt_first_loading nt_indentation_first(const nt_indentation *indentation, double contact_radius);
/* The contact radius [m] of the first loading at an indentation [m], >= 0. NaN in, NaN out. */
NT_API NT_REALTIME double nt_indentation_radius_at_depth(const nt_indentation *indentation, double depth);
/* The same at a load [N], >= 0. */
NT_API NT_REALTIME double nt_indentation_radius_at_load(const nt_indentation *indentation, double load);
/* F_Y, the load at which yield begins: pi^3 R^2 (1.6 Y)^3/(6 E*^2) [N] (Johnson 1985, Sec. 6.2). */
NT_API double nt_indentation_yield_load(const nt_indentation *indentation);
/* The load at which the mean pressure reaches 3 Y [N]. */
NT_API double nt_indentation_plastic_load(const nt_indentation *indentation);

/* Where a contact is and what it remembers. Copyable; zero is "never touched". */
typedef struct nt_indentation_state {
    double indentation;    /* delta, of the apex below the sample before it was touched [m] */
    double force;          /* on the tip, away from the sample, >= 0 [N] */
    double contact_radius; /* a [m] */
    double dent_radius;    /* a of the dent; 0: it has not yielded [m] */
    double stored;         /* elastic energy [J] */
    double dissipated;     /* heat so far, grows only [J] */
} nt_indentation_state;
/* Moves the apex to an indentation [m], below 0 above the sample. The path is unique, so its parts give the same as the
 * whole; the work of the hand is stored + dissipated. NT_OK; NT_E_NOT_FINITE, or NT_E_RANGE (a contact or a dent with a
 * radius above R/2), with the state left alone. */
NT_API NT_REALTIME nt_status nt_indentation_advance(const nt_indentation *indentation, nt_indentation_state *state,
                                                    double depth);

/* --- What stays: a dent, or the groove of a stroke, in the caller's height field --- */

/* Where the material goes that a tip displaces, as shares of its volume. The rest of 1 is densified below the dent. */
typedef struct nt_displacement {
    double piled_up;    /* in a ridge around the dent, 0 .. 1 [-] */
    double debris;      /* leaves the surface, 0 .. 1 [-] */
    double ridge_width; /* of the ridge, over the radius of the dent [-] */
} nt_displacement;
/* 0.8 piled up, no debris, a ridge as wide as the dent's radius. */
NT_API nt_displacement nt_displacement_defaults(void);
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with the first offending field in *problem (NULL allowed); the shares are 1
 * together at most. */
NT_API nt_status nt_displacement_check(const nt_displacement *displacement, nt_problem *problem);

/* A paraboloid, swept along a straight line: z = -depth (1 - s^2/radius^2), s the distance from the line. A dent ends
 * where it begins. After an indentation: radius a and depth delta_r, by the recovery of a Hertz contact. */
typedef struct nt_imprint {
    double start[2], end[2]; /* x, y [m] */
    double radius;           /* a, half of the width [m] */
    double depth;            /* [m] */
} nt_imprint;
/* Its volume [m^3]: pi a^2 depth/2 + 4/3 a depth length. */
NT_API double nt_imprint_volume(const nt_imprint *imprint);

/* What an edit has done. Always removed = piled_up + densified + debris, as sums over the pixels. */
typedef struct nt_edit {
    long first_x, first_y, count_x, count_y;     /* the pixels that may have changed; none: counts of 0 */
    double removed, piled_up, densified, debris; /* [m^3] */
} nt_edit;
/* From so many pixels of radius on the volume in the pixels is the imprint's own within 1 %: that of a long groove
 * along a row errs by 1/(4 n^2) at n pixels (the first term of Euler and Maclaurin). */
#define NT_IMPRINT_PIXELS 6.0
/* From what a place was to what it becomes. */
typedef struct nt_imprint_change {
    const nt_imprint *before; /* taken away; NULL: a new one */
    const nt_imprint *after;
    const nt_displacement *displacement;
} nt_imprint_change;
/* Edits heights, the memory of map->heights (nx * ny doubles). The ridge is as high as the removed pixels demand, so
 * that the balance is closed on any grid. The same calls give the same bits; to undo, keep a copy of the extents. As
 * nt_imprint_extent; the heights are left alone where it refuses. */
NT_API nt_status nt_imprint_edit(double *heights, const nt_height_map *map, const nt_imprint_change *change,
                                 nt_edit *edit, nt_problem *problem);

/* --- Scratching: a round tip that ploughs, all plastic (Bowden and Tabor 1950); a layer on a substrate or not --- */

typedef struct nt_scratching {
    double radius;             /* R, of the tip [m] */
    double hardness;           /* H, of the sample or its layer [Pa] */
    double shear_strength;     /* tau, between tip and sample [Pa] */
    double layer_thickness;    /* t; 0: no layer [m] */
    double substrate_hardness; /* H_s, below the layer; read where there is one [Pa] */
} nt_scratching;
/* NT_OK, or NT_E_NOT_FINITE / NT_E_RANGE with the first offending field in *problem (NULL allowed). */
NT_API nt_status nt_scratching_check(const nt_scratching *scratching, nt_problem *problem);

/* The groove under a load, and the force that makes it. */
typedef struct nt_groove {
    double depth;       /* d = P/(pi R H); through a layer t + (P/(pi R) - H t)/H_s [m] */
    double width;       /* 2a, a^2 = 2 R d; without a layer sqrt(8 P/(pi H)) [m] */
    double ploughing;   /* hardness times the area that the tip shows to the front, 4/3 a d [N] */
    double shearing;    /* tau pi a^2/2: the rear half of the contact is free [N] */
    double layer_load;  /* that the layer carries before it is cut through, pi R H t; 0: no layer [N] */
    int is_cut_through; /* 1: the tip runs on the substrate */
} nt_groove;
/* Under a load [N]. NT_OK; NT_E_NOT_FINITE; NT_E_RANGE with a problem: below 0, or a above R/2. */
NT_API nt_status nt_scratch(const nt_scratching *scratching, double load, nt_groove *groove, nt_problem *problem);

/* Volume worn off [m^3] by a way [m] under a load [N], K F s/H with the hardness H [Pa] (Archard 1953). NaN in, NaN
 * out. */
NT_API double nt_worn_volume(double coefficient, double load, double way, double hardness);
/* Radius of the flat [m] of a round tip of the radius R [m] that has lost a volume [m^3]: (4 R V/pi)^(1/4). NaN in, NaN
 * out. */
NT_API double nt_worn_flat(double radius, double volume);

/* --- A sample that keeps what a tip does to it while it is touched: force and heat of each contact by the law of
 * plasticity.h, and a list of the dents and grooves that are left.
 *
 * One contact has one memory, chosen where it begins: the dent that is there, or none. A tip that slides ploughs: the
 * rear half of its contact is free, so that it sinks until the front half carries the load, and the groove takes
 * hardness times its section (docs/indentation.md). All functions: thread-safe, no state but the caller's. --- */

enum { NT_DENTS = 128 };

/* What a contact has left. */
typedef struct nt_dent {
    nt_imprint imprint; /* a dent, or a groove: end is not start */
    double load;        /* that makes it at rest [N] */
    int before;         /* the dent of the list that it has grown from; -1: a new one */
    int grown;          /* so often it has grown in its place, as the last of the list */
} nt_dent;

/* Copyable. Zero is a sample that nothing has touched; nt_dents_place comes first. */
typedef struct nt_dents {
    nt_indentation_state contact; /* the one that is, or was last; indentation from where nothing had yielded */
    double bottom;                /* the residual depth where this contact began [m] */
    double began;                 /* and the radius of its dent; 0: none [m] */
    double start[2], at[2];       /* where the contact began to slide, and is [m] */
    double pressed[2];            /* where its dent grew last [m] */
    double ploughed;              /* share of the rear half that is free, 0 .. 1 [-] */
    double slid;                  /* the largest load while it slid, as at rest [N] */
    double dissipated;            /* heat of all contacts, grows only [J] */
    int touches;                  /* 1: it presses ... */
    int inside;                   /* ... in this dent of the list, -1: in none */
    int full;                     /* 1: a dent had no place in the list */
    int count;
    nt_dent made[NT_DENTS];
} nt_dents;

/* A tip that touches nothing goes to (x, y) [m]; what the last contact has left is added to the list. A dent that grows
 * keeps its middle; the last of the list grows in its place, so that a lever that rings makes one dent. Returns how
 * many dents were added or have grown, 0 .. 2: the last of the list. While it touches: nothing. */
NT_API NT_REALTIME int nt_dents_place(const nt_indentation *indentation, nt_dents *dents, double x, double y);
/* The law at a gap [m] over the surface with its dents, as nt_dents_lowered had it when the contact began. U is the
 * work of getting there, with the heat of what yields. Pure. NaN in, NaN out. */
NT_API NT_REALTIME nt_law_value nt_dents_eval(const nt_indentation *indentation, const nt_dents *dents, double gap);
/* Commits a gap; one that is not a number changes nothing. */
NT_API NT_REALTIME void nt_dents_advance(const nt_indentation *indentation, nt_dents *dents, double gap);
/* The tip slips over the sample to (x, y), at the gap that was committed. What the contact gives up is heat. */
NT_API NT_REALTIME void nt_dents_slide(const nt_indentation *indentation, nt_dents *dents, double x, double y);

#ifdef __cplusplus
}
#endif
#endif
