# SPDX-License-Identifier: BSD-3-Clause
"""One HTML page of a run: results, what was rejected and why, pictures, a Methods paragraph, versions and hashes.

The page stands alone: pictures are in it, nothing is loaded, all text is escaped.
"""

from __future__ import annotations

import base64
import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import nanotouch

from .._io.drawing import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, new_figure, plain
from .._io.html import table
from .._io.writing import replacing
from ..fit.show import between, with_sigma
from ..units import engineering
from .groups import QUANTITIES, Spread
from .methods import methods, modulus_meant
from .table import modulus_of

if TYPE_CHECKING:
    from .files import Summary

_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY)
_DECADE = 10.0  # spread from where a histogram has a logarithmic axis
_BINS = 30
_LISTED = 2000  # rows of the page; the table beside it has them all
_STYLE = """body{font-family:sans-serif;max-width:75em;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;margin:.5em 0}th,td{border-bottom:1px solid #ddd;vertical-align:top;font-size:90%}
img{max-width:100%}.methods{background:#f4f4f4;padding:1em}h2{margin-top:2em}code{font-size:85%}"""


def write_report(
    path: str | os.PathLike[str],
    summary: Summary,
    *,
    title: str,
    settings: Mapping[str, Any],
    reading: Mapping[str, Any],
    sheets: Iterable[Path] = (),
) -> Path:
    """Write the page of a run.

    Parameters
    ----------
    path : path
        HTML file.
    summary : Summary
        Of :func:`nanotouch.batch.fit_files`.
    title : str
        What was analysed.
    settings, reading : mapping
        The arguments of :func:`fit_files` and of :func:`nanotouch.curves.read`.
    sheets : iterable of path
        Contact sheets to show (:func:`nanotouch.batch.sheet.draw`).
    """
    rows, spreads = summary.rows, summary.spreads
    parts = [
        f"<h1>{escape(title)}</h1><p>{escape(str(summary))}</p>",
        "<h2>Results</h2>", _spread_table(spreads), f"<p>{escape(modulus_meant(settings))}</p>", *_histograms(spreads),
        "<h2>Rejected, and why</h2>", _rejected(rows),
        "<h2>Curves</h2>", _curves(rows),
        "<h2>Pictures</h2>", *(_image(sheet.read_bytes(), sheet.name) for sheet in sheets),
        "<h2>Methods</h2>", f'<p class="methods">{escape(methods(rows, settings, reading))}</p>',
        "<h2>Assumed</h2>", _listed(_told(rows, "assumptions")),
        "<h2>Versions and files</h2>", _versions(settings, reading), _hashes(rows),
    ]  # fmt: skip
    page = f'<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
    page += f"<style>{_STYLE}</style></head><body>{''.join(parts)}</body></html>\n"
    with replacing(path) as part:
        part.write_text(page, encoding="utf-8", errors="backslashreplace")
    return Path(path)


def _spread_table(spreads: Sequence[Spread]) -> str:
    headers = ("group", "quantity", "median", "quartiles", "5 % to 95 %", "curves", "no value", "log-normal")
    cells = []
    for found in spreads:
        p5, p25, p50, p75, p95 = found.percentiles
        known = found.values.size > 0
        fits = {None: "too few", True: f"yes: {with_sigma(found.geometric_mean, 0.0, found.unit)}, factor "
                                       f"{found.geometric_deviation:.3g}", False: "no"}  # fmt: skip
        cells.append((
            found.group or "all", QUANTITIES[found.quantity][0], with_sigma(p50, 0.0, found.unit) if known else "none",
            between(p25, p75, found.unit) if known else "", between(p5, p95, found.unit) if known else "",
            str(found.values.size), str(found.without), fits[found.log_normal],
        ))  # fmt: skip
    return table("Medians of what is determined", headers, cells)


def _histograms(spreads: Sequence[Spread]) -> list[str]:
    return [
        _image(_png(_histogram(quantity, found)), f"histogram of {QUANTITIES[quantity][0]}")
        for quantity in QUANTITIES
        if (found := [s for s in spreads if s.quantity == quantity and s.values.size])
    ]


