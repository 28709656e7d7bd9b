# SPDX-License-Identifier: BSD-3-Clause
"""Margins: the exact limit against eigenvalues of the whole sampled loop built here, against closed forms, and against
trials on the simulated rig; rules R2 and R3, Llewellyn, bandwidth, resolution; extremes; recordings."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import _core, margins
from nanotouch_app.main import main
from nanotouch_app.touching import stability

linalg = pytest.importorskip("scipy.linalg")
Floats = Any


def held(mass: float, damping: float, stiffness: float, period: float) -> tuple[Floats, Floats]:
    """Exact transition of (x, v) and of a held force."""
    a = np.zeros((3, 3))
    a[0, 1] = 1.0
    a[1] = [-stiffness / mass, -damping / mass, 1.0 / mass]
    e = linalg.expm(a * period)
    return e[:2, :2], e[:2, 2]


def notch(rig: nt.Rig, settings: nt.Settings) -> tuple[list[float], list[float]]:
    """Zeros on the sampled poles of the stage, poles of the wanted damping, gain 1 at rest."""
    angle = 2.0 * math.pi * rig.stage.resonance / settings.gains.rate
    if angle >= math.pi:
        return [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]
    bare, wanted = (
        np.poly(np.exp(angle * np.roots([1.0, 2.0 * zeta, 1.0]))).real
        for zeta in (0.5 / rig.stage.quality, settings.gains.stage_damping)
    )
    return list(bare * wanted.sum() / bare.sum()), list(wanted)


def radius(rig: nt.Rig, settings: nt.Settings, reflected: float, force_gain: float) -> float:
    """Spectral radius of one period of the loop, as the touch step computes it, on a contact of stiffness
    alpha_f alpha_p k_eff = reflected."""
    gains, hand = settings.gains, rig.hand
    period, delay = 1.0 / gains.rate, int(gains.delay)
    mass, damping = rig.master.mass + hand.mass, rig.master.damping + hand.damping
    wn = 2.0 * math.pi * rig.stage.resonance
    master, push = held(mass, damping, hand.stiffness, period)
    stage, drive = held(1.0 / wn**2, 1.0 / (wn * rig.stage.quality), 1.0, period)
    b, a = notch(rig, settings)
    low_pass = -math.expm1(-2.0 * math.pi * gains.force_filter * period)

    def step(state: Floats) -> Floats:
        x, v, xs, vs, w0, w1, correction, smooth, acting = state[:9]
        motor, command = list(state[9 : 9 + delay]), list(state[9 + delay :])
        acceleration = (acting - damping * v - hand.stiffness * x) / mass
        felt = -(hand.mass * acceleration + hand.damping * v + hand.stiffness * x)
        smooth += low_pass * (felt - smooth)
        correction += gains.stage_integral * period * (x - xs)
        into = x + correction
        out = b[0] * into + w0
        motor.append(-(1.0 + force_gain) * reflected * xs + force_gain * smooth)
        command.append(out)
        now, to = motor.pop(0), command.pop(0)
        moved, driven = master @ [x, v] + push * now, stage @ [xs, vs] + drive * to
        memory = [b[1] * into - a[1] * out + w1, b[2] * into - a[2] * out]
        return np.array([*moved, *driven, *memory, correction, smooth, now, *motor, *command])

    matrix = np.array([step(row) for row in np.eye(9 + 2 * delay)]).T
    return float(np.max(np.abs(np.linalg.eigvals(matrix))))


def cases() -> list[tuple[nt.Rig, nt.Settings]]:
    """Rates, delays, gains, dampings and hands at random."""
    random = np.random.default_rng(1)
    made = []
    for number in range(24):
        rig = nt.Rig()
        settings = nt.Settings.for_rig(rig)
        settings["gains.rate"] = 10 ** random.uniform(2.5, 4.7)
        settings["gains.delay"] = float(random.integers(0, 4))
        settings["gains.force_gain"] = 10 ** random.uniform(-1.0, 1.5)
        settings["gains.stage_damping"] = random.uniform(0.3, 1.5)
        if number % 2:
            rig["hand.damping"], rig["hand.stiffness"] = random.uniform(0.5, 5.0), random.uniform(100.0, 2000.0)
        if number % 3 == 0:
            rig["hand.mass"] = random.uniform(1e-3, 0.1)
        made.append((rig, settings))
    return made


@pytest.mark.parametrize("case", cases(), ids=lambda case: f"{case[1].gains.rate:.0f} Hz")
def test_exact_limits_are_those_of_the_eigenvalues(case: tuple[nt.Rig, nt.Settings]) -> None:
    """A ten thousandth below either limit all eigenvalues are inside the circle, above it one is not; and none has left
    it anywhere below."""
    rig, settings = case
    gain = settings.gains.force_gain
    found = margins.compute(rig, settings, math.inf)
    limit = found.exact_limit / (1.0 + gain)
    for share in (0.03, 0.3, 0.7, 0.9, 0.9999) if limit > 0.0 else ():
        assert radius(rig, settings, share * limit, gain) < 1.0
    assert radius(rig, settings, max(1.0001 * limit, 1e-3), gain) > 1.0
    reflected = found.loop_stiffness / (1.0 + gain)
    top = found.force_gain_limit
    for share in (0.0, 0.3, 0.7, 0.9999):
        assert radius(rig, settings, reflected, share * top) < 1.0
        assert radius(rig, settings, 0.0, share * top) < 1.0 + 1e-9  # in air the master is anywhere: a root at 1
    over = max(radius(rig, settings, reflected, 1.0001 * top), radius(rig, settings, 0.0, 1.0001 * top))
    assert over > 1.0 + 1e-9


def test_fast_stage_is_jury_with_a_period_of_delay() -> None:
    """x_m is sampled, the stage is there one period later: 30.8, 80, 149, 284, 685 kN/m for the paper's master."""
    table = {3e-3: 30.8e3, 1e-3: 80e3, 0.5e-3: 149e3, 0.25e-3: 284e3, 0.1e-3: 685e3}
    for period, limit in table.items():
        rig = nt.Rig(stage={"resonance": 1e6, "quality": 0.5})
        settings = nt.Settings.for_rig(rig)
        settings["gains.rate"], settings["gains.delay"], settings["gains.stage_integral"] = 1.0 / period, 0.0, 0.0
        assert margins.compute(rig, settings, math.inf).exact_limit == pytest.approx(limit, rel=6e-3)


