/* SPDX-License-Identifier: BSD-3-Clause
 * Private to session/: what makes two sessions the same, so that the state of one may go on in the other. */
#ifndef NANOTOUCH_SESSION_ORIGIN_H
#define NANOTOUCH_SESSION_ORIGIN_H

#include "nanotouch/session.h"

/* Of a session as it was opened, what no request changes. */
typedef struct nt_origin {
    uint64_t seed;
    nt_demand demand;
    nt_mode mode;
    nt_probe_model probe_model;
    int preflight;
    double x, y, clearance, rise, substep; /* [m], [m], [m], [m], [rad] */
    double path, faults, particles, rod;   /* check sums */
} nt_origin;

nt_origin nt_origin_of(const nt_session_setup *setup);
/* NT_E_STATE with what differs, of the kept one, in *problem. */
nt_status nt_origin_check(const nt_origin *kept, const nt_origin *own, nt_problem *problem);
/* The same of scene, rig and settings as they are now, but for the scales, which a kept moment brings along. */
nt_status nt_origin_check_setup(const nt_session_setup *kept, const nt_session_setup *own, nt_problem *problem);

#endif
