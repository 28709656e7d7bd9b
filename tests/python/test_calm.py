# SPDX-License-Identifier: BSD-3-Clause
"""Calm: the ripple that is foretold against that on the simulated rig, what calms a loop, the words; the loop's
frequency response against a master that is moved to and fro, period by period."""

from __future__ import annotations

import importlib.util
import math
from pathlib import Path
from typing import Any

import draws
import nanotouch as nt
import numpy as np
import pytest
from nanotouch import margins
from nanotouch_app.touching import margins as command

HEAVY = Path(__file__).parents[1] / "heavy" / "calm.py"


def heavy() -> Any:
    """The program with the sampler."""
    spec = importlib.util.spec_from_file_location("heavy_calm", HEAVY)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def scaled(alpha_p: float, alpha_f: float | None = None) -> tuple[nt.Rig, nt.Settings, float]:
    """The default rig with other scales, on its stiffest contact."""
    rig, scene = nt.Rig(), nt.Scene()
    settings = nt.session.settings_for_path(rig, load=scene.range.maximum_load)
    settings["gains.alpha_p"] = alpha_p
    if alpha_f is not None:
        settings["gains.alpha_f"] = alpha_f
    return rig, settings, scene.plan().maximum_stiffness


@pytest.mark.parametrize(("alpha_p", "alpha_f"), [(2e-5, None), (1e-4, None), (3e-4, None), (2e-5, 1.8e7)])
def test_ripple_of_the_default_rig_is_foretold(alpha_p: float, alpha_f: float | None) -> None:
    rig, settings, stiffness = scaled(alpha_p, alpha_f)
    found = margins.calm(rig, settings, stiffness)
    run = heavy().touched(heavy().Rig(rig, settings, found))
    assert 0.5 * found.ripple < run.ripple < 1.2 * found.ripple
    assert not (run.bounced)
    assert not (run.stopped)
    assert not (run.tripped)
    assert found.is_calm == (run.ripple < margins.CLEARLY_FELT)


def test_stable_is_not_calm() -> None:
    """alpha_p = 1e-3 on the default rig has a margin of 1.64; each step of its master is 1 N at the hand."""
    rig, settings, stiffness = scaled(1e-3)
    assert margins.compute(rig, settings, stiffness).least > 1.6
    found = margins.calm(rig, settings, stiffness)
    assert found.rule == "ripple"
    assert found.ripple > 1.0
    assert found.least < 0.3
    assert "NOT CALM" in str(found)
    assert "steps of the master" in str(found)
    name, _, value = found.change.split(" ")[:3]
    settings[name] = float(value)
    assert margins.calm(rig, settings, stiffness).is_calm
    settings[name] = 2.0 * float(value)
    assert not margins.calm(rig, settings, stiffness).is_calm


@pytest.mark.parametrize(("field", "value"), [("master.resolution", 4e-3), ("stage.command_resolution", 3e-8),
                                              ("stage.resolution", 3e-7), ("probe.noise", 1.0)])  # fmt: skip
def test_the_source_is_named(field: str, value: float) -> None:
    rig, settings, stiffness = scaled(2e-5)
    rig[field] = value
    found = margins.calm(rig, settings, stiffness)
    name = max(found.facts().items(), key=lambda fact: fact[1] if fact[0].startswith("ripple of") else -1.0)[0]
    assert name == f"ripple of {field}"
    assert not found.is_calm


def test_a_heavy_master_rings_and_a_slow_stage_slews() -> None:
    rig, settings, stiffness = scaled(2e-5)
    rig["master.mass"], rig["master.damping"], rig["master.resolution"] = 0.5, 10.0, 1e-7
    found = margins.calm(rig, settings, stiffness)
    kappa = margins.compute(rig, settings, stiffness).loop_stiffness
    assert found.rule == "ringing"
    assert found.ringing == pytest.approx(math.sqrt(kappa * 0.5) / 10.0, rel=0.15)  # 1/(2 zeta)
    rig, settings, stiffness = scaled(2e-4)
    settings["limits.stage_speed"] = 1e-7  # 8 nm take 80 ms
    found = margins.calm(rig, settings, stiffness)
    assert found.rule == "slewing"
    assert found.least < 0.2


