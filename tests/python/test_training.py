# SPDX-License-Identifier: BSD-3-Clause
"""Tasks without a window: each row of the C library's table is solved by an operator that sees what a person sees;
wrong answers do not pass."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nanotouch as nt
import pytest
from nanotouch_app.live.board import TASKS
from nanotouch_app.live.host import Host
from nanotouch_app.live.subject import PRESETS, of_preset
from touching import Operator, newest, result_of

PAGES = [task for task in TASKS.values() if task["is_page"]]


def begun(name: str, tmp_path: Path, preset: str = "") -> tuple[Host, list[dict[str, Any]]]:
    told: list[dict[str, Any]] = []
    host = Host(of_preset(preset or TASKS[name]["preset"]), told.append, stepped=True)
    host.folder = tmp_path
    host.advance(0.05)
    host.answer({"do": "task", "name": name, "seed": 1})
    return host, told


def operator(host: Host) -> Operator:
    return Operator(host, float(host.session.scene.range.maximum_load))


@pytest.fixture(params=[name for name, task in TASKS.items() if not task["is_page"]])
def solved(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[tuple[Host, list[dict[str, Any]]]]:
    host, told = begun(request.param, tmp_path)
    host.core.solve()
    host.report()
    yield host, told
    host.close()


def test_each_task_is_solved_by_its_ideal_operator(solved: tuple[Host, list[dict[str, Any]]], tmp_path: Path) -> None:
    host, told = solved
    last = newest(told, "task")
    assert last["passed"], last["now"]
    assert "{" not in last["now"]
    assert last["score"] > 80.0 or not last["scored"], last["now"]
    assert Path(last["saved"]).parent == tmp_path
    head, rows = result_of(host)
    assert Path(last["saved"]).read_text(encoding="utf-8") == host.core.result()
    assert (head["task"], head["passed"], head["said"]) == (last["name"], "True", last["now"])
    assert len(rows) > 5
    assert {len(row) for row in rows} == {len(rows[0])}
    assert not [message for message in told if message["tell"] == "refused"]


def test_the_first_page_begins_the_lesson_and_each_one_leads_to_the_next() -> None:
    names = [page["name"] for page in PAGES]
    assert [page["follows"] for page in PAGES] == [*names[1:], ""]
    assert {task["preset"] for task in TASKS.values()} <= set(PRESETS)


def test_a_heavy_hand_does_not_find_the_surface_lightly(tmp_path: Path) -> None:
    host, told = begun("find", tmp_path)
    host.answer({"do": "press", "on": True})
    host.advance(3.0)
    task, (figures, _) = newest(told, "task"), result_of(host)
    host.close()
    largest, limit = float(figures["largest force [N]"]), float(figures["limit [N]"])
    assert not task["passed"]
    assert largest > limit
    assert task["score"] == pytest.approx(100.0 * limit / largest)


def test_a_wrong_number_does_not_pass_and_a_bad_one_is_refused(tmp_path: Path) -> None:
    host, told = begun("pull_off", tmp_path)
    host.answer({"do": "say", "text": "18nN"})
    assert newest(told, "refused")["why"] == "not yet: 3 pull-offs are missing"
    hand = operator(host)
    for _ in range(3):
        hand.down_to(0.05 * hand.load)
        hand.up()
    host.answer({"do": "say", "text": "18 apples"})
    assert "apples" in newest(told, "refused")["why"]
    host.answer({"do": "say", "text": "25nN"})
    task, (figures, _) = newest(told, "task"), result_of(host)
    host.close()
    mean, error = float(figures["measured [N]"]), float(figures["error"])
    assert not task["passed"]
    assert mean == pytest.approx(nt.Scene().plan().pull_off_force, rel=0.1)
    assert error == pytest.approx(25e-9 / mean - 1.0, rel=1e-6)


def test_a_hand_that_stays_keeps_no_force_over_a_relief(tmp_path: Path) -> None:
    host, told = begun("steady", tmp_path)
    hand = operator(host)
    hand.down_to(0.9 * 0.3 * hand.load)
    hand.wait(11.0)
    task = newest(told, "task")
    host.close()
    assert not task["passed"]
    assert "hardly moved" in task["now"]


def test_samples_are_not_exchanged_under_the_tip(tmp_path: Path) -> None:
    host, told = begun("stiffer", tmp_path)
    hand = operator(host)
    hand.down_to(0.1 * hand.load)
    host.answer({"do": "choose", "number": 1})
    host.close()
    refused = [message["why"] for message in told if message["tell"] == "refused"]
    assert refused == ["not yet: lift the tip first"]


def test_a_sample_without_a_relaxation_time_has_no_slower_one(tmp_path: Path) -> None:
    for preset in ("silicon_in_air", "polymer_gel"):  # elastic; a power law, which has no time of its own
        host, told = begun("slower", tmp_path, preset)
        assert newest(told, "refused")["why"].endswith("this sample has no relaxation time; lay chondrocyte")
        host.close()


def test_who_always_says_the_same_does_not_find_the_slower_one(tmp_path: Path) -> None:
    """The two samples are apart by a ratio of 4 at first; at the end the sample is again what it was."""
    host, told = begun("slower", tmp_path)
    own = 2.8 / 11.7  # [s]
    assert host.session.scene.rheology.relaxation_time_1 in (pytest.approx(2.0 * own), pytest.approx(0.5 * own))
    for _ in range(100):
        host.answer({"do": "choose", "number": 2})
    task, (figures, rows) = newest(told, "task"), result_of(host)
    assert host.session.scene.rheology.relaxation_time_1 == pytest.approx(own, rel=1e-12)
    host.close()
    assert not task["passed"]
    assert float(figures["Weber fraction of the relaxation time"]) > 1.0
    assert rows[0] == ["pair", "ratio of relaxation times", "slower", "answer", "right"]


def test_what_a_task_hides_is_shown_again_at_its_end(tmp_path: Path) -> None:
    host, told = begun("trace", tmp_path)
    assert newest(told, "task")["hides"] == ["contact", "surface"]
    host.answer({"do": "task", "name": ""})
    assert newest(told, "task") == {"tell": "task", "name": ""}
    host.answer({"do": "task", "name": "nothing"})
    assert newest(told, "refused")["why"].startswith("task nothing: valid are find, pull_off")
    host.close()


@pytest.mark.parametrize("name", ["silicone_rubber", "polyester"])
def test_what_is_felt_of_the_modulus(name: str, tmp_path: Path) -> None:
    """d ln k/d ln E = 2/3 k_c/(k_c + k_i) for Hertz' contact under 0.4 of the load: k_i = (6 E*^2 R F)^(1/3)."""
    host = Host(of_preset(name), lambda message: None, stepped=True)
    for field in ("adhesion.work_of_adhesion", "adhesion.tip_surface_energy"):
        host.answer({"do": "change", "what": "scene", "field": field, "value": 0.0})
    told: list[dict[str, Any]] = []
    host.tell = told.append
    host.advance(0.01)
    host.answer({"do": "task", "name": "stiffer", "seed": 1})
    scene, spring = host.session.scene, host.core.state["stiffness"]
    # a pair begins with a sample that is sqrt(3) as stiff, or as soft; words are of the sample as it was
    modulus = float(of_preset(name).scene.sample.youngs_modulus)
    compliance = (1.0 - scene.sample.poisson_ratio**2) / modulus
    compliance += (1.0 - scene.tip.poisson_ratio**2) / scene.tip.youngs_modulus
    k = (6.0 * compliance**-2 * scene.tip.radius * 0.4 * scene.range.maximum_load) ** (1.0 / 3.0)
    host.close()
    found = re.search(r"Of 10 % of the modulus ([\d.]+) % are felt", newest(told, "task")["words"])
    assert found is not None
    assert float(found[1]) == pytest.approx(10.0 * 2.0 / 3.0 * spring / (spring + k), rel=0.03, abs=0.05)


