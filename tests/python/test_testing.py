# SPDX-License-Identifier: BSD-3-Clause
"""The door for other people's tests: assertions say what happened, fixtures give the same touch each time."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import testing
from nanotouch.errors import InvalidValue
from nanotouch.touch.record import Recording

pytest_plugins = ("pytester",)
EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "examples" / "testing"
QUIET = ("-p", "no:cacheprovider", "-p", "no:xdist")
PERIOD = 1e-4  # s


def recorded(**columns: list[float]) -> Recording:
    """Rows of one period each, from 1.2 s on."""
    rows = len(next(iter(columns.values())))
    time = 1.2 + PERIOD * np.arange(rows)
    return Recording({"time": time} | {name: np.asarray(values) for name, values in columns.items()})


def message(check: Callable[[], object]) -> str:
    with pytest.raises(AssertionError) as raised:
        check()
    return str(raised.value)


def test_a_force_above_its_limit_is_told_with_what_came_of_it() -> None:
    force = [0.0, 399e-9, 405e-9, 412e-9, 300e-9, 0.0]
    touch = recorded(tip_force=force, state=[0, 0, 0, 0, 0, 1], reasons=[0, 0, 0, 0, 0, 1])
    said = message(lambda: testing.assert_force_below(touch, 400e-9))
    assert said == "tip force 412 nN exceeded 400 nN at 1.2002 s, and most at 1.2003 s; HOLD came 3 ticks later"
    testing.assert_force_below(touch, 412e-9)
    free = recorded(tip_force=force, state=[0] * 6)
    assert "nothing stopped it" in message(lambda: testing.assert_force_below(free, 400e-9))
    pulls = recorded(tip_force=[-413e-9], state=[2])
    assert "413 nN exceeded 412 nN at 1.2 s; it was in RETRACT" in message(
        lambda: testing.assert_force_below(pulls, 412e-9)
    )
    lost = recorded(tip_force=[0.0, np.nan])
    assert "not known at 1.2001 s" in message(lambda: testing.assert_force_below(lost, 1.0))


@pytest.mark.parametrize(
    ("limit", "channel", "words"),
    [
        (-1e-9, "tip_force", "limit = -1e-09 N: valid is a finite force above 0 N"),
        (float("nan"), "tip_force", "limit = nan N"),
        ("400 nN", "tip_force", "limit = '400 nN': it must be a number [N]"),
        (400, "tip_force", "limit = 400 N: no load on a sample is above 1 N; 400 nN are 400e-9"),
        (1e-9, "gap", "channel 'gap' is no force; valid are operator_force"),
        (1e-9, "slave_force", "the recording has no slave_force; recorded: time, tip_force"),
    ],
)
def test_what_is_asked_for_must_make_sense(limit: Any, channel: str, words: str) -> None:
    with pytest.raises(InvalidValue, match=re.escape(words)):
        testing.assert_force_below(recorded(tip_force=[0.0]), limit, channel)


CHECKS: dict[str, Callable[[Any], object]] = {
    "runs": testing.assert_runs,
    "force": lambda touch: testing.assert_force_below(touch, 1.0),
    "reacts": lambda touch: testing.assert_reacts(touch, "HOLD", after=0.0, within=1.0),
    "guarantee": lambda touch: testing.assert_guarantee_kept(nt.Session(), touch),
    "same": lambda touch: testing.assert_same(touch, touch),
}


@pytest.mark.parametrize("check", CHECKS.values(), ids=CHECKS)
def test_nothing_passes_for_want_of_rows(check: Callable[[Any], object]) -> None:
    """As of a session with recorded=False, or of a hand without steps."""
    nothing = nt.Session(recorded=False).run(operator=[nt.Input(0.5, 0.0, 0.0, 0.01)])
    with pytest.raises(InvalidValue, match="has no rows"):
        check(nothing)
    with pytest.raises(InvalidValue, match="a dict is no Recording"):
        check({"time": np.zeros(3), "state": np.zeros(3)})


def test_times_and_ticks_are_told_to_the_period_also_late_and_of_a_selection() -> None:
    rows = 200
    time = 4321.0 + PERIOD * np.arange(rows)
    state = np.where(np.arange(rows) < 123, 0, 1)
    columns = {"time": time, "state": state, "tip_force": np.where(np.arange(rows) < 100, 0.0, -2e-9)}
    touch = Recording(columns, {"loop_rate": 1e4})
    assert message(lambda: testing.assert_runs(touch)).startswith("HOLD at 4321.0123 s")
    for step in (1, 10):
        said = message(lambda step=step: testing.assert_force_below(touch[::step], 1e-9))
        ticks = 23 if step == 1 else 30  # the first row of the selection that is in HOLD: a lower bound is not known
        assert said == f"tip force -2 nN exceeded 1 nN at 4321.01 s; HOLD came {ticks} ticks later"


def test_a_reaction_is_in_time_to_the_tick_and_what_was_not_recorded_is_not_passed_over() -> None:
    def touch(row: int) -> Recording:
        return Recording({"time": PERIOD * np.arange(100), "state": np.arange(100) >= row}, {"loop_rate": 1e4})

    for within, last in ((3e-4, 53), (3.9e-4, 53), (4e-4, 54), (0.5e-4, 50)):
        testing.assert_reacts(touch(last), "HOLD", after=50 * PERIOD, within=within)
        said = message(lambda last=last, w=within: testing.assert_reacts(touch(last + 1), "HOLD", after=5e-3, within=w))
        assert said.endswith(f"HOLD at {(last + 1) * PERIOD:.4g} s: no reason is known, {100 * (last - 49)} µs later")
    assert "before 0.005 s" in message(lambda: testing.assert_reacts(touch(49), "HOLD", after=5e-3, within=1.0))
    with pytest.raises(InvalidValue, match=r"no rows between 0.004 s and 0.005 s: whether HOLD came before"):
        testing.assert_reacts(touch(45)[::10], "HOLD", after=5e-3, within=1.0)
    with pytest.raises(InvalidValue, match=r"no rows between 0.005 s and 0.006 s: whether HOLD came within 200 µs of"):
        testing.assert_reacts(touch(51)[::10], "HOLD", after=5e-3, within=2e-4)  # it did
    testing.assert_reacts(touch(51)[::10], "HOLD", after=5e-3, within=1e-3)
    unknown = Recording({"time": PERIOD * np.arange(3), "state": [0, 0, 7]})
    with pytest.raises(InvalidValue, match=r"state 7 at 0.0002 s: valid are 0 .. 3"):
        testing.assert_reacts(unknown, "HOLD", after=0.0, within=1.0)


def test_a_fault_has_its_reaction_in_time() -> None:
    faults = nt.Faults().add("nan", "deflection", at=0.05, duration=1e-3)
    with pytest.warns(UserWarning, match="stopped"):
        touch = nt.Session(seed=1, faults=faults).run(operator=[nt.Input(0.0, 0.0, 0.0, 0.2)])
    testing.assert_reacts(touch, "HOLD", after=0.05, within=2e-4)
    testing.assert_reacts(touch, "RETRACT", after=0.05, within=5e-4)  # in the second tick in a row
    early = message(lambda: testing.assert_reacts(touch, "HOLD", after=0.1, within=1e-3))
    assert early.startswith("HOLD at 0.05")
    assert early.endswith("before 0.1 s")
    late = message(lambda: testing.assert_reacts(touch, "LATCHED", after=0.05, within=1e-3))
    assert late.startswith("no LATCHED within 1 ms of 0.05 s; it ended in RETRACT at")
    stopped = message(lambda: testing.assert_runs(touch))
    assert stopped.startswith("HOLD at 0.05")
    assert "it was in RUN in 500 of" in stopped
    with pytest.raises(InvalidValue, match=r"after = 3.0 s: the recording holds 0 .. 0\."):
        testing.assert_reacts(touch, "HOLD", after=3.0, within=1e-3)


def test_what_a_session_promises_is_kept_and_a_broken_promise_is_told() -> None:
    session = nt.Session(seed=1)
    touch = session.run(operator=testing.scripted_hand(session, (2.0, 0.2), (-0.3, 0.1)))
    assert np.abs(touch.tip_force).max() > 50e-9  # it touched
    testing.assert_guarantee_kept(session, touch)
    testing.assert_runs(touch)
    worse = Recording(touch.columns | {"tip_force": 10.0 * touch.tip_force}, touch.metadata)
    assert message(lambda: testing.assert_guarantee_kept(session, worse)).startswith("tip force ")
    pushed = Recording(touch.columns | {"motor_force": touch.motor_force + 6.0}, touch.metadata)
    assert "motor force" in message(lambda: testing.assert_guarantee_kept(session, pushed))


def test_a_promise_is_of_its_own_session_grows_with_time_and_has_a_bound() -> None:
    session = nt.Session(seed=1)
    touch = Recording(session.advance(0.01), session.metadata())
    other = nt.Session(nt.Scene(sample={"youngs_modulus": 1e9}))
    with pytest.raises(InvalidValue, match="a session with another scene"):
        testing.assert_guarantee_kept(other, touch)
    promised = session.guarantee()
    late = touch.columns | {"time": np.linspace(0.0, 1000.0, len(touch)), "tip_force": np.zeros(len(touch))}
    late["tip_force"][-1] = promised.force + 999.0 * promised.zero_drift
    testing.assert_guarantee_kept(session, Recording(late, touch.metadata))
    late["tip_force"] = late["tip_force"][::-1]  # the same force at the beginning is too much
    assert "at 0 s" in message(lambda: testing.assert_guarantee_kept(session, Recording(late, touch.metadata)))
    unbounded = nt.Session(control="paper", minimum_margin=0, faults=nt.Faults().add("nan", "deflection", at=0.005))
    failed = Recording(unbounded.advance(0.01), unbounded.metadata())
    with pytest.raises(InvalidValue, match="no bound of the tip force with one failure: inf N"):
        testing.assert_guarantee_kept(unbounded, failed)


def test_recordings_are_compared_channel_by_channel() -> None:
    right = nt.Session(seed=1).run(operator=[nt.Input(0.5, 0.0, 0.0, 0.05)])
    again = nt.Session(seed=1).run(operator=[nt.Input(0.5, 0.0, 0.0, 0.05)])
    testing.assert_same(again, right, dict.fromkeys(right.columns, 0.0))
    stage = right.stage_position.copy()
    stage[[100, 200]] += [1e-9, 3e-9]
    moved = Recording(right.columns | {"stage_position": stage}, right.metadata)
    said = message(lambda: testing.assert_same(moved, right, {"stage_position": 0.5e-9})).splitlines()
    assert said[0] == f"1 of {len(right.columns)} channels differ:"
    assert said[1].startswith(f"  stage_position: 2 of {len(right)} rows by more than 500 pm; first at 0.01 s: ")
    assert "most at 0.02" in said[1]
    testing.assert_same(moved, right, {"stage_position": 4e-9})
    testing.assert_same(right, Recording({"time": right.time, "gap": right.gap}))  # what is expected is compared
    gone = Recording({"time": right.time})
    assert message(lambda: testing.assert_same(gone, Recording({"time": right.time, "gap": right.gap}))) == (
        "not recorded: gap"
    )
    assert "rows were recorded" in message(lambda: testing.assert_same(right[:10], right))
    nothing = Recording(right.columns | {"gap": np.full(len(right), np.nan)}, right.metadata)
    assert "gap" in message(lambda: testing.assert_same(nothing, right))
    testing.assert_same(nothing, nothing)
    state = Recording(right.columns | {"state": right.state + 1}, right.metadata)
    assert "state" in message(lambda: testing.assert_same(state, right))
    with pytest.raises(InvalidValue, match="no channel 'hight' is expected"):
        testing.assert_same(right, right, {"hight": 1.0})
    for wrong in (1e-9, {"gap": "1 nm"}, {"gap": None}):
        with pytest.raises(InvalidValue, match="tolerances"):
            testing.assert_same(right, right, wrong)  # type: ignore[arg-type]
    cut = Recording(right.columns, right.metadata | {"incomplete": "killed"})
    with pytest.raises(InvalidValue, match="expected is incomplete: killed"):
        testing.assert_same(right, cut)


class Pen(nt.hal.Master):
    """A position device at rest, 0.1 mm above its middle."""

    height = -1e-4

    def describe(self) -> nt.hal.Capabilities:
        return nt.hal.Capabilities()

    def read(self) -> nt.hal.Reading:
        return nt.hal.Reading(position=(np.nan, np.nan, self.height))


class Broken(Pen):
    height = np.nan


def test_a_backend_that_breaks_its_contract_is_told_in_words() -> None:
    assert testing.assert_conforms(Pen()).readings > 100
    said = message(lambda: testing.assert_conforms(Broken()))
    assert said.startswith("the contract of a backend is broken: ")
    assert "position" in said
    with pytest.raises(InvalidValue, match="duration = 0 s"):  # no fault of the backend's
        testing.assert_conforms(Pen(), duration=0)


class Stage(nt.hal.Slave):
    """Follows at once but for a share of the way; `swapped` takes x for y."""

    share, swapped, lowest = 0.8, False, -np.inf

    def open(self, host: nt.hal.Host) -> None:
        self.at, self.least = [0.0, 0.0, 1e-6], [0.0, 0.0, 1e-6]

    def describe(self) -> nt.hal.Capabilities:
        channel = nt.hal.Channel("stage", "m", driven=True, minimum=self.lowest, maximum=1e-5, safe=1e-6)
        return nt.hal.Capabilities(axes=3, feels=True, channels=(channel,))

    def read(self) -> nt.hal.Reading:
        x, y, z = self.at
        return nt.hal.Reading(position=(y, x, z) if self.swapped else (x, y, z), felt=(np.nan, np.nan, z * 1e-9))

    def write(self, action: nt.hal.Action) -> None:
        start = (0.0, 0.0, 1e-6)
        self.at = [a + self.share * (b - a) for a, b in zip(start, action.target, strict=True)]
        self.least = [min(a, b) for a, b in zip(self.at, self.least, strict=True)]


@pytest.mark.filterwarnings("ignore:the deflection is the same number")
def test_a_stage_that_does_not_go_where_it_is_sent_is_found_where_it_may_move() -> None:
    def stage(**what: Any) -> Stage:
        return type("Own", (Stage,), what)()

    assert [said for said in testing.assert_conforms(stage(share=0.0)).unchecked if "whether z goes" in said]
    good = stage()
    assert not [said for said in testing.assert_conforms(good, move=1e-7).unchecked if "goes where" in said]
    assert good.least == pytest.approx([0.0, 0.0, 1e-6 - 0.8e-7])  # away from the sample
    cramped = stage(lowest=1e-6)
    testing.assert_conforms(cramped, move=1e-7)
    assert cramped.least[2] == pytest.approx(1e-6)  # no room there
    for what in ({"share": 0.0}, {"share": -1.0}, {"share": 1.6}, {"share": 1e3}, {"swapped": True}):
        said = message(lambda what=what: testing.assert_conforms(stage(**what), move=1e-7))
        assert "error of x after a move, over the move = " in said
    assert "room for a move along z" in message(lambda: testing.assert_conforms(stage(lowest=0.95e-6), move=1e-5))
    for wrong in (-1e-9, 1e-3, float("nan")):
        with pytest.raises(InvalidValue, match=r"valid is 0 \.\. 0.0001 m"):
            testing.assert_conforms(stage(), move=wrong)


PROGRAM = """
import nanotouch as nt
from nanotouch import testing

