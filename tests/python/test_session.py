# SPDX-License-Identifier: BSD-3-Clause
"""A whole touch: deterministic, block by block the same, refused where it cannot be, and what the plan says."""

from __future__ import annotations

import copy
import json
import math
import pickle
from concurrent.futures import ThreadPoolExecutor
from itertools import count, pairwise
from pathlib import Path
from threading import Event
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import Input, Recording, Rig, Scene, Session, Settings, Surface, record, surface
from nanotouch._core import Signals
from nanotouch.errors import Error, InvalidValue
from nanotouch.touch.columns import SIDEWAYS, TAPPING
from nanotouch.touch.session import Columns, settings_for_path

RUN, LATCHED = record.STATES.index("RUN"), record.STATES.index("LATCHED")
GRATING = Surface(surface.grating(pixels=128), 20e-9)
PUSH = Input(0.3, 0.0, 0.0, 0.2)


def same(one: Columns, other: Columns) -> bool:
    return list(one) == list(other) and all(np.array_equal(one[name], other[name]) for name in one)


def joined(blocks: list[Columns]) -> Columns:
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


@pytest.fixture(scope="module")
def pressed() -> tuple[Session, Recording]:
    """Approach a flat, press, come back."""
    session = Session(seed=0)
    return session, session.run()


# ---- what is recorded ----


def test_same_seed_same_record() -> None:
    one, same_seed, other_seed = (Session(seed=seed).advance(0.3, PUSH) for seed in (7, 7, 8))
    assert same(one, same_seed)
    assert not np.array_equal(one["slave_force"], other_seed["slave_force"])


@pytest.mark.parametrize("blocks", [[0.1, 0.2, 0.3], [0.6001 - 0.5 * 1e-4], [1e-4] * 7 + [0.5993], [0.0, 0.6]])
def test_blocks_equal_one_run_bitwise(blocks: list[float]) -> None:
    whole = Session().advance(0.6, PUSH)
    session = Session()
    parts = [session.advance(block, PUSH if n == 0 else None) for n, block in enumerate(blocks)]
    assert same(joined(parts), whole)


def test_run_equals_advance_bitwise() -> None:
    script = [PUSH, Input(-0.2, 0.0, 0.0, 0.15)]
    session = Session()
    parts = [session.advance(step.duration, step) for step in script]
    recording = Session().run(operator=script)
    assert same(joined(parts), {name: recording.columns[name] for name in parts[0]})


def test_columns_are_those_of_a_recording() -> None:
    block = Session().advance(0.01)
    assert set(block) == set(record.COLUMNS) - set(SIDEWAYS + TAPPING)
    assert {len(values) for values in block.values()} == {100}
    np.testing.assert_allclose(block["time"], np.arange(100) * 1e-4, rtol=1e-15)
    empty = Session().advance(0.0)
    assert set(empty) == set(record.COLUMNS) - set(SIDEWAYS + TAPPING)
    assert all(values.size == 0 for values in empty.values())


def test_recording_copies(pressed: tuple[Session, Recording]) -> None:
    recording = pressed[1][:50]
    for other in (copy.copy(recording), copy.deepcopy(recording), pickle.loads(pickle.dumps(recording))):
        assert same(other.columns, recording.columns)
        assert other.metadata == recording.metadata


def test_writer_receives_all_of_it(tmp_path: Path) -> None:
    session = Session()
    with record.Writer(tmp_path / "touch.mcap", session.metadata()) as writer:
        recording = session.run(1.2, writer=writer)
    again = record.read(tmp_path / "touch.mcap")
    assert same(again.columns, recording.columns)
    assert again.metadata == recording.metadata


def test_metadata_is_json_and_complete(pressed: tuple[Session, Recording]) -> None:
    session, recording = pressed
    metadata = json.loads(json.dumps(recording.metadata))
    assert metadata == recording.metadata
    gains = session.settings.gains
    assert (metadata["alpha_p"], metadata["alpha_f"]) == (gains.alpha_p, gains.alpha_f)
    assert metadata["spring_constant"] == 8.0
    assert metadata["scene"]["tip"]["radius"] == 20e-9
    assert Scene(**metadata["scene"]) == session.scene
    assert Rig(**metadata["rig"]) == session.rig
    assert Settings(**metadata["settings"]) == session.settings
    assert metadata["version"] == nt.__version__


