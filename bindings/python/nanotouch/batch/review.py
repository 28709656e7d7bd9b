# SPDX-License-Identifier: BSD-3-Clause
"""Curves one by one: what a person decides of each lies in a sidecar, which :func:`nanotouch.batch.fit_files` reads."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..curves import ForceCurve, read
from ..errors import Error, InvalidValue
from ..fit import FitResult, fit_curve
from .files import files_of
from .sidecar import Decision, Sidecar
from .table import by_hand


@dataclass(frozen=True)
class Place:
    """A curve by its file and its number in it; `name` is that of the sidecar."""

    file: Path
    index: int
    name: str
    curve: ForceCurve


class Review:
    """The curves of files, with what was decided; each change is written to the sidecar at once.

    Parameters
    ----------
    names : iterable of path
        Files, folders and patterns.
    sidecar : path
        TOML file; what it says already stays.
    model, reading, settings
        As for :func:`nanotouch.batch.fit_files`.
    """

    def __init__(
        self, names: Iterable[str | os.PathLike[str]], sidecar: str | os.PathLike[str], model: str = "auto",
        *, reading: Mapping[str, Any] | None = None, **settings: Any,
    ) -> None:  # fmt: skip
        self.path = Path(sidecar)
        self._decisions = dict(Sidecar.from_toml(self.path).decisions) if self.path.exists() else {}
        self._settings = {"model": model, **settings}
        self.places: list[Place] = []
        self.unread: dict[str, str] = {}
        own = self.path.resolve()
        for file in files_of(names):
            if file.resolve() == own:
                continue
            try:
                found = read(file, **(reading or {}))
            except Error as error:
                self.unread[file.name] = str(error)
                continue
            for index, curve in enumerate(found):
                name = file.as_posix() if len(found) == 1 else f"{file.as_posix()}#{index}"
                self.places.append(Place(file, index, name, curve))
        if not self.places:
            raise InvalidValue(f"no curve to review: {'; '.join(self.unread.values()) or 'no file'}")

    def decision(self, place: Place) -> Decision:
        """What is decided of a curve."""
        return self._decisions.get(place.name) or Sidecar(self._decisions).of(place.file, place.index)

    def decide(self, place: Place, **changes: Any) -> Decision:
        """Change `exclude`, `contact_point` [m] or `baseline` [m, m] of a curve; written at once."""
        made = replace(self.decision(place), **changes)
        if made.baseline is not None and not made.baseline[0] < made.baseline[1]:
            raise InvalidValue(f"baseline {made.baseline[0]:g} .. {made.baseline[1]:g} m: expected two that grow")
        if made == Decision():
            self._decisions.pop(place.name, None)
        else:
            self._decisions[place.name] = made
        Sidecar(self._decisions).write(self.path)
        return made

    def fitted(self, place: Place) -> FitResult | str:
        """The fit with what is decided, excluded or not; or why there is none."""
        try:
            return fit_curve(place.curve, **(self._settings | by_hand(self.decision(place))))
        except Error as error:
            return str(error)
