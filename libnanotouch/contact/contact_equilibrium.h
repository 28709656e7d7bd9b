/* SPDX-License-Identifier: BSD-3-Clause
 * Private to the library: what contact_equilibrium.h does not promise. */
#ifndef NANOTOUCH_CONTACT_CONTACT_EQUILIBRIUM_PRIVATE_H
#define NANOTOUCH_CONTACT_CONTACT_EQUILIBRIUM_PRIVATE_H

#include "nanotouch/advanced/contact_equilibrium.h"

/* At the branch parameter y >= 0 (contact.h, nt_maugis_at). NT_E_RANGE for w = 0, which has none. */
nt_status nt_maugis_at_parameter(const nt_maugis *maugis, double y, nt_contact_state *state);
/* The last equilibrium before the pull-off under a spring k_c >= 0 [N/m], INFINITY for grips. */
nt_status nt_maugis_spring_fold(const nt_maugis *maugis, double spring, nt_contact_state *state);

#endif
