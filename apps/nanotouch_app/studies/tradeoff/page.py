# SPDX-License-Identifier: BSD-3-Clause
"""The page on accuracy: every number in it is measured in the run that writes it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import nanotouch as nt
import numpy as np
from nanotouch import reference
from nanotouch.errors import Error
from nanotouch.touch.record import replacing

from nanotouch_app.studies.tradeoff import answer, errors, laws, plans, touch
from nanotouch_app.studies.tradeoff.errors import CONTROLS, RANGES, WORDS, Control, Range
from nanotouch_app.studies.tradeoff.measure import Maps, Row
from nanotouch_app.studies.tradeoff.rules import (
    HERTZ_LOAD,
    SPREAD,
    THRESHOLDS,
    TOLERANCES,
    Limit,
    lambda_limits,
    load_limits,
)
from nanotouch_app.studies.tradeoff.solvers import DMT, EXACT, HERTZ, JKR, JKR_LAMBDA, MAPPED, SOLVERS, Solver, unit
from nanotouch_app.studies.tradeoff.timing import ELEMENTS

LAMBDAS = (1e-4, 1e-3, 0.01, 0.05, 0.12, 0.5, 1.0, 2.0, 5.8, 10.0)
HERTZ_LOADS = (10.0, 20.0, 100.0, 1000.0)
MUS = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0)
SHORT = {within: f"P = {WORDS[within].removesuffix(' pull-off forces')} P_c" for within in RANGES}
QUANTITY = {"grips": "F(δ), grips", "load": "a(P), dead weight"}


class Measured(NamedTuple):
    """All that one run of the command has found."""

    maps: Maps
    rows: list[Row]
    planned: list[plans.Row]
    touch: touch.Result
    points: list[laws.Point]
    extremes: laws.Extremes


def write(path: Path, found: Measured) -> None:
    """Write the page, whole or not at all: the answer first, then what it rests on."""
    parts = [
        INTRODUCTION, answer.section(found.touch), speed(found.rows, found.extremes), plans.section(found.planned),
        *sections(found.maps), ENDING,
    ]  # fmt: skip
    with replacing(path) as part:
        part.write_text("\n\n".join(parts) + "\n", encoding="utf-8")


def sections(maps: Maps) -> list[str]:
    """All that does not depend on the machine."""
    return [_rules(), _limits(maps), _errors(), _hertz(maps), _lennard_jones()]


def summary(rows: list[Row]) -> str:
    """Cost and error of every solver, for the terminal."""
    lines = [f"{'':12} {'ns/element':>10}   worst force error under grips, {WORDS['moderate']}, at lambda ="]
    lambdas = sorted({row.lam for row in rows})
    lines.append(f"{'':12} {'':>10}   " + "".join(f"{lam:>9g}" for lam in lambdas))
    for solver in SOLVERS:
        own = [row for row in rows if row.solver == solver.name]
        found = {row.lam: row.against_exact for row in own if row.loads == "moderate"}
        lines.append(f"{solver.name:12} {_cost(own):>10.3g}   " + "".join(f"{found[lam]:>9.1e}" for lam in lambdas))
    return "\n".join(lines)


def _cost(rows: Iterable[Row]) -> float:
    """The median: cost depends a little on lambda and load."""
    return float(np.median([row.nanoseconds for row in rows]))


def _table(head: Sequence[str], body: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *body]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def percent(error: float) -> str:
    """``0.326`` is ``32.6 %``; below a tenth of a per cent two digits."""
    return f"{100 * error:.1f} %" if error >= 1e-3 else f"{100 * error:.1g} %"


def _limit(found: Limit) -> str:
    if not math.isnan(found.at):
        return f"{found.at:.2g}" if found.at < 1e3 else f"{found.at:.0f}"
    return "everywhere" if found.everywhere else "nowhere"


def _rules() -> str:
    body = []
    for solver, lam in THRESHOLDS:
        rule = f"{solver.name} {'below' if solver is DMT else 'above'} λ = {lam:g}"
        for control in CONTROLS:
            found = [percent(errors.worst(solver, control, lam, within)) for within in RANGES]
            body.append([rule, QUANTITY[control], *found])
    lam = THRESHOLDS[0][1]
    dmt, jkr = (percent(errors.worst(solver, "grips", lam, "moderate")) for solver in (DMT, JKR))
    hertz = [", ".join(map(percent, _hertz_errors(control, HERTZ_LOAD))) for control in CONTROLS]
    return f"""## What the paper's rules are worth

