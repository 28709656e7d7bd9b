# SPDX-License-Identifier: BSD-3-Clause
"""Tapping in the time domain against another integrator; what is refused."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.scan.tapping import Drive, Tapping, TappingState

A0, K, Q, F0 = 20e-9, 40.0, 50.0, 300e3


def bare() -> nt.Scene:
    """Hertz: a tip of 10 nm on 1 GPa that nothing attracts."""
    scene = nt.Scene(tip={"radius": 10e-9}, sample={"youngs_modulus": 1e9})
    scene.medium.relative_humidity = scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0
    return scene


def lever(quality: float = Q) -> nt.Rig:
    return nt.Rig(probe={"spring_constant": K, "quality": quality, "resonance": F0})


@pytest.mark.parametrize("at", ["tip", "base"])
def test_a_multistep_integrator_gives_the_same_motion(at: str) -> None:
    """LSODA of scipy on Hertz' closed form, which knows nothing of plan, lock-in or drive."""
    integrate = pytest.importorskip("scipy.integrate")
    plan, rig = bare().plan(), lever()
    tapping = Tapping(plan, rig, Drive(drive={"at": at, "free_amplitude": A0}), tolerance=1e-12)
    modulus = plan.explain()["effective_modulus"]
    hertz = 4.0 / 3.0 * modulus * math.sqrt(10e-9)
    strength = A0 / Q if at == "tip" else A0 / math.hypot(Q, 1.0)

    def slope(t: float, y: np.ndarray) -> list[float]:
        q, v = y  # over A0, t in 1/w0
        force = hertz * max(0.0, -(15e-9 + A0 * q)) ** 1.5
        return [v, -q - v / Q + force / K / A0 + strength / A0 * math.cos(t)]

    state = tapping.free()
    periods = 8
    times = 2.0 * math.pi * np.arange(periods * 512 + 1) / 512
    solved = integrate.solve_ivp(
        slope, (0.0, times[-1]), [state.position / A0, state.speed / A0], "LSODA", times, rtol=1e-12, atol=1e-13,
        max_step=0.1,
    )  # fmt: skip
    after, _ = tapping.run(state, 15e-9, periods - 1)
    end, value = tapping.run(after, 15e-9)
    assert end.position / A0 == pytest.approx(solved.y[0, -1], abs=1e-7)
    assert end.speed / A0 == pytest.approx(solved.y[1, -1], abs=1e-7)
    last, angle = A0 * solved.y[0, -513:], times[:513]
    deflection = last - (strength * np.cos(angle) if at == "base" else 0.0)
    samples = deflection * np.exp(1j * angle)
    locked = 2.0 * np.mean(0.5 * (samples[1:] + samples[:-1]))
    assert value.amplitude == pytest.approx(abs(locked), rel=1e-6)
    assert value.phase == pytest.approx(np.angle(locked), abs=1e-6)
    assert value.peak_force == pytest.approx(hertz * max(0.0, -(15e-9 + last.min())) ** 1.5, rel=1e-3)  # of 512 samples


def test_a_driven_base_differs_from_a_driven_tip_as_it_should() -> None:
    """q = D/(1 - r^2 + i r/Q); the deflection of a driven base lacks D: at Q = 10 the lag differs by atan(1/Q)."""
    plan = bare().plan()
    values = {}
    for at in ("tip", "base"):
        tapping = Tapping(plan, lever(10.0), Drive(drive={"at": at, "free_amplitude": A0}))
        values[at] = tapping.run(tapping.free(), 1e-6)[1]
    assert values["tip"].phase == pytest.approx(math.pi / 2, abs=1e-8)
    assert values["base"].phase - values["tip"].phase == pytest.approx(math.atan(0.1), abs=1e-8)


def test_a_lever_that_one_mode_does_not_describe_is_refused_in_words() -> None:
    with pytest.raises(InvalidValue, match=r"probe\.quality = 4: valid is 10"):
        Tapping(bare().plan(), lever(4.0))
    with pytest.raises(InvalidValue, match=r"drive\.frequency"):
        Tapping(bare().plan(), lever(), Drive(drive={"frequency": 5e6}))


def test_periods_and_states() -> None:
    tapping = Tapping(bare().plan(), lever())
    assert isinstance(tapping.free(), TappingState)
    with pytest.raises(InvalidValue, match="periods = 0"):
        tapping.run(tapping.free(), 1e-8, 0)
    one = tapping.run(*(tapping.free(), 15e-9, 7))
    other = tapping.run(tapping.run(tapping.free(), 15e-9, 3)[0], 15e-9, 4)
    assert one[0].position == pytest.approx(other[0].position, abs=1e-7 * A0)


def test_the_harmonics_above_the_first_move_the_lowest_point() -> None:
    """Harmonic balance: the force at 2 w .. 40 w on the lever's compliance there, again and again, from the amplitude
    alone. It finds the lowest gap, peak and mean force of the time domain. With one harmonic, as the slow flow has it,
    the tip would be a tenth higher above its deepest place, with a peak force a fifth less."""
    scene = nt.Scene(tip={"radius": 11.89e-9}, sample={"youngs_modulus": 2.884e9})
    scene.medium.relative_humidity = 0.345
    plan, k, quality, height = scene.plan(), 8.313, 403.0, 5.57e-9
    rig = nt.Rig(probe={"spring_constant": k, "quality": quality, "resonance": F0})
    tapping = Tapping(plan, rig, Drive(drive={"at": "tip", "free_amplitude": 9.478e-9}), tolerance=1e-8)
    settled = tapping.settle(height)
    truth, angle = settled.value, 2.0 * np.pi * np.arange(4096) / 4096
    assert settled.settled
    assert truth.contact_time > 0.1
    waves = np.exp(1j * np.arange(2, 41)[:, None] * angle)
    answer = 2.0 / k / (1.0 - np.arange(2, 41) ** 2 + 1j * np.arange(2, 41) / quality) / angle.size
    higher, mean, lowest = np.zeros(39, complex), truth.mean, []
    for _ in range(16):
        way = mean + truth.amplitude * np.cos(angle) + (higher @ waves).real
        force = np.asarray(plan.force(np.tile(height + way, 2)))[angle.size :]
        lowest.append(((height + way).min(), force.max()))
        higher = 0.5 * (higher + answer * (waves.conj() @ force))
        mean = 0.5 * (mean + force.mean() / k)
    assert lowest[-1] == pytest.approx((truth.lowest_gap, truth.peak_force), rel=1e-3)
    assert force.mean() == pytest.approx(truth.mean_force, rel=1e-2)  # a small rest of attraction and repulsion
    assert lowest[0][0] > 0.93 * truth.lowest_gap
    assert lowest[0][1] < 0.85 * truth.peak_force
