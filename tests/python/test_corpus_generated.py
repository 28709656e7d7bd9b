# SPDX-License-Identifier: BSD-3-Clause
"""The generated corpus: other people's readers agree with what is written, and the judge notices what is wrong."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("SurfaceTopography")
pytest.importorskip("afmformats")

sys.path.insert(0, str(Path(__file__).parents[1] / "corpus"))

import corpus
import corpus_peers
import generated
from made import Curves, Image, Made, Plane

IMAGES = [name for name in generated.writers() if "image" in name]
CURVES = [name for name in generated.writers() if "curve" in name]


def made(name: str, seed: int, folder: Path) -> Made:
    place = folder / str(seed)
    place.mkdir()
    return generated.writers()[name](np.random.default_rng(seed), place, plain=True)


@pytest.mark.parametrize("name", IMAGES)
def test_other_readers_of_images_agree_with_the_writer(name: str, tmp_path: Path) -> None:
    for seed in (1, 2, 3):
        file = made(name, seed, tmp_path)
        assert isinstance(file.truth, Image)
        due = file.truth.defaults[0]
        size = tuple(n * step for n, step in zip(due.heights.shape, due.pixel, strict=True))
        read = corpus._asked(corpus_peers.IMAGES, file.path)
        if not read:
            pytest.skip(f"no other reader of {name} is installed")
        for peer, channels in read.items():
            assert any(agrees(channel, due, size) for channel in channels), peer  # type: ignore[arg-type]


def agrees(theirs: corpus_peers.Image, due: Plane, size: tuple[float, ...]) -> bool:
    return (
        theirs.heights.shape == due.heights.shape
        and theirs.size == pytest.approx(size, rel=1e-4)
        and theirs.heights == pytest.approx(due.heights, abs=2e-6 * np.abs(due.heights).max(), nan_ok=True)
    )


@pytest.mark.parametrize("name", CURVES)
def test_other_readers_of_curves_agree_with_the_writer(name: str, tmp_path: Path) -> None:
    for seed in (1, 2, 3):
        file = made(name, seed, tmp_path)
        assert isinstance(file.truth, Curves)
        read = corpus._asked(corpus_peers.CURVES, file.path)
        if not read:
            pytest.skip(f"no other reader of {name} is installed")
        first = file.truth.curves[0].parts
        travel = np.ptp(np.concatenate([part.z for part in first]))
        force = np.ptp(np.concatenate([part.force for part in first if part.force is not None]))
        for peer, found in read.items():
            assert isinstance(found, corpus_peers.Curves)
            assert len(found.points) == len(file.truth.curves), peer
            if found.points[0]:
                assert found.points[0] == sum(len(part.z) for part in first), peer
            assert found.travel == pytest.approx(travel, rel=1e-6), peer
            assert found.force == pytest.approx(force, rel=1e-6), peer
