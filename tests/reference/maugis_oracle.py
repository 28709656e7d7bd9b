# SPDX-License-Identifier: BSD-3-Clause
"""High-precision solution of Maugis-Dugdale, independent of the library: makes maugis_table.h.

It uses the equations as Maugis printed them (J. Colloid Interface Sci. 150 (1992) 243; the paper's Eq. 11 with errata
E9 and E10), in the contact radius a and m = c/a, in units of K = R = pi w = 1, with 120 decimal digits, which leaves
more than 60 behind m - 1 ~ 1/lambda^2. The energy is the integral over the stress functions of the half-spaces and of
the Dugdale zone, integrated numerically; that it is the potential of the force is checked here by differentiation along
the branch. The stiffness is differentiated numerically. Inputs are exact doubles; results are rounded to 25 digits.

Run: python maugis_oracle.py > maugis_table.h     (mpmath 1.3 or newer; some minutes on two cores)
"""

from __future__ import annotations

import multiprocessing
from dataclasses import dataclass

from mpmath import acos, diff, exp, findroot, log, mp, mpf, nstr, pi, quad, sqrt

mp.dps = 120

LAMBDAS = ["1e-12", "1e-6", "1e-3", "0.01", "0.12", "0.3", "0.9", "0.95", "1", "5.8", "100", "1e3", "1e6", "1e12"]
CONTACT, NON_CONTACT = range(2)


@dataclass(frozen=True)
class State:
    """One equilibrium: contact radius, outer radius of the cohesive zone, load, indentation."""

    a: mpf
    c: mpf
    P: mpf
    d: mpf


def contact_state(lam: mpf, u: mpf) -> State:
    """The contact branch at u = log(m - 1): the Griffith condition is a quadratic in a, the rest is as printed."""
    m = 1 + exp(u)
    root, angle = sqrt(m * m - 1), acos(1 / m)
    square = lam / 2 * (root + (m * m - 2) * angle)
    linear = mpf(4) / 3 * lam**2 * (root * angle - m + 1)
    a = 2 / (linear + sqrt(linear**2 + 4 * square))
    P = a**3 - lam * a**2 * (root + m * m * angle)
    d = a**2 - mpf(4) / 3 * lam * a * root
    return State(a, m * a, P, d)


def griffith_residual(lam: mpf, s: State) -> mpf:
    """How well the printed Griffith condition holds."""
    m = s.c / s.a
    root, angle = sqrt(m * m - 1), acos(1 / m)
    first = lam * s.a**2 / 2 * (root + (m * m - 2) * angle)
    second = mpf(4) / 3 * lam**2 * s.a * (root * angle - m + 1)
    return first + second - 1


def non_contact_state(lam: mpf, c: mpf) -> State:
    """The surfaces apart, a disc of radius c inside the range of the stress."""
    d = c**2 / 2 - 8 * lam * c / (3 * pi) - 2 / (pi * lam)
    return State(mpf(0), c, -pi / 2 * lam * c**2, d)


def energy(lam: mpf, s: State) -> mpf:
    """Elastic energy, work of the stress on the gap, surface energy: raw integrals over the stress function q(t)."""
    with mp.workdps(60):
        a, c, d = +s.a, +s.c, +s.d
        contact = quad(lambda t: (mpf(3) / 8 * (d - t * t)) ** 2, [0, a]) if a else mpf(0)
        zone = quad(lambda t: (lam / 2) ** 2 * (c * c - t * t), [a, c])
        cross = quad(lambda t: (d - t * t) * (sqrt(c * c - t * t) - sqrt(a * a - t * t)), [0, a]) if a else mpf(0)
        gap = (c**4 - a**4) / 8 - d * (c * c - a * a) / 2
        return mpf(16) / 3 * (contact - zone) + 2 * lam * cross - c * c + pi * lam * gap


@dataclass(frozen=True)
class Slopes:
    """Derivatives with respect to the indentation: k = dP/dd, dk/dd and da/dd."""

    k: mpf
    dk_dd: mpf
    da_dd: mpf


def slopes(lam: mpf, u: mpf) -> Slopes:
    P1, P2 = (diff(lambda v: contact_state(lam, v).P, u, n) for n in (1, 2))
    d1, d2 = (diff(lambda v: contact_state(lam, v).d, u, n) for n in (1, 2))
    return Slopes(P1 / d1, (P2 * d1 - P1 * d2) / d1**3, diff(lambda v: contact_state(lam, v).a, u) / d1)


