# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 11: unloading of silicon, polyester and silicone rubber with the 8 N/m probe, Maugis-Dugdale."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import presets
from nanotouch.contact import Contact, cohesive_stress_atomic, effective_modulus, evaluate, indentation
from nanotouch.forces import kelvin_radius

from nanotouch_app.studies.reproduce import drawing, paper
from nanotouch_app.studies.reproduce.figure9 import film_pressure
from nanotouch_app.studies.reproduce.figure10 import LARGE
from nanotouch_app.studies.reproduce.statement import Floats, Parameter, Reproduction, Statement, holds, quantity
from nanotouch_app.studies.reproduce.unloading import Path, unload

DEEPEST, APART = Parameter("largest displacement", 100e-9, "m", "not in the text"), -100e-9
SCENES: dict[str, nt.Scene] = {
    "silicon": presets.paper_silicon()[0],
    "polyester": presets.paper_polyester()[0],
    "silicone rubber": presets.paper_silicone_rubber()[0],
}
RUBBER_WORK = Parameter(
    "work of adhesion of silicone rubber", SCENES["silicone rubber"].adhesion.work_of_adhesion, "J/m^2",
    "no number in the text: twice 22 mJ/m2, as water does not wet it (Chaudhury and Whitesides 1991)",
)  # fmt: skip
PARAMETERS = (
    paper.TIP, paper.SILICON, paper.SILICON_RATIO, paper.POLYESTER, paper.RUBBER,
    Parameter("Poisson ratio of polyester", SCENES["polyester"].sample.poisson_ratio, "", "handbook"),
    Parameter("Poisson ratio of silicone rubber", SCENES["silicone rubber"].sample.poisson_ratio, "", "incompressible"),
    paper.WORK, RUBBER_WORK, paper.HUMIDITY,
    paper.CANTILEVER, paper.TILT, DEEPEST,
)  # fmt: skip


def body(scene: nt.Scene) -> Contact:
    """The scene's contact: under water w = 2 gamma_L and Laplace's pressure (erratum E12), else of the solids."""
    modulus = effective_modulus(
        scene.tip.youngs_modulus, scene.tip.poisson_ratio, scene.sample.youngs_modulus, scene.sample.poisson_ratio
    )
    tension, work = scene.medium.surface_tension, scene.adhesion.work_of_adhesion
    if tension > 0.0:
        pressure = tension / kelvin_radius(scene.medium.relative_humidity, surface_tension=tension)
        return Contact(scene.tip.radius, modulus, 2.0 * tension, cohesive_stress=pressure)
    stress = cohesive_stress_atomic(work, scene.adhesion.equilibrium_distance)
    return Contact(scene.tip.radius, modulus, work, cohesive_stress=stress)


def unloadings() -> dict[str, Path]:
    """Sample -> unloading curve."""
    return {name: unload("maugis", body(scene), 1.05 * DEEPEST.value, APART) for name, scene in SCENES.items()}


def slope(path: Path) -> float:
    """dP/dDelta where the load passes zero [N/m]: the one state that all samples share."""
    middle, half = path.displacement_at(0.0), 0.1e-9
    low, high = path.at(np.array([middle - half, middle + half])).force
    return float(high - low) / (2.0 * half)


def strain(contact: Contact) -> float:
    """a/R at zero load."""
    return float(evaluate("maugis", indentation("maugis", 0.0, contact), contact).a) / contact.radius


def reproduce() -> Reproduction:
    """Compute the figure."""
    paths = unloadings()
    displacement = np.linspace(0.95 * APART, DEEPEST.value, 3901)
    columns = {"stage displacement [m]": displacement}
    for name, path in paths.items():
        at = path.at(displacement)
        columns |= {f"{name} load [N]": at.force, f"{name} contact radius [m]": at.radius}
    statements = (_steeper(paths), _pull_off(paths), *(_letting_go(*one) for one in paths.items()), _validity())
    return Reproduction(
        11, "unloading of silicon, polyester and silicone rubber", PARAMETERS, columns, statements,
        lambda figure: _draw(figure, columns),
    )  # fmt: skip


