/* SPDX-License-Identifier: BSD-3-Clause
 * Scaled bilateral teleoperation (paper, Sec. IV), one header per concept. Derivations: docs/control.md. */
#ifndef NANOTOUCH_CONTROL_H
#define NANOTOUCH_CONTROL_H

#include "nanotouch/guarantee.h"
#include "nanotouch/margins.h"
#include "nanotouch/motor_bound.h"
#include "nanotouch/passivity.h"
#include "nanotouch/preflight.h"
#include "nanotouch/scaling.h"
#include "nanotouch/servo.h"
#include "nanotouch/settings.h"
#include "nanotouch/stage_loop.h"
#include "nanotouch/supervisor.h"
#include "nanotouch/touch.h"

#endif
