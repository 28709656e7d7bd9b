# SPDX-License-Identifier: BSD-3-Clause
"""Maps on a ``distributed`` cluster on loopback: a worker that is killed costs time, nothing else."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nanotouch as nt
import pytest

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("xarray")
distributed = pytest.importorskip("distributed")

from nanotouch import maps  # noqa: E402
from test_maps import volume  # noqa: E402

pytestmark = [pytest.mark.filterwarnings("default")]  # distributed's own, when a worker is killed


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "silence_logs": 50}
    with distributed.LocalCluster(**options) as running:
        yield running


def test_a_killed_worker_changes_nothing(cluster: Any, tmp_path: Path) -> None:
    source = volume(16)
    alone = maps.fit(source, "jkr", radius=20e-9, block=4)
    killed: list[int] = []

    def kill(done: float) -> None:
        if done > 0.1 and not killed:
            killed.append(next(iter(cluster.workers.values())).pid)
            os.kill(killed[0], signal.SIGKILL)

    data = maps.fit(source, "jkr", radius=20e-9, block=4, cluster=cluster, progress=kill, resume=tmp_path)
    assert killed
    assert data.attrs["curves_without_result"] == 0
    assert data.equals(alone), "the same bits, wherever they were computed"
    assert len(list(tmp_path.glob("block-*.npz"))) == 64


def test_any_cluster_by_its_address(cluster: Any) -> None:
    source = volume(3)
    there = maps.fit(source, "hertz", radius=20e-9, block=2, cluster=cluster.scheduler_address)
    assert there.equals(maps.fit(source, "hertz", radius=20e-9))


def test_a_block_that_kills_its_workers_is_lost_alone(
    cluster: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """As a crash in a library would: the block ends every worker that gets it, the others come through."""
    source = volume(3)
    alone = maps.fit(source, "hertz", radius=20e-9)
    monkeypatch.setattr("nanotouch.maps.run.fit_block", deadly)
    cluster.scheduler.allowed_failures = 0
    data = maps.fit(source, "hertz", radius=20e-9, block=3, cluster=cluster, resume=tmp_path)
    assert (data.status.values[0] == 0).all()
    names = data.status.attrs["flag_meanings"].split()
    assert (data.status.values[1] == data.status.attrs["flag_values"][names.index("LOST")]).all()
    assert (data.status.values[2] == 0).all()
    assert "ended the workers" in data.reason.values[1, 0]
    monkeypatch.undo()
    again = maps.fit(source, "hertz", radius=20e-9, block=3, resume=tmp_path)  # a lost block is not kept as done
    assert again.equals(alone)


def deadly(stored: Any, block: Any, threads: int) -> Any:
    """Fits all but the block whose force is that of the second row."""
    from nanotouch.maps.block import fit_block

    if block.force[0] == volume(3).values[1, 0, 0]:
        os._exit(1)
    return fit_block(stored, block, threads)


def test_an_address_where_nobody_is() -> None:
    dask = pytest.importorskip("dask")
    with (
        dask.config.set({"distributed.comm.timeouts.connect": "300ms"}),
        pytest.raises(nt.Error, match=r"no Dask scheduler at tcp://127\.0\.0\.1:9"),
    ):
        maps.fit(volume(2), "hertz", radius=20e-9, cluster="tcp://127.0.0.1:9")
