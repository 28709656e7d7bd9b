# SPDX-License-Identifier: BSD-3-Clause
"""Margins, calm and guarantee of random rigs, independent of the library: makes loop_table.h.

The whole sampled loop is built as one matrix per period from the continuous models by matrix exponentials; a dead time
of n + eps periods divides each period in two. Limits are where an eigenvalue leaves the unit circle, found by
bisection; ripple is from the transfer functions C (z - A)^-1 B + D of that matrix. The library does neither: it
evaluates block by block on the circle. The terms of the guarantee are written down from docs/safety.md.

Run: python loop_oracle.py > loop_table.h     (numpy and scipy)
"""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
from scipy.linalg import expm

Floats = Any
RELEASED = 0.1
FIELDS = {
    "rig.probe": "spring_constant sensitivity noise resolution",
    "rig.stage": "resonance quality resolution command_resolution noise",
    "rig.master": "mass damping resolution max_force travel gauge gauge_range gauge_noise gauge_resolution rate",
    "rig.hand": "mass damping stiffness",
    "rig.converters": "adc_rate adc_latency dac_latency",
    "settings.gains": "rate alpha_p alpha_f alpha_f_approach alpha_f_retract force_gain force_filter"
    " velocity_feedforward stage_damping stage_integral stage_proportional stage_derivative coupling_stiffness"
    " coupling_damping height_gain height_stiffness delay",
    "settings.limits": "force stage_speed",
    "settings.control": "choice",
}
NAMES = [f"{of}.{name}" for of, names in FIELDS.items() for name in names.split()] + ["contact_stiffness"]
DEFAULT, PAPER, IMPEDANCE = 0, 1, 2


def logarithmic(random: Any) -> Any:
    """Numbers between two, alike in each decade."""
    return lambda low, high: float(np.exp(random.uniform(math.log(low), math.log(high))))


def drawn(seed: int, kind: str) -> dict[str, float]:
    """A rig and gains at random; kind says what is special."""
    random = np.random.default_rng(seed)
    log = logarithmic(random)
    f = dict.fromkeys(NAMES, 0.0)
    f |= {
        "rig.probe.spring_constant": log(1, 40), "rig.probe.sensitivity": log(1e-8, 1e-7),
        "rig.probe.noise": log(1e-3, 0.1), "rig.probe.resolution": log(1e-5, 1e-3),
        "rig.stage.resonance": log(300, 2000), "rig.stage.quality": log(3, 40),
        "rig.stage.resolution": log(1e-11, 3e-9), "rig.stage.command_resolution": log(1e-11, 1e-9),
        "rig.stage.noise": log(1e-11, 1e-9),
        "rig.master.mass": log(0.03, 0.5), "rig.master.damping": log(20, 200), "rig.master.resolution": log(1e-7, 1e-5),
        "rig.master.max_force": log(2, 10), "rig.master.travel": 0.02, "rig.master.gauge": 1.0,
        "rig.master.gauge_range": 5.0, "rig.master.gauge_noise": log(5e-4, 1e-2),
        "rig.master.gauge_resolution": log(2e-3, 0.05),
        "rig.hand.mass": log(0.005, 0.05), "rig.hand.damping": log(0.3, 5), "rig.hand.stiffness": log(50, 1000),
        "settings.gains.rate": log(3e3, 2e4), "settings.gains.alpha_p": log(1e-5, 2e-4),
        "settings.gains.alpha_f": log(1e5, 1e6), "settings.gains.alpha_f_approach": 1.0,
        "settings.gains.alpha_f_retract": log(1, 2), "settings.gains.force_gain": log(0.3, 3),
        "settings.gains.force_filter": log(50, 500), "settings.gains.stage_damping": random.uniform(0.3, 1.3),
        "settings.gains.stage_integral": log(5, 50), "settings.gains.height_gain": log(10, 200),
        "settings.gains.height_stiffness": log(100, 3000), "settings.gains.delay": float(random.integers(0, 4)),
        "settings.limits.force": log(1e-7, 1e-5), "settings.limits.stage_speed": log(3e-6, 1e-4),
        "contact_stiffness": log(5, 500),
    }  # fmt: skip
    if "soft" in kind:
        f["contact_stiffness"] = log(0.1, 0.3)
    if "coupled" not in kind and "paper" not in kind:  # near the limit, where the loop is felt
        f["settings.gains.alpha_f"] *= log(2e3, 2e4) / reflected(SimpleNamespace(**short(f)), f)
    if "latency" in kind:
        f["rig.converters.adc_latency"] = random.uniform(0.1, 0.9) / f["settings.gains.rate"]
        f["rig.converters.dac_latency"] = random.uniform(0.1, 0.9) / f["settings.gains.rate"]
    if "slow" in kind:
        f["rig.converters.adc_rate"] = random.uniform(0.6, 0.9) * f["settings.gains.rate"]
        f["rig.master.rate"] = random.uniform(0.3, 0.9) * f["settings.gains.rate"]
    if "fraction" in kind:
        f["settings.gains.velocity_feedforward"] = random.uniform(0.1, 0.6)
    if "coupled" in kind:
        f["settings.gains.coupling_stiffness"] = reflected(SimpleNamespace(**short(f)), f) * log(0.3, 3)
        f["settings.gains.coupling_damping"] = f["settings.gains.coupling_stiffness"] * log(1e-4, 1e-3)
        f["settings.gains.force_gain"] = log(0.1, 0.4)
    if "free" in kind:
        f["rig.hand.mass"] = f["rig.hand.damping"] = f["rig.hand.stiffness"] = 0.0
    if "impedance" in kind:
        f["settings.control.choice"] = IMPEDANCE
    if "paper" in kind:
        f["settings.control.choice"] = PAPER
        f["settings.gains.stage_proportional"], f["settings.gains.stage_derivative"] = log(0.01, 0.03), log(1e-7, 1e-6)
    if "sparse" in kind:  # two samples in a period of the resonance do not show it: no notch
        f["settings.gains.rate"] = random.uniform(1.3, 1.9) * f["rig.stage.resonance"]
        f["settings.gains.stage_integral"], f["settings.gains.delay"] = 1.0, 0.0
    return f


