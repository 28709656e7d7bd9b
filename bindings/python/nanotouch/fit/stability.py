# SPDX-License-Identifier: BSD-3-Clause
"""Does the modulus depend on how much of the curve is fitted? E(delta), the modulus over the end of the window."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from nanotouch._io.drawing import BLUE, new_figure, plain, saved
from nanotouch.curves import ForceCurve, analyse
from nanotouch.errors import InvalidValue, SolverError
from nanotouch.units import engineering

from .fitting import fit_curve
from .models import Floats, Model
from .result import FitResult

_FIRST = 0.1  # of the deepest indentation: the first window ends there
_KNOWN = 0.1  # relative sigma of a window that counts for the spread
_NOWHERE = -1.0  # m: below every indentation


@dataclass(frozen=True, eq=False)
class Stability:
    """A modulus over the end of the window.

    Attributes
    ----------
    indentation : ndarray, shape (n,)
        Where the windows end [m].
    modulus, sigma : ndarray, shape (n,)
        E* [Pa] and its statistical standard uncertainty; NaN where too few points are left or none fits.
    whole : FitResult
        Of the whole curve, whose contact point all windows share.
    """

    indentation: Floats
    modulus: Floats
    sigma: Floats
    whole: FitResult

    @property
    def spread(self) -> float:
        """Standard deviation of ln E* over the windows that know it to 10 %: what E* depends on where one stops."""
        known = self.modulus[self.sigma < _KNOWN * self.modulus]
        return float(np.std(np.log(known))) if known.size > 1 else np.nan

    def draw(self, save: str | os.PathLike[str] | None = None) -> Any:
        """The plot; also written to `save`, whole or not at all."""
        figure = new_figure(6.4, 4.2)
        panel = figure.add_subplot()
        wide, scale_d = engineering("m", self.indentation)
        stiff, scale_e = engineering("Pa", np.append(self.modulus[np.isfinite(self.modulus)],
                                                     self.whole.values["effective_modulus"]))  # fmt: skip
        panel.errorbar(self.indentation * scale_d, self.modulus * scale_e, 1.96 * self.sigma * scale_e, fmt="o-", ms=4,
                       lw=1.0, capsize=2, color=BLUE, label="window up to there, 95 % (statistical)")  # fmt: skip
        panel.axhline(
            self.whole.values["effective_modulus"] * scale_e, color="0.4", lw=0.8, ls="--", label="whole curve"
        )
        panel.set_xlabel(f"end of the window, indentation $\\delta$ ({wide})")
        panel.set_ylabel(f"effective modulus $E^*$ ({stiff})")
        panel.set_title(plain(f"{self.whole.name}: {self.whole.title}"), fontsize=10)
        panel.legend(fontsize=8)
        return saved(figure, save, dpi=130)


def stability(curve: ForceCurve, model: str | Model = "hertz", *, windows: int = 12, **options: Any) -> Stability:
    """Fit windows that all begin outside and end deeper and deeper, about the contact point of the whole curve.

    Parameters
    ----------
    curve, model, **options
        As of :func:`nanotouch.fit.fit_curve`; the model needs an ``effective_modulus``.
    windows : int
        How many, at least 2.
    """
    if windows < 2:
        raise InvalidValue(f"windows = {windows}: at least 2")
    report = options.pop("report", None) or analyse(curve, baseline=options.pop("baseline", "auto"))
    whole = fit_curve(curve, model, report=report, **options)
    if "effective_modulus" not in whole.values:
        raise InvalidValue(f"model {whole.model!r} has no effective_modulus")
    if whole.time is not None:
        raise InvalidValue(f"model {whole.model!r} is fitted to a whole curve over time, not to windows of it")
    options["contact_point"] = whole.values["contact_point"]
    ends = float(whole.indentation.max()) * np.linspace(_FIRST, 1.0, windows)
    found = np.full((2, windows), np.nan)
    for i, end in enumerate(ends):
        try:
            part = fit_curve(
                curve, model, report=report, window=(_NOWHERE, float(end)), window_of="indentation", **options
            )
        except (InvalidValue, SolverError):
            continue  # too few points, or none of them in contact: NaN
        found[:, i] = part.values["effective_modulus"], part.sigma_statistical["effective_modulus"]
    return Stability(ends, found[0], found[1], whole)