@pytest.mark.parametrize(("delay", "factor"), [(0.0, 2.0), (1.0, 1.0)])
def test_r2_of_a_pad(delay: float, factor: float) -> None:
    """2 m/(b_h T) without delay, half of it with one period; without filter and with little b_m that is exact."""
    rig = nt.Rig(hand={"damping": 5.0}, master={"damping": 0.01})
    settings = nt.Settings.for_rig(rig)
    settings["gains.delay"], settings["gains.force_filter"] = delay, 1e6
    found = margins.compute(rig, settings, 1e-6)
    assert found.pad_limit == pytest.approx(factor * 0.1 * 10e3 / 5.0)
    assert found.force_gain_limit == pytest.approx(found.pad_limit, rel=0.01)


@pytest.mark.parametrize("mass", [0.02, 0.1])
def test_r3_of_a_rigid_finger_at_any_rate(mass: float) -> None:
    """1 + m/m_h: 6 for 20 g, 2 for 0.1 kg; the low-pass of f_m lifts it."""
    for rate in (20e3, 100e3):
        rig = nt.Rig(hand={"mass": mass})
        settings = nt.Settings.for_rig(rig)
        settings["gains.rate"], settings["gains.force_filter"] = rate, 1e6
        found = margins.compute(rig, settings, 1e-6)
        assert found.mass_limit == pytest.approx(1.0 + 0.1 / mass)
        assert found.force_gain_limit == pytest.approx(found.mass_limit, rel=0.15)  # b_m T/m helps at low rates
        settings["gains.force_filter"] = 50.0
        assert margins.compute(rig, settings, 1e-6).force_gain_limit > 1.5 * found.mass_limit


