# SPDX-License-Identifier: BSD-3-Clause
"""A plan and a touch step as constants of C, in single precision, for a controller that has no time to plan
(docs/howto/microcontroller.md)."""

from __future__ import annotations

import re
import textwrap

from nanotouch import __version__, _core
from nanotouch.errors import InvalidValue
from nanotouch.scene import Rig, Settings
from nanotouch.scene.plan import Plan
from nanotouch.touch._path import Mode, core_mode
from nanotouch.units import in_words

_TEXT = """/* SPDX-License-Identifier: BSD-3-Clause
 * Written by nanotouch {version}: do not edit. Needs nanotouch_single.h and .c (tools/single.py).
 *
 * {name}_force: the force over the gap, {pieces} pieces. It is within {bound} of max(|F|, {scale}) of the plan's
 * where the gap is {away} or more from a fold, a jump and first touch. The plan's own bound is below.{left_out}
 * {name}_touch: the touch step in the mode "{mode}", {rate} steps in a second.
 *
{plan}
 */
#ifndef NANOTOUCH_CONSTANTS_{upper}_H
#define NANOTOUCH_CONSTANTS_{upper}_H

#include <math.h>

#include "nanotouch_single.h"

static const ntf_force_piece {name}_pieces[{pieces}] = {piece_text};

static const ntf_force_table {name}_force = {{
    {name}_pieces,
{table_text}}};

static const ntf_touch {name}_touch = {touch_text};

#endif
"""


def write(
    plan: Plan, rig: Rig | None = None, settings: Settings | None = None, mode: Mode = "point", name: str = "plan"
) -> str:
    """The text of a header with the constants ``name_force`` and ``name_touch``.

    Its force differs from the plan's by at most what stands in it: a tenth of the plan's relative accuracy or less,
    and no less than 4e-6. :class:`~nanotouch.errors.InvalidValue` says what cannot be written: a plan over a surface or
    of a sample that keeps dents, a force beyond single precision, one that is felt beyond 1 mm, a control law of one's
    own.
    """
    if not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        raise InvalidValue(f"name = {name!r}: it must be small letters, digits and _, a letter first")
    rig = Rig() if rig is None else rig
    settings = Settings.for_rig(rig) if settings is None else settings
    table = _core.ForceTable(plan.core)
    piece_text, table_text = table.text()
    slides = plan.friction.form != "off"
    described = str(plan).replace("*/", "* /").splitlines()
    return _TEXT.format(
        version=__version__,
        name=name,
        upper=name.upper(),
        bound=in_words(1.005 * table.bound, "", 3),  # never rounded down
        scale=in_words(table.scale, "N", 3),
        away=in_words(1.05 * table.fold_distance, "m", 2),
        left_out=" The plan's friction is not in it." if slides else "",
        mode=mode,
        rate=f"{settings.gains.rate:g}",
        plan="\n".join(f" * {part}" for line in described for part in textwrap.wrap(line, 116)),
        pieces=table.pieces,
        piece_text=piece_text,
        table_text=table_text,
        touch_text=_core.touch_text(rig.core, settings.core, core_mode(mode)),
    )