def test_progress_is_monotone_and_ends_at_one() -> None:
    seen: list[float] = []
    Session().run(2.0, progress=seen.append)
    assert len(seen) > 4
    assert all(0.0 < before < after for before, after in pairwise(seen))
    assert seen[-1] == 1.0


def test_duration_stretches_the_script() -> None:
    # each of the script's steps is rounded to a tick
    assert len(Session().run(1.5)) == pytest.approx(15_000, abs=8)
    assert len(Session().run(operator=[])) == 0


def test_the_session_keeps_what_it_was_made_from() -> None:
    """Later changes of the caller's descriptions are not those of the session."""
    scene, rig = Scene(), Rig()
    settings = settings_for_path(rig)
    session = Session(scene, rig, settings=settings)
    before = session.metadata()
    scene.tip.radius = 30e-9
    rig.probe.spring_constant = 1.0
    settings.gains.alpha_f = 1e6
    assert session.metadata() == before


# ---- physics ----


def test_pull_off_is_the_plans(pressed: tuple[Session, Recording]) -> None:
    """A stiff lever (8 N/m) meets the load fold within one tick of the stage. Near the fold the force goes as the
    square root of the travel that is left, so a tick of 0.1 nm is some per cent of it: 2 to 7 % in 12 runs with seeds
    0 to 11, never more than the plan's."""
    session, recording = pressed
    assert 0.92 < -recording.tip_force.min() / session.plan.pull_off_force < 1.0
    assert (recording.state == RUN).all()
    assert recording.tip_force.max() > 0.1e-6  # 2 N at the hand over alpha_f = 1.8e7
    assert recording.gap[0] == pytest.approx(session.clearance, rel=1e-3)
    assert recording.gap[-1] > 0.5 * session.clearance


def test_deflection_balances_the_force(pressed: tuple[Session, Recording]) -> None:
    """k_c zeta = F at rest, within the sensor's noise (50 mV peak to peak times S k_c = 13.2 nN, 6 sigma)."""
    _, recording = pressed
    sigma = 8.0 * 0.033e-6 * 50e-3 / 6
    error = recording.slave_force - recording.tip_force
    still = np.abs(np.gradient(recording.tip_force)) < 0.1 * sigma
    assert np.mean(still) > 0.6
    assert np.std(error[still]) == pytest.approx(sigma, rel=0.1)
    assert abs(np.mean(error[still])) < 0.1 * sigma


def test_at_rest_the_hand_feels_the_scaled_force() -> None:
    """f_m = alpha_f f_s within the noise, after the approach and five seconds of steady pushing."""
    session = Session()
    session.run(operator=[Input(0.3, 0.0, 0.0, 4.0), Input(1.0, 0.0, 0.0, 1.0), Input(1.0, 0.0, 0.0, 5.0)])
    rest = Recording(session.advance(1.0))
    alpha_f = session.settings.gains.alpha_f
    assert rest.tip_force.min() > 0.0
    assert np.mean(rest.operator_force) == pytest.approx(1.0, abs=0.02)  # the gauge's step
    assert alpha_f * np.mean(rest.slave_force) == pytest.approx(1.0, abs=0.02)


def test_scan_feels_the_surface() -> None:
    session = Session(surface=GRATING, mode="scan", path=[(0.3e-6, 3e-6), (1.3e-6, 3e-6)])
    recording = session.run()
    assert (recording.x[0], recording.x[-1]) == pytest.approx((0.3e-6, 1.3e-6), abs=1e-9)
    np.testing.assert_allclose(
        recording.surface_height, GRATING.height(recording.x, recording.y), atol=20e-9
    )  # x is read before the tip moves on; the flank is steep
    along = (recording.contact_radius > 0) & (recording.tip_force > 0)
    assert np.ptp(recording.surface_height[along]) > 400e-9
    assert session.relief == pytest.approx(np.ptp(GRATING.height(np.linspace(0.3e-6, 1.3e-6, 2001), 3e-6)))


