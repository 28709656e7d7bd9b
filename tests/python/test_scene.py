# SPDX-License-Identifier: BSD-3-Clause
"""Scene, rig, settings and plan: fields, TOML with a unit in every key, refusals that name key, value and range."""

from __future__ import annotations

import copy
import json
import math
import pickle
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from nanotouch import Demand, Rig, Scene, Settings, presets
from nanotouch.contact import geometry
from nanotouch.errors import InvalidValue, ReadError
from nanotouch.scene import Quantity, read_toml
from nanotouch.scene.description import Description, Field
from nanotouch.units import UNITS, from_si, key_spellings, to_si

KINDS: list[type[Description]] = [Scene, Rig, Settings, Demand]
NUMBERS = [(kind, field) for kind in KINDS for field in kind.fields.values() if not field.choices]
CHOICES = [(kind, field) for kind in KINDS for field in kind.fields.values() if field.choices]
FIELDS = [pytest.param(kind, field, id=field.name) for kind, field in NUMBERS]
KEYS = [
    pytest.param(kind, field, key, factor, id=f"{field.name.split('.')[0]}.{key}")
    for kind, field in NUMBERS
    for key, factor in key_spellings(field.name.split(".")[1], field.unit).items()
]
every_kind = pytest.mark.parametrize("kind", KINDS)
every_choice = pytest.mark.parametrize(("kind", "field"), [pytest.param(k, f, id=f.name) for k, f in CHOICES])
every_field = pytest.mark.parametrize(("kind", "field"), FIELDS)


# ---- fields ----


def test_the_words_of_a_choice_are_those_of_its_field() -> None:
    """Type checkers need them written out; they are in the order of the C library's numbers."""
    assert get_args(Quantity) == Demand.fields["demand.quantity"].choices
    assert Scene.fields["tip.shape"].choices == geometry.KINDS


@every_field
def test_field_is_documented_and_its_default_valid(kind: type[Description], field: Field) -> None:
    assert field.doc
    assert field.unit in UNITS
    assert field.minimum <= kind()[field.name] <= field.maximum


@every_field
def test_field_is_attribute_and_item(kind: type[Description], field: Field) -> None:
    made = kind()
    section, key = field.name.split(".")
    setattr(getattr(made, section), key, field.maximum)
    assert made[field.name] == getattr(getattr(made, section), key) == field.maximum
    made[field.name] = field.minimum
    assert getattr(getattr(made, section), key) == field.minimum
    made.check()
    assert kind(**{section: {key: field.maximum}})[field.name] == field.maximum


@every_field
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, "above", "below"])
def test_value_out_of_range_is_refused(kind: type[Description], field: Field, value: Any) -> None:
    made = kind()
    before = made[field.name]
    if value == "above":
        value = 2.0 * field.maximum
    if value == "below":
        value = field.minimum - 0.5 * abs(field.minimum) - 1e-30
    with pytest.raises(InvalidValue) as caught:
        made[field.name] = value
    message = str(caught.value)
    assert message.startswith(f"{field.name} = {value:g}")
    assert f"{field.minimum:.6g} .. {field.maximum:.6g}" in message
    assert field.unit in message
    assert made[field.name] == before


@every_choice
def test_choices_have_names(kind: type[Description], field: Field) -> None:
    made = kind()
    section, key = field.name.split(".")
    for number, choice in enumerate(field.choices):
        setattr(getattr(made, section), key, choice)
        assert getattr(getattr(made, section), key) == choice
        assert made[field.name] == number
        assert kind.from_tables({section: {key: choice}})[field.name] == number
        assert kind(**{section: {key: number}}).plain(field.name) == choice
    if field.choices == ("no", "yes"):
        assert kind.from_tables({section: {key: True}}).plain(field.name) == "yes"
    for wrong in ("maybe", -1, len(field.choices), 0.5, None):
        with pytest.raises(InvalidValue, match=f"valid are {field.choices[0]}, "):
            made[field.name] = wrong  # type: ignore[assignment]
        with pytest.raises(InvalidValue, match=rf"\[{section}\] {key} = "):
            kind.from_tables({section: {key: wrong}})


