# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch.curves.analyse on curves whose answer is known, and on the real ones."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic
from nanotouch import curves
from nanotouch.curves.baseline import fit_baseline
from nanotouch.errors import InvalidValue


def as_curve(known: synthetic.KnownCurve) -> curves.ForceCurve:
    def segment(role: str, z: synthetic.Array, force: synthetic.Array) -> curves.Segment:
        time = np.full(z.size, np.nan)
        return curves.Segment(role, time, z, "height (measured)", force, force / known.spring_constant)  # type: ignore[arg-type]

    return curves.ForceCurve(
        (
            segment("approach", known.approach_z, known.approach_force),
            segment("retract", known.retract_z, known.retract_force),
        ),
        {"spring constant": known.spring_constant},
        "synthetic",
    )


@pytest.mark.parametrize("seed", range(5))
def test_known_answer(seed: int) -> None:
    known = synthetic.known_curve(seed=seed)
    report = curves.analyse(as_curve(known))
    # the lowest of the points near the bottom: at most four standard deviations of noise off
    assert report.pull_off_force == pytest.approx(known.pull_off_force, abs=4 * known.noise)
    assert report.snap_in_force == pytest.approx(known.snap_in_force, abs=4 * known.noise)
    # 10 pN over 0.8 N/m is 12 pm
    assert report.contact_point == pytest.approx(known.contact_point, abs=60e-12)
    assert report.contact_slope == pytest.approx(known.spring_constant + report.baseline_tilt, rel=5e-3)
    assert report.noise == pytest.approx(known.noise, rel=0.15)
    assert report.baseline_tilt == pytest.approx(2e-4, abs=1e-5)
    for name in ("pull_off_force", "snap_in_force"):
        assert known.noise < report.sigma[name] < 3 * known.noise
    assert report.sigma["contact_point"] < 60e-12


def test_tilt_is_taken_off_and_a_constant_baseline_leaves_it_in() -> None:
    """5 mN/m of tilt: over the 0.3 um to the middle of the far half it makes 1.3 nN, which the line knows."""
    known = synthetic.known_curve(tilt=5e-3)
    curve = as_curve(known)
    line, constant = curves.analyse(curve), curves.analyse(curve, baseline="constant")
    assert line.pull_off_force == pytest.approx(known.pull_off_force, abs=5 * known.noise)
    lever = line.baselines["retract"].at(np.array([0.75 * 7.5e-7 + 0.25 * 2.8e-7])) - line.baselines["retract"].at(
        np.array([line.pull_off_z])
    )
    assert constant.pull_off_force - line.pull_off_force == pytest.approx(float(lever[0]), rel=0.02)
    with pytest.raises(InvalidValue, match="baseline"):
        curves.analyse(curve, baseline="parabola")  # type: ignore[arg-type]


def test_interference_waves_are_taken_off_or_widen_the_uncertainty() -> None:
    """A wave is no noise from point to point: a line that leaves it in must show it in sigma."""
    calm = curves.analyse(as_curve(synthetic.known_curve()))
    known = synthetic.known_curve(waves=0.3e-9)
    line = curves.analyse(as_curve(known), baseline="line")
    assert line.noise == pytest.approx(calm.noise, rel=0.2)
    assert line.sigma["pull_off_force"] > 3 * calm.sigma["pull_off_force"]
    assert abs(line.pull_off_force - known.pull_off_force) < 3 * max(line.sigma["pull_off_force"], 0.3e-9 / 3)
    assert calm.baselines["retract"].wave is None
    report = curves.analyse(as_curve(known))
    wave = report.baselines["retract"].wave
    assert wave is not None
    assert wave.amplitude == pytest.approx(0.3e-9, rel=0.05)
    # it is carried on into the contact, where an error of its period of 1 % moves it by a tenth of its amplitude
    assert report.pull_off_force == pytest.approx(known.pull_off_force, abs=4 * known.noise + 0.1 * 0.3e-9)
    assert any("interference" in note for note in report.notes)


