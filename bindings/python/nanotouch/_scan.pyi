# SPDX-License-Identifier: BSD-3-Clause
"""What _core has of advanced/tapping.h, advanced/scan.h and internal/steady.h. For type checkers: no module at run time."""

from typing import Any

Tapping: Any
Flow: Any
Scanner: Any
ScanProgress: Any
Steady: Any
steady_line: Any
