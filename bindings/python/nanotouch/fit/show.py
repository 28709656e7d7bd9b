# SPDX-License-Identifier: BSD-3-Clause
"""A fit in words: text, and HTML for notebooks."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .result import FitResult

_PREFIXES = {-18: "a", -15: "f", -12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
_PLACES = ("contact_point", "force_offset", "force_tilt", "sensitivity")
MEANING = {
    "effective_modulus": "E*, of tip and sample together",
    "youngs_modulus": "E of the sample",
    "work_of_adhesion": "w",
    "cohesive_range": "h0, range of the adhesion",
    "contact_point": "z of the base at first touch",
    "force_offset": "correction of the baseline",
    "force_tilt": "correction of its tilt",
    "sensitivity": "true over assumed",
}


def with_sigma(value: float, sigma: float, unit: str) -> str:
    """``(15.34 +- 0.12) kPa``: a common prefix, sigma with two digits; without sigma if that is 0."""
    power = 0
    larger = max(abs(value), sigma) if np.isfinite(sigma) else abs(value)
    if unit and larger != 0.0 and np.isfinite(larger):
        power = min(max(3 * int(np.floor(np.log10(larger) / 3)), min(_PREFIXES)), max(_PREFIXES))
    shown, spread = value / 10.0**power, sigma / 10.0**power
    unit = f" {_PREFIXES[power]}{unit}" if unit else ""
    if sigma == 0.0:
        return f"{shown:.4g}{unit}"
    if not 0.0 < spread <= 1e3 * abs(shown):
        return f"{shown:.4g}{unit} (sigma {spread:.2g})"
    digits = max(0, 1 - int(np.floor(np.log10(spread))))
    return f"({shown:.{digits}f} +- {spread:.{digits}f}){unit}"


def as_text(result: FitResult) -> str:
    """Parameters with their uncertainties, what was read off, what was assumed."""
    lines = [f"{result.name}: {result.title} fit of the {result.branch}, {_outcome(result)}"]
    for key in result.values:
        lines.append(f"  {key:18} {result.show(key)}{_parts(result, key)}")
    lines += [f"  {name:18} {text}" for name, text in _readings(result)]
    lines += [f"  valid for: {result.valid}"]
    lines += [f"  assumed: {text}" for text in result.assumptions]
    lines += [f"  note: {text}" for text in result.notes]
    return "\n".join(lines)


def as_html(result: FitResult) -> str:
    """The same as a table; what the curve does not determine is red."""
    rows = []
    for key in result.values:
        determined = result.determined(key)
        colour = {True: "#1a7f37", False: "#c0392b", None: "#666666"}[determined]
        cells = (key, MEANING.get(key, ""), result.show(key), _parts(result, key).strip(" ()"))
        rows.append(f'<tr style="color:{colour}">' + "".join(f"<td>{escape(cell)}</td>" for cell in cells) + "</tr>")
    rows += [
        f'<tr><td>{name}</td><td></td><td colspan="2">{escape(text)}</td></tr>' for name, text in _readings(result)
    ]
    remarks = [("valid for", result.valid)] + [("assumed", text) for text in result.assumptions]
    remarks += [("note", text) for text in result.notes]
    listed = "".join(f"<li>{kind}: {escape(text)}</li>" for kind, text in remarks)
    title = f"{result.name}: {result.title} fit of the {result.branch}, {_outcome(result)}"
    return f"<p><b>{escape(title)}</b></p><table>{''.join(rows)}</table><ul>{listed}</ul>"


def _outcome(result: FitResult) -> str:
    outcome = "converged" if result.converged else "NOT CONVERGED"
    return f"{result.z.size} points, {outcome} after {result.iterations} iterations"


def _parts(result: FitResult, key: str) -> str:
    """Statistical and calibration sigma of a property of the sample that both enter."""
    total, calibration, value = result.sigma[key], result.sigma_calibration[key], result.values[key]
    if key in _PLACES or not np.isfinite(total) or calibration == 0.0 or value == 0.0 or total > 10.0 * abs(value):
        return ""
    scale = 100.0 / abs(value)
    return f"  (statistical {scale * result.sigma_statistical[key]:.2g} %, calibration {scale * calibration:.2g} %)"


def _readings(result: FitResult) -> list[tuple[str, str]]:
    rows = []
    if np.isfinite(result.pull_off_force):
        rows.append(("pull-off force", f"fitted {_newton(result.pull_off_force)}, "
                                       f"measured {_newton(result.measured_pull_off_force)}"))  # fmt: skip
    rows += [
        ("snap-in force", f"measured {_newton(result.measured_snap_in_force)}"),
        ("residual", f"{_newton(result.residual_rms)} RMS, {result.misfit:.2g} times the noise"),
    ]
    return rows


def _newton(force: float) -> str:
    return with_sigma(force, 0.0, "N")
