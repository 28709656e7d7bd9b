# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 16 to 19 of ``nanotouch reproduce``: the numbers of their statements against closed forms and rules."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app.studies.reproduce import figure16, figure17, figure18, figure19, touching
from nanotouch_app.studies.reproduce.statement import Statement
from reproduced import reproduction

pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def statements() -> dict[int, list[Statement]]:
    return {number: list(reproduction(number).statements) for number in (16, 17, 18, 19)}


def find(statements: list[Statement], start: str) -> Statement:
    (found,) = [entry for entry in statements if entry.statement.startswith(start)]
    return found


def test_script_is_a_sinusoid() -> None:
    script = touching.sinusoid(1.0, 0.5, 4.0, 1.0)
    assert sum(step.duration for step in script) == pytest.approx(4.0)
    forces = [step.operator_force for step in script]
    assert (np.min(forces), np.max(forces), forces[-1]) == pytest.approx((0.5, 1.5, 0.5))


def test_literal_scale_leaves_the_hand_alone(statements: dict[int, list[Statement]]) -> None:
    """No force of the tip: the error is that of the hand itself, mean and amplitude over root 2."""
    (literal, repaired) = [entry for entry in statements[16] if entry.statement.startswith("master and slave")]
    alone = math.hypot(figure16.MEAN.value, figure16.AMPLITUDE.value / math.sqrt(2.0))
    assert literal.number == pytest.approx(alone, rel=0.03)  # from half a period on
    assert literal.verdict == "does not hold"
    assert repaired.verdict == "holds"
    assert figure16.NOISE.value < repaired.number < 1.3 * figure16.NOISE.value


def test_literal_loops_are_refused() -> None:
    with pytest.raises(nt.Error, match="stability margin"):
        figure16.session(figure16.LITERAL.value, touching.PAPER_RATE.value)
    with pytest.raises(nt.Error, match="stability margin"):
        figure17.session(figure17.LITERAL.value, touching.PAPER_RATE.value, "paper")
    with pytest.raises(nt.Error, match="stability margin"):
        figure17.session(figure17.LITERAL.value, touching.PAPER_RATE.value, "default")


def test_margin_of_the_literal_figure_17(statements: dict[int, list[Statement]]) -> None:
    """kappa = 3 x 2e6 x 4e-3 x 8 = 192 kN/m; bare stage, Q/wn = 7.07 ms, two hops of 1.5 periods."""
    kappa = 3.0 * 2e6 * 4e-3 * 8.0
    limit = 100.0 / (2.0 * 1.5 * 3e-3 + 20.0 / (2.0 * math.pi * 450.0))
    assert find(statements[17], "K_f = 2").number == pytest.approx(limit / kappa, rel=0.01)
    assert find(statements[17], "ideal responses of tracking are realized (").verdict == "does not hold"
    forces = find(statements[17], "ideal responses of tracking are realized: forces")
    assert forces.verdict == "holds"
    # the ramp to 2 N in 3 s moves the master by 2.7 mm: b_m v/(1 + K_f) = 0.03 N
    assert forces.number == pytest.approx(0.03, rel=0.2)


def test_grating_is_480_nm_at_the_hand(statements: dict[int, list[Statement]]) -> None:
    assert find(statements[18], "the upward jumps").number == pytest.approx(480e-9, rel=0.01)
    margin = find(statements[18], "K_f = 10").number
    kappa = 11.0 * 1e6 * figure18.REPAIRED.value * 8.0
    assert margin == pytest.approx(120.5e3 / kappa, rel=0.02)


def test_dots_are_followed_at_constant_force(statements: dict[int, list[Statement]]) -> None:
    assert all(entry.verdict == "holds" for entry in statements[19])
    assert find(statements[19], "just the surface").number < 0.5e-9  # half a step of the stage
    assert find(statements[19], "the z position").number < 2e-9
    drawn = find(
        statements[19], "quantum dots of 10 to 30 nm"
    ).number  # 3000 N/m over 7.1 nm/3e-6, at most the motor's 5 N
    assert drawn == pytest.approx(min(3000.0 * 7.13e-9 / figure19.SCALE.value, 5.0), rel=0.01)


def test_what_figure_17_lets_a_hand_feel(statements: dict[int, list[Statement]]) -> None:
    """As printed 2e6 x 17 nN: 35 mN beside gauge steps of 20 mN and noise of 26 mN. 4 pi 0.0728 R = 0.5 uN: 547 nm."""
    printed = find(statements[17], "the attractive forces are large enough")
    assert printed.verdict == "does not hold"
    assert printed.number == pytest.approx(2e6 * 17.3e-9, rel=0.05)
    assert find(statements[17], "sticking is small").verdict == "does not hold"  # very large: 35 mN
    assert find(statements[17], "the figure's -1 to -2 N").number == pytest.approx(547e-9, rel=1e-3)
    ours = find(statements[17], "the sticking of this tip can be felt")
    assert ours.verdict == "holds"
    assert ours.number > 0.3


def test_columns_have_no_gaps() -> None:
    for number in (16, 17, 18, 19):
        for header, values in reproduction(number).columns.items():
            assert np.isfinite(values).all(), header
