# SPDX-License-Identifier: BSD-3-Clause
"""What a person decided about single curves, in a TOML file that re-runs read again.

::

    ["bad.ibw"]
    exclude = "tip crashed"

    ["day1/b.jpk-force"]               # name of the file, or the end of its path
    contact_point_nm = 812.5           # z of the base, held
    baseline_nm = [900.0, 1400.0]      # z of the base between which the baseline is fitted

    ["map.jpk-force-map#3"]            # one curve of a file that holds several, counted from 0
    exclude = "no contact"
    sha256 = "9f86d0..."               # of the file that was looked at, by `nanotouch review`; all 64 digits

A decision with a ``sha256`` holds for that content alone, and not for another file of the same name.
"""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .._io.files import toml_tables as toml_tables
from .._io.words import told
from .._io.writing import replacing
from ..errors import ReadError
from ..units import from_si, to_si

_NM = 1e-9
_SHOWN = 8  # digits of a hash in a message


@dataclass(frozen=True)
class Decision:
    """About one curve; lengths are z of the base [m]."""

    exclude: str = ""
    contact_point: float | None = None
    baseline: tuple[float, float] | None = None
    sha256: str = field(default="", compare=False)  # of the file it was made on; empty: of any

    def outdated(self, sha256: str) -> str:
        """Why it does not hold for a file with this hash; empty where it does."""
        if not (self.sha256 and sha256) or self.sha256 == sha256:
            return ""
        return (
            f"its decision in the sidecar was made on other content (SHA-256 {self.sha256[:_SHOWN]}..., "
            f"now {sha256[:_SHOWN]}...): review it again"
        )


@dataclass(frozen=True)
class Sidecar:
    """Decisions by ``"file"`` or ``"file#index"``."""

    decisions: Mapping[str, Decision] = field(default_factory=dict)

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Sidecar:
        """Read one; ReadError names what is wrong in it."""
        tables = toml_tables(path)
        return cls({name: _decision(f"{os.fspath(path)}: [{name!r}]", table) for name, table in tables.items()})

    def write(self, path: str | os.PathLike[str]) -> None:
        """As TOML that :meth:`from_toml` reads back, whole or not at all."""
        tables = []
        for name, decision in self.decisions.items():
            lines = [f"[{json.dumps(name)}]"]
            if decision.exclude:
                lines.append(f"exclude = {json.dumps(decision.exclude)}")
            if decision.contact_point is not None:
                lines.append(f"contact_point_nm = {from_si(decision.contact_point, _NM)!r}")
            if decision.baseline is not None:
                low, high = (repr(from_si(end, _NM)) for end in decision.baseline)
                lines.append(f"baseline_nm = [{low}, {high}]")
            if decision.sha256 and len(lines) > 1:
                lines.append(f"sha256 = {json.dumps(decision.sha256)}")
            if len(lines) > 1:
                tables.append("\n".join(lines))
        with replacing(Path(path)) as part:
            part.write_text("\n\n".join(tables) + "\n", encoding="utf-8")

    def of(self, file: Path, index: int) -> Decision:
        """For one curve: what is said of it, or else of its whole file."""
        return self.named(file, index)[1]

    def named(self, file: Path, index: int) -> tuple[str | None, Decision]:
        """The same with the name by which it is said, the longest that fits; None where nothing is."""
        if self.decisions:
            for end in (f"#{index}", ""):
                fitting = [name for name in self.decisions if _is_end_of(name, file, end)]
                if fitting:
                    name = max(fitting, key=len)
                    return name, self.decisions[name]
        return None, Decision()

    def unused(self, files: list[Path]) -> list[str]:
        """Names that are those of no file: surely misspelt."""
        return [
            name for name in self.decisions
            if not any(_is_end_of(n, f) for f in files for n in (name, name.rsplit("#", 1)[0]))
        ]  # fmt: skip


def _is_end_of(name: str, file: Path, end: str = "") -> bool:
    """Of the path as it is given, or of the whole path: a run from another folder means the same curve."""
    return any(
        path == name or path.endswith(f"/{name}")
        for path in (f"{file.as_posix()}{end}", f"{Path(os.path.abspath(file)).as_posix()}{end}")
    )


def _decision(where: str, table: Any) -> Decision:
    known = {"exclude", "contact_point_nm", "baseline_nm"}
    if not isinstance(table, dict) or not table.keys() & known or not table.keys() <= known | {"sha256"}:
        raise ReadError(f"{where}: expected one or more of {', '.join(sorted(known))}")
    exclude = table.get("exclude", "")
    if not isinstance(exclude, str) or ("exclude" in table and not exclude):
        raise ReadError(f"{where}: exclude is {told(exclude)}, expected the reason in words")
    contact = table.get("contact_point_nm")
    if contact is not None and not _is_number(contact):
        raise ReadError(f"{where}: contact_point_nm is {told(contact)}, expected a number")
    ends = table.get("baseline_nm")
    if ends is not None and not (
        isinstance(ends, list) and len(ends) == 2 and all(map(_is_number, ends)) and ends[0] < ends[1]
    ):
        raise ReadError(f"{where}: baseline_nm is {told(ends)}, expected two numbers that grow")
    sha256 = table.get("sha256", "")
    if not isinstance(sha256, str) or ("sha256" in table and not re.fullmatch("[0-9a-f]{64}", sha256)):
        raise ReadError(f"{where}: sha256 is {told(sha256)}, expected 64 hexadecimal digits")
    place, baseline = (
        None if contact is None else to_si(contact, _NM),
        None if ends is None else (to_si(ends[0], _NM), to_si(ends[1], _NM)),
    )
    return Decision(exclude, place, baseline, sha256)


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= sys.float_info.max  # a whole number may be beyond
