/* SPDX-License-Identifier: BSD-3-Clause
 * The force between tip and surface: one potential U(pose, history), the sum of what a plan computes; F = -grad U in x,
 * y and z. What the history costs (jump-in, pull-off, menisci that form and rupture) only ever leaves the system. */
#ifndef NANOTOUCH_INTERACTION_H
#define NANOTOUCH_INTERACTION_H

#include "nanotouch/plan.h"
#include "nanotouch/types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The history of one contact. Copyable, 24 bytes, enough to replay from; zero is "never touched". */
typedef struct nt_interaction_state {
    int attached;      /* 1: in contact, or held by the meniscus or the attraction that contact has left */
    double dissipated; /* energy lost in jumps so far, grows only [J] */
    double port;       /* energy put in by slow changes so far (nt_interaction_change) [J] */
} nt_interaction_state;

/* Height, slopes and effective radius at a place (surface.h); of a plan without local forms the tip's own radius. */
NT_API NT_REALTIME nt_place nt_interaction_place(const nt_plan *plan, double x, double y);

/* Force on the tip at a pose. */
typedef struct nt_interaction_value {
    double U;          /* energy [J] */
    double Fx, Fy, Fz; /* force on the tip [N] */
    double k;          /* dFz/d(delta) [N/m] */
    double a;          /* contact radius [m] */
    double gap;        /* h of the undeformed bodies [m] */
} nt_interaction_value;

/* Pure: may be asked at trial poses. A gap inside the capture range counts as captured. */
NT_API NT_REALTIME nt_interaction_value nt_interaction_eval(const nt_plan *plan, const nt_interaction_state *state,
                                                            const nt_pose *pose);
/* The vertical law at a gap [m] over a place; NULL: a flat. */
NT_API NT_REALTIME nt_law_value nt_interaction_eval_gap(const nt_plan *plan, const nt_interaction_state *state,
                                                        const nt_place *place, double gap);

/* Commits history once per accepted step: captured (contact, meniscus formed) or let go (pull-off, meniscus ruptured),
 * with what that dissipates. A pose that is not a number changes nothing. */
NT_API NT_REALTIME void nt_interaction_advance(const nt_plan *plan, nt_interaction_state *state, const nt_pose *pose);
/* The same at a place of the surface and a gap [m], for callers that have both. */
NT_API NT_REALTIME void nt_interaction_advance_gap(const nt_plan *plan, nt_interaction_state *state,
                                                   const nt_place *place, double gap);

/* The history of friction. Copyable; zero is "never touched". Beside that of the contact, always: work of the hand
 * in the plane = what the potential gains + friction.stored + friction.dissipated. */
typedef struct nt_slide {
    nt_friction_state friction;
    double x, y; /* where the tip's support was last [m] */
    int placed;  /* 1: it was somewhere */
} nt_slide;

/* Commits the way from where the tip was last to a pose, once per accepted step and after nt_interaction_advance. The
 * friction force on the tip is then slide->friction.force, beside Fx and Fy of nt_interaction_eval. Along the way the
 * contact is that of its end. At a pose that is not a number nothing changes; a plan without friction ends the history,
 * whatever plan it comes from: no force is left, and what was stored is heat. */
NT_API NT_REALTIME void nt_interaction_slide(const nt_plan *plan, const nt_interaction_state *state, nt_slide *slide,
                                             const nt_pose *pose);

/* Slow changes of the scene itself (wear, charging, contact ageing): from `plan` to `changed` at a pose. The history is
 * carried over, what changes in U at this pose is booked in state->port; at a pose that is not a number, nothing. */
NT_API void nt_interaction_change(const nt_plan *plan, const nt_plan *changed, nt_interaction_state *state,
                                  const nt_pose *pose);

/* Arrays; strides in elements. Parts of them may go to different threads. */
typedef struct nt_interaction_arrays {
    const nt_pose *poses;
    nt_interaction_value *values;
    long count;
    long pose_stride, value_stride;
} nt_interaction_arrays;
/* One contact on one history at many poses. */
NT_API void nt_interaction_eval_n(const nt_plan *plan, const nt_interaction_state *state,
                                  const nt_interaction_arrays *arrays);
/* One contact along a path of poses: advance, then evaluate, at each. */
NT_API void nt_interaction_run_n(const nt_plan *plan, nt_interaction_state *state, const nt_interaction_arrays *arrays);
/* Many contacts of one plan, each with its own state (contiguous): advance, then evaluate, each at its pose. */
NT_API void nt_interaction_step_n(const nt_plan *plan, nt_interaction_state *states,
                                  const nt_interaction_arrays *arrays);

#ifdef __cplusplus
}
#endif
#endif