def test_touch(nt_session, nt_golden):
    session = nt_session(faults=nt.Faults())
    touch = session.run(operator=[nt.Input(FORCE, 0.0, 0.0, 0.05)])
    testing.assert_runs(touch)
    nt_golden(touch[::50])
"""


def test_a_project_of_somebody_else_compares_with_its_golden_recording(pytester: pytest.Pytester) -> None:
    pytest.importorskip("mcap")

    def outcome(force: str, *options: str) -> pytest.RunResult:
        pytester.makepyfile(test_theirs=PROGRAM.replace("FORCE", force))
        return pytester.runpytest_inprocess(*QUIET, *options)

    none = outcome("0.5")
    none.assert_outcomes(failed=1)
    none.stdout.fnmatch_lines("*test_touch.mcap to compare with: pytest --nt-update-golden writes it*")
    outcome("0.5", "--nt-update-golden").assert_outcomes(passed=1)
    assert (pytester.path / "golden" / "test_touch.mcap").stat().st_size < 50_000
    outcome("0.5").assert_outcomes(passed=1)
    other = outcome("0.6")
    other.assert_outcomes(failed=1)
    other.stdout.fnmatch_lines("*channels differ:*")


ODD = """
import math, time
import nanotouch as nt
import pytest

def touch(nt_session, force=0.5):
    return nt_session().run(operator=[nt.Input(force, 0.0, 0.0, 0.01)])[::10]

