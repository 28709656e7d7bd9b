# SPDX-License-Identifier: BSD-3-Clause
"""One block of curves fitted over time: viscoelastic samples, each curve with its times and pauses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..curves import ForceCurve, analyse
from ..errors import Error, SolverError
from ..fit import FitResult, fit_curve
from ..fit.models import extension
from .settings import Settings
from .store import Columns

_RANGE, _SOLVER = "NT_E_RANGE", "NT_E_NO_CONVERGENCE"


@dataclass(frozen=True, eq=False)
class Curves:
    """Some curves of a map; None where there is none."""

    curves: tuple[ForceCurve | None, ...]

    def __len__(self) -> int:
        return len(self.curves)


def fit_curves(stored: Mapping[str, Any], block: Curves, plain: tuple[str, ...], measured: tuple[str, ...]) -> Columns:
    """Fit every curve of a block; `plain` and `measured` are the names of what is read off it (those of fit_block)."""
    settings = Settings.from_json(stored)
    names = tuple(settings.parameters()) + (("youngs_modulus",) if settings.poisson_ratio is not None else ())
    rows = [_row(settings, curve, names) for curve in block.curves]
    columns: Columns = {
        "status": np.array([row["status"] for row in rows], np.int8),
        "flags": np.array([row["flags"] for row in rows], np.uint32),
        "reason": np.array([row["reason"] for row in rows], np.str_),
    }
    keys = [f"{name}{kind}" for name in names for kind in ("", "_sigma", "_sigma_statistical", "_sigma_calibration")]
    keys += [f"{name}{kind}" for name in measured for kind in ("", "_sigma")]
    keys += [f"exponent_{end}" for end in ("low", "high") if "exponent" in names]
    for key in (*keys, *plain):
        columns[key] = np.array([row.get(key, np.nan) for row in rows], float)
    return columns


def _row(settings: Settings, curve: ForceCurve | None, names: tuple[str, ...]) -> dict[str, Any]:
    statuses = extension().statuses
    row: dict[str, Any] = {"status": statuses[_RANGE], "flags": 0, "reason": "no curve"}
    if curve is None:
        return row
    try:
        report = analyse(curve, baseline=settings.baseline)
        row |= _read_off(report)
        result = fit_curve(curve, report=report, **settings.arguments())
    except Error as error:
        return row | {
            "status": statuses[_SOLVER if isinstance(error, SolverError) else _RANGE],
            "reason": str(error).removeprefix(f"{curve.name}: "),
        }
    row |= {"status": 0, "reason": "", "flags": _flags(settings, result), "rating": result.rating}
    row |= {"residual_rms": result.residual_rms, "contact_radius": result.contact_radius}
    for name in names:
        row |= {name: result.values[name], f"{name}_sigma": result.sigma[name]}
        row[f"{name}_sigma_statistical"] = result.sigma_statistical[name]
        row[f"{name}_sigma_calibration"] = result.sigma_calibration[name]
    if "exponent" in names:
        row["exponent_low"], row["exponent_high"] = result.interval["exponent"]
    return row


def _read_off(report: Any) -> dict[str, float]:
    names = ("pull_off_force", "snap_in_force", "adhesion_work", "contact_slope")
    row = {name: getattr(report, name) for name in names} | {f"{name}_sigma": report.sigma[name] for name in names}
    low, high = report.pull_off_interval
    return row | {
        "pull_off_least": low, "pull_off_most": high, "ruptures": float(len(report.ruptures)), "noise": report.noise,
        "baseline_tilt": report.baseline_tilt,
    }  # fmt: skip


def _flags(settings: Settings, result: FitResult) -> int:
    bits = extension().flags
    flags = 0 if result.converged else bits["not_converged"]
    flags |= bits["misfit"] if result.status == "misfit" else 0
    for name, (place, _) in settings.parameters().items():
        if settings.asks(name) and result.identifiable.get(name) is False:
            flags |= 1 << (8 + place)
    return int(flags)
