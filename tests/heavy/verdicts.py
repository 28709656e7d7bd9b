# SPDX-License-Identifier: BSD-3-Clause
"""Is an ``ok`` right? Curves of 13 kinds of defect, and clean ones, fitted with Hertz' law as a user would.

``python tests/heavy/verdicts.py [CURVES] [--held-out] [--first SEED] [--kind NAME]``: by kind, how many of the fits are
``ok``, how many of these are off by more than 20 % and outside their interval, and how many have an interval beyond
+-20 % that k, R and sensitivity, as uncertain as the fit is told, do not explain alone.
"""

from __future__ import annotations

import argparse
import sys
import warnings

import nanotouch as nt
import numpy as np
import verdict_draws as draws

FAR = 0.2
MOST_WRONG, MOST_LOST = 0.01, 0.02


def fitted(lab: draws.Lab, kind: str, seed: int) -> tuple[nt.fit.FitResult | None, float, str]:
    """The fit, the true E*, and why there is none."""
    one = draws.draw(lab, seed)
    ideal = draws.KINDS[kind](one)
    curve, radius = draws.curve_of(one, ideal, lab)
    known = nt.fit.Uncertainties(sensitivity=lab.known_to[0], spring_constant=lab.known_to[1], radius=lab.known_to[1])
    try:
        return nt.fit.fit_curve(curve, "hertz", radius=radius, uncertainties=known), ideal.modulus, ""
    except nt.errors.Error as error:
        return None, ideal.modulus, str(error)


def half_width(result: nt.fit.FitResult) -> float:
    """Half of the 95 % interval over the value, in the logarithm."""
    low, high = result.interval["effective_modulus"]
    return 0.5 * float(np.log(high / low)) if low > 0.0 else np.inf


def too_wide(result: nt.fit.FitResult) -> bool:
    """Beyond +-20 % without the calibration's share."""
    relative = result.sigma_statistical["effective_modulus"] / result.values["effective_modulus"]
    return half_width(result) > np.log1p(FAR) and 1.96 * relative > np.log1p(FAR)


def main() -> None:
    """A table by kind; fails where more than 1 % of what is ok is wrong, or 2 % of what is clean is lost."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("curves", nargs="?", type=int, default=300)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--held-out", action="store_true")
    parser.add_argument("--kind", action="append")
    parser.add_argument("--wrong", action="store_true", help="name the seeds that are wrong")
    args = parser.parse_args()
    warnings.simplefilter("ignore")
    lab = draws.HELD_OUT if args.held_out else draws.OWN
    counts = {"ok": 0, "wrong": 0, "wide": 0}
    lost = 0.0
    print(f"{'kind':12}{'ok':>6} of curves{'wrong of ok':>14}{'wide of ok':>12}{'median half width':>20}{'error':>9}")
    for kind in args.kind or draws.KINDS:
        ok, wrong, wide, halves, errors, seeds = 0, 0, 0, [], [], []
        for seed in range(args.first, args.first + args.curves):
            result, truth, _ = fitted(lab, kind, seed)
            if result is None or result.status != "ok":
                continue
            ok += 1
            value, (low, high) = result.values["effective_modulus"], result.interval["effective_modulus"]
            bad = abs(value / truth - 1.0) > FAR and not low <= truth <= high
            wrong += bad
            wide += too_wide(result)
            halves.append(half_width(result))
            errors.append(value / truth - 1.0)
            if bad:
                seeds.append(seed)
        middle = (float(np.median(halves)), float(np.median(errors))) if halves else (np.nan, np.nan)
        shown = f"{100 * middle[0]:17.1f} %{100 * middle[1]:8.1f} %"
        named = seeds if args.wrong else ()
        print(f"{kind:12}{ok:6d} of {args.curves:<6d}{wrong:10d}{wide:13d}{shown}", *named, flush=True)
        counts = {"ok": counts["ok"] + ok, "wrong": counts["wrong"] + wrong, "wide": counts["wide"] + wide}
        if kind == "clean":
            lost = 1.0 - ok / args.curves
    share = counts["wrong"] / max(counts["ok"], 1)
    print(f"of {counts['ok']} ok: {counts['wrong']} wrong ({100 * share:.2f} %), {counts['wide']} wide; "
          f"{100 * lost:.1f} % of the clean ones are not ok")  # fmt: skip
    sys.exit(share > MOST_WRONG or counts["wide"] > 0 or lost > MOST_LOST)


if __name__ == "__main__":
    main()
