# SPDX-License-Identifier: BSD-3-Clause
"""Text images of every country, handed to SurfaceTopography in the one form that it reads without loss.

It takes a line that it cannot read for a line of the header: the first one behind a byte-order mark, and each one with
a decimal comma or a damaged number.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from .._io import text
from .._io.readers import head_of
from ..errors import ReadError

_CURVES = re.compile(
    r'\A(?:"\\[?*]?(?:Force file|File) list"|Force-Distance Curve|# TEXT EXPORT)|^# (?:approachID|segmentIndex)', re.M
)
_NUMBERS = 4  # in a row of a picture, or of points: at least 2
_MISSING = {"nan", "bad", "inf", "infinity", "-inf", "+inf"}


@contextmanager
def plain_form(file: Path) -> Iterator[Path]:
    """A file with the same table in UTF-8, with points and tabs; the file itself where that is how it is written, or
    where it is no table."""
    content = _table(file)
    if content is None:
        yield file
        return
    with TemporaryDirectory() as folder:
        other = Path(folder) / f"table{file.suffix}"
        other.write_text(content, encoding="utf-8")
        yield other


def _table(file: Path) -> str | None:
    head = head_of(file)
    if not text.is_text(head):
        return None
    if _CURVES.search(text.decoded(head)):
        raise ReadError(f"{file}: force curves as text, not an image: curves.read reads them")
    raw = file.read_bytes()
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
    for number in range(rows[0], rows[-1]):
        _refuse_damaged(file, number, lines[number])
    return content if content.encode() != raw else None


def _refuse_damaged(file: Path, number: int, line: str) -> None:
    """A row in which some things are numbers and some are not; words alone are a header between two pictures."""
    words = line.split()
    if len(words) < _NUMBERS or text.is_row(line) or line.lstrip().startswith("#"):
        return
    bad = [word for word in words if word.lower() not in _MISSING and not _is_number(word)]
    if bad and len(bad) <= len(words) // 2:
        raise ReadError(f"{file}: line {number + 1} of a table holds {bad[0][:40]!r}, which is no number")


def _is_number(word: str) -> bool:
    return re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", word) is not None