def printed_radius(rig: nt.Rig, settings: nt.Settings) -> float:
    """Spectral radius of the stage under Eq. 17 as printed, the master held."""
    gains = settings.gains
    period, delay, wn = 1.0 / gains.rate, int(gains.delay), 2.0 * math.pi * rig.stage.resonance
    stage, drive = held(1.0 / wn**2, 1.0 / (wn * rig.stage.quality), 1.0, period)

    def step(state: Floats) -> Floats:
        x, v, last, *queue = state
        queue.append(-gains.stage_proportional * x - gains.stage_derivative * (x - last) / period)
        return np.array([*(stage @ [x, v] + drive * queue.pop(0)), x, *queue])

    matrix = np.array([step(row) for row in np.eye(3 + delay)]).T
    return float(np.max(np.abs(np.linalg.eigvals(matrix))))


@pytest.mark.parametrize("rate", [1.0 / 3e-3, 1e3, 4e3, 10e3])
@pytest.mark.parametrize(("delay", "derivative"), [(0.0, 0.0), (1.0, 0.0), (0.0, 1e-4)])
def test_stage_as_printed_is_judged(rate: float, delay: float, derivative: float) -> None:
    """Eq. 17's K_p: what the eigenvalues call unstable has no limit above 0, and is refused."""
    rig = nt.Rig()
    settings = nt.Settings.for_rig(rig)
    _core.set_control(settings.core, "paper")
    settings["gains.rate"], settings["gains.delay"], settings["gains.stage_derivative"] = rate, delay, derivative
    seen = set()
    for proportional in np.geomspace(1e-3, 1e3, 60):
        settings["gains.stage_proportional"] = float(proportional)
        stable = printed_radius(rig, settings) < 1.0
        found = margins.compute(rig, settings, math.inf)
        assert (found.exact_limit > 0.0) == stable
        assert stable or found.refusal is not None
        seen.add(stable)
    assert False in seen


def test_what_is_refused_says_why() -> None:
    rig = nt.Rig()
    settings = nt.Settings.for_rig(rig)
    assert margins.compute(rig, settings, math.inf).refusal is None
    settings["gains.alpha_p"] = 4e-3  # Fig. 17
    refusal = margins.compute(rig, settings, math.inf).refusal
    assert refusal is not None
    assert "margin" in refusal
    settings = nt.Settings.for_rig(rig)
    settings["gains.force_gain"] = 1000.0
    assert margins.compute(rig, settings, math.inf).rule in ("R1 contact", "R4 steps", "R5 noise")
    with pytest.raises(nt.Error, match="stability margin"):
        nt.Session(rig=rig, settings=settings)


def test_limits_of_extreme_rigs_are_numbers() -> None:
    """Rates 100 Hz to 1 MHz, k_i/k_c 1e-6 to 1e6, Q to 1e6, steps to 100 nm: positive limits, and never safer by rule
    than by the exact limit where the samples see the resonance."""
    for rate in (100.0, 1e3, 10e3, 100e3, 1e6):
        for quality in (0.5, 20.0, 1e6):
            for ratio in (1e-6, 1.0, 1e6):
                rig = nt.Rig(stage={"quality": quality, "command_resolution": 100e-9})
                settings = nt.Settings.for_rig(rig)
                settings["gains.rate"] = rate
                found = margins.compute(rig, settings, ratio * rig.probe.spring_constant)
                numbers = [value for value in found if isinstance(value, float)]
                assert not any(math.isnan(value) for value in numbers)
                assert found.exact_limit > 0.0 or quality == 1e6
                if rate > 2.2 * rig.stage.resonance:
                    assert found.stability_limit < found.exact_limit


def test_response_at_low_and_high_frequency() -> None:
    rig = nt.Rig()
    settings = nt.Settings.for_rig(rig)
    found = margins.compute(rig, settings, math.inf)
    reflected = found.loop_stiffness / 3.0
    settings["gains.stage_integral"] = 0.0
    low = margins.response(rig, settings, math.inf, [0.01])
    assert low.path[0] == pytest.approx(1.0, abs=1e-3)
    assert abs(low.impedance[0]) == pytest.approx(reflected / (2 * math.pi * 0.01), rel=2e-3)
    assert low.llewellyn[0] == pytest.approx(1.0, abs=1e-4)
    lag = -np.angle(margins.response(rig, settings, math.inf, [20.0]).path[0]) / (2 * math.pi * 20.0)
    assert lag == pytest.approx(found.loop_delay, rel=0.03)  # D of rule R1
    assert found.bandwidth == pytest.approx((1 + 2) * reflected / (2 * math.pi * 100.0), rel=0.05)
    assert margins.response(rig, settings, math.inf, [400.0]).llewellyn[0] < 0.5
    with pytest.raises(nt.Error, match="frequency"):
        margins.response(rig, settings, math.inf, [6e3])