def short(f: dict[str, float]) -> dict[str, float]:
    """Names without what they belong to, apart where two are the same."""
    return {name.split(".", 1)[-1].replace(".", "_"): value for name, value in f.items()}


def reflected(p: SimpleNamespace, f: dict[str, float]) -> float:
    """alpha_f alpha_p k_eff, with the larger alpha_f of the regions."""
    k_c, k = p.probe_spring_constant, f["contact_stiffness"]
    most = max(1.0, p.gains_alpha_f_approach, p.gains_alpha_f_retract)
    return most * p.gains_alpha_f * p.gains_alpha_p * k_c * k / (k_c + k)


def effective(f: dict[str, float]) -> SimpleNamespace:
    """What the law amounts to."""
    p = SimpleNamespace(**short(f))
    p.T = 1.0 / p.gains_rate
    p.k = f["contact_stiffness"]
    p.k_eff = p.k * p.probe_spring_constant / (p.k + p.probe_spring_constant)
    p.paper = p.control_choice == PAPER
    p.own_damping = p.master_damping
    if not p.paper:
        p.master_damping *= 1.0 - p.gains_velocity_feedforward
    p.K_f = 0.0 if p.control_choice == IMPEDANCE or not p.master_gauge else p.gains_force_gain
    p.notched = p.gains_rate > 2.0 * p.stage_resonance and not p.paper
    p.zeta = p.gains_stage_damping if p.notched else 0.5 / p.stage_quality
    p.integral = 0.0 if p.paper else p.gains_stage_integral
    p.alpha_f = p.gains_alpha_f * max(1.0, p.gains_alpha_f_approach, p.gains_alpha_f_retract)
    p.k_r = p.alpha_f * p.gains_alpha_p * p.k_eff
    repeats = max(0.0, 1.0 / p.converters_adc_rate - p.T) if p.converters_adc_rate else 0.0
    p.dead = p.gains_delay * p.T + p.converters_adc_latency + p.converters_dac_latency + repeats
    p.hold = max(0.0, 1.0 / p.master_rate - p.T) if p.master_rate else 0.0
    p.c = 1.0 if p.paper else 1.0 - math.exp(-2.0 * math.pi * p.gains_force_filter * p.T)
    return p


