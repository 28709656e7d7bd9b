# SPDX-License-Identifier: BSD-3-Clause
"""Fit one model to one branch of a force curve: see :func:`fit_curve`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal, NamedTuple, Protocol

import numpy as np

from nanotouch.curves import CurveReport, ForceCurve, analyse
from nanotouch.curves.baseline import Kind
from nanotouch.errors import InvalidValue

from .first import AUTO, first_choice
from .free_part import doubt_free_part
from .models import Model, extension, find, is_sharp, layer_of
from .points import Branch, Window, points_of
from .relaxing import relaxing
from .reporting import Sample, Tip, make_result
from .result import FitResult
from .show import with_sigma
from .solving import Setup, solve
from .ting import DRAG_HEIGHT, Law, adheres, noise_of, report_of, track_of
from .uncertainties import Uncertainties
from .whole import Whole, fit_whole

Loss = Literal["squares", "huber", "soft_l1", "cauchy"]

LOSSES: tuple[Loss, ...] = ("squares", "huber", "soft_l1", "cauchy")
ASSUMED_RADIUS = 20e-9  # m; common for new silicon and silicon nitride tips
ASSUMED_HALF_ANGLE = float(np.radians(20.0))  # of common pyramidal tips
ASSUMED_RANGE = 0.2e-9  # m; atomic adhesion
_LOSS_SCALE = 3.0  # times the noise


class TipLike(Protocol):
    """A tip: ``radius`` [m], and where it is not taken as rigid ``youngs_modulus`` [Pa] and ``poisson_ratio``."""

    @property
    def radius(self) -> float:
        """Of the apex [m]."""


def fit_curve(
    curve: ForceCurve,
    model: str | Model = "maugis",
    *,
    tip: TipLike | None = None,
    radius: float | None = None,
    half_angle: float | None = None,
    thickness: float | None = None,
    poisson_ratio: float | None = None,
    contact_point: float | None = None,
    window: Window | None = None,
    window_of: Literal["force", "indentation"] = "force",
    branch: Branch | None = None,
    cohesive_range: float | Literal["free"] | None = None,
    uncertainties: Uncertainties | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    fit_offset: bool = False,
    loss: Loss = "squares",
    loss_scale: float | None = None,
    baseline: Kind = "auto",
    report: CurveReport | None = None,
) -> FitResult:
    """Fit one model to one branch of a force curve.

    Parameters
    ----------
    curve : ForceCurve
        With forces and a spring constant.
    model : str or Model
        ``"auto"``: by what the curve shows (``result.choice`` says why). Or a name of
        :func:`nanotouch.fit.models`: ``"maugis"``, ``"jkr"``, ``"dmt"`` (the retraction from the deepest
        point to where the tip is torn off), ``"hertz"``, ``"sphere"``, ``"cone"``, ``"pyramid"``, ``"pyramid3"``,
        ``"layer"``, ``"layer_cone"`` (the approach, where it repels), or one of your own. ``"ting_power"``,
        ``"ting_sls"``, ``"ting_prony"`` (also with ``_sphere``, ``_cone``, ``_pyramid``, ``_punch``): a viscoelastic
        sample, approach, pauses and retraction in one fit.
    tip : object with ``radius``, optional
        For instance ``scene.tip``; its ``youngs_modulus`` and ``poisson_ratio`` enter the sample's modulus.
    radius : float, optional
        R of the tip [m], in place of `tip`. Without either it is the file's, or 20 nm, and the result says so.
    half_angle : float, optional
        Of cone (axis to flank) and pyramid (axis to face) [rad]; 20 degrees are assumed.
    thickness : float, optional
        Of an incompressible layer bonded to rigid ground, under the tip [m]; of ``"layer"`` and ``"layer_cone"``.
    poisson_ratio : float, optional
        Of the sample: then its Young's modulus is reported beside E*.
    contact_point : float, optional
        z of the base [m] at which the undeformed bodies touch, held; fitted by default.
    window : (float, float), optional
        Only points with a force [N], or a fitted indentation [m], between these.
    window_of : {"force", "indentation"}
        What `window` limits. Indentations are those of a fit without a window.
    branch : {"retract", "approach"}, optional
        Default: the retraction for adhesive models, the whole curve for ``"ting_..."``, else the approach.
    cohesive_range : float or "free", optional
        h0 = w/sigma0 of Maugis-Dugdale [m]; 0.2 nm (atoms) is assumed where it is not given.
    uncertainties : Uncertainties, optional
        Of the calibration; by default 3 % of the deflection sensitivity.
    fixed : mapping, optional
        Parameters to hold, by name, at a value [SI].
    bounds : mapping, optional
        (minimum, maximum) of parameters by name [SI].
    fit_offset : bool
        Also fit a constant force offset, instead of trusting the baseline to its uncertainty.
    loss : {"squares", "huber", "soft_l1", "cauchy"}
        All but the first resist outliers beyond `loss_scale` [N] (default three times the noise).
    baseline : {"auto", "line", "wave", "constant"} or (float, float)
        As of :func:`nanotouch.curves.analyse`.
    report : CurveReport, optional
        Of this curve, where it was analysed before.

    Raises
    ------
    InvalidValue
        If an argument or the curve cannot be used; SolverError if no law of this kind comes near the curve;
        MissingExtra if the package was built without Ceres.
    """
    compiled, uncertainties = extension(), uncertainties or Uncertainties()
    stiffness, report = _check_choices(curve, loss, window_of, branch), report or analyse(curve, baseline=baseline)
    choice, assumptions = "", list[str]()
    if tip is None and radius is None and (radius := curve.tip_radius) is not None:
        assumptions = [f"tip radius {with_sigma(radius, 0.0, 'm')} (as the file states)"]
    if model == AUTO:
        size, reach = _size(tip, radius), cohesive_range if isinstance(cohesive_range, float) else ASSUMED_RANGE
        model, branch, choice = first_choice(
            report, stiffness, size, cohesive_range=reach, sharp=half_angle is not None, layer=thickness is not None,
            branch=branch,
        )  # fmt: skip
    chosen = find(model)
    if chosen.kernel:
        check_over_time(chosen.name, loss=loss != "squares", window_of=window_of != "force", bounds=bool(bounds))
        what = Given(report, branch, window, _held(fixed or {}, contact_point), uncertainties, poisson_ratio)
        return _over_time(curve, chosen, TipSize(tip, radius, half_angle, thickness), what, assumptions)
    branch = branch or ("retract" if chosen.adhesive else "approach")
    points = points_of(report, branch, chosen, window=window if window_of == "force" else None, name=curve.name)
    held = _held(fixed or {}, contact_point)
    held |= layer_of(chosen, thickness, poisson_ratio, held)
    if chosen.has_range and cohesive_range != "free":
        held.setdefault("cohesive_range", _range(cohesive_range, assumptions))
    setup = Setup(
        model=chosen,
        radius=_radius(chosen, tip, radius, assumptions),
        half_angle=_half_angle(chosen, half_angle, assumptions),
        spring_constant=stiffness,
        held=held,
        bounds={name: _position_bounds(name, pair) for name, pair in (bounds or {}).items()},
        free_range=cohesive_range == "free",
        fit_offset=fit_offset,
        loss=LOSSES.index(loss),
        loss_scale=loss_scale or max(_LOSS_SCALE * report.noise, 1e-18),
    )
    _check_names(setup, chosen.options(compiled, setup.radius).parameters)
    setup = replace(setup, time=relaxing(curve, report, setup))
    assumptions += uncertainties.assumptions(sharp=is_sharp(chosen.name), layer=chosen.is_layer)
    solution = solve(compiled, setup, points, uncertainties)
    if window is not None and window_of == "indentation":
        inside = (solution.indentation >= window[0]) & (solution.indentation <= window[1])
        points = solution.points.kept(inside, curve.name).without_tear()
        solution = solve(compiled, setup, points, uncertainties)
    sharp, given = is_sharp(chosen.name), tip is not None or radius is not None
    told = Tip(choice, given, half_angle is None if sharp else not given)
    made = make_result(
        compiled, curve, setup, solution, uncertainties, report, branch, Sample(poisson_ratio, tip),
        assumptions, told,
    )  # fmt: skip
    return made if chosen.adhesive else doubt_free_part(made, report, branch, solution.made.power[1])


def _check_choices(curve: ForceCurve, loss: str, window_of: str, branch: str | None) -> float:
    """The curve's spring constant [N/m], after what can be wrong with any model."""
    _check_choice("loss", loss, LOSSES)
    _check_choice("window_of", window_of, ("force", "indentation"))
    _check_choice("branch", branch or "approach", ("approach", "retract"))
    if curve.spring_constant is None:
        raise InvalidValue(f"{curve.name}: no spring constant; give it to curves.read, or --spring-constant")
    return curve.spring_constant


