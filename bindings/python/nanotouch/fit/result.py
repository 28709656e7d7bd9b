# SPDX-License-Identifier: BSD-3-Clause
"""What a fit found."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from nanotouch._io.words import times
from nanotouch.curves import CurveReport
from nanotouch.errors import InvalidValue, require
from nanotouch.rheology import Rheology
from nanotouch.scene import Scene

from .answer import Answer, answer_of
from .models import Floats, built_in
from .over_time import rheology_of
from .points import Branch
from .show import Page, Row, as_html, as_text, between, newton
from .show import with_sigma as with_sigma
from .touched import FittedLaw, scene_of
from .uncertainties import Uncertainties

Status = Literal["ok", "undetermined", "misfit", "not converged"]

MISFIT = 3.0  # residual over noise from where the model is said not to describe the curve
GOOD = 4.5  # NT_FIT_GOOD
REJECTED = 1.0  # rating below which nothing is left of a curve, noise or not
SHOWN = ("youngs_modulus", "effective_modulus", "work_of_adhesion", "exponent")  # in a line
_PLACES = ("contact_point", "force_offset", "force_tilt", "sensitivity")


@dataclass(frozen=True, eq=False, repr=False)
class FitResult:
    """What a fit found; SI throughout.

    Attributes
    ----------
    model, title, valid : str
        Name of the model, its title, where it holds.
    values : mapping
        Each parameter of the model: ``effective_modulus`` E* [Pa], ``work_of_adhesion`` w [J/m^2], ``cohesive_range``
        h0 [m] (or those of the user's model), ``contact_point`` (z of the base where the undeformed bodies touch) [m],
        ``force_offset`` [N] and ``force_tilt`` [N/m] (by which the baseline was corrected), ``sensitivity`` (true over
        assumed deflection sensitivity). Where the Poisson ratio of the sample was given also ``youngs_modulus``: E of
        the sample [Pa].
    sigma, sigma_statistical, sigma_calibration : mapping
        Standard uncertainty of each: all together; from noise, baseline and sampling; from the calibration, as
        uncertain as :class:`Uncertainties` says. 0 where the parameter was held, infinite where the curve says nothing
        about it.
    interval : mapping
        (low, high) of the 95 % interval, of positive parameters symmetric in the logarithm.
    covariance : ndarray, shape (n, n)
        Of the parameters in `free`, in their order.
    free : tuple of str
        The parameters that were fitted.
    identifiable : mapping
        Whether the curve determines each fitted parameter of the model, and the contact point, to better than half its
        value.
    z, force, fitted, indentation : ndarray, shape (m,)
        The points that were fitted: z of the base [m], measured force with its baseline taken off [N], the model's
        force [N] and indentation [m] there.
    pull_off_force, measured_pull_off_force, measured_snap_in_force : float
        Of the fitted contact, and read off the curve [N], positive.
    residual_rms, misfit : float
        Of the force [N]; the same over the noise from point to point (infinite where there is no noise).
    contact_radius, contact_stiffness : float
        At the deepest point: a [m], k [N/m]; NaN for a user's model.
    transition_parameter : float
        Maugis' lambda; NaN for the other models.
    radius, half_angle, spring_constant : float
        What was used [m], [rad], [N/m].
    uncertainties : Uncertainties
        Of the calibration, as given.
    bounds : mapping
        (least, most) at 95 % of E*, w and E where the curve does not determine them; 0 and infinite where there is no
        bound. Empty where `reason` stands against any.
    reason : str
        Why nothing follows for the sample, in a few words; empty where something does.
    doubt : str
        Why the law is not that of this contact, though the curve determines what it asks for; empty where it is.
    choice : str
        Why this law was fitted, where it was left open (``model="auto"``).
    rating : float
        0 (reject) to 10, as people have rated such fits: by the largest residuals beside the load (docs/fit.md).
    radius_given, assumed_tip : bool
        Whether the radius was given; whether the size that this law needs was assumed.
    assumptions, notes : tuple of str
        What was not given and had to be assumed; what the reader should know before using the numbers.
    """

    model: str
    title: str
    valid: str
    branch: Branch | Literal["whole curve"]
    values: Mapping[str, float]
    sigma: Mapping[str, float]
    sigma_statistical: Mapping[str, float]
    sigma_calibration: Mapping[str, float]
    interval: Mapping[str, tuple[float, float]]
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
    half_angle: float
    spring_constant: float
    converged: bool
    iterations: int
    report: CurveReport
    assumptions: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    name: str = ""
    uncertainties: Uncertainties = field(default_factory=Uncertainties)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    reason: str = ""
    doubt: str = ""
    choice: str = ""
    rating: float = np.nan
    radius_given: bool = True
    assumed_tip: bool = False
    units: Mapping[str, str] = field(default_factory=dict)
    time: Floats | None = None
    """of each point [s], of models that are fitted to the whole curve"""

    @property
    def rheology(self) -> Rheology:
        """How the sample relaxes, of models over time: E where the Poisson ratio was given, else E*. InvalidValue for
        the others."""
        if self.time is None:
            raise InvalidValue(f"model {self.model!r} knows no time; ting_power, ting_sls and ting_prony do")
        return rheology_of(self.model, self.values)

    @property
    def status(self) -> Status:
        """``"ok"``, ``"not converged"``, ``"misfit"`` (the residuals are no noise, and large beside the load: a
        rating below 4.5; or any rating below 1; or there is a `doubt`) or ``"undetermined"`` (a parameter of the sample
        is not determined); the notes say what follows."""
        if not self.converged:
            return "not converged"
        if self.rating < REJECTED or (MISFIT < self.misfit < np.inf and not self.rating >= GOOD):
            return "misfit"
        if self.doubt and all(self.identifiable.values()):
            return "misfit"
        return "ok" if all(self.identifiable.values()) else "undetermined"

    @property
    def residuals(self) -> Floats:
        """Measured minus fitted force [N], shape (m,)."""
        return self.force - self.fitted

    def determined(self, key: str) -> bool | None:
        """Whether the curve determines a parameter; None if it was held or known beforehand."""
        return self.identifiable.get("effective_modulus" if key == "youngs_modulus" else key)

    def to_scene(self, *, poisson_ratio: float = 0.3) -> Scene:
        """The scene that was fitted, to be planned and touched: tip, E of the sample, w and its range.

        Dry, without forces that were not fitted; the tip is silicon, and E that which has the fitted E* with it.
        JKR's law, which has no range, becomes Maugis-Dugdale's of lambda 20; DMT's of lambda 0.001, as far as the range
        of adhesion then stays within 10 nm. The spring constant belongs to a rig.

        Parameters
        ----------
        poisson_ratio : float
            Of the sample; it says which E an E* is, and changes no force.

        Raises
        ------
        InvalidValue
            For a law of one's own, and where the curve does not determine what the scene needs.
        """
        needed = [key for key in ("effective_modulus", "work_of_adhesion") if key in self.values]
        unknown = [key for key in needed if self.determined(key) is False]
        if unknown:
            raise InvalidValue(f"{self.name}: the curve does not determine {' and '.join(unknown)}: no scene")
        if self.model not in built_in():
            raise InvalidValue(f"model {self.model!r} is none of contact alone: a scene cannot have it as its contact")
        if built_in()[self.model].is_layer:
            raise InvalidValue(f"model {self.model!r}: the contact of a scene is on a half-space, not on a layer")
        law = FittedLaw(
            model=self.model,
            radius=self.radius,
            half_angle=self.half_angle,
            effective_modulus=self.values["effective_modulus"],
            work_of_adhesion=self.values.get("work_of_adhesion", 0.0),
            cohesive_range=self.values.get("cohesive_range", float("nan")),
            largest_load=float(np.nanmax([self.force.max(), self.pull_off_force])),
        )
        return scene_of(law, poisson_ratio)

    def show(self, key: str) -> str:
        """One parameter in words: ``"(15.3 +- 0.4) kPa"``, or its bound where the curve does not determine it."""
        text = with_sigma(self.values[key], self.sigma[key], self.units[key])
        if self.determined(key) is False:
            return self._undetermined(key)
        return f"{text} (held)" if self.sigma[key] == 0.0 else text

    def _undetermined(self, key: str) -> str:
        """What is known of a parameter that the curve does not determine."""
        if self.reason:
            return f"not determined: {self.reason}"
        if key in self.bounds:
            told = between(*self.bounds[key], self.units[key])
            return "not determined, without a bound" if told == "unknown" else f"{told} (95 %), not determined"
        if self.uncertainties.sensitivity == 0.0:
            return "not determined; a bound needs the uncertainty of the sensitivity (--known-to sensitivity=3)"
        return "not determined"

    @property
    def answer(self) -> Answer:
        """What was asked, first: pull-off, work of adhesion where it follows, modulus or its bound."""
        return answer_of(self)

    def to_pandas(self) -> Any:
        """A pandas DataFrame with a row for each parameter: ``value``, ``sigma``, its statistical part and the
        calibration's, ``low`` and ``high`` of the 95 % interval, ``unit``, ``determined`` (None where it was held)."""
        pandas = require("pandas", "notebook")
        rows = {
            key: {
                "value": value, "sigma": self.sigma[key], "sigma_statistical": self.sigma_statistical[key],
                "sigma_calibration": self.sigma_calibration[key], "low": self.interval[key][0],
                "high": self.interval[key][1], "unit": self.units[key], "determined": self.determined(key),
            }
            for key, value in self.values.items()
        }  # fmt: skip
        return pandas.DataFrame.from_dict(rows, orient="index").rename_axis("parameter")

    def plot(self, save: str | os.PathLike[str] | None = None) -> Any:
        """Draw it as :func:`nanotouch.fit.draw` does: a matplotlib Figure, also written to `save`."""
        from .picture import plot

        return plot(self, save)

    def __repr__(self) -> str:
        asked = [key for key in SHOWN if key in self.values] or list(self.values)[:1]
        if "youngs_modulus" in asked:
            asked.remove("effective_modulus")
        said = ", ".join(f"{key} {self.show(key)}" for key in asked)
        return f"<FitResult {self.name}: {self.model}, {self.branch}, {self.status}; {said}>"

    def __str__(self) -> str:
        return as_text(self._page())

    def _repr_html_(self) -> str:
        return as_html(self._page())

    def _page(self) -> Page:
        outcome = "converged" if self.converged else "NOT CONVERGED"
        remarks = [("valid for", self.valid)] + [("assumed", text) for text in self.assumptions]
        return Page(
            title=f"{self.name}: {self.title} fit of the {self.branch}, {self.z.size} points, "
            f"{outcome} after {self.iterations} iterations",
            rows=[Row(key, self.show(key), self._parts(key), self.determined(key)) for key in self.values],
            readings=self._readings(),
            remarks=remarks + [("note", text) for text in self.notes],
            answer=self.answer.lines,
        )

    def _parts(self, key: str) -> str:
        """Statistical and calibration sigma of a property of the sample that both enter."""
        total, calibration, value = self.sigma[key], self.sigma_calibration[key], self.values[key]
        if (
            key in _PLACES
            or self.determined(key) is False
            or not np.isfinite(total)
            or calibration == 0.0
            or value == 0.0
            or total > 10.0 * abs(value)
        ):
            return ""
        scale = 100.0 / abs(value)
        return f"statistical {scale * self.sigma_statistical[key]:.2g} %, calibration {scale * calibration:.2g} %"

    def _readings(self) -> list[tuple[str, str]]:
        rows = []
        if np.isfinite(self.pull_off_force):
            rows.append(("pull-off force", f"fitted {newton(self.pull_off_force)}, "
                                           f"measured {newton(self.measured_pull_off_force)}"))  # fmt: skip
        rows += [
            ("snap-in force", f"measured {newton(self.measured_snap_in_force)}"),
            ("residual", f"{newton(self.residual_rms)} RMS, {times(self.misfit)} the noise"),
            ("rating", f"{self.rating:.1f} of 10"),
        ]
        return rows
