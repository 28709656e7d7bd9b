# SPDX-License-Identifier: BSD-3-Clause
"""Curves one by one: what a person decides of each lies in a sidecar, which :func:`nanotouch.batch.fit_files` reads."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .._io.digest import file_digest
from ..curves import ForceCurve, read
from ..errors import Error, InvalidValue
from ..fit import FitResult, fit_curve
from .files import files_of
from .sidecar import Decision, Sidecar
from .table import by_hand


@dataclass(frozen=True)
class Place:
    """A curve by its file, the file's SHA-256 and its number in it; `name` is that of the sidecar."""

    file: Path
    index: int
    name: str
    curve: ForceCurve
    sha256: str


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
        self._decisions = self._stored()
        self._settings = {"model": model, **settings}
        self.places: list[Place] = []
        self.unread: dict[str, str] = {}
        own = self.path.resolve()
        for file in files_of(names):
            if file.resolve() == own:
                continue
            try:
                sha256, found = file_digest(file), read(file, **(reading or {}))
            except (Error, OSError) as error:
                self.unread[file.name] = str(error)
                continue
            for index, curve in enumerate(found):
                path = _path_in(file)
                name = path if len(found) == 1 else f"{path}#{index}"
                self.places.append(Place(file, index, name, curve, sha256))
        if not self.places:
            raise InvalidValue(f"no curve to review: {'; '.join(self.unread.values()) or 'no file'}")

    def decision(self, place: Place) -> Decision:
        """What is decided of a curve."""
        return Sidecar(self._decisions).of(place.file, place.index)

    def decide(self, place: Place, **changes: Any) -> Decision:
        """Change `exclude`, `contact_point` [m] or `baseline` [m, m] of a curve; written at once.

        The sidecar is read again before: what another review or an editor has written meanwhile stays. What was decided
        on other content of the file goes.
        """
        self._decisions = self._stored()
        before = self.decision(place)
        before = Decision() if before.outdated(place.sha256) else before
        made = replace(before, **changes, sha256=place.sha256)
        if made.baseline is not None and not made.baseline[0] < made.baseline[1]:
            raise InvalidValue(f"baseline {made.baseline[0]:g} .. {made.baseline[1]:g} m: expected two that grow")
        name = self._own_name(place)
        if made != Decision():
            self._decisions[name or place.name] = made
        while made == Decision() and name is not None:
            del self._decisions[name]
            name = self._own_name(place)
        if self.decision(place) != made:
            whole = Sidecar(self._decisions).named(place.file, place.index)[0]
            raise InvalidValue(f"{self.path}: [{whole!r}] says it of all curves of the file; change it there")
        Sidecar(self._decisions).write(self.path)
        return made

    def _stored(self) -> dict[str, Decision]:
        return dict(Sidecar.from_toml(self.path).decisions) if self.path.exists() else {}

    def _own_name(self, place: Place) -> str | None:
        """By which the sidecar speaks of this curve alone."""
        name = Sidecar(self._decisions).named(place.file, place.index)[0]
        of_many = place.name.endswith(f"#{place.index}") and name is not None and not name.endswith(f"#{place.index}")
        return None if of_many else name

    def fitted(self, place: Place) -> FitResult | str:
        """The fit with what is decided, excluded or not; or why there is none."""
        decision = self.decision(place)
        if outdated := decision.outdated(place.sha256):
            return outdated
        try:
            return fit_curve(place.curve, **(self._settings | by_hand(decision)))
        except Error as error:
            return str(error)


def _path_in(file: Path) -> str:
    """Which a run from another folder finds, too: ``../a`` is no end of a path."""
    return Path(os.path.abspath(file)).as_posix() if ".." in file.parts else file.as_posix()
