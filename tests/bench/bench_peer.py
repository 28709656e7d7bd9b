# SPDX-License-Identifier: BSD-3-Clause
"""Maugis-Dugdale beside the one public solver, ContactEngineering's Adhesion (an optional dependency of this bench).

The peer gives load and indentation at a contact radius; a force at an indentation needs a root search over it, as its
users do. Errors are against our exact tier, which the tests hold to an independent high-precision oracle.

Run: pip install Adhesion; python bench_peer.py
"""

from __future__ import annotations

import numpy as np
from nanotouch.contact import reduced
from timing import least

LAMBDAS = (0.01, 0.27, 1.0, 5.8, 100.0, 1e5)
RADII = np.linspace(1.0, 5.0, 40)  # on the stable branch of every lambda


def main() -> None:
    """Print one line per lambda: time per force at an indentation, and the peer's error."""
    from Adhesion.ReferenceSolutions.MaugisDugdale import _load_and_displacement as peer_state  # in Maugis' units
    from scipy.optimize import brentq

    def peer_force(d: float, lam: float) -> float:
        a = brentq(lambda radius: float(np.ravel(peer_state(np.array([radius]), lam)[1])[0]) - d, 0.9, 6.0, xtol=1e-12)
        return float(np.ravel(peer_state(np.array([a]), lam)[0])[0])

    print(f"{'lambda':>8}{'peer [us]':>12}{'exact [us]':>12}{'ratio':>8}{'table ratio':>13}{'peer error':>12}")
    for lam in LAMBDAS:
        d = np.array([reduced.at_radius(lam, a).indentation for a in RADII])
        exact = reduced.force(lam, d)
        many = np.tile(d, 500)
        peer = least(lambda lam=lam, d=d: [peer_force(x, lam) for x in d], 2) / len(d)  # type: ignore[misc]
        ours = least(lambda lam=lam, many=many: reduced.force(lam, many)) / len(many)  # type: ignore[misc]
        table = least(lambda lam=lam, many=many: reduced.force(lam, many, tier="table")) / len(many)  # type: ignore[misc]
        found = np.array([peer_force(x, lam) for x in d])
        error = np.max(np.abs(found - exact) / np.maximum(np.abs(exact), 1.5))
        print(f"{lam:>8g}{peer * 1e6:>12.1f}{ours * 1e6:>12.3f}{peer / ours:>8.0f}{peer / table:>13.0f}{error:>12.1e}")


if __name__ == "__main__":
    main()
