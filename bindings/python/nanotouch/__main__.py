# SPDX-License-Identifier: BSD-3-Clause
"""``python -m nanotouch``: the ``nanotouch`` command, which comes with this package."""

import importlib
import sys

COMMAND = "nanotouch_app.main"  # by name: the library itself needs no command

sys.exit(importlib.import_module(COMMAND).main())
