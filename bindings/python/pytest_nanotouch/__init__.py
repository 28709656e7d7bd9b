# SPDX-License-Identifier: BSD-3-Clause
"""Fixtures for pytest, which finds them by itself where nanotouch is installed: ``nt_session`` and ``nt_golden``.

pytest imports this module in every run of every project, so it imports nanotouch only when a fixture is used.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zlib import crc32

import pytest

if TYPE_CHECKING:
    from nanotouch.touch.record import Recording
    from nanotouch.touch.session import Session

OPTION = "--nt-update-golden"
FOLDER = "golden"
LONGEST_NAME = 120  # of a file system's 255, with room for what is written beside it
OWNERS = pytest.StashKey[dict[Path, str]]()  # of each file, the test that has used it in this run
WRITTEN = pytest.StashKey[set[Path]]()


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

    with ExitStack() as stack:  # stops every one, also where another raises what its device has raised

        def open_session(*args: Any, **options: Any) -> Session:
            session = Session(*args, **options)
            stack.callback(_halt, session)
            return session

        yield open_session


@pytest.fixture
def nt_golden(request: pytest.FixtureRequest) -> Callable[..., None]:
    """``nt_golden(recording, name="", tolerances=None)`` compares with ``golden/TEST.mcap`` beside the file of the test
    (:func:`nanotouch.testing.assert_same`). ``pytest --nt-update-golden`` writes that file. A slice such as
    ``recording[::100]`` keeps it small. A file belongs to one test; a second call in a test compares with it, too."""
    folder = Path(request.path).parent / FOLDER
    owners = request.config.stash.setdefault(OWNERS, {})
    written = request.config.stash.setdefault(WRITTEN, set())
    renew = bool(request.config.getoption(OPTION))

    def compare(recording: Recording, name: str = "", tolerances: Mapping[str, float] | None = None) -> None:
        from nanotouch.testing._given import rows_of
        from nanotouch.testing.comparison import assert_same
        from nanotouch.touch import record

        rows_of(recording)
        path = folder / f"{_stem(request.node.name, name)}.mcap"
        owner = owners.setdefault(path, request.node.nodeid)
        if owner != request.node.nodeid:
            pytest.fail(
                f"{path} is that of {owner}: give one of them a name, nt_golden(recording, name)", pytrace=False
            )
        if renew and path not in written:
            folder.mkdir(exist_ok=True)
            record.write(path, recording)
            written.add(path)
        elif not path.exists():
            pytest.fail(f"there is no {path} to compare with: pytest {OPTION} writes it", pytrace=False)
        expected = record.read(path)
        if expected.incomplete:
            pytest.fail(f"{path} is damaged ({expected.incomplete}): pytest {OPTION} writes it anew", pytrace=False)
        assert_same(recording, expected, tolerances)

    return compare


def _halt(session: Session) -> None:
    if session.progress.runs:
        session.halt()


def _stem(test: str, name: str) -> str:
    """The name of a file for a test, and for one of its recordings."""
    if not re.fullmatch(r"[\w.-]*", name):
        pytest.fail(f"name = {name!r}: valid are letters, digits, '_', '.' and '-'", pytrace=False)
    stem = re.sub(r"[^\w.-]+", "_", test).strip("_") + f"-{name}" * bool(name)
    if len(stem.encode()) <= LONGEST_NAME:
        return stem
    return f"{stem.encode()[: LONGEST_NAME - 9].decode(errors='ignore')}-{crc32(stem.encode()):08x}"
