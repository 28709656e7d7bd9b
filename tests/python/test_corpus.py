# SPDX-License-Identifier: BSD-3-Clause
"""The verdicts of ``make corpus``: read, refused, wrong; and the real files, where they are, against other readers."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import synthetic

pytest.importorskip("SurfaceTopography")
pytest.importorskip("afmformats")

import corpus
import corpus_peers
from corpus_peers import Image

HEIGHTS = synthetic.asymmetric()
SIDE = (3e-6, 4e-6)


def verdicts(folder: Path) -> dict[str, tuple[str, str]]:
    rows = [corpus.judged(file) for file in sorted(folder.iterdir())]
    return {row.file.name: (row.verdict, row.told) for row in rows if row is not None}


def test_read_refused_and_what_is_no_data(tmp_path: Path) -> None:
    synthetic.write_gwy(tmp_path / "read.gwy", HEIGHTS, SIDE)
    np.save(tmp_path / "given.npy", HEIGHTS * 1e9)
    (tmp_path / "cut.gwy").write_bytes((tmp_path / "read.gwy").read_bytes()[:700])
    (tmp_path / "notes.txt").write_text("nothing was measured on this day\n")
    found = verdicts(tmp_path)
    assert found["read.gwy"] == ("read", "")
    assert found["given.npy"][0] == "read"
    assert "states no scan size" in found["given.npy"][1]
    assert found["cut.gwy"][0] == "refused"
    assert "notes.txt" not in found


@pytest.mark.parametrize(
    ("theirs", "told"),
    [
        (Image("a", HEIGHTS[::-1], SIDE), "upside down"),
        (Image("a", HEIGHTS[:, ::-1], SIDE), "mirrored"),
        (Image("a", 1.1 * HEIGHTS, SIDE), "heights over 4.4e-08 m, ours 4e-08"),
        (Image("a", HEIGHTS, (3e-6, 5e-6)), "scan 5e-06 x 3e-06 m"),
        (Image("a", HEIGHTS[1:], SIDE), "32 x 23 pixels"),
        (Image("a", np.random.default_rng(1).standard_normal(HEIGHTS.shape), SIDE), "another picture"),
    ],
)
def test_a_reader_that_disagrees_is_noticed(
    theirs: Image, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    synthetic.write_gwy(tmp_path / "a.gwy", HEIGHTS, SIDE)
    monkeypatch.setattr(corpus_peers, "IMAGES", {"peer": lambda file: [theirs]})
    verdict, text = verdicts(tmp_path)["a.gwy"]
    assert verdict == "wrong"
    assert text.startswith("peer has ")
    assert told in text


def test_real_files_agree_with_every_other_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    if not synthetic.DATA.is_dir():
        pytest.skip(f"real data not here: {synthetic.DATA}")
    monkeypatch.delitem(corpus_peers.IMAGES, "Gwyddion", raising=False)  # a program of its own, seconds a file
    files = [*(synthetic.DATA / "images").iterdir(), *(synthetic.DATA / "corpus").rglob("*")]
    rows = [row for file in files if file.is_file() and (row := corpus.judged(file)) is not None]
    assert {row.file.name: row.told for row in rows if row.verdict == "wrong"} == {}
