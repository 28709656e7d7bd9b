# SPDX-License-Identifier: BSD-3-Clause
"""A pushed particle beside closed forms in many digits (mpmath), and its account of energy beside its forces."""

from __future__ import annotations

import math

import mpmath
import nanotouch as nt
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planar_push_oracle import Flat, Joint

E, G, W = 3.63e9, 0.85e9, 0.06
SMOOTH = nt.ParticleContact(E, G)


def particle(radius: float, strength: float, distance: float, **of: float) -> nt.Particle:
    contact = nt.ParticleContact(E, G, W, shear_strength=strength, rolling_distance=distance)
    return nt.Particle(radius, contact, SMOOTH, tip_half_angle=0.0, **of)


def jkr_radius(radius: float, load: float) -> mpmath.mpf:
    """Johnson 1985, Eq. 5.47."""
    with mpmath.workdps(30):
        pull = 3 * mpmath.pi * W * radius
        return mpmath.cbrt(3 * radius / (4 * mpmath.mpf(E)) * (load + pull + mpmath.sqrt(2 * pull * load + pull**2)))


@pytest.mark.parametrize(("radius", "distance"), [(5e-6, 42e-9), (10e-6, 84e-9), (15e-6, 128e-9)])
@pytest.mark.parametrize("strength", [9e6, 15e6])
def test_lateral_trace_rises_and_stays_as_published_numbers_say(
    radius: float, distance: float, strength: float
) -> None:
    """A tip with an upright flank pushes level: a spring of M/(xi R) up to M/R, M = 4 F_c xi; rolling from there."""
    sphere = particle(radius, strength, distance, step=1e-9)
    start = -radius - sphere.tip_radius - 1e-9
    path = sphere.run(start + np.linspace(0.0, 3 * distance, 400), 0.0, 0.5 * radius)
    a0, pull_off = jkr_radius(radius, 0.0), 1.5 * mpmath.pi * W * radius
    assert sphere.rest_radius("substrate") == pytest.approx(float(a0), rel=1e-12)
    assert sphere.pull_off("substrate") == pytest.approx(float(pull_off), rel=1e-14)
    force, x = -path.force[:, 0], path.position[:, 0]
    assert force[-1] == pytest.approx(float(4 * pull_off * distance / radius), rel=1e-9)  # the solver's 1e-11
    rising = (x > 0.1 * distance) & (x < 0.9 * distance)
    slip = 1 / (8 * float(a0) * G)
    stiffness = 1 / (radius**2 / float(4 * pull_off * radius) + slip)  # rolling and sliding in series
    np.testing.assert_allclose(
        force[rising] / x[rising], stiffness, rtol=1e-8
    )  # of R, known to 1e-16, over x and by its balance
    assert path.happened("roll")[-1]
    assert not path.happened("slide").any()


def test_slides_where_its_area_gives_way_first() -> None:
    sphere = particle(5e-6, 1e5, 42e-9)
    path = sphere.run([-5.2e-6, -5e-6], 0.0, 2e-6)
    assert -path.force[-1, 0] == pytest.approx(float(1e5 * mpmath.pi * jkr_radius(5e-6, 0.0) ** 2), rel=1e-9)
    assert path.happened("slide")[-1]
    assert not path.happened("roll").any()


def test_it_rolls_or_slides_as_two_forces_say() -> None:
    """Pushed at the height of its middle a sphere without load rolls at 6 pi w xi or slides at tau pi a0^2, whichever
    is less, a0^3 = 9 pi w R^2/(2 E*): the published points, and random ones from 3 % beside the border of the map."""

    def area_of(radius: float, work: float) -> float:
        return float((4.5 * math.pi * work * radius**2 / E) ** (2.0 / 3.0))

    rng = np.random.default_rng(3)
    published = ((5e-6, 42e-9), (10e-6, 84e-9), (15e-6, 128e-9))
    points = [(radius, W, strength, distance) for radius, distance in published for strength in (9e6, 12e6, 15e6)]
    for share in (0.5, 0.9, 0.97, 1.03, 1.1, 2.0):
        radius, work, strength = 10.0 ** rng.uniform(-6.5, -4.8), rng.uniform(0.02, 0.15), rng.uniform(9e6, 15e6)
        points.append((radius, work, strength, share * strength * area_of(radius, work) / (6.0 * work)))
    smooth = nt.ParticleContact(E, G, work_of_adhesion=0.0, shear_strength=0.0, rolling_distance=1e-15)
    for radius, work, strength, distance in points:
        glass = nt.ParticleContact(E, G, work, shear_strength=strength, rolling_distance=distance)
        pushed = nt.Particle(radius, glass, smooth, tip_radius=0.2 * radius, tip_half_angle=1e-3)
        start = -1.201 * radius - 20e-9
        path = pushed.run(np.linspace(start, start + 6.0 * distance + 0.02 * radius, 80), 0.0, 0.8 * radius)
        rolls, slides = 6.0 * math.pi * work * distance, strength * math.pi * area_of(radius, work)
        assert path.happened("roll")[-1].any() == (rolls < slides)
        assert path.happened("slide")[-1].any() == (slides < rolls)
        assert abs(path.force[-1, 0]) == pytest.approx(min(rolls, slides), rel=1e-3)


