# SPDX-License-Identifier: BSD-3-Clause
"""Plans against published formulas that are not ours (foreign_formulas.py): cones and pyramids with and without
adhesion, double layers of unlike surfaces, electrostatics at 1 to 10 V, layers, a law of one's own. What a bound does
not cover is said here, and in docs/plan.md."""

from __future__ import annotations

import math
from typing import Any

import foreign_formulas as foreign
import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue

RIGID = {"youngs_modulus": 1e13}
NO_ADHESION = {"work_of_adhesion": 0.0, "hamaker_constant": 0.0}
DRY = {"relative_humidity": 0.0, "film_thickness": 0.0}


def error(plan: nt.Plan, gaps: Any, truth: Any, history: Any = "approach") -> float:
    """As a bound counts it."""
    found = np.asarray(plan.force(gaps, history))
    return float(np.max(np.abs(found - truth) / np.maximum(np.abs(truth), plan.scale)))


@pytest.mark.parametrize("angle", [0.1, 0.3, 0.7, 1.2, 1.5])
@pytest.mark.parametrize("work", [1e-3, 0.05, 5.0])
def test_cone_with_adhesion(angle: float, work: float) -> None:
    """Maugis and Barquins from contact radii 1e-4 above that at the fold of grips on."""
    scene = nt.Scene(
        tip={"shape": "cone", "half_angle": angle}, sample={"youngs_modulus": 1e9, "poisson_ratio": 0.3}, medium=DRY,
        adhesion={"work_of_adhesion": work, "hamaker_constant": 0.0}, range={"maximum_load": 1e-6},
    )  # fmt: skip
    plan = scene.plan(1e-4)
    facts = plan.explain()
    depth, force = foreign.barquins_maugis(facts["effective_modulus"], angle, work)
    inside = (force < 1e-6) & (depth < facts["largest_indentation"])
    assert inside.sum() > 20
    assert error(plan, -depth[inside], force[inside], "retract") <= plan.bound
    deepest = -foreign.barquins_maugis(facts["effective_modulus"], angle, work, 20_000)[1].min()
    assert plan.pull_off_force == pytest.approx(deepest, rel=1e-5)


@pytest.mark.parametrize(("sides", "published", "within"), [(4, 0.7453, 0.0105), (3, 0.8887, 0.0105)])
def test_pyramid(sides: int, published: float, within: float) -> None:
    """Bilodeau's approximate coefficients are 1 % above the exact ones (docs/geometry.md); adhesion is refused."""
    scene = nt.Scene(
        tip={"shape": "cone", "half_angle": 0.7, "sides": sides}, sample={"youngs_modulus": 1e9}, medium=DRY,
        adhesion=NO_ADHESION, range={"maximum_load": 1e-6},
    )  # fmt: skip
    plan = scene.plan(1e-4)
    depth = np.geomspace(1e-10, plan.explain()["largest_indentation"], 20)
    truth = published * plan.explain()["effective_modulus"] * math.tan(0.7) * depth**2
    assert error(plan, -depth, truth) <= within
    scene.adhesion.work_of_adhesion = 0.05
    with pytest.raises(InvalidValue, match=r"tip\.sides"):
        scene.plan(1e-4)


@pytest.mark.parametrize("potentials", [(0.02, -0.04), (0.05, 0.01), (-0.025, -0.025), (0.0, 0.05)])
@pytest.mark.parametrize("ionic_strength", [0.1, 10.0, 1000.0])
def test_double_layer_of_unlike_surfaces(potentials: tuple[float, float], ionic_strength: float) -> None:
    """The pressure of flats at constant potentials, summed over the tip; no contact, so that nothing deforms."""
    scene = nt.Scene(
        tip=RIGID | {"surface_potential": potentials[0]}, sample=RIGID | {"surface_potential": potentials[1]},
        medium={"kind": "liquid", "ionic_strength": ionic_strength}, adhesion=NO_ADHESION, range={"minimum_gap": 5e-10},
    )  # fmt: skip
    length = nt.forces.debye_length(ionic_strength, relative_permittivity=78.4)
    plan = scene.plan(1e-2)
    gaps = np.geomspace(5e-10, 10.0 * length, 30)
    truth = foreign.of_flats(lambda gap: foreign.unlike_flats(gap, potentials, length, 78.4), gaps, 20e-9, length)
    assert error(plan, gaps, truth) <= plan.bound + 1e-8  # of the quadrature, and of the constants' digits


