# SPDX-License-Identifier: BSD-3-Clause
"""What a fit found, and how it is shown."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from nanotouch.contact import Model
from nanotouch.curves import CurveReport

Floats = NDArray[np.float64]
Branch = Literal["approach", "retract"]


@dataclass(frozen=True, eq=False)
class FitResult:
    """What a fit found; SI throughout.

    Attributes
    ----------
    values, sigma : mapping
        Value and standard uncertainty of each parameter of the model: ``effective_modulus`` E* [Pa],
        ``work_of_adhesion`` w [J/m^2], ``cohesive_range`` h0 [m], ``contact_point`` (z of the base where the undeformed
        bodies touch) [m], ``force_offset`` [N], ``compliance`` (true over assumed deflection sensitivity). Where the
        Poisson ratio of the sample was given also ``youngs_modulus`` E of the sample [Pa]. Sigma is 0 where the
        parameter was held and infinite where the curve says nothing about it; it is statistical, with the uncertainty
        of the deflection sensitivity, without those of radius and spring constant.
    covariance : ndarray, shape (n, n)
        Of the parameters in `free`, in their order.
    free : tuple of str
        The parameters that were fitted.
    identifiable : mapping
        Whether the curve determines each fitted parameter, to better than half its value.
    z, force, fitted, indentation : ndarray, shape (m,)
        The points that were fitted: z of the base [m], measured force with its baseline taken off [N], the model's
        force [N] and indentation [m] there.
    pull_off_force, measured_pull_off_force, measured_snap_in_force : float
        Of the fitted contact, and read off the curve [N], positive.
    residual_rms, misfit : float
        Of the force [N]; the same over the noise from point to point (infinite where there is no noise).
    contact_radius, contact_stiffness : float
        At the deepest point: a [m], k [N/m].
    transition_parameter : float
        Maugis' lambda; NaN for the other models.
    assumptions, notes : tuple of str
        What was not given and had to be assumed; what the reader should know before using the numbers.
    """

    model: Model
    branch: Branch
    values: Mapping[str, float]
    sigma: Mapping[str, float]
    covariance: Floats
    free: tuple[str, ...]
    identifiable: Mapping[str, bool]
    z: Floats
    force: Floats
    fitted: Floats
    indentation: Floats
    pull_off_force: float
    measured_pull_off_force: float
    measured_snap_in_force: float
    residual_rms: float
    misfit: float
    contact_radius: float
    contact_stiffness: float
    transition_parameter: float
    radius: float
    spring_constant: float
    converged: bool
    iterations: int
    report: CurveReport
    assumptions: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    name: str = ""
    units: Mapping[str, str] = field(default_factory=dict)

    @property
    def residuals(self) -> Floats:
        """Measured minus fitted force [N], shape (m,)."""
        return self.force - self.fitted

    def __str__(self) -> str:
        lines = [f"{self.name}: {self.model} fit of the {self.branch}, {self.z.size} points, {self._outcome()}"]
        for key in self.values:
            lines.append(f"  {key:18} {self.show(key)}")
        lines += [
            f"  {'pull-off force':18} fitted {_nn(self.pull_off_force)}, measured {_nn(self.measured_pull_off_force)}",
            f"  {'snap-in force':18} measured {_nn(self.measured_snap_in_force)}",
            f"  {'residual':18} {self.residual_rms * 1e12:.3g} pN RMS, {self.misfit:.2g} times the noise",
        ]
        lines += [f"  assumed: {text}" for text in self.assumptions]
        lines += [f"  note: {text}" for text in self.notes]
        return "\n".join(lines)

    def _outcome(self) -> str:
        return f"{'converged' if self.converged else 'NOT CONVERGED'} after {self.iterations} iterations"

    def show(self, key: str) -> str:
        """One parameter in words: ``"(15.3 +- 0.4) kPa"``, with a warning where the curve does not determine it."""
        text = with_sigma(self.values[key], self.sigma[key], self.units[key])
        source = "effective_modulus" if key == "youngs_modulus" else key
        if source not in self.identifiable:
            return f"{text} (held)"
        return text if self.identifiable[source] else f"{text}, NOT DETERMINED"


_PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}


def with_sigma(value: float, sigma: float, unit: str) -> str:
    """``(15.34 +- 0.12) kPa``: a common prefix, sigma with two digits; without sigma if that is 0."""
    power = 0
    if unit and value != 0.0 and np.isfinite(value):
        power = min(max(3 * int(np.floor(np.log10(abs(value)) / 3)), -12), 12)
    shown, spread = value / 10.0**power, sigma / 10.0**power
    unit = f" {_PREFIXES[power]}{unit}" if unit else ""
    if sigma == 0.0:
        return f"{shown:.4g}{unit}"
    if not 0.0 < spread <= 1e3 * abs(shown):
        return f"{shown:.4g}{unit} (sigma {spread:.2g})"
    digits = max(0, 1 - int(np.floor(np.log10(spread))))
    return f"({shown:.{digits}f} +- {spread:.{digits}f}){unit}"


def _nn(force: float) -> str:
    return f"{force * 1e9:.4g} nN"
