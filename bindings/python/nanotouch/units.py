# SPDX-License-Identifier: BSD-3-Clause
"""Units at the edge: quantities on a command line (``2.5um``), keys of a TOML file (``radius_nm``), axes of
pictures. Inside: SI only."""

from __future__ import annotations

import math
import re
from decimal import Decimal

import numpy as np
from numpy.typing import ArrayLike

from nanotouch.errors import InvalidValue

_FACTORS = {
    "": 1.0, "k": 1e3, "M": 1e6, "G": 1e9,
    "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12, "f": 1e-15, "a": 1e-18, "z": 1e-21,
}  # fmt: skip


def _scaled(symbol: str, prefixes: str, rest: str = "") -> dict[str, float]:
    return {f"{p}{symbol}{rest}": _FACTORS[p] for p in ["", *prefixes]}


#: the prefixes that pictures use, by their power of ten
PREFIXES = {-18: "a", -15: "f", -12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
#: spellings accepted for each SI unit of the field tables, with their factor
UNITS: dict[str, dict[str, float]] = {
    "": {"": 1.0, "%": 0.01, "percent": 0.01},
    "m": _scaled("m", "munp"),
    "Pa": _scaled("Pa", "kMG"),
    "Pa s": _scaled("Pas", "mkM"),
    "N": _scaled("N", "munp"),
    "J": _scaled("J", "fpaz"),
    "V": _scaled("V", "mu"),
    "K": {"K": 1.0},
    "s": _scaled("s", "mu"),
    "Hz": _scaled("Hz", "kM"),
    "kg": {"kg": 1.0, "g": 1e-3},
    "rad": {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0},
    "N/m": _scaled("N", "mkun", "/m"),
    "m/N": _scaled("m", "mun", "/N"),
    "J/m^2": _scaled("J", "mu", "/m2"),
    "rad/V": {"rad/V": 1.0, "deg/V": math.pi / 180.0},
    "Hz/V": {"Hz/V": 1.0, "kHz/V": 1e3},
    "m/V": _scaled("m", "un", "/V"),
    "m/A": {"nm/nA": 1.0, "um/nA": 1e3, "nm/pA": 1e3, "nm/uA": 1e-3, "m/A": 1.0},
    "m/s": _scaled("m", "mun", "/s"),
    "N/V": _scaled("N", "munp", "/V"),
    "N/s": _scaled("N", "mk", "/s"),
    "1/s": {"/s": 1.0},
    "N s/m": {"Ns/m": 1.0},
    "m/m": {"m/m": 1.0, "um/mm": 1e-3, "nm/mm": 1e-6},
    "N/N": {"N/N": 1.0, "N/uN": 1e6, "N/nN": 1e9},
    "W": _scaled("W", "mk"),
    "m^3/mol": {"m3/mol": 1.0, "cm3/mol": 1e-6},
    "C": _scaled("C", "munpfa"),
    "mol/m^3": {"mol/m3": 1.0, "mM": 1.0, "M": 1e3},
    "periods": {"periods": 1.0, "": 1.0},
}

_EXAMPLES = {"": "0.4", "m": "2.5um", "s": "20s", "N": "100nN", "m/s": "1nm/s"}
_SPELT = str.maketrans({"µ": "u", "μ": "u", "²": "2", "³": "3", "^": None})
_QUANTITY = re.compile(r"\s*([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(.*?)\s*")


def to_si(value: float, factor: float) -> float:
    """``value`` times ``factor``, rounded once in decimal: 3 nm is the double 3e-9, as it would be written in SI."""
    return float(Decimal(repr(value)) * Decimal(repr(factor)))


def from_si(value: float, factor: float) -> float:
    """``value`` over ``factor``: what :func:`to_si` turns into ``value`` again, or into the double beside it where
    no number does."""
    near = float(Decimal(repr(float(value))) / Decimal(repr(factor)))
    around = (near, math.nextafter(near, -math.inf), math.nextafter(near, math.inf))
    return next((number for number in around if to_si(number, factor) == value), near)


def parse_quantity(text: str, unit: str) -> float:
    """``"2.5um"`` with unit ``"m"`` to 2.5e-6. The unit must be written; ``µ`` is read as ``u``."""
    match = _QUANTITY.fullmatch(text)
    if not match:
        raise InvalidValue(f"{text!r} is not a number with a unit; write it like {_example(unit)}")
    spelling = match[2].translate(_SPELT)
    if spelling not in UNITS[unit]:
        given = f"the unit {match[2]!r}" if match[2] else "no unit"
        valid = ", ".join(filter(None, UNITS[unit])) or "none"
        raise InvalidValue(f"{text!r} has {given}; write it like {_example(unit)} (units: {valid})")
    number = float(match[1])
    value = to_si(number, UNITS[unit][spelling]) if math.isfinite(number) else number
    if not math.isfinite(value):
        raise InvalidValue(f"{text!r} is not a finite number")
    return value


def least_power(unit: str) -> int:
    """Of ten, of the smallest prefix: works go down to aJ, all else to p (lengths of a few fm are no lengths here)."""
    return min(PREFIXES) if unit.startswith("J") else -12


def engineering(unit: str, values: ArrayLike) -> tuple[str, float]:
    """The SI prefix that suits the largest magnitude: ``engineering("m", [2e-7])`` is ``("nm", 1e9)``."""
    magnitudes = np.abs(np.asarray(values, dtype=float))
    largest = float(np.max(magnitudes, where=np.isfinite(magnitudes), initial=0.0))
    power = 3 * math.floor(math.log10(largest) / 3 + 1e-12) if largest > 0 else 0
    power = min(max(power, least_power(unit)), max(PREFIXES))
    return PREFIXES[power] + unit, 10.0**-power


def in_words(value: float, unit: str, digits: int = 4) -> str:
    """A number with its unit under a prefix that suits: ``in_words(3.936e-10, "N")`` is ``"393.6 pN"``."""
    rounded = float(f"{value:.{digits}g}")  # before the prefix is chosen: 999.96 pN are 1 nN
    if not unit and 1e3 <= abs(rounded) < 1e6:
        return f"{rounded:.0f}"  # not 1.05e+03
    prefixed, factor = engineering(unit, [rounded]) if unit else ("", 1.0)
    scaled = float(f"{rounded * factor:.{digits}g}")
    return f"{scaled:.{max(digits, 3)}g} {prefixed}".rstrip()  # two digits: 720 pm, not 7.2e+02 pm


def _example(unit: str) -> str:
    return _EXAMPLES.get(unit) or "20" + next(spelling for spelling in UNITS[unit] if spelling)


def key_suffix(spelling: str) -> str:
    """How a unit is written in a TOML key: ``N/m`` as ``N_per_m``."""
    return spelling.replace("/", "_per_", 1).lstrip("_") if spelling != "%" else "percent"


def key_spellings(name: str, unit: str) -> dict[str, float]:
    """All TOML keys for a field and their factors: ``radius``, m: ``radius_m``, ``radius_nm``, ..."""
    keys = {}
    for spelling, factor in UNITS[unit].items():
        suffix = key_suffix(spelling)
        keys[f"{name}_{suffix}" if suffix else name] = factor
    return keys
