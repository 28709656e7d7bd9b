/* SPDX-License-Identifier: BSD-3-Clause
 * The umbrella: what is promised, but fit.h, which is optional. Headers in advanced/ may change in any version. */
#ifndef NANOTOUCH_NANOTOUCH_H
#define NANOTOUCH_NANOTOUCH_H

#include "nanotouch/contact.h"
#include "nanotouch/control.h"
#include "nanotouch/curves.h"
#include "nanotouch/dynamics.h"
#include "nanotouch/forces.h"
#include "nanotouch/frames.h"
#include "nanotouch/friction.h"
#include "nanotouch/hal.h"
#include "nanotouch/hal_backend.h"
#include "nanotouch/interaction.h"
#include "nanotouch/margins.h"
#include "nanotouch/material.h"
#include "nanotouch/plan.h"
#include "nanotouch/rheology.h"
#include "nanotouch/rig.h"
#include "nanotouch/scene.h"
#include "nanotouch/session.h"
#include "nanotouch/status.h"
#include "nanotouch/surface.h"
#include "nanotouch/touch.h"
#include "nanotouch/types.h"
#include "nanotouch/version.h"

#endif
