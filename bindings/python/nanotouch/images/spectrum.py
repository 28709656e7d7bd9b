# SPDX-License-Identifier: BSD-3-Clause
"""Power spectral density and autocorrelation of an image, by SurfaceTopography."""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import Floats
from .._io.drawing import BLUE, VERMILION, new_figure, saved
from .._io.writing import replacing
from ..errors import require
from .topography import Topography


@dataclass(frozen=True, eq=False)
class Spectrum:
    """PSD over the wavevector, and height-difference autocorrelation over distance; of the rows (along x) and radial.

    Attributes
    ----------
    row_wavevector, row_density : ndarray
        q [rad/m] and the one-dimensional PSD C1D [m^3], mean of the rows.
    wavevector, density : ndarray
        q [rad/m] and the radial mean of the two-dimensional PSD, C_iso [m^4].
    row_distance, row_autocorrelation : ndarray
        r [m] and A(r) = <(h(x + r) - h(x))^2>/2 [m^2] along the rows: 0 at r = 0, the mean square height far off.
    distance, autocorrelation : ndarray
        The same, radial.
    """

    row_wavevector: Floats
    row_density: Floats
    wavevector: Floats
    density: Floats
    row_distance: Floats
    row_autocorrelation: Floats
    distance: Floats
    autocorrelation: Floats

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """A row for each value: what, wavevector or distance, value; SI."""
        tables = (
            ("PSD of rows: q [rad/m], C1D [m^3]", self.row_wavevector, self.row_density),
            ("PSD radial: q [rad/m], C_iso [m^4]", self.wavevector, self.density),
            ("ACF of rows: r [m], A [m^2]", self.row_distance, self.row_autocorrelation),
            ("ACF radial: r [m], A [m^2]", self.distance, self.autocorrelation),
        )
        with replacing(Path(path)) as part, part.open("w", encoding="utf-8", newline="") as stream:
            table = csv.writer(stream)
            table.writerow(("what", "over", "value"))
            for name, over, values in tables:
                table.writerows((name, float(x), float(y)) for x, y in zip(over, values, strict=True))

    def draw(self, save: str | os.PathLike[str] | None = None) -> Any:
        """Both, on logarithmic axes; also written to `save`, whole or not at all."""
        figure = new_figure(10.0, 4.2)
        density, correlation = figure.subplots(1, 2)
        density.loglog(self.row_wavevector, self.row_density, color=BLUE, label="rows, $C^{1D}$ (m$^3$)")
        density.set_xlabel("wavevector $q$ (rad/m)")
        density.set_ylabel("$C^{1D}$ (m$^3$)", color=BLUE)
        radial = density.twinx()
        radial.loglog(self.wavevector, self.density, color=VERMILION)
        radial.set_ylabel("radial mean $C^{iso}$ (m$^4$)", color=VERMILION)
        correlation.loglog(self.row_distance, self.row_autocorrelation, color=BLUE, label="along the rows")
        correlation.loglog(self.distance, self.autocorrelation, color=VERMILION, label="radial mean")
        correlation.set_xlabel("distance $r$ (m)")
        correlation.set_ylabel(r"$\langle(h(x + r) - h(x))^2\rangle/2$ (m$^2$)")
        correlation.legend(fontsize=8)
        for panel in (density, radial, correlation):
            panel.minorticks_off()  # their labels run together over less than two decades
        return saved(figure, save, dpi=130)


def spectrum(topography: Topography) -> Spectrum:
    """PSD (with a Hann window) and autocorrelation of a levelled image; missing pixels count as they were filled."""
    library = require("SurfaceTopography", "images")
    height, width = topography.size
    surface = library.Topography(topography.heights.T, (width, height), unit="m", periodic=False)
    return Spectrum(
        *_positive(*surface.power_spectrum_from_profile(reliable=False)),
        *_positive(*surface.power_spectrum_from_area(reliable=False)),
        *_positive(*surface.autocorrelation_from_profile(reliable=False)),
        *_positive(*surface.autocorrelation_from_area(reliable=False)),
    )


def _positive(over: Any, values: Any) -> tuple[Floats, Floats]:
    """As plain arrays: without empty bins and without 0, which a logarithmic axis has no place for."""
    x, y = (np.asarray(np.ma.filled(np.ma.asarray(part, float), np.nan), float) for part in (over, values))
    good = np.isfinite(x) & np.isfinite(y) & (x > 0.0) & (y > 0.0)
    return x[good], y[good]
