# SPDX-License-Identifier: BSD-3-Clause
"""Laws, modes, running changes, replay and the supervisor on plain numbers, from Python."""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nanotouch import Faults, Input, Recording, Rig, Scene, Session, Supervisor, Surface, record, surface
from nanotouch._core import Signals
from nanotouch.errors import Error, InvalidValue
from nanotouch.touch.margins import resolution
from nanotouch.touch.supervisor import REASONS

GRATING = Surface(surface.grating(pixels=128), 20e-9)
RUN = record.STATES.index("RUN")
PRESS = [Input(0.3, 0.0, 0.0, 2.0), Input(1.0, 0.0, 0.0, 1.0), Input(1.0, 0.0, 0.0, 3.0)]
COMMANDS = ("motor_force", "stage_command", "state", "reasons")


def same(one: Recording, other: Recording) -> bool:
    return all(np.array_equal(one.columns[name], other.columns[name]) for name in COMMANDS)


# ---- laws ----


@pytest.mark.parametrize("control", ["default", "impedance"])
def test_every_law_lets_the_hand_feel_the_scaled_force(control: str) -> None:
    session = Session(control=control, gains={"force_gain": 5.0})
    recording = session.run(operator=[*PRESS, Input(1.0, 0.0, 0.0, 3.0)])
    rest = recording[-8000:]
    assert (rest.state == RUN).all()
    # noise of the probe at the hand 0.007 N over sqrt(8000), and half a step of the gauge
    assert np.mean(session.settings.gains.alpha_f * rest.tip_force) == pytest.approx(1.0, abs=0.011)


def test_the_papers_stage_does_not_reach_its_target() -> None:
    """Eq. 17 has no integrator: x_s = alpha_p x_m K_p/(1 + K_p). At 20 kHz, without delay, K_p = 0.5 is stable."""
    gains = {"stage_proportional": 0.5, "delay": 0.0, "force_gain": 1.0}
    session = Session(control="paper", rate=20e3, gains=gains, clearance=2e-6, minimum_margin=0.5)
    recording = session.run(operator=[Input(0.5, 0.0, 0.0, 0.2), Input(0.0, 0.0, 0.0, 1.0), Input(0.0, 0.0, 0.0, 0.5)])
    end = recording[-1000:]
    wanted = session.settings.gains.alpha_p * (end.master_position - session.core.master_start)
    assert np.mean(end.stage_position) / np.mean(wanted) == pytest.approx(1.0 / 3.0, rel=0.02)


def test_the_papers_gains_are_refused() -> None:
    """Fig. 17: K_f = 2, kappa far above R1 at 3 ms (docs/control.md)."""
    gains = {"alpha_p": 4e-3, "alpha_f": 2e6, "force_gain": 2.0}
    with pytest.raises(InvalidValue, match="margin"):
        Session(control="paper", rate=333.0, gains=gains)


def test_a_law_in_python() -> None:
    calls = []

    def law(signals: Signals) -> tuple[float, float]:
        calls.append(signals.period)
        reflected = signals.alpha_f * signals.felt_force
        return -reflected - 2.0 * (reflected - signals.smooth_force), signals.target

    one, other = Session(control=law), Session()
    calls.clear()  # it has been tried
    script = [Input(0.5, 0.0, 0.0, 0.3)]
    mine, theirs = one.run(operator=script), other.run(operator=script)
    assert len(calls) == 3000
    np.testing.assert_allclose(mine.motor_force, theirs.motor_force, atol=1e-12)
    assert mine.metadata["control"] == "own"
    with pytest.raises(InvalidValue, match="law of one's own"):
        mine.replay()
    assert same(mine, mine.replay(law))


