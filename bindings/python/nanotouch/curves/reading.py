# SPDX-License-Identifier: BSD-3-Clause
"""Read force curves: pick the reader, apply the calibration that is given, check that what comes out is plausible."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

from .. import guard
from .._io import worker
from .._io.files import checked_path, guarded, refuse_traps
from .._io.readers import head_of, registered_for
from .._io.stream import Guarded
from .._io.words import printable
from ..errors import ReadError
from ..formats import refusal
from . import afm_formats, archive, asylum, asylum_pair, jpk, jpk_text, nanonis, nanoscope, nanoscope_text, nova
from .calibration import Calibration, CalibrationTable, calibrated
from .checks import check_curve
from .curve import ForceCurve, Segment
from .doubts import doubts


def read(
    path: str | PathLike[str],
    *,
    spring_constant: float | None = None,
    sensitivity: float | None = None,
    calibration: CalibrationTable | str | PathLike[str] | None = None,
    untrusted: bool | None = None,
) -> list[ForceCurve]:
    """Read every curve of a file in one of the formats of :mod:`nanotouch.formats`.

    Parameters
    ----------
    path : str or path
        JPK ``.jpk-force``, ``.jpk-force-map``, ``.jpk-qi-data``, ``.jpk-qi-series``; Asylum ``.ibw``, of pairs the
        ``...Defl.ibw``; NT-MDT and Optics11 ``.txt``; AFM Workshop ``.csv``, ``.zip``; Nanonis ``.dat``; a ``.zip`` of
        such files; afmformats
        ``.h5``, ``.tab``. NanoScope ramps, force volumes and PeakForce captures (``.000``, ``.spm``, ``.pfc``, any
        name; known by how they begin).
    spring_constant : float, optional
        k_c [N/m], 1e-4 .. 1e4, in place of the file's; forces are rescaled, deflections stay.
    sensitivity : float, optional
        Deflection sensitivity [m/V], 1e-10 .. 1e-4, in place of the file's; forces and deflections are rescaled. Of
        NT-MDT's text, whose detector reads amperes, in m/A, 0.1 .. 1e5.
    calibration : CalibrationTable or path, optional
        The same for many files, by name; the two arguments above count more.
    untrusted : bool, optional
        True: open the file in a confined process (Linux only), for files from elsewhere (docs/security.md). By default
        the ``nanotouch`` command does so, Python does not.

    Returns
    -------
    list of ForceCurve
        In the order of the file; a map is one list. ``meta["placeholders"]`` names what the file states without
        anybody having measured it (:data:`~nanotouch.curves.calibration.PLACEHOLDERS`), ``meta["notes"]`` what was
        left out or supplied.

    Raises
    ------
    ReadError
        If the file is missing, empty, damaged, of another kind, lacks a calibration that was not given, or holds
        implausible values.
    InvalidValue
        If `spring_constant` or `sensitivity` is out of range.
    """
    given = Calibration(spring_constant, sensitivity)
    file = checked_path(path)
    given = _over_table(given, calibration, file)
    if guard.wanted(untrusted):
        options = {"spring_constant": given.spring_constant, "sensitivity": given.sensitivity}
        read_there = worker.ask("curves.read", file, options, list[ForceCurve], [Segment])
        return [_rechecked(curve, file) for curve in read_there]
    name, curves = _loaded(file, given)
    with guarded(file, name):
        if not curves:
            raise ReadError(f"{file}: holds no force curve")
        return [_believed(curve, given, file) for curve in curves]


def _believed(curve: ForceCurve, given: Calibration, file: Path) -> ForceCurve:
    """With what is given in place of the file's, checked, and with what speaks against it in its notes."""
    curve = calibrated(curve, given, file)
    check_curve(curve, file)
    notes = doubts(curve)
    if not notes:
        return curve
    return ForceCurve(curve.segments, dict(curve.meta) | {"notes": (*curve.meta.get("notes", ()), *notes)}, curve.name)


