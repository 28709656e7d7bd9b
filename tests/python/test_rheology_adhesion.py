# SPDX-License-Identifier: BSD-3-Clause
"""Adhesion on a sample that relaxes, against a foreign solution: Persson and Brener's integral by quadrature over the
complex modulus, the edge's motion by a stiff solver of ordinary differential equations."""

from __future__ import annotations

import re
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue

scipy_integrate = pytest.importorskip("scipy.integrate")
from scipy.optimize import brentq  # noqa: E402

RADIUS, WORK, STIFFNESS, NU = 5e-6, 2e-3, 0.05, 0.4
TIP = nt.geometry.Shape("paraboloid", radius=RADIUS)
SOLID = nt.Rheology.prony(2e4, [6e4, 3e4], [2e-4, 4e-3])


def ratio_at(s: float) -> float:
    """w_eff/w of an edge that crosses its process zone s times a second."""

    def loss(x: float) -> float:  # x = ln(w/wc)
        w = 2 * np.pi * s * np.exp(x)
        modulus = SOLID.equilibrium_modulus + sum(
            e * 1j * w * tau / (1 + 1j * w * tau)
            for e, tau in zip(SOLID.arm_moduli, SOLID.relaxation_times, strict=True)
        )
        return float(-(1 / modulus).imag * np.sqrt(1 - np.exp(2 * x)))

    found, _ = scipy_integrate.quad(loss, -30.0, 0.0, limit=200, epsabs=0.0, epsrel=1e-10)
    return float(1.0 / (1.0 - 2 / np.pi * SOLID.equilibrium_modulus * found))


def by_stiff_solver(speed: float, crack: float, top: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Base positions and forces of a retraction at one speed from an edge at rest."""
    modulus = SOLID.equilibrium_modulus / (1 - NU**2)
    grid = np.geomspace(1e-3, 1e7, 400)
    ratios = np.array([ratio_at(s) for s in grid])
    speeds = crack * ratios * grid

    def depth(a: float, base: float) -> float:
        return (STIFFNESS * base + 2 * modulus * a**3 / (3 * RADIUS)) / (STIFFNESS + 2 * modulus * a)

    def release(a: float, base: float) -> float:
        return modulus * (a * a / RADIUS - depth(a, base)) ** 2 / (2 * np.pi * a * WORK)

    def rate(time: float, a: np.ndarray) -> list[float]:
        g = release(a[0], top - speed * time)
        if g <= 1.0:
            return [0.0]
        return [-float(np.exp(np.interp(np.log(g - 1), np.log(ratios - 1), np.log(speeds))))]

    start = brentq(lambda a: release(a, top) - 1.0, np.sqrt(RADIUS * depth(0.0, 0.0)) + 8e-7, 8e-6)

    def lost(time: float, a: np.ndarray) -> float:
        return float(a[0] - 1e-7)

    lost.terminal = True  # type: ignore[attr-defined]
    times = np.linspace(0.0, (top - end) / speed, 800)
    found = scipy_integrate.solve_ivp(
        rate, (0.0, times[-1]), [start], method="LSODA", t_eval=times, events=lost, rtol=1e-8, atol=1e-13
    )
    bases = top - speed * found.t
    forces = [2 * modulus * a * (depth(a, b) - a * a / (3 * RADIUS)) for a, b in zip(found.y[0], bases, strict=True)]
    return bases, np.array(forces)


@pytest.mark.parametrize("speed", [2e-8, 2e-6])
def test_a_retraction_is_that_of_a_foreign_solver(speed: float) -> None:
    top, end = 1e-6, -4e-6
    bases, forces = by_stiff_solver(speed, 1e-9, top, end)
    slow = np.concatenate([np.linspace(-1e-7, top, 100), np.full(100, top), bases[1:]])
    step = np.concatenate([np.full(99, 10.0), np.full(100, 10.0), -np.diff(bases) / speed])  # at rest before it turns
    ours = SOLID.force(
        np.concatenate([[0.0], np.cumsum(step)])[: slow.size],
        slow,
        TIP,
        poisson_ratio=NU,
        spring_constant=STIFFNESS,
        work_of_adhesion=WORK,
        crack_length=1e-9,
    )
    found = ours.force[199:]
    scale = np.abs(forces).max()
    assert -forces.min() > 1.2 * 1.5 * np.pi * WORK * RADIUS  # the edge does lose something
    assert -found.min() == pytest.approx(-forces.min(), rel=5e-3)
    np.testing.assert_allclose(found[:-20], forces[:-20], atol=0.01 * scale)  # the last points are of the jump


def test_what_is_not_known_is_refused() -> None:
    time, base = np.linspace(0.0, 1.0, 50), np.linspace(-1e-8, 1e-8, 50)
    edge = {"work_of_adhesion": 1e-3, "crack_length": 1e-9}
    with pytest.raises(InvalidValue, match="power_law with adhesion: E_0/E_inf must be finite"):
        nt.Rheology.power_law(1e4, 0.2).force(time, base, TIP, **edge)
    with pytest.raises(InvalidValue, match="cone with adhesion"):
        SOLID.force(time, base, nt.geometry.Shape("cone", half_angle=0.5), **edge)
    with pytest.raises(InvalidValue, match="derivatives with adhesion"):
        SOLID.force(time, base, TIP, derivatives=True, **edge)
    with pytest.raises(InvalidValue, match=r"time\[49\] = 0.979.* s: it must be above time\[48\] = 0.979"):
        SOLID.force(np.append(time[:-1], time[-2]), base, TIP, **edge)
    with pytest.raises(InvalidValue, match="crack_length"):
        SOLID.force(time, base, TIP, work_of_adhesion=1e-3)
    with pytest.raises(InvalidValue, match="work_of_adhesion"):
        SOLID.force(time, base, TIP, work_of_adhesion=float("nan"), crack_length=1e-9)
    with pytest.raises(InvalidValue, match=r"speed = .* m/s"):
        SOLID.force(1e-3 * time, 1e2 * base, TIP, **edge)


def test_the_examples_of_the_page_run(capsys: pytest.CaptureFixture[str]) -> None:
    page = Path(__file__).parents[2].joinpath("docs/rheology.md").read_text(encoding="utf-8")
    blocks = [block for block in re.findall(r"```python\n(.*?)```", page, re.S) if "curves.read" not in block]
    exec("\n".join(blocks), {})
    pull_off = float(capsys.readouterr().out.split()[-1])
    assert 1.0 < pull_off < 10.0  # between rest and E_0/E_inf