def _steeper(paths: dict[str, Path]) -> Statement:
    slopes = [slope(path) for path in paths.values()]
    facts = [
        f"{quantity(s, 'N/m')} on {name} (a/R = {strain(body(SCENES[name])):.2g})"
        for s, name in zip(slopes, paths, strict=True)
    ]
    return Statement(
        "larger E_s has a steeper slope", "III-B, Fig. 11", holds(all(np.diff(slopes) < 0.0)),
        "slope on silicon over that on polyester, at zero load", slopes[0] / slopes[1], "",
        f"{', '.join(facts)}: silicon is nearly as steep as the 8 N/m probe allows. Above a/R = {LARGE} "
        "the number is no more than a guide.",
    )  # fmt: skip


def _pull_off(paths: dict[str, Path]) -> Statement:
    shares = [
        path.pull_off / (math.pi * contact.work_of_adhesion * contact.radius)
        for path, contact in ((path, body(SCENES[name])) for name, path in paths.items())
    ]
    facts = ", ".join(f"{quantity(path.pull_off, 'N')} on {name}" for name, path in paths.items())
    spread = max(shares) / min(shares)
    return Statement(
        "the pull-off point gives information about the adhesion", "III-B, Fig. 11", holds(spread < 2.0 / 1.5),
        "largest over smallest pull-off force per pi w R", spread, "",
        f"{facts}. Between 1.5 and 2 pi w R whatever the stiffness: the force tells w to within a third. "
        "Where it happens tells the stiffness as well.",
    )  # fmt: skip


def _letting_go(name: str, path: Path) -> Statement:
    return Statement(
        f"measured unloading curve of {name}", "III-B, Fig. 11", "cannot be compared",
        "stage displacement at pull-off", path.let_go, "m",
        f"The text gives no number for the curve. a/R is {strain(body(SCENES[name])):.2g} at zero load.",
    )  # fmt: skip


def rubber_strain() -> float:
    """a/R at zero load on silicone rubber with the paper's water film, R = 30 nm."""
    ratio = SCENES["silicone rubber"].sample.poisson_ratio
    modulus = effective_modulus(paper.SILICON.value, paper.SILICON_RATIO.value, paper.RUBBER.value, ratio)
    return strain(Contact(paper.OTHER_TIP.value, modulus, paper.WORK.value, cohesive_stress=film_pressure()))


def _validity() -> Statement:
    ratio = rubber_strain()
    return Statement(
        "MD can be applied to all cases without any assumption", "VIII; III-B", holds(ratio <= LARGE),
        "a/R on silicone rubber at zero load, w = 2 gamma_L, R = 30 nm", ratio, "",
        "Half-space and paraboloid need a much smaller than R (erratum E13); the contact is wider than the tip.",
    )  # fmt: skip


def _draw(figure: Any, columns: dict[str, Floats]) -> None:
    panels = figure.subplots(1, 3)
    x = columns["stage displacement [m]"] * 1e9
    for name, (colour, style) in zip(SCENES, drawing.LOOKS, strict=False):
        valid = strain(body(SCENES[name])) <= LARGE
        label = name if valid else f"{name} (a/R above {LARGE})"
        for panel in panels:
            panel.plot(x, columns[f"{name} load [N]"] * 1e9, color=colour, ls=style, label=label)
    views = (("Load on unloading", None, None), ("Pull-off", (-6.0, 6.0), (-22.0, 32.0)), ("Rubber", None, (-6.0, 6.0)))
    for panel, (title, across, up) in zip(panels, views, strict=True):
        panel.set(xlim=across, ylim=up)
        drawing.zero(panel)
        legend = "upper left" if panel is panels[0] else None
        drawing.dress(panel, title, r"stage displacement $\Delta$ (nm)", "load $P$, + repulsive (nN)", legend)
