# SPDX-License-Identifier: BSD-3-Clause
"""Laws as rows: what the library says of its own, and laws of one's own in a scene."""

from __future__ import annotations

import copy
import math
import pickle
import re
from collections.abc import Iterator
from importlib.metadata import EntryPoint
from pathlib import Path

import draws
import nanotouch as nt
import numpy as np
import pytest
import random_scenes
from nanotouch import Scene, Session, presets, reference
from nanotouch.errors import Error, InvalidValue
from nanotouch.scene._custom import _known
from nanotouch.scene.plan import ROWS
from nanotouch.touch import record

K_B, E_CHARGE, EPSILON_0 = 1.380649e-23, 1.602176634e-19, 8.8541878128e-12


def energy(gap: float, strength: float, length: float, radius: float) -> float:
    """An exponential over a Gaussian: what no law of the library has."""
    return strength * radius * (length * math.exp(-gap / length) - 0.3 * length * math.exp(-((gap / length) ** 2)))


def force(gap: float, strength: float, length: float, radius: float) -> float:
    x = gap / length
    return strength * radius * (math.exp(-x) - 0.6 * x * math.exp(-(x**2)))


def stiffness(gap: float, strength: float, length: float, radius: float) -> float:
    x = gap / length
    return strength * radius / length * (math.exp(-x) + 0.6 * (1.0 - 2.0 * x**2) * math.exp(-(x**2)))


def bound(gap: float, strength: float, length: float, radius: float) -> float:
    """x exp(-x^2) falls from x = 1/sqrt(2) on, where it is 0.43."""
    x = max(gap / length, math.sqrt(0.5))
    return abs(strength) * radius * (math.exp(-gap / length) + 0.6 * x * math.exp(-(x**2)))


GEL = {
    "energy": energy, "force": force, "stiffness": stiffness, "bound": bound,
    "parameters": {"strength": None, "length": 2e-9, "radius": "tip.radius"},
    "units": {"strength": "N/m", "length": "m", "radius": "m"},
}  # fmt: skip


@pytest.fixture(autouse=True)
def registered() -> Iterator[None]:
    nt.scene.register("gel", **GEL)  # type: ignore[arg-type]
    yield
    _known.clear()


def gelled(strength: float = 0.4) -> Scene:
    return Scene(medium={"relative_humidity": 0.0}, terms={"gel": {"strength": strength}})


def test_rows_are_what_plans_are_made_of() -> None:
    for name in random_scenes.PRESETS:
        plan = getattr(presets, name)()[0].plan()
        for row, term in zip(ROWS, plan.explain()["terms"], strict=False):
            assert (row.name, row.title) == (term["name"], term["title"])
    names = [row.name for row in ROWS]
    assert names == list(reference.SceneForces._fields)
    assert len(set(names)) == len(names)
    assert [row.tail for row in ROWS if row.tail] == ["adhesion.hamaker_constant"]


def test_one_law_alone_and_the_pressure_of_its_flats() -> None:
    plan = Scene(medium={"relative_humidity": 0.0}).plan()
    gap = np.array([1e-9, 2e-9, 5e-9])
    scene_forces = reference.forces(Scene(medium={"relative_humidity": 0.0}), gap)
    np.testing.assert_allclose(plan.law("vdw", gap).F, scene_forces.vdw, rtol=1e-12)
    s = gap + 0.2e-9  # between the planes of atoms
    np.testing.assert_allclose(plan.pressure("vdw", gap).pressure, -1e-19 / (6 * np.pi * s**3), rtol=1e-12)
    assert math.isnan(plan.pressure("charge", 1e-9).pressure)
    with pytest.raises(InvalidValue, match="term 'gravity': there are contact, vdw"):
        plan.law("gravity", gap)


