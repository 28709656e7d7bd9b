# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 6: van der Waals, capillary and electrostatic force of a silicon tip on gold, as printed and corrected."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from nanotouch import forces

from nanotouch_app.studies.reproduce import drawing, paper
from nanotouch_app.studies.reproduce.statement import Floats, Parameter, Reproduction, Statement, holds, near, quantity
from nanotouch_app.studies.reproduce.unloading import bisect

FARTHEST = Parameter("largest gap", 100e-9, "m", "Eq. 1, 'h <= 100 nm'")
PARAMETERS = (
    paper.GOLD_TIP, paper.HAMAKER, paper.DISTANCE, paper.FILM, paper.MENISCUS, paper.WATER, paper.POTENTIAL,
    paper.PERMITTIVITY, FARTHEST,
)  # fmt: skip
TITLES = {"vdw": "van der Waals", "cap": "capillary", "el": "electrostatic"}
RUPTURE = 2.0 * (paper.FILM.value + paper.MENISCUS.value)

Forces = dict[str, Floats]


def literal(gap: Floats | float) -> Forces:
    """Eq. 1 as printed, with b = 0 [N]."""
    h, radius = np.asarray(gap, dtype=float), paper.GOLD_TIP.value
    bracket = 1.0 - (h - 2.0 * paper.FILM.value) / (2.0 * paper.MENISCUS.value)
    area = 4.0 * math.pi * radius * paper.MENISCUS.value
    return {
        "vdw": -paper.HAMAKER.value * radius / (6.0 * h**2),
        "cap": -4.0 * math.pi * paper.WATER.value * radius * bracket,
        "el": -paper.PERMITTIVITY.value * paper.POTENTIAL.value**2 * area / (2.0 * h**2),
    }


def corrected(gap: Floats | float) -> Forces:
    """The library's laws with the same parameters [N]; capillary: of a standing bridge."""
    h = np.asarray(gap, dtype=float)
    common = {"radius": paper.GOLD_TIP.value, "minimum_gap": paper.DISTANCE.value}
    bridge = forces.capillary(
        h, radius=paper.GOLD_TIP.value, surface_tension=paper.WATER.value, meniscus_radius=paper.MENISCUS.value,
        film_thickness=paper.FILM.value,
    )  # fmt: skip
    return {
        "vdw": np.asarray(forces.vdw(h, hamaker_constant=paper.HAMAKER.value, **common).F),
        "cap": np.asarray(bridge.F),
        "el": np.asarray(forces.electrostatic(h, potential=paper.POTENTIAL.value, **common).F),
    }


def reproduce() -> Reproduction:
    """Compute the figure."""
    gap = np.unique(np.concatenate([np.geomspace(paper.DISTANCE.value, FARTHEST.value, 1201), [RUPTURE]]))
    printed, right = literal(gap), corrected(gap)
    columns = {"gap [m]": gap}
    columns |= {f"printed {TITLES[law]} force [N]": force for law, force in printed.items()}
    columns |= {f"corrected {TITLES[law]} force [N]": force for law, force in right.items()}
    statements = (_order(), _caption(), _dominance(), _neglected(), _derjaguin(), _roughness(), _capillary(), _plate())
    return Reproduction(
        6, "forces without contact, silicon on gold", PARAMETERS, columns, statements,
        lambda figure: _draw(figure, gap, {"as printed (Eq. 1)": printed, "corrected": right}),
    )  # fmt: skip


def end_of_order() -> float:
    """The gap [m] up to which cap > vdW > el: where the falling capillary force, as printed, meets van der Waals."""

    def less(h: Floats) -> Floats:
        return abs(literal(h)["vdw"]) - abs(literal(h)["cap"])

    return float(bisect(less, 2.0 * paper.FILM.value, RUPTURE))


def caption_sliver() -> float:
    """The width [m] of the gaps with vdW > cap > el in magnitude, on both sides of the printed law's change of sign."""

    def less(law: str, side: float) -> float:
        """From the change of sign out to where cap is as large as the law."""

        def excess(distance: Floats) -> Floats:
            force = literal(RUPTURE + side * distance)
            return abs(force["cap"]) - abs(force[law])

        return float(bisect(excess, 0.0, 0.01e-9))

    return sum(less("vdw", side) - less("el", side) for side in (-1.0, 1.0))


def electrostatic_takes_over() -> float:
    """The gap [m] beyond which the electrostatic force exceeds van der Waals, both corrected."""

    def excess(h: Floats) -> Floats:
        force = corrected(h)
        return abs(force["el"]) - abs(force["vdw"])

    return float(bisect(excess, 1e-9, FARTHEST.value))


def _ratio(one: Forces, law: str, other: Forces, other_law: str) -> float:
    return float(one[law] / other[other_law])


def _order() -> Statement:
    end = end_of_order()
    inside = np.geomspace(paper.DISTANCE.value, 0.9999 * end, 500)
    every = True
    for force in (literal(inside), corrected(inside)):
        cap, vdw, el = (abs(force[law]) for law in ("cap", "vdw", "el"))
        every = every and bool(np.all(cap > vdw) and np.all(vdw > el))
    return Statement(
        "F_cap > F_vdw > F_el for the given case", "III-A", holds(every), "holds up to a gap of", end, "m",
        "As printed and corrected alike. Beyond, where the bridge ends, van der Waals leads.",
    )  # fmt: skip