@every_kind
def test_names_that_do_not_exist(kind: type[Description]) -> None:
    made = kind()
    section = kind.sections()[0]
    with pytest.raises(AttributeError, match="no section 'tpi'"):
        made.tpi  # noqa: B018
    with pytest.raises(AttributeError, match="radus"):
        getattr(made, section).radus  # noqa: B018
    with pytest.raises(AttributeError, match="radus"):
        getattr(made, section).radus = 1.0
    with pytest.raises(AttributeError, match="set a field of a section"):
        setattr(made, section, 3.0)
    with pytest.raises(AttributeError, match="set a field of a section"):
        made.tpi = 3.0  # type: ignore[assignment]
    with pytest.raises(KeyError):
        made["tip.radus"]
    with pytest.raises(KeyError):
        made["tip.radus"] = 1.0
    assert made.get("tip.radus") is None
    with pytest.raises(InvalidValue, match="no section 'tpi'"):
        kind(tpi={})
    with pytest.raises(InvalidValue, match="no field 'radus'"):
        kind(**{section: {"radus": 1.0}})
    with pytest.raises(InvalidValue, match="must be a table"):
        kind(**{section: 3.0})  # type: ignore[arg-type]


@every_kind
def test_copies_are_equal_and_independent(kind: type[Description]) -> None:
    made = kind()
    name, field = next((name, field) for name, field in kind.fields.items() if not field.choices)
    made[name] = field.minimum
    for other in (made.copy(), copy.copy(made), copy.deepcopy(made), pickle.loads(pickle.dumps(made))):
        assert type(other) is kind
        assert other == made
        other[name] = field.maximum
        assert made[name] == field.minimum
        assert other != made


@every_kind
def test_a_repr_is_what_one_would_write(kind: type[Description]) -> None:
    made = kind()
    for name, field in kind.fields.items():
        made[name] = 1.0 if field.choices else field.minimum
    assert eval(repr(made), {kind.__name__: kind, "inf": float("inf")}) == made


def test_sections_are_views() -> None:
    scene = Scene()
    tip = scene.tip
    for other in (copy.copy(tip), pickle.loads(pickle.dumps(tip))):
        assert other.radius == tip.radius
    tip.radius = 30e-9
    assert scene["tip.radius"] == 30e-9
    assert {"shape", "radius", "half_angle", "youngs_modulus"} <= set(dir(tip))
    assert repr(tip).startswith("tip(shape=paraboloid, sides=0, radius=3e-08, ")
    assert repr(scene) == "Scene(tip={'radius': 3e-08})"
    assert repr(Scene()) == "Scene()"
    assert {"tip", "sample", "medium", "adhesion"} <= set(dir(scene))


@every_kind
def test_dict_is_json(kind: type[Description]) -> None:
    nested = json.loads(json.dumps(kind().to_dict()))
    flat = {f"{section}.{key}": value for section, keys in nested.items() for key, value in keys.items()}
    assert flat == {name: kind().plain(name) for name in kind.fields}


def test_defaults_are_the_paper() -> None:
    scene, rig = Scene(), Rig()
    assert (scene.tip.radius, scene.medium.relative_humidity) == (20e-9, 0.4)
    assert (scene.sample.youngs_modulus, scene.sample.poisson_ratio) == (135e9, 0.35)
    assert (rig.probe.spring_constant, rig.probe.sensitivity) == (8.0, 0.033e-6)
    assert (rig.master.mass, rig.master.damping) == (0.1, 100.0)
    assert Settings().gains.rate == 10e3
    assert Settings().gains.force_gain == 2.0


# ---- TOML ----


