/* SPDX-License-Identifier: BSD-3-Clause
 * Scaled bilateral teleoperation (paper, Sec. IV), one header per concept. Derivations: docs/control.md. */
#ifndef NANOTOUCH_CONTROL_H
#define NANOTOUCH_CONTROL_H

#include "nanotouch/advanced/motor_bound.h"
#include "nanotouch/advanced/passivity.h"
#include "nanotouch/advanced/preflight.h"
#include "nanotouch/advanced/stage_loop.h"
#include "nanotouch/guarantee.h"
#include "nanotouch/margins.h"
#include "nanotouch/scaling.h"
#include "nanotouch/servo.h"
#include "nanotouch/settings.h"
#include "nanotouch/supervisor.h"
#include "nanotouch/touch.h"

#endif