def test_topography_holds_the_force() -> None:
    dots = Surface(surface.dots(pixels=128), 20e-9)
    session = Session(surface=dots, mode="topography")
    recording = session.run()
    touching = recording.contact_radius > 0
    set_point = session.settings.gains.set_point
    assert np.median(recording.slave_force[touching]) == pytest.approx(set_point, rel=0.02)
    assert (recording.state == RUN).all()


def test_margins(pressed: tuple[Session, Recording]) -> None:
    """R1: (1 + K_f) alpha_f alpha_p k_eff against b_m over the delay."""
    session, _ = pressed
    margins = session.margins()
    gains, rig = session.settings.gains, session.rig
    k = session.plan.maximum_stiffness
    k_eff = k * rig.probe.spring_constant / (k + rig.probe.spring_constant)
    loop = (1 + gains.force_gain) * gains.alpha_f * gains.alpha_p * k_eff
    assert margins.loop_stiffness == pytest.approx(loop, rel=1e-6)  # the stage gives way a little, too
    # b_m/D, less what the stage's integral takes: 4 % at 60 1/s
    assert 0.95 < margins.stability_limit * margins.loop_delay / rig.master.damping <= 1.0
    assert margins.margin == pytest.approx(margins.stability_limit / margins.loop_stiffness, rel=1e-12)
    assert margins.margin == session.core.margin > 1.5


def test_scaling_follows_the_relief() -> None:
    """Eq. 19, 21: the master's travel for clearance, indentation and relief."""
    flat, rough = settings_for_path(Rig()), settings_for_path(Rig(), relief=480e-9)
    assert flat.gains.alpha_p == pytest.approx((0.1e-6 + 0.3e-6) / 0.02, rel=1e-12)
    assert rough.gains.alpha_p == pytest.approx((0.1e-6 + 0.3e-6 + 480e-9) / 0.02, rel=1e-12)
    assert flat.gains.alpha_f == rough.gains.alpha_f == pytest.approx(2 * 5 / (8 * 0.33e-6 + 0.6e-6), rel=1e-12)


# ---- stops ----


def test_emergency_stop_latches_until_confirmed() -> None:
    session = Session()
    assert (session.advance(0.1)["state"] == RUN).all()
    session.emergency_stop()
    stopped = session.advance(0.1)
    assert (stopped["state"][1:] == LATCHED).all()
    session.emergency_stop(False)
    assert (session.advance(0.1)["state"] == LATCHED).all()
    with pytest.raises(Error, match="arm"):
        session.arm()
    assert (session.advance(0.1)["state"] == LATCHED).all()
    session.arm(confirmed=True)
    assert (session.advance(0.1)["state"][1:] == RUN).all()


def test_arming_while_pressed_latches_again() -> None:
    session = Session()
    session.emergency_stop()
    session.advance(0.01)
    session.arm(confirmed=True)
    assert (session.advance(0.1)["state"][1:] == LATCHED).all()


# ---- threads ----


def test_emergency_stop_does_not_wait_for_advance() -> None:
    """The law of control holds a long advance at tick 100 until another thread has pressed: only the next tick is
    RUN."""
    running, stopped, calls = Event(), Event(), count(1)

    def law(signals: Signals) -> tuple[float, float]:
        if next(calls) == 100:
            running.set()
            assert stopped.wait(20.0), "the stop waits for advance"
        return 0.0, signals.stage_position

    session = Session(control=law, minimum_margin=0.0, preflight=False)
    with ThreadPoolExecutor(1) as pool:
        advancing = pool.submit(session.core.advance, 60_000)
        assert running.wait(20.0)
        session.emergency_stop()
        stopped.set()
        advancing.result()
    state = session.core.read(60_000)["state"]
    assert (state[:100] == RUN).all()
    assert (state[100:] == LATCHED).all()


def test_a_press_is_not_lost_to_a_quick_release() -> None:
    session = Session()
    session.emergency_stop()
    session.emergency_stop(False)
    assert (session.advance(0.1)["state"] == LATCHED).all()
    session.arm(confirmed=True)
    assert (session.advance(0.1)["state"] == RUN).all()


