# SPDX-License-Identifier: BSD-3-Clause
"""Numbers and names in sentences."""

from __future__ import annotations


def counted(number: int, noun: str, plural: str = "") -> str:
    """``"no scars"``, ``"1 scar"``, ``"2 scars"``."""
    if number == 1:
        return f"1 {noun}"
    return f"{number or 'no'} {plural or noun + 's'}"


def times(ratio: float) -> str:
    """A ratio with two digits and no exponent: ``"2.4 times"``, ``"250 times"``."""
    return f"{ratio:.2g} times" if ratio < 99.5 else f"{float(f'{ratio:.2g}'):.0f} times"


def told(value: object) -> str:
    """A wrong value as Python writes it, unless it is too large for a sentence."""
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # a whole number of more than 4300 digits, a list of lists of lists ...
        return f"a too large {type(value).__name__}"
    return text if len(text) <= 200 else f"{text[:100]} ... ({len(text)} characters)"


def shortened(name: str) -> str:
    """A wrong name, unless it is too long for a sentence."""
    return name if len(name) <= 100 else f"{name[:50]} ... ({len(name)} characters)"


def printable(text: str) -> str:
    """The same where it can be printed; of a file's name, bytes that are no character are written out."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")
