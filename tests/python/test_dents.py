# SPDX-License-Identifier: BSD-3-Clause
"""A session whose sample yields while it is touched: force and heat beside the law at rest, grooves beside a ploughing
tip, what is recorded, replayed, taken back and drawn."""

from __future__ import annotations

import json
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import plasticity, record
from nanotouch.errors import InvalidValue
from nanotouch.touch.operator import Input

GOLD = {"youngs_modulus": 78e9, "poisson_ratio": 0.42, "yield_strength": 0.35e9, "dents": "yes"}


def soft_scene(load: float = 150e-9, **more: object) -> nt.Scene:
    """Gold below a hard tip, nothing but contact."""
    return nt.Scene(
        tip={"radius": 20e-9, "youngs_modulus": 1e12, "poisson_ratio": 0.2},
        sample=GOLD,
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        range={"maximum_load": load},
        **more,  # type: ignore[arg-type]
    )


def law_of(scene: nt.Scene) -> nt.plasticity.Indentation:
    modulus = nt.contact.effective_modulus(1e12, 0.2, 78e9, 0.42)
    return plasticity.Indentation(float(scene.tip.radius), modulus, 0.35e9)


def test_a_curve_is_the_law_at_rest_and_leaves_its_dent() -> None:
    """Force over gap as the paraboloid's law has it, up and down; the dent is that of the largest load."""
    scene = soft_scene()
    session = nt.Session(scene=scene, mode="curve", path=[(0.0, 0.0)], seed=3)
    recording = session.run()
    columns, law = recording.columns, law_of(scene)
    way = law.run(-columns["gap"][columns["surface_height"] == 0.0])
    force = columns["tip_force"][columns["surface_height"] == 0.0]
    np.testing.assert_allclose(force, way.force, atol=1e-6 * force.max())
    (dent,) = session.dents
    assert recording.dents == session.dents
    made = law.at_load(dent.load)
    assert dent.load == pytest.approx(columns["tip_force"].max(), rel=1e-3)
    assert (dent.imprint.radius, dent.imprint.depth) == pytest.approx((made.contact_radius, made.residual_depth))
    assert columns["surface_height"][-1] == pytest.approx(-dent.imprint.depth)  # of the apex over its middle


def pressed(session: nt.Session, force: float) -> None:
    """Press with a force of the tip, in the hand's scale, then let go."""
    scale = float(session.settings.gains.alpha_f)
    for one in (force, -0.2 * force):
        session.advance(1.0, Input(scale * one, 0.0, 0.0, 0.2))


def test_pressed_again_it_bears_what_it_bore_and_undo_takes_it_back() -> None:
    session = nt.Session(scene=soft_scene(), seed=1)
    pressed(session, 40e-9)
    assert len(session.dents) == 1
    pressed(session, 20e-9)
    assert len(session.dents) == 1
    (first,) = session.dents
    before = session.snapshot()
    pressed(session, 80e-9)
    (second,) = session.dents  # the same dent, grown
    assert second.before is None
    assert second.load > 1.5 * first.load
    session.restore(before)
    assert session.dents == (first,)
    session.undent()
    with pytest.raises(nt.errors.Error, match="no dent"):
        session.undent()
    assert session.advance(0.01)["surface_height"][-1] == 0.0


def test_the_same_seed_the_same_dents_and_a_replay_has_the_same_bits(tmp_path: Path) -> None:
    recordings = []
    for _ in range(2):
        session = nt.Session(scene=soft_scene(), seed=5, mode="curve", path=[(0.0, 0.0)])
        recordings.append(session.run())
    one, two = recordings
    assert one.dents == two.dents
    np.testing.assert_array_equal(one.columns["tip_force"], two.columns["tip_force"])
    record.write(tmp_path / "a.mcap", one)
    read = record.read(tmp_path / "a.mcap")
    assert read.dents == one.dents
    again = read.replay()
    np.testing.assert_array_equal(again.columns["motor_force"], one.columns["motor_force"])


def test_a_lever_that_rings_makes_one_dent_of_its_taps() -> None:
    """It bounces while it lands, and all along the touch: without merging the list of 128 is full before the end."""
    scene = soft_scene(9e-9)
    scene.sample.yield_strength = 0.045e9
    rig = nt.Rig(probe={"spring_constant": 1.0, "resonance": 20e3, "quality": 300.0})
    session = nt.Session(scene=scene, rig=rig, mode="scan", path=[(0.0, 0.0), (200e-9, 0.0)], seed=3)
    recording = session.run(1.4)
    events = recording.metadata["events"]
    taps = [numbers for _, name, numbers in events if name == "dent_size"]
    assert len(taps) > 10
    assert not (recording.columns["state"] > 0).any()
    *others, dent = recording.dents
    assert len(others) < 3
    assert recording.dents == session.dents
    assert [dent.imprint.radius, dent.imprint.depth, dent.load] == taps[-1][:3]
    assert dent.before is None
    np.testing.assert_array_equal(recording.replay().columns["motor_force"], recording.columns["motor_force"])
    session.set_mode("point")
    session.advance(0.5, Input(-5e-9 * float(session.settings.gains.alpha_f), 0.0, 0.0, 0.1))
    session.undent()
    assert session.dents == plasticity.dents_of(session.metadata()["events"])
    assert len(session.dents) <= len(others) + 1


