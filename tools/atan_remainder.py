# SPDX-License-Identifier: BSD-3-Clause
"""Makes the coefficients of nt_maugis_atan_remainder() in libnanotouch/contact/maugis/functions.h.

A(z) = (sqrt z - atan sqrt z)/z^1.5 on 0 <= z <= 1, as the ratio of a polynomial of degree 6 to one of degree 7 that
equals A at 14 Chebyshev points, computed with 80 digits. Prints the coefficients and the largest relative error.

Run: python atan_remainder.py     (mpmath 1.3 or newer)
"""

from __future__ import annotations

from mpmath import atan, cos, lu_solve, matrix, mp, mpf, nstr, pi, polyval, sqrt

mp.dps = 80

NUMERATOR_DEGREE, DENOMINATOR_DEGREE = 6, 7


def remainder(z: mpf) -> mpf:
    s = sqrt(z)
    return (s - atan(s)) / s**3


def interpolant() -> tuple[list[mpf], list[mpf]]:
    """Coefficients p and q, lowest first, q[0] = 1: p(z) - A(z) (q(z) - 1) = A(z) at the nodes."""
    n, m = NUMERATOR_DEGREE, DENOMINATOR_DEGREE
    count = n + m + 1
    system, right = matrix(count, count), matrix(count, 1)
    for i in range(count):
        z = (1 - cos(pi * (2 * i + 1) / (2 * count))) / 2
        value = remainder(z)
        for j in range(n + 1):
            system[i, j] = z**j
        for j in range(1, m + 1):
            system[i, n + j] = -value * z**j
        right[i] = value
    solution = lu_solve(system, right)
    return [solution[j] for j in range(n + 1)], [mpf(1)] + [solution[n + j] for j in range(1, m + 1)]


def main() -> None:
    p, q = interpolant()
    points = [mpf(i) / 2000 + mpf(10) ** -9 for i in range(2000)]
    error = max(abs(polyval(p[::-1], z) / polyval(q[::-1], z) / remainder(z) - 1) for z in points)
    print("p:", ", ".join(nstr(c, 20) for c in p))
    print("q:", ", ".join(nstr(c, 20) for c in q))
    print("largest relative error:", nstr(error, 2))


if __name__ == "__main__":
    main()
