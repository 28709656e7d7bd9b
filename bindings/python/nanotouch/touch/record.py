# SPDX-License-Identifier: BSD-3-Clause
"""Recordings of a touch: named columns in SI units, written block by block to an MCAP file and read back.

The file describes itself: its schema record (encoding ``nanotouch.columns``) is JSON that names every column with its
type, unit and meaning, and says how a message holds them. A recording that was cut short holds every whole block, and
its metadata say why (:mod:`nanotouch.touch._recorder`)."""

from __future__ import annotations

import json
import math
import os
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch import guard
from nanotouch._io import html, worker
from nanotouch._io.files import checked_path, refuse_pipe
from nanotouch._io.writing import BLOCK_ROWS
from nanotouch._io.writing import replacing as replacing
from nanotouch._io.writing import write_csv as write_csv
from nanotouch.errors import Error, InvalidValue, ReadError, require
from nanotouch.plasticity import Dent, dents_of
from nanotouch.touch import _recording_file, _stopped
from nanotouch.touch._control import ControlLaw
from nanotouch.touch._recorder import INCOMPLETE, recovered_name
from nanotouch.touch._recorder import Metadata as Metadata
from nanotouch.touch._recorder import Writer as Writer
from nanotouch.touch.columns import COLUMNS as COLUMNS
from nanotouch.touch.columns import STATES as STATES
from nanotouch.touch.columns import Column as Column
from nanotouch.touch.columns import checked

if TYPE_CHECKING:  # a recording is read without a reader of curves
    from nanotouch._fields import Columns
    from nanotouch.curves import ForceCurve
else:
    Columns = object

MCAP_MAGIC = b"\x89MCAP0\r\n"
HDF5_STORAGE = {"chunks": True, "compression": "gzip", "shuffle": True, "fletcher32": True}