def test_resolution_is_the_papers() -> None:
    """Sec. IV-C: N_p = 40 and 400, N_f = 66 (printed: 67) and 400 for steps of 10 and 1 nm; 500 of master and gauge."""
    for step, steps, forces in ((1e-9, 400, 400), (10e-9, 40, 66)):
        rig = nt.Rig(stage={"command_resolution": step, "resolution": step})
        found = margins.resolution(rig, nt.Settings.for_rig(rig), 0.4e-6)
        assert (round(found.slave_steps), round(found.force_steps)) == (steps, forces)
        assert (round(found.master_steps), round(found.gauge_steps)) == (500, 500)
        assert f"N_p = {steps}" in str(found)


def test_force_range_of_plan_and_test_touch() -> None:
    session = nt.Session()
    plan = margins.force_range(session.plan, highest=2.6e-6)
    assert plan.lowest == -session.plan.pull_off_force
    touch = margins.force_range(session.run())
    assert touch.lowest < 0.0 < touch.highest < 2.6e-6
    assert margins.heuristic_alpha_f(session.rig, touch) > margins.heuristic_alpha_f(session.rig, plan)
    assert margins.heuristic_alpha_f(session.rig, margins.ForceRange(-0.6e-6, 2.64e-6)) == pytest.approx(10 / 3.24e-6)
    with pytest.raises(nt.Error, match="empty"):
        margins.heuristic_alpha_f(session.rig, margins.ForceRange(1e-6, 1e-6))


def test_recording_gives_margins_energy_and_width() -> None:
    session = nt.Session()
    felt = margins.of_recording(session.run())
    assert felt.is_passive
    own = session.margins()
    assert felt.felt_stiffness == pytest.approx(own.loop_stiffness / 3.0, rel=0.15)  # the plan's stiffest, by chords
    assert felt.free_damping == pytest.approx(own.free_damping, rel=0.1)
    assert felt.margins.margin == pytest.approx(own.margin, rel=0.15)
    assert felt.dissipated[-1] > 0.0
    with pytest.raises(nt.Error, match="metadata"):
        margins.of_recording(nt.Recording({"time": [0.0, 1.0]}))


