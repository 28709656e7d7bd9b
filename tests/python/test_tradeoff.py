# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch tradeoff``: its errors against figures obtained apart from the library, closed forms and asymptotics; the
page against the measurement; the command end to end."""

from __future__ import annotations

import contextlib
import csv
import io
import math
from pathlib import Path

import numpy as np
import pictures
import pytest
from nanotouch import Rig, reference
from nanotouch.plots import new_figure
from nanotouch_app.main import main
from nanotouch_app.studies.tradeoff import FILES, answer, errors, laws, measure, page, plans, rules, touch
from nanotouch_app.studies.tradeoff.plans import PRESETS
from nanotouch_app.studies.tradeoff.solvers import DMT, EXACT, HERTZ, JKR, JKR_TABLE, POLISHED, SOLVERS, TABLE, Solver

pytest.importorskip("matplotlib")

DOCS = Path(__file__).resolve().parents[2] / "docs" / "evidence" / "accuracy.md"
COLUMNS = [
    (DMT, "load", "adhesive", False), (DMT, "load", "moderate", False), (DMT, "grips", "adhesive", False),
    (DMT, "grips", "moderate", False), (DMT, "grips", "moderate", True), (JKR, "load", "adhesive", False),
    (JKR, "load", "moderate", False), (JKR, "grips", "adhesive", False), (JKR, "grips", "moderate", False),
]  # fmt: skip
#: lambda and the columns above, from a prototype with 110-digit solutions of the printed equations
PROTOTYPE = [
    (1e-4, 0.000, 0.000, 0.014, 0.017, 0.000, 1.00, 0.442, 0.421, 0.431),
    (1e-3, 0.002, 0.001, 0.042, 0.053, 0.001, 1.00, 0.441, 0.392, 0.396),
    (0.01, 0.016, 0.007, 0.118, 0.143, 0.007, 1.00, 0.432, 0.320, 0.314),
    (0.05, 0.054, 0.032, 0.95, 0.254, 0.025, 1.00, 0.396, 0.254, 0.216),
    (0.12, 0.098, 0.066, 0.95, 0.326, 0.045, 1.00, 0.347, 0.211, 0.154),
    (0.5, 0.220, 0.170, 0.95, 0.463, 0.090, 1.00, 0.198, 0.104, 0.062),
    (1.0, 0.289, 0.230, 0.95, 0.527, 0.108, 1.00, 0.111, 0.050, 0.030),
    (2.0, 0.338, 0.275, 0.95, 0.565, 0.119, 0.052, 0.046, 0.018, 0.011),
    (5.8, 0.365, 0.302, 0.95, 0.584, 0.124, 0.008, 0.007, 0.003, 0.002),
    (10.0, 0.368, 0.305, 0.95, 0.586, 0.125, 0.003, 0.002, 0.001, 0.001),
]


@pytest.fixture(scope="module")
def maps() -> measure.Maps:
    return measure.maps(quick=False, progress=lambda done: None)


# --- errors ---


@pytest.mark.parametrize("line", PROTOTYPE, ids=lambda line: f"{line[0]:g}")
def test_errors_are_those_of_the_prototype(line: tuple[float, ...]) -> None:
    """To half of its last digit, and what other sampled loads do where an error is steep (0.002 at most)."""
    for (solver, control, within, rezeroed), wanted in zip(COLUMNS, line[1:], strict=True):
        found = errors.worst(solver, control, line[0], within, rezeroed)  # type: ignore[arg-type]
        assert found == pytest.approx(wanted, abs=2.5e-3), (solver.name, control, within)


def test_threshold_of_jkr_is_a_rule_of_one_per_cent() -> None:
    for control in errors.CONTROLS:
        for within in errors.RANGES:
            assert errors.worst(JKR, control, 5.8, within) <= 0.0085


@pytest.mark.parametrize("d", [0.5, 1.0, 3.0])
def test_force_of_dmt_misses_the_square_root_of_lambda(d: float) -> None:
    """-4 sqrt(lambda d/pi), the next order being lambda."""
    lam = 1e-8
    missing = float((EXACT.force(lam, np.array([d])) - DMT.force(lam, np.array([d])))[0])
    assert missing == pytest.approx(4.0 * math.sqrt(lam * d / math.pi), rel=1e-3)


def test_jkr_misses_the_inverse_square_of_lambda() -> None:
    for control in errors.CONTROLS:
        ratio = errors.worst(JKR, control, 30.0, "moderate") / errors.worst(JKR, control, 300.0, "moderate")
        assert ratio == pytest.approx(100.0, rel=0.02)


def test_hertz_without_range_is_off_by_the_pull_off_force() -> None:
    """At lambda to 0 the truth is DMT: dF = 2, a^3 = P + 2; lambda = 1e-6 is within sqrt(lambda) of it."""
    for load in (10.0, 20.0, 100.0):
        P = 2.0 * load
        F, a = (errors.error(HERTZ, control, 1e-6, np.array([load]))[0] for control in errors.CONTROLS)
        assert pytest.approx(2.0 / P, rel=0.01) == F
        assert a == pytest.approx(1.0 - (P / (P + 2.0)) ** (1.0 / 3.0), rel=1e-3)


@pytest.mark.parametrize("lam", [1e-3, 0.12, 0.9, 5.8, 1e3])
def test_tiers_answer_from_their_tables_and_as_well_as_they_say(lam: float) -> None:
    """1.5e-6 and rounding. An error above rounding shows that it was the table that answered."""
    for within in errors.RANGES:
        assert errors.worst(TABLE, "grips", lam, within) < 1.5e-6
        assert errors.worst(POLISHED, "grips", lam, within) < 1e-13
        assert errors.worst(EXACT, "grips", lam, within) < 1e-13
    assert errors.worst(TABLE, "grips", lam, "moderate") > 1e-12
    assert errors.worst(TABLE, "load", lam, "moderate") < 1e-5


def test_table_of_jkr_is_jkr() -> None:
    for within in errors.RANGES:
        found = [errors.worst(solver, "grips", 100.0, within) for solver in (JKR, JKR_TABLE)]
        assert found[0] == pytest.approx(found[1], abs=1e-6)


@pytest.mark.parametrize("mu", [0.1, 0.25, 0.5])
def test_errors_against_lennard_jones_are_those_of_the_reference(mu: float) -> None:
    """The reference takes even steps of indentation, here it is of load: 2 % of an error that peaks within."""
    found = errors.to_lennard_jones(EXACT, reference.LAMBDA_PER_MU * mu, "moderate")
    assert found == pytest.approx(reference.model_error("maugis", mu), rel=0.02)


def test_lennard_jones_is_not_asked_outside_its_table() -> None:
    assert math.isnan(errors.to_lennard_jones(EXACT, 10.0, "moderate"))
    assert math.isnan(errors.to_lennard_jones(EXACT, 1.0, "high"))


@pytest.mark.parametrize("solver", SOLVERS, ids=lambda solver: solver.name)
def test_what_is_timed_is_what_is_judged(solver: Solver) -> None:
    """Twice, as buffers are used again."""
    d = np.linspace(-0.5, 8.0, 1001)
    call = solver.prepare(0.5, d)
    call()
    np.testing.assert_allclose(call(), solver.force(0.5, d), rtol=1e-14, atol=1e-14)


# --- limits and fronts ---


def test_limits_of_a_power_law() -> None:
    x = np.logspace(-6, 2, 33)
    assert rules.limit(x, np.sqrt(x), 0.05, below=True).at == pytest.approx(0.0025)
    assert rules.limit(x, x**-2.0, 0.05, below=False).at == pytest.approx(0.05**-0.5)
    assert rules.limit(x, 0.0 * x, 0.05, below=True) == pytest.approx((math.nan, True), nan_ok=True)
    assert rules.limit(x, 0.0 * x + 1.0, 0.05, below=True) == pytest.approx((math.nan, False), nan_ok=True)


def test_an_error_that_dips_again_gives_no_licence() -> None:
    x = np.array([1.0, 2.0, 4.0, 8.0, 16.0])
    found = rules.limit(x, np.array([1e-4, 0.1, 1e-5, 1e-5, 1.0]), 0.01, below=True)
    assert 1.0 < found.at < 2.0


def test_lambda_limits_are_those_of_the_prototype(maps: measure.Maps) -> None:
    """3 %: it had 8 lambdas a decade and interpolated."""
    for solver, control, within, wanted in (
        (DMT, "load", "adhesive", (4.7e-4, 0.0056, 0.045, 0.125)),
        (DMT, "load", "moderate", (1.3e-3, 0.0137, 0.085, 0.212)),
        (JKR, "load", "moderate", (15.8, 4.85, 1.88, 1.09)),
        (DMT, "grips", "moderate", (None, 3.2e-5, 9.0e-4, 0.0042)),
        (JKR, "grips", "moderate", (7.3, 2.1, 0.63, 0.26)),
    ):
        found = rules.lambda_limits(solver, maps, control, within)  # type: ignore[arg-type]
        for limit, value in zip(found, wanted, strict=True):
            if value is None:
                assert math.isnan(limit.at)
                assert not limit.everywhere
            else:
                assert limit.at == pytest.approx(value, rel=0.05)


# --- the page and the command ---


def test_page_says_what_is_measured(maps: measure.Maps) -> None:
    written = DOCS.read_text(encoding="utf-8")
    for section in page.sections(maps):
        assert section in written
    assert "32.6 %" in written


@pytest.fixture(scope="module")
def planned() -> list[plans.Row]:
    return plans.trade(quick=False)


def test_plans_keep_what_they_are_asked_for(planned: list[plans.Row]) -> None:
    """Bound below demand, error below bound, never dearer than everything exact, and never dearer for less."""
    assert len(planned) == 20 * 8
    kept = [row for row in planned if row.forms != plans.REFUSED]
    assert all(
        not row.error > row.bound and row.bound <= row.relative_accuracy + row.deformation for row in kept
    )  # NaN: deforms
    assert all(row.cost <= row.full_cost for row in kept)
    for name in {row.preset for row in planned}:
        own = [row for row in kept if row.preset == name and not math.isnan(row.error)]
        assert [row.cost for row in own] == sorted(row.cost for row in own)
    refused = [row for row in planned if row.forms == plans.REFUSED]
    assert all(row.bound > row.relative_accuracy for row in refused)
    # bounds above rounding are no more than 10 times too cautious, in the median of all steps hardly at all
    first = [step[0] for step in plans.steps(kept) if step[0].error > plans.ROUNDING]
    tight = [row.error / max(row.bound - row.deformation, row.error) for row in first]
    assert np.min(tight) > 0.1
    assert np.median(tight) > 0.5


def test_page_says_what_plans_cost(planned: list[plans.Row]) -> None:
    assert plans.section(planned) in DOCS.read_text(encoding="utf-8")


def read(path: Path) -> tuple[list[str], list[list[str]]]:
    with path.open(encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return rows[0], rows[1:]


@pytest.fixture(scope="module")
def touched() -> touch.Result:
    return touch.trade(quick=True)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory, touched: touch.Result) -> tuple[Path, str]:
    """Where the command has written, and what it said. ``conftest.py`` looks whether its pictures hide anything."""
    out, said = tmp_path_factory.mktemp("tradeoff"), io.StringIO()
    with contextlib.redirect_stdout(said), pytest.MonkeyPatch.context() as patch:
        patch.setattr(touch, "trade", lambda quick, progress: touched)
        assert main(["tradeoff", "--quick", "--out", str(out)]) == 0
    return out, said.getvalue()


def test_command(written: tuple[Path, str]) -> None:
    out, said = written
    assert sorted(path.name for path in out.iterdir()) == sorted(FILES)
    assert all((out / name).stat().st_size > 30_000 for name in FILES if name.endswith("png"))
    for name in FILES:
        assert not name.endswith("csv") or all(header.endswith(("]", "(name)")) for header in read(out / name)[0])
    _, rows = read(out / "laws.csv")
    assert len(rows) == len(measure.QUICK_LAMBDAS) * len(errors.RANGES) * len(SOLVERS)
    at = {(float(row[0]), row[1], row[2]): [float(cell) for cell in row[3:]] for row in rows}
    assert at[0.12, "moderate", "DMT"][1] == pytest.approx(0.326, abs=1e-3)
    assert at[0.12, "moderate", "JKR"][1] == pytest.approx(0.154, abs=1e-3)
    for lam in measure.QUICK_LAMBDAS:  # measured about 80, by processor time, to which other programs add nothing
        assert at[lam, "moderate", "MD exact"][0] > 10.0 * at[lam, "moderate", "MD table"][0]
    assert "MD polished" in said
    assert {row[0] for row in read(out / "plans.csv")[1]} == set(PRESETS)
    _, rows = read(out / "tradeoff.csv")
    cost = {tuple(row[:3]): float(row[5]) for row in rows}
    for rate in ("1000.0", "10000.0"):  # measured 150 and 100: substeps are what the dynamic probe costs
        assert cost["probe", "0.25 rad", rate] > 10.0 * cost["plan", "1 %", rate]
        assert cost["probe", "0.25 rad", rate] > 2.0 * cost["probe", "4 rad", rate]


def test_every_kind_of_series_is_drawn() -> None:
    """All that is varied, at all its rates, in both panels; all presets; no axis is cut."""
    rows = [
        touch.Row(axis, "1 %", rate, "dynamic", "contact table", 1e-3 * number, 10.0**-number, 0.0)
        for number, (axis, rate) in enumerate(((a, r) for a in answer.AXES for r in touch.RATES), start=1)
    ]
    figure = new_figure(15.0, 7.5)
    for panel, kind in zip(figure.subplots(1, 2), answer.KINDS, strict=True):
        answer.draw_kind(panel, rows, kind)
        assert len(panel.lines) == len(rows)
    assert pictures.hidden(figure) == []


def test_picture_of_plans_shows_all_presets(planned: list[plans.Row]) -> None:
    figure = plans.draw(planned)
    shown = {panel.get_title(loc="left"): panel for panel in figure.axes}
    assert set(shown) == {name.replace("_", " ") for name in PRESETS}
    for name in PRESETS:
        costs = {row.cost for row in planned if row.preset == name and row.forms != plans.REFUSED}
        assert set(shown[name.replace("_", " ")].lines[0].get_xdata()) == costs
    assert pictures.hidden(figure) == []


# --- the whole touch ---


def test_the_reference_of_the_touch_converges_as_its_error_says() -> None:
    """Half the substep, a quarter of the change: Richardson's extrapolation holds there."""
    first, second, third = (
        touch.run(touch.Way("", "", 1e4, touch.EXACT | {"probe_model": "dynamic", "substep": step}), 0.03).hand
        for step in (0.2, 0.1, 0.05)
    )
    ratio = touch.differs(first, second) / touch.differs(second, third)
    assert ratio == pytest.approx(2.0**touch.ORDER, rel=0.25)


