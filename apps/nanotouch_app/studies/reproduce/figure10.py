# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 10: Maugis-Dugdale's load, contact radius and m = c/a on unloading, for samples of different stiffness."""

from __future__ import annotations

from typing import Any

import numpy as np
from nanotouch.contact import Contact, Model, evaluate, indentation, pull_off_force

from nanotouch_app.studies.reproduce import drawing, paper
from nanotouch_app.studies.reproduce.figure9 import APART, COMPARED, DEEPEST, body
from nanotouch_app.studies.reproduce.statement import (
    TOLERANCE,
    Floats,
    Parameter,
    Reproduction,
    Statement,
    holds,
    quantity,
)
from nanotouch_app.studies.reproduce.unloading import Path, bisect, unload

SOFTEST = -30e-9  # stage displacement [m] at which also the softest sample has let go
MODULI = (
    paper.SILICON, Parameter("Young's modulus E_s", 20e9, "Pa", "not in the text; between silicon and polyester"),
    paper.POLYESTER, paper.MICA,
)  # fmt: skip
LARGE = 0.3  # a/R above which a sphere is no paraboloid
PARAMETERS = (
    paper.TIP, *MODULI, paper.SILICON_RATIO, paper.WORK, paper.DISTANCE, paper.CANTILEVER, paper.TILT, DEEPEST,
    COMPARED,
    Parameter("a/R up to which the law is valid", LARGE, "", "erratum E13"),
)  # fmt: skip


def dugdale_ratio(lam: float, radius: Floats) -> Floats:
    """m = c/a of the Dugdale zone at contact radii in units of (pi w R^2/K)^(1/3); NaN without contact.

    Solves Eq. 11 for y = 1/sqrt(m^2 - 1), in which the radius rises: a = b y, b^2 g1 lam/2 + b B = 1.
    """

    def reduced_radius(log_y: Floats) -> Floats:
        y = np.exp(log_y)
        t = np.arctan2(1.0, y)
        g1, g2 = y + (1.0 - y**2) * t, t - 1.0 / (np.sqrt(1.0 + y**2) + y)
        B = 4.0 / 3.0 * lam**2 * g2
        radius: Floats = 2.0 * y / (B + np.sqrt(B**2 + 2.0 * lam * g1))
        return radius

    radius = np.asarray(radius, dtype=float)
    y = np.exp(bisect(lambda log_y: reduced_radius(log_y) - radius, np.full(radius.shape, -20.0), 9.0))
    return np.where(radius > 0.0, np.sqrt(1.0 + y**-2), np.nan)


def contact_ratio(contact: Contact, radius: Floats) -> Floats:
    """m = c/a at contact radii [m]."""
    stiffness = 4.0 / 3.0 * contact.effective_modulus
    unit = np.cbrt(np.pi * contact.work_of_adhesion * contact.radius**2 / stiffness)
    return dugdale_ratio(contact.maugis_lambda, np.asarray(radius) / unit)


def unloadings() -> dict[float, Path]:
    """Young's modulus of the sample [Pa] -> MD's unloading curve."""
    return {E.value: unload("maugis", body(E.value), 1.1 * DEEPEST.value, SOFTEST) for E in MODULI}


def reproduce() -> Reproduction:
    """Compute the figure."""
    paths = unloadings()
    displacement = np.linspace(3.0 * APART, DEEPEST.value, 1601)
    columns = {"stage displacement [m]": displacement}
    for modulus, path in paths.items():
        at, name = path.at(displacement), quantity_of(modulus)
        columns |= {f"{name} load [N]": at.force, f"{name} contact radius [m]": at.radius}
        columns |= {f"{name} m = c/a []": contact_ratio(body(modulus), at.radius)}
    statements = (*_softer(paths), _meaning_of_m(paths), *_thresholds(), _limits())
    return Reproduction(
        10, "Maugis-Dugdale for samples of different stiffness", PARAMETERS, columns, statements,
        lambda figure: _draw(figure, columns),
    )  # fmt: skip


