/* SPDX-License-Identifier: BSD-3-Clause
 * The umbrella: everything but the optional parts (fit.h, hal_linux.h). */
#ifndef NANOTOUCH_NANOTOUCH_H
#define NANOTOUCH_NANOTOUCH_H

#include "nanotouch/commands.h"
#include "nanotouch/contact.h"
#include "nanotouch/contact_equilibrium.h"
#include "nanotouch/control.h"
#include "nanotouch/curves.h"
#include "nanotouch/dynamics.h"
#include "nanotouch/field.h"
#include "nanotouch/flow.h"
#include "nanotouch/forces.h"
#include "nanotouch/frames.h"
#include "nanotouch/friction.h"
#include "nanotouch/geometry.h"
#include "nanotouch/hal.h"
#include "nanotouch/hal_backend.h"
#include "nanotouch/interaction.h"
#include "nanotouch/material.h"
#include "nanotouch/maugis_bank.h"
#include "nanotouch/maugis_table.h"
#include "nanotouch/observer.h"
#include "nanotouch/plan.h"
#include "nanotouch/rig.h"
#include "nanotouch/scan.h"
#include "nanotouch/scene.h"
#include "nanotouch/session.h"
#include "nanotouch/sim.h"
#include "nanotouch/status.h"
#include "nanotouch/surface.h"
#include "nanotouch/tapping.h"
#include "nanotouch/terrain.h"
#include "nanotouch/types.h"
#include "nanotouch/version.h"
#include "nanotouch/view.h"

#endif