def test_a_stage_with_little_damping_keeps_time_with_its_steps() -> None:
    """A limit cycle at the stage's own resonance: white steps, or a whole one, foretold 0.18 N."""
    rig, settings, stiffness = scaled(2e-5, 6e6)
    rig["stage.resonance"], rig["stage.quality"], rig["stage.command_resolution"] = 100.0, 40.0, 0.5e-9
    rig["stage.resolution"], rig["master.resolution"], rig["probe.noise"] = 1e-11, 1e-6, 5e-3
    settings["gains.rate"], settings["gains.delay"] = 3e3, 3.0
    assert margins.compute(rig, settings, stiffness).least > 5.0
    found = margins.calm(rig, settings, stiffness)
    run = heavy().touched(heavy().Rig(rig, settings, found))
    assert margins.CLEARLY_FELT < run.ripple < found.ripple
    assert not found.is_calm
    assert "steps of the stage's command" in str(found)


def test_nothing_is_felt_where_no_loop_closes() -> None:
    rig, settings, stiffness = scaled(2e-5)
    assert margins.calm(nt.Rig(master={"motor": 0.0, "gauge": 0.0}), settings, stiffness).is_calm
    assert margins.calm(rig, settings, 0.0).least == math.inf
    settings["gains.delay"] = 1000.0
    assert not math.isnan(margins.calm(rig, settings, stiffness).least)


def test_random_rigs_that_are_called_calm_are_calm() -> None:
    """Six of those of tests/heavy/calm.py, which takes as many as one likes."""
    module = heavy()
    seen = 0
    for seed in range(1000, 1020):
        one = module.drawn(seed)
        if one is None or not one.calm.is_calm or seen == 6:
            continue
        seen += 1
        run = module.touched(one)
        assert (run.bounced, run.stopped, run.tripped) == (False, False, False), f"seed {seed}"
        assert not run.ripple > margins.CLEARLY_FELT, f"seed {seed}: {run.ripple} N"
    assert seen >= 4


def moved_master(rig: nt.Rig, settings: nt.Settings, reflected: float, frequency: float) -> complex:
    """Z = f_m/x_m' of a master that is moved as cos(w t), from the touch step's own sums, one period after another."""
    linalg = pytest.importorskip("scipy.linalg")
    gains, period, delay = settings.gains, 1.0 / settings.gains.rate, int(settings.gains.delay)
    wn = 2.0 * math.pi * rig.stage.resonance
    block = np.zeros((3, 3))
    block[0, 1], block[1] = 1.0, [-(wn**2), -wn / rig.stage.quality, wn**2]
    exact = linalg.expm(block * period)
    angle = wn * period
    bare, wanted = (
        np.poly(np.exp(angle * np.roots([1.0, 2.0 * zeta, 1.0]))).real
        for zeta in (0.5 / rig.stage.quality, gains.stage_damping)
    )
    b, a = bare * wanted.sum() / bare.sum(), wanted
    share = -math.expm1(-2.0 * math.pi * gains.force_filter * period)
    w, count = 2.0 * math.pi * frequency, round(gains.rate / frequency)
    stage, memory, correction, smooth = np.zeros(2), [0.0, 0.0], 0.0, 0.0
    motor, command = [0.0] * (delay + 1), [0.0] * (delay + 1)
    phasor = 0j
    turns = 12 + round(0.3 * frequency)  # the stage's integral has settled
    for k in range(turns * count):
        t = k * period
        x, v, acceleration = math.cos(w * t), -w * math.sin(w * t), -(w**2) * math.cos(w * t)
        felt = rig.master.mass * acceleration + rig.master.damping * v - motor[0]  # held until now
        smooth += share * (felt - smooth)
        correction += gains.stage_integral * period * (x - stage[0])
        into = x + correction
        out = b[0] * into + memory[0]
        memory = [b[1] * into - a[1] * out + memory[1], b[2] * into - a[2] * out]
        motor.append(-(1.0 + gains.force_gain) * reflected * stage[0] + gains.force_gain * smooth)
        command.append(out)
        motor.pop(0), command.pop(0)
        if k >= (turns - 4) * count:  # the first harmonic of a force that is held over the period
            phasor += motor[0] * (np.exp(-1j * w * t) - np.exp(-1j * w * (t + period))) / (1j * w)
        stage = exact[:2, :2] @ stage + exact[:2, 2] * command[0]
    tau = 2.0 * phasor / (4 * count * period)
    own = rig.master.damping * 1j * w - rig.master.mass * w**2
    return complex((own - tau) / (1j * w))


