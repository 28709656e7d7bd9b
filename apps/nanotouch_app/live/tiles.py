# SPDX-License-Identifier: BSD-3-Clause
"""A surface as tiles, each in a coarse mesh and, where there are more pixels than that, in a fine one. The tiles around
the tip are shown fine. All are sent once: that the tip moves only changes which of them are shown."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch_app.live.arrays import points, quads, to_vtk
from nanotouch_app.live.relief import MOST_PIXELS, coarse

Floats = NDArray[np.float64]

MOST_TRIANGLES = 2**17  # that are shown at once
MOST_FINE = 1024  # pixels to a side of the finest mesh
TILES, DIVISIONS = 12, 16  # tiles to a side; quadrilaterals to a side of a coarse one


class Lattice:
    """Heights [m] at places along y and x [pixels] that need not be evenly apart; linear between them."""

    def __init__(self, heights: Floats, rows: Floats, columns: Floats) -> None:
        self.heights, self.rows, self.columns = heights, rows, columns

    def at(self, row: Any, column: Any) -> Any:
        """Heights at places [pixels]; beyond the rim those of the rim."""
        (j, v), (i, u) = _between(self.rows, row), _between(self.columns, column)
        near = (1 - u) * self.heights[j, i] + u * self.heights[j, i + 1]
        far = (1 - u) * self.heights[j + 1, i] + u * self.heights[j + 1, i + 1]
        return (1 - v) * near + v * far


def _between(places: Floats, at: Any) -> tuple[Any, Any]:
    where = np.interp(at, places, np.arange(len(places)))
    below = np.minimum(where.astype(int), len(places) - 2)
    return below, where - below


def _whole(heights: Floats) -> Lattice:
    """A place for each pixel."""
    rows, columns = (np.arange(length, dtype=np.float64) for length in heights.shape)
    return Lattice(heights, rows, columns)


def _edges(pixels: int, tiled: bool) -> list[int]:
    """Pixels at which tiles meet; the last tile may be smaller."""
    last = pixels - 1
    return [*range(0, last, -(-last // TILES)), last] if tiled else [0, last]


class Mesh:
    """One resolution of all tiles: where its quadrilaterals meet, and which of them are whose."""

    def __init__(self, lattice: Lattice, parts: dict[tuple[int, int], tuple[slice, slice]]) -> None:
        self.lattice, self.parts = lattice, parts
        self.data: dict[tuple[int, int], Any] = {}

    def build(self, vtk: Any, spacing: tuple[float, float], scale: float, rim: Lattice) -> None:
        """Make the meshes; their rims are as high as another lattice, so that tiles of both kinds meet.

        ``spacing`` of pixels along y and x, and ``scale`` of heights, in scene units.
        """
        grid = self.lattice
        y, x = (grid.rows + 0.5) * spacing[0], (grid.columns + 0.5) * spacing[1]
        slope_y, slope_x = np.gradient(grid.heights * scale, y, x)
        normals = np.stack([-slope_x, -slope_y, np.ones_like(slope_x)], axis=-1).astype(np.float32)
        normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
        for tile, (rows, columns) in self.parts.items():
            part = grid.heights[rows, columns].copy()
            if rim is not grid:
                for k in (0, -1):
                    part[k] = rim.at(grid.rows[rows][k], grid.columns[columns])
                    part[:, k] = rim.at(grid.rows[rows], grid.columns[columns][k])
            across, along = np.meshgrid(x[columns], y[rows])
            mesh = vtk.vtkPolyData()
            mesh.SetPoints(points(vtk, np.stack([across, along, part * scale], axis=-1)))
            mesh.SetPolys(quads(vtk, *part.shape))
            mesh.GetPointData().SetNormals(to_vtk(normals[rows, columns].reshape(-1, 3)))
            self.data[tile] = mesh

    def colour(self, values: Lattice) -> None:
        """By values at the same places."""
        for tile, mesh in self.data.items():
            mesh.GetPointData().SetScalars(to_vtk(values.heights[self.parts[tile]].ravel()))


class Tiles:
    """Heights over their lowest one [m] in tiles; ``spacing`` and ``scale`` as in :meth:`Mesh.build`. No colour before
    :meth:`colour`."""

    def __init__(self, vtk: Any, heights: Floats, spacing: tuple[float, float], scale: float) -> None:
        tiled = max(heights.shape) > MOST_PIXELS
        self.edges = [_edges(pixels, tiled) for pixels in heights.shape]
        self.shape = (len(self.edges[0]) - 1, len(self.edges[1]) - 1)
        fine, coarse_one = _whole(heights), self._thinned(heights) if tiled else _whole(heights)
        steps = [(len(places) - 1) // count
                 for places, count in zip((coarse_one.rows, coarse_one.columns), self.shape, strict=True)]  # fmt: skip
        self.coarse = Mesh(coarse_one, {
            (i, j): (slice(i * steps[0], (i + 1) * steps[0] + 1), slice(j * steps[1], (j + 1) * steps[1] + 1))
            for i, j in np.ndindex(self.shape)
        })  # fmt: skip
        rows, columns = self.edges
        self.side = self._side(steps) if tiled else 0
        """tiles to a side that are shown fine"""
        self.fine = Mesh(fine, {
            (i, j): (slice(rows[i], rows[i + 1] + 1), slice(columns[j], columns[j + 1] + 1))
            for i, j in np.ndindex(self.shape) if self.side
        })  # fmt: skip
        for mesh in (self.coarse, self.fine):
            mesh.build(vtk, spacing, scale, coarse_one)

    def _thinned(self, values: Floats) -> Lattice:
        """Means over about as many pixels as lie between the places of the coarse meshes."""
        means, merged = coarse(values, TILES * DIVISIONS)
        y, x = ((np.arange(length, dtype=np.float64) + 0.5) * merged - 0.5 for length in means.shape)
        rows, columns = (
            np.concatenate([[0.0], *(np.linspace(a, b, min(DIVISIONS, edges[1]) + 1)[1:]
                                     for a, b in itertools.pairwise(edges))]) for edges in self.edges
        )  # fmt: skip
        return Lattice(Lattice(means, y, x).at(rows[:, None], columns), rows, columns)

    def _side(self, steps: list[int]) -> int:
        own = 2 * steps[0] * steps[1]
        more = 2 * self.edges[0][1] * self.edges[1][1] - own
        room = MOST_TRIANGLES - own * self.shape[0] * self.shape[1]
        return min(math.isqrt(room // more), *self.shape) if more > 0 else 0

    def colour(self, values: Floats) -> None:
        """By values of each pixel."""
        self.coarse.colour(self._thinned(values) if self.side else _whole(values))
        self.fine.colour(_whole(values))

    def near(self, row: float, column: float) -> set[tuple[int, int]]:
        """The tiles that are shown fine for a tip at a place [pixels]."""
        if not self.side:
            return set()
        starts = []
        for at, edges, count in zip((row, column), self.edges, self.shape, strict=True):
            start = round(float(np.interp(at, edges, np.arange(count + 1))) - 0.5 * self.side)
            starts.append(min(max(start, 0), count - self.side))
        return {(starts[0] + i, starts[1] + j) for i, j in np.ndindex(self.side, self.side)}

    def cover(self, row: Any, column: Any) -> Any:
        """Not below any mesh at places [pixels]: what is laid on the surface lies on this [m]."""
        return np.maximum(self.fine.lattice.at(row, column), self.coarse.lattice.at(row, column))
