# SPDX-License-Identifier: BSD-3-Clause
"""Pictures: they show the extremes, name quantities and units, and mark snap-in and pull-off where they are."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nanotouch import plots
from nanotouch.errors import Error, InvalidValue, MissingExtra
from nanotouch.plots import panels
from nanotouch.touch.record import Recording
from numpy.typing import NDArray

pytest.importorskip("matplotlib")
METADATA = {"alpha_p": 4e-5, "alpha_f": 2e6, "master_start": 0.0, "spring_constant": 8.0, "start_height": 300e-9}
SNAP_IN, PULL_OFF, NOISE = 6e-9, 18e-9, 2e-9


def touch(rows: int = 40_000, noise: float = NOISE, truth: bool = True) -> Recording:
    """A stiff flat: the force jumps to -SNAP_IN at the surface, grows to 1 uN, and lets go at -PULL_OFF."""
    k = METADATA["spring_constant"]
    travel = 428e-9 * np.sin(np.pi * np.linspace(0, 1, rows)) ** 2
    pressed = k * (travel - 300e-9) - SNAP_IN
    contact = travel > 300e-9
    turn = rows // 2
    contact[turn:] = pressed[turn:] > -PULL_OFF
    force = np.where(contact, pressed, 0.0)
    made = {"time": np.arange(rows) * 1e-4, "stage_position": travel}
    made |= {"x": np.full(rows, 2e-6), "y": np.full(rows, 3e-6)}
    measured = force + noise * np.random.default_rng(1).standard_normal(rows)
    made |= {"slave_force": measured, "deflection": measured / k, "master_position": travel / METADATA["alpha_p"]}
    made |= {"operator_force": 2e6 * force, "state": np.where(np.arange(rows) > 0.9 * rows, 1, 0)}
    if truth:
        made |= {"tip_force": force, "gap": 300e-9 - travel + force / k}
    return Recording(made, METADATA)


@dataclass
class Steps:
    """A surface that is 100 nm higher where x > 3 um, and 20 nm higher in the upper half."""

    name: str = "steps"
    pixel_size: tuple[float, float] = (0.1e-6, 0.1e-6)

    @property
    def heights(self) -> NDArray[np.float64]:
        j, i = np.mgrid[:40, :60]
        return 100e-9 * (i > 30) + 20e-9 * (j >= 20)


def scan(rows: int = 30_000) -> Recording:
    """Along y = 1 um from x = 1 um to 5 um, at 80 nN, with approach and retraction."""
    part = np.clip((np.arange(rows) / rows - 0.2) / 0.6, 0, 1)
    x = 1e-6 + 4e-6 * part
    lifted = np.clip(np.abs(np.linspace(-5, 5, rows)) - 4, 0, 1) * 200e-9
    height = 100e-9 * (x > 3.05e-6)
    bent = np.where(lifted > 0, 0, 10e-9)
    travel = 300e-9 - height - lifted + bent
    made = {"time": np.arange(rows) * 1e-4, "x": x, "y": np.full(rows, 1e-6)}
    made |= {"stage_position": travel, "deflection": bent}
    made |= {"slave_force": 8 * bent, "master_position": travel / METADATA["alpha_p"], "operator_force": 1.6e7 * bent}
    return Recording(made | {"surface_height": height}, METADATA)


def drawn(path: Path) -> float:
    """Share of the picture's pixels that are not white."""
    image = pytest.importorskip("matplotlib.image").imread(path)
    return float(np.mean(image[..., :3].min(axis=-1) < 0.9))


@pytest.mark.parametrize(
    ("unit", "values", "label", "factor"),
    [
        ("m", [2e-7, -1e-9], "nm", 1e9),
        ("m", [1e-6], "µm", 1e6),
        ("N", [-1.8e-8, 1e-6], "µN", 1e6),
        ("N", [999e-9], "nN", 1e9),
        ("N", [5.0], "N", 1.0),
        ("N", [0.0], "N", 1.0),
        ("N", [math.nan, math.inf], "N", 1.0),
        ("N", [math.nan, 2e-9], "nN", 1e9),
        ("J", [1.6e-16], "aJ", 1e18),
        ("J", [2e-14, 3e-17], "fJ", 1e15),
        ("m", [1e-30], "pm", 1e12),
        ("Pa", [1.6e11], "GPa", 1e-9),
        ("m", [], "m", 1.0),
    ],
)
def test_engineering(unit: str, values: list[float], label: str, factor: float) -> None:
    assert plots.engineering(unit, values) == (label, pytest.approx(factor))


