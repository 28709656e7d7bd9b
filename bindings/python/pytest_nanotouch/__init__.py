# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures for pytest, which finds them by itself where nanotouch is installed: ``nt_session`` and ``nt_golden``.

pytest imports this module in every run of every project, so it imports nanotouch only when a fixture is used.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from nanotouch.touch.record import Recording
    from nanotouch.touch.session import Session

OPTION = "--nt-update-golden"
FOLDER = "golden"


def pytest_addoption(parser: pytest.Parser) -> None:
    """The option that writes what is compared with."""
    group = parser.getgroup("nanotouch")
    group.addoption(OPTION, action="store_true", help="write the recordings of nt_golden anew, instead of comparing")


@pytest.fixture
def nt_session() -> Iterator[Callable[..., Session]]:
    """``nt_session(scene, rig, **options)`` opens a :class:`nanotouch.Session` on a simulated rig, in virtual time and
    with seed 1, so that each run of the test gives the same to the last bit. A half of one's own, faults and all else
    are options as of the class. Threads that it started are stopped when the test ends."""
    from nanotouch.touch.session import Session

    opened: list[Session] = []

    def open_session(*args: Any, **options: Any) -> Session:
        opened.append(Session(*args, **options))
        return opened[-1]

    yield open_session
    for session in opened:
        if session.progress.runs:
            session.halt()


@pytest.fixture
def nt_golden(request: pytest.FixtureRequest) -> Callable[..., None]:
    """``nt_golden(recording, name="", tolerances=None)`` compares with ``golden/TEST.mcap`` beside the file of the test
    (:func:`nanotouch.testing.assert_same`). ``pytest --nt-update-golden`` writes that file. A slice such as
    ``recording[::100]`` keeps it small."""
    folder = Path(request.path).parent / FOLDER
    stem = re.sub(r"[^\w.-]+", "_", request.node.name).strip("_")
    renew = bool(request.config.getoption(OPTION))

    def compare(recording: Recording, name: str = "", tolerances: Mapping[str, float] | None = None) -> None:
        from nanotouch.testing.comparison import assert_same
        from nanotouch.touch import record

        path = folder / (f"{stem}-{name}.mcap" if name else f"{stem}.mcap")
        if renew:
            folder.mkdir(exist_ok=True)
            record.write(path, recording)
        elif not path.exists():
            pytest.fail(f"there is no {path} to compare with: pytest {OPTION} writes it", pytrace=False)
        else:
            assert_same(recording, record.read(path), tolerances)

    return compare
