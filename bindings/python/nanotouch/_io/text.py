# SPDX-License-Identifier: BSD-3-Clause
"""Text of others: byte-order marks, encodings, decimal commas, semicolons.

Everything that a table of numbers is written with is brought to one form, points and tabs, before anybody reads it.
"""

from __future__ import annotations

import codecs
import io
import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))
_ROW = re.compile(r"[-+\d.,;\seE]+|(?i:[-+\d.,;\se]|nan|bad|inf(?:inity)?)+")
_WITH_COMMA = re.compile(
    r"(?P<head>[^:=]*[:=]\s*[-+]?)(?P<before>\d+),(?P<after>\d+)(?P<tail>(?:[eE][-+]?\d+)?\s*[^\d\s,.]*)\s*"
)
_FORTRAN = re.compile(r"(?<![\w.])([-+]?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+))[dD]([-+]?[0-9]+)(?![\w.])")
_NO_NUMBER = re.compile(
    r"(?<![\w.])[-+]?(?:[0-9]+[.,]#(?:QNAN|SNAN|IND|INF|QNB|J)[0-9]*|nan\(\w*\))(?![\w.])", re.IGNORECASE
)
_QUOTED = re.compile(r'"\s*([^",\s]+)\s*"')
_LOOKED_AT = 200  # rows
_TAIL, _ALIKE = 20000, 8  # characters at the end, and rows there, that tell how numbers are written
_SHIFT_JIS_MICRO = "\x83\xca"  # as latin-1


class NotATable(ValueError):
    """What stands there are no numbers that can be told apart."""


def is_text(raw: bytes) -> bool:
    """Whether bytes are text: with a byte-order mark, or without the characters that no text has."""
    if any(raw.startswith(mark) for mark, _ in _MARKS):
        return True
    return not re.search(rb"[\x00-\x08\x0e-\x1f]", raw)


def without_padding(raw: bytes) -> bytes:
    """Without what fills a file up to its block, NULs or the end mark of DOS; bytes of UTF-16 are none."""
    return raw if any(raw.startswith(mark) for mark, _ in _MARKS[1:]) else raw.rstrip(b"\0\x1a")


def decoded(raw: bytes) -> str:
    """By the byte-order mark, else UTF-8, else latin-1; without the mark."""
    for mark, codec in _MARKS:
        if raw.startswith(mark):
            return raw[len(mark) :].decode(codec, "replace")
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("latin-1").replace(_SHIFT_JIS_MICRO, "µ")


def is_row(line: str) -> bool:
    """Whether a line holds nothing but numbers."""
    return bool(line.strip()) and any(c.isdigit() for c in line) and _ROW.fullmatch(line) is not None


def respelled(line: str) -> str:
    """A row as others write it: without quotes around its numbers, ``e`` for Fortran's ``D``, ``nan`` for Microsoft's
    ``1.#QNAN``. Any other line as it is."""
    row = _NO_NUMBER.sub("nan", _FORTRAN.sub(r"\1e\2", _QUOTED.sub(r"\1", line)))
    return row if is_row(row) or set(re.split(r"[\s,;]+", row.strip(" \t,;"))) == {"nan"} else line


def plain(text: str) -> str:
    """The same with decimal points, and with tabs between the numbers of a row; an empty cell becomes ``nan``.

    Raises
    ------
    NotATable
        If points and commas cannot be told apart.
    """
    lines = text.replace("\u2212", "-").splitlines()  # a minus of typography
    sample = [line for line in lines if is_row(line)][:_LOOKED_AT]
    comma = _is_decimal("\n".join(sample))
    cells = ";" if any(";" in line for line in sample) else "\t" if any("\t" in line for line in sample) else ""
    cells = "," if not (comma or cells) and any("," in line for line in sample) else cells
    return "\n".join(_row(line, comma, cells) if is_row(line) else _words(line, comma) for line in lines) + "\n"


def ends_cut(text: str) -> bool:
    """Whether the last number lacks digits: without an end of line after it, and shorter behind its point than all
    others of its column. Where these differ among themselves, nobody can say."""
    if not text or text[-1] in "\r\n":
        return False
    lines = text[-_TAIL:].splitlines()[1 if len(text) > _TAIL else 0 :]
    if not is_row(lines[-1]):
        return False
    rows = [re.split(r"[\s;]+", line.strip()) for line in lines if is_row(line)]
    others = [row[-1] for row in rows[:-1] if len(row) == len(rows[-1])]
    if len(others) < _ALIKE:  # of a small matrix, whose columns are alike
        others = [word for row in rows for word in row][:-1]
    forms = [form for word in others if (form := _form(word)) is not None]  # nan has none
    last = _form(rows[-1][-1])
    if last is None or len(forms) < _ALIKE:
        return False
    decimals, exponents = zip(*forms, strict=True)
    return len(set(decimals)) == 1 and (last[0] < decimals[0] or last[1] < min(exponents))


def _form(word: str) -> tuple[int, int] | None:
    """How many digits stand behind the point, and in the exponent."""
    match = re.fullmatch(r"[-+]?\d*(?:[.,](\d*))?(?:[eE][-+]?(\d*))?", word)
    return None if match is None else (len(match[1] or ""), len(match[2] or ""))


def table(rows: Sequence[str]) -> NDArray[np.float64]:
    """Rows of :func:`plain` as numbers, shape (rows, columns)."""
    try:
        return np.loadtxt(io.StringIO("\n".join(rows)), dtype=np.float64, ndmin=2, comments=None)
    except ValueError as error:
        raise NotATable(str(error)) from None


def _is_decimal(sample: str) -> bool:
    """Whether commas are decimal ones; NotATable where they may be either."""
    if not re.search(r"\d,\d", sample):
        return False
    others = re.search(r"[;\t]|\d[ ]+[-+\d]", sample) is not None and not re.search(r"\d,[ ]", sample)
    if re.search(r"\d\.\d", sample):
        if others and (re.search(r"\d\.\d{3},\d", sample) or re.search(r"\d,\d{3}\.\d", sample)):
            raise NotATable("its numbers have thousands separators")
        return False
    if others:
        return True
    if re.search(r",[-+]?0\d", sample):
        raise NotATable("commas stand both in its numbers and between them")
    return False


def _row(line: str, comma: bool, cells: str) -> str:
    text = line.replace(",", ".") if comma else line
    if not cells:
        return "\t".join(text.split())
    parts = [part.strip() or "nan" for part in text.rstrip().removesuffix(cells).split(cells)]
    return "\t".join(" ".join(part.split()).replace(" ", "\t") for part in parts)


def _words(line: str, comma: bool) -> str:
    """A line of a header. Where no row tells what a comma is, one before other than three digits is a decimal one."""
    if comma:
        return re.sub(r"(?<=\d),(?=\d)", ".", line)
    stated = _WITH_COMMA.fullmatch(line)
    if stated is None:
        return line
    if len(stated["after"]) == 3 and stated["before"] != "0":
        raise NotATable(f"{line.strip()!r}: its comma may be a decimal one, or between thousands")
    return f"{stated['head']}{stated['before']}.{stated['after']}{stated['tail']}"
