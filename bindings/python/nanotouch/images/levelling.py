# SPDX-License-Identifier: BSD-3-Clause
"""Make an image touchable without inventing or erasing structure: take out tilt, bow and offsets from row to row.

Every method is aware of steps. Tilt and bow are what the flat pieces of the surface agree on (terraces.py); offsets of
rows are what does not last and what both halves of the image agree on (rows.py). Each says what it removed, and warns
where it had to leave, or has taken, what may be a structure.
"""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._words import counted
from ..errors import InvalidValue
from . import rows, terraces
from ._robust import block_means, digit, reduction, used_pixels
from .despeckling import DespeckleReport, despeckle
from .terraces import Terrace
from .topography import Topography

_METHOD = re.compile(r"plane|poly[2-6]|rows|medians|terraces")


@dataclass(frozen=True)
class LevelStep:
    """What one method took away.

    Attributes
    ----------
    method : str
        "plane", "poly2", "rows", ...
    removed_range : float
        Highest minus lowest of what was removed [m].
    removed_rms : float
        Its root mean square about its mean [m].
    note : str
        What was found, in a sentence.
    """

    method: str
    removed_range: float
    removed_rms: float
    note: str

    def __str__(self) -> str:
        return f"{self.method}: removed {self.removed_range * 1e9:.4g} nm; {self.note}"


@dataclass(frozen=True)
class LevelReport:
    """What levelling took away.

    Attributes
    ----------
    method : str
        As given to :func:`level`.
    steps : tuple of LevelStep
        What each method removed, in order.
    tilt : tuple of float
        Slopes of the removed plane ``(dz/dy, dz/dx)`` [-].
    offset : float
        Removed mean height [m].
    removed_range : float
        Highest minus lowest of all that was removed, over the image [m].
    range_before, range_after : float
        Highest minus lowest height of the image [m].
    pieces : int
        Number of pieces the image was cut into along its steep places; 1 where nothing was fitted.
    terraces : tuple of Terrace
        The levels of the surface, largest first; only of the method "terraces".
    warnings : tuple of str
        What may be a structure and was erased, or was left because it may be one.
    """

    method: str
    steps: tuple[LevelStep, ...]
    tilt: tuple[float, float]
    offset: float
    removed_range: float
    range_before: float
    range_after: float
    pieces: int
    terraces: tuple[Terrace, ...]
    warnings: tuple[str, ...]

    def __str__(self) -> str:
        ranges = f"height range {self.range_before * 1e9:.4g} nm before, {self.range_after * 1e9:.4g} nm after"
        lines = [f"{self.method} levelling: {ranges}", *(f"  {step}" for step in self.steps)]
        return "\n".join(lines + [f"  warning: {text}" for text in self.warnings])


def prepare(topography: Topography) -> tuple[Topography, tuple[LevelReport, DespeckleReport]]:
    """Level by plane and rows, and despeckle: what ``nanotouch touch`` does to an image before it is touched."""
    levelled, level_report = level(topography, "plane+rows")
    clean, despeckle_report = despeckle(levelled)
    return clean, (level_report, despeckle_report)


def level(
    topography: Topography, method: str = "plane", mask: NDArray[np.bool_] | None = None
) -> tuple[Topography, LevelReport]:
    """Take out tilt, bow, offsets of rows and the mean height, keeping every step.

    Parameters
    ----------
    topography : Topography
        The image.
    method : str
        One of these, or several joined by ``+`` and done in that order, as ``"plane+rows"`` (after the rows the
        background before them is fitted once more):

        ==============  ==============================================================================================
        ``plane``       the tilt that the flat pieces of the surface agree on
        ``poly2``       a polynomial of total order 2 (up to ``poly6``) in the same way: the bow of a scanner
        ``rows``        offsets from row to row, as far as they are no structure
        ``medians``     every row to the same median, whatever that erases; warns where it is a structure
        ``terraces``    as ``plane``; height 0 is the largest level, and the levels are listed in the report
        ==============  ==============================================================================================
    mask : ndarray, shape (ny, nx), bool, optional
        True where a pixel shall not take part; pixels that were filled in never do.

    Returns
    -------
    topography : Topography
        Mean height of the pixels that took part 0 (with ``terraces``: the largest level).
    report : LevelReport
        What was removed; its warnings are given as :class:`UserWarning` too.
    """
    methods = method.split("+") if isinstance(method, str) else [""]
    if not all(_METHOD.fullmatch(m) for m in methods):
        raise InvalidValue(
            f"method: {method!r}, expected plane, poly2 .. poly6, rows, medians or terraces, or several joined by +"
        )
    job = _Job(topography, used_pixels(topography, mask, terraces.SMALLEST_PIECE))
    for name in methods:
        job.take_out(name)
    levelled, report = job.result(method)
    for text in report.warnings:
        warnings.warn(text, stacklevel=2)
    return levelled, report


