# SPDX-License-Identifier: BSD-3-Clause
"""A sample that relaxes in scenes, plans and sessions: what a file says, when time matters, and what a touch feels
beside Ting's law. The bounds of plans are held in tests/c/test_scene_relaxation.c."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import Rheology, record
from nanotouch.errors import InvalidValue
from nanotouch.touch.operator import Input

GEL = Rheology.prony(600.0, [600.0, 300.0], [0.02, 0.3])
ALONE: dict[str, Any] = {
    "tip": {"shape": "sphere", "radius": 5e-6, "material": "silica"},
    "sample": {"poisson_ratio": 0.5},
    "medium": {"kind": "liquid", "relative_humidity": 0.0},
    "adhesion": {"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
}
SOFT = nt.Rig(probe={"spring_constant": 0.06, "resonance": 15e3})
ROUGHLY = 0.03


def scene_of(rheology: Any = GEL, **ranges: float) -> nt.Scene:
    return nt.Scene(rheology=rheology, range={"maximum_load": 1e-9, **ranges}, **ALONE)


def test_a_scene_keeps_its_kernel() -> None:
    """Through fields, copies, JSON, pickles and text."""
    scene = scene_of()
    assert scene.rheology.kind == "prony"
    assert scene["rheology.arm_modulus_2"] == 300.0
    assert scene["rheology.arm_count"] == 2.0
    table = {"kind": "prony", "equilibrium_modulus": 600.0, "arm_moduli": [600, 300], "relaxation_times": [0.02, 0.3]}
    assert scene_of(table) == scene
    assert nt.Scene(**json.loads(json.dumps(scene.to_dict()))) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene == scene.copy()
    assert eval(repr(scene), {"Scene": nt.Scene}) == scene
    assert nt.Scene().rheology.kind == "elastic"


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ({"kind": "power_law", "modulus_kPa": 1.0, "exponent": 0.9}, r"exponent.*0 \.\. 0.85"),
        ({"kind": "power_law", "modulus": 1.0, "exponent": 0.2}, "modulus_kPa"),
        ({"kind": "prony", "equilibrium_modulus_kPa": 1.0}, "lacks arm_moduli"),
        ({"kind": "jelly"}, "valid are elastic, power_law"),
        ({"arm_moduli_kPa": [1.0]}, "no key arm_moduli_kPa"),
    ],
)
def test_a_wrong_table_is_refused(table: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        nt.Scene.from_tables({"rheology": table})


@pytest.mark.parametrize(
    "rheology", [{"arm_moduli": [1e3]}, {"kind": "prony", "arm_moduli": 3.0}, {"kind": "prony", "e": 1}]
)
def test_a_wrong_kernel_of_a_program_is_refused(rheology: dict[str, Any]) -> None:
    with pytest.raises(InvalidValue, match=r"kind|arm_moduli|no field"):
        nt.Scene(rheology=rheology)


def test_time_matters_or_not() -> None:
    """A slow touch of stiff rubber is elastic, with the error said; the same touch quickly is not."""
    rubber = Rheology.standard_linear_solid(2e6, 0.3e6, 1e-3)
    slow = scene_of(rubber, maximum_load=1e-6, speed=3e-8).plan()
    assert slow.relaxation is not None
    assert slow.relaxation.springs == 0
    assert slow.relaxation.modulus == pytest.approx(2e6)
    assert 0.0 < slow.relaxation.error <= slow.bound <= 0.01
    assert "time: left out" in str(slow)
    quick = scene_of(rubber, maximum_load=1e-6, speed=1e-3).plan()
    assert quick.relaxation is not None
    assert (quick.relaxation.springs, quick.relaxation.arms) == (64, 1)
    assert "64 springs" in str(quick)
    assert nt.Scene().plan().relaxation is None
    nt.Interaction(slow)
    with pytest.raises(InvalidValue, match=r"rheology\.kind = .*relaxes"):
        nt.Interaction(quick)


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("adhesion.work_of_adhesion", 0.01, "beside adhesion"),
        ("friction.coefficient", 0.1, "beside friction"),
        ("sample.thickness", 1e-6, "thickness of a layer"),
        ("medium.brush_thickness", 0.3e-6, "forces before contact"),
    ],
)
def test_what_does_not_go_with_it_is_refused(field: str, value: float, words: str) -> None:
    scene = scene_of(Rheology.power_law(1e3, 0.2))
    scene[field] = value
    with pytest.raises(InvalidValue, match=rf"rheology\.kind .*{words}.*does not know"):
        scene.plan(ROUGHLY)


def press(session: nt.Session, force: float, time: float) -> nt.Recording | dict[str, Any]:
    return session.advance(time, Input(float(session.settings.gains.alpha_f) * force, 0.0, 0.0, 0.05))


@pytest.mark.parametrize("rheology", [GEL, Rheology.power_law(1e3, 0.2)], ids=["prony", "power_law"])
def test_a_touch_is_tings(rheology: Rheology) -> None:
    """A whole curve: the force that a session records against the forward solver, which knows neither its springs nor
    its ticks, along the base's way; and after it no force is left."""
    scene = scene_of(rheology)
    recording = nt.Session(scene, SOFT, relative_accuracy=ROUGHLY, mode="curve", path=[(0.0, 0.0)], seed=1).run()
    columns = recording.columns
    force = columns["tip_force"]
    indentation = -columns["gap"]
    begins = int(np.argmax(indentation > 0.0)) - 1
    ends = begins + 1 + int(np.argmax(force[begins + 1 :] == 0.0))
    time = columns["time"]
    truth = rheology.force(
        time[begins:ends], indentation[begins:ends], nt.geometry.Shape("sphere", radius=5e-6), poisson_ratio=0.5
    ).force
    assert truth.max() > 0.3e-9
    np.testing.assert_allclose(force[begins:ends], truth, atol=0.01 * truth.max())
    assert force[ends:].max() == 0.0