def test_the_reference_of_the_touch_is_that_of_others(touched: touch.Result) -> None:
    """A probe at rest, solved in Python on nanotouch.reference: what it lacks is inertia, below 2e-6 here."""
    assert touched.independent < 1e-5
    assert touched.own < 1e-3


def test_the_touch_says_what_dominates(touched: touch.Result) -> None:
    """Noise far above all that is computed, and felt in proportion; a scale that is off by x is felt as x at most."""
    at = {(row.axis, row.name, row.rate): row for row in touched.rows}
    noise = at["noise", "detector", touch.RATE].smooth
    exact = at["plan", "exact", touch.RATE].smooth
    assert noise > 100.0 * exact
    half = {"probe": {"noise": 0.5 * Rig().probe.noise}}
    runs = [
        touch.run(touch.Way("", "", touch.RATE, {"probe_model": "quasi-static"}, rig), 0.1).hand[:300]
        for rig in ({}, half, {"probe": {"noise": Rig().probe.noise}})
    ]
    assert touch.differs(runs[2], runs[0]) == pytest.approx(2.0 * touch.differs(runs[1], runs[0]), rel=0.01)
    off = touch.calibration_sigma()
    assert 0.0 < at["calibration", f"{100 * off:.2g} %", touch.RATE].smooth < off
    said = answer.sentences(touched)
    assert "away from jump-in and pull-off: dominated by detector noise" in said
    assert all(f"within {100 * demand:g} %" in said for demand in touch.DEMANDS)


