# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 9: load and contact radius against stage displacement, four theories, silicon on silicon, unloading."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from nanotouch.contact import MODELS, Contact, cohesive_stress_atomic, effective_modulus
from nanotouch.forces import kelvin_radius

from nanotouch_app.studies.reproduce import drawing, paper
from nanotouch_app.studies.reproduce.statement import Floats, Parameter, Reproduction, Statement, holds, near
from nanotouch_app.studies.reproduce.unloading import Path, unload

TITLES = {"hertz": "Hertz", "dmt": "DMT", "jkr": "JKR", "maugis": "MD", "film": "MD, film's pressure (E12)"}
DEEPEST, APART = Parameter("largest displacement", 20e-9, "m", "not in the text"), -4e-9
COMPARED = Parameter("displacement at which the theories are compared", 10e-9, "m", "half of the range shown")
PARAMETERS = (
    paper.TIP, paper.OTHER_TIP, paper.SILICON, paper.SILICON_RATIO, paper.WORK, paper.DISTANCE, paper.HUMIDITY,
    paper.CANTILEVER,
    paper.TILT, paper.SLOPE, DEEPEST, COMPARED,
)  # fmt: skip


def film_pressure() -> float:
    """Laplace's pressure [Pa] in the water film, gamma_L/r1 with r1 from the humidity (erratum E12)."""
    return paper.WATER.value / kelvin_radius(paper.HUMIDITY.value, surface_tension=paper.WATER.value)


def body(
    sample_modulus: float = paper.SILICON.value, radius: float = paper.TIP.value, stress: float | None = None
) -> Contact:
    """The paper's silicon tip on a sample; by default with its cohesive stress 1.03 w/a0 (w added: erratum E9)."""
    ratio = paper.SILICON_RATIO.value
    modulus = effective_modulus(paper.SILICON.value, ratio, sample_modulus, ratio)
    atomic = cohesive_stress_atomic(paper.WORK.value, paper.DISTANCE.value)
    return Contact(radius, modulus, paper.WORK.value, cohesive_stress=stress or atomic)


def unloadings(radius: float = paper.TIP.value) -> dict[str, Path]:
    """The four theories' unloading curves, and that of MD under the film's pressure."""
    start, stop = 1.1 * DEEPEST.value, 2.0 * APART
    paths: dict[str, Path] = {model: unload(model, body(radius=radius), start, stop) for model in MODELS}
    film = body(radius=radius, stress=film_pressure())
    return {**paths, "film": unload("maugis", film, start, stop)}


def reproduce() -> Reproduction:
    """Compute the figure."""
    paths, others = unloadings(), unloadings(paper.OTHER_TIP.value)
    displacement = np.linspace(APART, DEEPEST.value, 1201)
    columns = {"stage displacement [m]": displacement}
    for model, path in paths.items():
        at = path.at(displacement)
        columns |= {f"{model} load [N]": at.force, f"{model} contact radius [m]": at.radius}
    return Reproduction(
        9, "unloading of silicon from silicon, four theories", PARAMETERS, columns,
        (
            *(_area(model, sign, paths, others) for model, sign in (("jkr", 1.0), ("dmt", -1.0), ("hertz", -1.0))),
            _load("dmt", paths), _load("hertz", paths), _slope(paths["maugis"]), _stress(paths), _eq_8(others["hertz"]),
        ),
        lambda figure: _draw(figure, columns, paths["maugis"]),
    )  # fmt: skip


def excess_area(paths: dict[str, Path], model: str, displacement: Floats | float) -> Floats:
    """Contact area of a theory over that of MD, minus 1, at stage displacements [m]."""
    return (paths[model].at(displacement).radius / paths["maugis"].at(displacement).radius) ** 2 - 1.0


def excess_load(paths: dict[str, Path], model: str, displacement: float, from_zero_load: bool = False) -> float:
    """Load of a theory over that of MD [N] at a stage displacement [m] from first touch or each one's zero load."""
    loads = []
    for name in (model, "maugis"):
        start = paths[name].displacement_at(0.0) if from_zero_load and name != "hertz" else 0.0
        loads.append(float(paths[name].at(displacement + start).force))
    return loads[0] - loads[1]


def _area(model: str, sign: float, paths: dict[str, Path], others: dict[str, Path]) -> Statement:
    inside = np.linspace(1e-9, DEEPEST.value, 39)
    excess = np.array([excess_area(family, model, inside) for family in (paths, others)])
    at, other = (float(excess_area(family, model, COMPARED.value)) for family in (paths, others))
    near_, far = 100.0 * excess[0][[0, -1]]
    return Statement(
        f"{TITLES[model]} {'over' if sign > 0.0 else 'under'}estimates the contact area", "III-B, Fig. 9",
        holds(bool(np.all(sign * excess > 0.0))),
        f"area over that of MD, minus 1, at {COMPARED.value * 1e9:g} nm", at, "",
        f"{near_:+.0f} % at 1 nm, {far:+.0f} % at {DEEPEST.value * 1e9:g} nm; with R = 30 nm {100 * other:+.0f} % "
        f"at {COMPARED.value * 1e9:g} nm. Against MD, as the radius was not measured.",
    )  # fmt: skip


