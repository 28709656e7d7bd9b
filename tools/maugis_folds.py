# SPDX-License-Identifier: BSD-3-Clause
"""Makes libnanotouch/contact/maugis/fold_polynomials.inc: where the contact branch of Maugis-Dugdale has its folds.

The branch parameter y of the displacement fold, of the load fold and of zero load, over lambda, each made a smooth
function of a variable that runs from 0 to 1 (maugis/folds.c has them), by a polynomial in each eighth of it that equals
it at the Chebyshev points, computed with 40 digits. What the polynomials leave is below 2e-16 of y.

Run: python maugis_folds.py > fold_polynomials.inc     (mpmath 1.3 or newer)
"""

from __future__ import annotations

from collections.abc import Callable

from mpmath import atan, cos, diff, findroot, mp, mpf, nstr, pi, sqrt

mp.dps = 40
PIECES, COUNT = 8, 13


class Branch:
    """The branch at a lambda and y; h is a derivative by y over y."""

    def __init__(self, lam: mpf, y: mpf) -> None:
        w, r, t = 1 + y * y, sqrt(1 + y * y), pi / 2 - atan(y)
        g1, g2, g3 = y + (1 - y * y) * t, t - r + y, y + w * t
        h1, h2, h3 = -2 * (t - y / w), y / w - 1 / r, 2 * t
        linear = 4 * lam * lam / 3
        B = linear * g2
        D = sqrt(B * B + 2 * lam * g1)
        b = 2 / (B + D)
        b1 = -b * (lam / 2 * h1 * b + linear * h2) / D
        a, a1 = b * y, b + y * y * b1
        self.P = a**3 - lam * b * b * g3
        self.P1 = 3 * b * a * a1 - lam * b * (2 * b1 * g3 + b * h3)
        self.d1 = 2 * b * a1 - 4 * lam * b1 / 3


def root(function: Callable[[mpf], mpf], low: mpf, high: mpf) -> mpf:
    """In a bracket, to the last of the digits."""
    return findroot(function, (low, high), solver="anderson", tol=mpf(10) ** -60, verify=False, maxsteps=60)


def edge() -> tuple[mpf, mpf]:
    """lambda_0, where the displacement fold is at y = 0; and where, at y < 0, it ends in a square root."""
    centre = findroot(lambda lam: Branch(lam, mpf(0)).d1, mpf("0.938"))

    def turning(lam: mpf, y: mpf) -> tuple[mpf, mpf]:
        return Branch(lam, y).d1, diff(lambda at: Branch(lam, at).d1, y)

    return centre, findroot(turning, (mpf("0.88"), mpf("-0.25")))[0]


CENTRE, TURNING = edge()
BEYOND = CENTRE / TURNING  # of x = lambda_0/lambda
FIRST, LAST = sqrt(BEYOND - 1), sqrt(BEYOND)


def grip(t: mpf) -> mpf:
    lam = CENTRE / (BEYOND - (FIRST + t * (LAST - FIRST)) ** 2)
    return root(lambda y: Branch(lam, y).d1, (lam - CENTRE) / 2, (lam - CENTRE) * 3) / (lam - CENTRE)


def load(lam: mpf, guess: mpf) -> mpf:
    return root(lambda y: Branch(lam, y).P1, guess / 2, guess * 2)


def zero(lam: mpf, guess: mpf) -> mpf:
    return root(lambda y: Branch(lam, y).P, guess / 2, guess * 2)


def load_low(t: mpf) -> mpf:
    return load(t * t, t**3 * mpf("1.4")) / t**3


def zero_low(t: mpf) -> mpf:
    return zero(t * t, t * mpf("1.2")) / t


def load_high(t: mpf) -> mpf:
    return load(1 / t, mpf("0.9") / t) * t


def zero_high(t: mpf) -> mpf:
    return zero(1 / t, mpf("1.2") / t) * t


def polynomial(function: Callable[[mpf], mpf], piece: int) -> list[mpf]:
    """In s = -1 .. 1 over a piece, lowest coefficient first."""
    nodes = [cos(pi * (2 * i + 1) / (2 * COUNT)) for i in range(COUNT)]
    values = [function((piece + (node + 1) / 2) / PIECES) for node in nodes]
    before, now = [mpf(0)], [mpf(1)]  # Chebyshev polynomials
    total = [mpf(0)] * COUNT
    for k in range(COUNT):
        share = sum(v * cos(k * pi * (2 * i + 1) / (2 * COUNT)) for i, v in enumerate(values)) / COUNT
        for j, c in enumerate(now):
            total[j] += (share if k == 0 else 2 * share) * c
        twice = [mpf(0)] + [(1 if k == 0 else 2) * c for c in now]
        before, now = now, [c - (before[j] if k > 0 and j < len(before) else 0) for j, c in enumerate(twice)]
    return total


def main() -> None:
    low = CENTRE - mpf(float(CENTRE))
    print("/* SPDX-License-Identifier: BSD-3-Clause")
    print(" * Made by tools/maugis_folds.py. */")
    print(f"#define CENTRE {float(CENTRE)!r} /* lambda_0, and what a double leaves of it */")
    print(f"#define CENTRE_REST ({float(low)!r})")
    print(f"#define BEYOND {nstr(BEYOND, 20)} /* of lambda_0/lambda, where the displacement fold is a square root */")
    print(f"#define FIRST {nstr(FIRST, 20)} /* sqrt(BEYOND - lambda_0/lambda) at lambda_0 */")
    print(f"#define PER_WIDTH {nstr(1 / (LAST - FIRST), 20)} /* and over its width up to infinity */")
    print(f"enum {{ PIECES = {PIECES}, COEFFICIENTS = {COUNT} }};")
    for function in (grip, load_low, zero_low, load_high, zero_high):
        print(f"static const double {function.__name__}[PIECES][COEFFICIENTS] = {{")
        for piece in range(PIECES):
            row = [repr(float(c)) for c in polynomial(function, piece)]
            lines, text = [], "   "
            for number in row:
                if len(text) + len(number) + 3 > 116:
                    lines.append(text)
                    text = "    "
                text += f" {number},"
            print("    {" + ("\n".join([*lines, text])).lstrip().rstrip(",") + "},")
        print("};")


if __name__ == "__main__":
    main()
