# SPDX-License-Identifier: BSD-3-Clause
"""Tables of text: what is damaged, or stated twice, is refused by name; nothing is left out or taken in part."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from nanotouch import images
from nanotouch.errors import ReadError

pytest.importorskip("SurfaceTopography")

Z = np.round(np.random.default_rng(1).normal(size=(12, 10)) * 5, 4)  # nm, from the upper edge
ROWS = ["\t".join(f"{v:.4f}" for v in row) for row in Z]
HEADER = "# Channel: Height\n# Width: 3 um\n# Height: 3.6 um\n# Value units: nm\n"
WHOLE = HEADER + "\n".join(ROWS) + "\n"


def holed(number: int, word: str) -> str:
    """With a word in the place of a number."""
    rows = list(ROWS)
    rows[number] = rows[number].replace(rows[number].split()[3], word)
    return HEADER + "\n".join(rows) + "\n"


SAME: dict[str, Callable[[], bytes]] = {
    "as it is": lambda: WHOLE.encode(),
    "NULs at the end": lambda: WHOLE.rstrip().encode() + bytes(700),
    "end mark of DOS": lambda: WHOLE.rstrip().encode() + b"\x1a",
    "one line twice": lambda: WHOLE.replace("# Width: 3 um", "# Width: 3 um\n# Width: 3 um").encode(),
    "commas in the header alone": lambda: WHOLE.replace("3.6 um", "3,6 um").replace("3 um", "3,0 um").encode(),
    "minus of typography": lambda: WHOLE.replace("-", "\u2212").encode(),
    "two tables": lambda: (WHOLE + WHOLE.replace("Channel: Height", "Channel: Back")).encode(),
}
REFUSED = {
    "-- in the first row": (holed(0, "--"), "line 5 of a table holds '--'"),
    "-- in the last row": (holed(11, "--"), "line 16 of a table holds '--'"),
    "a first row of --": (HEADER + "\t".join(10 * ["--"]) + "\n" + "\n".join(ROWS), "line 5 of a table holds '--'"),
    "NUL within": (WHOLE.replace("\t", "\t\0", 1), "characters that no text has"),
    "two widths": (WHOLE.replace("# Width: 3 um", "# Width: 3 um\n# Width: 4 um"), "'Width' as '3 um' and as '4 um'"),
    "another height at the end": (WHOLE + "Height: 99 um\n", "'height' as '3.6 um' and as '99 um'"),
    "no unit of the width": (WHOLE.replace("3.6 um", "3.6").replace("3 um", "3"), "'width' as 3, without a unit"),
    "a width alone": (WHOLE.replace("# Height: 3.6 um\n", ""), "only one of 'width' and 'height'"),
    "thousands": (WHOLE.replace("3.6 um", "3,600 nm"), "a decimal one, or between thousands"),
    "places of columns": (
        HEADER + "\t".join(f"{0.3 * i:.1f}" for i in range(10)) + "\n" + "\n".join(ROWS),
        "first row",
    ),
    "places of rows": (HEADER + "\n".join(f"{i}\t{row}" for i, row in enumerate(ROWS)), "first column"),
    "the table twice": (WHOLE + WHOLE, "two tables under the name 'Height'"),
    "cut off": (WHOLE[:-20], "line 16 has 8 numbers, the one before has 10"),
    "heights per volt": (WHOLE.replace("units: nm", "units: nm/V"), "'nm/V', which is no length"),
}


def emptied(number: int, *words: str) -> str:
    """With words in the place of a whole row."""
    rows = list(ROWS)
    rows[number] = "\t".join(words if len(words) == 10 else 10 * words)
    return HEADER + "\n".join(rows) + "\n"


FORTRAN = HEADER + "\n".join("\t".join(f"{v:.6e}".replace("e", "D") for v in row) for row in Z) + "\n"
QUOTED = HEADER + "\n".join(",".join(f'"{v:.4f}"' for v in row) for row in Z) + "\n"
SAME |= {"exponents of Fortran": FORTRAN.encode, "numbers in quotes": QUOTED.encode}
REFUSED |= {
    f"{name} in row {row}": (emptied(row, *words), f"line {row + 5} of a table holds '{words[0]}'")
    for name, words in {"N/A": ("N/A",), "#N/A": ("#N/A",), "NULL": ("NULL",), "x": ("x",)}.items()
    for row in (0, 5, 11)
} | {
    "a row of words": (
        emptied(5, *["no", "number", "is", "in", "this", "whole", "row", "of", "words"], "at"),
        "line 10 of .* 'no'",
    ),
    "underscores of Python": (holed(5, "-37_1.7"), "line 10 of a table holds '-37_1.7'"),
    "a row with underscores of Python": (emptied(5, "1_000"), "line 10 of a table holds '1_000'"),
    "inf with more behind it": (holed(5, "inf_"), "line 10 of a table holds 'inf_'"),
    "digits of another script": (emptied(5, "\u0661\u0662"), "line 10 of a table holds"),
}


@pytest.mark.parametrize("row", [0, 5, 11])
@pytest.mark.parametrize("word", ["1.#QNAN", "-1.#IND", "-nan(ind)", "1.#INF00", "nan", "-nan", ""])
def test_a_row_of_what_is_no_number_is_missing(word: str, row: int, tmp_path: Path) -> None:
    """It keeps its place, so that pixels keep their size."""
    (tmp_path / "t.txt").write_text(emptied(row, word), encoding="utf-8")
    found = images.read(tmp_path / "t.txt")
    assert found.pixel_size == pytest.approx((0.3e-6, 0.3e-6))
    np.testing.assert_array_equal(np.flatnonzero(found.mask[::-1].all(axis=1)), [row])
    assert found.mask.sum() == 10
    assert "missing" in " ".join(found.notes)


def test_a_row_of_what_is_no_number_between_commas_is_missing(tmp_path: Path) -> None:
    (tmp_path / "t.txt").write_text(emptied(5, "1.#QNAN").replace("\t", ","), encoding="utf-8")
    found = images.read(tmp_path / "t.txt")
    assert found.shape == (12, 10)
    assert found.mask[6].all()
    assert found.mask.sum() == 10
    assert "10 numbers of its table written as 1.#QNAN: missing" in found.notes


@pytest.mark.parametrize("name", SAME)
def test_a_table_is_read_whole(name: str, tmp_path: Path) -> None:
    (tmp_path / "t.txt").write_bytes(SAME[name]())
    found = images.read(tmp_path / "t.txt", "Height")
    np.testing.assert_allclose(found.heights[::-1], Z * 1e-9, rtol=1e-12)
    assert found.size == pytest.approx((3.6e-6, 3e-6))


@pytest.mark.parametrize("name", REFUSED)
def test_a_table_that_cannot_be_believed_is_refused(name: str, tmp_path: Path) -> None:
    content, reason = REFUSED[name]
    (tmp_path / "t.txt").write_text(content, encoding="utf-8")
    with pytest.raises(ReadError, match=reason):
        images.read(tmp_path / "t.txt")


def test_a_plane_is_no_row_of_places(tmp_path: Path) -> None:
    """Its rows count up evenly, too, but all of them do."""
    y, x = np.mgrid[:8, :9]
    np.savetxt(tmp_path / "t.txt", 0.5 * x + 0.25 * y, fmt="%.3f")
    assert images.read(tmp_path / "t.txt", pixel_size=1e-8, z_unit="nm").shape == (8, 9)
