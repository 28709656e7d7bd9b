# SPDX-License-Identifier: BSD-3-Clause
"""Imported by mutated modules: NT_MUTANT=17 switches mutant 17 on; NT_REACHED=file gets the numbers of those passed."""

import atexit
import os

_on = int(os.environ.get("NT_MUTANT", "0"))
_reached: set[int] = set()


def is_on(number: int) -> bool:
    """Say whether this mutant is switched on."""
    _reached.add(number)
    return number == _on


def _report() -> None:
    with open(os.environ["NT_REACHED"], "a") as file:
        file.writelines(f"{number}\n" for number in _reached)


if os.environ.get("NT_REACHED"):
    atexit.register(_report)
