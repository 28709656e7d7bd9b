# SPDX-License-Identifier: BSD-3-Clause
"""What was asked of a curve, answered first: pull-off, work of adhesion where it follows, modulus or its bound."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from nanotouch.curves.adhesion import Kind, adhesion_of
from nanotouch.units import in_words

from .models import is_sharp
from .show import between, newton, with_sigma

if TYPE_CHECKING:
    from .result import FitResult

_GAUSSIAN = 1.959963984540054
_DMT, _JKR = 2.0 * np.pi, 1.5 * np.pi  # F/(w R) of the two limits
_SMALL = 0.3  # a/R at the tear up to which they are within 5 % of a sphere's
_WATER = 0.072  # J/m^2


class Answer(NamedTuple):
    """The answer of one curve; SI, NaN where there is none.

    Attributes
    ----------
    adhesion : {"none", "tear", "held", "unknown"}
        As of :func:`nanotouch.curves.adhesion_of`.
    pull_off_force : (float, float, float)
        Value, least and most (95 %) [N], the calibration's uncertainty in it.
    work_of_adhesion : (float, float)
        Least and most (95 %) [J/m^2]: from F/(2 pi R) to F/(1.5 pi R), with the uncertainties of force and radius. For
        one clean tear alone, of a contact that is surely small against the tip (a/R < 0.3), whose radius was given.
    work_times_radius : (float, float)
        The same times R [N], whether the radius was given or not.
    separation_work : (float, float)
        Of pulling off, its standard uncertainty [J].
    modulus : (float, float, float)
        Value, least and most (95 %) [Pa], of `quantity`. The value is NaN where the curve sets bounds alone, all are
        NaN where it sets none.
    lines : tuple of (str, str)
        All that in words.
    """

    adhesion: Kind
    pull_off_force: tuple[float, float, float]
    work_of_adhesion: tuple[float, float]
    work_times_radius: tuple[float, float]
    separation_work: tuple[float, float]
    modulus: tuple[float, float, float]
    lines: tuple[tuple[str, str], ...]
    pull_off_sigma: float = np.nan
    """standard uncertainty of the pull-off force, the calibration's in it [N]"""
    quantity: Literal["youngs_modulus", "effective_modulus"] = "effective_modulus"
    """which modulus it is: E of the sample if its Poisson ratio was given, else E*"""

    def __str__(self) -> str:
        return "\n".join(f"  {name:18} {text}" for name, text in self.lines)

    def as_json(self) -> dict[str, Any]:
        """Plain numbers; null for what is infinite or not a number."""

        def plain(values: Sequence[float]) -> list[float | None]:
            return [float(v) if np.isfinite(v) else None for v in values]

        return {
            "adhesion": self.adhesion,
            "pull_off_force_N": plain(self.pull_off_force),
            "work_of_adhesion_J_per_m2": plain(self.work_of_adhesion),
            "work_times_radius_N": plain(self.work_times_radius),
            "separation_work_J": plain(self.separation_work),
            "modulus_Pa": plain(self.modulus),
            "modulus_is": self.quantity,
            "words": dict(self.lines),
        }


def answer_of(result: FitResult) -> Answer:
    """The answer of a fit."""
    found = adhesion_of(result.report)
    force, sigma, low, high = _force(result)
    lines = [("pull-off", _pull_off(result, found.kind, found.words, force, sigma, low, high))]
    nothing = (np.nan, np.nan)
    work = product = nothing
    if found.kind == "tear" and not is_sharp(result.model):
        product, work, said = _works(result, low, high)
        lines += said
    separation = (np.nan, np.nan)
    if found.kind in ("tear", "held"):
        separation = _separation(result)
        lines.append(("separation", f"work {with_sigma(*separation, 'J')}, below the baseline, over the base's travel"))
    if found.kind == "held":
        lines.append(("adhesion", "force and work of separation alone: what does not detach gives no work per area"))
    modulus, said = _modulus(result)
    said += _relaxation(result)
    if result.choice:
        lines.append(("law", result.choice))
    quantity = _quantity_of(result)
    return Answer(found.kind, (force, low, high), work, product, separation, modulus, (*lines, *said), sigma, quantity)


def _force(result: FitResult) -> tuple[float, float, float, float]:
    """Pull-off force, its sigma and ends (95 %), with the calibration's uncertainty [N]."""
    report, known = result.report, result.uncertainties
    force, statistical = report.pull_off_force, report.sigma["pull_off_force"]
    of_calibration = abs(force) * known.force
    low, high = report.pull_off_interval
    low = force - np.hypot(force - low, _GAUSSIAN * of_calibration)
    high = force + np.hypot(high - force, _GAUSSIAN * of_calibration)
    return force, float(np.hypot(statistical, of_calibration)), max(float(low), 0.0), float(high)


def _pull_off(result: FitResult, kind: Kind, words: str, force: float, sigma: float, low: float, high: float) -> str:
    if kind == "unknown" or not np.isfinite(force):
        return words
    if kind == "none":
        return f"none seen; below {newton(high)} (95 %)"
    return f"{with_sigma(force, sigma, 'N')}, 95 % {between(low, high, 'N')}; {words}"