def test_a_sample_stiffer_than_the_lever_is_told(tmp_path: Path) -> None:
    for preset, stiffer in (("cell_in_liquid", False), ("silicone_rubber", True)):
        host, told = begun("stiffer", tmp_path, preset)
        assert ("feel like the lever" in newest(told, "task")["words"]) == stiffer
        host.close()


def test_the_hand_stays_over_the_surface(tmp_path: Path) -> None:
    host = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True)
    host.advance(0.05)
    for _ in range(20):
        host.answer({"do": "move", "way": (100e-9, -100e-9, 0.0)})
        host.advance(0.05)
    frame = host.observer.newest()
    assert frame["reasons"] == 0
    host.answer({"do": "move", "way": (-50e-9, 0.0, 0.0)})  # it turns at once
    host.advance(0.2)
    assert host.observer.newest()["tip_position"][0] == pytest.approx(450e-9, abs=2e-9)
    host.close()


def test_the_lesson_predicts_touches_and_explains(tmp_path: Path) -> None:
    """All pages in a row by their own way to the next one; each right answer is that of the simulation."""
    told: list[dict[str, Any]] = []
    host = Host(of_preset("silicon_in_air"), told.append, stepped=True)
    host.answer({"do": "task", "name": "lesson", "lay": True})
    for page in PAGES:
        host.advance(0.05)
        assert host.core.state["task"] == page["name"]
        assert len(newest(told, "task")["choices"]) == 3
        host.answer({"do": "wheel", "steps": 1.0})
        assert "first say what you expect" in newest(told, "refused")["why"]
        told.clear()
        host.core.solve()
        host.report()
        task = newest(told, "task")
        assert task["now"].startswith("You were right.")
        assert not re.search(r"\{|: -|with - ", task["now"])  # each page has its sample as it was meant
        assert not [message for message in told if message["tell"] == "refused"]
        if page["follows"]:
            host.answer({"do": "choose", "number": 0})
    host.close()
    assert page is PAGES[-1]


