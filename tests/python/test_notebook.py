# SPDX-License-Identifier: BSD-3-Clause
"""What a notebook shows, and what a recording becomes in pandas and xarray."""

from __future__ import annotations

import json
import pickle
from html.parser import HTMLParser

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.touch.columns import COLUMNS


@pytest.fixture(scope="module")
def recording() -> nt.Recording:
    return nt.Session(seed=1).run(0.3)


class Parsed(HTMLParser):
    """Tags that are open, and the text."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.cells: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.cells.append(data)


def test_pandas_has_each_column_over_time(recording: nt.Recording) -> None:
    pytest.importorskip("pandas")
    frame = recording.to_pandas()
    assert frame.index.name == "time"
    assert list(frame.columns) == [name for name in recording.columns if name != "time"]
    for name in frame.columns:
        np.testing.assert_array_equal(frame[name].to_numpy(), recording.columns[name])
    assert frame.attrs["units"]["gap"] == "m"
    assert frame.loc[0.1:0.2].index[-1] <= 0.2


def test_xarray_has_units_and_metadata(recording: nt.Recording) -> None:
    pytest.importorskip("xarray")
    data = recording.to_xarray()
    assert data.sizes["time"] == len(recording)
    assert data.gap.attrs == {"units": "m", "long_name": COLUMNS["gap"].doc}
    assert data.gap.sel(time=0.1, method="nearest") == recording.gap[np.abs(recording.time - 0.1).argmin()]
    assert json.loads(data.attrs["scene"])["tip"]["radius"] == 20e-9


def test_without_pandas_the_extra_is_named(recording: nt.Recording, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "pandas", None)
    with pytest.raises(nt.errors.MissingExtra, match="extra notebook"):
        recording.to_pandas()


def test_a_plot_shows_itself_without_magic(recording: nt.Recording) -> None:
    pytest.importorskip("matplotlib")
    for figure in (recording.plot(), nt.plots.force_gap(recording)):
        assert figure._repr_png_().startswith(b"\x89PNG")
        again = pickle.loads(pickle.dumps(figure))
        assert len(again.axes) == len(figure.axes)


def test_each_thing_has_a_table_in_a_notebook(recording: nt.Recording) -> None:
    session = nt.Session(seed=1)
    session.advance(0.01)
    scene = nt.Scene(tip={"radius": 33e-9})
    for thing, words in (
        (scene, ("tip.radius *", "33 nm", "sample.youngs_modulus")), (session, ("RUN", "0.01 s", "10000 Hz")),
        (scene.plan(), ("Plan",)), (recording, ("gap", f"Recording of {len(recording)} rows")),
        (session.settings, ("gains.alpha_f *", "gains.rate")),
    ):  # fmt: skip
        parsed = Parsed(thing._repr_html_())
        assert not parsed.open
        for word in words:
            assert word in parsed.cells, (type(thing), word)


def test_text_of_users_is_escaped() -> None:
    recording = nt.Recording({"time": [0.0]}, {"incomplete": "<script>"})
    assert "<script>" not in recording._repr_html_()
    assert "&lt;script&gt;" in recording._repr_html_()


def test_a_session_says_what_it_is() -> None:
    session = nt.Session(seed=1)
    session.advance(0.02)
    told = repr(session)
    assert told.startswith("Session(mode 'point', RUN, 10000 Hz, 0.02 s run, ")
    assert "stability margin" in told