def quantity_of(modulus: float) -> str:
    """``"E_s 2 GPa"``"""
    return f"E_s {modulus / 1e9:g} GPa"


def _softer(paths: dict[float, Path]) -> list[Statement]:
    at = {modulus: path.at(COMPARED.value) for modulus, path in paths.items()}
    radii, loads = ([float(getattr(one, what)) for one in at.values()] for what in ("radius", "force"))
    names = ", ".join(f"{E / 1e9:g}" for E in at)
    outside = ", ".join(f"{E / 1e9:g} GPa" for E, r in zip(at, radii, strict=True) if r > LARGE * paper.TIP.value)
    where, section = f"at {COMPARED.value * 1e9:g} nm", "III-B, Fig. 10"
    return [
        Statement(
            "as the surface becomes softer the contact area increases", section,
            holds(all(np.diff(radii) > 0.0)), f"contact radius on 20 GPa over that on 135 GPa, {where}",
            radii[1] / radii[0], "",
            f"{', '.join(quantity(r, 'm') for r in radii)} for {names} GPa; a/R is above {LARGE} for {outside}, "
            "outside the law's validity.",
        ),
        Statement(
            "as the surface becomes softer the applied load decreases", section, holds(all(np.diff(loads) < 0.0)),
            f"load on 20 GPa over that on 135 GPa, {where}", loads[1] / loads[0], "",
            f"{', '.join(quantity(load, 'N') for load in loads)} for {names} GPa: the stage's way goes into the sample "
            "instead of the probe.",
        ),
    ]  # fmt: skip


def _meaning_of_m(paths: dict[float, Path]) -> Statement:
    ratio = float(contact_ratio(body(), paths[paper.SILICON.value].at(COMPARED.value).radius))
    return Statement(
        "m is the width of the annulus over a", "III-B, Eq. 11", holds(ratio - 1.0 >= 1.0),
        f"(c - a)/a on silicon at {COMPARED.value * 1e9:g} nm", ratio - 1.0, "",
        f"Below 1 the sqrt(m^2 - 1) of Eq. 11 would not be real: m is c/a, here {ratio:.3g} (erratum E10).",
    )  # fmt: skip


def contact_of_lambda(lam: float) -> Contact:
    """A contact with R = K = pi w = 1: Maugis' units; lambda = 2 sigma0 (R/(pi w K^2))^(1/3)."""
    return Contact(1.0, 0.75, 1.0 / np.pi, cohesive_stress=lam / 2.0)


def worst_force(model: Model, lam: float) -> float:
    """Largest error of a theory's F(delta) against MD's over max(|F|, pull-off), loads 0 .. 10 pull-offs."""
    contact = contact_of_lambda(lam)
    pull_off = pull_off_force("maugis", contact)
    loads = np.array([0.0, 10.0 * pull_off])
    least, most = indentation("maugis", loads, contact)
    depth = np.linspace(least, most, 2001)
    right = evaluate("maugis", depth, contact).F
    error = np.abs(evaluate(model, depth, contact).F - right)
    return float(np.max(error / np.maximum(np.abs(right), pull_off)))


def worst_radius(model: Model, lam: float, least: float = 0.0, most: float = 10.0) -> float:
    """Largest error of a theory's a(P) relative to MD's, loads in pull-off forces."""
    contact = contact_of_lambda(lam)
    loads = np.linspace(least, most, 2001) * pull_off_force("maugis", contact)
    radii = [evaluate(m, indentation(m, loads, contact), contact).a for m in (model, "maugis")]
    return float(np.max(np.abs(radii[0] / radii[1] - 1.0)))


def _thresholds() -> list[Statement]:
    return [_replaced("jkr", "lambda > 5.8", 5.8), _replaced("dmt", "lambda < 0.12", 0.12), _hertz_at_twenty()]


