# SPDX-License-Identifier: BSD-3-Clause
"""A map of force curves as a surface that can be touched: topography, modulus and adhesion of each place."""

from __future__ import annotations

import json
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats, as_floats
from ..errors import InvalidValue
from ..fit.fitting import ASSUMED_HALF_ANGLE, ASSUMED_RADIUS
from ..fit.models import is_sharp
from ..fit.over_time import OVER_TIME
from ..fit.touched import FittedLaw, scene_of, youngs_modulus
from ..images import Topography, fill
from ..images.values import LEAST_SHARE, Fill
from ..scene import Scene
from ..scene.surface import Surface
from .dataset import determined
from .settings import Settings


def to_scene(data: Any, *, poisson_ratio: float = 0.3) -> Scene:
    """The scene of a map's median contact, to be touched over :func:`to_surface`.

    Parameters
    ----------
    data : Dataset
        What :func:`fit` returns.
    poisson_ratio : float
        Of the sample; it says which E an E* is, and changes no force.
    """
    settings = _settings(data)
    if settings.model in OVER_TIME:
        raise InvalidValue(f"model {settings.model!r}: a scene is elastic; fit the map with an elastic law")
    if settings.thickness is not None:
        raise InvalidValue(f"model {settings.model!r}: the contact of a scene is on a half-space, not on a layer")
    known = {name: _known(data, name) for name in ("effective_modulus", "work_of_adhesion") if name in data}
    median = {name: float(np.median(data[name].values[here])) for name, here in known.items() if here.any()}
    if "effective_modulus" not in median:
        raise InvalidValue("effective_modulus: no curve of this map determines it")
    radius = settings.radius or ASSUMED_RADIUS
    angle = settings.half_angle or ASSUMED_HALF_ANGLE
    return scene_of(
        FittedLaw(
            model=settings.model,
            radius=radius,
            half_angle=angle,
            effective_modulus=median["effective_modulus"],
            work_of_adhesion=median.get("work_of_adhesion", 0.0),
            cohesive_range=float(np.nanmedian(data["cohesive_range"].values)) if "cohesive_range" in data else np.nan,
            largest_load=_largest_load(
                data, known["effective_modulus"], None if is_sharp(settings.model) else radius, angle
            ),
        ),
        poisson_ratio,
    )


def to_surface(
    data: Any,
    scene: Scene,
    *,
    fill_by: Fill | None = None,
    pixel_size: float | tuple[float, float] | None = None,
    dilate: bool = False,
) -> Surface:
    """Topography, Young's modulus and work of adhesion of a map, for a scene with its tip.

    Heights are the contact points: where the apex stands at no force. E is that which has the fitted E* with the
    scene's tip and Poisson ratio.

    Parameters
    ----------
    data : Dataset
        What :func:`fit` returns.
    scene : Scene
        With the tip that will touch, such as :func:`to_scene` makes.
    fill_by : {"neighbours", "median"}, optional
        What cells get whose curve does not determine a quantity: the mean of their neighbours (of the logarithm, from
        the rim of each hole inwards), or the median of the map. Without it such a map is refused. Filled cells are
        in ``surface.topography.mask``.
    pixel_size : float or (float, float), optional
        ``(dy, dx)`` [m], for maps that do not say where their curves were taken.
    dilate : bool
        Dilate the heights by the scene's tip. The tip that took the map has done so already.
    """
    if fill_by is not None and fill_by not in get_args(Fill):
        raise InvalidValue(f"fill_by {fill_by!r}: valid are {', '.join(get_args(Fill))}")
    names = [name for name in ("contact_point", "effective_modulus", "work_of_adhesion") if name in data]
    missing = {name: ~_known(data, name) for name in names}
    if fill_by is None and any(holes.any() for holes in missing.values()):
        said = ", ".join(f"{name} of {int(holes.sum())}" for name, holes in missing.items() if holes.any())
        raise InvalidValue(
            f"{missing[names[0]].size} curves do not determine {said}: give fill_by='neighbours' or 'median', "
            "or crop the map"
        )
    heights = _filled(data["contact_point"].values, missing["contact_point"], fill_by, "contact_point")
    modulus = _filled(np.log(_positive(data, "effective_modulus")), missing["effective_modulus"], fill_by, "E*")
    given = {"youngs_modulus": np.vectorize(lambda value: youngs_modulus(scene, value))(np.exp(modulus))}
    if "work_of_adhesion" in missing:
        work = _filled(np.log(_positive(data, "work_of_adhesion")), missing["work_of_adhesion"], fill_by, "w")
        given["work_of_adhesion"] = np.exp(work)
    topography = Topography(
        heights - heights.mean(),
        pixel_size_of(data, pixel_size),
        str(data.attrs.get("input_name", "")),
        "contact_point",
        "nanotouch.maps",
        np.logical_or.reduce(list(missing.values())),
    )
    tip = (scene.tip.radius, scene.tip.half_angle) if dilate else ()
    return Surface(topography, *tip, **given)


def _largest_load(data: Any, known: NDArray[np.bool_], radius: float | None, half_angle: float) -> float:
    """Of the curves, by their contact at the deepest point without adhesion: 2/3 k a^2/R, of a sharp tip k delta/2."""
    k, a = (data[name].values[known] for name in ("contact_stiffness", "contact_radius"))
    depth = 4.0 / 3.0 * a**2 / radius if radius is not None else np.pi * a / (2.0 * np.tan(half_angle))
    return float(np.nanmax(0.5 * k * depth))


def _settings(data: Any) -> Settings:
    return Settings.from_json(json.loads(data.attrs["settings"]))


def _positive(data: Any, name: str) -> Floats:
    values = data[name].values
    return np.where(values > 0.0, values, np.nan)


def _known(data: Any, name: str) -> NDArray[np.bool_]:
    """Where a quantity is determined, and a number that a surface can carry."""
    if name not in data:
        raise InvalidValue(f"the map has no {name}: it is not what nanotouch.maps.fit returns")
    values = data[name].values
    here = determined(data, name)
    if name == "contact_point":
        return here
    least = LEAST_SHARE * np.max(values[here], initial=0.0) if name == "work_of_adhesion" else 0.0
    return np.asarray(here & (values > least))


def _filled(values: Floats, missing: NDArray[np.bool_], by: Fill | None, name: str) -> Floats:
    if not missing.any():
        return np.asarray(values, dtype=np.float64)
    if missing.all():
        raise InvalidValue(f"{name}: no curve of this map determines it")
    if by == "median":
        return np.where(missing, np.median(values[~missing]), values)
    return fill(np.where(missing, np.nan, values))[0]


def pixel_size_of(data: Any, given: float | tuple[float, float] | None = None) -> tuple[float, float]:
    """(dy, dx) [m] of a map, by where its curves were taken."""
    if given is not None:
        pair = np.broadcast_to(as_floats(given, "pixel_size"), (2,))
        return float(pair[0]), float(pair[1])
    sides = []
    for axis in "yx":
        places = np.asarray(data[axis].values, dtype=np.float64)
        if data[axis].attrs.get("units") != "m" or places.size < 2:
            raise InvalidValue("the map does not say where its curves were taken: give pixel_size=(dy, dx) [m]")
        sides.append(abs(float(places[-1] - places[0])) / (places.size - 1))
    return sides[0], sides[1]