@pytest.mark.parametrize("volts", [1.0, 3.0, 10.0])
@pytest.mark.parametrize("radius", [10e-9, 100e-9, 1e-6])
def test_electrostatics(volts: float, radius: float) -> None:
    """Image charges, exact. Hudlet's form is never weaker, and up to 5.2 % stronger: the error of the law itself, which
    is no part of the bound."""
    scene = nt.Scene(
        tip=RIGID | {"radius": radius}, sample=RIGID, medium={"kind": "vacuum"}, range={"minimum_gap": 1e-9},
        adhesion=NO_ADHESION | {"contact_potential": volts},
    )  # fmt: skip
    plan = scene.plan(1e-2)
    gaps = np.geomspace(1e-9, 1e-5, 60)
    ratio = np.asarray(plan.force(gaps)) / foreign.image_charges(gaps, radius, volts)
    away = np.abs(plan.force(gaps)) > 1e-2 * plan.scale  # farther out a plan may leave it to its bound
    assert np.all(ratio[away] > 1.0 - plan.bound - 1e-9)
    assert np.all(ratio[away] < 1.052 + 100.0 * plan.bound)


@pytest.mark.parametrize("thickness", [1e-6, 3e-6, 1e-5])
def test_layer_is_warned_of(thickness: float) -> None:
    """Contact on a bonded layer is that of a half-space, unless the layer is solved. The warning says by how much the
    layer's force is above it, which Dimitriadis' series confirms to a tenth."""
    scene = nt.Scene(
        tip=RIGID | {"radius": 5e-6}, sample={"youngs_modulus": 1e4, "poisson_ratio": 0.5, "thickness": thickness},
        medium=DRY, adhesion=NO_ADHESION, range={"maximum_load": 1e-10},
    )  # fmt: skip
    plan = scene.plan(1e-2)
    warned = [warning for warning in plan.warnings if "layer" in warning.text]
    depth = plan.explain()["largest_indentation"]
    true = float(foreign.dimitriadis(np.array([depth]), 5e-6, 1e4, thickness)[0])
    missing = true / float(plan.force(-depth)) - 1.0
    assert missing > plan.bound
    assert warned
    assert warned[0].value == pytest.approx(missing, rel=0.1)


@pytest.mark.parametrize(("depth", "decay", "rest"), [(1e-21, 5e9, 4e-10), (1e-20, 1e9, 1e-9), (1e-19, 1e8, 1e-8)])
def test_law_of_ones_own(depth: float, decay: float, rest: float) -> None:
    """Morse's potential, registered."""
    laws = foreign.morse(depth, decay, rest)
    name = f"morse_{-round(math.log10(depth))}"
    nt.scene.register(name, **laws, parameters={}, units={})
    scene = nt.Scene(
        tip=RIGID, sample=RIGID, medium=DRY, adhesion=NO_ADHESION, terms={name: {}}, range={"minimum_gap": 2.5e-10}
    )
    gaps = np.geomspace(2.5e-10, 1e-6, 100)
    truth = np.array([laws["force"](gap) for gap in gaps])
    for demand in (1e-2, 1e-4, 1e-6):
        plan = scene.plan(demand)
        if not plan.explain()["deforms"]:  # even these bodies do, by a part in 1e5, under the stiffest law
            assert error(plan, gaps, truth) <= plan.bound