class _Job:
    """An image while one method after the other is applied.

    They work on strips, means over blocks along the rows; the image itself is touched once, at the end.
    """

    def __init__(self, topography: Topography, used: NDArray[np.bool_] | None) -> None:
        z = topography.heights
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

    def take_out(self, method: str) -> None:
        """Apply one method to the strips and add to what is to be removed."""
        if method in ("rows", "medians"):
            self._take_out_rows(method)
        else:
            self._take_out_background(method)

    def _take_out_background(self, method: str, again: terraces.Background | None = None) -> None:
        shape = self.topography.shape
        order = int(method[4:]) if method.startswith("poly") else 1
        if again is None:
            found = terraces.fit(self.strips, shape, order, self.floor)
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
            note += f" and a bow of {np.ptp(bow) * 1e9:.4g} nm"
        if method == "terraces":
            self.terraces, self.zero = terraces.levels(self.strips, found)
            heights = ", ".join(f"{t.height * 1e9:.4g} nm ({100 * t.share:.3g} %)" for t in self.terraces[:6])
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
                    f"{rms * 1e9:.3g} nm rms left: a structure may have gone; use poly2 or a mask"
                )

    def _take_out_rows(self, method: str) -> None:
        found = rows.analyse(self.strips)
        removed = found.offsets if method == "rows" else rows.medians(self.strips)
        self.strips = self.strips - removed[:, None]
        self.by_row += removed
        note, warning = (self._rows_verdict if method == "rows" else self._medians_verdict)(found)
        if warning:
            self.warnings.append(warning)
        self._record(method, removed, note)
        if removed.any() and self.background:  # which sees better now
            self._take_out_background(*self.background)

    def _rows_verdict(self, found: rows.RowProfile) -> tuple[str, str]:
        lasting = f"{found.lasting * 1e9:.3g} nm that last along y were kept"
        if found.jumps:
            steps = counted(found.jumps, "step")
            lasting += f", with {steps} across whole rows up to {found.highest_jump * 1e9:.4g} nm"
        if found.period is not None:
            return f"none; {lasting}", (
                f"rows repeat every {found.period:.3g} rows over {found.wave * 1e9:.4g} nm: taken for a grating along "
                "the fast axis and left; medians would erase it"
            )
        if not found.agreed:
            return f"no offsets on which both halves of the image agree; {lasting}", ""
        if found.single:
            off = counted(len(found.single), "row was", "rows were")
            return f"offsets of rows; {lasting}", (
                f"{off} off by up to {found.highest_single * 1e9:.4g} nm and put back (the first is row "
                f"{found.single[0]}); if that is a wire along the fast axis, level without rows"
            )
        return f"offsets of rows; {lasting}", ""

    def _medians_verdict(self, found: rows.RowProfile) -> tuple[str, str]:
        rms, lasting = float(np.nanstd(self.strips)), found.lasting
        note = f"the median of every row, {lasting * 1e9:.4g} nm of it lasting along y"
        if found.period is not None:
            what = f"a grating along the fast axis of {found.period:.3g} rows, {found.wave * 1e9:.4g} nm high"
        elif found.jumps and found.highest_jump > rms:
            what = f"{counted(found.jumps, 'step')} along the fast axis, up to {found.highest_jump * 1e9:.4g} nm high"
        elif lasting > 4.0 * rms:
            what = f"a structure along the fast axis, {lasting * 1e9:.4g} nm high over {rms * 1e9:.3g} nm rms left"
        else:
            return note, ""
        return note, f"medians erased what looks like {what}; use rows"

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
