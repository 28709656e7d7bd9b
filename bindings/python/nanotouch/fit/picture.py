# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a fit: the whole curve with what was read off it, the fitted part with the model, the residuals."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from nanotouch._io.drawing import BLUE, GREEN, VERMILION, new_figure, plain, saved
from nanotouch.curves import ForceCurve
from nanotouch.units import engineering, in_words

from .models import Floats, is_sharp
from .result import FitResult

_FREE = 0.4  # of the depth: how much of the free part is shown beside a whole curve's contact


def draw(curve: ForceCurve, result: FitResult, save: str | os.PathLike[str] | None = None) -> Any:
    """Draw a fit.

    Returns
    -------
    matplotlib.figure.Figure
        Also written to `save`, whole or not at all.
    """
    return plot(result, save, title=f"{curve.name}, curve {curve.meta.get('enum', 0)}: {result.title}")


def plot(result: FitResult, save: str | os.PathLike[str] | None = None, *, title: str = "") -> Any:
    """The same of the result alone, which holds its curve: force over position, and over indentation with the law."""
    figure = new_figure(12.0, 5.5)
    grid = figure.add_gridspec(3, 2, width_ratios=(1.0, 1.0))
    _whole(figure.add_subplot(grid[:, 0]), result)
    fitted = figure.add_subplot(grid[:2, 1])
    _fitted(fitted, result)
    _residuals(figure.add_subplot(grid[2, 1], sharex=fitted), result)
    figure.suptitle(plain(title or f"{result.name}: {result.title}"))
    return saved(figure, save, dpi=130)


def _whole(panel: Any, result: FitResult) -> None:
    shown: list[tuple[str, Floats, Floats, str]] = []
    for role, colour in (("approach", BLUE), ("retract", VERMILION)):
        if role in result.report.branches:
            branch = result.report.branches[role]
            shown.append((role, branch.z, branch.force, colour))
    wide, scale_z = engineering("m", np.concatenate([z for _, z, _, _ in shown]))
    strong, scale_f = engineering("N", np.concatenate([force for _, _, force, _ in shown]))
    for role, z, force, colour in shown:
        panel.plot(
            z * scale_z, force * scale_f, color=colour, lw=0.9, label="retraction" if role == "retract" else role
        )
    panel.axhline(0.0, color="0.4", lw=0.8, ls="--", label="baseline (taken off)")
    contact = result.values["contact_point"]
    panel.axvline(contact * scale_z, color=GREEN, lw=1.0, ls=":", label="contact point of the fit")
    report = result.report
    marks = [("snap-in", report.snap_in_z, report.snap_in_force, BLUE, "v"),
             ("pull-off", report.pull_off_z, report.pull_off_force, VERMILION, "o")]  # fmt: skip
    for name, z_mark, force_mark, colour, shape in marks:
        if force_mark > 0.0:
            unit, factor = engineering("N", force_mark)
            label = f"{name} {force_mark * factor:.3g} {unit}"
            panel.plot(
                z_mark * scale_z, -force_mark * scale_f, shape, ms=8, mfc="none", mec=colour, mew=1.5, label=label
            )
    panel.set_xlabel(f"height of the cantilever's base $z$ ({wide})")
    panel.set_ylabel(f"force $F$, + repulsive ({strong})")
    panel.legend(loc="best", fontsize=8)


def _indentation(result: FitResult) -> Floats:
    """Of the points as they were measured [m]: at the same position of the base the residual bends the lever, too."""
    gain = result.values.get("sensitivity", 1.0) / result.spring_constant
    return np.asarray(result.indentation - gain * result.residuals)


def _fitted(panel: Any, result: FitResult) -> None:
    depth, scale_z = _indentation(result), engineering("m", result.indentation)[1]
    strong, scale_f = engineering("N", result.force)
    for part, colour, label in _parts(result):
        panel.plot(depth[part] * scale_z, result.force[part] * scale_f, ".", color=colour, ms=3, alpha=0.6, label=label)
    panel.plot(result.indentation * scale_z, result.fitted * scale_f, color="black", lw=1.2, label=result.title)
    panel.axhline(0.0, color="0.4", lw=0.8, ls="--")
    panel.axvline(0.0, color=GREEN, lw=1.0, ls=":")
    panel.text(0.03, 0.95, _box(result), transform=panel.transAxes, ha="left", va="top", fontsize=8,
               bbox={"facecolor": "white", "edgecolor": "0.7", "alpha": 0.9})  # fmt: skip
    panel.set_ylabel(f"force $F$ ({strong})")
    panel.tick_params(labelbottom=False)
    panel.legend(loc="center left", fontsize=8)
    branch = "retraction" if result.branch == "retract" else result.branch
    if result.time is not None:  # of a long free part little is seen
        deepest = float(result.indentation.max()) * scale_z
        panel.set_xlim(-_FREE * deepest, 1.1 * deepest)
    panel.set_title(f"the {result.z.size} points of the {branch} that were fitted", fontsize=9)


def _parts(result: FitResult) -> list[tuple[slice, str, str]]:
    """Points that are drawn alike, with colour and label: of a whole curve what comes after its deepest point apart."""
    if result.time is None:
        return [(slice(None), VERMILION if result.branch == "retract" else BLUE, "measured")]
    turn = int(np.argmin(result.z)) + 1
    return [(slice(turn), BLUE, "to the deepest point"), (slice(turn, None), VERMILION, "after it")]


def _residuals(panel: Any, result: FitResult) -> None:
    wide, scale_z = engineering("m", result.indentation)
    weak, scale_f = engineering("N", result.residuals)
    panel.plot(result.indentation * scale_z, result.residuals * scale_f, ".", color="0.35", ms=3)
    panel.axhline(0.0, color="black", lw=0.8)
    noise = result.report.noise * scale_f
    panel.axhspan(-noise, noise, color="0.85", zorder=0, label="± noise")
    panel.set_xlabel(rf"indentation $\delta$ ({wide})")
    panel.set_ylabel(f"residual ({weak})")
    panel.legend(loc="best", fontsize=8)


def _box(result: FitResult) -> str:
    symbols = {
        "effective_modulus": "$E^*$",
        "work_of_adhesion": "$w$",
        "youngs_modulus": "$E$",
        "exponent": r"$\beta$",
        "relaxation_time": r"$\tau$",
        "cohesive_range": "$h_0$",
    }
    lines = [f"{symbol} = {result.show(key)}" for key, symbol in symbols.items() if key in result.values]
    size = f"$R$ = {in_words(result.radius, 'm', 3)}"
    if is_sharp(result.model):
        size = rf"$\psi$ = {np.degrees(result.half_angle):.3g}°"
    lines.append(f"{size}, $k_c$ = {result.spring_constant:.3g} N/m")
    return "\n".join(lines).replace("+-", "±").replace("^2", "²")