@pytest.mark.parametrize("force_gain", [0.0, 3.0])
@pytest.mark.parametrize("delay", [0.0, 3.0])
def test_response_is_that_of_a_master_that_is_moved(force_gain: float, delay: float) -> None:
    rig, settings, _ = scaled(2e-4)
    settings["gains.force_gain"], settings["gains.delay"] = force_gain, delay
    k_c = rig.probe.spring_constant
    for frequency in draws.some((250.0, 1250.0, 20.0, 200.0), 2):
        for stiffness in (0.0, 30.0):
            reflected = settings.gains.alpha_f * settings.gains.alpha_p * stiffness * k_c / (stiffness + k_c)
            found = complex(margins.response(rig, settings, stiffness, frequency).impedance[0])
            assert found == pytest.approx(moved_master(rig, settings, reflected, frequency), rel=1e-6)


def test_above_some_frequency_the_low_pass_gives_energy() -> None:
    """In air Re Z < 0 where m w_c K_f - b > 0 and (w/w_c)^2 > b (1 + K_f)/(m w_c K_f - b), delays aside; without K_f
    nowhere."""
    rig, settings, _ = scaled(2e-5)
    settings["gains.rate"], settings["gains.delay"] = 500e3, 0.0
    corner = 2.0 * math.pi * settings.gains.force_filter
    expected = settings.gains.force_filter * math.sqrt(300.0 / (0.1 * corner * 2.0 - 100.0))
    assert margins.compute(rig, settings, 1e-9).passive_up_to == pytest.approx(expected, rel=0.03)
    settings["gains.force_gain"] = 0.0
    assert margins.compute(rig, settings, 1e-9).passive_up_to == 250e3
    rig, settings, stiffness = scaled(2e-5)
    found = margins.compute(rig, settings, stiffness)
    assert 200.0 < found.passive_up_to < 260.0
    real = margins.response(rig, settings, stiffness, [0.99 * found.passive_up_to, 1.01 * found.passive_up_to])
    assert real.impedance.real[0] > 0.0 > real.impedance.real[1]


def test_where_r1_is_too_much_the_exact_limit_decides() -> None:
    """A spring of the hand on a light master: R1 knows nothing of it, and the words say so."""
    rig, settings, stiffness = scaled(2e-5)
    settings["gains.rate"], rig["hand.mass"], settings["gains.force_gain"] = 1e3, 0.03, 3.0
    rig["stage.resonance"] = 445.0
    for share in np.geomspace(440.0, 900.0, 60):  # below twice the stage's resonance
        settings["gains.rate"] = float(share)
        found = margins.compute(rig, settings, stiffness)
        if 0.0 < found.exact_limit < found.stability_limit:
            break
    else:
        pytest.fail("no such rate")
    text = command.words(found, margins.resolution(rig, settings, 0.4e-6), settings, rig)
    assert "TOO MUCH by a factor of" in text
    assert "the exact limit decides" in text
    assert found.least < found.margin
