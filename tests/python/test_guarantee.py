# SPDX-License-Identifier: BSD-3-Clause
"""What is promised before arming, in words and numbers; test_session_adversary (C) attacks it."""

from __future__ import annotations

import numpy as np
import pytest
from nanotouch import Faults, Input, Rig, Scene, Session, Settings, Surface, record, surface

GRATING = Surface(surface.grating(pixels=128), 20e-9)
LATCHED = record.STATES.index("LATCHED")


def test_the_guarantee_is_the_sum_of_its_terms() -> None:
    flat, rough = Session(), Session(surface=GRATING, mode="scan")
    for session in (flat, rough):
        found = session.guarantee()
        terms = found.calibration + found.motion + found.ringing + found.snap_in + found.noise + found.tare
        assert found.force == pytest.approx(session.settings.limits.force + terms, rel=1e-12)
        assert found.limit == pytest.approx(session.settings.limits.force, rel=1e-12)
        assert found.snap_in >= session.plan.explain()["pull_off_force"]
        assert found.arrival > 2.0 * session.plan.explain()["pull_off_force"]  # the tip arrives with more than that
        assert found.with_failure == found.force + max(found.failures.values())
        assert found.warning is None
        assert found.arrival < found.limit
        for number in (found.force, found.with_failure):
            assert f"{number * 1e9:.4g} nN" in str(found)
        assert "help is needed within 13.9 h" in str(found)
    assert rough.guarantee().motion > 3.0 * flat.guarantee().motion  # the flank of the grating


def test_what_nothing_would_show_is_said() -> None:
    """Without an integral hysteresis hides a stage that sticks: the others keep their number."""
    found = Session(gains={"stage_integral": 0.0}).guarantee()
    assert found.with_failure == np.inf
    others = found.force + max(most for most in found.failures.values() if most < np.inf)
    assert f"at most {others * 1e9:.4g} nN if one thing fails" in str(found)
    assert "without bound for slip of stage or surface: nothing would show it" in str(found)


def test_one_failure_far_above_the_others_does_not_hide_them() -> None:
    """An integral may hide half of a declared hysteresis: a slip of so much is no use to those who fear another."""
    found = Session(rig=Rig(stage={"hysteresis": 0.15, "creep": 0.01})).guarantee()
    slip, second = sorted(found.failures.values())[:-3:-1]
    assert slip == found.failures["slip of stage or surface"] > 10.0 * second
    assert f"{(found.force + second) * 1e9:.4g} nN if anything else does" in str(found)
    assert "anything else" not in str(Session().guarantee())


def test_a_limit_that_protects_nothing_is_said() -> None:
    """A soft lever jumps in with forty times the limit: said before anything moves."""
    rig = Rig(probe={"spring_constant": 0.1, "resonance": 30e3})
    settings = Settings.for_rig(rig)
    settings.limits.force, settings.gains.set_point = 2e-9, 1e-9
    settings.gains.alpha_p, settings.limits.stage_speed = 4e-6, 1e-6
    session = Session(None, rig, settings=settings, clearance=4e-9)
    found = session.guarantee()
    assert found.warning is not None
    assert "does not protect the sample" in str(found).splitlines()[-1]
    pressed = session.advance(0.1, Input(1.0, 0.0, 0.0, 0.02))["tip_force"].max()
    assert 20e-9 < pressed < found.force < 120e-9


@pytest.mark.parametrize("rate", [1e-9, 1e-6])
def test_a_stop_lifts_from_the_drift_of_the_frame(rate: float) -> None:
    session = Session(faults=Faults().add("drift", "stage", at=0.6, value=rate), rate=2000.0)
    session.advance(0.5, Input(0.2, 0.0, 0.0, 0.1))
    session.advance(1.0, Input(2.0, 0.0, 0.0, 0.2))
    session.emergency_stop(True)
    session.advance(0.1)
    session.emergency_stop(False)
    assert session.advance(2.0)["tip_force"].max() < 2e-6
    later = session.advance(8.0)
    assert (later["state"] == LATCHED).all()
    assert np.abs(later["tip_force"]).max() < 60e-9
    assert session.guarantee().help_time == pytest.approx(50e3)


def test_a_slide_from_soft_to_hard_is_promised() -> None:
    """The lever is bent further by as much as the tip sinks in less: with 30 N/m by more than all the rest."""
    moduli = np.full((32, 32), 1e9)
    moduli[:, 16:] = 100e9
    sample = Surface(np.zeros((32, 32)), pixel_size=5e-9, youngs_modulus=moduli)
    rig = Rig(probe={"spring_constant": 30.0, "noise": 2e-3, "spring_constant_sigma": 0.0, "sensitivity_sigma": 0.0})
    settings = Settings.for_rig(rig)
    settings.limits.force, settings.gains.set_point = 400e-9, 100e-9
    settings.limits.stage_speed, settings.limits.follow_error = 0.5e-6, 25e-9
    settings.gains.alpha_f, settings.gains.alpha_p = 2.5e6, 5e-6
    scene = Scene(sample={"youngs_modulus": 1e9})
    session = Session(
        scene, rig, surface=sample, settings=settings, path=[(20e-9, 80e-9)], clearance=5e-9, relative_accuracy=0.1
    )
    promised = session.guarantee().force
    soft = session.advance(3.0, Input(0.93, 20e-9, 80e-9, 0.5))["tip_force"][-1]
    hard = session.advance(0.1, Input(0.93, 140e-9, 80e-9, 0.0))["tip_force"].max()
    assert soft < 400e-9
    assert 1.25 * 515e-9 < hard < promised < 2.5 * hard  # 515 nN: limit and all terms but this


def test_what_the_tare_takes_off_is_told_where_it_matters() -> None:
    found = Session().guarantee()
    assert 0.0 < found.tare < 1e-12
    assert "tare 5 nN" not in str(found)
    assert "noise 15.3, tare 5 nN; and" in str(found._replace(tare=5e-9, force=found.force + 5e-9))
    assert Session(preflight=False).guarantee().tare == 0.0


def test_a_stage_that_cannot_keep_up_is_promised() -> None:
    """What it falls behind a command that is faster than it can go is still to come when the command turns."""
    found = [Session(rig=Rig(stage={"max_speed": speed}), settings=Settings()).guarantee() for speed in (30e-6, 20e-6)]
    assert found[1].motion > 1.5 * found[0].motion
    assert found[1].force > found[0].force