@pytest.mark.parametrize(("kind", "field", "key", "factor"), KEYS)
@given(part=st.floats(0.0, 1.0))
@settings(max_examples=20)
@example(part=0.0)
@example(part=1.0)
def test_every_key_round_trips(kind: type[Description], field: Field, key: str, factor: float, part: float) -> None:
    """In every unit, over the whole range."""
    si = field.minimum + part * (field.maximum - field.minimum)
    written = from_si(min(si, field.maximum), factor)
    if not field.minimum <= to_si(written, factor) <= field.maximum:  # one rounding beyond the end
        written = math.nextafter(written, from_si(0.5 * (field.minimum + field.maximum), factor))
    made = kind.from_tables({field.name.split(".")[0]: {key: written}})
    assert made[field.name] == to_si(written, factor)
    assert made[field.name] == pytest.approx(si, rel=1e-15)


def test_file(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text("""
[tip]
radius_nm = 30
half_angle_deg = 20.0
[medium]
relative_humidity_percent = 61
surface_tension_mN_per_m = 72
[adhesion]
work_of_adhesion_mJ_per_m2 = 50
[probe]
spring_constant_N_per_m = 1
[gains]
force_gain = 1
rate_kHz = 5
delay = 2
""")
    scene, rig, settings = read_toml(file)
    assert scene.tip.radius == 30e-9
    assert scene.tip.half_angle == pytest.approx(math.radians(20.0), rel=1e-15)
    assert scene.medium.relative_humidity == 0.61
    assert scene.medium.surface_tension == 0.072
    assert scene.adhesion.work_of_adhesion == 0.05
    assert rig.probe.spring_constant == 1.0
    assert (settings.gains.force_gain, settings.gains.rate, settings.gains.delay) == (1.0, 5e3, 2.0)
    # what is not named keeps its default; settings follow the rig
    assert scene.sample.youngs_modulus == 135e9
    assert settings.limits.force == Settings.for_rig(rig).limits.force != Settings().limits.force
    assert Scene.from_toml(file) == scene
    assert Rig.from_toml(file) == rig
    assert Settings.from_toml(file, rig) == settings


def refusal(text: str, tmp_path: Path) -> str:
    file = tmp_path / "scene.toml"
    file.write_text(text)
    with pytest.raises(InvalidValue) as caught:
        read_toml(file)
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[tpi]\nradius_nm = 20", ["[tpi]", "known are", "tip", "probe", "gains"]),
        ("tip = 3", ["[tip]", "table", "3"]),
        ("radius_nm = 3", ["[radius_nm]", "known are"]),
        ("[tip]\nradus_nm = 20", ["[tip]", "radus_nm", "did you mean radius_nm"]),
        ("[tip]\nfoo = 20", ["[tip]", "foo", "it has", "radius"]),
        ("[tip]\nradius = 20", ["[tip] radius", "lacks its unit", "radius_nm"]),
        ("[tip]\nradius_GPa = 20", ["[tip]", "radius_GPa", "did you mean"]),
        ("[tip]\nradius_nm = true", ["[tip] radius_nm = True", "number"]),
        ("[tip]\nradius_nm = '20'", ["[tip] radius_nm = '20'", "number"]),
        ("[tip]\nradius_nm = [20]", ["[tip] radius_nm = [20]", "number"]),
        ("[tip]\nradius_nm = nan", ["[tip] radius_nm = nan", "0.1 .. 1e+06"]),
        ("[tip]\nradius_nm = inf", ["[tip] radius_nm = inf", "0.1 .. 1e+06"]),
        ("[tip]\nradius_nm = 0", ["[tip] radius_nm = 0", "0.1 .. 1e+06"]),
        ("[tip]\nradius_m = 20", ["[tip] radius_m = 20", "apex radius R", "1e-10 .. 0.001"]),  # nm meant
        ("[tip]\nradius_nm = 20\nradius_m = 20e-9", ["[tip]", "both radius_nm and radius_m"]),
        ("[medium]\nrelative_humidity = 40", ["relative_humidity = 40", "0 .. 1"]),  # per cent meant
        ("[probe]\nspring_constant_N_per_m = 0", ["spring_constant_N_per_m = 0", "k_c", "0.0001 .. 10000"]),
        ("[gains]\nrate_Hz = -1", ["rate_Hz = -1", "10 .. 1e+06"]),
    ],
)
def test_refusals(text: str, words: list[str], tmp_path: Path) -> None:
    message = refusal(text, tmp_path)
    assert all(word in message for word in words), message
    assert "\n" not in message


