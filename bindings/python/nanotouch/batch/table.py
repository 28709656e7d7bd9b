# SPDX-License-Identifier: BSD-3-Clause
"""The rows of a table of results: all that is known of a fit, or the fifteen columns that answer."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .._io.writing import replacing
from ..fit import FitResult
from .sidecar import Decision

Row = dict[str, Any]

#: what the modulus in a table is: E of the sample where its Poisson ratio was given, else E*
MODULI = {"youngs_modulus": "E", "effective_modulus": "E*"}
#: the short table, with the columns of E or of E*
SHORT = (
    "file", "curve", "group", "status", "reason", "model", "rating", "E [Pa]", "E low [Pa]", "E high [Pa]",
    "E* [Pa]", "E* low [Pa]", "E* high [Pa]", "pull_off_force [N]", "pull_off_force sigma [N]",
    "work_of_adhesion low [J/m^2]", "work_of_adhesion high [J/m^2]", "separation_work [J]",
)  # fmt: skip
#: besides, where a model over time was fitted
OVER_TIME = ("exponent", "exponent low", "exponent high", "relaxation_time [s]", "relaxation_time sigma [s]")
_PLAIN = {
    "residual_rms": "N", "misfit": "", "contact_radius": "m", "contact_stiffness": "N/m", "radius": "m",
    "spring_constant": "N/m",
}  # fmt: skip
_READ_OFF = {"pull_off_force": "N", "snap_in_force": "N", "adhesion_work": "J", "contact_slope": "N/m"}


def row_without(file: Path, index: int | None, status: str, reason: str) -> Row:
    """Of a curve or file without a fit."""
    return {"file": str(file), "curve": "" if index is None else index, "status": status, "reason": reason}


def row_of(file: Path, index: int, result: FitResult, decision: Decision) -> Row:
    """All that is known of a fit."""
    row: Row = {"file": str(file), "curve": index, "status": result.status, "reason": _reason(result)}
    row |= {"model": result.model, "branch": result.branch, "points": int(result.z.size), "rating": result.rating}
    row |= _answered(result)
    for name, value in result.values.items():
        unit = result.units[name]
        row |= {_headed(name, unit): value, _headed(f"{name} sigma", unit): result.sigma[name]}
        row[_headed(f"{name} sigma statistical", unit)] = result.sigma_statistical[name]
        row[_headed(f"{name} sigma calibration", unit)] = result.sigma_calibration[name]
        if name in result.identifiable:
            row[f"{name} determined"] = int(result.identifiable[name])
    if "exponent" in result.interval:
        row["exponent low"], row["exponent high"] = result.interval["exponent"]
    row["relaxation"] = dict(result.answer.lines).get("relaxation", "")
    for name, unit in _READ_OFF.items():
        row[_headed(f"measured {name}", unit)] = getattr(result.report, name)
        row[_headed(f"measured {name} sigma", unit)] = result.report.sigma[name]
    row["fitted pull_off_force [N]"] = result.pull_off_force
    row |= {_headed(name, unit): getattr(result, name) for name, unit in _PLAIN.items()}
    row |= {"noise [N]": result.report.noise, "ruptures": len(result.report.ruptures)}
    row |= {"converged": int(result.converged), "by hand": ", ".join(sorted(by_hand(decision)))}
    row |= {"choice": result.choice, "notes": "; ".join(result.notes), "assumptions": "; ".join(result.assumptions)}
    return {key: "" if value != value else value for key, value in row.items()}  # not a number: an empty cell


def by_hand(decision: Decision) -> dict[str, Any]:
    """What a person decided, as arguments of a fit."""
    given = {"contact_point": decision.contact_point, "baseline": decision.baseline}
    return {key: value for key, value in given.items() if value is not None}


def write(path: Path, rows: list[Row], *, long: bool) -> None:
    """As CSV, whole or not at all."""
    every = dict.fromkeys(key for row in rows for key in row)
    names = list(every) if long else _short(every)
    # file names may hold bytes that are no UTF-8
    with replacing(path) as part, part.open("w", encoding="utf-8", errors="backslashreplace", newline="") as stream:
        writer = csv.DictWriter(stream, names, restval="", extrasaction="ignore")
        writer.writeheader()
        writer.writerows(rows)


def _short(every: dict[str, None]) -> list[str]:
    """The fifteen columns, and those of models over time."""
    other = tuple(f"{symbol} " for symbol in MODULI.values() if f"{symbol} [Pa]" not in every)
    other = other if len(other) < len(MODULI) else ("E ",)
    names = [name for name in SHORT if not name.startswith(other)]
    return [*names, *(name for name in OVER_TIME if name in every)]


def modulus_of(row: Mapping[str, Any]) -> str:
    """What the modulus of a row is: E or E*."""
    return next((symbol for symbol in MODULI.values() if f"{symbol} [Pa]" in row), MODULI["effective_modulus"])


def _answered(result: FitResult) -> Row:
    """The numbers of the answer; a bound that does not exist is infinite or 0."""
    answer, symbol = result.answer, MODULI[result.answer.quantity]
    force, low, high = answer.pull_off_force
    work, sigma = answer.separation_work
    value, least, most = answer.modulus
    return {
        "adhesion": answer.adhesion, "pull_off_force [N]": force, "pull_off_force low [N]": low,
        "pull_off_force high [N]": high, "pull_off_force sigma [N]": answer.pull_off_sigma,
        "work_of_adhesion low [J/m^2]": answer.work_of_adhesion[0],
        "work_of_adhesion high [J/m^2]": answer.work_of_adhesion[1], "separation_work [J]": work,
        "separation_work sigma [J]": sigma, f"{symbol} [Pa]": value, f"{symbol} low [Pa]": least,
        f"{symbol} high [Pa]": most,
    }  # fmt: skip


def _reason(result: FitResult) -> str:
    """Why the status is not ok, in a few words."""
    if result.status == "ok":
        return ""
    if result.status == "not converged":
        return "the fit stopped before it converged"
    if result.rating == 0.0:
        return "no contact rises above ten times the noise"
    if result.reason or result.doubt:
        return result.reason or result.doubt
    if result.status == "misfit":
        return "the model does not describe the curve"
    missing = [name for name, known in result.identifiable.items() if not known]
    return "not determined: " + ", ".join(missing)


def _headed(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name
