# SPDX-License-Identifier: BSD-3-Clause
"""Numbers in sentences."""

from __future__ import annotations


def counted(number: int, noun: str, plural: str = "") -> str:
    """``"no scars"``, ``"1 scar"``, ``"2 scars"``."""
    if number == 1:
        return f"1 {noun}"
    return f"{number or 'no'} {plural or noun + 's'}"


def times(ratio: float) -> str:
    """A ratio with two digits and no exponent: ``"2.4 times"``, ``"250 times"``."""
    return f"{ratio:.2g} times" if ratio < 99.5 else f"{float(f'{ratio:.2g}'):.0f} times"