def test_double_layer_pressure_is_that_of_equal_plates() -> None:
    """p = 2 eps kappa^2 psi^2 e^-x/(1 + e^-x)^2 of equal potentials, Hogg's linear theory, worked out apart."""
    scene = Scene(medium={"kind": "liquid", "ionic_strength": 1.0}, tip={"surface_potential": 0.02},
                  sample={"surface_potential": 0.02})  # fmt: skip
    epsilon = EPSILON_0 * scene.medium.relative_permittivity
    kappa = math.sqrt(2 * 6.02214076e23 * E_CHARGE**2 * 1.0 / (epsilon * K_B * scene.medium.temperature))
    e = math.exp(-kappa * 6e-9)
    expected = 2 * epsilon * kappa**2 * 0.02**2 * e / (1 + e) ** 2
    assert scene.plan().pressure("double_layer", 6e-9).pressure == pytest.approx(expected, rel=1e-9)


def test_yukawa_force_is_in_the_sum_and_in_the_reference() -> None:
    scene = Scene(medium={"relative_humidity": 0.0, "yukawa_energy": 2e-3, "yukawa_length": 4e-9})
    plan = scene.plan(relative_accuracy=1e-4)
    assert "Yukawa: computed, at most" in str(plan)
    factor = 1 - 0.2 + 1.2 * math.exp(-10)
    expected = 2 * math.pi * 20e-9 * 2e-3 * factor * math.exp(-3 / 4)
    assert reference.forces(scene, 3e-9).yukawa == pytest.approx(expected, rel=1e-12)
    outcome = random_scenes.compare(scene, 1e-4)
    assert isinstance(outcome, random_scenes.Outcome)
    assert outcome.error <= plan.bound


@pytest.mark.parametrize("accuracy", [0.3, 1e-2, 1e-4, 1e-6])
def test_ones_own_law_is_planned_within_its_bound(accuracy: float) -> None:
    for strength in (1e-7, 1e-2, 0.4, -0.2):
        scene = gelled(strength)
        outcome = random_scenes.compare(scene, accuracy)
        assert isinstance(outcome, random_scenes.Outcome)
        assert outcome.error <= outcome.plan.bound
        assert random_scenes.keeps(outcome.plan, accuracy)
    gap = np.geomspace(0.3e-9, 30e-9, 50)
    truth = [force(h, -0.2, 2e-9, 20e-9) for h in gap]
    law = outcome.plan.law("gel", gap)
    np.testing.assert_allclose(law.F, truth, atol=1e-6 * np.max(np.abs(truth)))
    assert "gel" in [term.name for term in outcome.plan.terms]
    assert "gel: tabulated, at most" in str(outcome.plan)


def power(gap: float, strength: float, length: float, radius: float) -> tuple[float, float, float]:
    F = strength * radius * (length / (gap + length)) ** 2
    return F * (gap + length), F, 2 * F / (gap + length)


def brush(gap: float, strength: float, length: float, radius: float) -> tuple[float, float, float]:
    """With an edge, where its stiffness has a step."""
    rest = max(1 - gap / length, 0.0)
    k = strength * radius / length if rest > 0.0 else 0.0
    return 0.5 * strength * radius * length * rest**2, strength * radius * rest, k


def test_random_laws_in_random_scenes() -> None:
    """Whatever the law and the scene: error within the bound, within the demand, folds in place."""
    rng = np.random.default_rng(17)
    for name, law in (("power", power), ("brush", brush)):
        nt.scene.register(
            name,
            energy=lambda gap, law=law, **values: law(gap, **values)[0],
            force=lambda gap, law=law, **values: law(gap, **values)[1],
            stiffness=lambda gap, law=law, **values: law(gap, **values)[2],
            bound=lambda gap, law=law, **values: abs(law(gap, **values)[1]),
            parameters={"strength": None, "length": None, "radius": "tip.radius"},
            units={"strength": "N/m", "length": "m", "radius": "m"},
        )
    made = 0
    scenes = draws.count(20, 60)
    for _ in range(scenes):
        scene = (random_scenes.near_preset if rng.random() < 0.5 else random_scenes.extreme)(rng)
        strength = 10.0 ** rng.uniform(-6, 0) * rng.choice([-1.0, 1.0])
        scene.add_term(
            str(rng.choice(["power", "brush", "gel"])), strength=strength, length=10.0 ** rng.uniform(-10, -6)
        )
        accuracy = 10.0 ** rng.uniform(-5, -0.5)
        outcome = random_scenes.compare(scene, accuracy)
        if isinstance(outcome, random_scenes.Outcome):
            made += 1
            assert outcome.error <= outcome.plan.bound, scene
            assert random_scenes.keeps(outcome.plan, accuracy), scene
            assert outcome.folds_hold, scene
        else:
            assert "terms." not in str(outcome)
    assert made > scenes // 2