def _check_choice(name: str, value: str, valid: tuple[str, ...]) -> None:
    if value not in valid:
        raise InvalidValue(f"{name} {value!r}: valid are {', '.join(valid)}")


class TipSize(NamedTuple):
    """What was given of the tip, and of the sample's thickness."""

    tip: TipLike | None
    radius: float | None
    half_angle: float | None
    thickness: float | None


class Given(NamedTuple):
    """What else a fit of a whole curve takes."""

    report: CurveReport
    branch: Branch | None
    window: Window | None
    held: dict[str, float]
    uncertainties: Uncertainties
    poisson_ratio: float | None


def _over_time(curve: ForceCurve, model: Model, size: TipSize, given: Given, assumptions: list[str]) -> FitResult:
    """A fit of the whole curve, or of the approach alone."""
    if given.branch == "retract":
        raise InvalidValue(f"model {model.name!r} is fitted to the whole curve, or to the approach alone")
    assert curve.spring_constant is not None
    held, report = given.held, report_of(curve, given.report)
    law = Law(
        model=model,
        radius=_radius(model, size.tip, size.radius, assumptions),
        half_angle=_half_angle(model, size.half_angle, assumptions),
        thickness=layer_of(model, size.thickness, given.poisson_ratio, held).get("thickness", 0.0),
        spring_constant=curve.spring_constant,
        noise=noise_of(report),
        drag_height=held.pop(DRAG_HEIGHT, 0.0),
        held=held,
    )
    law.check_names(extension())
    approach_only = given.branch == "approach"
    track = track_of(curve, report, approach_only=approach_only, window=given.window)
    dipping = None
    if adheres(report) and not approach_only:
        dipping = track_of(curve, report, approach_only=False, window=given.window, dips=True)
    known, sharp = size.tip is not None or size.radius is not None, model.sides is not None
    assumptions += given.uncertainties.assumptions(sharp=sharp, layer=law.thickness > 0.0)
    told = Tip("", known, size.half_angle is None if sharp else not known)
    return fit_whole(Whole(curve, report, law, track, dipping), given.uncertainties,
                     Sample(given.poisson_ratio, size.tip), assumptions, told)  # fmt: skip


