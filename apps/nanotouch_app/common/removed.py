# SPDX-License-Identifier: BSD-3-Clause
"""Options of earlier versions, with what takes their place."""

OF_SURFACE = "name it in the [surface] table of a scene file (docs/surface.md)"

OF_DEMAND = "name it in the [demand] table of a scene file (docs/plan.md)"

OPTIONS = {
    **dict.fromkeys(("--bound", "--force-floor", "--quantity", "--budget"), OF_DEMAND),
    **dict.fromkeys(
        ("--youngs-modulus", "--effective-modulus", "--work-of-adhesion", "--pull-off-force", "--properties", "--unit",
         "--fill-by"), OF_SURFACE,
    ),
}  # fmt: skip
