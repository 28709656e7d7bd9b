# SPDX-License-Identifier: BSD-3-Clause
"""Viscoelastic contact against closed forms and brute-force quadrature, none of which is our own output."""

from __future__ import annotations

import itertools
import pickle

import mpmath
import nanotouch as nt
import numpy as np
import pytest
from nanotouch import Rheology
from nanotouch.contact.geometry import Shape
from nanotouch.errors import InvalidValue
from scipy.special import beta as beta_function
from scipy.special import betainc
from ting_oracle import force

PARABOLOID = Shape("paraboloid", radius=5e-6)
E1, SPEED, DEPTH, NU = 2e3, 1e-6, 1e-6, 0.5
FACTOR = 1.0 / (1.0 - NU**2)


def triangle(points: int, ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """Down at SPEED and back `ratio` times as fast."""
    top = DEPTH / SPEED
    time = np.arange(points + int(points / ratio) + 1) * top / points
    return time, np.where(time <= top, SPEED * time, DEPTH - ratio * SPEED * (time - top))


def closed_form(time: np.ndarray, exponent: float, ratio: float, power: float, scale: float) -> np.ndarray:
    """g = scale delta^power on a power law, Lee and Radok, then Ting (Efremov et al. 2017)."""
    top = DEPTH / SPEED
    whole = scale * FACTOR * E1 * power * SPEED**power * beta_function(power, 1 - exponent)
    last = np.clip(time - (1 + ratio) ** (1 / (1 - exponent)) * (time - top), 0.0, None)
    back = betainc(power, 1 - exponent, np.divide(last, time, where=time > 0, out=np.zeros_like(time)))
    return whole * time ** (power - exponent) * np.where(time <= top, 1.0, back)


# The bound is 1e-6 of F_max, with derivatives or without.
@pytest.mark.parametrize("exponent", [0.0, 0.05, 0.2, 0.35, 0.5])
@pytest.mark.parametrize(("points", "ratio"), [(250, 1.0), (1000, 0.5), (1000, 3.0)])
def test_triangle_on_a_power_law(exponent: float, points: int, ratio: float) -> None:
    time, position = triangle(points, ratio)
    shapes = {
        "paraboloid": (PARABOLOID, 1.5, 4 / 3 * np.sqrt(5e-6)),
        "cone": (Shape("cone", half_angle=0.6), 2.0, 2 / np.pi * np.tan(0.6)),
    }
    for shape, power, scale in shapes.values():
        found = Rheology.power_law(E1, exponent).force(time, position, shape)
        true = closed_form(time, exponent, ratio, power, scale)
        assert np.abs(found.force - true).max() < 1e-6 * true.max()
        assert found.arms <= 22
        np.testing.assert_array_equal(found.indentation, position)


def test_beyond_the_bound_a_steep_power_law_is_said_to_be_worse() -> None:
    time, position = triangle(1000, 1.0)
    true = closed_form(time, 0.8, 1.0, 1.5, 4 / 3 * np.sqrt(5e-6))
    found = Rheology.power_law(E1, 0.8).force(time, position, PARABOLOID)
    assert np.abs(found.force - true).max() < 3e-5 * true.max()  # docs/rheology.md says so


def test_punch_superposes() -> None:
    """2 a Int E d(delta), down and up, until the force is 0."""
    time, position = triangle(500, 1.0)
    since = np.clip(time - 1.0, 0.0, None)
    true = 2e-6 * FACTOR * E1 * SPEED * (time**0.7 - 2 * since**0.7) / 0.7
    found = Rheology.power_law(E1, 0.3).force(time, position, Shape("punch", radius=1e-6)).force
    ends = int(np.argmax(true < 0.0))
    # the first step, where E is infinite, is what is left: its last arm keeps the integral only
    assert np.abs(found[2:ends] - true[2:ends]).max() < 1e-5 * true.max()
    assert (found[ends:] == 0.0).all()


SOLID = Rheology.standard_linear_solid(800.0, 1500.0, 0.3)
SERIES = Rheology.prony(500.0, [900.0, 600.0, 400.0], [0.02, 0.3, 2.0])


def held(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Down, a pause, back at twice the speed: straight pieces, so that the oracle's history is ours."""
    time = np.linspace(0.0, 2.0, points + 1)
    return time, np.interp(time, [0.0, 1.0, 1.5, 2.0], [0.0, 1e-6, 1e-6, 0.0])


def sphere_slope(depth: np.ndarray) -> np.ndarray:
    """2 a of Sneddon's sphere, by bisection of his delta(a)."""
    R, low, high = 5e-6, np.zeros_like(depth), np.full_like(depth, 5e-6 * (1 - 1e-12))
    for _ in range(60):
        a = 0.5 * (low + high)
        deeper = a / 2 * np.log((R + a) / (R - a)) > depth
        low, high = np.where(deeper, low, a), np.where(deeper, a, high)
    return low + high


@pytest.mark.parametrize("rheology", [SOLID, SERIES, Rheology.power_law(E1, 0.3)], ids=["solid", "prony", "power_law"])
@pytest.mark.parametrize("shape", ["paraboloid", "sphere"])
def test_held_history_against_quadrature(rheology: Rheology, shape: str) -> None:
    time, depth = held(800)
    found = rheology.force(time, depth, Shape(shape, radius=5e-6)).force
    corners = np.array([0.0, 1.0, 1.5, 2.0]), np.array([0.0, 1e-6, 1e-6, 0.0])
    slope = sphere_slope if shape == "sphere" else lambda d: 2 * np.sqrt(5e-6 * d)
    exponent = 0.3 if rheology.kind == "power_law" else 0.0
    for index in (3, 200, 400, 500, 600, 610, 660, 720, 790):
        t = time[index]
        to = np.concatenate([corners[0][corners[0] < t], [t]])
        true = force(rheology.relaxation, exponent, slope, to, np.interp(to, *corners), len(to) - 1) * FACTOR
        assert abs(found[index] - true) < 1e-6 * found.max()


@pytest.mark.parametrize("rheology", [SERIES, Rheology.power_law(E1, 0.4)], ids=["prony", "power_law"])
def test_bending_lever_is_solved_for(rheology: Rheology) -> None:
    """The balance holds to the last digits, and the force is that of the indentation found."""
    k = 0.02
    time, position = triangle(300, 1.0)
    found = rheology.force(time, position - 3e-8, PARABOLOID, spring_constant=k)
    touched = found.indentation > 0.0
    balance = found.indentation + found.force / k - (position - 3e-8)
    assert np.abs(balance[touched]).max() < 1e-18  # of 1e-6 m
    start = 3e-8 / SPEED
    exponent = 0.4 if rheology.kind == "power_law" else 0.0
    for index in (60, 300, 340):
        t = np.concatenate([[0.0], time[10 : index + 1] - start])
        d = np.concatenate([[0.0], found.indentation[10 : index + 1]])
        true = force(rheology.relaxation, exponent, lambda x: 2 * np.sqrt(5e-6 * x), t, d, len(t) - 1) * FACTOR
        # straight between points is ours, but for the first piece, which we make in 14
        assert abs(found.force[index] - true) < 2e-6 * found.force.max()


def test_layer_agrees_with_garcia() -> None:
    """Garcia and Garcia (2018), five terms: within 2 % up to a = 0.8 h (elastic: exponent 0)."""
    h, depth = 3e-6, np.linspace(0.0, 5e-7, 50)
    found = Rheology.power_law(E1, 0.0).force(depth / SPEED, depth, PARABOLOID, thickness=h).force
    q = np.sqrt(5e-6 * depth) / h
    series = 1 + 1.133 * q + 1.497 * q**2 + 1.469 * q**3 + 0.755 * q**4
    np.testing.assert_allclose(found[1:], (16 / 9 * E1 * np.sqrt(5e-6) * depth**1.5 * series)[1:], rtol=0.02)
    half_space = Rheology.power_law(E1, 0.0).force(depth / SPEED, depth, PARABOLOID).force
    assert found[-1] > 1.7 * half_space[-1]


def test_layer_relaxes_as_its_half_space() -> None:
    """With a step far faster than the relaxation F(t)/F(0) = E(t)/E(0), whatever the law of indentation."""
    time = np.concatenate([[0.0, 1e-6], np.linspace(0.01, 1.0, 40)])
    position = np.where(time > 0, 5e-7, 0.0)
    for thickness in (0.0, 2e-6):
        found = SERIES.force(time, position, PARABOLOID, thickness=thickness).force
        np.testing.assert_allclose(
            found[1:] / found[1], SERIES.relaxation(time[1:]) / SERIES.relaxation(0.0), rtol=1e-4
        )


@pytest.mark.parametrize("rheology", [SERIES, Rheology.power_law(E1, 0.25)], ids=["prony", "power_law"])
@pytest.mark.parametrize("spring_constant", [0.0, 0.05])
def test_derivatives(rheology: Rheology, spring_constant: float) -> None:
    """Against differences of the force; by `contact` from the fourth point on, before which the grid moves with it."""
    time, position = triangle(200, 1.0)
    options = {"spring_constant": spring_constant}
    found = rheology.force(time, position - 1e-9, PARABOLOID, derivatives=True, **options)
    assert found.derivatives is not None
    assert found.derivatives.shape == (len(time), 1 + len(rheology.parameters))
    step = 1e-12
    ends = [rheology.force(time, position - 1e-9, PARABOLOID, contact=sign * step, **options).force for sign in (1, -1)]
    scale = np.abs(found.derivatives).max(axis=0)
    assert np.abs((ends[0] - ends[1])[4:] / (2 * step) - found.derivatives[4:, 0]).max() < 1e-4 * scale[0]
    for column, name in enumerate(rheology.parameters, 1):
        field, _, index = name.partition("[")
        value = getattr(rheology, field)
        ends = []
        for sign in (1, -1):
            if index:
                changed = list(value)
                changed[int(index[:-1])] *= 1 + sign * 1e-5
            else:
                changed = value * (1 + sign * 1e-5)
            other = Rheology(**{**_fields(rheology), field: changed})
            ends.append(other.force(time, position - 1e-9, PARABOLOID, **options).force)
        width = 2e-5 * (value[int(index[:-1])] if index else value)
        assert np.abs((ends[0] - ends[1]) / width - found.derivatives[:, column]).max() < 1e-5 * scale[column], name


def _fields(rheology: Rheology) -> dict[str, object]:
    return {name: getattr(rheology, name) for name in rheology.__dataclass_fields__}


def test_points_in_between_change_nothing() -> None:
    """A straight piece is what it is, cut or not; spacing that is not even is no case of its own."""
    time, position = triangle(400, 1.0)
    keep = np.sort(np.random.default_rng(1).choice(len(time), 300, replace=False))
    keep = np.union1d(keep, [0, 400, len(time) - 1])
    for rheology in (SERIES, Rheology.power_law(E1, 0.3)):
        fine = rheology.force(time, position, PARABOLOID).force
        coarse = rheology.force(time[keep], position[keep], PARABOLOID).force
        assert np.abs(fine[keep] - coarse).max() < 2e-6 * fine.max()


def test_kernels_against_mpmath() -> None:
    """J by a numerical inversion of 1/(s^2 E(s)); the integral by quadrature."""
    mpmath.mp.dps = 16
    for rheology in (SERIES, SOLID, Rheology.prony(0.0, [700.0, 300.0], [0.1, 2.0]), Rheology.power_law(E1, 0.3)):
        if rheology.kind == "power_law":
            image = lambda s: E1 * mpmath.gamma(0.7) * s**-0.7  # noqa: E731
        else:
            arms = list(zip(rheology.arm_moduli, rheology.relaxation_times, strict=True))
            image = lambda s: rheology.equilibrium_modulus / s + sum(m / (s + 1 / t) for m, t in arms)  # noqa: B023, E731
        for t in (0.7,):
            creep = mpmath.invertlaplace(lambda s: 1 / (s**2 * image(s)), t, method="talbot")  # noqa: B023
            assert rheology.creep(t) == pytest.approx(float(creep), rel=1e-10)
            area = mpmath.quad(lambda x: rheology.relaxation(float(x)), [0, t / 1e6, t / 1e3, t / 10, t])  # noqa: B023
            assert rheology.relaxation_integral(t) == pytest.approx(
                float(area), rel=1e-4 if rheology.kind == "power_law" else 1e-9
            )


@pytest.mark.parametrize("error", [1e-3, 1e-5, 1e-7])
def test_spectrum_keeps_its_demand(error: float) -> None:
    """Between the samples at which the error was measured, too; no arm is negative."""
    arms = []
    for exponent in (0.02, 0.3, 0.6, 0.85):
        rheology = Rheology.power_law(E1, exponent)
        spectrum = rheology.discretize(1e-3, 10.0, error)
        time = np.geomspace(1e-3, 10.0, 997)
        sums = spectrum.equilibrium_modulus + np.exp(-np.outer(time, spectrum.rates)) @ spectrum.moduli
        assert np.abs(sums / rheology.relaxation(time) - 1).max() < min(error, 2 * spectrum.error)
        assert spectrum.moduli.min() >= 0.0
        assert spectrum.equilibrium_modulus >= 0.0
        arms.append(len(spectrum.rates))
    assert max(arms) == min(arms) <= {1e-3: 18, 1e-5: 23, 1e-7: 30}[error]


def test_toml(tmp_path: object) -> None:
    path = f"{tmp_path}/scene.toml"
    with open(path, "w") as file:
        file.write(
            '[sample]\nyoungs_modulus_kPa = 1\n[rheology]\nkind = "prony"\nequilibrium_modulus_kPa = 0.5\n'
            "arm_moduli_Pa = [900, 600]\nrelaxation_times_ms = [20, 300]\n"
        )
    assert Rheology.from_toml(path) == Rheology.prony(500.0, [900.0, 600.0], [0.02, 0.3])
    assert nt.Scene.from_toml(path) == nt.Scene(
        sample={"youngs_modulus": 1e3}, rheology=Rheology.prony(500.0, [900.0, 600.0], [0.02, 0.3])
    )
    table = {"kind": "power_law", "modulus_kPa": 2, "exponent": 0.2}
    assert Rheology.from_table(table) == Rheology.power_law(2e3, 0.2)
    for wrong, words in (
        ({"kind": "maxwell"}, "valid are power_law"),
        ({"kind": "power_law", "modulus": 2, "exponent": 0.2}, "modulus_kPa"),
        ({"kind": "power_law", "modulus_kPa": 2}, "lacks exponent"),
        ({"kind": "power_law", "modulus_kPa": 2, "exponent": 0.9}, "0.85"),
        ({**table, "arm_moduli_kPa": [1]}, "no key arm_moduli_kPa"),
        ({**table, "modulus_Pa": 3}, "twice"),
    ):
        with pytest.raises(InvalidValue, match=words):
            Rheology.from_table(wrong)


def test_refusals() -> None:
    time, position = triangle(20, 1.0)
    law = Rheology.power_law(E1, 0.2)
    for change, words in (
        ({"time": time[::-1].copy()}, r"time\[1\] = .* s: it must be above time\[0\]"),
        ({"position": position + 1e-7}, r"positions\[0\]"),
        ({"position": np.where(time == 1.0, np.nan, position)}, "positions"),
        ({"shape": Shape("blunted", radius=1e-7, half_angle=0.3)}, "kind"),
        ({"thickness": 1e-6, "poisson_ratio": 0.4}, "poisson_ratio"),
        ({"thickness": 1e-7}, "indentation"),
        ({"shape": Shape("sphere", radius=5e-7)}, "indentation"),
    ):
        with pytest.raises(InvalidValue, match=words):
            law.force(**{"time": time, "position": position, "shape": PARABOLOID, **change})
    with pytest.raises(InvalidValue, match="1 of each"):
        Rheology("standard_linear_solid")


def springs_by_midpoints(time: np.ndarray, depth: np.ndarray, fine: int) -> np.ndarray:
    """The paraboloid's force on SERIES by 1500 springs and `fine` midpoint steps a point: another integrator."""
    x = (np.arange(1500) + 0.5) / 1500 * np.sqrt(5e-6 * depth.max())
    D, width = x**2 / 5e-6, np.sqrt(5e-6 * depth.max()) / 1500
    u, z = np.zeros_like(x), np.zeros((3, len(x)))
    E, tau = np.array(SERIES.arm_moduli), np.array(SERIES.relaxation_times)
    force = [0.0]
    h = (time[1] - time[0]) / fine
    whole, half = np.exp(-h / tau), np.exp(-h / (2 * tau))
    A = 500.0 + E @ half
    for first, last in itertools.pairwise(depth):
        for part in range(1, fine + 1):
            z *= whole[:, None]
            held = 500.0 * u + E @ z
            way = np.maximum(first + (last - first) * part / fine - D - u, -held / A)
            u += way
            z += half[:, None] * way
        force.append(float(np.maximum(500.0 * u + E @ z, 0.0).sum() * 2 * width * FACTOR))
    return np.array(force)


def test_contact_that_grows_again() -> None:
    """Into the dent that it left, before that is gone; then back to the first force, once it is."""
    time = np.linspace(0.0, 3.0, 601)
    depth = np.interp(
        time, [0.0, 0.5, 0.9, 1.5, 2.0, 2.1, 2.5, 3.0], np.array([0, 1, 0.3, 0.8, 0.1, -0.5, 0.6, 0]) * 1e-6
    )
    found = SERIES.force(time, depth, PARABOLOID)
    assert found.by_springs
    reference = springs_by_midpoints(time, depth, 8)
    assert np.abs(found.force - reference).max() < 3e-4 * reference.max()  # 128 springs: some 1e-4
    twice = np.interp(time * 30, [0.0, 4.5, 9.0, 81.0, 85.5, 90.0], np.array([-1, 1, -1, -1, 1, -1]) * 1e-6)
    cycle = SERIES.force(time * 30, twice, PARABOLOID, spring_constant=0.05).force  # 35 of the slowest arm between
    peaks = cycle[[30, 570]]
    assert abs(peaks[1] / peaks[0] - 1) < 1e-3


def test_elastic_contact_grows_again() -> None:
    """Exponent 0 is Hertz on any way, to what 128 springs resolve."""
    rng = np.random.default_rng(2)
    depth = np.concatenate([[0.0], rng.uniform(-2e-7, 1e-6, 200)])
    found = Rheology.power_law(E1, 0.0).force(np.arange(201) * 0.01, depth, PARABOLOID)
    hertz = 4 / 3 * np.sqrt(5e-6) * np.clip(depth, 0, None) ** 1.5 * E1 * FACTOR
    assert found.by_springs
    assert np.abs(found.force - hertz).max() < 1e-4 * hertz.max()


def test_noise_in_a_pause() -> None:
    """A base that jitters by 0.1 nm in a pause changes the force by no more than its stiffness times that."""
    time, depth = held(800)
    jitter = np.random.default_rng(3).normal(size=801) * 1e-10 * ((time > 1.0) & (time < 1.5))
    options = {"spring_constant": 0.05, "derivatives": True}
    still, shaken = (SERIES.force(time, depth + part, PARABOLOID, **options) for part in (0.0, jitter))
    assert shaken.by_springs
    assert not still.by_springs
    assert np.abs(still.force - shaken.force).max() < 4e-10 * 0.05 + 1e-4 * still.force.max()
    assert still.derivatives is not None
    assert shaken.derivatives is not None
    scale = np.abs(still.derivatives).max(axis=0)
    difference = np.abs(still.derivatives - shaken.derivatives) / scale
    assert np.sqrt((difference**2).mean(axis=0)).max() < 5e-3  # by `contact` the springs' steps show


def test_any_history_has_an_answer() -> None:
    """Levers far softer than the sample, steep laws, punches: in balance, never below 0, derivatives finite."""
    rng = np.random.default_rng(4)
    for draw in range(600):
        laws = (
            Rheology.power_law(
                10 ** rng.uniform(1, 7), rng.choice([0.0, rng.uniform(0, 0.85)]), 10 ** rng.uniform(-3, 3)
            ),
            Rheology.standard_linear_solid(10 ** rng.uniform(1, 6), 10 ** rng.uniform(1, 6), 10 ** rng.uniform(-6, 4)),
            Rheology.prony(0.0, 10 ** rng.uniform(1, 6, 3), 10 ** rng.uniform(-6, 4, 3)),
        )
        kind = ("paraboloid", "cone", "punch")[rng.integers(3)]
        shape = Shape(kind, radius=10 ** rng.uniform(-7, -5), half_angle=rng.uniform(0.1, 1.4))
        time = np.cumsum(10 ** rng.uniform(-1, 1, 60)) * 10 ** rng.uniform(-5, 0)
        away = (1 - np.abs(np.linspace(-1, 1, 60)), rng.normal(size=60).cumsum(), np.sin(np.linspace(0, 9, 60)))[
            draw % 3
        ]
        position = 10 ** rng.uniform(-9, -6) * (away - away[0])
        k = 10 ** rng.uniform(-3, 2) if draw % 4 else 0.0
        found = laws[rng.integers(3)].force(time, position, shape, spring_constant=k, derivatives=True)
        assert (found.force >= 0.0).all()
        assert np.isfinite(found.force).all()
        assert found.derivatives is not None
        assert np.isfinite(found.derivatives).all()
        balance = found.indentation + (found.force / k if k else 0.0) - position
        assert np.abs(balance).max() <= 1e-9 * np.abs(position).max()


def test_package_knows_it() -> None:
    assert pickle.loads(pickle.dumps(SERIES)) == SERIES
    assert nt.Rheology is nt.rheology.Rheology