class Stream:
    """The curves of a JPK archive, each read, calibrated and checked as by :func:`read` when it is asked for."""

    def __init__(self, file: Path, given: Calibration) -> None:
        self.file, self._given = file, given
        with guarded(file, jpk.NAME):
            self._archive = jpk.Archive(file, given)

    def __len__(self) -> int:
        return len(self._archive)

    def __getitem__(self, number: int) -> ForceCurve:
        with guarded(self.file, jpk.NAME):
            return _believed(self._archive[number], self._given, self.file)

    def place(self, number: int) -> dict[str, Any]:
        """Where a curve was taken: what ``meta`` says of grid and position, without reading the curve."""
        with guarded(self.file, jpk.NAME):
            return self._archive.place(number)


class GuardedStream(Stream):
    """The same, read by a confined process."""

    def __init__(self, file: Path, given: Calibration) -> None:
        self.file = file
        options = {"spring_constant": given.spring_constant, "sensitivity": given.sensitivity}
        self._there = Guarded(file, options, (ForceCurve, Segment))

    def __len__(self) -> int:
        return len(self._there)

    def __getitem__(self, number: int) -> ForceCurve:
        return _rechecked(self._there[number], self.file)

    def place(self, number: int) -> dict[str, Any]:
        """Where a curve was taken."""
        return self._there.place(number)


def stream(
    path: str | PathLike[str],
    *,
    spring_constant: float | None = None,
    sensitivity: float | None = None,
    calibration: CalibrationTable | str | PathLike[str] | None = None,
    untrusted: bool | None = None,
) -> Stream | None:
    """The curves of a file one at a time, for maps larger than the memory; None where it can only be read whole.

    The arguments are those of :func:`read`.
    """
    file = checked_path(path)
    if file.suffix.lower() not in jpk.ENDINGS or registered_for(file, head_of(file), "curves") is not None:
        return None
    given = _over_table(Calibration(spring_constant, sensitivity), calibration, file)
    found = GuardedStream(file, given) if guard.wanted(untrusted) else Stream(file, given)
    if not len(found):
        raise ReadError(f"{file}: holds no force curve")
    return found


def _over_table(
    given: Calibration, calibration: CalibrationTable | str | PathLike[str] | None, file: Path
) -> Calibration:
    """What is given for the file, by value or by table."""
    if calibration is None:
        return given
    table = calibration if isinstance(calibration, CalibrationTable) else CalibrationTable.from_csv(calibration)
    return given.over(table.of(file))


def _loaded(file: Path, given: Calibration) -> tuple[str, list[ForceCurve]]:
    """Name of the reader, and the curves as the file states them."""
    head = head_of(file)
    refuse_traps(file, head)
    registered = registered_for(file, head, "curves")
    if registered is not None:
        name, reader = registered
        with guarded(file, name):
            return name, list(reader.read(file))
    if head.startswith(nanoscope.SIGNATURES):
        with guarded(file, nanoscope.NAME):
            return nanoscope.NAME, nanoscope.read(file, given)
    if file.suffix.lower() in jpk.ENDINGS:
        with guarded(file, jpk.NAME):
            return jpk.NAME, jpk.read(file, given)
    for own in (nanonis, jpk_text, nanoscope_text, nova):
        if own.recognises(file, head):
            with guarded(file, own.NAME):
                return own.NAME, own.read(file, given)
    if asylum_pair.recognises(file):
        with guarded(file, asylum_pair.NAME):
            return asylum_pair.NAME, asylum_pair.read(file, given)
    if archive.recognises(file, head):
        with guarded(file, archive.NAME):
            return archive.NAME, archive.read(file, lambda one: _loaded(checked_path(one), given)[1])
    if file.suffix.lower() == ".ibw":
        with guarded(file, asylum.NAME):
            return asylum.NAME, asylum.read(file, given)
    refused = refusal(file, head, "curves")
    if refused is not None:
        raise ReadError(f"{file}: {refused}")
    with guarded(file, afm_formats.NAME):
        return afm_formats.NAME, afm_formats.read(file, given)


def _rechecked(curve: ForceCurve, file: Path) -> ForceCurve:
    """The worker is not believed; what became text on the way is put right."""
    meta: dict[str, Any] = dict(curve.meta)
    if "path" in meta:
        meta["path"] = file
    with guarded(file, "worker"):
        check_curve(curve, file)
    return ForceCurve(curve.segments, meta, printable(file.name))
