# SPDX-License-Identifier: BSD-3-Clause
"""Reads a generated file as users do, and says: right, refused (with the reason), or silently wrong.

Nothing here knows a format. Images go through ``nt.images.channels`` and ``nt.images.read``, curves and maps through
``nt.curves.read``, with every option at its default but for what the file does not state.
"""

from __future__ import annotations

import contextlib
import io
import logging
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import Any

import nanotouch as nt
import numpy as np
from made import Array, Curve, Curves, Image, Made, Part, Plane

SCALE = 1e-4  # of lengths: headers print five to seven digits
VALUE = 2e-6  # of the range: single precision, and the digits of a printed scale
BACK = ("retrace", "backward", "bwd", "reverse")


@dataclass(frozen=True)
class Verdict:
    kind: str  # right, refused, wrong
    reason: str = ""


RIGHT = Verdict("right")


def judge(made: Made) -> Verdict:
    """The verdict on one file."""
    check = _image if isinstance(made.truth, Image) else _curves
    with _silence():
        try:
            reason = check(made)
        except nt.Error as error:
            return Verdict("refused", " ".join(str(error).split()).replace(f"{made.path}: ", ""))
        except Exception as error:
            return Verdict("wrong", f"{type(error).__name__}: {error}")
    if reason:
        return Verdict("wrong", reason)
    return Verdict("wrong", f"read, though {made.must_refuse}") if made.must_refuse else RIGHT


@contextlib.contextmanager
def _silence() -> Iterator[None]:
    logging.disable(logging.CRITICAL)
    try:
        with (
            warnings.catch_warnings(),
            contextlib.redirect_stdout(io.StringIO()),
            contextlib.redirect_stderr(io.StringIO()),
        ):
            warnings.simplefilter("ignore")
            yield
    finally:
        logging.disable(logging.NOTSET)


def _guessed(made: Made, read: Callable[..., Any]) -> str:
    """Read without what the file does not state: a refusal is due, or curves without forces."""
    for name in set(made.given) - {"channel"}:
        try:
            found = read(made.path, **{key: value for key, value in made.given.items() if key != name})
        except nt.Error:
            continue
        if name != "spring_constant" or any(s.force is not None for curve in found for s in curve.segments):
            return f"read without {name}, which the file does not state"
    return ""


def _untold(made: Made, notes: Sequence[str]) -> str:
    text = " ".join(notes).lower()
    for words in made.told:
        if not any(word.lower() in text for word in words):
            return f"no note with {' or '.join(words)}: {text!r}"
    return ""


def _image(made: Made) -> str:
    truth = made.truth
    assert isinstance(truth, Image)
    if wrong := _guessed(made, nt.images.read):
        return wrong
    read = nt.images.read(made.path, **made.given)
    differences = [_plane_differs(read, plane) for plane in truth.defaults]
    if all(differences):
        return f"{read.channel!r}: {differences[0]}"
    if wrong := _untold(made, read.notes):
        return wrong
    return _channels(made, truth)


def _channels(made: Made, truth: Image) -> str:
    """Every channel of heights that is listed is one that was written; trace and retrace are told apart by name."""
    planes = [*truth.defaults, *truth.others]
    for channel in nt.images.channels(made.path):
        if channel.kind != "height":
            continue
        try:
            read = nt.images.read(made.path, **made.given | {"channel": channel.name})
        except nt.Error:
            continue
        differences = {_plane_differs(read, plane): plane for plane in planes}
        if "" not in differences:
            return f"channel {channel.name!r}: {next(iter(differences))}"
        plane = differences[""]
        told = any(word in channel.name.lower() for word in BACK)
        if plane.trace is not None and {p.trace for p in planes} == {True, False} and told == plane.trace:
            return f"channel {channel.name!r} is the {'trace' if plane.trace else 'retrace'}"
    return ""


