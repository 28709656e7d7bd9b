# SPDX-License-Identifier: BSD-3-Clause
"""Promises hold wherever the tip can be led: by a master of three axes, by inputs, by requests; and where it stands."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.touch.operator import Hold, Input

PIXEL = 20e-9
DRY = nt.Scene(medium={"relative_humidity": 0.0})
STILL = (math.nan, math.nan)  # the tip follows the master


def plane(slope: float) -> nt.Surface:
    """Rising along x; the right force on a tip there, without friction, is -slope times that along z."""
    x = np.arange(64) * PIXEL
    return nt.Surface(nt.Topography(np.tile(slope * x, (64, 1)), (PIXEL, PIXEL)), tip_radius=20e-9)


def ridges(slope: float) -> nt.Surface:
    """Flanks of 320 nm that change their direction."""
    x, period = np.arange(128) * 10e-9, 640e-9
    heights = np.tile(slope * np.abs((x / period) % 1.0 - 0.5) * period, (128, 1))
    return nt.Surface(nt.Topography(heights, (10e-9, 10e-9)), tip_radius=10e-9)


def sideways(columns: Any) -> Any:
    return np.hypot(columns["tip_force_x"], columns["tip_force_y"])


@pytest.mark.parametrize("rubs", [False, True])
def test_a_tilted_plane_pushes_sideways_no_more_than_promised(rubs: bool) -> None:
    """0.2 times the force along z, and what friction holds; the default mode, with a master of three axes."""
    friction = {"shear_strength": 50e6, "coefficient": 0.3} if rubs else {}
    scene = nt.Scene(medium={"relative_humidity": 0.0}, friction=friction)
    rig = nt.Rig(master={"axes": 3}, probe={"lateral_stiffness": 50.0})
    session = nt.Session(scene, rig, surface=plane(0.2), seed=1, clearance=20e-9)
    promised = session.guarantee()
    assert promised.lateral_force >= 0.2 * promised.force  # the plane's own slope times all that may press
    limit = session.settings.gains.alpha_f * session.settings.limits.force
    session.advance(0.4, Input((0.0, 0.0, 1.0), *STILL, 0.1))  # type: ignore[arg-type]
    session.advance(0.4, Input((0.0, 0.0, 0.5 * limit), *STILL, 0.2))  # type: ignore[arg-type]
    rubbed = session.advance(0.3, Input((4.0, 1.0, 0.5 * limit), *STILL, 0.02))  # type: ignore[arg-type]
    pressed = session.advance(0.3, Input((4.0, 1.0, 2.0 * limit), *STILL, 0.02))  # type: ignore[arg-type]
    if not rubs:
        np.testing.assert_allclose(rubbed["tip_force_x"], -0.2 * rubbed["tip_force"], rtol=1e-6, atol=1e-15)
    worst = max(sideways(rubbed).max(), sideways(pressed).max())
    assert 70e-9 < worst < promised.lateral_force < 5.0 * worst


def test_a_stage_of_one_axis_has_the_slope_it_stands_on() -> None:
    """53 nN were met where 17 were promised."""
    rig = nt.Rig(stage={"axes": 1}, probe={"lateral_stiffness": 50.0})
    session = nt.Session(DRY, rig, surface=plane(0.5), seed=1, clearance=20e-9)
    promised = session.guarantee()
    assert not promised.moves_sideways
    columns = session.advance(1.0, Input(2.0, *session.path[0], 0.1))
    met = sideways(columns).max()
    np.testing.assert_allclose(columns["tip_force_x"], -0.5 * columns["tip_force"], rtol=1e-6, atol=1e-15)
    assert 50e-9 < met < promised.lateral_force
    assert promised.lateral_force >= 0.5 * promised.force
    assert "sideways at most" in str(promised)
    flat = nt.Session(DRY, rig, surface=plane(0.0), clearance=20e-9).guarantee()
    assert promised.motion == pytest.approx(flat.motion, rel=0.01)  # it stands: nothing rises under it


def swept(session: nt.Session, speed: float, blows: int = 40) -> tuple[float, float]:
    """A hand that holds the master and throws it sideways; the largest forces along z and sideways [N]."""
    random = np.random.default_rng(1)
    alpha, end = session.settings.gains.alpha_p, 0.49 * session.rig.master.travel
    now = np.array([0.0, 0.0, session.core.master_start])
    force = aside = 0.0
    for _ in range(blows):
        way = np.array([random.choice([-1, 1]) * random.uniform(50e-9, 250e-9), 0.0, random.uniform(-30e-9, 60e-9)])
        to = np.clip(now + way / alpha, -end, end)
        duration = max(abs(to[0] - now[0]) / speed, 1e-3)
        columns = session.advance(duration + 2e-3, Hold(tuple(to), *STILL, duration))
        force, aside = max(force, np.abs(columns["tip_force"]).max()), max(aside, sideways(columns).max())
        if session.state != "RUN":
            session.arm(True)
            away = (to[0], to[1], max(to[2] - 100e-9 / alpha, -end))
            session.advance(0.01, Hold(away, *STILL, 5e-3))
        last = session.advance(1e-4)
        now = np.array([last["master_x"][-1], last["master_y"][-1], last["master_position"][-1]])
    return force, aside


def fast(slope: float, mode: Any, path: Any = None, lateral_speed: float = 300e-6) -> nt.Session:
    """A rig whose stage goes 0.3 mm/s sideways. At these slopes its margins are low: nobody asks for them here."""
    rig = nt.Rig(master={"axes": 3, "mass": 0.05, "damping": 5.0},
                 probe={"lateral_stiffness": 50.0, "spring_constant": 8.0})  # fmt: skip
    scene = nt.Scene(tip={"radius": 10e-9}, medium={"relative_humidity": 0.0},
                     adhesion={"work_of_adhesion": 0.01, "hamaker_constant": 1e-20})  # fmt: skip
    settings = nt.Settings.for_rig(rig)
    settings.limits.force, settings.gains.set_point = 400e-9, 100e-9
    settings.limits.lateral_speed, settings.limits.indentation = lateral_speed, 1e-7
    settings.gains.alpha_p, settings.gains.alpha_f, settings.gains.force_gain = 1e-3, 2e4, 0.0
    return nt.Session(scene, rig, surface=ridges(slope), clearance=20e-9, settings=settings, mode=mode, path=path,
                      minimum_margin=0.0)  # fmt: skip


def test_flanks_press_no_more_than_promised_in_the_default_mode() -> None:
    """1 564 nN were met where 836 were promised."""
    session = fast(3.0, "point")
    promised = session.guarantee()
    force, aside = swept(session, 0.3)
    assert 836e-9 < force < promised.force
    assert 2000e-9 < aside < promised.lateral_force


def test_a_surface_rises_by_no_more_than_its_relief() -> None:
    """However fast the tip goes: 64 nm of relief, where slope and speed would make 480 nm of the reaction time."""
    session = fast(0.2, "point", lateral_speed=3e-3)
    promised = session.guarantee()
    stands = fast(0.2, "point", lateral_speed=1e-9).guarantee()
    assert 60e-9 * 8.0 < promised.motion - stands.motion < 75e-9 * 8.0 * 1.15
    force, _ = swept(session, 1.0)
    assert 420e-9 < force < promised.force  # above the limit: it was swept hard


def test_the_same_rig_has_the_same_margin_whatever_its_mode_is_called() -> None:
    """Both are touch, and the hand goes anywhere: 1.59 and armed in one, 1.17 and refused in the other."""
    path = [(0.2e-6, 0.6e-6), (1.1e-6, 0.6e-6)]
    point, scan = fast(4.0, "point"), fast(4.0, "scan", path)
    assert point.stability_margin == scan.stability_margin
    assert point.guarantee() == scan.guarantee()


def half_tilted() -> nt.Surface:
    """Level up to the middle, a slope of 1 from there."""
    x = np.arange(64) * PIXEL
    return nt.Surface(nt.Topography(np.tile(np.maximum(x - 32 * PIXEL, 0.0), (64, 1)), (PIXEL, PIXEL)))


LEVEL = [(0.1e-6, 0.5e-6), (0.4e-6, 0.5e-6)]


def test_a_path_narrows_nothing_where_inputs_may_leave_it() -> None:
    """With a master of one axis: what is promised on the level part holds on the slope, and the tip is led there."""
    surface = half_tilted()
    along = nt.Session(DRY, surface=surface, mode="scan", path=LEVEL, clearance=20e-9)
    free = nt.Session(DRY, surface=surface, mode="scan", clearance=20e-9)
    flat = nt.Session(DRY, surface=plane(0.0), mode="scan", path=LEVEL, clearance=20e-9)
    promised = along.guarantee()
    assert promised.motion == pytest.approx(free.guarantee().motion)
    assert promised.motion > 1.5 * flat.guarantee().motion
    met = along.advance(0.3, Input(1.0, 0.9e-6, 0.5e-6, 0.1))
    assert met["x"].max() > 0.66e-6  # on the slope, until a stop
    assert 0.0 < np.abs(met["tip_force"]).max() < promised.force


def test_a_path_narrows_nothing_where_a_hand_of_three_axes_leads() -> None:
    rig = nt.Rig(master={"axes": 3})
    kept = nt.Session(DRY, rig, surface=half_tilted(), mode="scan", path=LEVEL, clearance=20e-9)
    free = nt.Session(DRY, rig, surface=half_tilted(), clearance=20e-9)
    assert kept.guarantee().motion == pytest.approx(free.guarantee().motion)
    assert kept.guarantee().motion > nt.Session(DRY, rig, clearance=20e-9).guarantee().motion


def test_a_lateral_limit_that_is_lowered_on_the_way_holds() -> None:
    """The path that goes on is as slow as is promised from then on."""
    session = nt.Session(DRY, surface=plane(0.0), clearance=50e-9)
    session.advance(1e-3, Input(0.0, 1.0e-6, 0.6e-6, 0.0))
    session.change("settings", "limits.lateral_speed", 1e-6)
    columns = session.advance(0.05)
    assert np.abs(np.diff(columns["x"][1:])).max() * session.rate < 1e-6 * (1.0 + 1e-6)
