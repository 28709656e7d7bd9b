# SPDX-License-Identifier: BSD-3-Clause
"""The matrix of extremes: what laws, plans, the loop and fits say at the edges of what they may be given. A cell counts
what was tried: right, refused (with a reason), or wrong. ``tests/heavy/extremes.py`` makes the whole of it."""

from __future__ import annotations

import collections
import math
import re
from collections.abc import Callable, Iterable
from typing import NamedTuple

import extremes_laws
import numpy as np
from extremes_laws import LAWS, Law
from nanotouch.errors import Error

KINDS = ("units", "folds", "zeros", "infinities", "30 decades")
"""of extremes"""
DECADES = 15
"""to either side of the usual value"""


class Cell(NamedTuple):
    """Of one subject at one kind of extreme."""

    tried: int
    right: int
    refused: dict[str, int]
    """by reason"""
    wrong: list[str]


class Refused(Exception):
    """The reason."""


def cell(trials: Iterable[tuple[str, Callable[[], str]]]) -> Cell:
    """``trials`` are words and a call that returns what is wrong, nothing where all is right; it may refuse."""
    refused: collections.Counter[str] = collections.Counter()
    tried = right = 0
    wrong = []
    for words, call in trials:
        tried += 1
        try:
            what = call()
        except (Error, Refused) as error:
            refused[reason(str(error))] += 1
            continue
        if what:
            wrong.append(f"{words}: {what}")
        else:
            right += 1
    return Cell(tried, right, dict(refused), wrong)


def reason(said: str) -> str:
    """A refusal without its numbers: the quantity that is outside its range, or what stands in the way."""
    first = said.splitlines()[0]
    if ": valid is" in first or "it must be" in first:
        return "outside its range"
    return re.sub(r"[-+]?[0-9.]+(e[-+]?[0-9]+)?", "..", first)[:80]


# --- laws ---


def of_law(law: Law, kind: str, rng: np.random.Generator, count: int) -> Cell:
    """One cell of a law."""
    return cell((words, lambda point=point: judge(law, point)) for words, point in points(law, kind, rng, count))  # type: ignore[misc]


def points(law: Law, kind: str, rng: np.random.Generator, count: int) -> Iterable[tuple[str, dict[str, float]]]:
    """Arguments at an extreme: others are the usual ones."""
    names = list(law.usual)
    if kind == "units":  # all lengths and energies scaled: a law knows no unit
        for _ in range(count):
            length, energy = 10.0 ** rng.uniform(-6.0, 9.0), 10.0 ** rng.uniform(-9.0, 9.0)
            by = {name: extremes_laws.scale(unit, length, energy) for name, unit in law.units.items()}
            scaled = {name: value * by[name] for name, value in law.usual.items()}
            yield f"lengths x {length:.3g}, energies x {energy:.3g}", scaled
        return
    if kind == "folds":
        for point in law.folds(law.usual):
            for ulp in (-1, 0, 1):
                moved = point | {law.at: float(np.nextafter(point[law.at], ulp * math.inf)) if ulp else point[law.at]}
                yield f"{law.at} = {moved[law.at]!r}", moved
        return
    if kind == "30 decades":
        for _ in range(count):
            name = names[int(rng.integers(len(names)))]
            value = law.usual[name] * 10.0 ** rng.uniform(-DECADES, DECADES)
            yield f"{name} = {value:.4g}", law.usual | {name: value}
        return
    values = (0.0, -0.0, 5e-324) if kind == "zeros" else (math.inf, -math.inf, math.nan)
    for name in names:
        for value in values:
            yield f"{name} = {value}", law.usual | {name: value}


def judge(law: Law, point: dict[str, float]) -> str:
    """What is wrong beside mpmath; an infinite or zero argument is held against its limit."""
    found = law.call(**point)
    for name, value in point.items():
        if math.isnan(value):
            return "" if math.isnan(found.F) else f"NaN {name} gives F = {found.F}"
    if math.isnan(found.F) and any(map(math.isinf, point.values())):
        raise Refused("not finite: NaN in its place")
    truths = extremes_laws.truths(law, point)
    if not truths:
        raise Refused("no limit")
    for truth in truths:
        if all(close(value, wanted, law.tolerance) for value, wanted in zip(found[:3], truth, strict=True)):
            return ""
    return f"U, F, k = {found[:3]}, mpmath {truths[0]}"


def close(value: float, wanted: float, tolerance: float) -> bool:
    """Within rounding; what is below 1e-290 may be any number that small."""
    if math.isinf(wanted) or math.isinf(value):
        return value == wanted or min(abs(value), abs(wanted)) > 1e300
    return abs(value - wanted) <= tolerance * abs(wanted) + 1e-290


def of_laws(seed: int, count: int) -> dict[tuple[str, str], Cell]:
    """All laws at all kinds of extremes."""
    return {
        (law.name, kind): of_law(law, kind, np.random.default_rng([seed, n, k]), count)
        for n, law in enumerate(LAWS)
        for k, kind in enumerate(KINDS)
    }
