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
