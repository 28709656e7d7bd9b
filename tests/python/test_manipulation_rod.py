# SPDX-License-Identifier: BSD-3-Clause
"""A rod that is pushed: beside the balance of evenly spread friction in closed form, and beside the least power of any
motion (scipy), which knows no springs, no steps and no energies; its account of energy on random paths."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.manipulation import Rod, turning_point
from scipy.integrate import quad
from scipy.optimize import brentq, minimize

WIRE: dict[str, Any] = {
    "length": 2e-6, "radius": 50e-9, "effective_modulus": 70e9, "effective_shear_modulus": 10e9,
    "work_of_adhesion": 0.05, "shear_strength": 10e6, "tip_radius": 25e-9, "step": 1e-9,
}  # fmt: skip
BESIDE = 75e-9  # the tip touches here


def test_friction_is_that_of_a_cylinder_without_load() -> None:
    """Where pi E* b^2/(4 R) = sqrt(2 pi E* b w), found by a bracket; tau on its width."""
    wire = Rod(**WIRE)
    load = lambda b: math.pi * 70e9 * b * b / (4 * 50e-9) - math.sqrt(2 * math.pi * 70e9 * b * 0.05)  # noqa: E731
    b = brentq(load, 1e-10, 1e-8, xtol=1e-24)
    assert wire.half_width == pytest.approx(b, rel=1e-9)
    assert wire.friction == pytest.approx(2 * b * 10e6, rel=1e-9)


@pytest.mark.parametrize("arm", [0.99, 0.6, 0.2, 0.02])
def test_it_turns_about_the_published_point(arm: float) -> None:
    """Pushed at an arm of L/2 times this: forces and torque of an even friction balance at c; the push is 2 q c."""
    wire = Rod(**WIRE, elements=400)  # the point lies within half of one
    at = 0.5 * wire.length * arm
    path = wire.run(at, np.linspace(-BESIDE, -BESIDE + 12e-9, 25), state=wire.place(0.0, 0.0, 0.0, (at, -BESIDE)))
    c = turning_point(wire.length, at)
    late = slice(-6, None)
    way, turn = np.diff(path.position[late, 1]), np.diff(path.angle[late])
    assert np.mean(way / turn) == pytest.approx(c, rel=0.01)  # it has turned by 0.01
    assert -path.force[-1, 1] == pytest.approx(2.0 * wire.friction * c, rel=2e-3)


def test_a_push_on_the_middle_does_not_turn_it_and_one_on_the_end_slides_it_along() -> None:
    wire = Rod(**WIRE)
    across = wire.run(0.0, np.linspace(-BESIDE, 0.0, 76), state=wire.place(0.0, 0.0, 0.0, (0.0, -BESIDE)))
    assert across.angle[-1] == pytest.approx(0.0, abs=1e-6)
    assert across.force[-1] == pytest.approx([0.0, -wire.friction * wire.length, 0.0], rel=1e-6, abs=1e-15)
    end = 0.5 * wire.length + BESIDE * (1.0 + 1e-12)
    along = wire.run(np.linspace(end, end - 50e-9, 51), 0.0, state=wire.place(0.0, 0.0, 0.0, (end, 0.0)))
    assert along.force[-1] == pytest.approx([wire.friction * wire.length, 0.0, 0.0], rel=1e-6, abs=1e-15)
    assert along.position[-1, 0] == pytest.approx(-50e-9, abs=3e-9)  # less what the contact yields


def least_power(length: float, arm: float, friction: float) -> tuple[float, Any]:
    """Of all plane motions whose point at the arm goes by 1 across the rod, the one that makes least heat: the force
    there, and the motion (along, across, turn)."""

    def power(free: Any) -> float:
        along, turn = free
        across = 1.0 - turn * arm
        speed = lambda s: math.hypot(along, across + turn * s)  # noqa: E731
        zero = -across / turn if turn else math.inf
        return friction * quad(speed, -length / 2, length / 2, points=[zero] if abs(zero) < length / 2 else None)[0]

    found = minimize(power, [0.0, 0.5 / length], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-14})
    return float(found.fun), (found.x[0], 1.0 - found.x[1] * arm, found.x[1])


def test_beside_the_least_power_of_any_motion() -> None:
    wire = Rod(**WIRE, elements=400)
    at = 0.7e-6
    path = wire.run(at, np.linspace(-BESIDE, -BESIDE + 8e-9, 17), state=wire.place(0.0, 0.0, 0.0, (at, -BESIDE)))
    force, (along, across, turn) = least_power(2.0, 0.7, 1.0)  # in micrometres, friction 1
    assert -path.force[-1, 1] / wire.friction * 1e6 == pytest.approx(force, rel=2e-3)
    moved = np.diff(path.position[-6:], axis=0).sum(axis=0)
    turned = float(path.angle[-1] - path.angle[-6]) * 1e-6
    assert turned / moved[1] == pytest.approx(turn / across, rel=0.01)
    assert abs(moved[0] / moved[1]) < 0.01
    assert abs(along / across) < 1e-3


def test_energy_is_kept_on_random_paths() -> None:
    """Round a rod, against it, off its ends: stored + dissipated = work; heat never falls; work within the forces."""
    rng = np.random.default_rng(1)
    worst, pushed, wires = 0.0, 0, int(os.environ.get("NANOTOUCH_ROD_WIRES", "2"))
    for _ in range(wires):
        made = {**WIRE, "length": 10 ** rng.uniform(-6.6, -6.2), "shear_strength": 10 ** rng.uniform(6, 7.3)}
        wire = Rod(**{**made, "tip_stiffness": 10 ** rng.uniform(1.5, 2.3), "elements": 24, "step": 2e-9})
        state = wire.place(0.0, 0.0, float(rng.uniform(0, 6)), (wire.length, wire.length))
        heat, turnover = 0.0, 0.0
        for _ in range(3):
            to = state.pose[:2] + 0.3 * wire.length * rng.standard_normal(2)
            share = np.linspace(0.0, 1.0, 20)[1:, None]
            begun = state
            path = wire.run(*(begun.tip[:2] + share * (to - begun.tip[:2])).T, state=begun)
            state = path.state
            assert (np.diff(path.dissipated, prepend=heat) >= 0.0).all()
            assert (path.stored >= 0.0).all()
            turnover += float(np.abs(np.diff(path.work, prepend=begun.work)).sum())
            worst = float(
                np.maximum(
                    worst, float(np.abs(path.stored + path.dissipated - path.work).max()) / np.maximum(turnover, 1e-30)
                )
            )
            heat = float(path.dissipated[-1])
        pushed += heat > 0.0
    print(f"{wires} wires: stored + dissipated beside the work within {worst:.2g} of the turnover")
    assert worst < 1e-12
    assert pushed > 0.4 * wires


def test_the_same_path_in_parts_and_from_a_kept_state() -> None:
    """States are values: one that is gone back to gives the same bits."""
    wire = Rod(**WIRE)
    y = np.linspace(-BESIDE, -BESIDE + 20e-9, 21)
    whole = wire.run(0.4e-6, y, state=wire.place(0.0, 0.0, 0.0, (0.4e-6, -BESIDE)))
    half = wire.run(0.4e-6, y[:10], state=wire.place(0.0, 0.0, 0.0, (0.4e-6, -BESIDE))).state
    for _ in range(2):
        rest = wire.run(0.4e-6, y[10:], state=half)
        np.testing.assert_array_equal(rest.state.pose, whole.state.pose)
        np.testing.assert_array_equal(rest.state.pulls, whole.state.pulls)


def test_more_elements_and_shorter_steps_change_little() -> None:
    paths = []
    for elements, step in ((25, 1e-9), (100, 1e-9), (400, 0.25e-9)):
        wire = Rod(**{**WIRE, "elements": elements, "step": step})
        y = np.linspace(-BESIDE, -BESIDE + 40e-9, 41)
        paths.append(wire.run(0.6e-6, y, state=wire.place(0.0, 0.0, 0.0, (0.6e-6, -BESIDE))))
    few, coarse, fine = paths
    for path, turn in ((few, 0.03), (coarse, 5e-3)):
        assert path.force[-1, 1] == pytest.approx(fine.force[-1, 1], rel=2e-3)
        assert path.angle[-1] == pytest.approx(fine.angle[-1], rel=turn)


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [("length", 100e-9, "4 radii"), ("elements", 4, "8 .. 400"), ("work_of_adhesion", 0.0, "work_of_adhesion"),
     ("shear_strength", float("nan"), "shear_strength"), ("tip_stiffness", 0.1, "does not go through"),
     ("work_of_adhesion", 1e4, "half_width")],
)  # fmt: skip
def test_what_is_no_rod_is_refused(field: str, value: float, message: str) -> None:
    with pytest.raises(InvalidValue, match=message):
        Rod(**{**WIRE, field: value})


def test_wrong_ways_are_refused() -> None:
    wire = Rod(**WIRE)
    with pytest.raises(InvalidValue, match="touches the rod: begin beside it"):
        wire.place(0.0, 0.0, 0.0, (0.0, 0.0))
    with pytest.raises(InvalidValue, match="valid are numbers"):
        wire.place(0.0, math.nan, 0.0, (0.0, 1e-6))
    with pytest.raises(InvalidValue, match="valid are numbers"):
        wire.run(math.inf, 0.0, state=wire.place(0.0, 0.0, 0.0, (0.0, 1e-6)))
    with pytest.raises(InvalidValue, match="half of the length"):
        turning_point(1e-6, 0.6e-6)