def _caption() -> Statement:
    width = caption_sliver()
    return Statement(
        "Fig. 6 from top to bottom: vdW, cap, el", "III-A, caption", holds(width > 0.5 * FARTHEST.value),
        "width of all gaps with that order of magnitudes", width, "m",
        "The text's own order has cap on top; only where the printed capillary force changes sign does it pass below "
        "the others. With signs el is uppermost (erratum E18).",
    )  # fmt: skip


def _dominance() -> Statement:
    at = paper.DISTANCE.value
    right, printed = corrected(at), literal(at)
    return Statement(
        "F_cap dominates F_vdw in air for hydrophilic surfaces", "III-A",
        holds(_ratio(right, "cap", right, "vdw") > 1.0), "capillary over van der Waals at a0, corrected",
        _ratio(right, "cap", right, "vdw"), "",
        f"Hardly at contact (as printed {_ratio(printed, 'cap', printed, 'vdw'):.2g} times), and "
        f"{_ratio(corrected(5e-9), 'cap', corrected(5e-9), 'vdw'):.0f} times at 5 nm.",
    )  # fmt: skip


def _neglected() -> Statement:
    at = corrected(paper.DISTANCE.value)
    over = electrostatic_takes_over()
    return Statement(
        "F_el can be neglected for a grounded (semi)conductor", "III-A", "cannot be compared",
        "gap beyond which F_el of the given 0.25 V exceeds van der Waals", over, "m",
        f"Grounded says nothing about the contact potential, which is the U of Fig. 6. At a0 it adds "
        f"{100 * _ratio(at, 'el', at, 'vdw'):.1g} % of van der Waals; far away it is the largest force.",
    )  # fmt: skip


def _derjaguin() -> Statement:
    excess = [_ratio(literal(h), "vdw", corrected(h), "vdw") - 1.0 for h in (10e-9, FARTHEST.value)]
    return Statement(
        "F_vdw = -HR/(6 h^2) for h <= 100 nm", "III-A, Eq. 1", holds(near(1.0 + excess[1])),
        "printed over exact sphere at 100 nm, minus 1", excess[1], "",
        f"At 10 nm {excess[0]:.2g}: it needs h much smaller than R (erratum E1).",
    )  # fmt: skip


def _roughness() -> Statement:
    common = {"radius": paper.GOLD_TIP.value, "hamaker_constant": paper.HAMAKER.value, "minimum_gap": 1e-12}
    factors = [factor(h) for h in (0.2e-9, 1e-9, 10e-9)]
    exact = float(forces.vdw(1e-9, roughness=1e-9, **common).F / forces.vdw(1e-9, **common).F)
    return Statement(
        "b can exponentially decrease the surface forces", "III-A", holds(near(factor(1e-9, 2e-9) / factor(1e-9) ** 2)),
        "(h/(h + b/2))^2 for b = 1 nm at h = 1 nm", factors[1], "",
        f"{factors[0]:.2f} at 0.2 nm, {factors[2]:.2f} at 10 nm. Algebraic: twice the b leaves "
        f"{factor(1e-9, 2e-9):.2f}, not the square, {factors[1] ** 2:.2f} (erratum E2). The exact sphere: {exact:.2f}.",
    )  # fmt: skip


def factor(gap: float, roughness: float = 1e-9) -> float:
    """What a roughness [m] leaves of the printed van der Waals force at a gap [m]."""
    return (gap / (gap + roughness / 2.0)) ** 2


def _capillary() -> Statement:
    close, apart = literal(paper.DISTANCE.value), literal(30e-9)
    return Statement(
        "F_cap = -4 pi gamma_L R [1 - (h - 2e)/(2 r1)] at every h", "III-A, Eq. 1", holds(float(apart["cap"]) <= 0.0),
        "printed capillary force at 30 nm, repulsive", float(apart["cap"]), "N",
        f"And {quantity(-float(close['cap']), 'N')} of attraction at a0, where a bridge can pull "
        f"{quantity(-float(corrected(0.0)['cap']), 'N')}: the bracket belongs between 0 and 1 (erratum E3).",
    )  # fmt: skip


def _plate() -> Statement:
    ratios = [_ratio(literal(h), "el", corrected(h), "el") for h in (paper.DISTANCE.value, 10e-9)]
    return Statement(
        "F_el = -eps0 U^2 S/(2 h^2) with S = 4 pi R r1", "III-A, Eq. 1", holds(near(ratios[0])),
        "printed over sphere and plane (Hudlet) at a0", ratios[0], "",
        f"At 10 nm {ratios[1]:.2g}: a plate law with the area of a meniscus (erratum E5).",
    )  # fmt: skip


def _draw(figure: Any, gap: Floats, sets: Mapping[str, Forces]) -> None:
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for panel, (title, force) in zip(panels, sets.items(), strict=True):
        for (law, name), (colour, _) in zip(TITLES.items(), drawing.LOOKS, strict=False):
            for sign, style, label in ((-1.0, "-", name), (1.0, ":", f"{name}, repulsive")):
                part = np.where(sign * force[law] > 0.0, abs(force[law]), np.nan)
                if np.any(np.isfinite(part)):
                    panel.loglog(gap * 1e9, part * 1e9, color=colour, ls=style, label=label)
        panel.axvline(RUPTURE * 1e9, color=drawing.GREY, lw=0.8, ls="--")
        panel.text(RUPTURE * 1e9, 5e-6, "$2e+2r_1$ ", color=drawing.GREY, fontsize="small", ha="right")
        panel.set_ylim(1e-6, 1e3)
        drawing.dress(panel, f"Magnitudes, {title}", "gap $h$ (nm)", "force (nN)", "lower left")
