# SPDX-License-Identifier: BSD-3-Clause
"""What tears off in many curves: forces and contour lengths of all ruptures, and their histograms."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import numpy as np

from .._io.drawing import BLUE, VERMILION, new_figure, saved
from .._io.words import counted
from .._io.writing import replacing
from ..curves import Chain, analyse, chains, read
from ..errors import Error
from ..fit.models import Floats
from ..fit.show import with_sigma
from ..units import engineering
from .files import WITHOUT, Summary
from .sidecar import Sidecar
from .table import by_hand

HEADERS = (
    "file", "curve", "z [m]", "force [N]", "slope [N/m]", "step [N]", "contour_length [m]", "contour_length sigma [m]",
    "contour_length step [m]", "persistence_length [m]", "persistence_length sigma [m]",
)  # fmt: skip


@dataclass(frozen=True)
class Pulls:
    """The ruptures of many curves.

    Attributes
    ----------
    curves : list of (str, int, tuple of Chain)
        File, number of the curve in it, its ruptures from the sample outwards.
    without : list of (str, int, str)
        Curves whose ruptures could not be fitted, and why.
    """

    curves: list[tuple[str, int, tuple[Chain, ...]]]
    without: list[tuple[str, int, str]]

    @property
    def force(self) -> Floats:
        """Of each rupture [N]."""
        return np.array([chain.rupture.force for _, _, found in self.curves for chain in found])

    @property
    def contour_length(self) -> Floats:
        """Those that their curves determine [m]."""
        every = np.array([chain.contour_length for _, _, found in self.curves for chain in found])
        return np.asarray(every[np.isfinite(every)])

    @property
    def length_step(self) -> Floats:
        """By how much the contour length grows from one rupture of a pull to the next [m]."""
        every = np.array([step for _, _, found in self.curves for step in _steps(found)])
        return np.asarray(every[np.isfinite(every)])

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """A row for each rupture; an empty cell where its curve tells no length."""
        options: dict[str, Any] = {"encoding": "utf-8", "errors": "backslashreplace", "newline": ""}
        with replacing(Path(path)) as part, part.open("w", **options) as to:
            table = csv.writer(to)
            table.writerow(HEADERS)
            for file, index, found in self.curves:
                for chain, step in zip(found, _steps(found), strict=True):
                    lengths = (chain.contour_length, chain.contour_length_sigma, step, chain.segment_length,
                               chain.segment_length_sigma)  # fmt: skip
                    table.writerow((file, index, *chain.rupture, *("" if math.isnan(one) else one for one in lengths)))

    def draw(self, save: str | os.PathLike[str] | None = None) -> Any:
        """Histograms of force, contour length and its steps; also written to `save`, whole or not at all."""
        figure = new_figure(10.5, 3.4)
        shown = (("rupture force", "N", self.force), ("contour length $L_c$", "m", self.contour_length),
                 ("step of $L_c$ in a pull", "m", self.length_step))  # fmt: skip
        for panel, (name, unit, values) in zip(figure.subplots(1, 3), shown, strict=True):
            prefixed, scale = engineering(unit, values if values.size else np.ones(1))
            panel.set_xlabel(f"{name} ({prefixed})")
            panel.set_ylabel("ruptures")
            panel.set_title(f"{values.size} values" if values.size else "none is determined", fontsize=9)
            if values.size:
                panel.hist(values * scale, bins="auto" if values.size > 1 else 1, color=BLUE, alpha=0.6)
                panel.axvline(float(np.median(values)) * scale, color=VERMILION, lw=1.5, label="median")
                panel.legend(fontsize=8)
        return saved(figure, save, dpi=130)

    def __str__(self) -> str:
        said = f"{counted(self.force.size, 'rupture')} of {counted(len(self.curves), 'curve')}"
        for name, unit, values in (("force", "N", self.force), ("contour length", "m", self.contour_length)):
            said += f", {name} {with_sigma(float(np.median(values)), 0.0, unit)}" if values.size else f", no {name}"
        return f"{said} (medians; {counted(self.contour_length.size, 'length')} determined)"


def pulls(
    summary: Summary,
    *,
    segment_length: float | Literal["free"] | None = None,
    sidecar: str | os.PathLike[str] | None = None,
    reading: Mapping[str, Any] | None = None,
    progress: Callable[[float], None] | None = None,
    **settings: Any,
) -> Pulls:
    """The ruptures of every curve that a run fitted, each with the chain that it ended.

    Parameters
    ----------
    summary : Summary
        Of :func:`nanotouch.batch.fit_files`.
    segment_length : float or "free", optional
        Persistence length of the chains, as of :func:`nanotouch.curves.chains`.
    sidecar, reading, progress, **settings
        As for :func:`nanotouch.batch.fit_files`; of the settings ``baseline`` counts.
    """
    decided = Sidecar() if sidecar is None else Sidecar.from_toml(sidecar)
    torn = [row for row in summary.rows if row["status"] not in WITHOUT and int(row.get("ruptures") or 0)]
    found, without = [], []
    name, curves = "", None
    for number, row in enumerate(torn):
        file, index = str(row["file"]), int(row["curve"])
        if file != name:
            name, curves = file, read(file, **(reading or {}))
        assert curves is not None
        known = dict(settings) | by_hand(decided.of(Path(file), index))
        try:
            report = analyse(curves[index], baseline=known.get("baseline", "auto"))
            found.append((file, index, chains(curves[index], report, segment_length=segment_length)))
        except Error as error:
            without.append((file, index, str(error)))
        if progress:
            progress((number + 1) / len(torn))
    return Pulls(found, without)


def _steps(found: tuple[Chain, ...]) -> list[float]:
    """Of the contour length, from the rupture before; NaN for the first."""
    lengths = [chain.contour_length for chain in found]
    return [math.nan, *(after - before for before, after in pairwise(lengths))][: len(lengths)]
