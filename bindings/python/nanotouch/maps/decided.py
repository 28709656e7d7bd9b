# SPDX-License-Identifier: BSD-3-Clause
"""What a person decided about single curves of a map, from the sidecar that fits of many files read too."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..batch.sidecar import Decision, Sidecar
from ..errors import InvalidValue
from .block import EXCLUDED, fit_block, part_of, status_names
from .settings import Settings
from .store import Columns
from .volume import CurveVolume, Volume

Decisions = Mapping[int, Decision]


def decisions_of(volume: Volume, sidecar: Sidecar) -> tuple[dict[int, Decision], list[str]]:
    """The decisions by place, counted along the rows, and the names in the sidecar that are those of no curve."""
    if not isinstance(volume, CurveVolume) or volume.file is None:
        raise InvalidValue("a sidecar names curves of a file, and this map is an array or a list of curves")
    file, found = volume.file, {}
    used: set[str] = set()
    sha256 = volume.digest() if any(one.sha256 for one in sidecar.decisions.values()) else ""
    for place in sorted(volume.places):
        name, decision = sidecar.named(file, volume.numbers[place])
        if name is not None:
            if outdated := decision.outdated(sha256):
                raise InvalidValue(f"{name}: {outdated}")
            found[place] = decision
            used.add(name)
    whole = sidecar.named(file, -1)[0]  # of every curve, though each may have a decision of its own
    return found, [name for name in sidecar.decisions if name not in used and name != whole]


def decide(columns: Columns, stored: Mapping[str, Any], volume: Volume, start: int, decisions: Decisions) -> Columns:
    """The columns of a block that begins at `start`, with its decided curves left out or fitted again."""
    end = start + columns["status"].size
    mine = {place: decision for place, decision in decisions.items() if start <= place < end}
    if not mine:
        return columns
    made = {name: values.astype(object) if name == "reason" else values.copy() for name, values in columns.items()}
    for place, decision in mine.items():
        one = _excluded(columns, decision) if decision.exclude else _fitted(stored, volume, place, decision)
        for name, value in one.items():
            made[name][place - start] = value
    return made | {"reason": made["reason"].astype(np.str_)}


def _excluded(columns: Columns, decision: Decision) -> dict[str, Any]:
    values = {name: np.nan for name, column in columns.items() if column.dtype.kind == "f"}
    return values | {"status": status_names()[EXCLUDED], "flags": 0, "reason": f"excluded: {decision.exclude}"}


def _fitted(stored: Mapping[str, Any], volume: Volume, place: int, decision: Decision) -> dict[str, Any]:
    settings = Settings.from_json(stored)
    if decision.contact_point is not None:
        settings = replace(settings, fixed=dict(settings.fixed) | {"contact_point": decision.contact_point})
    if decision.baseline is not None:
        settings = replace(settings, baseline=decision.baseline)
    stored = settings.as_json()
    columns = fit_block(stored, part_of(volume, stored, place, place + 1))
    return {name: values[0] for name, values in columns.items()}