def _load(model: str, paths: dict[str, Path]) -> Statement:
    touch, level = (excess_load(paths, model, COMPARED.value, start) for start in (False, True))
    share = max(abs(touch), abs(level)) / float(paths["maugis"].at(COMPARED.value).force)
    return Statement(
        f"{TITLES[model]} underestimates the applied load", "III-B, Fig. 9", holds(touch < 0.0),
        f"load minus that of MD at {COMPARED.value * 1e9:g} nm", touch, "N",
        f"Displacement from first touch; from each theory's own zero load it is {level * 1e9:+.2f} nN. "
        f"The larger is {100 * share:.1g} % of the load; the rig resolves 13 nN.",
    )  # fmt: skip


def _stress(paths: dict[str, Path]) -> Statement:
    contacts = body(), body(stress=film_pressure())
    ratio = contacts[1].maugis_lambda / contacts[0].maugis_lambda
    area = float(excess_area(paths, "film", COMPARED.value))
    return Statement(
        "the annulus of the MD model is under 1.03 w/a0 with w = 2 gamma_L", "III-B, Eq. 11", holds(near(ratio)),
        "lambda with the film's Laplace pressure over that with 1.03 w/a0", ratio, "",
        f"{contacts[1].maugis_lambda:.2g} instead of {contacts[0].maugis_lambda:.2g}: water pulls with gamma_L/r1 "
        f"over 2 r1 (erratum E12). The area at {COMPARED.value * 1e9:g} nm changes by {100 * area:+.0f} %.",
    )  # fmt: skip


def _slope(maugis: Path) -> Statement:
    rise = float(np.ptp(maugis.at(np.array([0.0, DEEPEST.value])).force)) / DEEPEST.value
    tilt = math.degrees(math.acos(paper.CANTILEVER.value / paper.SLOPE.value))
    stiffest = paper.CANTILEVER.value / math.cos(paper.TILT.value)
    return Statement(
        "the unloading measured with the 8 N/m probe has a slope of 8.5 N/m", "III-B, Fig. 9",
        holds(paper.SLOPE.value <= stiffest),
        f"slope of MD over 0 .. {DEEPEST.value * 1e9:g} nm", rise, "N/m",
        f"Probe and contact are springs in series: no contact law gives more than k_c/cos(alpha) = {stiffest:g} N/m. "
        f"8.5 N/m needs a k_c of more than that, or a tilt above {tilt:.1f} degrees; the text says 'around 8 N/m'.",
    )  # fmt: skip


def eq_8_indentation(displacement: float, radius: float) -> float:
    """The paper's Eq. 8 [m]: Hertz with a = sqrt(2 Delta R), the radius taken from the stage's displacement (E8)."""
    modulus = 4.0 / 3.0 * body(radius=radius).effective_modulus
    spring = paper.CANTILEVER.value
    tilt = math.cos(paper.TILT.value)
    return spring * displacement / (spring + modulus * tilt * math.sqrt(2.0 * displacement * radius))


def _eq_8(hertz: Path) -> Statement:
    first, last = (
        eq_8_indentation(at, paper.OTHER_TIP.value) / float(hertz.at(at).indentation) for at in (1e-9, DEEPEST.value)
    )
    return Statement(
        "the contact radius may be taken as sqrt(2 Delta R) (Eq. 8)", "III-B", holds(near(first)),
        "indentation of Eq. 8 over that of Eq. 6 (Hertz), at 1 nm, R = 30 nm", first, "",
        f"At {DEEPEST.value * 1e9:g} nm it is {last:.3g}: the stage mostly moves the probe (erratum E8).",
    )  # fmt: skip


def _draw(figure: Any, columns: dict[str, Floats], maugis: Path) -> None:
    left, right = figure.subplots(1, 2)
    across = columns["stage displacement [m]"] * 1e9
    inset = left.inset_axes([0.60, 0.09, 0.38, 0.42])
    for (model, title), (colour, style) in zip(TITLES.items(), drawing.LOOKS, strict=False):
        for panel in (left, inset):
            panel.plot(across, columns[f"{model} load [N]"] * 1e9, color=colour, ls=style, label=title)
        right.plot(across, columns[f"{model} contact radius [m]"] * 1e9, color=colour, ls=style, label=title)
    start = maugis.displacement_at(0.0) * 1e9
    left.plot(across, paper.SLOPE.value * (across - start), color=drawing.GREY, lw=1.0, ls=(0, (1, 2)),
              label="measured slope, 8.5 N/m, drawn through MD's zero load")  # fmt: skip
    inset.set(xlim=(-3.0, 1.0), ylim=(-20.0, 5.0))
    inset.tick_params(labelsize="x-small")
    inset.grid(alpha=0.3)
    left.set_ylim(-25.0, 180.0)
    drawing.zero(left)
    across_label = r"stage displacement $\Delta$ (nm)"
    drawing.dress(left, "Load on unloading, + repulsive", across_label, "load $P$ (nN)", "upper left")
    drawing.dress(right, "Contact radius", across_label, "contact radius $a$ (nm)", "lower right")
