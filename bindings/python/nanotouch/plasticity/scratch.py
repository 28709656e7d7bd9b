# SPDX-License-Identifier: BSD-3-Clause
"""A round tip that ploughs through a soft sample, with or without a layer; wear. All SI."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from nanotouch import _core
from nanotouch._arrays import check_between
from nanotouch.errors import InvalidValue


class Groove(NamedTuple):
    """The groove of a scratch, and the force that makes it."""

    depth: float
    """d [m]"""
    width: float
    """2a, sqrt(8 P/(pi H)) where there is no layer [m]"""
    ploughing: float
    """hardness times the area that the tip shows to the front [N]"""
    shearing: float
    """tau pi a^2/2 [N]"""
    layer_load: float
    """that the layer carries before it is cut through; 0: no layer [N]"""
    is_cut_through: bool
    """the tip runs on the substrate"""

    @property
    def lateral_force(self) -> float:
        """Ploughing and shearing [N]."""
        return self.ploughing + self.shearing


@dataclass(frozen=True)
class Scratching:
    """A paraboloid that moves through an ideally plastic sample (Bowden and Tabor 1950).

    Parameters
    ----------
    radius : float
        R, of the tip [m].
    hardness : float
        H, of the sample or its layer [Pa]; 3 Y of an ideally plastic one.
    shear_strength : float
        tau, between tip and sample [Pa].
    layer_thickness : float
        t, of a layer [m]; 0: none.
    substrate_hardness : float, optional
        H_s, below the layer [Pa]; needed where there is one.
    """

    radius: float
    hardness: float
    shear_strength: float = 0.0
    layer_thickness: float = 0.0
    substrate_hardness: float | None = None

    def __post_init__(self) -> None:
        if self.layer_thickness > 0.0 and self.substrate_hardness is None:
            raise InvalidValue("substrate_hardness [Pa] is missing: there is a layer")
        _ = self._core

    @cached_property
    def _core(self) -> _core.Scratching:
        substrate = self.hardness if self.substrate_hardness is None else self.substrate_hardness
        return _core.Scratching(self.radius, self.hardness, self.shear_strength, self.layer_thickness, substrate)

    def groove(self, load: float) -> Groove:
        """Under a load [N]: 0 and above, a contact radius up to half of the tip's."""
        return Groove(*self._core.scratch(load))


def worn_volume(coefficient: float, load: float, way: float, *, hardness: float) -> float:
    """Volume worn off [m^3] by a way [m] under a load [N]: K F s/H, H the hardness [Pa] (Archard 1953)."""
    for name, value, unit in (("coefficient", coefficient, ""), ("load", load, "N"), ("way", way, "m")):
        if not (np.isfinite(value) and value >= 0.0):
            raise InvalidValue(f"{name} = {value:g} {unit}: valid is 0 and above")
    check_between("hardness", hardness, "Pa", above=0.0)
    return _core.worn_volume(coefficient, load, way, hardness)


def worn_flat(radius: float, volume: float) -> float:
    """Radius of the flat [m] of a round tip of the radius R [m] that has lost a volume [m^3]: (4 R V/pi)^(1/4)."""
    check_between("radius", radius, "m", above=0.0)
    if not (np.isfinite(volume) and volume >= 0.0):
        raise InvalidValue(f"volume = {volume:g} m^3: valid is 0 and above")
    return _core.worn_flat(radius, volume)