def held(mass: float, damping: float, stiffness: float, time: float) -> tuple[Floats, Floats]:
    """Exact transition of (x, v) and of a held force."""
    a = np.zeros((3, 3))
    a[0, 1] = 1.0
    a[1] = [-stiffness / mass, -damping / mass, 1.0 / mass]
    e = expm(a * time)
    return e[:2, :2], e[:2, 2]


def notch(p: SimpleNamespace) -> tuple[Floats, Floats]:
    """Zeros on the sampled poles of the stage, poles of the wanted damping, gain 1 at rest."""
    if not p.notched:
        return np.array([1.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])
    angle = 2.0 * math.pi * p.stage_resonance * p.T
    bare, wanted = (np.poly(np.exp(angle * np.roots([1.0, 2.0 * zeta, 1.0]))).real
                    for zeta in (0.5 / p.stage_quality, p.zeta))  # fmt: skip
    return bare * wanted.sum() / bare.sum(), wanted


class Part:
    """A second-order system behind a hold and a dead time, in steps of a period."""

    def __init__(self, mass: float, damping: float, stiffness: float, period: float, dead: float):
        self.whole = math.floor(dead / period + 1e-9)
        early = max(0.0, dead / period - self.whole) * period
        self.phi1, self.gamma1 = held(mass, damping, stiffness, early)
        self.phi2, self.gamma2 = held(mass, damping, stiffness, period - early)

    def step(self, state: Floats, queue: list[Any], command: Any) -> tuple[Floats, list[Any], Any]:
        """Its state after a period, the queue of commands, and the command that acted last."""
        queue = [*queue, command]
        state = self.phi1 @ state + self.gamma1 * queue[-2 - self.whole]
        state = self.phi2 @ state + self.gamma2 * queue[-1 - self.whole]
        return state, queue[1:], queue[-1 - self.whole]


ERRORS = 5  # master, stage command, stage reading, probe, gauge
OUTPUTS = 4  # read force, the same behind a hand's low-pass, the stage's command, the pushing hand's echo


