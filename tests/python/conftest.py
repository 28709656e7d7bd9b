# SPDX-License-Identifier: BSD-3-Clause
"""What every test starts from."""

import functools
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pictures
import pytest
from nanotouch._io import drawing
from nanotouch_app import view


def pytest_configure() -> None:
    """Let Ctrl-C through: a shell that runs the tests in the background ignores SIGINT, and so would all they start."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session", autouse=True)
def every_series_is_seen() -> Iterator[None]:
    """No figure is saved, by whatever the tests run in this process, that hides a series outside of its axes."""
    shown = drawing._shown

    @functools.cache
    def watched(figure: Any) -> Any:
        def savefig(self: Any, *args: Any, **kwargs: Any) -> None:
            figure.savefig(self, *args, **kwargs)
            found = pictures.hidden(self, drawn=True)
            assert not found, found

        return type("Figure", (shown(figure),), {"savefig": savefig, "__module__": drawing.__name__})

    drawing._shown = watched
    yield
    drawing._shown = shown


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """For tests of other things: a picture takes its time. Figures are made, scenes of VTK
    are not; the files of both are empty."""

    def savefig(self: Any, file: Any, **kwargs: Any) -> None:
        if not hasattr(file, "write"):
            Path(file).touch()

    figure = pytest.importorskip("matplotlib.figure").Figure
    monkeypatch.setattr(drawing._shown(figure), "savefig", savefig)
    monkeypatch.setattr(view, "render_png", lambda _topography, _recording, path, **_: Path(path).touch())
