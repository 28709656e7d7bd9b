# SPDX-License-Identifier: BSD-3-Clause
"""Plans of one scene over values of its fields, as one labeled array per result: :meth:`nanotouch.Scene.plans`."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from nanotouch._arrays import refuse_dressed
from nanotouch._io.words import told
from nanotouch.errors import InvalidValue, require
from nanotouch.scene.plan import Plan

if TYPE_CHECKING:
    from nanotouch.scene import Demand, Rig, Scene

RESULTS = {  # of a plan: unit, name
    "pull_off_force": ("N", "pull-off force under load control"),
    "maugis_lambda": ("1", "Maugis parameter"),
    "minimum_spring": ("N/m", "softest spring without jump-in"),
    "maximum_stiffness": ("N/m", "contact stiffness at the largest load"),
    "bound": ("1", "bound of the error of the demanded quantity"),
    "scale": ("", "what small values of it are compared with"),
    "fold_shift_m": ("m", "bound of the shift of a fold"),
    "cost": ("1", "cost of an evaluation in Hertz evaluations"),
    "latency": ("1", "the same where each waits for the last"),
}


def plans_over(scene: Scene, over: Mapping[str, Sequence[Any]], demand: Demand | None, rig: Rig | None) -> Any:
    """The dataset of :meth:`nanotouch.Scene.plans`."""
    xarray = require("xarray", "notebook")
    if demand is not None and not hasattr(demand, "core"):
        wanted = f"nanotouch.Demand(demand={{'relative_accuracy': {demand!r}}})"
        raise InvalidValue(f"demand: expected a nanotouch.Demand, not {demand!r}: for an accuracy {wanted}")
    if not isinstance(over, Mapping):
        raise InvalidValue(f"over = {told(over)}: expected a mapping of fields to their values")
    for name, values in over.items():
        refuse_dressed(values, f"over[{name!r}]")
        if name not in scene.fields:
            raise InvalidValue(f"over: {name!r} is no field of a scene; fields are named as in scene['tip.radius']")
        if np.ndim(values) != 1 or len(values) == 0:
            raise InvalidValue(f"over[{name!r}]: expected a sequence of values, not {values!r}")
    shape = tuple(len(values) for values in over.values())
    made = {name: np.full(shape, np.nan) for name in RESULTS}
    law, refused = np.full(shape, "", dtype=object), np.full(shape, "", dtype=object)
    for place, values in zip(np.ndindex(shape), itertools.product(*over.values()), strict=True):
        try:
            varied = scene.copy()
            for name, value in zip(over, values, strict=True):
                varied[name] = value
            plan = Plan.make(varied, demand, rig)
        except InvalidValue as error:
            refused[place] = str(error)
            continue
        law[place] = plan.contact_law
        for name, numbers in made.items():
            numbers[place] = getattr(plan, name)
    dims = tuple(over)
    data: dict[str, Any] = {name: (dims, numbers, _about(name)) for name, numbers in made.items()}
    data |= {"contact_law": (dims, law), "refused": (dims, refused)}
    coordinates = {name: ((name,), list(values), {"units": scene.fields[name].unit}) for name, values in over.items()}
    return xarray.Dataset(data, coordinates, attrs={"title": "plans of one scene"})


def _about(name: str) -> dict[str, str]:
    unit, words = RESULTS[name]
    return {"units": unit, "long_name": words} if unit else {"long_name": words}