def test_held_it_relaxes_and_a_replay_has_the_same_bits(tmp_path: Path) -> None:
    session = nt.Session(scene_of(), SOFT, relative_accuracy=ROUGHLY, seed=2)
    scale = float(session.settings.gains.alpha_f)
    recording = session.run(operator=[Input(scale * force, 0.0, 0.0, 0.3) for force in (0.5e-9, 0.5e-9, -0.3e-9)])
    assert recording.columns["tip_force"].max() > 0.2e-9
    record.write(tmp_path / "a.mcap", recording)
    again = record.read(tmp_path / "a.mcap").replay()
    np.testing.assert_array_equal(again.columns["motor_force"], recording.columns["motor_force"])


def test_a_snapshot_has_what_the_sample_remembers() -> None:
    session = nt.Session(scene_of(), SOFT, relative_accuracy=ROUGHLY, seed=3)
    press(session, 0.4e-9, 0.3)
    moment = session.snapshot()
    first = press(session, -0.2e-9, 0.3)
    session.restore(moment)
    second = press(session, -0.2e-9, 0.3)
    np.testing.assert_array_equal(first["tip_force"], second["tip_force"])


def test_margins_and_force_bound_count_the_stiffness_over_a_period() -> None:
    """Both are those of an elastic sample of that modulus or worse, and worse than those of the one at rest."""
    bounds, limits = [], []
    for rheology, modulus in ((GEL, 600.0), ("elastic", 600.0), ("elastic", 1500.0)):
        scene = scene_of(rheology if rheology is GEL else {"kind": "elastic"})
        scene.sample.youngs_modulus = modulus
        session = nt.Session(scene, SOFT, relative_accuracy=ROUGHLY, seed=1)
        bounds.append(session.guarantee().force)
        limits.append(session.plan.maximum_stiffness)
    assert limits[0] >= limits[2] > limits[1]
    assert bounds[0] >= bounds[2] >= bounds[1]


def test_a_dynamic_lever_is_refused() -> None:
    with pytest.raises(nt.errors.Error, match="a dynamic lever over a sample that relaxes"):
        nt.Session(scene_of(), SOFT, relative_accuracy=ROUGHLY, probe_model="dynamic")
