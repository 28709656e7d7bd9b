# SPDX-License-Identifier: BSD-3-Clause
"""Mutants of C: where a source may be changed, and the source with all drawn changes in it, each behind a switch.

Positions come from clang's parser, so a changed expression is one of the language and not of its spelling.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from clang import cindex

SWAPPED = {
    "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "+": "-", "-": "+", "*": "/", "/": "*",
    "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "*=": "/=", "/=": "*=",
}  # fmt: skip
SWAPPED_CALLS = {"fmin": "fmax", "fmax": "fmin", "floor": "ceil", "ceil": "floor"}
BINARY = (cindex.CursorKind.BINARY_OPERATOR, cindex.CursorKind.COMPOUND_ASSIGNMENT_OPERATOR)
LITERALS = (cindex.CursorKind.INTEGER_LITERAL, cindex.CursorKind.FLOATING_LITERAL)
CONSTANT = (
    cindex.CursorKind.ENUM_DECL,
    cindex.CursorKind.CASE_STMT,
    cindex.CursorKind.STATIC_ASSERT,
    cindex.CursorKind.PARM_DECL,
)
"""What lies below these has to be a constant, which a switch is not, or says nothing."""


class Mutant(NamedTuple):
    """One change: the bytes from start to end of a file become `text`."""

    path: str
    function: str
    line: int
    start: int
    end: int
    original: str
    text: str
    is_statement: bool = False
    occurrence: int = 1

    @property
    def key(self) -> str:
        """What names it as long as its function keeps the expression, whatever the line."""
        squeezed = (re.sub(r"\s+", " ", part) for part in (self.original, self.text or "(removed)"))
        again = f" (occurrence {self.occurrence})" if self.occurrence > 1 else ""
        return f"{self.path}:{self.function}: " + " -> ".join(squeezed) + again


def of_file(path: Path, root: Path, flags: list[str]) -> list[Mutant]:
    """Return every mutant of the functions in a C source."""
    unit = cindex.Index.create().parse(str(path), flags)
    source = path.read_bytes()
    found: list[Mutant] = []
    for cursor in unit.cursor.get_children():
        is_here = cursor.location.file and Path(cursor.location.file.name) == path
        if cursor.kind == cindex.CursorKind.FUNCTION_DECL and cursor.is_definition() and is_here:
            for start, end, text, is_statement in _changes(cursor, source):
                line = source.count(b"\n", 0, start) + 1
                original = source[start:end].decode()
                name = str(path.relative_to(root))
                found.append(Mutant(name, cursor.spelling, line, start, end, original, text, is_statement))
    return numbered(found)


def numbered(mutants: list[Mutant]) -> list[Mutant]:
    """Tell apart those that change the same expression at several places of one function."""
    seen: Counter[str] = Counter()
    for i, mutant in enumerate(mutants):
        seen[mutant.key] += 1
        mutants[i] = mutant._replace(occurrence=seen[mutant.key])
    return mutants


Change = tuple[int, int, str, bool]


def _changes(cursor: cindex.Cursor, source: bytes) -> Iterator[Change]:
    """Yield start, end, new text and whether it is a whole statement, of all changes below a cursor."""
    for child in cursor.get_children():
        if cursor.kind == cindex.CursorKind.COMPOUND_LITERAL_EXPR and child.kind in LITERALS:
            continue  # the size of its type
        is_static = child.kind == cindex.CursorKind.VAR_DECL and child.storage_class == cindex.StorageClass.STATIC
        is_array = child.kind == cindex.CursorKind.VAR_DECL and "[" in child.type.spelling
        if child.kind in CONSTANT or is_static or is_array:
            if child.kind == cindex.CursorKind.CASE_STMT:
                yield from _changes_of_case(child, source)
            continue
        if cursor.kind == cindex.CursorKind.COMPOUND_STMT:
            yield from _removed(child, source)
        yield from _changes_here(child, source)
        yield from _changes(child, source)


def _changes_of_case(case: cindex.Cursor, source: bytes) -> Iterator[Change]:
    for child in list(case.get_children())[1:]:
        if child.kind == cindex.CursorKind.CASE_STMT:
            yield from _changes_of_case(child, source)
        else:
            yield from _changes_here(child, source)
            yield from _changes(child, source)


def _extent(cursor: cindex.Cursor) -> tuple[int, int]:
    return cursor.extent.start.offset, cursor.extent.end.offset


def _removed(statement: cindex.Cursor, source: bytes) -> Iterator[Change]:
    """A call or an assignment that stands as a statement of its own."""
    start, end = _extent(statement)
    is_assignment = statement.kind in BINARY and statement.type.kind != cindex.TypeKind.VOID
    if (statement.kind == cindex.CursorKind.CALL_EXPR or is_assignment) and source[end : end + 1] == b";":
        yield start, end + 1, "", True


def _changes_here(cursor: cindex.Cursor, source: bytes) -> Iterator[Change]:
    start, end = _extent(cursor)
    text = source[start:end].decode()
    children = list(cursor.get_children())
    if cursor.kind in BINARY and len(children) == 2:
        yield from _swapped(children, (start, end), source)
    elif cursor.kind == cindex.CursorKind.UNARY_OPERATOR and text[:1] in "!-" and text[1:2] not in "-=":
        yield start, end, f"({text[1:]})", False
    elif (
        cursor.kind == cindex.CursorKind.CALL_EXPR
        and cursor.spelling in SWAPPED_CALLS
        and text.startswith(cursor.spelling)
    ):
        yield start, end, SWAPPED_CALLS[cursor.spelling] + text[len(cursor.spelling) :], False
    elif cursor.kind in LITERALS and re.fullmatch(r"[0-9.]+(e[+-]?[0-9]+)?f?", text):
        yield start, end, "1" if float(text.rstrip("f")) == 0.0 else f"(2 * {text})", False


def _swapped(children: list[cindex.Cursor], extent: tuple[int, int], source: bytes) -> Iterator[Change]:
    if any(
        child.type.get_canonical().kind in (cindex.TypeKind.POINTER, cindex.TypeKind.CONSTANTARRAY)
        for child in children
    ):
        swappable = {"==", "!=", "&&", "||"}
    else:
        swappable = set(SWAPPED)
    (_, left_end), (right_start, _) = map(_extent, children)
    if not extent[0] < left_end <= right_start < extent[1]:
        return  # of a macro
    between = source[left_end:right_start].decode()
    operator = between.strip()
    if operator in swappable:
        left, right = source[extent[0] : left_end].decode(), source[right_start : extent[1]].decode()
        yield extent[0], extent[1], left + between.replace(operator, SWAPPED[operator]) + right, False


def with_switches(source: bytes, mutants: dict[int, Mutant]) -> bytes:
    """Return the source with these mutants of it, by their numbers, each in force while its number is switched on."""
    return _switched(source, 0, len(source), sorted(mutants.items(), key=lambda item: (item[1].start, -item[1].end)))


def _switched(source: bytes, start: int, end: int, mutants: list[tuple[int, Mutant]]) -> bytes:
    parts, at = [], start
    while mutants:
        (number, first), *rest = mutants
        inside = [item for item in rest if item[1].start < first.end]
        mutants = rest[len(inside) :]
        parts.append(source[at : first.start])
        kept = _switched(source, first.start, first.end, inside).decode()
        is_on = f"mutant_is_on({number})"
        changed = f"if (!{is_on}) {{ {kept} }}" if first.is_statement else f"({is_on} ? ({first.text}) : ({kept}))"
        parts.append(changed.encode())
        at = first.end
    parts.append(source[at:end])
    return b"".join(parts)
