# SPDX-License-Identifier: BSD-3-Clause
"""Many sessions at once, on all processors: :class:`Sessions`."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Unpack

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _arrays, _core
from nanotouch.errors import InvalidValue, require
from nanotouch.scene import Rig, Scene, Settings
from nanotouch.scene.surface import Surface
from nanotouch.touch._path import Mode
from nanotouch.touch._play import BLOCK_TICKS, joined
from nanotouch.touch.columns import COLUMNS
from nanotouch.touch.operator import Hold, Input, core_input, script_for, stretched
from nanotouch.touch.options import Options, checked_seed
from nanotouch.touch.session import Columns, Session

RIG = "rig."
Script = list[tuple[int, _core.Input]]


class _Member(Session):
    """Its records are taken block by block: a short ring serves."""

    _ring_capacity = 2 * BLOCK_TICKS


class Sessions:
    """Sessions that differ in some fields of scene or rig and in their seeds, run side by side: for learning, inference
    and studies of many samples.

    ``sessions[i]`` is a :class:`~nanotouch.Session`, and records what it would record alone, to the bit: the number of
    threads changes the time it takes and nothing else. Its noise is a stream of its own, begun by ``seed + i``.

    Parameters
    ----------
    scene, rig : Scene, Rig
        What the sessions have in common.
    vary : mapping of str to array_like
        Fields that differ, such as ``{"sample.youngs_modulus": moduli, "rig.probe.spring_constant": constants}``; one
        value for each session.
    count : int, optional
        How many; by default as many as there are values.
    seed : int
        Of the first session; the next ones count on from it.
    threads : int, optional
        By default one for each processor that this process may use.
    surface, mode, path, settings, **options
        As of a :class:`~nanotouch.Session`; simulated halves only.
    """

    def __init__(
        self,
        scene: Scene | None = None,
        rig: Rig | None = None,
        *,
        vary: Mapping[str, ArrayLike] | None = None,
        count: int | None = None,
        threads: int | None = None,
        surface: Surface | None = None,
        mode: Mode = "point",
        path: Sequence[tuple[float, float]] | None = None,
        settings: Settings | None = None,
        **options: Unpack[Options],
    ) -> None:
        for own in ("master", "slave"):
            if options.get(own) is not None:
                raise InvalidValue(f"{own}: sessions side by side are simulated; a device leads one session")
        if options.get("recorded", True) is not True:
            raise InvalidValue("recorded: sessions side by side are recorded")
        scene, rig = Scene() if scene is None else scene, Rig() if rig is None else rig
        self.vary = {name: _values(name, values, scene, rig) for name, values in (vary or {}).items()}
        """the fields that differ, and their values"""
        total = _count(self.vary, count)
        first = checked_seed(options.get("seed", 1))
        self.seeds = [checked_seed(first + i) for i in range(total)]
        """of each session"""
        self.threads = _threads(threads)

        def opened(i: int) -> Session:
            mine, its_rig = scene.copy(), rig.copy()
            given: Any = options | {"seed": self.seeds[i]}
            try:
                for name, values in self.vary.items():
                    which: Scene | Rig = its_rig if name.startswith(RIG) else mine
                    which[name.removeprefix(RIG)] = values[i]
                return _Member(mine, its_rig, surface=surface, mode=mode, path=path, settings=settings, **given)
            except InvalidValue as error:
                error.add_note(f"this is of session {i}: " + ", ".join(f"{n} = {v[i]}" for n, v in self.vary.items()))
                raise

        with ThreadPoolExecutor(self.threads) as pool:
            self._members: list[Session] = list(pool.map(opened, range(total)))
        rates = {one.rate for one in self._members}
        if len(rates) > 1:
            raise InvalidValue(f"the sessions run at {min(rates):g} .. {max(rates):g} Hz: give them one rate")
        self.rate = rates.pop()
        """of their force loops [Hz]"""

    def __len__(self) -> int:
        return len(self._members)

    def __getitem__(self, which: int) -> Session:
        return self._members[which]

    def __iter__(self) -> Iterator[Session]:
        return iter(self._members)

    def advance(self, duration: float, inputs: Input | Hold | Sequence[Input | Hold] | None = None) -> Columns:
        """Run all for a time [s], and return what was recorded as columns, arrays of (session, tick). ``inputs``: where
        hand and tip go meanwhile, one input for all or one for each."""
        ticks = round(duration * self.rate)
        if not 0 < ticks <= 10**9:
            raise InvalidValue(f"duration = {duration} s: valid is {1 / self.rate:g} .. {1e9 / self.rate:g} s")
        if inputs is None:
            return self._run(ticks, [])
        each = [inputs] * len(self) if isinstance(inputs, Input | Hold) else inputs
        if len(each) != len(self):
            raise InvalidValue(f"inputs: {len(each)} of them for {len(self)} sessions")
        return self._run(ticks, [[(0, core_input(one))] for one in each])

    def run(self, duration: float | None = None, *, operator: Sequence[Input | Hold] | None = None) -> Any:
        """Play an operator's script in all, and return the records as an :class:`xarray.Dataset` over ``session`` and
        ``time``, with the fields that differ beside ``session``.

        Parameters
        ----------
        duration : float, optional
            Stretch the script to this time [s].
        operator : sequence of Input or Hold, optional
            What hand and tip do in every session; by default what :meth:`nanotouch.Session.run` does by itself, in
            each. A session whose script is shorter stays where it has come to until all are done.
        """
        xarray = require("xarray", "notebook")
        scripts = [stretched(script_for(one) if operator is None else operator, duration) for one in self]
        lengths = [[round(step.duration * self.rate) for step in script] for script in scripts]
        total = max(map(sum, lengths))
        if total == 0:
            raise InvalidValue(f"the script takes no time at {self.rate:g} Hz")
        starts = [itertools.accumulate(length, initial=0) for length in lengths]
        timed = [
            [(start, core_input(step)) for start, step in zip(begun, script, strict=False)]
            for begun, script in zip(starts, scripts, strict=True)
        ]
        return self._dataset(xarray, self._run(total, timed))

    def _run(self, ticks: int, scripts: list[Script]) -> Columns:
        """So many ticks, with what each is sent to after so many of them."""
        cores, blocks = [one.core for one in self], []
        for done in range(0, ticks, BLOCK_TICKS):
            end = min(done + BLOCK_TICKS, ticks)
            now = [[(at - done, input) for at, input in script if done <= at < end] for script in scripts]
            _core.advance_sessions(cores, now, end - done, self.threads)
            blocks.append(_core.read_sessions(cores, end - done))
            for one in self:
                one._asked()  # or they would pile up
        return joined(blocks, axis=1)

    def _dataset(self, xarray: Any, columns: Columns) -> Any:
        times = columns.pop("time")
        time = times[0]
        if (late := np.flatnonzero((times != time).any(axis=1))).size:
            raise InvalidValue(f"sessions {late.tolist()} have been run on their own: there is no common time")
        data = {
            name: (
                ("session", "time"),
                values,
                {"units": COLUMNS[name].unit or "1", "long_name": COLUMNS[name].doc},
            )
            for name, values in columns.items()
        }
        coordinates: dict[str, Any] = {"time": ("time", time, {"units": "s"}), "session": np.arange(len(self))}
        coordinates["seed"] = ("session", self.seeds)
        for name, varied in self.vary.items():
            which: Scene | Rig = self[0].rig if name.startswith(RIG) else self[0].scene
            coordinates[name] = ("session", varied, {"units": which.fields[name.removeprefix(RIG)].unit or "1"})
        return xarray.Dataset(data, coordinates, attrs={"title": "sessions side by side", "version": _core.version})


def _values(name: str, values: ArrayLike, scene: Scene, rig: Rig) -> list[Any]:
    """What a field shall be in each session."""
    which: Scene | Rig = rig if name.startswith(RIG) else scene
    if name.removeprefix(RIG) not in which.fields:
        raise InvalidValue(
            f"vary: {name!r} is no field of a scene, nor, behind 'rig.', of a rig; they are named as in "
            "scene['tip.radius'], rig['probe.spring_constant']"
        )
    _arrays.refuse_dressed(values, f"vary[{name!r}]")
    found = np.asarray(values)
    if found.ndim != 1 or found.size == 0:
        raise InvalidValue(f"vary[{name!r}]: expected one value for each session, not {values!r}")
    return list(found.tolist())


def _count(vary: Mapping[str, Sequence[Any]], count: int | None) -> int:
    lengths = {name: len(values) for name, values in vary.items()} | ({} if count is None else {"count": count})
    if not lengths:
        raise InvalidValue("how many sessions? give vary, or count")
    if len(set(lengths.values())) > 1:
        raise InvalidValue("vary and count disagree: " + ", ".join(f"{name} {n}" for name, n in lengths.items()))
    found = next(iter(lengths.values()))
    if isinstance(found, bool) or not isinstance(found, int) or found < 1:
        raise InvalidValue(f"count = {found}: valid is a whole number from 1 on")
    return found


def _threads(threads: int | None) -> int:
    if threads is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if isinstance(threads, bool) or not isinstance(threads, int) or not 1 <= threads <= 1024:
        raise InvalidValue(f"threads = {threads}: valid is a whole number, 1 .. 1024")
    return threads
