# SPDX-License-Identifier: BSD-3-Clause
"""Text images of every country, handed to SurfaceTopography in the one form that it reads without loss.

It takes a line that it cannot read for a line of the header: the first one behind a byte-order mark, and each one with
a decimal comma or a damaged number. Of two lines of a header that differ it takes the last. So a table is looked at
here first: what is damaged, or stated twice, is refused by name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from .._arrays import Floats
from .._io import text
from .._io.readers import head_of
from ..errors import ReadError
from .checks import LENGTHS

_CURVES = re.compile(
    r'\A(?:"\\[?*]?(?:Force file|File) list"|Force-Distance Curve|# TEXT EXPORT)|^# (?:approachID|segmentIndex)', re.M
)
_NUMBERS = 4  # in a row of a picture, or of points: at least 2
_EVEN = 5  # equal steps in a row, which heights do not have by chance
_STATED = re.compile(r"\s*[#%;]*\s*(?P<key>[^\s:=][^:=]{0,40}?)\s*[:=]\s*(?P<value>\S.*)")
_SIZES = ("width", "height", "x-length", "y-length")
_UNITS = ("value units", "z-unit", "unit data")  # of the heights
_DECIDES = (
    *_SIZES, *_UNITS, "channel", "x-unit", "y-unit", "x-pixels", "y-pixels", "nx", "ny", "scale x", "scale y", "unit x",
    "bit2nm", "file format",
)  # fmt: skip
_MISSING = {"nan", "bad", "inf", "infinity", "-inf", "+inf"}


@contextmanager
def plain_form(file: Path) -> Iterator[Path]:
    """A file with the same table in UTF-8, with points and tabs; the file itself where that is how it is written, or
    where it is no table."""
    content = _plain(file)
    if content is None:
        yield file
        return
    with TemporaryDirectory() as folder:
        other = Path(folder) / f"table{file.suffix}"
        other.write_text(content, encoding="utf-8")
        yield other


def check_text(file: Path) -> None:
    """Refuse what a reader of text takes for a table although it is not text: it would leave lines out."""
    if not text.is_text(text.without_padding(file.read_bytes())):
        raise ReadError(f"{file}: holds characters that no text has: it is damaged")


@dataclass
class _Table:
    """What stands before its rows, and its edges; without rows what stands behind the last table."""

    header: dict[str, str] = field(default_factory=dict)
    columns: int = 0
    top: list[list[str]] = field(default_factory=list)  # its first two rows
    left: list[list[str]] = field(default_factory=list)  # its first two columns

    def add(self, words: list[str]) -> None:
        if len(self.top) < 2:
            self.top.append(words)
        self.left.append(words[:2])
        self.columns = len(words)


def _plain(file: Path) -> str | None:
    head = text.without_padding(head_of(file))
    if not text.is_text(head):
        return None
    if _CURVES.search(text.decoded(head)):
        raise ReadError(f"{file}: force curves as text, not an image: curves.read reads them")
    stored = file.read_bytes()
    raw = text.without_padding(stored)
    if not text.is_text(raw):
        return None
    try:
        content = text.plain(text.decoded(raw))
    except text.NotATable as error:
        raise ReadError(f"{file}: {error}") from None
    lines = content.splitlines()
    rows = [number for number, line in enumerate(lines) if text.is_row(line) and len(line.split("\t")) > 1]
    if len(rows) < _NUMBERS:
        return None
    columns = len(lines[rows[0]].split())
    for number, line in enumerate(lines):
        _refuse_damaged(file, number, line, 0 if rows[0] < number < rows[-1] else columns)
    _check(file, _tables(file, lines))
    return content if content.encode() != stored else None


def _refuse_damaged(file: Path, number: int, line: str, columns: int) -> None:
    """A row in which some things are numbers and some are not; words alone are a header between two pictures. Before
    and after the table only what has as many `columns` is a row."""
    words = line.split()
    if len(words) < _NUMBERS or line.lstrip().startswith(("#", "%")) or (columns and len(words) != columns):
        return
    with suppress(ValueError):
        list(map(float, words))
        return
    bad = [word for word in words if word.lower() not in _MISSING and not _is_number(word)]
    if bad and (len(bad) <= len(words) // 2 or not any(c.isalpha() for c in line)):
        raise ReadError(f"{file}: line {number + 1} of a table holds {bad[0][:40]!r}, which is no number")


def _tables(file: Path, lines: list[str]) -> list[_Table]:
    """All tables, in order. A header that states one thing twice is refused, and so are rows of different lengths."""
    found = [_Table()]
    for number, line in enumerate(lines, 1):
        if text.is_row(line):
            words = line.split()
            columns = found[-1].columns
            if len(words) != columns and min(len(words), columns) and max(len(words), columns) >= _NUMBERS:
                told = f"line {number} has {len(words)} numbers, the one before has {columns}"
                raise ReadError(f"{file}: {told}: it is cut off or damaged")
            found[-1].add(words)
            continue
        stated = _STATED.match(line)
        if stated is None or (key := stated["key"].casefold()) not in _DECIDES:
            continue
        if found[-1].columns:
            found.append(_Table())
        _agree(file, stated["key"], found[-1].header.setdefault(key, stated["value"].strip()), stated["value"].strip())
    return found


def _agree(file: Path, key: str, known: str, value: str) -> None:
    if known != value:
        raise ReadError(f"{file}: its header states {key!r} as {known!r} and as {value!r}")


def _check(file: Path, tables: list[_Table]) -> None:
    """Refuse two tables under one name, whose rows would be taken for those of one picture; a size or unit that the
    reader would take in part; places of points among heights."""
    names: list[str] = []
    for table in tables:
        if not table.columns:  # at the end of the file
            for key, value in table.header.items():
                _agree(file, key, tables[-2].header.get(key, value), value)
            continue
        names.append(table.header.get("channel", names[-1] if names else ""))
        if names[-1] in names[:-1]:
            raise ReadError(f"{file}: it holds two tables under the name {names[-1]!r}")
        _check_header(file, table.header)
        _refuse_places(file, table)


def _check_header(file: Path, header: dict[str, str]) -> None:
    for first, second in (("width", "height"), ("x-length", "y-length")):
        if (first in header) != (second in header):
            raise ReadError(f"{file}: its header states only one of {first!r} and {second!r}")
    if not any(key in header for key in ("x-unit", "y-unit", "unit x", "file format")):
        for key in _SIZES:
            if _is_number(header.get(key, "")):
                raise ReadError(f"{file}: its header states {key!r} as {header[key]}, without a unit")
    for key in _UNITS:
        whole = header.get(key, "")
        part = re.match(r"\w*", whole)
        if part is not None and part[0] != whole and part[0] in LENGTHS:
            raise ReadError(f"{file}: its header states {key!r} as {whole!r}, which is no length")


def _refuse_places(file: Path, table: _Table) -> None:
    """A first row or column that counts up evenly beside others that do not: where the points lie, not heights."""
    if min(len(table.left), table.columns) < _NUMBERS:
        return
    for edge, noun in ((table.top, "row"), (list(zip(*table.left, strict=True)), "column")):
        first, second = (np.array([float(word) if _is_number(word) else np.nan for word in line[1:]]) for line in edge)
        if _is_even(first) and not _is_even(second):
            raise ReadError(
                f"{file}: its first {noun} goes from {first[0]:g} to {first[-1]:g} in equal steps: places of points, "
                "not heights; take it out"
            )


def _is_even(values: Floats) -> bool:
    steps = np.diff(values)
    return len(steps) >= _EVEN and steps[0] != 0.0 and bool((np.abs(steps - steps[0]) <= 1e-3 * abs(steps[0])).all())


def _is_number(word: str) -> bool:
    return re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", word) is not None
