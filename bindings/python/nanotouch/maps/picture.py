# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a map: modulus, adhesion, contact point, and where not to believe them."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._io.drawing import new_figure, plain, saved
from ..errors import InvalidValue, require
from ..units import engineering
from .dataset import determined, doubtful, flag_counts

Floats = NDArray[np.float64]

PANELS = (
    "effective_modulus", "exponent", "relaxation_time", "pull_off_force", "adhesion_work", "work_of_adhesion",
    "contact_point",
)  # fmt: skip
_TITLES = {
    "effective_modulus": "effective modulus $E^*$",
    "youngs_modulus": "Young's modulus $E$",
    "work_of_adhesion": "work of adhesion $w$",
    "exponent": r"exponent $\beta$ of the power law",
    "relaxation_time": r"relaxation time $\tau$",
    "pull_off_force": "pull-off force",
    "adhesion_work": "work of separation",
    "contact_point": "height at no force",
}
_DECADE = 10.0  # spread from where a modulus is drawn on a logarithmic scale
_INNER = (2.0, 98.0)  # percentiles that the colours span, so that a few bad curves do not grey out the rest


def draw(data: Any, names: tuple[str, ...] | None = None, save: str | os.PathLike[str] | None = None) -> Any:
    """Draw variables of a map and, last, the state of each curve; by default modulus, adhesion and height.

    A value that its curve does not determine is crossed and does not stretch the colours, or is a lower bound, with a
    triangle; without a result it is grey.

    Returns
    -------
    matplotlib.figure.Figure
        Also written to `save`, whole or not at all.
    """
    names = tuple(name for name in PANELS if name in data) if names is None else names
    unknown = [name for name in names if name not in data]
    if unknown:
        raise InvalidValue(f"{unknown[0]!r} is not in this map; it has {', '.join(data.data_vars)}")
    count = len(names) + 1
    across = min(count, 2 if count <= 4 else 3)
    figure = new_figure(5.2 * across, 4.4 * -(-count // across))
    panels = figure.subplots(-(-count // across), across, squeeze=False).ravel()
    extent, labels = _extent(data)
    for panel, name in zip(panels, names, strict=False):
        _quantity(figure, panel, data, name, extent)
    _state(figure, panels[len(names)], data, extent)
    for panel in panels[:count]:
        panel.set_xlabel(labels[0])
        panel.set_ylabel(labels[1])
    for panel in panels[count:]:
        panel.set_axis_off()
    figure.suptitle(f"{plain(data.attrs.get('title', ''))}, {data.sizes['y']} x {data.sizes['x']} curves", fontsize=10)
    return saved(figure, save, dpi=130)


def _quantity(figure: Any, panel: Any, data: Any, name: str, extent: list[float]) -> None:
    colors = require("matplotlib.colors", "app")
    values = np.asarray(data[name].values, float)
    if name == "contact_point":
        values = values - np.nanmin(values) if np.isfinite(values).any() else values
    unit = "" if data[name].attrs["units"] == "1" else data[name].attrs["units"]
    unit, scale = engineering(unit, np.nan_to_num(values, posinf=0.0, neginf=0.0)) if unit else ("", 1.0)
    good = determined(data, name)
    least = (
        np.asarray(data[f"{name}_least"].values, float) if f"{name}_least" in data else np.full(values.shape, np.nan)
    )
    bounded = ~good & np.isfinite(least)
    values = np.where(bounded, least, values)
    spanned = values[good if good.any() else np.isfinite(values)] * scale
    low, high = np.percentile(spanned, _INNER) if spanned.size else (0.0, 1.0)
    if low == high:
        low, high = low - 0.5 * (abs(low) or 1.0), high + 0.5 * (abs(high) or 1.0)
    logarithmic = name.endswith("modulus") and low > 0.0 and high > _DECADE * low
    norm = colors.LogNorm(low, high) if logarithmic else colors.Normalize(low, high)
    panel.set_facecolor("0.7")
    image = panel.imshow(values * scale, origin="lower", extent=extent, norm=norm, cmap="viridis", interpolation="none")
    figure.colorbar(image, ax=panel, label=unit, extend="both")
    doubtful = np.isfinite(values) & ~good & ~bounded
    for marked, marker in ((doubtful, "x"), (bounded, "^")):
        if marked.any():
            y, x = np.nonzero(marked)
            panel.scatter(*_centres(data, extent, y, x), s=6, marker=marker, lw=0.6, color="white")
    without = int(np.count_nonzero(~np.isfinite(values)))
    bounds = f"{int(bounded.sum())} a lower bound (^), " if bounded.any() else ""
    panel.set_title(f"{_TITLES.get(name, name.replace('_', ' '))}\n{int(doubtful.sum())} not determined (x), {bounds}"
                    f"{without} without (grey)", fontsize=9)  # fmt: skip


def _state(figure: Any, panel: Any, data: Any, extent: list[float]) -> None:
    """No result, flagged, or neither."""
    colors = require("matplotlib.colors", "app")
    state = np.where(data["status"].values != 0, 2, np.where(doubtful(data), 1, 0))
    palette = colors.ListedColormap(["#009e73", "#e69f00", "#000000"])
    image = panel.imshow(state, origin="lower", extent=extent, cmap=palette, vmin=-0.5, vmax=2.5, interpolation="none")
    bar = figure.colorbar(image, ax=panel, ticks=[0, 1, 2])
    bar.ax.set_yticklabels([f"{name}: {np.count_nonzero(state == i)}" for i, name in
                            enumerate(("good", "flagged", "no result"))])  # fmt: skip
    common = sorted(flag_counts(data).items(), key=lambda item: -item[1])[:3]
    panel.set_title("state of the curves\n" + ", ".join(f"{name} {count}" for name, count in common), fontsize=9)


def _extent(data: Any) -> tuple[list[float], tuple[str, str]]:
    """Edges of the picture for imshow and the labels of x and y."""
    steps, labels = [], []
    lengths = np.concatenate([data["x"].values, data["y"].values]).astype(float)
    unit, scale = engineering("m", lengths) if data["x"].attrs.get("units") == "m" else ("", 1.0)
    for axis in ("x", "y"):
        values = np.asarray(data[axis].values, float) * scale
        half = 0.5 * (values[-1] - values[0]) / max(1, values.size - 1) or 0.5
        steps += [values[0] - half, values[-1] + half]
        labels.append(f"{axis} ({unit})" if unit else {"x": "column", "y": "row"}[axis])
    return steps, (labels[0], labels[1])


def _centres(data: Any, extent: list[float], y: NDArray[Any], x: NDArray[Any]) -> tuple[Floats, Floats]:
    ny, nx = data.sizes["y"], data.sizes["x"]
    return (extent[0] + (x + 0.5) * (extent[1] - extent[0]) / nx, extent[2] + (y + 0.5) * (extent[3] - extent[2]) / ny)