def test_a_law_that_fails_stops_the_loop_and_says_why() -> None:
    def law(signals: Signals) -> tuple[float, float]:
        if signals.master_position > -7.9e-3:
            raise ZeroDivisionError("my law")
        return 0.0, signals.target

    with pytest.raises(ZeroDivisionError, match="my law"):
        Session(control=law)  # in the middle of the travel
    session = Session(control=law, minimum_margin=0.0)
    with pytest.raises(ZeroDivisionError, match="my law"):
        session.advance(1.0, Input(1.0, 0.0, 0.0, 0.1))
    left = session.core.read(50_000)
    assert left["state"][-1] == record.STATES.index("RETRACT")
    assert np.isfinite(left["motor_force"]).all()


@pytest.mark.parametrize("answer", [None, (1.0,), (1.0, 2.0, 3.0), 3.0, "ab", (1j, 0.0)])
def test_a_law_that_gives_no_pair_is_named(answer: Any) -> None:
    session = Session(control=lambda _signals: answer, minimum_margin=0.0)
    with pytest.raises(TypeError, match=r"motor force .* and stage position"):
        session.advance(0.01)


def test_a_law_that_cannot_be_judged_is_refused() -> None:
    def damped(signals: Signals) -> tuple[float, float]:
        return -signals.alpha_f * signals.felt_force - 50.0 * signals.master_speed, signals.target

    with pytest.raises(InvalidValue, match="own law, of no kind that can be judged"):
        Session(control=damped)
    with pytest.raises(InvalidValue, match=r"mode: stability margin .own law, of no kind that can be judged."):
        Session(control=damped, mode="curve").set_mode("point")
    Session(control=damped, minimum_margin=0.0).advance(0.01)


def test_a_law_that_fails_while_it_is_tried_says_so_at_once() -> None:
    broken = []

    def law(signals: Signals) -> tuple[float, float]:
        if broken:
            raise ZeroDivisionError("my law")
        return -signals.alpha_f * signals.felt_force, signals.target

    session = Session(control=law)
    broken.append(True)
    with pytest.raises(ZeroDivisionError, match="my law"):
        session.rescale(alpha_f=1e6)
    broken.clear()
    session.rescale(alpha_f=1e6)
    session.advance(0.01)


def test_refusals_name_the_rule() -> None:
    with pytest.raises(InvalidValue, match=r"stability margin \(R5 noise\) = .* valid is 1.5"):
        Session(gains={"force_gain": 500.0})
    with pytest.raises(InvalidValue, match=r"stability margin \(exact K_f\)"):
        Session(rate=1e3, gains={"force_gain": 10.0, "alpha_p": 1e-3})
    with pytest.raises(InvalidValue, match=r"stability margin \(R1 contact\)"):
        Session(gains={"force_gain": 0.0, "alpha_p": 1e-2})
    with pytest.raises(InvalidValue, match="minimum_margin = -1"):
        Session(minimum_margin=-1.0)
    session = Session(mode="curve", gains={"force_gain": 500.0})
    with pytest.raises(InvalidValue, match=r"mode: stability margin .R5 noise. = .*: valid is 1.5 .. inf"):
        session.set_mode("point")
    with pytest.raises(InvalidValue, match=r"rescale: stability margin .* = 0: valid is 1.5 .. inf"):
        Session().rescale(alpha_p=1e-2)


def test_one_scale_changes_without_the_other() -> None:
    session = Session()
    alpha_p, alpha_f = session.settings.gains.alpha_p, session.settings.gains.alpha_f
    session.rescale(alpha_f=2.0 * alpha_f)
    session.rescale(alpha_p=0.5 * alpha_p)
    assert session.metadata()["events"][-1][2] == [0.5 * alpha_p, 2.0 * alpha_f]


def test_what_cannot_be_replayed_is_refused_by_name() -> None:
    recording = Session().run(0.5)
    whole = recording.metadata

    def changed(**entries: Any) -> record.Recording:
        return record.Recording(recording.columns, whole | entries)

    with pytest.raises(InvalidValue, match=r"every tick; after 0.0999 s .* goes on at 0.2 s"):
        recording[np.r_[0:1000, 2000:5000]].replay()
    with pytest.raises(InvalidValue, match="give no other law"):
        recording.replay(lambda signals: (0.0, signals.target))
    bad: list[dict[str, Any]] = [
        {"mode": "x"}, {"control": "x"}, {"path": []}, {"master_start": "x"}, {"events": "abc"},
        {"events": [[0, "zzz", []]]}, {"events": [[0, "aim", []]]}, {"events": [[0, "aim", ["x", 0, 0]]]},
        {"events": [[0, "mode", ["x"]]]},
    ]  # fmt: skip
    for entries in bad:
        with pytest.raises(InvalidValue):
            changed(**entries).replay()


