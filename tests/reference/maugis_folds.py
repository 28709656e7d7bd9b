# SPDX-License-Identifier: BSD-3-Clause
"""Makes maugis_folds.inc: folds of Maugis-Dugdale from the two printed equations in a and m = c/a (Maugis 1992), not
from the form in y that the library uses, with 60 digits. lambda is spread over all that is valid, and crowds where the
displacement fold leaves the contact branch.

Run: python maugis_folds.py > maugis_folds.inc     (mpmath 1.3 or newer)
"""

from __future__ import annotations

import random

from mpmath import acos, diff, findroot, mp, mpf, nstr, pi, sqrt

mp.dps = 60


def state(lam: mpf, y: mpf) -> tuple[mpf, mpf, mpf]:
    """a, P, d at y = a/sqrt(c^2 - a^2), by m = sqrt(1 + 1/y^2): the printed equations solved for a."""
    m = sqrt(1 + 1 / (y * y))
    root, arc = sqrt(m * m - 1), acos(1 / m)
    square = lam / 2 * (root + (m * m - 2) * arc)
    linear = 4 * lam * lam / 3 * (1 - m + root * arc)
    a = (-linear + sqrt(linear * linear + 4 * square)) / (2 * square)
    return a, a**3 - lam * a * a * (root + m * m * arc), a * a - 4 * lam * a * root / 3


def turning(lam: mpf, which: int, low: mpf, high: mpf) -> mpf:
    return findroot(
        lambda at: diff(lambda y: state(lam, y)[which], at, h=mpf(10) ** -25) / at,
        (low, high), solver="anderson", tol=mpf(10) ** -60, verify=False, maxsteps=80,
    )  # fmt: skip


def row(lam: mpf) -> str:
    centre = mpf("0.93794745721071221162973566815")
    guess = mpf("1.6") * lam * sqrt(lam) if lam < 1 else lam * mpf("0.9")
    load = state(lam, turning(lam, 1, guess / 2, guess * 2))
    guess = mpf("1.2") * sqrt(lam) if lam < 1 else lam * mpf("1.2")
    zero_y = findroot(lambda y: state(lam, y)[1], (guess / 2, guess * 2), solver="anderson", tol=mpf(10) ** -80)
    zero = state(lam, zero_y)
    if lam > centre:
        grip = state(lam, turning(lam, 2, (lam - centre) / 2, (lam - centre) * 3))
    else:
        c = 8 * lam / (3 * pi)
        grip = mpf(0), -pi / 2 * lam * c * c, -2 / (pi * lam) - c * c / 2
    numbers = (lam, load[1], load[0], load[2], grip[1], grip[0], grip[2], zero[0], zero[2])
    return "    {" + ", ".join(nstr(number, 20) for number in numbers) + "},"


def main() -> None:
    random.seed(45)
    lambdas = [10 ** random.uniform(-6, 6) for _ in range(60)] + [10 ** random.uniform(-1.5, 1.5) for _ in range(60)]
    lambdas += [0.9379474572107122 * (1 + 10 ** random.uniform(-6, -1)) for _ in range(20)]
    for lam in lambdas:
        print(row(mpf(lam)))


if __name__ == "__main__":
    main()
