# SPDX-License-Identifier: BSD-3-Clause
"""The drawn surface: its tiles meet, those around the tip are fine, and a moved tip sends nothing of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app import view
from nanotouch_app.common import samples
from nanotouch_app.live import film, parts, tiles
from nanotouch_app.live.subject import of_preset


@pytest.fixture(scope="module")
def vtk_works() -> None:
    """Skip where VTK cannot render."""
    pytest.importorskip("vtkmodules")
    works, reason = view.probe()
    if not works:
        pytest.skip(reason)


def times(stage: Any) -> list[int]:
    """When each part of the surface was changed last."""
    meshes = [*stage.tiles.coarse.data.values(), *stage.tiles.fine.data.values()]
    return [part.GetMTime() for mesh in meshes for part in (mesh, mesh.GetPoints(), mesh.GetPolys())]


def shown(stage: Any) -> int:
    """Triangles that are drawn of the surface."""
    return sum(2 * actor.GetMapper().GetInput().GetNumberOfPolys() for actor in stage.surface if actor.GetVisibility())


@pytest.mark.usefixtures("vtk_works")
def test_a_moving_tip_rebuilds_nothing_of_the_surface(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(film, "RATE", 4.0)
    studio = film.Studio(of_preset("silicon_in_air"))
    try:
        stage = studio.picture.stage
        assert 0 < shown(stage) <= 2**17
        made = times(stage)
        studio.host.advance(0.02)
        studio.look()
        before = stage.apex(studio.picture.seen)
        pictures = list(studio.play([(0.3, {}), (0.8, {"do": "press", "on": True})]))
        assert times(stage) == made
        assert stage.apex(studio.picture.seen)[2] < before[2]
        assert pictures[-1].shape == (900, 1440, 3)
        assert np.any(pictures[-1] != pictures[0])
        x, y = stage.dragged(before, stage.pixel(before + np.array([0.05, 0.02, 0.0])) - stage.pixel(before))
        assert (x, y) == (pytest.approx(0.05 * stage.unit, rel=0.05), pytest.approx(0.02 * stage.unit, rel=0.05))
    finally:
        studio.close()


@pytest.mark.usefixtures("vtk_works")
def test_a_large_surface_is_fine_around_the_tip_and_nothing_of_it_is_sent_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(film, "RATE", 4.0)
    rough = samples.rough(pixels=1024)
    studio = film.Studio(replace(of_preset("rough"), topography=samples.rough(pixels=128)))
    try:
        stage, picture = studio.picture.stage, studio.picture
        picture.lay(rough.heights, np.asarray(rough.pixel_size))
        stage = picture.stage
        stage.mount(20e-9, 0.3, "cone")
        made, fine = times(stage), []
        for x in (0.1, 0.5, 0.93):
            for _ in range(2):
                picture.seen.frame = np.zeros(1, nt.frames.FRAME)[0]
                picture.seen.frame["tip_position"] = np.array([x, 0.4, 0.0]) * 1e-6
                stage.update(picture.seen)
                if x > 0.1:
                    assert shown(stage) <= 2**17
            fine.append(stage.near)
            assert all(stage.fine[tile].GetVisibility() and not stage.coarse[tile].GetVisibility() for tile in fine[-1])
            tile, pixel = min(fine[-1]), stage._pixels(x * 1e-6, 0.4e-6)
            least, most = (np.array(edge) * stage.tiles.edges[0][1] for edge in (tile, max(fine[-1])))
            assert np.all(least <= pixel)
            assert np.all(pixel <= most + stage.tiles.edges[0][1])
        assert times(stage) == made
        assert len(set.union(*fine)) > len(fine[0])
    finally:
        studio.close()


@pytest.mark.parametrize("shape", [(512, 512), (1024, 1024), (300, 1024), (1000, 40), (257, 3), (64, 80)])
def test_tiles_meet_without_a_gap(shape: tuple[int, int]) -> None:
    vtk, numpy_support = parts.load(), pytest.importorskip("vtkmodules.util.numpy_support")
    heights = np.random.default_rng(1).random(shape)
    made = tiles.Tiles(vtk, heights, (1e-3, 1e-3), 0.1)
    made.colour(heights)
    own = {tile: mesh.GetNumberOfPolys() * 2 for tile, mesh in made.coarse.data.items()}
    for row, column in ((0, 0), (shape[0] // 2, shape[1] // 3), (shape[0], shape[1])):
        near = made.near(row, column)
        assert len(near) == made.side**2
        total = sum(2 * made.fine.data[t].GetNumberOfPolys() if t in near else own[t] for t in own)
        assert total <= tiles.MOST_TRIANGLES
    for mesh in (made.coarse, made.fine):
        for tile, data in mesh.data.items():
            rows, columns = mesh.parts[tile]
            y, x = mesh.lattice.rows[rows], mesh.lattice.columns[columns]
            points = numpy_support.vtk_to_numpy(data.GetPoints().GetData())
            z = points[:, 2].reshape(len(y), len(x))
            assert z[0] == pytest.approx(0.1 * made.coarse.lattice.at(y[0], x), abs=1e-6)
            assert z[:, -1] == pytest.approx(0.1 * made.coarse.lattice.at(y, x[-1]), abs=1e-6)
    assert (max(shape) > 256) == (made.side > 0)
