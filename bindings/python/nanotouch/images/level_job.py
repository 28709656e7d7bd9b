# SPDX-License-Identifier: BSD-3-Clause
"""An image while one method of levelling after the other is applied to it, and what each has to say."""

from __future__ import annotations

from copy import copy
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._io.words import counted
from . import drift, rows, terraces
from ._robust import block_means, digit, reduction
from .level_report import LevelReport, LevelStep
from .terraces import Terrace
from .topography import Topography
from .words import length

_ROUNDING = 1e-9
"""Part of the height range that no converter resolves (24 bits: 6e-8) and that sums of doubles leave behind."""


class Job:
    """An image while one method after the other is applied.

    They work on strips, means over blocks along the rows; the image itself is touched once, at the end.
    """

    def __init__(self, topography: Topography, used: NDArray[np.bool_] | None, *, rows_stray: bool = False) -> None:
        """rows_stray: what lasts from row to row is not taken out, so that it would tell a bow along y falsely."""
        z = topography.heights
        self.rows_stray = rows_stray
        self.topography, self.used = topography, used
        self.width = reduction(z.shape[1])
        known = z if used is None else np.where(used, z, np.nan)
        self.strips = block_means(known, self.width, 1)
        if used is not None and np.isnan(self.strips).all():
            self.width, self.strips = 1, known
        self.floor = digit(np.diff(known[:: len(z) // 64 | 1], axis=1), topography.height_range)
        self.by_row, self.by_column = np.zeros(len(z)), np.zeros(z.shape[1])
        self.curved: Floats | None = None
        self.tilt = np.zeros(2)  # (dz/dy, dz/dx) [-]
        self.steps: list[LevelStep] = []
        self.warnings: list[str] = []
        self.pieces = 1
        self.background: tuple[str, terraces.Background] | None = None  # the last
        self.terraces: tuple[Terrace, ...] = ()
        self.zero: float | None = None  # [m]; the mean if None
        self._seen: tuple[Floats, drift.Drift] | None = None
        self.offsets: Floats = np.zeros(len(z))  # of rows, the last that were taken out [m]

    def look(self) -> drift.Drift:
        """What the rows show as they are."""
        if self._seen is None or self._seen[0] is not self.strips:
            self._seen = self.strips, drift.analyse(self.strips)
        return self._seen[1]

    def copy(self) -> Job:
        """The same, to go on in another way."""
        made = copy(self)
        made.by_row, made.by_column, made.tilt = self.by_row.copy(), self.by_column.copy(), self.tilt.copy()
        made.steps, made.warnings = list(self.steps), list(self.warnings)
        return made

    def take_out(self, method: str) -> None:
        """Apply one method to the strips and add to what is to be removed."""
        if method == "lines":
            self._take_out_lines()
        elif method in ("rows", "medians"):
            self._take_out_rows(method)
        else:
            self._take_out_background(method)

    def _take_out_background(self, method: str, again: terraces.Background | None = None) -> None:
        shape = self.topography.shape
        order = int(method[4:]) if method.startswith("poly") else 1
        if again is None:
            found = terraces.fit(self.strips, shape, order, self.floor, along_y=1 if self.rows_stray else order)
        else:
            found = terraces.refit(self.strips, shape, again)
        removed = found.values(shape, (1, self.width))
        self.strips = self.strips - removed
        plane_y, plane_x = found.plane(shape)
        self.by_row += plane_y
        self.by_column += plane_x
        slopes = np.array([np.ptp(p) / (len(p) - 1) * np.sign(p[-1]) for p in (plane_y, plane_x)])
        slopes /= self.topography.pixel_size
        self.tilt += slopes
        self.pieces, self.background = found.pieces, (method, found)
        note = f"a tilt of {np.degrees(np.arctan(np.hypot(*slopes))):.3g} degrees"
        note += f" on which {found.pieces} pieces agree" if found.pieces > 1 else ""
        if order > 1:
            bow = found.bow(shape)
            self.curved = bow if self.curved is None else self.curved + bow
            self._judge_bow(method, bow)
            note += f" and a bow of {length(np.ptp(bow))}"
        if method == "terraces":
            self.terraces, self.zero = terraces.levels(self.strips, found)
            heights = ", ".join(f"{length(t.height)} ({100 * t.share:.3g} %)" for t in self.terraces[:6])
            note += f"; levels at {heights}" + (", ..." if len(self.terraces) > 6 else "")
        self._record(method, removed, note)

    def _judge_bow(self, method: str, bow: Floats) -> None:
        """A scanner bends a flat once. A background that turns again, by more than the roughness left, is a wave."""
        rms = float(np.nanstd(self.strips))
        for axis, name in ((0, "x"), (1, "y")):
            turns = _turns(bow.mean(axis=axis), rms)
            if turns > 1:
                self.warnings.append(
                    f"{method} removed a background that turns {turns} times along {name} by more than the "
                    f"{length(rms, 3)} rms left: a structure may have gone; use poly2 or a mask"
                )

    def _take_out_lines(self) -> None:
        found = self.look()
        self.strips = self.strips - found.offsets[:, None]
        self.offsets = found.offsets
        self.by_row += found.offsets
        note = f"offsets of rows, and {length(found.lasting)} of drift along y"
        if found.structure:
            told = f"repeats every {found.period:.3g} rows" if found.period else f"has {len(found.jumps)} like steps"
            note = f"offsets of rows alone: what lasts {told}, as a grating along the fast axis does"
        elif found.jumps:
            self.warnings.append(
                f"{counted(len(found.jumps), 'step')} of {length(abs(found.jumps[0]))} across whole rows kept; if "
                "the tip changed there and the surface has no step, mask one part or use medians"
            )
        self._record("lines", found.offsets, note)
        if found.offsets.any() and self.background:  # which sees better now, and other pieces where drift has gone
            method, background = self.background
            self._take_out_background(method, background if found.structure else None)

    def _take_out_rows(self, method: str) -> None:
        self._along = self.look()
        found = self._along.rows
        removed = found.offsets if method == "rows" else rows.medians(self.strips)
        self.strips = self.strips - removed[:, None]
        self.offsets = removed
        self.by_row += removed
        note, warning = (self._rows_verdict if method == "rows" else self._medians_verdict)(found)
        if warning:
            self.warnings.append(warning)
        self._record(method, removed, note)
        if removed.any() and self.background:  # which sees better now
            self._take_out_background(*self.background)

    def _rows_verdict(self, found: rows.RowProfile) -> tuple[str, str]:
        lasting = f"{length(found.lasting, 3)} that last along y were kept"
        if self._along.lasting > float(np.nanstd(self.strips - self._along.offsets[:, None])):
            lasting += f" ({length(self._along.lasting, 3)} of them look like drift: lines takes it out)"
        if found.jumps:
            steps = counted(found.jumps, "step")
            lasting += f", with {steps} across whole rows up to {length(found.highest_jump)}"
        if found.period is not None:
            return f"none; {lasting}", (
                f"rows repeat every {found.period:.3g} rows over {length(found.wave)}: taken for a grating along "
                "the fast axis and left; medians would erase it"
            )
        if not found.agreed:
            return f"no offsets on which both halves of the image agree; {lasting}", ""
        if found.single:
            off = counted(len(found.single), "row was", "rows were")
            return f"offsets of rows; {lasting}", (
                f"{off} off by up to {length(found.highest_single)} and put back (the first is row "
                f"{found.single[0]}); if that is a wire along the fast axis, level without rows"
            )
        return f"offsets of rows; {lasting}", ""

    def _medians_verdict(self, found: rows.RowProfile) -> tuple[str, str]:
        note = f"the median of every row, {length(found.lasting)} of it lasting along y"
        if found.lasting < _ROUNDING * self.topography.height_range:
            return note, ""
        if found.period is not None:
            what = f"a grating along the fast axis of {found.period:.3g} rows, {length(found.wave)} high"
        elif found.jumps and found.highest_jump > float(np.nanstd(self.strips)) and self._along.structure:
            what = f"{counted(found.jumps, 'step')} along the fast axis, up to {length(found.highest_jump)} high"
        elif self._along.structure or self._surface_went(found):
            what = f"a structure along the fast axis, {length(found.lasting)} high"
        else:
            return note, ""
        return note, f"medians erased what looks like {what}; use lines"

    def _surface_went(self, found: rows.RowProfile) -> bool:
        """Whether what lasts is more than drift: high over what is left, and not what lines would take out."""
        left = found.lasting - self._along.lasting
        return left > 4.0 * float(np.nanstd(self.strips)) and left > 0.5 * found.lasting

    def _record(self, method: str, removed: Floats, note: str) -> None:
        self.steps.append(LevelStep(method, float(np.ptp(removed)), float(removed.std()), note))

    def result(self, method: str) -> tuple[Topography, LevelReport]:
        """The levelled image and the report."""
        before = self.topography
        heights = before.heights - self.by_row[:, None]
        heights -= self.by_column
        removed_range = float(np.ptp(self.by_row) + np.ptp(self.by_column))
        offset = float(self.by_row.mean() + self.by_column.mean())
        if self.curved is not None:
            heights -= self.curved
            removed_range = float(np.ptp(before.heights - heights))
            offset += float(self.curved.mean())
        zero = self.zero
        if zero is None:
            zero = float(heights.mean() if self.used is None else heights[self.used].mean())
        heights -= zero
        levelled = replace(before, heights=heights)
        report = LevelReport(
            method,
            tuple(self.steps),
            (float(self.tilt[0]), float(self.tilt[1])),
            zero + offset,
            removed_range,
            before.height_range,
            levelled.height_range,
            self.pieces,
            self.terraces,
            tuple(self.warnings),
        )
        return levelled, report


def _turns(profile: Floats, prominence: float) -> int:
    """How often a profile turns round by more than `prominence`."""
    turns, direction = 0, 0
    low = high = float(profile[0])
    for value in profile:
        low, high = min(low, value), max(high, value)
        if direction >= 0 and high - value > prominence:
            turns, direction, low = turns + (direction > 0), -1, value
        elif direction <= 0 and value - low > prominence:
            turns, direction, high = turns + (direction < 0), 1, value
    return turns