def solve(lam: mpf, quantity: str, target: mpf, u_low: mpf, u_high: mpf) -> mpf:
    """u between two values where P or d passes its target, to the last digits."""

    def error(u: mpf) -> mpf:
        return getattr(contact_state(lam, u), quantity) - target

    low, high = u_low, u_high
    sign = error(low) > 0
    assert sign != (error(high) > 0), (lam, quantity, target)
    for _ in range(40):
        middle = (low + high) / 2
        if (error(middle) > 0) == sign:
            low = middle
        else:
            high = middle
    return findroot(error, (low, high), solver="anderson", tol=mpf(10) ** -200, maxsteps=200, verify=False)


def fold(lam: mpf, quantity: str) -> mpf | None:
    """u where P or d has its minimum along the contact branch; None where it has none."""

    def slope(u: mpf) -> mpf:
        return diff(lambda v: getattr(contact_state(lam, v), quantity), u)

    grid = [mpf(i) / 2 for i in range(-140, 140)]
    values = [getattr(contact_state(lam, u), quantity) for u in grid]
    lowest = min(range(len(grid)), key=lambda i: values[i])
    if lowest == len(grid) - 1:
        return None
    return findroot(slope, (grid[lowest - 1], grid[lowest + 1]), solver="anderson", tol=mpf(10) ** -120, verify=False)


def number(x: mpf) -> str:
    return str(nstr(x, 25, min_fixed=0, max_fixed=0))


def exact(x: mpf) -> str:
    return float(x).hex()


def state_row(lam: mpf, unstable: int, d: float, values: tuple[mpf, ...]) -> str:
    return f"{{{exact(lam)}, {unstable}, {d.hex()}, {', '.join(number(v) for v in values)}}},"


U_TOUCH, U_DEEP = mpf(200), mpf(-140)  # m of 1e87 (a = 0 to all digits) and 1 + 1e-61


def contact_row(lam: mpf, unstable: int, d: float, ends: tuple[mpf, mpf]) -> str:
    u = solve(lam, "d", mpf(d), *ends)
    s = contact_state(lam, u)
    assert abs(griffith_residual(lam, s)) < mpf(10) ** -70
    assert abs(s.d - mpf(d)) < mpf(10) ** -50 * (1 + abs(d))
    rates = slopes(lam, u)
    return state_row(lam, unstable, d, (energy(lam, s), s.P, rates.k, s.a, rates.dk_dd, rates.da_dd))


def non_contact_row(lam: mpf, unstable: int, d: float) -> str:
    c_star = 8 * lam / (3 * pi)
    root = sqrt(c_star**2 + 2 * (mpf(d) + 2 / (pi * lam))) * (-1 if unstable else 1)
    c = c_star + root
    s = non_contact_state(lam, c)
    dk_dd = pi * lam * c_star / root**3
    return state_row(lam, unstable, d, (energy(lam, s), s.P, -pi * lam * c / root, s.a, dk_dd, mpf(0)))


def between(low: mpf, high: mpf) -> list[float]:
    """Doubles strictly between two indentations: spread, and crowding at both ends."""
    parts = [mpf(i) / 12 for i in range(1, 12)] + [mpf(10) ** -e for e in (2, 3, 4, 6, 8)]
    parts += [1 - mpf(10) ** -e for e in (2, 3, 4, 6, 8)]
    return sorted({x for x in (float(low + p * (high - low)) for p in parts) if low < mpf(x) < high})


def beyond(low: mpf) -> list[float]:
    """Doubles above an indentation or load: crowding at it, spread to 1e4."""
    steps = [mpf(10) ** (-mpf(e) / 2) for e in range(1, 21)] + [mpf(i) / 2 for i in range(1, 24)]
    steps += [mpf(10) ** (mpf(e) / 4) for e in range(5, 17)]
    return [float(low + step) for step in steps]


def load_row(lam: mpf, unstable: int, P: float, u: mpf) -> str:
    assert abs(contact_state(lam, u).P - mpf(P)) < mpf(10) ** -50 * (1 + abs(P))
    return load_text(lam, unstable, P, (contact_state(lam, u).d, slopes(lam, u).k))


def load_text(lam: mpf, unstable: int, P: float, values: tuple[mpf, ...]) -> str:
    return f"{{{exact(lam)}, {unstable}, {P.hex()}, {', '.join(number(v) for v in values)}}},"