def _replaced(model: Model, where: str, lam: float) -> Statement:
    force, radius = worst_force(model, lam), worst_radius(model, lam)
    return Statement(
        f"MD can be replaced by {model.upper()} if {where}", "III-B", holds(max(force, radius) <= TOLERANCE),
        f"largest error of F(delta) at lambda = {lam}", force, "",
        f"Loads up to 10 pull-offs, relative to the larger of load and pull-off; {radius:.2g} in a(P) (erratum E14). "
        f"{100 * TOLERANCE:g} % counts as a replacement.",
    )  # fmt: skip


def _hertz_at_twenty() -> Statement:
    force, radius = _hertz(20.0, lam=1e3)
    hard_force, hard_radius = _hertz(20.0, lam=0.12)
    return Statement(
        "MD can be replaced by Hertz if P > 20 P_a", "III-B", holds(max(force, radius) <= TOLERANCE),
        "error of a(P) at 20 P_a, lambda = 1000", radius, "",
        f"{force:.2g} in F(delta); at lambda = 0.12 it is {hard_radius:.2g} and {hard_force:.2g} (erratum E14). "
        f"{100 * TOLERANCE:g} % counts as a replacement.",
    )  # fmt: skip


def _hertz(load: float, lam: float) -> tuple[float, float]:
    """Error of Hertz in F(delta) and in a(P) at a load in pull-off forces."""
    contact = contact_of_lambda(lam)
    force = load * pull_off_force("maugis", contact)
    depth = indentation("maugis", force, contact)
    return abs(float(evaluate("hertz", depth, contact).F) / force - 1.0), worst_radius("hertz", lam, load, load)


def _limits() -> Statement:
    """1.5 pi w R of JKR and 2 pi w R of DMT."""
    errors = [
        abs(pull_off_force("maugis", contact_of_lambda(lam)) / limit - 1.0) for lam, limit in ((1e-6, 2.0), (1e6, 1.5))
    ]
    return Statement(
        "MD converges to DMT for lambda -> 0 and to JKR for lambda -> infinity", "III-B", holds(max(errors) < 1e-6),
        "larger difference of the pull-off forces, relative, at lambda 1e-6 and 1e6", max(errors), "",
        "2 pi w R and 1.5 pi w R. F(delta) converges as the square root of lambda only, towards DMT.",
    )  # fmt: skip


def _draw(figure: Any, columns: dict[str, Floats]) -> None:
    panels = figure.subplots(1, 3)
    x = columns["stage displacement [m]"] * 1e9
    for modulus, (colour, style) in zip((E.value for E in MODULI), drawing.LOOKS, strict=False):
        name = quantity_of(modulus)
        radius = columns[f"{name} contact radius [m]"]
        inside = radius <= LARGE * paper.TIP.value
        for panel, (what, scale) in zip(
            panels, (("load [N]", 1e9), ("contact radius [m]", 1e9), ("m = c/a []", 1.0)), strict=True
        ):
            y = columns[f"{name} {what}"] * scale
            label = f"{modulus / 1e9:g} GPa"
            for part, alpha in ((inside, 1.0), (~inside, 0.5)):
                if np.isfinite(y[part]).any():
                    panel.plot(x, np.where(part, y, np.nan), color=colour, ls=style, alpha=alpha, label=label)
                    label = "_pale"
    across = r"stage displacement $\Delta$ (nm)"
    drawing.zero(panels[0])
    panels[1].axhline(LARGE * paper.TIP.value * 1e9, color=drawing.GREY, lw=0.8, ls="--")
    panels[2].set_yscale("log")
    drawing.dress(panels[0], "Load; pale: a/R above 0.3", across, "load $P$ (nN)", "upper left")
    drawing.dress(panels[1], "Contact radius", across, "contact radius $a$ (nm)", None)
    drawing.dress(panels[2], "Outer over inner radius", across, "$m = c/a$ (1)", None)