class Loop:
    """One period of everything as matrices."""

    def __init__(self, p: SimpleNamespace, k_r: float, K_f: float, hand: tuple[float, float, float] | None,
                 integral: float | None = None):  # fmt: skip
        self.p, self.k_r, self.K_f, self.hand = p, k_r, K_f, hand
        self.integral = p.integral if integral is None else integral
        mass, damping, stiffness = hand or (0.0, 0.0, 0.0)
        self.mass, self.damping, self.stiffness = p.master_mass + mass, p.master_damping + damping, stiffness
        wn = 2.0 * math.pi * p.stage_resonance
        self.master = Part(self.mass, self.damping, self.stiffness, p.T, p.dead + 2.0 * p.hold)
        self.stage = Part(1.0 / wn**2, 1.0 / (wn * p.stage_quality), 1.0, p.T, p.dead)
        self.b, self.a = notch(p)
        self.motors, self.commands = self.master.whole + 1, self.stage.whole + 1
        self.size = 12 + self.motors + self.commands
        rows = [self.period(row[: self.size], row[self.size :]) for row in np.eye(self.size + ERRORS + 1)]
        whole = np.array([np.concatenate(row) for row in rows]).T
        self.A, self.B = whole[: self.size, : self.size], whole[: self.size, self.size :]
        self.C, self.D = whole[self.size :, : self.size], whole[self.size :, self.size :]

    def period(self, state: Floats, errors: Floats) -> tuple[Floats, Floats]:
        p, K_f = self.p, self.K_f
        e_m, e_c, e_y, n, e_g, push = errors
        x, v, xs, vs, w0, w1, correction, smooth, acting, stretch, before, felt = state[:12]
        motor, command = list(state[12 : 12 + self.motors]), list(state[12 + self.motors :])
        mass, damping, stiffness = self.hand or (0.0, 0.0, 0.0)
        if self.hand is None:
            x = v = acting = before = 0.0
        acceleration = (acting - self.damping * v - self.stiffness * x) / self.mass
        gauge = -(mass * acceleration + damping * v + stiffness * x) + e_g
        smooth += p.c * (gauge - smooth)
        read, seen = x + e_m, xs + e_y
        force = self.k_r * xs + n
        force += self.k_r * e_y * 0.0
        spring, drag = p.gains_coupling_stiffness, p.gains_coupling_damping / p.T
        if spring > 0.0:
            stretch = (drag * (stretch + read - before) + force) / (spring + drag)
            target, shown = read - stretch, spring * stretch
        else:
            target, shown = read, force
            stretch = 0.0
        if p.paper:
            into = -p.gains_stage_proportional * (seen - target) - p.gains_stage_derivative * (
                (seen - target) - correction) / p.T  # fmt: skip
            correction = seen - target
        else:
            correction += self.integral * p.T * (target - seen)
            if self.integral == 0.0:
                correction = 0.0
            into = target + correction
        out = self.b[0] * into + w0
        memory = [self.b[1] * into - self.a[1] * out + w1, self.b[2] * into - self.a[2] * out]
        sent = out + e_c
        moved, motor, last = self.master.step(np.array([x, v]), motor, -(1.0 + K_f) * shown + K_f * smooth + push)
        driven, command, _ = self.stage.step(np.array([xs, vs]), command, sent)
        share = min(1.0, (1.0 + K_f) * p.c)
        felt += share * (shown - felt)
        if self.hand is None:
            moved, last, motor, smooth = np.zeros(2), 0.0, [0.0] * self.motors, 0.0
        state = np.array([*moved, *driven, *memory, correction, smooth, last, stretch, read, felt, *motor, *command])
        return state, np.array([shown, felt, sent, (1.0 + K_f) * shown])

    def radius(self) -> float:
        return float(np.max(np.abs(np.linalg.eigvals(self.A))))

    def at(self, theta: float) -> Floats:
        z = complex(math.cos(theta), math.sin(theta))
        return self.C @ np.linalg.solve(z * np.eye(self.size) - self.A, self.B) + self.D


def limit(radius: Any, low: float, high: float, margin: float = 1e-10) -> float:
    """The smallest gain at which an eigenvalue leaves the circle."""
    last = low
    for gain in np.geomspace(low, high, 400):
        if radius(gain) > 1.0 + margin:
            for _ in range(60):
                middle = math.sqrt(last * gain)
                last, gain = (last, middle) if radius(middle) > 1.0 + margin else (middle, gain)
            return gain
        last = gain
    return math.inf


def frequency(matrix: Floats, period: float) -> float:
    """At which it oscillates whose largest root lies on the circle [Hz]."""
    roots = np.linalg.eigvals(matrix)
    return abs(float(np.angle(roots[np.argmax(np.abs(roots))]))) / (2.0 * math.pi * period)