def test_a_choice_that_is_not_offered_is_refused(tmp_path: Path) -> None:
    host, told = begun("stiffer", tmp_path)
    for number in (-1, 4, 7):
        host.answer({"do": "choose", "number": number})
        assert newest(told, "refused")["why"] == f"choice {number + 1}: valid is 1 .. 4"
    for number in (float("nan"), float("inf"), 1e300):
        told.clear()
        host.answer({"do": "choose", "number": number})
        assert ": valid is 1 .. 4" in newest(told, "refused")["why"]
    for seed in (-1, float("nan"), 1e17):
        told.clear()
        host.answer({"do": "task", "name": "stiffer", "seed": seed})
        assert ": valid is 0 .. 9" in newest(told, "refused")["why"]
    host.close()


def test_a_task_begins_on_its_sample_as_it_was_meant() -> None:
    host = Host(of_preset("mica_in_air"), lambda message: None, stepped=True)
    host.answer({"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.3})
    assert host.session.scene["medium.relative_humidity"] == 0.3
    host.answer({"do": "task", "name": "find"})  # on what lies there
    assert host.session.scene["medium.relative_humidity"] == 0.3
    host.answer({"do": "task", "name": "lesson", "lay": True})
    assert host.session.scene["medium.relative_humidity"] == 0.0
    host.close()


def test_what_the_lesson_says_is_what_is_measured(tmp_path: Path) -> None:
    host, told = begun("lesson-2", tmp_path)
    host.answer({"do": "choose", "number": 2})  # larger: wrong
    hand = operator(host)
    for _ in range(2):
        hand.down_to(0.1 * hand.load)
        hand.up()
    task, (figures, _) = newest(told, "task"), result_of(host)
    host.close()
    assert not task["passed"]
    assert "You expected something else: it becomes smaller." in task["now"]
    wet = of_preset("silicon_in_air").scene.plan().pull_off_force
    assert float(figures["pull-off 1 [N]"]) == pytest.approx(wet, rel=0.1)
    assert float(figures["pull-off 2 [N]"]) < 0.7 * wet


def test_the_tip_jumps_where_the_spring_is_too_soft(tmp_path: Path) -> None:
    """Van der Waals alone, F = -H R/(6 (h + z0)^2): h = (H R/(3 k))^(1/3) - z0."""
    host, told = begun("lesson-1", tmp_path)
    host.core.solve()
    host.report()
    spring = 0.2  # a fifth of the lever's
    host.close()
    for part, words in ((1.0, "that is at"), (0.25, "N/m at")):
        analytic = (1e-19 * 25e-9 / (3.0 * part * spring)) ** (1.0 / 3.0) - 3.49e-10
        found = re.search(rf"{words} ([\d.]+) nm", newest(told, "task")["now"])
        assert found is not None
        assert float(found[1]) == pytest.approx(1e9 * analytic, rel=0.02)