def _plane_differs(read: nt.images.Topography, plane: Plane) -> str:
    ours = _measured(np.where(read.mask, np.nan, read.heights))
    theirs = _measured(plane.heights)
    if ours.shape != theirs.shape:
        return f"{ours.shape[0]} x {ours.shape[1]} pixels for {theirs.shape[0]} x {theirs.shape[1]}"
    for name, got, due in zip(("dy", "dx"), read.pixel_size, plane.pixel, strict=True):
        if abs(got - due) > SCALE * due:
            return f"{name} {got:.5g} m for {due:.5g} m"
    if (np.isnan(ours) != np.isnan(theirs)).any():
        return f"{np.isnan(ours).sum()} pixels missing for {np.isnan(theirs).sum()}"
    difference = ours - theirs
    if plane.free:
        difference = difference - np.nanmean(difference)
    worst = np.nanmax(np.abs(difference))
    if worst > VALUE * np.nanmax(np.abs(theirs)):
        flips = {"upside down": ours[::-1], "mirrored": ours[:, ::-1], "turned": ours[::-1, ::-1], "negated": -ours}
        for name, flipped in flips.items():
            if np.nanmax(np.abs(flipped - theirs)) < 0.1 * worst:
                return name
        return f"heights over {np.ptp(ours[~np.isnan(ours)]):.5g} m for {np.ptp(theirs[~np.isnan(theirs)]):.5g} m"
    return ""


def _measured(heights: Array) -> Array:
    """Without the rows at the edges that hold nothing: lines of a scan that was stopped may be left out or masked."""
    rows = np.flatnonzero(~np.isnan(heights).all(axis=1))
    return heights[rows[0] : rows[-1] + 1] if rows.size else heights[:0]


def _curves(made: Made) -> str:
    truth = made.truth
    assert isinstance(truth, Curves)
    if wrong := _guessed(made, nt.curves.read):
        return wrong
    read = nt.curves.read(made.path, **made.given)
    if wrong := _curves_differ(read, truth):
        return wrong
    if wrong := _untold(made, [note for curve in read for note in curve.meta.get("notes", ())]):
        return wrong
    if truth.curves[0].place is not None and (wrong := _places(made, truth, read)):
        return wrong
    first = truth.curves[0]
    for name, stated in (("spring_constant", first.spring_constant), ("sensitivity", first.sensitivity)):
        if stated is None or name in made.given:
            continue
        corrected = nt.curves.read(made.path, **made.given | {name: 2 * stated})
        if wrong := _curves_differ(corrected, _corrected(truth, name)):
            return f"with {name} times 2: {wrong}"
    return ""


def _places(made: Made, truth: Curves, read: Sequence[nt.curves.ForceCurve]) -> str:
    """A map has every curve at its place: what the fit reads off there is what the curve alone shows."""
    data = nt.maps.fit(made.path, "hertz", radius=1e-6, **made.given)
    slopes = data.contact_slope.values
    due = np.full(slopes.shape, np.nan)
    for theirs, curve in zip(truth.curves, read, strict=True):
        assert theirs.place is not None
        if not (theirs.place[1] < due.shape[0] and theirs.place[0] < due.shape[1]):
            return f"a map of {due.shape[0]} x {due.shape[1]}, and none at {theirs.place}"
        due[theirs.place[::-1]] = nt.curves.analyse(curve).contact_slope
    return "" if np.allclose(slopes, due, rtol=1e-6, equal_nan=True) else f"places: slopes {slopes} for {due}"


def _corrected(truth: Curves, name: str) -> Curves:
    """Twice the spring constant, or twice the sensitivity: what follows from either follows."""

    def twice(curve: Curve) -> Curve:
        parts = tuple(
            replace(
                part,
                deflection=part.deflection if part.deflection is None or name != "sensitivity" else 2 * part.deflection,
                force=None if part.force is None else 2 * part.force,
            )
            for part in curve.parts
        )
        stated = getattr(curve, name)
        setpoint = None if curve.setpoint is None else 2 * curve.setpoint
        return replace(curve, parts=parts, setpoint=setpoint, **{name: 2 * stated})

    return replace(truth, curves=tuple(twice(curve) for curve in truth.curves))


def _curves_differ(read: Sequence[nt.curves.ForceCurve], truth: Curves) -> str:
    if len(read) != len(truth.curves):
        return f"{len(read)} curves for {len(truth.curves)}"
    for number, (ours, theirs) in enumerate(zip(read, truth.curves, strict=True)):
        if wrong := _curve_differs(ours, theirs):
            return f"curve {number}: {wrong}"
    return ""