@pytest.mark.parametrize("force", [0.5, 0.6], ids=["a/b", "a b"])  # both of a_b
def test_two(nt_session, nt_golden, force):
    nt_golden(touch(nt_session, force))

@pytest.mark.parametrize("force", [0.5], ids=["long" * 100])
def test_long(nt_session, nt_golden, force):
    nt_golden(touch(nt_session, force))

def test_twice(nt_session, nt_golden):
    nt_golden(touch(nt_session))
    nt_golden(touch(nt_session, 0.9))

def test_folder(nt_session, nt_golden):
    nt_golden(touch(nt_session), "../up")

def test_nothing(nt_session, nt_golden):
    nt_golden(touch(nt_session)[:0])

def test_tolerance(nt_session, nt_golden):
    nt_golden(touch(nt_session), tolerances={"hight": 1.0})

def test_damaged(nt_session, nt_golden, request):
    nt_golden(touch(nt_session))
    golden = request.path.parent / "golden" / "test_damaged.mcap"
    damaged = bytearray(golden.read_bytes())
    damaged[len(damaged) // 3] ^= 255
    golden.write_bytes(damaged)
    nt_golden(touch(nt_session))

class Fails(nt.hal.Master):
    count = 0

    def describe(self):
        return nt.hal.Capabilities()

    def read(self):
        self.count += 1
        if self.count > 600:
            raise RuntimeError("unplugged")
        return nt.hal.Reading(position=(math.nan, math.nan, 0.0))

LEFT = []

def test_thread(nt_session):
    LEFT.append(nt_session(recorded=False))
    rig = nt.Rig(master={"motor": "no", "gauge": "no"})
    failing = nt_session(rig=rig, master=Fails(), recorded=False, preflight=False)
    LEFT.append(nt_session(recorded=False))
    for session in (*LEFT, failing):
        session.start("free")
    end = time.monotonic() + 20.0
    while failing.state == "RUN" and time.monotonic() < end:
        time.sleep(1e-3)

def test_threads_were_stopped():
    assert not any(session.progress.runs for session in LEFT)
"""


def test_a_golden_file_belongs_to_one_test_and_is_whole_and_every_thread_is_stopped(pytester: pytest.Pytester) -> None:
    pytest.importorskip("mcap")
    pytester.makepyfile(test_odd=ODD)
    found = pytester.runpytest_inprocess(*QUIET, "-W", "ignore", "--tb=line", "--nt-update-golden")
    found.assert_outcomes(passed=4, failed=6, errors=1)
    for words in (
        "*test_two_a_b.mcap is that of test_odd.py::test_two?a/b?: give one of them a name*",
        "*channels differ:*",
        "*name = '../up': valid are letters, digits*",
        "*recording has no rows*",
        "*no channel 'hight' is expected*",
        "*test_damaged.mcap is damaged (*: pytest --nt-update-golden writes it anew*",
        "*RuntimeError: unplugged*",
    ):
        found.stdout.fnmatch_lines_random(words)


def test_the_examples_of_the_docs_pass(pytester: pytest.Pytester) -> None:
    """A laboratory's own backend, a student's own law, a window that embeds a session."""
    if not EXAMPLES.is_dir():
        pytest.skip("without the pages")
    for test in EXAMPLES.glob("test_*.py"):
        shutil.copy(test, pytester.path)
    pytester.runpytest_inprocess(*QUIET).assert_outcomes(passed=9)


def test_pytest_finds_the_fixtures_and_other_projects_pay_nothing_for_them() -> None:
    (found,) = (one for one in entry_points(group="pytest11") if one.name == "nanotouch")
    assert found.value == "pytest_nanotouch"
    program = "import sys, pytest_nanotouch; sys.exit('nanotouch' in sys.modules or 'numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], timeout=60).returncode == 0