def check_over_time(name: str, **given: bool) -> None:
    """Raise InvalidValue for arguments, by name, that do not go with a model over time."""
    for argument, refused in given.items():
        if refused:
            raise InvalidValue(f"{argument} does not go with model {name!r}, which is fitted to the whole curve")


def _check_names(setup: Setup, parameters: tuple[tuple[str, str, float, float] | None, ...]) -> None:
    known = tuple(parameter[0] for parameter in parameters if parameter is not None)
    for name in (*setup.held, *setup.bounds):
        _check_choice("parameter", name, known)


def _held(fixed: Mapping[str, float], contact_point: float | None) -> dict[str, float]:
    held = {name: _position(name, value) for name, value in fixed.items()}
    return held if contact_point is None else held | {"contact_point": -contact_point}


def _position(name: str, value: float) -> float:
    """The C library counts positions towards the sample."""
    return -float(value) if name == "contact_point" else float(value)


def _position_bounds(name: str, pair: tuple[float, float]) -> tuple[float, float]:
    return (-pair[1], -pair[0]) if name == "contact_point" else pair


def _radius(model: Model, tip: TipLike | None, radius: float | None, assumptions: list[str]) -> float:
    if tip is not None and radius is not None:
        raise InvalidValue("give tip or radius, not both")
    if tip is not None:
        return float(tip.radius)
    if radius is not None:
        return float(radius)
    if not is_sharp(model.name):
        assumptions.append(f"tip radius {ASSUMED_RADIUS * 1e9:g} nm (not given; {model.scaling})")
    return ASSUMED_RADIUS


def _size(tip: TipLike | None, radius: float | None) -> float:
    """Of the tip, for the choice of a law [m]."""
    return float(tip.radius) if tip is not None else ASSUMED_RADIUS if radius is None else float(radius)


def _half_angle(model: Model, half_angle: float | None, assumptions: list[str]) -> float:
    if half_angle is None and is_sharp(model.name):
        degrees = np.degrees(ASSUMED_HALF_ANGLE)
        assumptions.append(f"half angle {degrees:.3g} degrees (not given; {model.scaling})")
    return ASSUMED_HALF_ANGLE if half_angle is None else float(half_angle)


def _range(cohesive_range: float | Literal["free"] | None, assumptions: list[str]) -> float:
    if cohesive_range is None:
        assumptions.append(f"range of adhesion h0 = {ASSUMED_RANGE * 1e9:g} nm (atomic; not given)")
        return ASSUMED_RANGE
    return float(cohesive_range)