The paper takes DMT below λ = 0.12, JKR above 5.8, and Hertz above {HERTZ_LOAD:g} times the pull-off force, without
saying to which error. At the thresholds themselves it is:

{_table(["rule", "quantity and control", *SHORT.values()], body)}

So λ < 0.12 is a 10 % rule for the contact radius under a dead weight. For the force at a given indentation, which
is what a haptic loop asks, DMT is there wrong by {dmt} of the force or of the pull-off force, and JKR, said not to
hold, by {jkr}. (In adhesion it is worse: for δ < 0 DMT has no contact and no force, while the true contact still
pulls.) λ > 5.8 is a 1 % rule: the pair is not symmetric. P = {HERTZ_LOAD:g} P_c with Hertz, at λ = {_lambdas(", ")}:
{hertz[0]} of F(δ), but {hertz[1]} of a(P)."""


def _limits(maps: Maps) -> str:
    cases: list[tuple[str, Control, Range, bool]] = [
        (f"{QUANTITY[control]}; {SHORT[within]}", control, within, False)
        for control in ("load", "grips")
        for within in RANGES
    ]
    cases.insert(5, (f"{cases[4][0]}, δ counted from P = 0", "grips", "moderate", True))
    body = [
        [words, *(" / ".join(map(_limit, lambda_limits(s, maps, control, within, zeroed))) for s in (DMT, JKR))]
        for words, control, within, zeroed in cases
    ]
    low, high = maps.lambdas[[0, -1]]
    return f"""## Where DMT and JKR meet a tolerance

λ limits for {_tolerances()}, over λ = {low:g} .. {high:g}; beyond a limit the error never returns above the tolerance.

{_table(["quantity, control and loads", "DMT holds below", "JKR holds above"], body)}

To leading order DMT misses -4 √(λ d/π) of F(δ), the square root of λ, but only O(λ) of a(P); JKR misses O(λ⁻²) of
both. Most of DMT's error is a shift of the zero of indentation: who counts δ from where the force is zero may use it
much farther."""


def _errors() -> str:
    columns: list[tuple[Solver, Control, Range, bool]] = [
        (DMT, "load", "adhesive", False), (DMT, "load", "moderate", False), (DMT, "grips", "adhesive", False),
        (DMT, "grips", "moderate", False), (DMT, "grips", "moderate", True), (JKR, "load", "adhesive", False),
        (JKR, "load", "moderate", False), (JKR, "grips", "adhesive", False), (JKR, "grips", "moderate", False),
    ]  # fmt: skip
    head = [
        f"{s.name} {'a(P)' if control == 'load' else 'F(δ)'} {within}{', from P = 0' if zeroed else ''}"
        for s, control, within, zeroed in columns
    ]
    body = [
        [f"{lam:g}", *(percent(errors.worst(s, control, lam, within, zero)) for s, control, within, zero in columns)]
        for lam in LAMBDAS
    ]
    return f"""## Errors over λ

Largest error in a range of loads: adhesive is {WORDS["adhesive"]}, moderate {WORDS["moderate"]}. 100 % for a(P):
the model sees no contact at a load that the true one still holds.

{_table(["λ", *head], body)}"""


def _hertz(maps: Maps) -> str:
    body = [
        [f"{load:g}", *(" / ".join(map(percent, _hertz_errors(control, load))) for control in CONTROLS)]
        for load in HERTZ_LOADS
    ]
    limits = [" / ".join(map(_limit, load_limits(maps, control))) for control in CONTROLS]
    return f"""## Hertz at high load

Error at λ = {_lambdas(" / ")}:

{_table(["P/P_c", *(QUANTITY[control] for control in CONTROLS)], body)}

At every λ of the map Hertz meets {_tolerances()} above P/P_c = {limits[0]} for F(δ) and {limits[1]} for a(P) (loads
up to 10 000 P_c were looked at)."""


def _hertz_errors(control: Control, load: float) -> list[float]:
    return [float(errors.error(HERTZ, control, lam, np.array([load]))[0]) for lam in SPREAD]


def _lambdas(between: str) -> str:
    return between.join(f"{lam:g}" for lam in SPREAD)


def _tolerances() -> str:
    return " / ".join(f"{100 * tolerance:g} %" for tolerance in TOLERANCES)


def _lennard_jones() -> str:
    body = []
    for mu in MUS:
        lam = reference.LAMBDA_PER_MU * mu
        pull_off = nt.contact.pull_off_force("maugis", unit(lam))
        row = [f"{mu:g}", f"{lam:.3f}", f"{-reference.pull_off(mu):.4f}", f"{pull_off:.4f}"]
        for zeroed in (False, True):
            row += [percent(errors.to_lennard_jones(s, lam, "moderate", zeroed)) for s in (EXACT, DMT, JKR)]
        body.append(row)
    head = ["μ", "λ", "P_c Lennard-Jones", "P_c MD", *(f"{name}" for name in ("MD", "DMT", "JKR"))]
    head += [f"{name} from P = 0" for name in ("MD", "DMT", "JKR")]
    return f"""## What Maugis-Dugdale itself is worth