def _histogram(quantity: str, spreads: Sequence[Spread]) -> Any:
    name, unit = QUANTITIES[quantity]
    every = np.concatenate([found.values for found in spreads])
    shown, scale = engineering(unit, np.array([np.median(every)])) if unit else ("", 1.0)
    low, high = float(every.min()), float(every.max())
    wide = high > _DECADE * low > 0.0  # an exponent may be 0
    if low == high:
        low, high = (0.9 * low, 1.1 * high) if low else (0.0, 1.0)
    edges = np.geomspace(low, high, _BINS + 1) if wide else np.linspace(low, high, _BINS + 1)
    figure = new_figure(7.0, 3.2)
    panel = figure.add_subplot()
    for found, colour in zip(spreads, _COLOURS * (1 + len(spreads) // len(_COLOURS)), strict=False):
        panel.hist(found.values * scale, edges * scale, histtype="stepfilled", alpha=0.45, color=colour,
                   label=f"{plain(found.group or 'all')} ({found.values.size})")  # fmt: skip
        panel.axvline(found.percentiles[2] * scale, color=colour, lw=1.5)
        if found.log_normal and low > 0.0:
            _draw_log_normal(panel, found, edges, scale, colour)
    if wide:
        panel.set_xscale("log")
    panel.set_xlabel(f"{name} ({shown})" if shown else name)
    panel.set_ylabel("curves")
    panel.legend(fontsize=8)
    return figure


def _draw_log_normal(panel: Any, found: Spread, edges: Any, scale: float, colour: str) -> None:
    """The fitted distribution as the number of curves that it puts into each bin."""
    mean, spread = np.log(found.geometric_mean), np.log(found.geometric_deviation)
    if spread <= 0.0:
        return
    x = np.sqrt(edges[1:] * edges[:-1])
    density = np.exp(-0.5 * ((np.log(x) - mean) / spread) ** 2) / (spread * np.sqrt(2.0 * np.pi))
    panel.plot(x * scale, found.values.size * density * np.log(edges[1:] / edges[:-1]), color=colour, lw=1.0, ls="--")


def _rejected(rows: Sequence[Mapping[str, Any]]) -> str:
    bad = [row for row in rows if row["status"] != "ok"]
    if not bad:
        return "<p>Nothing.</p>"
    cells = [(_named(row), row["status"], row["reason"]) for row in bad[:_LISTED]]
    more = f"<p>and {len(bad) - _LISTED} more in the table</p>" if len(bad) > _LISTED else ""
    return table(f"{len(bad)} of {len(rows)}", ("curve", "status", "why"), cells) + more


def _curves(rows: Sequence[Mapping[str, Any]]) -> str:
    headers = ("curve", "group", "status", "law", "rating", "modulus", "pull-off", "w", "work of separation")
    over_time = any(row.get("relaxation", "") for row in rows)
    kept = [row for row in rows if row["status"] not in ("failed", "excluded")]
    cells = [
        (
            _named(row), row.get("group", ""), row["status"], row["model"], _shown(row, "rating", "", 1),
            _modulus(row), _force(row),
            _range(row, "work_of_adhesion low [J/m^2]", "work_of_adhesion high [J/m^2]", "J/m^2"),
            _shown(row, "separation_work [J]", "J"), *([row.get("relaxation", "")] if over_time else []),
        )
        for row in kept[:_LISTED]
    ]  # fmt: skip
    more = f"<p>and {len(kept) - _LISTED} more in the table</p>" if len(kept) > _LISTED else ""
    return table(f"{len(kept)} fitted", (*headers, "relaxation") if over_time else headers, cells) + more


def _named(row: Mapping[str, Any]) -> str:
    name = Path(row["file"]).name
    return name if row["curve"] in ("", 0) else f"{name}#{row['curve']}"


def _shown(row: Mapping[str, Any], key: str, unit: str, digits: int | None = None) -> str:
    value = row.get(key, "")
    if value == "":
        return ""
    return f"{value:.{digits}f}" if digits is not None else with_sigma(value, 0.0, unit)


def _range(row: Mapping[str, Any], low: str, high: str, unit: str) -> str:
    ends = row.get(low, ""), row.get(high, "")
    text = "" if "" in ends else between(float(ends[0]), float(ends[1]), unit)
    return "" if text == "unknown" else text


def _modulus(row: Mapping[str, Any]) -> str:
    symbol = modulus_of(row)
    ends = _range(row, f"{symbol} low [Pa]", f"{symbol} high [Pa]", "Pa")
    value = _shown(row, f"{symbol} [Pa]", "Pa")
    return f"{symbol} {f'{value}, {ends}' if value and ends else value or ends}" if value or ends else ""


def _force(row: Mapping[str, Any]) -> str:
    if row.get("adhesion") == "none":
        return f"below {_shown(row, 'pull_off_force high [N]', 'N')}"
    value, sigma = row.get("pull_off_force [N]", ""), row.get("pull_off_force sigma [N]", "")
    return "" if "" in (value, sigma) else with_sigma(value, sigma, "N")


def _told(rows: Sequence[Mapping[str, Any]], key: str) -> list[str]:
    counts: dict[str, int] = {}
    for row in rows:
        for text in filter(None, str(row.get(key, "")).split("; ")):
            counts[text] = counts.get(text, 0) + 1
    return [f"{text} ({count} curves)" for text, count in counts.items()]


def _listed(texts: Iterable[str]) -> str:
    return f"<ul>{''.join(f'<li>{escape(text)}</li>' for text in texts)}</ul>"


def _versions(settings: Mapping[str, Any], reading: Mapping[str, Any]) -> str:
    given = {**settings, **reading}
    cells = [("nanotouch", nanotouch.__version__), ("numpy", np.__version__), ("Python", sys.version.split()[0])]
    cells += [(key, str(value)) for key, value in sorted(given.items()) if value is not None]
    return table("Made with", ("what", "value"), cells)


def _hashes(rows: Sequence[Mapping[str, Any]]) -> str:
    found = {row["file"]: row["sha256"] for row in rows}
    lines = "".join(f"<tr><td><code>{escape(d)}</code></td><td>{escape(f)}</td></tr>" for f, d in found.items())
    return f"<details><summary>SHA-256 of {len(found)} files</summary><table>{lines}</table></details>"


def _png(figure: Any) -> bytes:
    data: bytes = figure._repr_png_()
    return data


def _image(data: bytes, alt: str) -> str:
    return f'<p><img alt="{escape(alt)}" src="data:image/png;base64,{base64.b64encode(data).decode()}"></p>'