def margins(p: SimpleNamespace, limits: bool = True) -> dict[str, float]:
    """All of nt_margins; without the exact limits what is a sum."""
    hand = (p.hand_mass, p.hand_damping, p.hand_stiffness)
    softens = 1.0 / (1.0 + p.k_r / p.gains_coupling_stiffness) if p.gains_coupling_stiffness else 1.0
    k_r = p.k_r * softens
    b, a = notch(p)
    wn = 2.0 * math.pi * p.stage_resonance
    delay = (b @ [0, 1, 2] / b.sum() - a @ [0, 1, 2] / a.sum()) * p.T + 1.0 / (wn * p.stage_quality)
    lag = delay / (4.0 * p.zeta**2 * (1.0 - p.zeta**2)) if 2.0 * p.zeta**2 < 1.0 else delay
    hop = 0.5 * p.T + p.dead
    D = 2.0 * hop + lag + 2.0 * p.hold
    found = {"loop_stiffness": (1.0 + p.K_f) * k_r, "loop_delay": D}
    found["stability_limit"] = p.master_damping / (D * (1.0 + p.integral * (D - hop)))
    found["margin"] = found["stability_limit"] / found["loop_stiffness"]
    d = (p.dead + p.hold) / p.T
    found["pad_limit"] = (p.master_mass / (p.hand_damping * p.T) * 2.0 * math.sin(math.pi / (4.0 * d + 2.0))
                          if p.hand_damping else math.inf)  # fmt: skip
    found["mass_limit"] = 1.0 + p.master_mass / p.hand_mass if p.hand_mass else math.inf
    step = max(p.stage_command_resolution, p.gains_alpha_p * p.master_resolution)
    found["quantisation_step"] = (1.0 + p.K_f) * k_r * step / p.gains_alpha_p
    c = 1.0 - math.exp(-2.0 * math.pi * p.gains_force_filter * p.T)
    gauge = math.sqrt(c / (2.0 - c) * (p.master_gauge_noise**2 + p.master_gauge_resolution**2 / 12.0))
    sigma = p.probe_spring_constant * p.probe_sensitivity * p.probe_noise / 6.0
    found["force_noise"] = math.sqrt(((1.0 + p.K_f) * p.alpha_f * sigma) ** 2 + (p.K_f * gauge) ** 2)
    servo = p.gains_height_gain * k_r / (p.alpha_f * p.gains_alpha_p * p.probe_spring_constant) * (hop + lag)
    found["height_margin"] = min(1.0 / servo, p.master_damping / ((hop + 2.0 * p.hold) * p.gains_height_stiffness))
    if not limits:
        return found
    hands = [hand, (0.0, 0.0, 0.0), (RELEASED, 0.0, 0.0)] if p.gains_coupling_stiffness else [hand]
    kappa = [limit(lambda g, h=h: Loop(p, g, p.K_f, h).radius(), 1e-3 * p.k_r, 1e6 * p.k_r) for h in hands]
    found["exact_limit"] = (1.0 + p.K_f) * min(kappa) * softens
    worst = hands[int(np.argmin(kappa))]
    found["exact_frequency"] = (
        frequency(Loop(p, min(kappa), p.K_f, worst).A, p.T) if min(kappa) < math.inf else math.nan
    )
    gains = [limit(lambda g, k=k, h=h: Loop(p, k, g, h).radius(), 1e-3, 1e4, 1e-9)
             for h in hands for k in (0.0, p.k_r)]  # fmt: skip
    found["force_gain_limit"] = min(gains)
    if p.paper:
        found["integral_limit"] = math.nan
    else:
        found["integral_limit"] = limit(lambda g: Loop(p, 0.0, 0.0, None, g).radius(), 1e-1, 1e5)
    alone = limit(lambda g: Loop(p, g, 0.0, None).radius(), 1e-3 * p.k_r, 1e4 * p.k_r) if p.gains_coupling_stiffness \
        else math.inf  # fmt: skip
    found["coupling_margin"] = alone / p.k_r
    return found


