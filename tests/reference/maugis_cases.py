# SPDX-License-Identifier: BSD-3-Clause
"""Random cases of Maugis-Dugdale to 120 digits, many and compact: makes maugis_indentations.inc and maugis_loads.inc.

The equations and solvers are those of maugis_oracle.py (as printed, in a and m = c/a; nothing of the library). Inputs
are exact doubles, outputs the nearest doubles, rates (the condition of the problem) to 6 digits. In each direction
10 500 cases over lambda 1e-6 .. 1e6 and 1 080 out to 1e-12 and 1e12; 30 % of them within 1e-10 .. 1 of a fold. The
seed is fixed.

Run: python maugis_cases.py     (mpmath 1.3 or newer, with gmpy2 some ten minutes on one core)
"""

from __future__ import annotations

import multiprocessing
import random
from collections.abc import Callable
from pathlib import Path

from maugis_oracle import U_DEEP, U_TOUCH, State, contact_state, fold, non_contact_state, solve
from mpmath import diff, mpf, pi, sqrt

REGULAR, PER_REGULAR = 250, 42
EXTREME, PER_EXTREME = 54, 20


def lambdas(rng: random.Random) -> list[tuple[str, int]]:
    """Short decimals, log-uniform, a fifth of them around the change of kind of the fold at 0.9379."""
    wide = [(f"{10 ** rng.uniform(-6, 6):.3g}", PER_REGULAR) for _ in range(REGULAR * 4 // 5)]
    near = [(f"{10 ** rng.uniform(-0.3, 0.2):.3g}", PER_REGULAR) for _ in range(REGULAR // 5)]
    tiny = [(f"{10 ** rng.uniform(-12, -6):.3g}", PER_EXTREME) for _ in range(EXTREME // 2)]
    huge = [(f"{10 ** rng.uniform(6, 12):.3g}", PER_EXTREME) for _ in range(EXTREME // 2)]
    return wide + near + tiny + huge


class Branches:
    """Ends and folds of one lambda."""

    def __init__(self, lam: mpf) -> None:
        self.lam = lam
        self.u_grip, u_pull = fold(lam, "d"), fold(lam, "P")
        assert u_pull is not None
        self.u_pull = u_pull
        self.c_star = 8 * lam / (3 * pi)
        self.onset = -2 / (pi * lam)
        self.touch = contact_state(lam, U_TOUCH)
        self.pull = contact_state(lam, u_pull)
        self.grip = non_contact_state(lam, self.c_star) if self.u_grip is None else contact_state(lam, self.u_grip)

    def contact(self, given: str, target: float, unstable: bool) -> tuple[State, mpf, mpf]:
        """State at an indentation or load, and the rates of the other one and of the radius with it."""
        turn = self.u_pull if given == "P" else (U_TOUCH if self.u_grip is None else self.u_grip)
        ends = (turn, U_TOUCH) if unstable else (U_DEEP, turn)
        u = solve(self.lam, given, mpf(target), *ends)
        state = contact_state(self.lam, u)
        assert abs(getattr(state, given) - target) < mpf(10) ** -50 * (1 + abs(target))
        P1, d1, a1 = (
            diff(lambda v, name=name: getattr(contact_state(self.lam, v), name), u) for name in ("P", "d", "a")
        )
        return (state, d1 / P1, a1 / P1) if given == "P" else (state, P1 / d1, a1 / d1)

    def apart(self, given: str, target: float, unstable: bool) -> tuple[State, mpf, mpf]:
        """The same on the non-contact branch."""
        if given == "P":
            c = sqrt(-mpf(target) / (pi / 2 * self.lam))
        else:
            c = self.c_star + sqrt(self.c_star**2 + 2 * (mpf(target) - self.onset)) * (-1 if unstable else 1)
        k = -pi * self.lam * c / (c - self.c_star)
        return non_contact_state(self.lam, c), 1 / k if given == "P" else k, mpf(0)


def offset(rng: random.Random) -> mpf:
    """Distance above a fold: 30 % within 1e-10 .. 1, the rest up to 1e4."""
    if rng.random() < 0.3:
        return mpf(10) ** rng.uniform(-10, 0)
    return mpf(10) ** rng.uniform(0, 4) if rng.random() < 0.3 else mpf(rng.uniform(0, 10))


def row(text: str, unstable: bool, target: float, values: tuple[float, float, mpf, mpf]) -> str:
    other, a, rate, radius_rate = values
    return f"{{{text}, {int(unstable)}, {target!r}, {other!r}, {a!r}, {float(rate):.6g}, {float(radius_rate):.6g}}},"


def indentation_row(b: Branches, text: str, rng: random.Random) -> str | None:
    unstable = rng.random() < 0.15
    low = b.grip.d if b.u_grip is not None or unstable or rng.random() < 0.4 else b.touch.d
    d = float(low + offset(rng))
    if mpf(d) <= b.grip.d or (unstable and mpf(d) >= b.onset) or abs(mpf(d) - b.touch.d) < mpf(10) ** -40:
        return None
    in_contact = d < b.touch.d if unstable and b.u_grip is not None else not unstable and d > b.touch.d
    in_contact = in_contact or (b.u_grip is not None and not unstable)
    state, k, da = (b.contact if in_contact else b.apart)("d", d, unstable)
    return row(text, unstable, d, (float(state.P), float(state.a), k, da))


def load_row(b: Branches, text: str, rng: random.Random) -> str | None:
    unstable = rng.random() < 0.15
    P = float(b.pull.P + offset(rng))
    if mpf(P) <= b.pull.P or (unstable and P >= 0):
        return None
    state, rate, da = (b.apart if unstable and b.touch.P < P else b.contact)("P", P, unstable)
    return row(text, unstable, P, (float(state.d), float(state.a), rate, da))


Make = Callable[[Branches, str, random.Random], str | None]


def cases(job: tuple[int, str, int]) -> tuple[list[str], list[str]]:
    seed, text, count = job
    rng = random.Random(seed)
    branches = Branches(mpf(float(text)))

    def rows(make: Make) -> list[str]:
        made: list[str] = []
        while len(made) < count:
            line = make(branches, text, rng)
            made += [line] if line is not None else []
        return made

    return rows(indentation_row), rows(load_row)


def main() -> None:
    jobs = [(seed, text, count) for seed, (text, count) in enumerate(lambdas(random.Random(1992)))]
    with multiprocessing.Pool() as pool:
        parts = pool.map(cases, jobs, chunksize=1)
    folder = Path(__file__).resolve().parent
    for name, column, (given, other) in (("indentations", 0, "dP"), ("loads", 1, "Pd")):
        head = "/* SPDX-License-Identifier: BSD-3-Clause\n * Generated by maugis_cases.py: "
        head += f"lambda, unstable, {given}, {other}, a, "
        head += f"d{other}/d{given}, da/d{given}; reduced units. Do not edit. */\n"
        rows = [line for part in parts for line in part[column]]
        (folder / f"maugis_{name}.inc").write_text(head + "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
