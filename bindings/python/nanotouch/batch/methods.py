# SPDX-License-Identifier: BSD-3-Clause
"""What was done to a folder of curves, in the words of a Methods section."""

from __future__ import annotations

import platform
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

import nanotouch

from .._io.words import counted
from ..fit.models import title_of
from ..fit.show import between, with_sigma


def methods(rows: Sequence[Mapping[str, Any]], settings: Mapping[str, Any], reading: Mapping[str, Any]) -> str:
    """One paragraph, from what was really done."""
    fitted = [row for row in rows if row["status"] not in ("failed", "excluded")]
    files = len({row["file"] for row in fitted})
    said = [
        f"{counted(len(fitted), 'force curve')} of {counted(files, 'file')} were analysed with nanotouch "
        f"{nanotouch.__version__} (Python {platform.python_version()}, NumPy {np.__version__}).",
        _calibration(fitted, reading),
        "The baseline is a line through the free part of each branch by Tukey-weighted least squares, with the wave of "
        "interference where there is strong evidence of one. Both branches were judged together: only what lies beyond "
        "the last rupture of the retraction counts as free.",
        _laws(fitted, settings),
        _over_time(fitted),
        modulus_meant(settings),
        "The force was fitted over the position of the cantilever's base, with the cantilever's bending in the model. "
        "Sensitivity, level and tilt of the baseline entered as data of their own uncertainty.",
        "Uncertainties are standard ones with those of the calibration; intervals are 95 % ones. Noise was split into "
        "white and 1/f noise by its spectrum.",
        _left_out(rows),
        "Groups are given by their medians and quartiles. A distribution is called log-normal where Anderson and "
        "Darling's test does not reject that at 5 %.",
    ]
    return " ".join(text for text in said if text)


def _calibration(rows: Sequence[Mapping[str, Any]], reading: Mapping[str, Any]) -> str:
    constants = [row["spring_constant [N/m]"] for row in rows if row.get("spring_constant [N/m]", "") != ""]
    if not constants:
        return ""
    low, high = min(constants), max(constants)
    shown = with_sigma(low, 0.0, "N/m") if low == high else between(low, high, "N/m")
    given = [name.replace("_", " ") for name in ("spring_constant", "sensitivity", "calibration") if reading.get(name)]
    source = f"given by hand ({', '.join(given)})" if given else "those stated in the files"
    return f"The spring constant was {shown}; spring constants and sensitivities are {source}."


def _laws(rows: Sequence[Mapping[str, Any]], settings: Mapping[str, Any]) -> str:
    used = Counter((row["model"], row["branch"]) for row in rows)
    if not used:
        return ""
    named = {"retract": "retraction"}
    said = [f"{title_of(model)} on the {named.get(branch, branch)} ({count})"
            for (model, branch), count in used.most_common()]  # fmt: skip
    how = "chosen by what each curve shows" if settings.get("model") == "auto" else "chosen beforehand"
    tip = _tip(rows, settings)
    return f"Laws of contact, {how}: {', '.join(said)}.{tip}"


def _over_time(rows: Sequence[Mapping[str, Any]]) -> str:
    if not any(row["branch"] == "whole curve" for row in rows):
        return ""
    return (
        "Approach, pauses and retraction of a curve were fitted at once over time, the contact growing by Lee and "
        "Radok's (1960) and shrinking by Ting's (1966) solution; a retraction that adheres was left out."
    )


def _tip(rows: Sequence[Mapping[str, Any]], settings: Mapping[str, Any]) -> str:
    if settings.get("half_angle") is not None:
        return f" Half angle of the tip: {np.degrees(settings['half_angle']):.3g} degrees."
    if settings.get("radius") is not None:
        return f" Radius of the tip: {with_sigma(settings['radius'], 0.0, 'm')}."
    if settings.get("tip") is not None:
        return f" Tip: {settings['tip']}."
    if all("(as the file states)" in row["assumptions"] for row in rows):
        radii = [row["radius [m]"] for row in rows]
        return f" Radius of the tip, as the files state: {between(min(radii), max(radii), 'm')}."
    return " The radius of the tip is NOT given: 20 nm is assumed, and moduli hold for it alone."


def modulus_meant(settings: Mapping[str, Any]) -> str:
    """Which modulus the table holds: E of the sample needs its Poisson's ratio."""
    ratio = settings.get("poisson_ratio")
    if ratio is not None:
        return f"The modulus is E of the sample, for a Poisson's ratio of {ratio:g}."
    return (
        "The modulus is E* of tip and sample together, 1/E* = (1 - nu^2)/E under a rigid tip; no Poisson's ratio nu "
        "was given for E."
    )


def _left_out(rows: Sequence[Mapping[str, Any]]) -> str:
    counts = Counter(row["status"] for row in rows)
    said = {
        "failed": "could not be read or fitted", "excluded": "excluded by hand",
        "misfit": "left out of the moduli, as no law describes them", "not converged": "left out, not converged",
        "undetermined": "not determining every parameter, told by bounds",
    }  # fmt: skip
    found = [f"{counts[status]} {text}" for status, text in said.items() if counts[status]]
    return f"Of {counted(len(rows), 'row')} of the table: {', '.join(found)}." if found else ""