def test_a_rig_without_a_gauge_is_felt_all_the_same() -> None:
    rig = Rig(master={"gauge": 0.0})
    session = Session(rig=rig)
    recording = session.run(operator=[*PRESS, Input(1.0, 0.0, 0.0, 3.0)])
    assert (recording.state == RUN).all()
    rest = recording[-5000:]
    assert session.settings.gains.alpha_f * np.mean(rest.tip_force) == pytest.approx(1.0, abs=0.01)
    assert same(recording, recording.replay())


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"control": "fuzzy"}, ["'fuzzy'", "default, paper, impedance"]),
        ({"gains": {"force": 1.0}}, ["'force'", "force_gain"]),
        ({"gains": {"force_gain": -1.0}}, ["force_gain", "-1"]),
        ({"delay": -1.0}, ["delay = -1.0 s"]),
        ({"rate": 1.0}, ["rate = 1 Hz"]),
    ],
)
def test_bad_choices_are_refused(options: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(InvalidValue) as caught:
        Session(**options)
    assert all(word in str(caught.value) for word in words), caught.value


def test_a_link_of_many_periods_runs() -> None:
    session = Session(delay=8e-3, gains={"stage_integral": 0.0})  # which would lead
    recording = session.run(operator=[Input(0.2, 0.0, 0.0, 0.01), Input(0.2, 0.0, 0.0, 0.2)])
    position, command = recording.stage_position[200:], recording.stage_command
    errors = [float(np.std(position - command[200 - late : len(command) - late])) for late in range(200)]
    assert 81 <= int(np.argmin(errors)) < 92  # periods of 0.1 ms with the rig's own, and the notch's 5
    with pytest.raises(InvalidValue, match=r"gains.delay = 301 periods: valid is 0 .. 254"):
        Session(delay=30e-3, minimum_margin=0.0)


def test_a_link_delay_costs_margin() -> None:
    near, far = Session(), Session(delay=0.5e-3)
    assert far.settings.gains.delay == near.settings.gains.delay + 5.0
    assert far.margins().loop_delay == pytest.approx(near.margins().loop_delay + 2 * 0.5e-3, rel=1e-9)


# ---- modes ----


@pytest.mark.parametrize("clearance", [30e-9, 0.5e-6, 3e-6])
def test_an_approach_finds_the_surface(clearance: float) -> None:
    session = Session(mode="approach", clearance=clearance)
    recording = session.run()
    assert session.is_done
    set_point = session.settings.gains.set_point
    assert np.median(recording.slave_force[-500:]) == pytest.approx(set_point, rel=0.03)
    assert recording.tip_force.max() < set_point + session.force_overshoot
    session.set_mode("point")
    after = session.run(operator=[Input(0.5, 0.0, 0.0, 0.5), Input(0.5, 0.0, 0.0, 3.0)])
    assert (after.state == RUN).all()
    assert session.settings.gains.alpha_f * np.mean(after.tip_force[-3000:]) == pytest.approx(0.5, abs=0.011)


def test_a_curve_is_one_for_the_curves_module() -> None:
    session = Session(mode="curve", clearance=0.1e-6)
    recording = session.run()
    assert session.is_done
    curve = recording.curve()
    assert [segment.role for segment in curve.segments] == ["approach", "retract"]
    assert curve.spring_constant == 8.0
    approach, retract = curve.approach, curve.retract
    assert approach is not None
    assert retract is not None
    assert approach.z[0] > approach.z[-1]
    assert retract.z[0] < retract.z[-1]
    assert approach.force is not None
    assert retract.force is not None
    # 6 sigma of the reading: 13 nN
    assert approach.force.max() == pytest.approx(session.settings.gains.set_point, abs=14e-9)
    assert -retract.force.min() == pytest.approx(session.plan.pull_off_force, abs=14e-9)
    assert same(recording, recording.replay())
    with pytest.raises(InvalidValue, match="'point'"):
        Session().run(operator=[Input(0.0, 0.0, 0.0, 0.01)]).curve()


# ---- while it runs ----


def test_a_new_scale_while_it_runs() -> None:
    session = Session(Scene(range={"maximum_load": 2e-6}))
    gains = session.settings.gains
    session.run(operator=PRESS)
    session.rescale(alpha_f=0.5 * gains.alpha_f)
    recording = session.run(operator=[Input(1.0, 0.0, 0.0, 4.0)])
    assert (recording.state == RUN).all()
    assert np.abs(np.diff(recording.stage_command)).max() < 1e-9
    rest = recording[-3000:]
    assert 0.5 * gains.alpha_f * np.mean(rest.tip_force) == pytest.approx(1.0, abs=0.015)
    with pytest.raises(Error, match="rescale"):
        session.rescale(alpha_f=1e3 * gains.alpha_f)  # closer to its limit than 1.5


def test_the_clutch_holds_the_stage() -> None:
    session = Session()
    session.run(operator=PRESS)
    session.clutch()
    recording = session.run(operator=[Input(-0.5, 0.0, 0.0, 0.01), Input(-0.5, 0.0, 0.0, 0.2)])
    assert recording.master_position[-1] < recording.master_position[0] - 0.1e-3
    assert np.ptp(recording.stage_command) < 2e-9
    session.clutch(open=False)
    assert (session.run(operator=[Input(0.2, 0.0, 0.0, 0.5)]).state == RUN).all()


# ---- replay ----


def test_a_replay_is_the_same_to_the_last_bit(tmp_path: Path) -> None:
    """Through a file, with every kind of request."""
    session = Session(surface=GRATING, mode="scan", path=[(0.5e-6, 3e-6), (1.5e-6, 3e-6)], seed=3)
    blocks = [session.advance(1.0, Input(0.3, 0.5e-6, 3e-6, 0.5))]
    session.rescale(alpha_f=0.7 * session.settings.gains.alpha_f)
    blocks.append(session.advance(1.0, Input(0.6, 0.8e-6, 3e-6, 1.0)))
    session.clutch()
    blocks.append(session.advance(0.1))
    session.clutch(open=False)
    session.set_mode("topography")
    blocks.append(session.advance(0.5, Input(0.0, 0.9e-6, 3e-6, 0.5)))
    session.emergency_stop()
    blocks.append(session.advance(0.1))
    session.emergency_stop(False)
    session.arm(confirmed=True)
    session.set_mode("scan")
    blocks.append(session.advance(0.5, Input(-0.3, 1.0e-6, 3e-6, 0.2)))
    columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
    recording = Recording(columns, session.metadata())
    assert len(np.unique(recording.state)) >= 2
    record.write(tmp_path / "touch.mcap", recording)
    again = record.read(tmp_path / "touch.mcap")
    assert same(recording, again.replay())
    other = {name: values.copy() for name, values in columns.items()}
    other["deflection"][5000] += 1e-12  # the comparison can fail
    assert not same(recording, Recording(other, recording.metadata).replay())


def test_what_cannot_be_replayed_says_why() -> None:
    recording = Session().run(operator=[Input(0.1, 0.0, 0.0, 0.01)])
    with pytest.raises(InvalidValue, match="begins at time 0 s"):
        recording[10:].replay()
    with pytest.raises(InvalidValue, match="lacks age"):
        Recording({name: v for name, v in recording.columns.items() if name != "age"}, recording.metadata).replay()


# ---- supervisor ----


def test_the_supervisor_on_plain_numbers() -> None:
    supervise = Supervisor()
    assert supervise() == ("RUN", ())
    assert supervise(operator_force=math.nan) == ("HOLD", ("invalid sample",))
    assert supervise() == ("RUN", ())
    assert supervise(age=2.5e-4) == ("HOLD", ("stale sample",))
    assert supervise(operator_force=5.0) == ("RUN", ("operator force clipped",))
    assert supervise(deflection=0.3e-6) == ("RETRACT", ("force limit",))
    assert supervise() == ("RETRACT", ("force limit",))
    assert supervise(flags=("emergency_stop",)).state == "LATCHED"
    with pytest.raises(Error):
        supervise.arm()
    supervise.arm(confirmed=True)
    assert supervise() == ("RUN", ())
    assert supervise(flags=("device_lost",)).state == "LATCHED"


@pytest.mark.parametrize(("hysteresis", "integral"), [(0.15, 60.0), (0.3, 60.0), (0.15, 0.0), (0.3, 0.0)])
def test_a_declared_hysteresis_is_no_fault(hysteresis: float, integral: float) -> None:
    rig = Rig(stage={"hysteresis": hysteresis, "creep": 0.01})
    gains = {"approach_speed": 20e-6, "curve_length": 3e-6, "stage_integral": integral}
    session = Session(rig=rig, mode="curve", clearance=4e-6, gains=gains)
    recording = session.run()
    assert (recording.state == RUN).all()
    if hysteresis == 0.15:
        assert session.is_done  # what no integral takes away of 30 % is much of the way
    # it is no room for a stage that turns: it stops, and the force keeps its bound
    faults = Faults().add("gain", "stage", at=2.0, value=-1.0)
    hard = Scene(range={"maximum_load": 2.2e-6})
    turned = Session(hard, rig, gains={"stage_integral": integral}, faults=faults)
    script = [Input(2.0, 0.0, 0.0, 0.5), Input(2.0, 0.0, 0.0, 2.0), Input(-0.5, 0.0, 0.0, 4.0)]
    with pytest.warns(UserWarning, match="the session was stopped"):
        recording = turned.run(operator=script)
    assert recording.state[-1] != RUN
    promised = turned.guarantee()
    assert recording.tip_force.max() < promised.force + promised.failures["stage runs or turns"]


def test_steps_of_converters_count() -> None:
    coarse = Rig(converters={"adc_bits": 12.0, "dac_bits": 12.0})
    step = 100e-6 / 4096
    same = Rig(stage={"resolution": step, "command_resolution": step}, probe={"resolution": 20.0 / 4096})
    sessions = [Session(rig=rig) for rig in (coarse, same)]  # drawn back by 20 of these steps, and seen to be
    assert sessions[0].margins() == sessions[1].margins()
    fine = Session(gains={"alpha_f": sessions[0].settings.gains.alpha_f})  # coarse steps leave a smaller one
    assert sessions[0].margins().quantisation_step > 100.0 * fine.margins().quantisation_step / 8.0
    assert sessions[0].guarantee() == sessions[1].guarantee()
    assert resolution(coarse, sessions[0].settings, 0.4e-6) == resolution(same, sessions[1].settings, 0.4e-6)


@pytest.mark.parametrize("step", [1e-8, 1e-7])
def test_a_stage_of_coarse_steps_follows(step: float) -> None:
    rig = Rig(stage={"resolution": step, "command_resolution": step})
    session = Session(rig=rig, mode="curve", clearance=1e-6, gains={"approach_speed": 20e-6})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the steps of 0.1 um press beyond the force limit
        recording = session.run()
    assert not np.any(recording.reasons & 1 << REASONS.index("stage does not follow"))


def test_a_bias_is_tared_and_a_large_one_refused() -> None:
    assert abs(Session().core.tare[0]) < 5e-9 / math.sqrt(1000)
    settings = Session().settings.copy()
    settings.limits.deflection_drift = 0.0
    with pytest.raises(InvalidValue, match="deflection drift"):
        Session(settings=settings)
    assert Session(preflight=False).core.tare == (0.0, 0.0)