def test_huge_integer(tmp_path: Path) -> None:
    assert "radius_nm" in refusal(f"[tip]\nradius_nm = {10**400}", tmp_path)


@pytest.mark.parametrize("content", [b"not toml", b"\xff\xfe", b"[tip\n"])
def test_what_is_not_toml(content: bytes, tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_bytes(content)
    with pytest.raises(ReadError, match=r"scene\.toml is not a TOML file"):
        read_toml(file)


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"nowhere\.toml: no such file"):
        read_toml(tmp_path / "nowhere.toml")


@pytest.mark.parametrize("kind", [Scene, Rig])
def test_unknown_section_is_refused_by_each(kind: type[Description]) -> None:
    with pytest.raises(InvalidValue, match=r"unknown section \[tpi\]"):
        kind.from_tables({"tpi": {}})


# ---- presets ----

PRESETS = [name for name in vars(presets) if name[0].islower() and name.islower()]
PRESETS = [name for name in PRESETS if name not in ("annotations", "math")]
NO_PULL = ("cell_in_liquid", "chondrocyte", "polymer_gel")


def test_presets_and_the_papers_scenes_are_there() -> None:
    assert set(PRESETS) == {
        *presets.FELT, "paper_silicon", "paper_gold", "paper_mica", "paper_polyester", "paper_silicone_rubber",
        "paper_inas",
    }  # fmt: skip


@pytest.mark.parametrize("name", PRESETS)
def test_preset_plans(name: str) -> None:
    scene, rig = getattr(presets, name)()
    scene.check()
    rig.check()
    plan = scene.plan()
    assert (plan.pull_off_force > 1e-14) == (name not in NO_PULL)  # of the cell 1 fN of tail reaches out of its brush
    # every one of the paper is loaded enough to leave small contacts at 2.2 uN
    texts = [warning.text for warning in plan.warnings]
    assert ("contact radius over tip radius at the largest load" in texts) == name.startswith("paper_")


def test_gold_pulls_as_in_figure_6() -> None:
    """At contact the capillary force 4 pi gamma R = 27.14 nN, from 2 e = 10 nm limited to its range 2 r1."""
    scene, _ = presets.paper_gold()
    plan = scene.plan()
    assert plan.explain()["adhesion_source"] == "meniscus"
    assert plan.pull_off_force == pytest.approx(4 * math.pi * 0.072 * 30e-9, rel=0.02)
    assert "electrostatic: left out, at most 261.7 pN, 0.96 % of the pull-off" in str(
        scene.plan(relative_accuracy=0.02)
    )
    assert "electrostatic: of the sphere" in str(scene.plan(relative_accuracy=1e-3))


@pytest.mark.parametrize("value", ["3e-8", "20", b"3", None, True, np.bool_(True), [2e-8], 1j, np.array([2e-8])])
def test_what_is_no_number_is_refused_by_name(value: object) -> None:
    with pytest.raises(InvalidValue, match=r"^tip\.radius = .*: it must be a number$"):
        Scene(tip={"radius": value})  # type: ignore[dict-item]


@pytest.mark.parametrize("value", [3e-8, np.float64(3e-8), np.array(3e-8)])
def test_numbers_of_numpy_are_numbers(value: float) -> None:
    assert Scene(tip={"radius": value}).tip.radius == 3e-8
    assert Scene(tip={"conducting": np.bool_(False)}).tip.conducting == "no"  # type: ignore[dict-item]
