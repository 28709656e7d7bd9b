# SPDX-License-Identifier: BSD-3-Clause
"""Margins of three axes of random rigs and contacts, independent of the library: makes sideways_table.h.

One matrix per period of z (loop_oracle.py) and of a lateral axis, tied by the forces of the contact; limits are
where an eigenvalue leaves the unit circle. The rule is the larger eigenvalue of docs/margins.md, "Three axes".

Run: python sideways_oracle.py > sideways_table.h     (numpy and scipy)
"""

from __future__ import annotations

import math
from typing import Any

import loop_oracle as loops
import numpy as np

CONTACT = ("stick", "grip", "slope", "curvature", "load")
KINDS = (
    "plain",
    "plain latency",
    "slow",
    "free",
    "fraction impedance",
    "smooth",
    "flat",
    "latency",
    "soft",
    "stuck",
    "stuck latency",
)


class Both(loops.Loop):
    """z with a lateral axis beside it, on a contact J [N/m] over x and z."""

    def __init__(self, p: Any, gain: float, J: Any, hand: tuple[float, float, float]):
        self.J, self.gain = np.array(J), gain * p.alpha_f * p.gains_alpha_p
        self.after = 1 + math.ceil(p.dead / p.T - 1e-9)
        mass, damping, stiffness = hand
        self.side = loops.Part(p.master_mass + mass, p.own_damping + damping, stiffness, p.T,
                               p.dead + 2.0 * p.hold)  # fmt: skip
        self.lateral = 2 + self.after + self.side.whole + 1
        super().__init__(p, 0.0, p.K_f, hand)
        rows = [self.both(row) for row in np.eye(self.size + self.lateral)]
        self.A = np.array(rows).T

    def both(self, state: Any) -> Any:
        z, rest = state[: self.size], state[self.size :]
        x, past, queue = rest[:2], list(rest[2 : 2 + self.after]), list(rest[2 + self.after :])
        way = past[0]  # of the stage, which is at once where it is told, as the sample shows it
        self.k_r = 0.0
        side = self.gain * (self.J[0, 0] * way + self.J[0, 1] * z[2])
        force = self.gain * (self.J[1, 0] * way + self.J[1, 1] * z[2])
        moved, _ = self.period(z, np.array([0.0, 0.0, 0.0, force, 0.0, 0.0]))
        x, queue, _ = self.side.step(x, queue, -side)
        # what is read now was commanded `after` periods before the next sample
        return np.concatenate([moved, x, [*past[1:], rest[0]], queue])


def alone(p: Any, hand: tuple[float, float, float]) -> tuple[float, float]:
    """kappa at which x over a spring oscillates, and how often [Hz]."""

    def matrix(kappa: float) -> Any:
        side = loops.Part(p.master_mass + hand[0], p.own_damping + hand[1], hand[2], p.T, p.dead + 2.0 * p.hold)
        after, size = 1 + math.ceil(p.dead / p.T - 1e-9), 2 + side.whole + 1

        def step(state: Any) -> Any:
            past, queue = list(state[2 : 2 + after]), list(state[2 + after :])
            x, queue, _ = side.step(state[:2], queue, -kappa * past[0])
            return np.concatenate([x, [*past[1:], state[0]], queue])

        return np.array([step(row) for row in np.eye(size + after)]).T

    kappa = loops.limit(lambda k: float(np.abs(np.linalg.eigvals(matrix(k))).max()), 1.0, 1e8)
    roots = np.linalg.eigvals(matrix(kappa))
    root = roots[np.argmin(np.abs(np.abs(roots) - 1.0))]
    return kappa, abs(float(np.angle(root))) / (2.0 * math.pi * p.T)


def contact_of(kind: str, random: Any, p: Any) -> dict[str, float]:
    def log(low: float, high: float) -> float:
        return float(np.exp(random.uniform(math.log(low), math.log(high))))

    found = {"stick": log(0.05, 0.5) * p.k_eff, "grip": log(0.05, 0.3) * p.k, "slope": log(0.1, 0.6),
             "curvature": log(1e5, 1e7), "load": log(1e-8, 1e-6)}  # fmt: skip
    if "stuck" in kind:
        found["stick"], found["grip"] = log(3.0, 8.0) * p.k_eff, log(0.5, 1.0) * p.k
    if "smooth" in kind:
        found["stick"] = found["grip"] = 0.0
    if "flat" in kind:
        found["slope"] = found["curvature"] = 0.0
    return found