def test_limit_on_the_simulated_rig_is_the_exact_one() -> None:
    rig = nt.Rig()
    for rate in (300.0, 1e3, 5e3):
        limit = stability.simulated_limit(rig, nt.Settings.for_rig(rig), rate)
        assert limit.force_gain == pytest.approx(limit.exact, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("rate", [2e3, 5e3, 10e3])
@pytest.mark.parametrize("hand", [{}, {"damping": 3.0}, {"mass": 0.05}])
def test_limit_on_the_simulated_rig_with_hands(rate: float, hand: dict[str, float]) -> None:
    """Against the eigenvalues at the contact; the exact limit is for air as well, where a pad may give way earlier."""
    rig = nt.Rig(hand=hand)
    settings = nt.Settings.for_rig(rig)
    limit = stability.simulated_limit(rig, settings, rate, 3e8)
    settings["gains.rate"] = rate
    gains, k_c = settings.gains, rig.probe.spring_constant
    reflected = gains.alpha_f * gains.alpha_p * k_c / (1.0 + k_c / limit.contact_stiffness)
    assert radius(rig, settings, reflected, 0.98 * limit.force_gain) < 1.0
    assert radius(rig, settings, reflected, 1.02 * limit.force_gain) > 1.0
    assert limit.exact < 1.02 * limit.force_gain


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["margins", "--no-map", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    for word in ("R1 contact", "R5 noise", "Llewellyn", "Z-width", "N_p = 400", "verdict: armed"):
        assert word in said
    facts = json.loads((tmp_path / "margins.json").read_text())
    assert facts["refusal"] is None
    scene = tmp_path / "scene.toml"
    scene.write_text("[gains]\nforce_gain = 500\n")
    assert main(["margins", str(scene), "--rate", "1kHz", "--no-map", "--out", str(tmp_path), "--overwrite"]) == 1
    assert "REFUSED" in capsys.readouterr().out


def test_a_converter_slower_than_the_loop_costs_margin() -> None:
    rig = nt.Rig(converters={"adc_rate": 4e3})
    found = stability.simulated_limit(rig, nt.Settings.for_rig(rig), 10e3)
    assert 0.8 * found.force_gain < found.exact < found.force_gain  # the age goes to and fro, its largest is reckoned
    with pytest.raises(nt.Error, match=r"gains.rate = 10000 Hz: valid is 0 .. 6000 Hz"):
        nt.Session(rig=nt.Rig(converters={"adc_rate": 2e3}))
    with pytest.raises(nt.Error, match=r"gains.rate = 10000 Hz: valid is 0 .. 5000 Hz"):
        nt.Session(rig=nt.Rig(converters={"adc_latency": 0.4e-3}))


@pytest.mark.parametrize(
    ("periods", "latency"), [(2.4, 0.5), (2.9, 0.05), (1.5, 1.4), (2.2, 0.1), (2.99, 0.0), (2.0, 0.9)]
)
def test_a_session_that_is_armed_has_no_stale_samples(periods: float, latency: float) -> None:
    """A converter that repeats a sample for so many periods, with so many of latency: the first four armed at 10 kHz,
    and held in 9 to 33 % of the ticks."""
    converters = {"adc_rate": 10e3 / periods, "adc_latency": latency * 1e-4}
    rate = 10e3
    try:
        session = nt.Session(rig=nt.Rig(converters=converters), minimum_margin=0.0)
    except nt.Error as error:
        assert latency > 0.0
        assert "gains.rate = 10000 Hz" in str(error)  # noqa: PT017  some are refused, some not
        rate = 0.999 * float(str(error).split("0 .. ")[1].split(" ")[0])
        session = nt.Session(rig=nt.Rig(converters=converters), minimum_margin=0.0, rate=rate)
    columns = session.advance(0.2)
    assert columns["age"].max() <= 2.0 / rate * (1.0 + 1e-9)
    assert not np.any(columns["reasons"] & 8)


def test_force_range_sets_the_scale() -> None:
    rig, plan = nt.Rig(), nt.Scene().plan()
    span = margins.force_range(plan, 500e-9)
    alpha_f = margins.heuristic_alpha_f(rig, span)
    assert alpha_f * (span.highest - span.lowest) == pytest.approx(2.0 * rig.master.gauge_range)
    assert nt.Session(force_range=span).settings.gains.alpha_f == alpha_f
    with pytest.raises(nt.Error, match="force_range"):
        nt.Session(force_range=span, settings=nt.Settings.for_rig(rig))


def test_command_options_and_recordings(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ["--out", str(tmp_path), "--overwrite"]
    assert main(["margins", "--no-map", "--control", "paper", *out]) == 1
    assert "unstable without any contact" in capsys.readouterr().out
    assert main(["margins", "--no-map", "--control", "impedance", "--delay", "2ms", "--force-range", "plan", *out]) == 0
    facts = json.loads((tmp_path / "margins.json").read_text())
    assert facts["loop_delay"] == pytest.approx(0.8e-3 + 2 * 2e-3, abs=0.01e-3)
    session = nt.Session()
    recording = session.run()
    with nt.record.Writer(tmp_path / "made.mcap", session.metadata()) as writer:
        writer.append(recording.columns)
        writer.update(recording.metadata)
    assert main(["margins", str(tmp_path / "made.mcap"), *out]) == 0
    said = capsys.readouterr().out
    assert "verdict: passive" in said
    assert "z_width.png" in said
    assert main(["margins", str(tmp_path / "made.mcap"), "--rate", "1kHz", *out]) == 2