def test_dents_of_events_go_back_with_a_rewind() -> None:
    session = nt.Session(scene=soft_scene(), seed=1)
    pressed(session, 40e-9)
    one, moment = session.dents, session.snapshot()
    pressed(session, 80e-9)
    assert plasticity.dents_of(session.metadata()["events"]) == session.dents != one
    session.restore(moment)
    assert plasticity.dents_of(session.metadata()["events"]) == session.dents == one
    pressed(session, 60e-9)
    assert plasticity.dents_of(session.metadata()["events"]) == session.dents != one


def test_a_snapshot_goes_back_before_the_dent() -> None:
    session = nt.Session(scene=soft_scene(), seed=1)
    before = session.snapshot()
    pressed(session, 60e-9)
    dents = session.dents
    session.restore(before)
    assert session.dents == ()
    pressed(session, 60e-9)
    assert session.dents == dents


def test_a_tip_that_is_dragged_leaves_a_groove() -> None:
    """Width and forces of Bowden and Tabor, on a sample so soft that all but 1 % of the depth is plastic."""
    scene = soft_scene(9e-9, friction={"shear_strength": 2e6})
    scene.sample.yield_strength = 0.02e9
    rig = nt.Rig(probe={"lateral_stiffness": 200.0, "spring_constant": 1.0, "resonance": 50e3})
    session = nt.Session(scene=scene, rig=rig, mode="topography", path=[(0.0, 0.0), (200e-9, 0.0)], seed=1)
    columns = session.run().columns
    late = columns["x"] > 100e-9
    load = float(columns["tip_force"][late].mean())
    session.set_mode("point")
    session.advance(1.0, Input(-5e-9 * float(session.settings.gains.alpha_f), 200e-9, 0.0, 0.2))
    groove = next(dent.imprint for dent in session.dents if dent.imprint.start_x != dent.imprint.end_x)
    known = plasticity.Scratching(20e-9, hardness=0.06e9, shear_strength=2e6).groove(load)
    assert groove.end_x - groove.start_x > 150e-9
    assert 2.0 * columns["contact_radius"][late].mean() == pytest.approx(known.width, rel=0.02)
    assert 2.0 * groove.radius == pytest.approx(known.width, rel=0.2)  # that of the largest load
    assert -columns["tip_force_x"][late].mean() == pytest.approx(known.lateral_force, rel=0.06)


def test_a_specimen_takes_what_a_session_left() -> None:
    session = nt.Session(scene=soft_scene(), seed=1)
    pressed(session, 60e-9)
    first = session.dents
    pressed(session, 120e-9)
    grown = session.dents[-1]._replace(before=0)
    specimen = plasticity.Specimen(np.zeros((128, 128)), 0.4e-9)
    shift = 25e-9
    events = [
        specimen.take(
            dent._replace(
                imprint=dent.imprint._replace(
                    start_x=dent.imprint.start_x + shift,
                    start_y=dent.imprint.start_y + shift,
                    end_x=dent.imprint.end_x + shift,
                    end_y=dent.imprint.end_y + shift,
                )
            )
        )
        for dent in (*first, grown)
    ]
    last = session.dents[-1].imprint
    assert specimen.heights.min() == pytest.approx(-last.depth, rel=0.02)
    removed = sum(event.removed for event in events)
    assert removed == pytest.approx(last.volume, rel=0.01)
    assert json.loads(json.dumps(events[-1].as_dict()))["kind"] == "indent"
    specimen.undo()
    specimen.undo()
    assert not specimen.heights.any()
    with pytest.raises(InvalidValue, match="take all of them"):
        specimen.take(grown)


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("sample.yield_strength", 0.0, "yield_strength"),
        ("adhesion.work_of_adhesion", 0.05, "adhesion"),
        ("tip.shape", "cone", "not round"),
        ("range.maximum_load", 0.2e-6, "maximum_load"),
    ],
)
def test_what_does_not_go_with_dents_is_refused(field: str, value: float | str, message: str) -> None:
    scene = soft_scene()
    scene[field] = value
    with pytest.raises(nt.errors.Error, match=message):
        nt.Session(scene=scene)


def test_who_knows_no_dents_says_so() -> None:
    plan = soft_scene().plan()
    assert "keeps dents" in str(plan)
    with pytest.raises(InvalidValue, match=r"sample\.dents"):
        nt.Interaction(plan)
    with pytest.raises(nt.errors.Error, match="no dents"):
        nt.Session().undent()