def test_limits_and_stiffnesses_are_those_of_the_books() -> None:
    sphere, a = particle(5e-6, 12e6, 42e-9), 150e-9
    torsion = 1 / (1 / G - 2 / E)
    ratio = a / sphere.rest_radius("substrate")
    assert sphere.limit("substrate", "slide", a) == pytest.approx(12e6 * np.pi * a**2, rel=1e-14)
    assert sphere.limit("substrate", "spin", a) == pytest.approx(2 / 3 * np.pi * 12e6 * a**3, rel=1e-14)
    torque = 4 * sphere.pull_off("substrate") * ratio**1.5
    assert sphere.limit("substrate", "roll", a) == pytest.approx(torque * 42e-9, rel=1e-14)
    assert sphere.stiffness("substrate", "roll", a) == pytest.approx(torque * 5e-6, rel=1e-14)
    assert sphere.stiffness("substrate", "slide", a) == pytest.approx(8 * a * G, rel=1e-14)
    assert sphere.stiffness("substrate", "spin", a) == pytest.approx(16 / 3 * torsion * a**3, rel=1e-14)


@settings(max_examples=25, deadline=None)
@given(
    offset=st.floats(-0.9, 0.9),
    strength=st.floats(5.0, 9.0),
    distance=st.floats(-10.0, -6.5),
    rubbing=st.floats(5.0, 8.0),
    adhesion=st.floats(0.0, 0.1),
)
def test_work_is_the_force_along_the_way(
    offset: float, strength: float, distance: float, rubbing: float, adhesion: float
) -> None:
    """The trapezoid of the force on the tip, 1 nm steps: each event may cost half of a step's force."""
    substrate = nt.ParticleContact(E, G, W, shear_strength=10**strength, rolling_distance=10**distance)
    tip = nt.ParticleContact(E, G, adhesion, shear_strength=10**rubbing, rolling_distance=1e-9)
    sphere = nt.Particle(1e-6, substrate, tip, step=1e-9)
    x = np.linspace(-1.3e-6, -0.6e-6, 701)
    path = sphere.run(x, offset * 1e-6, 0.4e-6)
    done = -np.sum(0.5 * (path.force[1:, 0] + path.force[:-1, 0]) * np.diff(x))
    jump = 1e-9 * np.abs(np.diff(path.force[:, 0])).sum()
    assert abs(path.work[-1] - done) <= jump + 1e-20
    assert np.all(np.diff(path.dissipated) >= 0.0)
    np.testing.assert_allclose(path.stored + path.dissipated, path.work, rtol=0, atol=1e-12 * path.work.max() + 1e-24)


def test_goes_on_from_a_state() -> None:
    sphere, x = particle(1e-6, 12e6, 10e-9), np.linspace(-1.2e-6, -0.9e-6, 31)
    whole = sphere.run(x, 0.1e-6, 0.3e-6)
    first = sphere.run(x[:11], 0.1e-6, 0.3e-6)
    second = sphere.run(x[11:], 0.1e-6, 0.3e-6, state=first.state)
    np.testing.assert_array_equal(second.position, whole.position[11:])
    assert first.state.tip == (x[10], 0.1e-6, 0.3e-6)
    assert second.state.position == tuple(whole.position[-1])


def test_what_is_refused_is_told() -> None:
    with pytest.raises(nt.errors.InvalidValue, match=r"tip.effective_shear_modulus = 1e\+09 Pa: valid is"):
        nt.Particle(1e-6, SMOOTH, nt.ParticleContact(2e9, 1e9))
    with pytest.raises(nt.errors.InvalidValue, match=r"substrate.work_of_adhesion = 9 J/m\^2: valid is 0 .."):
        nt.Particle(10e-9, nt.ParticleContact(1e9, 0.25e9, 9.0), SMOOTH)
    with pytest.raises(nt.errors.InvalidValue, match="does not touch"):
        particle(1e-6, 1e6, 1e-9).run(0.0, 0.0, 1e-6)
    with pytest.raises(nt.errors.InvalidValue, match="motion 'turn': valid are slide, roll, spin"):
        particle(1e-6, 1e6, 1e-9).limit("tip", "turn", 1e-9)  # type: ignore[arg-type]
    with pytest.raises(nt.errors.InvalidValue, match="model 'morse'"):
        nt.Particle(1e-6, SMOOTH, nt.ParticleContact(E, G, model="morse"))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("radius", "share", "height", "strength", "mode"),
    [(1.9e-6, 0.29, 1.45, 6e6, "roll"), (0.75e-6, 0.10, 1.35, 1e6, "slide"), (1.5e-6, 0.4, 1.6, 2e8, "roll")],
)
def test_beside_a_planar_model_of_its_own(
    radius: float, share: float, height: float, strength: float, mode: str
) -> None:
    """planar_push_oracle.py, in the same steps: forces on the tip, and where the sphere goes."""
    E, G, tip_radius = 5e9, 1.2e9, share * radius
    rolling = 0.004 * radius, 0.004 * tip_radius
    both = radius * tip_radius / (radius + tip_radius)
    reach = -math.sqrt((radius + tip_radius) ** 2 - (height * radius - radius) ** 2)
    tips = np.linspace(reach - 2e-9, reach + 4.0 * rolling[0], 150)
    contacts = [
        nt.ParticleContact(E, G, work, shear_strength=strength, rolling_distance=distance, model="dmt")
        for work, distance in zip((0.06, 0.01), rolling, strict=True)
    ]
    step = 1.001 * float(tips[1] - tips[0])
    sphere = nt.Particle(radius, *contacts, tip_radius=tip_radius, step=step)
    path = sphere.run(tips, 0.0, height * radius - tip_radius)
    joints = Joint(radius, E, G, 0.06, strength, rolling[0]), Joint(both, E, G, 0.01, strength, rolling[1])
    flat = Flat(radius, tip_radius, height * radius, *joints, float(tips[0]))
    force = np.array([flat.step(float(place)) for place in tips])
    assert path.happened(mode).any()
    np.testing.assert_allclose(path.force[:, [0, 2]], force, atol=1e-5 * np.abs(force).max())
    assert path.position[-1, 0] == pytest.approx(flat.pose[0], rel=1e-5)