def test_no_adhesion_gives_zero_and_an_approach_alone_no_pull_off() -> None:
    rng = np.random.default_rng(8)
    z = np.linspace(8e-7, 2e-7, 1500)
    force = np.where(z < 3e-7, 3e-2 * np.clip(3e-7 - z, 0, None), 0.0) + 10e-12 * rng.standard_normal(z.size)
    approach = curves.Segment("approach", np.full(z.size, np.nan), z, "height (measured)", force)
    report = curves.analyse(curves.ForceCurve((approach,), {"spring constant": 0.05}, "soft"))
    assert report.snap_in_force == 0.0
    assert np.isnan(report.pull_off_force)
    # seen once the force is five times the noise, 50 pN over 0.03 N/m = 1.7 nm inside
    assert 0 < 3e-7 - report.contact_point < 3e-9
    idle = 10e-12 * rng.standard_normal(z.size)
    free = curves.Segment("approach", np.full(z.size, np.nan), z, "height (measured)", idle)
    nothing = curves.analyse(curves.ForceCurve((free,), {}, "free"))
    assert np.isnan(nothing.contact_point)
    assert np.isnan(nothing.contact_slope)


def test_force_and_gap() -> None:
    """On a stiff sample the tip stands still in contact: the gap there is zero, and it opens at pull-off."""
    known = synthetic.known_curve(noise=2e-12)
    curve = as_curve(known)
    report = curves.analyse(curve)
    gap, force = curves.force_gap(curve, report)
    touching = curve.retract.z < report.pull_off_z  # type: ignore[union-attr]
    assert np.abs(gap[touching]).max() < 50e-12
    assert force.min() == pytest.approx(-known.pull_off_force, abs=10e-12)
    assert gap[~touching][5:].min() > 10e-9  # pull-off over k: 15 nm
    assert abs(np.median(force[~touching])) < 5e-12
    with pytest.raises(InvalidValue, match="spring constant"):
        curves.force_gap(curves.ForceCurve(curve.segments, {}, "synthetic"), report)
    with pytest.raises(InvalidValue, match="role"):
        curves.force_gap(curve, report, "pause")


def test_without_force_or_points() -> None:
    z = np.linspace(1e-6, 0, 100)
    bent = curves.Segment("approach", z, z, "height (measured)", deflection=z)
    with pytest.raises(InvalidValue, match="no force without a spring constant"):
        curves.analyse(curves.ForceCurve((bent,), {}, "volts"))
    with pytest.raises(InvalidValue, match="neither an approach nor a retraction"):
        curves.analyse(curves.ForceCurve((), {}, "nothing"))


REAL = [
    # file, pull-off and snap-in [nN] as published with the data, against a constant baseline; None: none is stated
    ("fmt-igor-fd_SiN_FD_plot.ibw", 12.8, 3.0),
    ("fmt-jpk-fd_qi-data-2021.04.13.jpk-qi-series", 10.4, None),
    ("fmt-jpk-cc_pr14-polymergel-2021.06.30.jpk-force", 11.2, None),
    ("fmt-jpk-fd_spot3-0192.jpk-force", 0.43, None),
]


@pytest.mark.parametrize(("name", "pull_off", "snap_in"), REAL)
def test_real_curves(name: str, pull_off: float, snap_in: float | None) -> None:
    pytest.importorskip("afmformats")
    path = synthetic.DATA / "curves" / name
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    (curve,) = curves.read(path)
    published = curves.analyse(curve, baseline="constant")
    assert published.pull_off_force == pytest.approx(pull_off * 1e-9, rel=0.01)
    if snap_in is not None:
        assert published.snap_in_force == pytest.approx(snap_in * 1e-9, rel=0.01)


def test_real_silicon_nitride() -> None:
    pytest.importorskip("afmformats")
    path = synthetic.DATA / "curves" / "fmt-igor-fd_SiN_FD_plot.ibw"
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    report = curves.analyse(curves.read(path)[0])
    assert report.pull_off_force == pytest.approx(12.8e-9, abs=0.05e-9)
    assert report.snap_in_force == pytest.approx(3.0e-9, abs=0.05e-9)
    assert report.noise < 10e-12


def test_drift_is_not_taken_for_a_wave() -> None:
    """Random walks have no period, but look like a wave or two: 100 of them, at most 8 mistaken (2.5 % are, in 200)."""
    rng = np.random.default_rng(0)
    z = np.linspace(0.0, 1.5e-6, 1500)
    mistaken = 0
    for _ in range(100):
        force = 1e-12 * np.cumsum(rng.standard_normal(z.size)) + 5e-12 * rng.standard_normal(z.size)
        mistaken += fit_baseline(z, force).wave is not None
    assert mistaken <= 8
