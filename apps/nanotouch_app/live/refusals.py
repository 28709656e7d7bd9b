# SPDX-License-Identifier: BSD-3-Clause
"""Why a slider has sprung back, in words, and how far it may go."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import nanotouch as nt
from nanotouch import margins
from nanotouch.errors import Error

from nanotouch_app.live.sliders import KINDS, OFFERED, Slider

NUMBER = r"([-+.\deEinfa]+)"
INACCURATE = re.compile(rf"demand\.relative_accuracy = {NUMBER}\s*: valid is {NUMBER} \.\. ")
UNSTABLE = re.compile(rf"stability margin \(([^)]*)\) = {NUMBER}: valid is {NUMBER} \.\. ")
NO_LAW = re.compile(r"the sample deforms under (.*) before contact\)")
OTHER = re.compile(r"([a-z]+\.[a-z_]+)(?: \(([^)]*)\))? = (\S+(?: \S+)?): valid is ([^;]*)")
HALVINGS = 20  # of the way to what was asked
SURE = 0.999  # of what was found is told, so that asking for it works


def in_words(session: nt.Session, what: str, field: str, value: float, error: Error) -> str:
    """What a session has said to a change, as it is told to the person at the slider."""
    shown = _slider(what, field)
    old = float(getattr(session, what)[field])
    asked, stays = f"{shown.name} {shown.told(value)}", f"It stays at {shown.told(old)}."
    said = str(error)
    if found := INACCURATE.search(said):
        best, wanted = (100.0 * float(found[number]) for number in (2, 1))
        return f"{asked}: known only within {best:.2g} % there, and this session keeps {wanted:.2g} %. {stays}"
    if found := NO_LAW.search(said):
        law = found[1]
        return f"{asked}: so soft that {law} moves it before contact; no law within the demand. {stays}"
    if found := UNSTABLE.search(said):
        limit = _furthest(old, value, lambda at: _margin(session, field, at) >= session.minimum_margin)
        possible = "" if limit is None else f" Possible is up to {shown.told(limit)}."
        return (f"{asked}: the loop would not be stable enough (margin {float(found[2]):.3g} of {found[1]}; at least "
                f"{float(found[3]):.3g} is kept).{possible} {stays}")  # fmt: skip
    if (found := OTHER.search(said)) and found[1] != field:
        why = f" ({found[2]})" if found[2] else ""
        within = f"which would have to be within {found[4]}{why}"
        return f"{asked}: that does not go with {found[1]} = {found[3]}, {within}. {stays}"
    return f"{asked}: {said.removeprefix(f'{field}: ').removeprefix('rescale: ')}. {stays}"


def _slider(what: str, field: str) -> Slider:
    """One that tells the field's name and values."""
    name = next((words for _, key, words, *_ in OFFERED if key == field), field.split(".")[1].replace("_", " "))
    ends = KINDS[what].fields[field]
    return Slider(what, field, name, ends.minimum, ends.maximum, ends.minimum)


def _margin(session: nt.Session, field: str, value: float) -> float:
    """Of the loop with this value in its settings."""
    settings = session.settings.copy()
    settings[field] = value
    return margins.of_own_law(session.rig, settings, settings, session.plan.maximum_stiffness, session.mode).least


def _furthest(good: float, bad: float, holds: Callable[[float], bool]) -> float | None:
    """Nearest to a bad value from a good one, by halves of the way; None where not even the good one is."""
    if not (good > 0.0 and bad > 0.0 and holds(good)):
        return None
    for _ in range(HALVINGS):
        middle = math.sqrt(good * bad)
        good, bad = (middle, bad) if holds(middle) else (good, middle)
    return good * (SURE if bad > good else 2.0 - SURE)