def check_energy(lam: mpf) -> None:
    """dU/dd = P along the contact branch, and U continuous with the non-contact branch at a = 0."""
    for y in (mpf("0.01"), mpf(1), 1 + lam):
        u = log(sqrt(1 + 1 / y**2) - 1)
        slope = diff(lambda v: energy(lam, contact_state(lam, v)), u, h=mpf(10) ** -15)
        rate = slope / diff(lambda v: contact_state(lam, v).d, u)
        P = contact_state(lam, u).P
        assert abs(rate - P) < mpf(10) ** -12 * (2 + abs(P)), (lam, y, rate, P)
    c = contact_state(lam, U_TOUCH).c
    U = energy(lam, non_contact_state(lam, c))
    integral = quad(lambda x: -pi / 2 * lam * x**2 * (x - 8 * lam / (3 * pi)), [0, c])
    assert abs(U - integral) < mpf(10) ** -40 * (1 + abs(U)), (lam, U, integral)


def tables(text: str) -> tuple[list[str], list[str], str]:
    lam = mpf(float(text))
    check_energy(lam)
    u_grip, u_pull = fold(lam, "d"), fold(lam, "P")
    assert u_pull is not None
    touch, onset, c_star = contact_state(lam, U_TOUCH), -2 / (pi * lam), 8 * lam / (3 * pi)
    grip = contact_state(lam, u_grip) if u_grip is not None else non_contact_state(lam, c_star)
    pull = contact_state(lam, u_pull)
    start = u_grip if u_grip is not None else U_TOUCH
    rows = [contact_row(lam, 0, d, (U_DEEP, start)) for d in beyond(contact_state(lam, start).d)]
    if u_grip is not None:
        rows += [contact_row(lam, 1, d, (u_grip, U_TOUCH)) for d in between(grip.d, touch.d)]
        rows += [non_contact_row(lam, 1, d) for d in between(touch.d, onset)]
    else:
        rows += [non_contact_row(lam, 0, d) for d in between(grip.d, touch.d)]
        rows += [non_contact_row(lam, 1, d) for d in between(grip.d, onset)]
    loads = []
    for P in beyond(pull.P):
        loads.append(load_row(lam, 0, P, solve(lam, "P", mpf(P), U_DEEP, u_pull)))
    for P in between(pull.P, touch.P):
        loads.append(load_row(lam, 1, P, solve(lam, "P", mpf(P), u_pull, U_TOUCH)))
    for P in between(touch.P, mpf(0)):
        c = sqrt(-mpf(P) / (pi / 2 * lam))
        loads.append(load_text(lam, 1, P, (non_contact_state(lam, c).d, -pi * lam * c / (c - c_star))))
    zero = contact_state(lam, solve(lam, "P", mpf(0), U_DEEP, u_pull))
    values = (pull.P, pull.a, pull.d, grip.P, grip.a, grip.d, zero.a, zero.d, touch.P, touch.d, onset)
    folds = f"{{{exact(lam)}, {int(u_grip is not None)}, {', '.join(number(v) for v in values)}}},"
    return rows, loads, folds


HEAD = """/* SPDX-License-Identifier: BSD-3-Clause
 * Generated by maugis_oracle.py: Maugis-Dugdale to 25 digits in reduced units (K = R = pi w = 1). Do not edit. */
"""
STATES = """static const struct {
    double lambda;
    int unstable;
    double d, U, P, k, a;
    double dk_dd, da_dd;
} maugis_states[] = {"""
LOADS = """static const struct {
    double lambda;
    int unstable;
    double P, d, k;
} maugis_loads[] = {"""
FOLDS = """static const struct {
    double lambda;
    int grip_in_contact;
    double pull_off_load, pull_off_radius, pull_off_indentation;
    double grip_load, grip_radius, grip_indentation;
    double zero_load_radius, zero_load_indentation, touch_load, touch_indentation, onset_indentation;
} maugis_fold_values[] = {"""


def main() -> None:
    with multiprocessing.Pool() as pool:
        parts = pool.map(tables, LAMBDAS, chunksize=1)
    states = [row for rows, _, _ in parts for row in rows]
    loads = [row for _, rows, _ in parts for row in rows]
    print(HEAD)
    for head, rows in ((STATES, states), (LOADS, loads), (FOLDS, [row for _, _, row in parts])):
        print(head + "\n    " + "\n    ".join(rows) + "\n};\n")


if __name__ == "__main__":
    main()