def _works(
    result: FitResult, low: float, high: float
) -> tuple[tuple[float, float], tuple[float, float], list[tuple[str, str]]]:
    """w R, w and the words for one clean tear."""
    spread = float(np.exp(_GAUSSIAN * result.uncertainties.radius))
    product = (low / _DMT, high / _JKR)
    nothing = (np.nan, np.nan)
    size = _size_at_tear(result, high)
    if not result.radius_given:
        said = (
            f"w R {between(*product, 'N')} (95 %; F/(2 pi) to F/(1.5 pi)) if the contact's radius is below {_SMALL} R"
        )
        return product, nothing, [
            ("adhesion", f"{said} at the tear: the tip's radius is not given, and w needs it (--radius, radius=)")
        ]  # fmt: skip
    if not size <= _SMALL:
        known = f"may be up to {size:.2g} R (95 %)" if np.isfinite(size) else "is open, since the modulus is"
        return (
            product,
            nothing,
            [
                (
                    "adhesion",
                    f"no w: the contact's radius at the tear {known}; a paraboloid's w needs less than {_SMALL} R",
                )
            ],
        )
    work = (product[0] / result.radius / spread, product[1] / result.radius * spread)
    meniscus = 4.0 * np.pi * _WATER * result.radius
    return (
        product,
        work,
        [
            ("adhesion", f"w {between(*work, 'J/m^2')} (95 %; F/(2 pi R) to F/(1.5 pi R))"),
            (
                "in air",
                f"a meniscus of water alone gives 4 pi gamma R = {newton(meniscus)}: w is then not the sample's",
            ),
        ],
    )


def _size_at_tear(result: FitResult, force: float) -> float:
    """a/R where a contact is torn off by that force, at most (JKR, 95 %): (3 F/(4 E* R^2))^(1/3) with the least E* that
    the curve leaves; NaN where it leaves all."""
    if result.determined("effective_modulus") is False or "effective_modulus" not in result.values:
        modulus = result.bounds.get("effective_modulus", (np.nan, np.nan))[0]
    else:
        modulus = result.interval["effective_modulus"][0]
    if not modulus > 0.0:
        return np.nan
    return float((0.75 * force / (modulus * result.radius**2)) ** (1.0 / 3.0))


def _separation(result: FitResult) -> tuple[float, float]:
    """Work below the baseline and its sigma, with the calibration's [J]: force and way go as the sensitivity."""
    report, known = result.report, result.uncertainties
    work, sigma = report.adhesion_work, report.sigma["adhesion_work"]
    return work, float(np.hypot(sigma, abs(work) * known.force))


def _relaxation(result: FitResult) -> list[tuple[str, str]]:
    """How the sample relaxes, of models over time."""
    if result.time is None:
        return []
    if "exponent" in result.values:
        low, high = result.interval["exponent"]
        text = f"E goes as t^-beta, at 1 s as above; beta {result.show('exponent')}"
        if result.determined("exponent"):
            text += f", 95 % from {low:.4f} to {high:.4f}"
        return [("relaxation", text)]
    names = [name for name in result.values if name.startswith("relaxation_time")]
    arms = [
        f"{result.show(name.replace('relaxation_time', 'arm_modulus'))} more within {result.show(name)}"
        for name in names
    ]
    return [("relaxation", f"E* at rest {result.show('effective_modulus')}; of E* {', '.join(arms)}")]


def _quantity_of(result: FitResult) -> Literal["youngs_modulus", "effective_modulus"]:
    return "youngs_modulus" if "youngs_modulus" in result.values else "effective_modulus"


def _modulus(result: FitResult) -> tuple[tuple[float, float, float], list[tuple[str, str]]]:
    """The modulus in words: E of the sample or E*; without the tip's size as a product with it."""
    if "effective_modulus" not in result.values:
        return (np.nan, np.nan, np.nan), []
    key = _quantity_of(result)
    title = "E" if key == "youngs_modulus" else "E*"
    value, (low, high) = result.values[key], result.interval[key]
    if result.determined(key) is False:
        value = np.nan
        low, high = result.bounds.get(key, (np.nan, np.nan))
    text = result.show(key)
    if result.determined(key) is not False and result.sigma[key] > 0.0:
        text += f", 95 % {between(low, high, 'Pa')}"
    lines = [("modulus", f"{title} {text}")]
    if result.status == "misfit" and result.determined(key) is not False:
        lines.append(("", f"misfit, not to be relied on: {result.doubt or 'the residuals are no noise'}"))
    if result.assumed_tip:
        sharp = is_sharp(result.model)
        size = f"{np.degrees(result.half_angle):.3g} degrees" if sharp else f"R = {in_words(result.radius, 'm')}"
        factor = np.tan(result.half_angle) if sharp else np.sqrt(result.radius)
        name, unit = ("tan(half angle)", "Pa") if sharp else ("sqrt(R)", "Pa m^0.5")
        shown = between(low * factor, high * factor, unit)
        lines.append(("", f"for {size}, which is assumed; what the curve says is {title} {name} {shown} (95 %)"))
    return (value, low, high), lines
