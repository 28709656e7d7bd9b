# SPDX-License-Identifier: BSD-3-Clause
"""SDL, without the line that it prints of itself."""

from __future__ import annotations

import warnings
from typing import Any

from nanotouch.errors import require


def load() -> Any:
    """The module; :class:`~nanotouch.errors.MissingExtra` names the extra that brings it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # which SDL it has found
        return require("sdl2", "hands")