A sphere on a half-space that attract each other by the Lennard-Jones law, solved self-consistently
(`nanotouch.reference`, made by `tools/lennard_jones`), is closer to atoms than Dugdale's constant stress. Largest
error of F(δ) against it, P = 0 to 10 P_c, at equal indentation and with both indentations counted from zero load:

{_table(head, body)}

Solving Maugis-Dugdale to better than 1e-4 is numerical hygiene, not physics. At small μ the difference is the
compliance of the Lennard-Jones wall, sub-ångström in δ, which no contact model has. It is mostly a shift of the zero of
indentation. At the smallest μ it is a stiffness as well, which stays when counting from zero load."""


def speed(rows: list[Row], far: laws.Extremes) -> str:
    """Cost and error of every solver: the one part that depends on the machine."""
    hertz = _cost(row for row in rows if row.solver == HERTZ.name)
    body = []
    for solver in SOLVERS:
        own = [row for row in rows if row.solver == solver.name]
        worst = [max(row.against_exact for row in own if row.loads == within) for within in RANGES]
        cost = _cost(own)
        body.append([solver.name, f"{cost:.3g}", f"{cost / hertz:.3g}", *(f"{error:.1e}" for error in worst)])
    lambdas = sorted({row.lam for row in rows})
    head = ["solver", "ns per element", "in Hertz", *(f"error, {words}" for words in SHORT.values())]
    return f"""## Speed and accuracy

Force alone from an array of {ELEMENTS} indentations, on the machine where this page was made. Run the command for
yours; ratios travel better than nanoseconds. Processor time, least
of repeated runs, median over λ = {lambdas[0]:g} .. {lambdas[-1]:g} and loads; everything included: the Python call,
folds and table of the contact. Hertz and DMT are in-place numpy here,
the least that Python can do; the closed JKR computes energy, stiffness and radius besides. Errors: |ΔF|/max(|F|, P_c)
under grips against the exact tier, worst over those λ; that of the exact tier is of the way there and back,
F(δ(P)) against P.

{_table(head, body)}

{laws.sentence(far)}

MD table is `nanotouch.contact.reduced.force(lam, d, tier="table")`, JKR table the same at λ = {JKR_LAMBDA:g}, polished
and exact are the other tiers. `laws.csv` holds every λ apart. `nanotouch bench` gives the
cost of every law from Python, `make bench` in C, where Hertz inlined costs less than numpy's three passes."""


INTRODUCTION = f"""<!-- generated by: nanotouch tradeoff --doc docs/evidence/accuracy.md -->
# Accuracy: what each contact model is worth, and what it costs

```
nanotouch tradeoff --doc docs/evidence/accuracy.md
```

measures every table below and writes this page and four pictures, each with its `.csv` (`calls.csv` has what
`laws.png` draws).

- `tradeoff.png`: the whole touch: error of the force at the hand against processor time per second of touch.
- `laws.png`: error of each contact model and tier against the processor time of a force; its extremes.
- `errormap.png`: errors of {", ".join(s.name for s in MAPPED)} over λ and load, with the paper's rules drawn in.
- `plans.png`: plans of the presets over the accuracy demanded.

An error means nothing without what is held and what is asked. Grips (a stiff cantilever, a stage) hold the indentation
δ, and the error is that of the force: |ΔF|/max(|F|, P_c), P_c the pull-off force of Maugis-Dugdale (MD). A dead weight
(a soft cantilever) holds the load P, and the error is that of the contact radius: |Δa|/a. Truth is exact
Maugis-Dugdale unless said otherwise; λ is Maugis' parameter, 1.157 times Tabor's μ (docs/contact.md)."""

ENDING = f"""What this does not say: whether the tip is a sphere, a/R small, the surface smooth and the material elastic
(docs/geometry.md). The largest error in a range of loads is that of {errors.POINTS} loads in it. `test_tradeoff` holds
the page against the measurement, and the measurement against figures obtained apart from the library."""


def check(path: Path) -> None:
    """Raise unless the page may be written there."""
    if not path.parent.is_dir():
        raise Error(f"cannot write {path}: {path.parent} is not a folder")