def together(p: Any, hand: tuple[float, float, float], c: dict[str, float]) -> float:
    """The least factor on alpha_f at which all axes oscillate."""
    grips = c["grip"] * p.k_eff / p.k
    frictionless = c["stick"] == 0.0 and c["grip"] == 0.0
    slopes = [c["slope"] * share for share in (0.25, 0.5, 0.75, 1.0)] if c["slope"] > 0.0 else [0.0]
    limits = []
    for slope in slopes:
        for stuck, slips in [(0, 0)] if frictionless else [(0, 0), (1, 0), (0, 1), (0, -1)]:
            by_z = p.k_eff * slope + slips * grips
            J = [[slope * by_z + c["load"] * c["curvature"] + stuck * c["stick"], by_z], [p.k_eff * slope, p.k_eff]]
            limits.append(loops.limit(lambda g, J=J: Both(p, g, J, hand).radius(), 1e-1, 1e3, 1e-10))
    return min(limits)


def main() -> None:
    names = [*loops.NAMES, *CONTACT]
    outputs = ("loop_stiffness", "loop_delay", "margin", "exact_limit", "exact_frequency", "coupling", "coupled_margin",
               "projected", "together")  # fmt: skip
    print("/* SPDX-License-Identifier: BSD-3-Clause")
    print(" * Generated by sideways_oracle.py: margins of three axes. Do not edit. */")
    print("typedef struct sideways_case {\n    const char *kind;")
    print(f"    double in[{len(names)}]; /* as in loop_table.h, and the contact: {', '.join(CONTACT)} */")
    print("".join(f"    double {name};\n" for name in outputs) + "} sideways_case;\n")
    print("static const sideways_case sideways_cases[] = {")
    for seed, kind in enumerate(KINDS, 101):
        f = loops.drawn(seed, kind)
        p = loops.effective(f)
        c = contact_of(kind, np.random.default_rng(seed), p)
        hand = (p.hand_mass, p.hand_damping, p.hand_stiffness)
        z = loops.margins(p, limits=False)
        scale = p.alpha_f * p.gains_alpha_p
        by_z = p.k_eff * c["slope"] + c["grip"] * p.k_eff / p.k
        lateral = c["stick"] + c["slope"] * by_z + c["load"] * c["curvature"]
        periods = 1 + math.ceil(p.dead / p.T - 1e-9)
        delay = (periods + 0.5) * p.T + p.dead + 2.0 * p.hold
        margin = p.own_damping / (delay * scale * lateral)
        b_z = z["stability_limit"] * z["loop_delay"] / (z["loop_stiffness"] / (scale * p.k_eff))
        off = 0.5 * scale * (by_z * z["loop_delay"] + p.k_eff * c["slope"] * delay) / math.sqrt(p.own_damping * b_z)
        rule = np.array([[1.0 / margin, off], [off, 1.0 / z["margin"]]]) if by_z > 0.0 else \
            np.diag([1.0 / margin, 1.0 / z["margin"]])  # fmt: skip
        kappa, frequency = alone(p, hand)
        coupled = 1.0 / float(np.linalg.eigvalsh(rule)[-1])
        exact = together(p, hand, c) if by_z > 0.0 else math.inf
        coupled = float(np.minimum(coupled, exact))
        found = (scale * lateral, delay, margin, kappa, frequency,
                 2.0 * rule[0, 1] / np.trace(rule), coupled, 1.0 + 0.5 * by_z / p.k_eff, exact)  # fmt: skip
        values = ", ".join(loops.number(value) for value in [*(f[name] for name in loops.NAMES), *c.values()])
        print(f'    {{.kind = "{kind}",\n     .in = {{{values}}},')
        print(
            "".join(f"     .{name} = {loops.number(value)},\n" for name, value in zip(outputs, found, strict=True))
            + "},"
        )
    print("};")


if __name__ == "__main__":
    main()