def _curve_differs(read: nt.curves.ForceCurve, truth: Curve) -> str:
    ours = _joined([Part(s.role, s.z, s.deflection, s.force, _span(s.time)) for s in read.segments])
    theirs = _joined(truth.parts)
    if truth.cycle:
        return _cycle_differs(ours, theirs) or _meta_differs(read, truth)
    told, due = ([(part.role, len(part.z)) for part in parts] for parts in (ours, theirs))
    if told != due:
        return f"segments {told} for {due}"
    shift = 0.0
    if truth.free_z:
        shift = float(np.mean(np.concatenate([a.z - b.z for a, b in zip(ours, theirs, strict=True)])))
    for quantity in ("z", "deflection", "force"):
        pairs = [(getattr(a, quantity), getattr(b, quantity)) for a, b in zip(ours, theirs, strict=True)]
        if wrong := _quantity_differs(quantity, pairs, shift if quantity == "z" else 0.0):
            return wrong
    for a, b in zip(ours, theirs, strict=True):
        if b.duration and a.duration and abs(a.duration - b.duration) > 2.5 * b.duration / len(b.z):
            return f"{b.role} of {a.duration:.5g} s for {b.duration:.5g} s"
    return _meta_differs(read, truth)


def _cycle_differs(ours: Sequence[Part], theirs: Sequence[Part]) -> str:
    """A period may begin anywhere and be cut beside its deepest point: compared are points, sorted by deflection."""

    def sorted_points(parts: Sequence[Part]) -> tuple[Array, Array, Array]:
        columns = (
            np.concatenate([part.deflection for part in parts if part.deflection is not None]),
            np.concatenate([part.z for part in parts]),
            np.concatenate([np.full(len(part.z), part.role == "approach") for part in parts]),
        )
        order = np.lexsort((columns[1], np.round(columns[0] / VALUE / np.ptp(columns[0]))))
        return columns[0][order], columns[1][order], columns[2][order]

    got, due = sorted_points(ours), sorted_points(theirs)
    if len(got[0]) != len(due[0]):
        return f"{len(got[0])} points for {len(due[0])}"
    for name, a, b in zip(("deflection", "z"), got, due, strict=False):
        worst = np.abs(a - b - (np.mean(a - b) if name == "z" else 0.0)).max()
        if worst > 5e-6 * np.ptp(b):
            return f"{name} off by {worst:.4g} m"
    other = int((got[2] != due[2]).sum())
    return f"{other} points of the other branch" if other > 3 else ""


def _quantity_differs(name: str, pairs: list[tuple[Array | None, Array | None]], shift: float) -> str:
    known = [(a, b) for a, b in pairs if b is not None]
    if not known:
        return ""
    if any(a is None for a, _ in known):
        return f"no {name}"
    ours, theirs = (np.concatenate([pair[i] for pair in known if pair[i] is not None]) for i in (0, 1))
    scale = max(float(np.ptp(theirs)), float(np.abs(theirs).max()) if not shift else 0.0)
    worst = float(np.abs(ours - shift - theirs).max())
    if not worst <= VALUE * scale:
        signs = " (negated)" if float(np.abs(ours + theirs).max()) < 0.1 * worst else ""
        return f"{name} {ours.min():.5g} .. {ours.max():.5g} for {theirs.min():.5g} .. {theirs.max():.5g}{signs}"
    return ""


def _span(time: Array) -> float | None:
    n = len(time)
    return float(time[-1] - time[0]) * n / (n - 1) if n > 1 and np.isfinite(time).all() else None


def _joined(parts: Sequence[Part]) -> list[Part]:
    """Neighbours of one role as one."""
    found = []
    for role, group in groupby(parts, key=lambda part: part.role):
        run = list(group)
        columns = {
            name: None
            if any(getattr(p, name) is None for p in run)
            else np.concatenate([getattr(p, name) for p in run])
            for name in ("z", "deflection", "force")
        }
        spans = [p.duration for p in run]
        found.append(Part(role, **columns, duration=None if None in spans else sum(spans)))  # type: ignore[arg-type]
    return found


def _meta_differs(read: nt.curves.ForceCurve, truth: Curve) -> str:
    due = {"spring constant": truth.spring_constant, "sensitivity": truth.sensitivity, "setpoint": truth.setpoint}
    for name, value in due.items():
        got = read.meta.get(name)
        if value is None or (got is None and name == "setpoint"):
            continue
        if got is None or abs(got - value) > SCALE * abs(value):
            return f"{name} {got} for {value:.6g}"
    return ""