def calm(p: SimpleNamespace, found: dict[str, float]) -> dict[str, float]:
    """All of nt_calm."""
    loop = Loop(p, p.k_r, p.K_f, (p.hand_mass, p.hand_damping, p.hand_stiffness))
    unit = [
        1.0,
        1.0 / p.gains_alpha_p,
        1.0 / p.gains_alpha_p,
        p.alpha_f * p.probe_spring_constant * p.probe_sensitivity,
        1.0,
    ]
    thetas = np.concatenate([np.geomspace(1e-5, 1e-2, 3000, endpoint=False), np.linspace(1e-2, math.pi, 12001)])
    table = np.array([loop.at(theta) for theta in thetas])
    gains = np.abs(table[:, 1, :ERRORS]) * unit
    # the reading of the stage stirs the force through the command alone
    squares = np.trapezoid(gains**2, thetas, axis=0) / math.pi
    highest = gains.max(axis=0)
    back = np.abs(1.0 / table[:, 2, 1] - 1.0)[np.argmax(gains[:, 1])]
    meter, volt = p.alpha_f * p.k_eff, unit[3]
    thrown = p.gains_alpha_p * p.master_resolution
    steps = [p.master_resolution, p.stage_command_resolution, p.stage_resolution, p.probe_resolution, 0.0]
    noise = [
        0.0,
        0.0,
        p.stage_noise,
        p.probe_noise / 6.0,
        math.hypot(p.master_gauge_noise, p.master_gauge_resolution / math.sqrt(12.0)) if p.K_f > 0.0 else 0.0,
    ]
    least = [meter * p.gains_alpha_p, meter, 0.5 * meter, volt, 0.0]
    rings = [1, back >= 0.05 or thrown < 4.0 * p.stage_command_resolution, 1, 0, 0]
    parts, sum_of_steps, sum_of_noises = [], 0.0, 0.0
    for i in range(ERRORS):
        white = 6.0 * math.sqrt(squares[i])
        step = max(2.0 * white / math.sqrt(12.0), least[i], highest[i] if rings[i] else 0.0) * steps[i]
        parts.append(math.hypot(step, white * noise[i]))
        sum_of_steps += step
        sum_of_noises = math.hypot(sum_of_noises, white * noise[i])
    ripple = math.hypot(sum_of_steps, sum_of_noises)
    ringing = float(np.abs(table[:, 3, 5]).max())
    felt = min(0.3, 0.25 * p.gains_alpha_f * p.limits_force)
    slew = max(0.0, p.gains_alpha_p * p.master_resolution / p.limits_stage_speed - p.T)
    slewing = found["margin"] * found["loop_delay"] / (found["loop_delay"] + slew)
    least_of = [felt / ripple, 1.75 / ringing, slewing / (1.5 if slew > 0.0 else 1.0)]
    return {"ripple": ripple, **{f"parts[{i}]": part for i, part in enumerate(parts)}, "felt": felt,
            "ringing": ringing, "slewing": slewing, "least": min(least_of)}  # fmt: skip


KINDS = ("plain", "latency", "slow", "coupled", "coupled latency", "fraction impedance", "free", "paper", "sparse",
         "free slow fraction", "plain", "coupled")  # fmt: skip


CASTS = {"rig.master.gauge": "(int)", "settings.control.choice": "(nt_control_choice)"}


def number(value: float) -> str:
    """In C; what cannot be asked is NAN."""
    if math.isnan(value):
        return "NAN"
    return "HUGE_VAL" if math.isinf(value) else repr(float(value))


def main() -> None:
    print("/* SPDX-License-Identifier: BSD-3-Clause")
    print(" * Generated by loop_oracle.py: random rigs, their margins and how calm they are. Do not edit. */")
    print('#include <math.h>\n\n#include "nanotouch/settings.h"\n')
    print("static void set_loop(const double *value, nt_rig *rig, nt_settings *settings)\n{")
    for i, name in enumerate(NAMES[:-1]):
        print(f"    {name.replace('.', '->', 1)} = {CASTS.get(name, '')}value[{i}];")
    print("}\n")
    rows = []
    for seed, kind in enumerate(KINDS, 1):
        f = drawn(seed, kind)
        p = effective(f)
        found = margins(p)
        rows.append((kind, f, found, calm(p, found)))
    names = [list(row.keys()) for row in rows[0][2:]]
    print("typedef struct loop_case {\n    const char *kind;")
    print(f"    double in[{len(NAMES)}]; /* the last is the contact stiffness */")
    print("".join(f"    double {name};\n" for name in names[0]) + "    struct {")
    print("".join(f"        double {name};\n" for name in names[1] if "[" not in name) + "        double parts[5];")
    print("    } calm;\n} loop_case;\n\nstatic const loop_case loop_cases[] = {")
    for kind, f, found, quiet in rows:
        print(f'    {{.kind = "{kind}",\n     .in = {{' + ", ".join(number(f[name]) for name in NAMES) + "},")
        print("".join(f"     .{name} = {number(value)},\n" for name, value in found.items()) + "     .calm = {")
        print("".join(f"         .{name} = {number(value)},\n" for name, value in quiet.items()) + "     }},")
    print("};")


if __name__ == "__main__":
    main()