class Recording(Columns):
    """Named columns of equal length, and what they were recorded with.

    Parameters
    ----------
    columns : mapping of str to array, shape (n,)
        Any of ``COLUMNS`` (``time`` always), in SI units; kept in the order and type of that table.
    metadata : mapping, optional
        JSON-able: ``alpha_p`` [m/m], ``alpha_f`` [N/N], ``spring_constant`` [N/m], ``start_height`` z_0 [m],
        ``master_start``, x_m where x_s = 0 [m], scene, rig, seed.

    Columns are attributes (``recording.time``). Indexing with a slice, mask or index array gives a Recording.
    """

    columns: dict[str, NDArray[Any]]
    metadata: dict[str, Any]

    def __init__(self, columns: Mapping[str, ArrayLike], metadata: Mapping[str, Any] | None = None) -> None:
        self.columns = checked(columns)
        self.metadata = dict(metadata or {})

    if not TYPE_CHECKING:  # type checkers know the columns from _fields.pyi, and refuse others

        def __getattr__(self, name: str) -> NDArray[Any]:
            columns = self.__dict__.get("columns", {})
            if name in columns:
                return columns[name]
            recorded = ", ".join(columns)
            raise AttributeError(f"the recording has no column {name!r}; recorded: {recorded}")

    def __len__(self) -> int:
        return len(self.columns["time"])

    def __getitem__(self, rows: slice | NDArray[Any]) -> Recording:
        if not isinstance(rows, slice) and np.ndim(rows) != 1:
            raise TypeError("a recording is indexed with a slice, a mask or an array of row numbers")
        return Recording({name: values[rows] for name, values in self.columns.items()}, self.metadata)

    def __contains__(self, name: object) -> bool:
        return name in self.columns

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.columns]

    def __repr__(self) -> str:
        span = f"{self.time[0]:.6g} s to {self.time[-1]:.6g} s" if len(self) else "empty"
        ended = _stopped.of_columns(self.columns)
        stopped = f"{ended}, " if ended not in ("", "RUN") else ""
        return f"Recording({len(self)} rows, {span}, {stopped}columns: {', '.join(self.columns)})"

    def _repr_html_(self) -> str:
        rows = [(name, COLUMNS[name].unit, *_ends(values), COLUMNS[name].doc) for name, values in self.columns.items()]
        title = f"Recording of {len(self)} rows" + (f", incomplete: {self.incomplete}" if self.incomplete else "")
        return html.table(title, ("column", "unit", "least", "largest", "meaning"), rows)

    def to_pandas(self) -> Any:
        """A ``pandas.DataFrame``: a column for each column, in SI units, with ``time`` [s] as its index. Units are in
        ``frame.attrs["units"]``."""
        frame = require("pandas", "notebook").DataFrame(self.columns).set_index("time")
        frame.attrs["units"] = {name: COLUMNS[name].unit for name in self.columns}
        return frame

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` over the dimension ``time`` [s]; each variable has ``units`` and ``long_name``, the
        dataset the metadata as JSON."""
        xarray = require("xarray", "notebook")
        named = {
            name: ("time", values, {"units": COLUMNS[name].unit, "long_name": COLUMNS[name].doc})
            for name, values in self.columns.items()
        }
        about = {key: json.dumps(value) for key, value in self.metadata.items()}
        return xarray.Dataset(named, attrs=about).set_coords("time")

    def plot(self, save: str | os.PathLike[str] | None = None) -> Any:
        """Positions and forces over time (:func:`nanotouch.plots.time`), a ``Figure`` that a notebook shows."""
        from nanotouch import plots  # a method for convenience, of a later layer

        return plots.time(self, save)

    def parameter(self, name: str) -> float:
        """A number of the metadata that the recording cannot be read without, such as ``alpha_f``."""
        if self.metadata.get(name) is None:  # null: what is not known, such as the start height of a real stage
            present = ", ".join(self.metadata) or "nothing"
            raise InvalidValue(f"the recording's metadata lacks {name!r}; it has: {present}")
        return float(self.metadata[name])

    @property
    def incomplete(self) -> str | None:
        """Why the recording ended before it was to; None where it is whole."""
        return self.metadata.get(INCOMPLETE)

    @property
    def scaled_slave_force(self) -> NDArray[np.float64]:
        """alpha_f f_s [N], shape (n,): the slave's force at the operator's scale."""
        return self.parameter("alpha_f") * self.slave_force

    @property
    def scaled_stage_position(self) -> NDArray[np.float64]:
        """x_s / alpha_p [m], shape (n,), from where the master started: the stage's travel at the operator's scale."""
        return self.stage_position / self.parameter("alpha_p") + self.parameter("master_start")

    @property
    def tip_height(self) -> NDArray[np.float64]:
        """z_t = z_0 - x_s + zeta cos(tilt) [m], shape (n,), from measured quantities only."""
        tilt = float(self.metadata.get("rig", {}).get("probe", {}).get("tilt", 0.0))
        base: NDArray[np.float64] = self.parameter("start_height") - self.stage_position
        return base + math.cos(tilt) * self.deflection

    def replay(self, control: ControlLaw | None = None) -> Recording:
        """Feed what was measured to the touch step again: the same commands to the last bit, on the same machine.

        Of a session that went back, what was not taken back: :meth:`without_rewinds`.

        Parameters
        ----------
        control : callable, optional
            The law, where the recording was made with one's own.
        """
        from nanotouch.touch.replay import replay  # the next layer, which needs this one: a method for convenience

        return replay(self, control)

    @property
    def dents(self) -> tuple[Dent, ...]:
        """What the tip has left in a sample that keeps dents, the oldest first."""
        return dents_of(self.without_rewinds().metadata.get("events", []))

    def without_rewinds(self) -> Recording:
        """The rows and events that a session went on from. Itself where the session never went back."""
        from nanotouch.touch.replay import without_rewinds  # as above

        return without_rewinds(self)

    def curve(self) -> ForceCurve:
        """The force-distance curve of a recording in mode ``"curve"``, for :mod:`nanotouch.curves`."""
        from nanotouch.touch.replay import curve  # as above

        return curve(self)

    def to_csv(self, path: str | os.PathLike[str], progress: Callable[[float], None] | None = None) -> None:
        """Write a text table: ``# key: value`` lines with the metadata, then ``name [unit],...``, then the rows."""
        comments = {key: json.dumps(value) for key, value in self.metadata.items()}
        headers = {_heading(name): values for name, values in self.columns.items()}
        write_csv(path, headers, comments, progress)

    def to_hdf5(self, path: str | os.PathLike[str]) -> None:
        """Write HDF5: a dataset per column with attributes ``unit`` and ``doc``; metadata as JSON root attributes."""
        h5py = require("h5py", "record")
        with replacing(path) as whole, h5py.File(whole, "w") as file:
            file.attrs.update({key: json.dumps(value) for key, value in self.metadata.items()})
            for name, values in self.columns.items():
                dataset = file.create_dataset(name, data=values, **HDF5_STORAGE)
                dataset.attrs["unit"] = COLUMNS[name].unit
                dataset.attrs["doc"] = COLUMNS[name].doc


def write(path: str | os.PathLike[str], recording: Recording) -> None:
    """Write a whole recording at once."""
    with Writer(path, recording.metadata) as writer:
        for start in range(0, len(recording), BLOCK_ROWS):
            writer.append(recording[start : start + BLOCK_ROWS].columns)


def is_recording(path: str | os.PathLike[str]) -> bool:
    """Whether the file begins as an MCAP file does."""
    with checked_path(path).open("rb") as file:
        return file.read(len(MCAP_MAGIC)) == MCAP_MAGIC


def read(path: str | os.PathLike[str], *, untrusted: bool | None = None) -> Recording:
    """Read a recording. A damaged or truncated file gives every whole block, with a warning that says what is missing,
    and is marked as incomplete.

    Parameters
    ----------
    path : path
        The MCAP file.
    untrusted : bool, optional
        True: read it in a confined process (Linux only). By default the ``nanotouch`` command does so, Python does not.
    """
    file = Path(path)
    refuse_pipe(file)
    if guard.wanted(untrusted):
        parts = worker.ask("record.read", file, {}, dict)
        if not all(isinstance(parts.get(key), dict) for key in ("columns", "metadata")):
            raise ReadError(f"{path}: the worker's answer is not what was asked for", "worker")
    else:
        parts = _recording_file.parts_of(file)
    metadata, damage = dict(parts["metadata"]), str(parts.get("damage", ""))
    if damage:
        before = metadata.get(INCOMPLETE)
        metadata[INCOMPLETE] = damage if before is None else f"{before}; {damage}"
    try:
        recording = Recording(parts["columns"], metadata)
    except InvalidValue as error:
        raise ReadError(f"{path} is not a recording of nanotouch: {error}") from error
    if damage:
        warnings.warn(f"{path} is damaged ({damage}); {len(recording)} rows were read", stacklevel=2)
    return recording


def recover(path: str | os.PathLike[str], out: str | os.PathLike[str] | None = None) -> tuple[Path, Recording]:
    """Write what a killed process left as a recording that is marked as incomplete; `path` stays as it is.

    Parameters
    ----------
    path : path
        ``<name>.<process id>.part``, or a damaged recording.
    out : path, optional
        A new file; by default ``<name>``, or for another name ``<stem>.recovered.mcap`` beside it.

    Returns
    -------
    (Path, Recording)
        Where it is now, and what it holds; ``recording.incomplete`` says why it ended.
    """
    target = recovered_name(Path(path)) if out is None else Path(out)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of the damage: it is in the metadata
        recording = read(path)
    if recording.incomplete is None:
        raise InvalidValue(f"{path} is whole: there is nothing to recover")
    if target.exists():
        raise Error(f"cannot write {target}: it exists already; name another file")
    write(target, recording)
    return target, recording


def _ends(values: NDArray[Any]) -> tuple[str, str]:
    """The least and the largest number, "" where there is none."""
    numbers = values[np.isfinite(values)]
    return (f"{numbers.min():.4g}", f"{numbers.max():.4g}") if len(numbers) else ("", "")


def _heading(name: str) -> str:
    unit = COLUMNS[name].unit
    return f"{name} [{unit}]" if unit else name
