# SPDX-License-Identifier: BSD-3-Clause
"""Text images of every country, handed to SurfaceTopography in the one form that it reads without loss.

It takes a line that it cannot read for a line of the header: the first one behind a byte-order mark, and each one with
a decimal comma or a damaged number. Of two lines of a header that differ it takes the last. So a table is looked at
here first: what is damaged, or stated twice, is refused by name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from .._arrays import Floats
from .._io import text
from .._io.readers import head_of
from .._io.words import counted
from ..errors import ReadError
from .checks import LENGTHS
from .text_dialects import translated

_CURVES = re.compile(
    r'\A(?:"\\[?*]?(?:Force file|File) list"|Force-Distance Curve|# TEXT EXPORT)|^# (?:approachID|segmentIndex)', re.M
)
_NUMBERS = 4  # in a row of a picture, or of points: at least 2
_EVEN = 5  # equal steps in a row, which heights do not have by chance
_STATED = re.compile(r"\s*[#%;]*\s*(?P<key>[^\s:=][^:=]{0,40}?)\s*[:=]\s*(?P<value>\S.*)")
_STATED_LENGTH = re.compile(r"([0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(\S+)")
_SIZES = ("width", "height", "x-length", "y-length")
_UNITS = ("value units", "z-unit", "unit data")  # of the heights
_DECIDES = (
    *_SIZES, *_UNITS, "channel", "x-unit", "y-unit", "x-pixels", "y-pixels", "nx", "ny", "scale x", "scale y", "unit x",
    "bit2nm", "file format",
)  # fmt: skip
_MISSING = {"bad", *(sign + word for sign in ("", "-", "+") for word in ("nan", "inf", "infinity"))}
_LEFT_EMPTY = {"n/a", "#n/a", "na", "null", "none", "x", "-", "--", "---", "void", "missing", "undefined", "*"}


@dataclass(frozen=True)
class Plain:
    """A file with the table in UTF-8, with points and tabs: the file itself where that is how it is written, or where
    it is no table."""

    file: Path
    sizes: dict[str, tuple[float, float]] = field(default_factory=dict)  # (Ly, Lx) of each channel [m]
    notes: tuple[str, ...] = ()


@contextmanager
def plain_form(file: Path) -> Iterator[Plain]:
    """What is read in place of the file."""
    content, sizes, notes = _plain(file)
    if content is None:
        yield Plain(file, sizes, notes)
        return
    with TemporaryDirectory() as folder:
        other = Path(folder) / f"table{file.suffix}"
        other.write_text(content, encoding="utf-8")
        yield Plain(other, sizes, notes)


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
    runs: list[int] = field(default_factory=list)  # rows between empty lines

    def add(self, words: list[str], is_next: bool) -> None:
        if is_next and self.runs:
            self.runs[-1] += 1
        else:
            self.runs.append(1)
        if len(self.top) < 2:
            self.top.append(words)
        self.left.append(words[:2])
        self.columns = len(words)


_NOTHING: tuple[str | None, dict[str, tuple[float, float]], tuple[str, ...]] = (None, {}, ())


def _plain(file: Path) -> tuple[str | None, dict[str, tuple[float, float]], tuple[str, ...]]:
    """What the table is in the plain form, None where it is so already; its sizes; what was supplied."""
    head = text.without_padding(head_of(file))
    if not text.is_text(head):
        return _NOTHING
    if _CURVES.search(text.decoded(head)):
        raise ReadError(f"{file}: force curves as text, not an image: curves.read reads them")
    stored = file.read_bytes()
    raw = text.without_padding(stored)
    if not text.is_text(raw):
        return _NOTHING
    decoded = text.decoded(raw)
    written = decoded.splitlines()
    spelled = [text.respelled(line) for line in written]
    told = _told_missing(written, spelled)
    try:
        lines = text.plain("\n".join(spelled)).splitlines()
    except text.NotATable as error:
        raise ReadError(f"{file}: {error}") from None
    lines, notes = translated(file, [_without_comment(line) for line in lines])
    rows = [number for number, line in enumerate(lines) if text.is_row(line) and len(line.split("\t")) > 1]
    if len(rows) < _NUMBERS:
        return _NOTHING
    columns = len(lines[rows[0]].split())
    lines, emptied = _with_empty_rows(lines, rows, columns)
    notes += told + emptied
    for number, line in enumerate(lines):
        _refuse_damaged(file, number, line, columns, rows[0] < number < rows[-1])
    tables = _tables(file, lines)
    if text.ends_cut(decoded):
        raise ReadError(f"{file}: its last number, {lines[rows[-1]].split()[-1]}, is cut off")
    _check(file, tables)
    content = "\n".join(lines) + "\n"
    return content if content.encode() != stored else None, _sizes(tables), notes


def _without_comment(line: str) -> str:
    """A row without the comment behind its numbers: the reader would take all of it for a line of the header."""
    numbers = re.split(r"\s+[#%]", line, maxsplit=1)[0]
    return numbers if text.is_row(numbers) else line


def _sizes(tables: list[_Table]) -> dict[str, tuple[float, float]]:
    """Of those that state both sides with a unit; SurfaceTopography takes none of them without one of the heights."""
    found = {}
    for table in tables:
        sides = [_STATED_LENGTH.fullmatch(table.header.get(key, "")) for key in ("height", "width")]
        lengths = [float(m[1]) * LENGTHS[m[2]] for m in sides if m is not None and m[2] in LENGTHS]
        if len(lengths) == 2:
            found[table.header.get("channel", "Default")] = (lengths[0], lengths[1])
    return found


def _told_missing(written: list[str], spelled: list[str]) -> tuple[str, ...]:
    """A note of what stands for a number that could not be calculated."""
    words = [
        word for old, new in zip(written, spelled, strict=True) if old != new for word in re.split(r"[\s;,]+", old)
    ]
    found = [word for word in words if "#" in word or "(" in word]
    return (f"{counted(len(found), 'number')} of its table written as {found[0][:20]}: missing",) if found else ()


def _with_empty_rows(lines: list[str], rows: list[int], columns: int) -> tuple[list[str], tuple[str, ...]]:
    """The lines with ``nan`` in each row of empty cells, and a note of them; the reader would leave such a row out."""
    kept = list(lines)
    for number, line in enumerate(lines):
        if line and not line.strip("\t;, ") and max(map(line.count, "\t;,")) in (columns - 1, columns):
            kept[number] = "\t".join(columns * ["nan"])
        elif _is_missing_row(line.replace(",", " ").replace(";", " ")):
            lines[number] = kept[number] = "\t".join(re.split(r"[\s,;]+", line.strip(" \t,;")))
    count = sum(a != b for a, b in zip(lines, kept, strict=True))
    return kept, ((f"{counted(count, 'row')} of empty cells: missing",) if count else ())


def _refuse_damaged(file: Path, number: int, line: str, columns: int, inside: bool) -> None:
    """A row in which something is no number. Words alone may be a header: between two pictures if they are not as many
    as the `columns`, before and after the table if they are not all the same, nor what is written in empty cells."""
    words = line.split()
    is_comment = line.lstrip().startswith(("#", "%")) and not all(word.startswith("#") for word in words)
    if len(words) < _NUMBERS or is_comment or (not inside and len(words) != columns):
        return
    bad = [word for word in words if word.lower() not in _MISSING and not _is_number(word)]
    few = len(bad) <= len(words) // 2 or not any(c.isalpha() for c in line)
    empty = len(set(bad)) == 1 or {word.casefold() for word in bad} <= _LEFT_EMPTY
    whole = len(words) == columns and (empty or (inside and _STATED.fullmatch(line) is None))
    if bad and (few or whole):
        raise ReadError(f"{file}: line {number + 1} of a table holds {bad[0][:40]!r}, which is no number")


def _tables(file: Path, lines: list[str]) -> list[_Table]:
    """All tables, in order. A header that states one thing twice is refused, and so are rows of different lengths."""
    found, is_next = [_Table()], False
    for number, line in enumerate(lines, 1):
        if text.is_row(line) or _is_missing_row(line):
            words = line.split()
            columns = found[-1].columns
            if len(words) != columns and min(len(words), columns) and max(len(words), columns) >= _NUMBERS:
                told = f"line {number} has {len(words)} numbers, the one before has {columns}"
                raise ReadError(f"{file}: {told}: it is cut off or damaged")
            found[-1].add(words, is_next)
            is_next = True
            continue
        is_next = False
        stated = _STATED.match(line)
        if stated is None or (key := stated["key"].casefold()) not in _DECIDES:
            continue
        if re.search(r"\d,\d", stated["value"]) and key not in ("channel", "file format"):
            raise ReadError(f"{file}: its header states {stated['key']!r} as {stated['value']!r}: a comma in a number")
        if found[-1].columns:
            found.append(_Table())
        _agree(file, stated["key"], found[-1].header.setdefault(key, stated["value"].strip()), stated["value"].strip())
    return found


def _is_missing_row(line: str) -> bool:
    words = line.casefold().split()
    return len(words) >= _NUMBERS and set(words) <= _MISSING


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
        if sum(run >= _NUMBERS for run in table.runs) > 1 and table.columns >= _NUMBERS:
            told = " and ".join(map(str, table.runs[:8]))
            raise ReadError(f"{file}: tables of {told} rows under one header: which of them is the image? Split them")
        names.append(table.header.get("channel", names[-1] if names else ""))
        if names[-1] in names[:-1]:
            raise ReadError(f"{file}: it holds two tables under the name {names[-1]!r}")
        _check_header(file, table.header)
        for keys, held in ((("x-pixels", "nx"), table.columns), (("y-pixels", "ny"), len(table.left))):
            for key in keys:
                if table.header.get(key, str(held)) != str(held):
                    raise ReadError(f"{file}: its header states {key!r} as {table.header[key]}, its table has {held}")
        _refuse_places(file, table)
    _check_lengths(file, [table.header for table in tables if table.columns])


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


def _check_lengths(file: Path, headers: list[dict[str, str]]) -> None:
    """Refuse a file of which no table is in a unit of length: the reader would say that there is none."""
    units = [next((header[key] for key in _UNITS if key in header), "m") for header in headers]
    if not any(unit in LENGTHS or re.match(r"\w*", unit)[0] in LENGTHS for unit in units):  # type: ignore[index]
        told = ", ".join(
            f"{header.get('channel', 'its table')!r} is in {unit!r}"
            for header, unit in zip(headers, units, strict=True)
        )
        raise ReadError(f"{file}: {told}, not a length ({', '.join(LENGTHS)}), so it holds no heights")


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
    return re.fullmatch(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?", word) is not None