def test_a_finer_plan_is_felt_more_exactly_away_from_the_jumps(touched: touch.Result) -> None:
    own = {row.name: row.smooth for row in touched.rows if row.axis == "plan" and row.rate == touch.RATE}
    assert own["30 %"] > own["1 %"] > own["exact"]


def test_errors_of_the_touch_are_those_of_the_whole_run() -> None:
    """The jump-in counts: a shift of it by one of 1000 samples is seen in the RMS, and not where jumps are left out."""
    truth = np.where(np.arange(1000) < 300, 0.0, 1.0)
    late = np.where(np.arange(1000) < 301, 0.0, 1.0)
    assert touch.differs(late, truth) == pytest.approx(1000**-0.5)
    assert touch.differs(late, truth, touch.smooth(truth, 1e4)) == 0.0


def test_extremes_are_finite_and_right() -> None:
    found = laws.extremes()
    assert found.wrong == 0
    assert found.error["MD table"].max() < 1.5e-6
    assert found.error["MD polished"].max() < 1e-13


def test_map_of_the_command(written: tuple[Path, str]) -> None:
    headers, rows = read(written[0] / "errormap.csv")
    assert all("[" in header and header.endswith("]") for header in headers)
    values = np.array(rows, dtype=float)
    assert np.all(np.isfinite(values))
    lam, load, hertz = (
        values[:, 0],
        values[:, 1],
        values[:, headers.index("Hertz grips: |dF|/max(|F|;|F_pull-off|) [-]")],
    )
    at = np.isclose(lam, 1e-6) & np.isclose(load, 100.0, rtol=0.1)
    assert hertz[at] == pytest.approx(1.0 / load[at], rel=0.01)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--out", "{file}"], "cannot write into"),
        (["--quick", "--doc", "{out}/page.md"], "full measurement"),
        (["--doc", "{out}/none/page.md"], "not a folder"),
    ],
)
def test_one_sentence(arguments: list[str], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").touch()
    given = [word.format(file=tmp_path / "file", out=tmp_path) for word in arguments]
    assert main(["tradeoff", *given, *([] if "--out" in given else ["--out", str(tmp_path / "out")])]) == 2
    error = capsys.readouterr().err
    assert error.startswith("nanotouch tradeoff: ")
    assert says in error
    assert error.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