@given(st.integers(1, 200_000), st.integers(0, 2**32 - 1))
def test_envelope_keeps_extremes(rows: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    one, other = rng.standard_normal(rows), rng.standard_normal(rows)
    one[rng.integers(rows)] = math.nan
    kept = plots.envelope(one, other)
    assert (np.diff(kept) > 0).all()
    assert kept[0] == 0
    assert kept[-1] == rows - 1
    assert len(kept) <= max(plots.LONG, 4 * plots.STRETCHES + 2)
    assert other[kept].min() == other.min()
    assert other[kept].max() == other.max()
    if rows > 1:
        assert np.nanmin(one[kept]) == np.nanmin(one)
        assert np.nanmax(one[kept]) == np.nanmax(one)


def test_adhesion_in_the_simulators_truth() -> None:
    """The jumps are one row wide; between two rows the force moves by 8 N/m * 428 nm * pi/40000 = 0.27 nN."""
    seen = plots.adhesion(touch())
    assert seen.snap_in_force == pytest.approx(SNAP_IN, abs=0.3e-9)
    assert seen.pull_off_force == pytest.approx(PULL_OFF, abs=0.3e-9)


def test_letting_go_a_little_is_no_snap_in() -> None:
    recording = touch()
    force = recording.tip_force.copy()
    force[15_000:15_200] -= 100e-9  # while it presses with some hundred nN
    seen = plots.adhesion(Recording(recording.columns | {"tip_force": force}, recording.metadata))
    assert seen == plots.adhesion(recording)


@pytest.mark.parametrize("rows", [40_000, 200_000])
def test_adhesion_above_the_noise(rows: int) -> None:
    """The mean over 0.5 ms (4 rows) of 2 nN noise leaves 1 nN, continued to the edge 1.6 nN; twice that here."""
    recording = touch(rows, truth=False)
    truth = plots.adhesion(touch(rows))
    seen = plots.adhesion(recording)
    assert seen.pull_off_force == pytest.approx(PULL_OFF, abs=3.2e-9)
    assert abs(seen.pull_off_row - truth.pull_off_row) < 50
    if rows == 200_000:  # five times slower: the dip lasts long enough to stand out of the noise
        assert seen.snap_in_force == pytest.approx(SNAP_IN, abs=3.2e-9)


def test_noise_alone_has_no_adhesion() -> None:
    rng = np.random.default_rng(5)
    made = {"time": np.arange(200_000) * 1e-4, "slave_force": 2e-9 * rng.standard_normal(200_000)}
    made["stage_position"] = np.sin(np.linspace(0, np.pi, 200_000))
    seen = plots.adhesion(Recording(made))
    assert (seen.snap_in_row, seen.pull_off_row) == (-1, -1)
    assert math.isnan(seen.pull_off_force)


def test_phases() -> None:
    assert plots.phases(touch()) == (pytest.approx(20_000, abs=1),) * 2
    assert plots.phases(scan()) == (pytest.approx(6_000, abs=30), pytest.approx(24_000, abs=30))


def test_time_shows_units_states_and_both_sides(tmp_path: Path) -> None:
    figure = plots.time(touch(), save=tmp_path / "time.png")
    upper, lower = figure.axes
    assert upper.get_ylabel() == "position (mm)"
    assert lower.get_ylabel() == "force (N)"
    assert lower.get_xlabel() == "time (s)"
    legend = [text.get_text() for text in lower.get_legend().get_texts()]
    assert legend == ["master $f_m$", r"scaled slave $\alpha_f f_s$", "HOLD"]
    assert 0.02 < drawn(tmp_path / "time.png") < 0.9


def test_force_gap_marks_what_adhesion_found(tmp_path: Path) -> None:
    figure = plots.force_gap(touch(), save=tmp_path / "force_gap.png")
    whole, magnified = figure.axes
    assert whole.get_xlabel() == "gap $h$ (nm)"
    assert whole.get_ylabel() == "slave force $f_s$, + repulsive (µN)"
    assert magnified.get_ylabel() == "slave force $f_s$, + repulsive (nN)"
    assert magnified.get_ylim()[1] < 50
    texts = [text.get_text() for text in magnified.texts]
    assert texts[0].startswith("snap-in −5.8")
    assert texts[1].startswith("pull-off −18")
    assert 0.02 < drawn(tmp_path / "force_gap.png") < 0.9


def test_force_gap_of_a_real_rig_uses_measured_height() -> None:
    figure = plots.force_gap(touch(truth=False))
    assert figure.axes[0].get_xlabel() == "tip height $z_t$ (nm)"


def test_line_lies_on_the_profile(tmp_path: Path) -> None:
    figure = plots.line(scan(), Steps(), save=tmp_path / "line.png")
    upper, lower = figure.axes
    assert upper.get_ylabel() == "height (nm)"
    assert lower.get_xlabel() == "distance along the line (µm)"
    curves = {curve.get_label(): curve.get_xydata() for curve in upper.lines}
    low, high = upper.get_ylim()
    for label in ("tip, measured", "hand, scaled", "surface as the tip can follow it"):
        distance, height = curves[label].T
        np.testing.assert_allclose(height[(distance > 0.1) & (distance < 1.9)], 0, atol=1)
        np.testing.assert_allclose(height[(distance > 2.2) & (distance < 3.9)], 100, atol=1)
        assert low < height.min() < height.max() < high
    ground = upper.collections[0].get_paths()[0].vertices
    assert ground[:, 1].max() == pytest.approx(100)  # the line runs in the lower half: no 20 nm
    assert 0.02 < drawn(tmp_path / "line.png") < 0.9


def test_a_line_needs_sideways_motion() -> None:
    with pytest.raises(InvalidValue, match="does not move sideways"):
        plots.line(touch())


def test_force_curves() -> None:
    gap = np.linspace(-2e-9, 10e-9, 100)
    figure = plots.force_curves({"Hertz": (gap, 1e-8 * np.maximum(-gap, 0)), "DMT": (gap, -1e-8 * gap)})
    (panel,) = figure.axes
    assert panel.get_xlabel() == "gap $h$ (nm)"
    assert [text.get_text() for text in panel.get_legend().get_texts()] == ["Hertz", "DMT"]
    with pytest.raises(InvalidValue, match="at least one"):
        plots.force_curves({})


def test_of_a_minute_at_10_kHz_few_points_are_drawn() -> None:
    """What is drawn of 600 000 rows is bounded, whatever the record's length."""
    recording = touch(600_000)
    for draw in (plots.time, plots.force_gap):
        drawn = sum(len(line.get_xdata()) for panel in draw(recording).axes for line in panel.lines)
        assert 1000 < drawn < 200_000


def test_nothing_half_written(tmp_path: Path) -> None:
    with pytest.raises(Error, match=r"cannot write .*time\.png"):
        plots.time(touch(1000), save=tmp_path / "missing" / "time.png")
    with pytest.raises(ValueError, match="xyz"):
        plots.time(touch(1000), save=tmp_path / "time.xyz")
    assert list(tmp_path.iterdir()) == []


def test_without_matplotlib(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(MissingExtra, match="pip install tqdm matplotlib"):
        plots.time(touch(1000))


def test_force_gap_is_no_zigzag_and_lies_on_the_planned_law() -> None:
    """Medians over the stage's steps scatter less than readings, and the law of the recorded scene is drawn."""
    recording = nt.Session(seed=1).run()
    whole = plots.force_gap(recording).axes[0]
    drawn_lines = {line.get_label(): line.get_xydata() for line in whole.lines}
    assert {"planned law", "approach", "retraction"} <= set(drawn_lines)
    gap, force = drawn_lines["approach"].T
    readings = next(line for line in whole.lines if line.get_marker() == "." and line.get_color() == plots.BLUE)
    x, y = np.asarray(readings.get_xydata()).T
    assert len(gap) <= 300
    assert np.std(force[gap > 20.0]) < 0.5 * np.std(y[x > 20.0])  # far away: noise alone
    law = drawn_lines["planned law"]
    seen = np.isfinite(law[:, 1])
    assert np.interp(50.0, law[seen, 0], law[seen, 1]) == pytest.approx(0.0, abs=1.0)


def test_the_band_of_a_line_is_explained() -> None:
    """One step of a master of 40 um resolution at 1:25 000, on a lever of 8 N/m: 12.8 nN."""
    recording = nt.Session(mode="scan", path=[(0.0, 0.0), (1e-6, 0.0)], seed=1).run(1.0)
    rig, scale = nt.Rig(), recording.parameter("alpha_p")
    texts = [text.get_text() for axes in plots.line(recording).axes for text in axes.texts]
    step = 1e9 * rig.master.resolution * scale * rig.probe.spring_constant
    told = f"line: mean; band: least to largest; one step: the master's position {step:.3g} nN"
    assert any(told in one for one in texts)


def test_the_legend_of_a_magnified_force_gap_hides_no_title() -> None:
    figure = plots.force_gap(touch())
    assert len(figure.axes) == 2
    assert all(panel.get_legend() is None for panel in figure.axes)
    figure.draw_without_rendering()
    [legend] = figure.legends
    assert {text.get_text() for text in legend.get_texts()} >= {"approach", "retraction"}
    assert not any(legend.get_window_extent().overlaps(panel.get_tightbbox()) for panel in figure.axes)


def test_the_mean_of_a_signal_skips_what_was_not_measured() -> None:
    """One NaN hid all that followed it."""
    values = np.arange(3000.0)
    values[10] = np.nan
    mean = panels._running_mean(values, 7)
    assert np.isfinite(mean).all()
    np.testing.assert_allclose(mean[100:2900], np.arange(100.0, 2900.0), rtol=1e-12)
    assert np.isnan(panels._running_mean(np.full(50, np.nan), 7)).all()