def test_a_measured_pull_off_is_that_of_the_whole() -> None:
    scene = gelled(-0.05)
    scene.adhesion.given, scene.adhesion.pull_off_force = "pull_off_force", 12e-9
    outcome = random_scenes.compare(scene, 1e-4)
    assert isinstance(outcome, random_scenes.Outcome)
    assert outcome.folds_hold
    assert outcome.error <= outcome.plan.bound
    assert outcome.plan.pull_off_force == pytest.approx(12e-9, rel=1e-8)


def test_a_parameter_follows_the_scene() -> None:
    scene = gelled()
    assert scene.terms == {"gel": {"strength": 0.4, "length": 2e-9, "radius": 20e-9}}
    scene.tip.radius = 40e-9
    assert scene.terms["gel"]["radius"] == 40e-9
    felt = scene.plan().law("gel", 1e-9).F
    assert felt == pytest.approx(force(1e-9, 0.4, 2e-9, 40e-9), rel=1e-6)
    scene.remove_term("gel")
    assert scene == Scene(medium={"relative_humidity": 0.0}, tip={"radius": 40e-9})


def test_copies_have_it(tmp_path: Path) -> None:
    scene = gelled()
    for same in (scene.copy(), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene)), Scene(**scene.to_dict())):
        assert same == scene
        assert same.plan().law("gel", 1e-9).F == scene.plan().law("gel", 1e-9).F
    assert pickle.loads(pickle.dumps(scene.plan())).law("gel", 1e-9).F == scene.plan().law("gel", 1e-9).F
    other = scene.copy()
    other.add_term("gel", strength=0.1)
    assert other != scene
    assert scene.terms["gel"]["strength"] == 0.4
    assert "terms={'gel'" in repr(scene)
    path = tmp_path / "scene.toml"
    path.write_text("[medium]\nrelative_humidity_percent = 0\n[terms.gel]\nstrength_mN_per_m = 400\nlength_nm = 2\n")
    read = Scene.from_toml(path)
    assert read.terms["gel"]["strength"] == pytest.approx(0.4, rel=1e-15)
    assert nt.Rig.from_toml(path) == nt.Rig()  # the others pass it over


def test_what_it_states_wrongly_is_refused_by_name() -> None:
    def half(gap: float, **values: float) -> float:
        return 0.5 * bound(gap, **values)

    def flipped(gap: float, **values: float) -> float:
        return -force(gap, **values)

    def raising(gap: float, **values: float) -> float:
        raise ZeroDivisionError(f"at {gap}")

    def returning(gap: float, **values: float) -> float:
        """A thousandth of the force at 1 nm comes back where the bound says that it has faded."""
        return force(gap, **values) + (5e-12 if 0.5e-6 < gap < 1e-6 else 0.0)

    for wrong, match in (
        ({"bound": half}, r"terms\.gel\.bound = .* N"),
        ({"force": returning}, r"terms\.gel\.bound = .* N: valid is 5e-12"),
        ({"force": flipped}, r"terms\.gel\.law"),
        ({"stiffness": flipped}, r"terms\.gel\.law"),
    ):
        nt.scene.register("gel", **(GEL | wrong))  # type: ignore[arg-type]
        with pytest.raises(InvalidValue, match=match):
            gelled().plan()
    nt.scene.register("gel", **(GEL | {"energy": raising}))  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match=r"terms\.gel\.law") as refusal:
        gelled().plan()
    assert isinstance(refusal.value.__cause__, ZeroDivisionError)
    assert "it raised ZeroDivisionError" in str(refusal.value)