def test_sessions_in_threads_do_not_see_each_other() -> None:
    expected = [Session(seed=seed).advance(0.5, PUSH) for seed in range(4)]
    with ThreadPoolExecutor(4) as pool:
        results = list(pool.map(lambda seed: Session(seed=seed).advance(0.5, PUSH), range(4)))
    assert all(same(one, other) for one, other in zip(results, expected, strict=True))


def test_threads_may_share_a_session() -> None:
    """Who gets which rows is open; that none is lost or made twice is not."""
    session = Session()
    with ThreadPoolExecutor(4) as pool:
        parts = list(pool.map(lambda _: session.advance(0.2)["time"], range(12)))
    times = np.sort(np.concatenate([*parts, session.core.read(50_000)["time"]]))
    np.testing.assert_allclose(times, np.arange(24_000) * 1e-4, rtol=1e-12)


# ---- refusals ----


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"mode": "hover"}, ["'hover'", "point, scan, topography"]),
        ({"path": [(7e-6, 1e-6)]}, ["(7 um, 1 um)", "outside", "0 .. 6 um"]),
        ({"path": [(1e-6, -1e-9)]}, ["(1 um, -0.001 um)", "outside"]),
        ({"path": [(math.nan, 0.0)]}, ["path", "not finite"]),
        ({"path": []}, ["'point'", "one point"]),
        ({"path": [(1e-6, 1e-6), (2e-6, 2e-6)]}, ["'point'", "one point", "not 2"]),
        ({"mode": "scan", "path": [(1e-6, 1e-6)]}, ["'scan'", "two points", "not 1"]),
        ({"mode": "scan", "path": [(1e-6, 1e-6)] * 2}, ["'scan'", "a length"]),
        ({"mode": "scan", "path": [(1e-6, 1e-6), (1e-6, 7e-6)]}, ["outside"]),
        ({"clearance": 0.0}, ["clearance = 0 m", "0.001 m"]),
        ({"clearance": 1e-10}, ["clearance = 1e-10 m", "1.1897e-09 .. 0.001 m"]),  # 1 nm and the drift of 0.19 s
        ({"clearance": math.nan}, ["clearance = nan m"]),
        ({"seed": -1}, ["seed = -1", "0 .. 2^64 - 1"]),
        ({"seed": 2**64}, ["seed"]),
        ({"relative_accuracy": -0.1}, ["relative_accuracy = -0.1"]),
        ({"minimum_margin": 1e9}, ["stability margin", "1e+09"]),
    ],
)
def test_bad_options(options: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(InvalidValue) as caught:
        Session(surface=GRATING, **options)
    assert all(word in str(caught.value) for word in words), caught.value


def test_a_seed_is_a_whole_number() -> None:
    with pytest.raises(TypeError):
        Session(seed=1.5)  # type: ignore[arg-type]
    assert Session(seed=np.int64(3)).metadata()["seed"] == 3  # type: ignore[arg-type]


@pytest.mark.parametrize("duration", [-1e-3, math.nan, math.inf])
def test_bad_durations(duration: float) -> None:
    session = Session()
    with pytest.raises(InvalidValue, match="duration"):
        session.advance(duration)
    with pytest.raises(InvalidValue, match="duration"):
        session.run(duration)


@pytest.mark.parametrize(
    ("step", "words"),
    [
        (Input(math.nan, 1e-6, 1e-6, 1.0), "operator_force = nan N: valid is -inf .. inf N"),
        (Input(0.1, 1e-6, 1e-6, math.inf), "duration = inf s: valid is 0 .. inf s"),
        (Input(0.1, 1e-6, 1e-6, -1.0), "duration = -1 s: valid is 0 .. inf s"),
        (Input(0.1, 9e-6, 1e-6, 1.0), r"input.x = 9e-06 m: valid is 0 .. 6e-06 m"),
    ],
)
def test_bad_input(step: Input, words: str) -> None:
    session = Session(surface=GRATING)
    with pytest.raises(InvalidValue, match=words):
        session.advance(0.1, step)
    with pytest.raises(InvalidValue, match=words):
        session.run(operator=[PUSH, step])
    assert session.advance(1e-4)["time"][0] == 0.0  # nothing has run
