# SPDX-License-Identifier: BSD-3-Clause
"""Fit a map: blocks of curves in C threads of this process, or on any Dask cluster; finished blocks are kept."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from itertools import islice
from typing import Any

import nanotouch

from ..batch.sidecar import Decision, Sidecar
from ..curves import CalibrationTable
from ..errors import Error, InvalidValue, require
from ..fit import TipLike
from .block import fit_block, lost_block, part_of
from .dataset import assemble, put
from .decided import Decisions, decide, decisions_of
from .settings import Settings
from .store import BlockStore, Columns
from .volume import Volume, blocks_of, volume_of

BLOCK_CURVES = 64
IN_FLIGHT = 2  # blocks for each thread of a cluster: one at work, one at hand
LOCAL = "local"

Progress = Callable[[float], None]


def fit(
    source: Any,
    model: str = "maugis",
    *,
    tip: TipLike | None = None,
    radius: float | None = None,
    z: Any = None,
    deflection: bool = False,
    spring_constant: float | None = None,
    sensitivity: float | None = None,
    calibration: CalibrationTable | str | os.PathLike[str] | None = None,
    untrusted: bool | None = None,
    cluster: Any = None,
    resume: str | os.PathLike[str] | None = None,
    threads: int = 0,
    block: int = BLOCK_CURVES,
    progress: bool | Progress = False,
    sidecar: str | os.PathLike[str] | None = None,
    **settings: Any,
) -> Any:
    """Fit every curve of a force volume or QI map.

    Parameters
    ----------
    source : path, array of shape (ny, nx, n), or list of ForceCurve
        A file that :func:`nanotouch.curves.read` reads; or forces [N] (with ``deflection=True`` deflections [m]) that
        can be sliced by rows: numpy, ``numpy.memmap``, h5py, zarr, Dask. Row 0 is y = 0.
    model, tip, radius, **settings
        As for :func:`nanotouch.fit.fit_curve`: ``poisson_ratio``, ``branch``, ``window``, ``half_angle``,
        ``cohesive_range``, ``uncertainties``, ``fixed``, ``bounds``, ``fit_offset``, ``loss``, ``loss_scale``;
        ``baseline``. Without `tip` and `radius` the file's radius, or 20 nm, and ``assumptions`` says so.
    z : array of shape (n,) or (ny, nx, n)
        Height of the base, away from the sample [m]; with an array only.
    spring_constant : float
        k_c [N/m]: of an array, or in place of that of the file.
    sensitivity, calibration, untrusted
        As for :func:`nanotouch.curves.read`.
    cluster : optional
        None: this process. Else Dask's ``distributed``: ``"local"`` (worker processes here), the address of a
        scheduler (``"tcp://host:8786"``), a ``Client`` or a cluster object.
    resume : folder, optional
        Finished blocks are kept there; the same call after a killed run goes on from them. A folder with results of
        other settings, input or version is refused.
    threads : int
        In this process; 0: one per processor. The result does not depend on it, nor on `cluster`.
    block : int
        Curves that are read, fitted and kept together.
    progress : bool or callable
        True: a bar (tqdm); a callable gets the fraction that is done.
    sidecar : path, optional
        Exclusions, contact points and baselines by hand, of a map from a file: :mod:`nanotouch.batch.sidecar`.

    Returns
    -------
    xarray.Dataset
        See docs/maps.md. Curves without a result are NaN, with ``status`` and ``reason``.
    """
    require("xarray", "maps")
    chosen = Settings.of(model, tip, radius, settings)
    if block < 1 or threads < 0:
        raise InvalidValue(f"block {block}, threads {threads}: expected at least 1 and 0")
    if isinstance(calibration, str | os.PathLike):
        calibration = CalibrationTable.from_csv(calibration)
    reading = {"spring_constant": spring_constant, "sensitivity": sensitivity, "calibration": calibration}
    volume = volume_of(source, z, deflection, reading | {"untrusted": untrusted})
    chosen = chosen.beside(volume.tip_radii)
    made_of = {
        "settings": chosen.as_json(),
        "input": {"name": volume.name, "shape": list(volume.shape), "sha256": volume.digest()},
        "calibration": {
            key: value if isinstance(value, float | int | None) else str(value) for key, value in reading.items()
        },
        "version": nanotouch.__version__,
        "block": block,
    }
    decisions, unused = dict[int, Decision](), list[str]()
    if sidecar is not None:
        decisions, unused = decisions_of(volume, Sidecar.from_toml(sidecar))
        made_of["sidecar"] = {str(place): asdict(decision) for place, decision in decisions.items()}
    store = BlockStore(resume, made_of) if resume is not None else None
    curves, done = volume.shape[0] * volume.shape[1], 0
    table: Columns = {}
    with _reporting(progress) as report, _workers(cluster) as client:
        for number, columns in _finished(volume, chosen, store, (client, block, threads), decisions):
            done += put(columns, number * block, curves, table)
            report(done / curves)
    data = assemble(volume, chosen, table, made_of)
    data.attrs |= {"sidecar": json.dumps(made_of.get("sidecar", {})), "sidecar_unused": json.dumps(unused)}
    return data


Where = tuple[Any, int, int]  # client or None, curves in a block, threads


def _finished(
    volume: Volume, settings: Settings, store: BlockStore | None, where: Where, decisions: Decisions
) -> Iterator[tuple[int, Columns]]:
    """Every block with its number: first those of earlier runs, then the others as they are made."""
    client, size, threads = where
    missing = []
    for number, start, stop in blocks_of(volume, size):
        columns = store.load(number) if store is not None else None
        if columns is None:
            missing.append((number, start, stop))
        else:
            yield number, columns
    stored = settings.as_json()
    made = (
        _made_here(volume, stored, missing, threads) if client is None else _made_there(volume, stored, missing, client)
    )
    for number, columns, complete in made:
        columns = decide(columns, stored, volume, number * size, decisions)
        if store is not None and complete:
            store.save(number, columns)
        yield number, columns


Made = Iterator[tuple[int, Columns, bool]]


def _made_here(volume: Volume, stored: dict[str, Any], missing: list[tuple[int, int, int]], threads: int) -> Made:
    for number, start, stop in missing:
        yield number, fit_block(stored, part_of(volume, stored, start, stop), threads), True


def _made_there(volume: Volume, stored: dict[str, Any], missing: list[tuple[int, int, int]], client: Any) -> Made:
    """A few blocks at a time, so that memory stays flat; Dask gives those of a lost worker to another.

    Dask gives up all blocks that were with a worker each time one died (its ``allowed-failures``), not only the guilty
    one; so these are tried again, each alone. What fails then is lost, and no other with it.
    """
    killed = require("distributed", "maps").KilledWorker
    suspects = []
    for block, future in _finished_there(volume, stored, missing, client):
        try:
            yield block[0], future.result(), True
        except killed:
            suspects.append(block)
    for suspect in suspects:
        for (number, start, stop), future in _finished_there(volume, stored, [suspect], client):
            try:
                yield number, future.result(), True
            except killed:
                reason = "its block ended the workers that it was given to"
                yield number, lost_block(stored, stop - start, reason), False


def _finished_there(
    volume: Volume, stored: dict[str, Any], missing: list[tuple[int, int, int]], client: Any
) -> Iterator[tuple[tuple[int, int, int], Any]]:
    """Blocks with their futures as they finish; as many are on their way as the workers need."""
    finished = require("distributed", "maps").as_completed([])
    waiting = iter(missing)
    running: dict[Any, tuple[int, int, int]] = {}

    def keep_busy() -> None:
        wanted = IN_FLIGHT * max(1, sum(client.nthreads().values()))  # workers come and go
        for block in islice(waiting, max(0, wanted - len(running))):
            future = client.submit(fit_block, stored, part_of(volume, stored, *block[1:]), 1, pure=False)
            running[future] = block
            finished.add(future)

    keep_busy()
    for future in finished:
        yield running.pop(future), future
        keep_busy()


@contextmanager
def _workers(cluster: Any) -> Iterator[Any]:
    """A client of the cluster; None for this process. What was made here is closed at the end."""
    if cluster is None:
        yield None
        return
    distributed = require("distributed", "maps")
    if isinstance(cluster, distributed.Client):
        yield cluster
    elif cluster == LOCAL:
        options = {"threads_per_worker": 1, "dashboard_address": None}
        with distributed.LocalCluster(**options) as local, distributed.Client(local) as client:
            yield client
    else:
        with _connected(distributed, cluster) as client:
            yield client


def _connected(distributed: Any, cluster: Any) -> Any:
    try:
        return distributed.Client(cluster)
    except (OSError, ValueError) as error:
        raise Error(f"no Dask scheduler at {cluster}: {error}") from error


@contextmanager
def _reporting(progress: bool | Progress) -> Iterator[Progress]:
    """What is called with the fraction done."""
    if callable(progress):
        yield progress
        return
    if not progress:
        yield lambda fraction: None
        return
    with require("tqdm.auto", "app").tqdm(
        total=1.0, desc="map", bar_format="{l_bar}{bar}| {elapsed}<{remaining}"
    ) as bar:
        yield lambda fraction: bar.update(fraction - bar.n) and None