def test_names_and_parameters_are_refused_by_name(tmp_path: Path) -> None:
    for name in ("vdw", "yukawa", "custom_1", "not a name", "x" * 40):
        with pytest.raises(InvalidValue, match="must be an identifier"):
            nt.scene.register(name, **GEL)  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="'length' must be in both"):
        nt.scene.register("other", **(GEL | {"units": {"strength": "", "radius": "m"}}))  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match=r"terms\.foam: no such law is registered .* registered: gel"):
        Scene(terms={"foam": {}})
    with pytest.raises(InvalidValue, match=r"terms\.gel has no parameter 'size'"):
        Scene(terms={"gel": {"strength": 1.0, "size": 2.0}})
    with pytest.raises(InvalidValue, match=r"terms\.gel needs strength \[N/m\]"):
        Scene(terms={"gel": {}})
    with pytest.raises(InvalidValue, match=r"terms\.gel\.strength = nan"):
        Scene(terms={"gel": {"strength": math.nan}})
    with pytest.raises(InvalidValue, match=r"terms\.gel: version 2 is needed, version 1 is registered"):
        Scene(terms={"gel": {"strength": 1.0, "version": 2}})
    path = tmp_path / "scene.toml"
    path.write_text("[terms.gel]\nstrength = 1\n")
    with pytest.raises(InvalidValue, match=r"\[terms.gel\] has no key strength;"):
        Scene.from_toml(path)
    for i in range(4):
        nt.scene.register(f"gel_{i}", **GEL)  # type: ignore[arg-type]
    full = Scene(terms={f"gel_{i}": {"strength": 1e-3} for i in range(4)})
    with pytest.raises(InvalidValue, match="at most 4"):
        full.add_term("gel", strength=1e-3)
    assert len(full.plan().explain()["terms"]) == len(ROWS)


