/* SPDX-License-Identifier: BSD-3-Clause
 * What is drawn of a contact, so that every front end draws the same: the force curve with its folds, and the section
 * through tip and sample as they are deformed. Numbers only; nothing here draws. All functions: thread-safe, no state.
 */
#ifndef NANOTOUCH_VIEW_H
#define NANOTOUCH_VIEW_H

#include "nanotouch/interaction.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- Force against gap --- */

/* The parts of the curve that a plan's law draws over the gap. */
typedef enum nt_view_part {
    NT_VIEW_APART,    /* the way in: from far away to where adhesion takes hold, or to first touch */
    NT_VIEW_ATTACHED, /* the way out: from deep contact to the fold where it lets go */
    NT_VIEW_UNSTABLE  /* between the two folds: equilibria that nothing can hold */
} nt_view_part;

typedef struct nt_view_point {
    double gap;   /* h [m] */
    double force; /* on the tip, + repulsive [N] */
} nt_view_point;

typedef struct nt_view_range {
    nt_view_part part;
    double nearest;  /* smallest gap that is drawn; below 0: contact [m] */
    double farthest; /* largest [m] */
} nt_view_range;

/* Up to `count` >= 2 points of one part over a place (NULL: a flat), denser towards the fold; in the order of the gap,
 * downwards on the way in, upwards on the other two. Returns how many: 0 where the law has no such part in the range.
 */
NT_API long nt_view_curve(const nt_plan *plan, const nt_place *place, const nt_view_range *range,
                          nt_view_point points[], long count);

/* --- Section through the contact --- */

/* What is known of a contact: gap, force, and how its bodies share the deformation. */
typedef struct nt_view_pose {
    double gap;       /* h of the undeformed bodies [m] */
    double force;     /* on the tip: tells which branch the contact is on [N] */
    double tip_share; /* of the deformation: E* (1 - nu_t^2)/E_t, 0 .. 1 [-] */
} nt_view_pose;
/* E* (1 - nu_t^2)/E_t of a scene. */
NT_API double nt_view_tip_share(const nt_scene *scene);

/* A contact made ready to be drawn. */
typedef struct nt_view_contact {
    nt_shape shape;
    double radius;          /* effective radius R of a sphere or paraboloid there [m] */
    double modulus;         /* E* [Pa] */
    double gap;             /* h of the undeformed bodies [m] */
    double indentation;     /* delta that contact and zone deform the bodies with; of a sample that deforms under forces
                               beside contact that of their sum, so that the surfaces stay apart [m] */
    double contact_radius;  /* a [m] */
    double cohesive_radius; /* c, where the adhesive zone ends; a where it has no width [m] */
    double cohesive_stress; /* sigma0 between a and c [Pa] */
    double tip_share;       /* [-] */
    int attached;           /* 1: adhesion has taken hold, or the bodies touch */
} nt_view_contact;
/* The contact at a pose over a place (NULL: a flat): of the branches that the law has there, the one whose force is
 * nearest to the pose's. */
NT_API nt_view_contact nt_view_contact_at(const nt_plan *plan, const nt_place *place, const nt_view_pose *pose);

/* Both surfaces at a distance from the axis; heights over the undeformed sample. */
typedef struct nt_view_profile {
    double tip;       /* lower side of the tip as it is deformed, infinite where there is none [m] */
    double sample;    /* sample as it is deformed [m] */
    double rigid_tip; /* the tip as it would be undeformed [m] */
} nt_view_profile;

/* The section at distances r >= 0 from the axis [m]: half-spaces under the pressure of contact and cohesive zone.
 *
 * With theta(t) = delta - t Int_0^t f'(s)/sqrt(t^2 - s^2) ds inside a, and -2 sigma0/E* sqrt(c^2 - t^2) from a to c,
 * the surfaces come closer by u(r) = 2/pi Int_0^min(r, c) theta(t)/sqrt(r^2 - t^2) dt (Sneddon 1965, Maugis 1992):
 * delta - f inside a exactly, by quadrature to 1e-3 of delta outside. A layer is drawn as a half-space. */
NT_API void nt_view_section(const nt_view_contact *contact, const double r[], nt_view_profile profiles[], long count);

#ifdef __cplusplus
}
#endif
#endif
