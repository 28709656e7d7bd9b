# SPDX-License-Identifier: BSD-3-Clause
"""A mock of forcedimension-core 1.0, after its documentation: what a bridge calls of it, over a device on the desk."""

import os

if os.environ.get("NANOTOUCH_MOCK") == "no SDK":  # as the package does without libdrd
    raise ImportError("There were problems loading libdrd. Check if you have it installed properly.")

from . import dhd as dhd