def test_the_page_to_add_a_force_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = (Path(__file__).parents[2] / "docs" / "add_a_force.md").read_text(encoding="utf-8")
    (program,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    (table,) = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    made: dict[str, Scene] = {}
    exec(program, made)
    assert "gel: tabulated" in capsys.readouterr().out
    path = tmp_path / "scene.toml"
    path.write_text(table)
    assert Scene.from_toml(path) == made["scene"]
    listed = re.findall(r"^\| `(\S+)`(?:, `(\S+)`)? \|", page, re.MULTILINE)
    files = [name for row in listed for name in row if "/" in name]
    assert len(files) == 8
    assert all((Path(__file__).parents[2] / name).exists() for name in files)


def test_an_installed_package_registers_its_law(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the entry point of its name, so that the command knows it, too."""
    _known.clear()

    def found(group: str, name: str) -> list[EntryPoint]:
        return [EntryPoint(name, f"{__name__}:{name}", group)] if name in ("install_gel", "install_none") else []

    monkeypatch.setattr("nanotouch.scene._custom.entry_points", found)
    assert Scene(terms={"install_gel": {"strength": 0.4}}).plan().law("install_gel", 1e-9).F > 0.0
    with pytest.raises(Error, match=r"the law 'install_none' .* cannot be registered"):
        Scene(terms={"install_none": {}})


def install_gel() -> None:
    nt.scene.register("install_gel", **GEL)  # type: ignore[arg-type]


def test_a_session_touches_it_and_records_its_name() -> None:
    session = Session(gelled(), relative_accuracy=1e-4)
    assert "gel" in [term.name for term in session.plan.terms]
    session.advance(0.01)
    scene = session.metadata()["scene"]
    assert scene["terms"] == {"gel": {"version": 1, "strength": 0.4, "length": 2e-9, "radius": "tip.radius"}}
    assert Scene(**scene) == session.scene
    _known.clear()
    with pytest.raises(InvalidValue, match=r"terms\.gel: no such law is registered"):
        Scene(**scene)


def test_what_runs_never_calls_python() -> None:
    calls = 0

    def counted(gap: float, **values: float) -> float:
        nonlocal calls
        calls += 1
        return force(gap, **values)

    nt.scene.register("gel", **(GEL | {"force": counted}))  # type: ignore[arg-type]
    plan = gelled().plan()
    planned = calls
    assert 0 < planned < 5000
    plan.force(np.linspace(20e-9, -1e-9, 5000))
    assert calls == planned


def test_a_unit_that_no_file_could_spell_is_refused() -> None:
    law = {name: lambda gap, length: 0.0 for name in ("energy", "force", "stiffness", "bound")}
    with pytest.raises(InvalidValue, match="unit 'furlong' of 'length'; known are m, Pa"):
        nt.scene.register("far", parameters={"length": 1.0}, units={"length": "furlong"}, **law)


def test_a_parameter_may_have_any_name_but_those_that_are_taken() -> None:
    def law(gap: float, **values: float) -> float:
        return 0.0

    laws = dict.fromkeys(("energy", "force", "stiffness", "bound"), law)
    for name in ("name", "self", "force"):
        nt.scene.register("odd", parameters={name: 1.0}, units={name: ""}, **laws)
        assert Scene(terms={"odd": {name: 2.0}}).terms["odd"] == {name: 2.0}
    for name in ("gap", "version", "not a name"):
        with pytest.raises(InvalidValue, match=f"no parameter may be called {name}"):
            nt.scene.register("odd", parameters={name: 1.0}, units={name: ""}, **laws)
    for followed, match in (
        ("tip.radius", r"length \[Pa\] cannot follow tip.radius \[m\]"),
        ("tip.shape", "is a number"),
    ):
        nt.scene.register("odd", parameters={"length": followed}, units={"length": "Pa"}, **laws)
        with pytest.raises(InvalidValue, match=match):
            Scene(terms={"odd": {}})


def test_parameters_are_set_by_add_term_alone() -> None:
    """What stands in `terms` follows the scene; to assign there would change nothing."""
    scene = gelled()
    with pytest.raises(TypeError):
        scene.terms["gel"]["strength"] = 0.1  # type: ignore[index]
    with pytest.raises(TypeError):
        scene.terms["other"] = {}  # type: ignore[index]
    scene.add_term("gel", strength=0.1)
    assert scene.terms["gel"]["strength"] == 0.1


def test_a_recording_with_a_law_is_replayed_and_its_scene_needs_the_law(tmp_path: Path) -> None:
    """A replay is of what was measured, so it needs no law; the scene of it does, in its version."""
    session = Session(gelled(), relative_accuracy=1e-4)
    columns, path = session.advance(0.05), tmp_path / "touch.mcap"
    record.write(path, record.Recording(columns, session.metadata()))
    read = record.read(path)
    for version, refusal in ((1, ""), (2, "version 1 is needed, version 2 is registered"), (0, "no such law")):
        _known.clear()
        if version:
            nt.scene.register("gel", **(GEL | {"version": version}))  # type: ignore[arg-type]
        again = read.replay()
        for name in ("motor_force", "stage_command", "state"):
            np.testing.assert_array_equal(again.columns[name], columns[name], err_msg=name)
        if not refusal:
            assert Scene(**read.metadata["scene"]).plan(1e-4).law("gel", 1e-9) == session.plan.law("gel", 1e-9)
            continue
        with pytest.raises(InvalidValue, match=rf"terms\.gel: {refusal}"):
            Scene(**read.metadata["scene"])
