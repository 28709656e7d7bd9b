# SPDX-License-Identifier: BSD-3-Clause
"""How the curves of a map are fitted: the arguments of :func:`nanotouch.fit.fit_curve` that hold for all of them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Literal, NamedTuple

import numpy as np

from ..curves.baseline import Kind, choice_of
from ..errors import InvalidValue
from ..fit import TipLike, Uncertainties
from ..fit.fitting import ASSUMED_HALF_ANGLE, ASSUMED_RADIUS, ASSUMED_RANGE, LOSSES, Loss, check_over_time
from ..fit.models import extension, find, is_sharp, layer_of
from ..fit.points import Branch
from ..fit.show import with_sigma
from ..fit.solving import Setup
from ..fit.ting import parameters_of

_STEP = 0.1  # standard uncertainties, for the derivatives of the result by what is calibrated
_ANY = 1.0  # N/m, where each curve brings its own spring constant
_TYPICAL = 1e-9  # N, where each curve brings its own noise


class ElasticTip(NamedTuple):
    """A tip that is not rigid."""

    radius: float
    youngs_modulus: float
    poisson_ratio: float


@dataclass(frozen=True)
class Settings:
    """Plain numbers and names, so that they can be stored beside the results and sent to other processes; SI.

    See :func:`nanotouch.fit.fit_curve` for what they mean; None is its default.
    """

    model: str = "maugis"
    radius: float | None = None
    half_angle: float | None = None
    thickness: float | None = None
    tip_modulus: float | None = None
    tip_poisson_ratio: float = 0.0
    poisson_ratio: float | None = None
    branch: Branch | None = None
    baseline: Kind = "auto"
    window: tuple[float, float] | None = None
    cohesive_range: float | Literal["free"] | None = None
    uncertainties: Uncertainties = field(default_factory=Uncertainties)
    fixed: Mapping[str, float] = field(default_factory=dict)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    fit_offset: bool = False
    loss: Loss = "squares"
    loss_scale: float | None = None
    stated_radius: bool = False  # the radius is the file's

    def __post_init__(self) -> None:
        if find(self.model).force is not None:
            raise InvalidValue(f"model {self.model!r} is a function in Python; maps take those of the library")
        choices = (
            ("loss", self.loss, LOSSES),
            ("branch", self.branch, (None, "approach", "retract")),
        )
        for name, value, valid in choices:
            if value not in valid:
                raise InvalidValue(f"{name} {value!r}: valid are {', '.join(str(v) for v in valid if v)}")
        ratio = self.poisson_ratio
        if ratio is not None and not -1.0 < ratio <= 0.5:
            raise InvalidValue(f"poisson_ratio {ratio}: valid is above -1, up to 0.5")
        if self.over_time:
            self._check_over_time()
        else:
            self.recipe()

    @property
    def over_time(self) -> bool:
        """Whether whole curves are fitted, with their times."""
        return bool(find(self.model).kernel)

    def _check_over_time(self) -> None:
        refused = {"loss": self.loss != "squares", "bounds": bool(self.bounds), "branch": self.branch == "retract"}
        check_over_time(self.model, **refused, cohesive_range=self.cohesive_range is not None)
        layer_of(find(self.model), self.thickness, self.poisson_ratio, self.fixed)

    def arguments(self) -> dict[str, Any]:
        """Of :func:`nanotouch.fit.fit_curve`, for models over time."""
        tip = None
        if self.tip_modulus is not None:
            tip = ElasticTip(ASSUMED_RADIUS if self.radius is None else self.radius, self.tip_modulus,
                             self.tip_poisson_ratio)  # fmt: skip
        names = ("model", "half_angle", "thickness", "poisson_ratio", "branch", "window", "uncertainties", "fixed")
        return {name: getattr(self, name) for name in names} | {"tip": tip, "radius": None if tip else self.radius}

    @classmethod
    def of(cls, model: str, tip: TipLike | None, radius: float | None, given: Mapping[str, Any]) -> Settings:
        """From the arguments of a fit."""
        valid = cls.__dataclass_fields__.keys() - {"tip_modulus", "tip_poisson_ratio", "stated_radius"}
        unknown = sorted(given.keys() - valid)
        if unknown:
            raise InvalidValue(f"unknown argument {unknown[0]!r}: valid are {', '.join(sorted(valid))}")
        if tip is not None and radius is not None:
            raise InvalidValue("give tip or radius, not both")
        known = {key: value for key, value in given.items() if value is not None}
        if tip is not None:
            modulus = float(getattr(tip, "youngs_modulus", np.inf))
            known |= {"radius": float(tip.radius), "tip_poisson_ratio": float(getattr(tip, "poisson_ratio", 0.0))}
            known |= {"tip_modulus": modulus if np.isfinite(modulus) else None}
        elif radius is not None:
            known["radius"] = float(radius)
        return cls(model=model, **known)

    def beside(self, radii: Collection[float]) -> Settings:
        """With the tip radius [m] that the file states, where none was given; one that states several is refused."""
        if self.radius is not None or is_sharp(self.model) or not radii:
            return self
        if len(radii) > 1:
            raise InvalidValue(f"the file states tip radii from {min(radii):g} to {max(radii):g} m: give the radius")
        return replace(self, radius=min(radii), stated_radius=True)

    def as_json(self) -> dict[str, Any]:
        """What is stored."""
        return asdict(self)

    @classmethod
    def from_json(cls, stored: Mapping[str, Any]) -> Settings:
        """Back from :meth:`as_json`."""
        return cls(**(dict(stored) | {"uncertainties": Uncertainties(**stored["uncertainties"])}))

    def recipe(self) -> Any:
        """What the C library takes."""
        held = {name: _position(name, value) for name, value in self.fixed.items()}
        held |= layer_of(find(self.model), self.thickness, self.poisson_ratio, held)
        if find(self.model).has_range and self.cohesive_range != "free":
            held.setdefault("cohesive_range", ASSUMED_RANGE if self.cohesive_range is None else self.cohesive_range)
        setup = Setup(
            model=find(self.model),
            radius=ASSUMED_RADIUS if self.radius is None else self.radius,
            half_angle=ASSUMED_HALF_ANGLE if self.half_angle is None else self.half_angle,
            spring_constant=_ANY,
            held=held,
            bounds={name: _position_bounds(name, pair) for name, pair in self.bounds.items()},
            free_range=self.cohesive_range == "free",
            loss=LOSSES.index(self.loss),
            loss_scale=_TYPICAL,
        )
        places = _places(replace(setup, held={}, bounds={}))
        for name in (*setup.held, *setup.bounds):
            if name not in places:
                raise InvalidValue(f"parameter {name!r}: valid are {', '.join(places)}")
        recipe = extension().Recipe(setup.options(extension()))
        for name in held:
            recipe.hold(places[name])
        recipe.baseline = choice_of(self.baseline)
        recipe.loss_scale = self.loss_scale or 0.0
        recipe.fit_offset = self.fit_offset
        if self.branch is not None:
            recipe.approach = self.branch == "approach"
        if self.window is not None:
            recipe.lowest_force, recipe.highest_force = self.window
        recipe.sensitivity_uncertainty = self.uncertainties.sensitivity
        recipe.check()
        return recipe

    def parameters(self) -> dict[str, tuple[int, str]]:
        """Place and unit of each parameter of the model."""
        if self.over_time:
            return parameters_of(find(self.model))
        options = extension().Options(self.model)
        return {p[0]: (place, p[1]) for place, p in enumerate(options.parameters) if p is not None}

    def asks(self, name: str) -> bool:
        """Whether a parameter is what is looked for; those of baseline and calibration are known beforehand."""
        return self.fit_offset if name == "force_offset" else name not in ("force_tilt", "sensitivity", "drag")

    def calibrations(self) -> Iterator[tuple[Any, float, float]]:
        """For each thing that is uncertain: the recipe with it changed, by how many of its standard uncertainties, and
        the factor that this puts on spring constant and forces."""
        spread = self.uncertainties
        if spread.spring_constant > 0.0:
            yield self.recipe(), _STEP, 1.0 + _STEP * spread.spring_constant
        if spread.radius > 0.0 and not is_sharp(self.model):
            radius = ASSUMED_RADIUS if self.radius is None else self.radius
            yield replace(self, radius=radius * (1.0 + _STEP * spread.radius)).recipe(), _STEP, 1.0
        if spread.half_angle > 0.0 and is_sharp(self.model):
            angle = ASSUMED_HALF_ANGLE if self.half_angle is None else self.half_angle
            yield replace(self, half_angle=angle + _STEP * spread.half_angle).recipe(), _STEP, 1.0
        if spread.thickness > 0.0 and self.thickness is not None:
            yield replace(self, thickness=self.thickness * (1.0 + _STEP * spread.thickness)).recipe(), _STEP, 1.0

    def assumptions(self) -> list[str]:
        """What was not given and had to be assumed."""
        said = []
        if is_sharp(self.model) and self.half_angle is None:
            said.append(
                f"half angle {np.degrees(ASSUMED_HALF_ANGLE):.3g} degrees (not given; {find(self.model).scaling})"
            )
        if not is_sharp(self.model) and self.radius is None:
            said.append(f"tip radius {ASSUMED_RADIUS * 1e9:g} nm (not given; {find(self.model).scaling})")
        if self.stated_radius and self.radius is not None:
            said.append(f"tip radius {with_sigma(self.radius, 0.0, 'm')} (as the file states)")
        if find(self.model).has_range and self.cohesive_range is None:
            said.append(f"range of adhesion h0 = {ASSUMED_RANGE * 1e9:g} nm (atomic; not given)")
        said += self.uncertainties.assumptions(sharp=is_sharp(self.model), layer=find(self.model).is_layer)
        if self.poisson_ratio is not None and self.tip_modulus is None:
            said.append("the tip is rigid (its modulus is not given)")
        return said


def _places(setup: Setup) -> dict[str, int]:
    return {p[0]: place for place, p in enumerate(setup.options(extension()).parameters) if p is not None}


def _position(name: str, value: float) -> float:
    """The C library counts positions towards the sample."""
    return -float(value) if name == "contact_point" else float(value)


def _position_bounds(name: str, pair: tuple[float, float]) -> tuple[float, float]:
    return (-pair[1], -pair[0]) if name == "contact_point" else (pair[0], pair[1])
