# SPDX-License-Identifier: BSD-3-Clause
"""The tip of a rod in its true height: beside the least distance of a segment and a cone (scipy), on a lever, over the
top; the account of energy of any pose."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nanotouch.errors import Error, InvalidValue
from nanotouch.manipulation import Rod, RodPath
from numpy.typing import NDArray
from scipy.optimize import minimize

L, R = 1e-6, 50e-9
Floats = NDArray[np.float64]


def wire(radius: float = 30e-9, half_angle: float = 0.3, **kwargs: float) -> Rod:
    return Rod(L, R, 70e9, 10e9, 0.05, 1e6, radius, half_angle, **kwargs)  # type: ignore[arg-type]


def nearest(radius: float, half_angle: float, tip: Floats, pose: tuple[float, float, float]) -> tuple[float, Floats]:
    """Least distance of the axis from the cone of the middles of spheres that fill the tip, by descent, in um; and the
    way from the one to the other."""
    x, y, angle = pose
    apex = np.array([tip[0], tip[1], tip[2] + radius])

    def way(free: Floats) -> Floats:
        along, height, turn = free
        axis = np.array([x + along * L * math.cos(angle), y + along * L * math.sin(angle), R])
        wide = height * math.tan(half_angle)
        return (axis - apex) * 1e6 - np.array([wide * math.cos(turn), wide * math.sin(turn), height])

    least = min(
        (minimize(lambda free: float(np.linalg.norm(way(free))), [along, height, turn], method="L-BFGS-B",
                  bounds=[(-0.5, 0.5), (0.0, 3.0), (-10.0, 10.0)], options={"ftol": 1e-15, "gtol": 1e-12})
         for along in (-0.4, 0.0, 0.4) for height in (0.0, 0.05) for turn in (0.0, 2.1, 4.2)),
        key=lambda found: float(found.fun),
    )  # fmt: skip
    return float(least.fun) * 1e-6, way(least.x) / float(least.fun)


@settings(max_examples=25, deadline=None)
@given(
    st.floats(-0.7e-6, 0.7e-6), st.floats(-0.2e-6, 0.2e-6), st.floats(0.0, 130e-9), st.floats(0.0, 3.1),
    st.sampled_from([10e-9, 30e-9, 120e-9]), st.sampled_from([0.0, 0.2, 0.7]),
)  # fmt: skip
def test_it_touches_where_a_segment_is_near_a_cone(
    x: float, y: float, z: float, angle: float, radius: float, half_angle: float
) -> None:
    rod, tip, pose = wire(radius, half_angle), np.array([x, y, z]), (0.1e-6, 0.05e-6, angle)
    distance, _ = nearest(radius, half_angle, tip, pose)
    if abs(distance - R - radius) < 1e-4 * R:
        return
    if distance < R + radius:
        with pytest.raises(InvalidValue, match="touches the rod: begin beside it"):
            rod.place(*pose, tip=(x, y, z))
    else:
        assert rod.place(*pose, tip=(x, y, z)).force.tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("half_angle", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("z", [0.0, 30e-9, 80e-9])
@pytest.mark.parametrize(("x", "angle"), [(0.2e-6, 0.1), (0.5e-6, 0.4)])
def test_it_presses_along_the_normal(half_angle: float, z: float, x: float, angle: float) -> None:
    """At its side and at its end, low, at its middle, above: the force is along the shortest way, and its size is the
    stiffness times the depth."""
    rod = wire(half_angle=half_angle)
    path = rod.run(x, np.linspace(-0.4e-6, 0.4e-6, 801), z, state=rod.place(0.0, 0.0, angle, (x, -0.4e-6, z)))
    size = np.linalg.norm(path.force, axis=1)
    row = int(np.argmax(size > 0.5 * size.max()))
    pose = (float(path.position[row, 0]), float(path.position[row, 1]), float(path.angle[row]))
    distance, normal = nearest(30e-9, half_angle, path.tip[row], pose)
    np.testing.assert_allclose(path.force[row] / size[row], -normal, atol=1e-4)
    assert size[row] == pytest.approx(100.0 * (R + 30e-9 - distance), abs=1e-4 * 100.0 * R * 0.05)


def test_a_flank_lifts_by_its_slope_and_a_push_is_the_sum_of_friction() -> None:
    """On the middle: q L sideways, and tan psi of it up; at an end, along: the same."""
    rod = wire(half_angle=0.4)
    path = rod.run(0.0, np.linspace(-0.2e-6, 0.1e-6, 301), 10e-9, state=rod.place(0, 0, 0, (0.0, -0.2e-6, 10e-9)))
    assert path.force[-1] == pytest.approx(rod.friction * L * np.array([0.0, -1.0, math.tan(0.4)]), rel=1e-6, abs=1e-16)


def test_a_lever_lags_by_the_push_over_its_stiffness() -> None:
    held, hung = wire(), wire(lever=2.0)
    y = np.linspace(-0.2e-6, 0.1e-6, 301)
    stiff, soft = (rod.run(0.0, y, 10e-9, state=rod.place(0, 0, 0, (0.0, -0.2e-6, 10e-9))) for rod in (held, hung))
    assert soft.force[-1] == pytest.approx(stiff.force[-1], rel=1e-6, abs=1e-15)
    assert y[-1] - soft.tip[-1, 1] == pytest.approx(held.friction * L / 2.0, rel=1e-6)
    assert stiff.position[-1, 1] - soft.position[-1, 1] == pytest.approx(held.friction * L / 2.0, rel=1e-3)
    back = hung.run(0.0, y[::-1], 10e-9, state=soft.state)
    assert back.force[-1].tolist() == [0.0, 0.0, 0.0]
    assert back.tip[-1] == pytest.approx([0.0, -0.2e-6, 10e-9], abs=1e-18)
    assert back.dissipated[-1] + back.stored[-1] == pytest.approx(back.work[-1], rel=1e-12)


def test_over_the_top_it_is_not_pushed() -> None:
    """A tip that is higher than rod and contact passes; one that grazes the top is lifted, and pushes hardly."""
    rod = wire(half_angle=0.0)
    y = np.linspace(-0.2e-6, 0.2e-6, 401)
    high = rod.run(0.0, y, 2.0 * R + 1e-12, state=rod.place(0, 0, 0, (0.0, -0.2e-6, 2.0 * R + 1e-12)))
    assert np.abs(high.force).max() == 0.0
    low = rod.run(0.0, y, 2.0 * R - 1e-10, state=rod.place(0, 0, 0, (0.0, -0.2e-6, 2.0 * R - 1e-10)))
    assert low.force[:, 2].max() == pytest.approx(100.0 * 1e-10, rel=1e-3)
    assert np.abs(low.force[:, 1]).max() < 0.06 * low.force[:, 2].max()
    assert np.abs(low.position).max() < 1e-11
    assert low.force[-1].tolist() == [0.0, 0.0, 0.0]
    with pytest.raises(Error, match="range"):  # it is not pressed flat
        rod.run(0.0, 0.0, [2.0 * R, 1.2 * R], state=rod.place(0, 0, 0, (0.0, 0.0, 2.0 * R)))


@settings(max_examples=15, deadline=None)
@given(st.randoms(use_true_random=False), st.sampled_from([0.0, 1.0, 50.0]), st.sampled_from([0.0, 0.3, 1.2]))
def test_energy_is_kept_from_any_pose(random: object, lever: float, half_angle: float) -> None:
    """Low, high, on its top: stored + dissipated = work, heat never falls, and the work of a small step lies between
    the forces at its ends."""
    rng = np.random.default_rng(random.randrange(2**32))  # type: ignore[attr-defined]
    rod = wire(half_angle=half_angle, lever=lever, elements=16)
    state = rod.place(0.0, 0.0, float(rng.uniform(0, 3)), (0.7e-6, 0.7e-6, 2.5 * R))
    turnover, heat = 0.0, 0.0
    for _ in range(4):
        end = np.array([*(state.pose[:2] + 0.2e-6 * rng.standard_normal(2)), rng.uniform(0.0, 2.2 * R)])
        way = state.base + np.linspace(0.0, 1.0, 400)[1:, None] * (end - state.base)
        try:
            path: RodPath = rod.run(*way.T, state=state)
        except Error as error:
            assert "range" in str(error)  # noqa: PT017  # it would go through
            return
        work, forces = np.diff(path.work, prepend=state.work), np.vstack([state.force, path.force])
        steps = np.diff(way, axis=0, prepend=state.base[None])
        turnover += float(np.abs(work).sum())
        assert np.abs(path.stored + path.dissipated - path.work).max() <= 1e-12 * turnover + 1e-30
        assert (np.diff(path.dissipated, prepend=heat) >= 0.0).all()
        assert (path.stored >= 0.0).all()
        most = np.maximum(-(forces[:-1] * steps).sum(axis=1), -(forces[1:] * steps).sum(axis=1))
        assert work.sum() <= most.sum() + 0.05 * np.abs(most).sum() + 1e-24
        sideways = np.linalg.norm(path.force[:, :2], axis=1).max()
        assert sideways <= rod.friction * L * (1.0 + 1e-6)
        state, heat = path.state, float(path.dissipated[-1])


@pytest.mark.parametrize("place", [(0.0, 0.0), (3e-6, 2.4e-6), (-2e-4, 5e-5)])
@pytest.mark.parametrize("lever", [0.0, 20.0])
def test_a_push_on_the_middle_can_be_taken_back_anywhere(place: tuple[float, float], lever: float) -> None:
    """All forces are 0 then, but for the rounding of places: far from the origin that is more."""
    rod, (x, y) = wire(lever=lever), place
    way = y + np.concatenate([np.linspace(-0.2e-6, 0.2e-6, 401), np.linspace(0.2e-6, 0.1e-6, 5001)])
    path = rod.run(x, way, 10e-9, state=rod.place(x, y, 0.0, (x, y - 0.2e-6, 10e-9)))
    assert path.position[-1, 1] - y > 0.2e-6
    assert path.force[-1].tolist() == [0.0, 0.0, 0.0]
