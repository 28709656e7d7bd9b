# SPDX-License-Identifier: BSD-3-Clause
"""What levelling took away, step by step, and what other ways would have given."""

from __future__ import annotations

from dataclasses import dataclass

from .terraces import Terrace
from .words import length


@dataclass(frozen=True)
class Candidate:
    """A way to level an image, and what it would give: by none of these numbers alone is it chosen.

    Attributes
    ----------
    method : str
        As for :func:`~nanotouch.images.level`.
    rms : float
        Root mean square left [m]. Small where a structure was erased, too.
    held_out : float
        What every other column, which took no part, still has from row to row: rms of the median differences [m].
    anisotropy : float
        Power of the profile of the rows over that of the columns that is left [-]: far above 1 is drift or a structure
        along the fast axis.
    step_kept : float
        Of a step along the fast axis that was added to the image on trial, the share that is left [-].
    """

    method: str
    rms: float
    held_out: float
    anisotropy: float
    step_kept: float

    def __str__(self) -> str:
        return (
            f"{self.method}, {length(self.rms)} rms left, {length(self.held_out, 3)} from row to row held out, "
            f"rows over columns {self.anisotropy:.3g}, {100 * self.step_kept:.0f} % of a step on trial kept"
        )


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
        return f"{self.method}: removed {length(self.removed_range)}; {self.note}"


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
    candidates : tuple of Candidate
        Of the method "auto": what was chosen, then the runner-up, then the others.
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
    candidates: tuple[Candidate, ...] = ()

    def __str__(self) -> str:
        ranges = f"height range {length(self.range_before)} before, {length(self.range_after)} after"
        lines = [f"{self.method} levelling: {ranges}", *(f"  {step}" for step in self.steps)]
        for name, one in zip(("chosen", "runner-up"), self.candidates, strict=False):
            lines.append(f"  {name}: {one}")
        return "\n".join(lines + [f"  warning: {text}" for text in self.warnings])
