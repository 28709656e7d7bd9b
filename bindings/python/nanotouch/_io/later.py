# SPDX-License-Identifier: BSD-3-Clause
"""Packages whose modules load when something of them is first used: to list what a file holds needs few of them."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Mapping
from typing import Any


def at_first_use(package: str, homes: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """The ``__getattr__`` and ``__dir__`` of a package, from its modules and the names in each.

    A name that is its module's, too, cannot wait: whoever loads the module would put it into the name's place.
    """
    found = {name: module for module, names in homes.items() for name in names.split()}
    assert not set(found) & set(homes)

    def getattr_(name: str) -> Any:
        if name not in found:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(importlib.import_module(f"{package}.{found[name]}"), name)
        setattr(sys.modules[package], name, value)
        return value

    return getattr_, lambda: sorted(sys.modules[package].__all__)
