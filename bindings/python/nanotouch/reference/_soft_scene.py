# SPDX-License-Identifier: BSD-3-Clause
"""The force of a scene without adhesion whose sample deforms, composed from the laws of :mod:`nanotouch.forces` and
solved by :class:`nanotouch.reference.Deformation`; it shares no code with plans."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import forces as laws
from nanotouch._arrays import Floats, LawValue, as_floats
from nanotouch.reference._deformation import Deformation, Deformed
from nanotouch.reference._half_space import Layer
from nanotouch.reference._pressures import Pressure
from nanotouch.scene import Scene

_CLOSE = 1e-12
"""a minimum gap that is none [m]"""


def deformed_force(scene: Scene, gap: ArrayLike) -> Floats:
    """Force on the tip [N] at gaps [m] in falling order; see :func:`deformed`."""
    return np.array([here.force for here in deformed(scene, gap)[0]])


def deformed(scene: Scene, gap: ArrayLike) -> tuple[list[Deformed], float | None]:
    """The equilibria at gaps [m] in falling order: van der Waals, double layer, hydration and brush, in contact Hertz
    with them. Bodies touch at the interatomic distance; between there and gap 0 the force stays. And the gap at which
    contact begins, if it was reached [m]."""
    sample, hold = _sample(scene), scene.adhesion.equilibrium_distance
    found = []
    for here in as_floats(gap, "gap"):
        last = sample.curve([here - hold])[0] if sample.touch is None else None
        if sample.touch is not None:
            last = sample.curve([here - hold if here - hold >= sample.touch else min(sample.touch, here)])[0]
        assert last is not None
        found.append(last)
    return found, sample.touch


def _sample(scene: Scene) -> Deformation:
    law = _pressure(scene, scene.adhesion.equilibrium_distance)
    modulus, share = _modulus(scene)
    thickness = scene.sample.thickness
    layer = Layer(thickness, scene.sample.poisson_ratio, share) if thickness > 0.0 else None
    return Deformation(law, scene.tip.radius, modulus, layer, tolerance=1e-6)


def _modulus(scene: Scene) -> tuple[float, float]:
    """E*, and the share of the compliance that is the sample's."""
    compliance = [(1.0 - body.poisson_ratio**2) / body.youngs_modulus for body in (scene.tip, scene.sample)]
    return 1.0 / sum(compliance), compliance[1] / sum(compliance)


def _pressure(scene: Scene, hold: float) -> Pressure:
    """Of all laws, over the gap from where the bodies touch; p = k/(2 pi R), as Derjaguin has it."""
    evals = _laws(scene)
    per_area = 2.0 * np.pi * scene.tip.radius

    def pressure(g: Floats) -> Floats:
        return np.asarray(sum(evaluate(g + hold).k for evaluate in evals) / per_area)

    def energy(g: Floats) -> Floats:
        return np.asarray(sum(evaluate(g + hold).F for evaluate in evals) / per_area)

    brush = scene.medium.brush_thickness
    ends = (brush - hold,) if brush > hold else ()
    return Pressure(pressure, energy, ends, diverges=brush > 10.0 * hold)  # bodies with brushes do not touch


def _laws(scene: Scene) -> list[Callable[[Floats], LawValue]]:
    tip, sample, medium, distance = scene.tip, scene.sample, scene.medium, scene.adhesion.equilibrium_distance
    radius: dict[str, Any] = {"radius": tip.radius}
    found: list[Callable[[Floats], LawValue]] = []
    if scene.adhesion.hamaker_constant > 0.0:
        found.append(
            lambda g: laws.vdw_derjaguin(
                g,
                hamaker_constant=scene.adhesion.hamaker_constant,
                roughness=sample.roughness + 2.0 * distance,
                minimum_gap=_CLOSE,
                **radius,
            )
        )
    if medium.ionic_strength > 0.0:
        debye = laws.debye_length(
            medium.ionic_strength,
            relative_permittivity=medium.relative_permittivity,
            temperature=medium.temperature,
        )
        found.append(
            lambda g: laws.double_layer(
                g,
                debye_length=debye,
                relative_permittivity=medium.relative_permittivity,
                tip_potential=tip.surface_potential,
                sample_potential=sample.surface_potential,
                minimum_gap=_CLOSE,
                **radius,
            )
        )
    if medium.hydration_energy != 0.0:
        found.append(
            lambda g: laws.hydration(
                g, amplitude=medium.hydration_energy, decay_length=medium.hydration_length, minimum_gap=0.0, **radius
            )
        )
    if medium.brush_thickness > distance:
        found.append(
            lambda g: laws.steric(
                g,
                thickness=medium.brush_thickness,
                spacing=medium.brush_spacing,
                temperature=medium.temperature,
                minimum_gap=_CLOSE,
                **radius,
            )
        )
    return found
