# SPDX-License-Identifier: BSD-3-Clause
"""A fit in words: text, and HTML for notebooks."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import NamedTuple

import numpy as np

from nanotouch.units import PREFIXES, least_power

MEANING = {
    "effective_modulus": "E*, of tip and sample together",
    "youngs_modulus": "E of the sample",
    "work_of_adhesion": "w",
    "cohesive_range": "h0, range of the adhesion",
    "contact_point": "z of the base at first touch",
    "force_offset": "correction of the baseline",
    "force_tilt": "correction of its tilt",
    "sensitivity": "true over assumed",
    "exponent": "beta of the power law",
    "arm_modulus": "E_1, what relaxes",
    "relaxation_time": "tau",
    "drag": "of the lever at the surface, over its speed",
}
_COLOURS = {True: "#1a7f37", False: "#c0392b", None: "#666666"}


class Row(NamedTuple):
    """One parameter."""

    key: str
    text: str
    """with its uncertainty"""
    parts: str
    """of the uncertainty, or empty"""
    determined: bool | None
    """by the curve; None if it was held or known beforehand"""


class Page(NamedTuple):
    """All that is said of a fit."""

    title: str
    rows: list[Row]
    readings: list[tuple[str, str]]
    """what was read off: its name, and the text"""
    remarks: list[tuple[str, str]]
    """kind and text"""
    answer: Sequence[tuple[str, str]] = ()
    """what was asked, first"""


def with_sigma(value: float, sigma: float, unit: str) -> str:
    """``(15.34 +- 0.12) kPa``: a common prefix, two digits of sigma; without sigma if that is 0."""
    power = _power(max(abs(value), sigma) if np.isfinite(sigma) else abs(value), unit)
    shown, spread = value / 10.0**power, sigma / 10.0**power
    unit = f" {PREFIXES[power]}{unit}" if unit else ""
    if sigma == 0.0:
        return f"{shown:.4g}{unit}"
    if not np.isfinite(spread):
        return f"{shown:.4g}{unit} (sigma {spread})"
    digits = max(0, 1 - int(np.floor(np.log10(spread))))
    rounded = round(shown, digits) + 0.0  # no negative zero
    return f"({rounded:.{digits}f} +- {spread:.{digits}f}){unit}"


def _power(larger: float, unit: str) -> int:
    """Of ten, of the prefix."""
    if not unit or larger == 0.0 or not np.isfinite(larger):
        return 0
    return min(max(3 * int(np.floor(np.log10(larger) / 3)), least_power(unit)), max(PREFIXES))


def between(low: float, high: float, unit: str) -> str:
    """``from 1.2 to 3.4 nN``, ``above 1.2 nN``, ``below 3.4 nN``: an interval with a common prefix."""
    if np.isnan(low) or np.isnan(high) or (low <= 0.0 and np.isinf(high)):
        return "unknown"
    if np.isinf(high):
        return f"above {with_sigma(low, 0.0, unit)}"
    if low <= 0.0:
        return f"below {with_sigma(high, 0.0, unit)}"
    power = _power(max(abs(low), abs(high)), unit)
    digits = max(0, 2 - int(np.floor(np.log10(max(high - low, 1e-3 * high) / 10.0**power))))
    shown = f" {PREFIXES[power]}{unit}" if unit else ""
    if high > 100.0 * low:
        return f"from {with_sigma(low, 0.0, unit)} to {with_sigma(high, 0.0, unit)}"
    return f"from {low / 10.0**power:.{digits}f} to {high / 10.0**power:.{digits}f}{shown}"


def newton(force: float) -> str:
    """A force without its uncertainty."""
    return "unknown" if np.isnan(force) else with_sigma(force, 0.0, "N")


def as_text(page: Page) -> str:
    """Parameters with their uncertainties, what was read off, what was assumed."""
    lines = [f"  {name:18} {text}" for name, text in page.answer]
    lines += [page.title]
    lines += [f"  {row.key:18} {row.text}{f'  ({row.parts})' if row.parts else ''}" for row in page.rows]
    lines += [f"  {name:18} {text}" for name, text in page.readings]
    lines += [f"  {kind}: {text}" for kind, text in page.remarks]
    return "\n".join(lines)


def as_html(page: Page) -> str:
    """The same as a table; what the curve does not determine is red."""
    rows = []
    for row in page.rows:
        cells = (row.key, MEANING.get(row.key, ""), row.text, row.parts)
        filled = "".join(f"<td>{escape(cell)}</td>" for cell in cells)
        rows.append(f'<tr style="color:{_COLOURS[row.determined]}">{filled}</tr>')
    rows += [f'<tr><td>{name}</td><td></td><td colspan="2">{escape(text)}</td></tr>' for name, text in page.readings]
    listed = "".join(f"<li>{kind}: {escape(text)}</li>" for kind, text in page.remarks)
    told = "".join(f"<tr><td>{escape(name)}</td><td>{escape(text)}</td></tr>" for name, text in page.answer)
    return f"<table>{told}</table><p><b>{escape(page.title)}</b></p><table>{''.join(rows)}</table><ul>{listed}</ul>"
