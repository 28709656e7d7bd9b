# SPDX-License-Identifier: BSD-3-Clause
"""Recordings with damaged blocks: every whole block comes back, and what is lost is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from nanotouch import record
from nanotouch.touch.record import Recording, Writer
from test_record import METADATA, columns, same


def places_of_blocks(path: Path) -> list[tuple[int, int]]:
    """Where each block lies in the file, by the mcap package alone."""
    reader = pytest.importorskip("mcap.stream_reader")
    found = []
    with open(path, "rb") as file:
        stream, begin = reader.StreamReader(file, emit_chunks=True), 8
        for part in stream.records:
            if type(part).__name__ == "Chunk":
                end = stream._stream.count
                begin = end - len(part.data) - 53
                found.append((begin, end))
    return found


def in_blocks(path: Path, rows: int, block: int, metadata: dict[str, object] | None = None) -> Recording:
    """A recording of so many rows, written in blocks."""
    recording = Recording(columns(rows), METADATA | (metadata or {}))
    with Writer(path, recording.metadata) as writer:
        for start in range(0, rows, block):
            writer.append(recording[start : start + block].columns)
    return recording


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("kind", ["bit", "zeros", "cut out", "length"])
def test_every_whole_block_comes_back(tmp_path: Path, kind: str, seed: int) -> None:
    """Of 179 blocks some are damaged, at random: all rows of the others are read, and how many are lost is told."""
    path, block, rows = tmp_path / "r.mcap", 40, 178 * 40 + 17
    recording = in_blocks(path, rows, block, {"rows": rows})
    places = places_of_blocks(path)
    assert len(places) == 179
    rng = np.random.default_rng(seed)
    hit = np.sort(rng.choice(178, 1 if seed < 3 else int(rng.integers(2, 30)), replace=False))
    data = bytearray(path.read_bytes())
    for number in hit[::-1]:
        begin, end = places[number]
        at = int(rng.integers(begin + 53, end))
        if kind == "bit":
            data[at] ^= 1 << int(rng.integers(8))
        elif kind == "zeros":
            data[begin + 1 : end] = bytes(end - begin - 1)
        elif kind == "cut out":
            del data[at : at + int(rng.integers(1, end - at + 1))]
        else:
            data[begin + 1 + int(rng.integers(8))] ^= 1 << int(rng.integers(8))
    path.write_bytes(data)
    keep = ~np.isin(np.arange(rows) // block, hit)
    with pytest.warns(UserWarning, match=f"{int(keep.sum())} rows were read"):
        back = record.read(path)
    assert same(recording[keep], back)
    assert back.incomplete is not None
    assert back.incomplete.startswith(
        f"{len(hit)} of 179 blocks {'are' if len(hit) > 1 else 'is'} lost, number {hit[0] + 1}"
    )
    assert f": {len(hit) * block} of {rows} rows, " in back.incomplete
    first = "before the first row" if hit[0] == 0 else f"after {recording.time[hit[0] * block - 1]:.6g} s"
    assert first in back.incomplete
    out, recovered = record.recover(path)
    again = record.read(out)  # whole now, without a warning
    assert same(recovered, again)
    assert again.metadata == METADATA | {"incomplete": back.incomplete, "lost_after": back.metadata["lost_after"]}


def test_what_is_lost_is_estimated_where_no_number_of_rows_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "r.mcap"
    recording = in_blocks(path, 1000, 100)
    begin, end = places_of_blocks(path)[4]
    data = bytearray(path.read_bytes())
    data[(begin + end) // 2] ^= 1
    path.write_bytes(data[: int(0.95 * len(data))])
    with pytest.warns(UserWarning, match="is damaged"):
        back = record.read(path)
    assert back.incomplete == "1 block is lost, number 5: some 100 rows, after 0.0399 s; it ends early"
    assert same(recording[np.r_[0:400, 500 : 100 + len(back)]], back)
    assert len(back) == 800


def test_damaged_metadata_leave_the_rows(tmp_path: Path) -> None:
    path = tmp_path / "r.mcap"
    recording = in_blocks(path, 1000, 100)
    data = path.read_bytes()
    for old, new in ((b'{"tip"', b'{"tip '), (b"alpha_p", b"\xff\xfe\xfdha_p"), (b"\x09\0\0\0nano", b"\xff\0\0\0nano")):
        path.write_bytes(data.replace(old, new))
        with pytest.warns(UserWarning, match="is damaged"):
            back = record.read(path)
        assert same(recording, back)
        assert back.incomplete is not None
        assert "before the first row" in back.incomplete
