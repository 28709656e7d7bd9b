# SPDX-License-Identifier: BSD-3-Clause
"""Maps: every curve as fit_curve fits it, whatever the threads; bad curves are reported; what is stored reads back."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from synthetic import DATA

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("xarray")

from nanotouch import maps

SOFT, HARD, WEAK, STRONG = 2e8, 1e9, 0.015, 0.04  # Pa, Pa, J/m^2, J/m^2
SETTINGS: dict[str, Any] = {"radius": 20e-9, "cohesive_range": 0.2e-9}


def pattern(n: int = 8) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Two moduli in a chequerboard, a sticky patch, a step of 5 nm: shapes (n, n)."""
    y, x = np.mgrid[:n, :n] / n
    modulus = np.where((x // 0.25 + y // 0.25) % 2 == 0, SOFT, HARD)
    work = np.where((x - 0.65) ** 2 + (y - 0.35) ** 2 < 0.2**2, STRONG, WEAK)
    return modulus, work, np.where(x + 2 * y > 1.6, 5e-9, 0.0)


def volume(n: int = 8, points: int = 500, **given: Any) -> maps.ArrayVolume:
    known: dict[str, Any] = {"radius": 20e-9, "spring_constant": 1.0, "noise": 30e-12, "depth": 20e-9, "tilt": 1e-4}
    return maps.synthesize(*pattern(n), points=points, **(known | given))


def curve_of(source: maps.ArrayVolume, y: int, x: int) -> nt.ForceCurve:
    half = source.z.size // 2
    parts = [("approach", slice(0, half)), ("retract", slice(half, None))]
    segments = tuple(
        nt.curves.Segment(role, np.full(half, np.nan), source.z[part], "height (measured)", source.values[y, x, part])  # type: ignore[arg-type]
        for role, part in parts
    )
    return nt.ForceCurve(segments, {"spring constant": source.spring_constant})


@pytest.mark.parametrize("model", ["hertz", "dmt", "jkr", "maugis", "cone", "pyramid"])
def test_every_curve_is_fitted_as_fit_curve_does(model: str) -> None:
    """The procedure stands twice, in numpy for one curve and in C++ for many: both must give the same.

    Their sums differ in order, so in the last digits: 1e-13 of sigma is found, 1e-6 allowed. (A curve that determines
    nothing can end anywhere; none is here.)
    """
    settings: dict[str, Any] = (
        SETTINGS if model == "maugis" else {} if model in ("cone", "pyramid") else {"radius": 20e-9}
    )
    source = volume(3)
    source.values[1, 1] *= 1.15  # a calibration that is wrong by five standard deviations
    data = maps.fit(source, model, **settings)
    flags = dict(zip(data.flags.attrs["flag_meanings"].split(), data.flags.attrs["flag_masks"], strict=True))
    for y, x in np.ndindex(3, 3):
        one = nt.fit.fit_curve(curve_of(source, y, x), model, **settings)
        here = data.isel(y=y, x=x)
        for name in one.free:
            assert float(here[name]) == pytest.approx(one.values[name], abs=1e-6 * one.sigma[name])
            assert float(here[f"{name}_sigma"]) == pytest.approx(one.sigma[name], rel=1e-6, abs=0.0)
            assert float(here[f"{name}_sigma_statistical"]) == pytest.approx(
                one.sigma_statistical[name], abs=1e-6 * one.sigma[name]
            )
            if name in one.identifiable:
                assert bool(int(here.flags) & flags[f"{name}_undetermined"]) == (not one.identifiable[name])
        for name in ("pull_off_force", "snap_in_force", "adhesion_work", "contact_slope"):
            assert float(here[name]) == pytest.approx(getattr(one.report, name), rel=1e-9, abs=0.0)
            assert float(here[f"{name}_sigma"]) == pytest.approx(one.report.sigma[name], rel=1e-9, abs=0.0, nan_ok=True)
        assert float(here.noise) == pytest.approx(one.report.noise, rel=1e-12, abs=0.0)
        assert float(here.residual_rms) == pytest.approx(one.residual_rms, rel=1e-6, abs=0.0)


def test_flicker_noise_widens_sigma_as_in_fit_curve() -> None:
    """1/f noise is found in numpy and in C++; their sums differ in order."""
    source = volume(2, points=900, noise=10e-12)
    rng = np.random.default_rng(2)
    for y, x in np.ndindex(2, 2):
        source.values[y, x] += np.cumsum(rng.standard_normal(source.z.size)) * 3e-12 * np.array([0.0, 1.0])[x]
    data = maps.fit(source, "dmt", radius=20e-9)
    for y, x in np.ndindex(2, 2):
        one = nt.fit.fit_curve(curve_of(source, y, x), "dmt", radius=20e-9)
        noise = one.report.baselines["retract"].noise
        assert (source.z.size * noise.flicker > noise.white) == (x == 1)
        for name in one.free:
            assert float(data[f"{name}_sigma"][y, x]) == pytest.approx(one.sigma[name], rel=1e-6, abs=0.0)
    assert float(data.contact_point_sigma[0, 1]) > 3.0 * float(data.contact_point_sigma[0, 0])


def test_moduli_scatter_by_sigma_in_white_noise() -> None:
    """Few points on the contact, so that the scatter of their own counts: 576 curves know a standard deviation to 3 %.
    (What correlated noise adds must not widen where there is none: by a sixth, once.)"""
    source = volume(24, points=1000)
    data = maps.fit(source, "maugis", **SETTINGS)
    pull = (data.effective_modulus.values - pattern(24)[0]) / data.effective_modulus_sigma.values
    assert np.std(pull) == pytest.approx(1.0, abs=0.1)


def test_the_pattern_is_found() -> None:
    modulus, work, height = pattern()
    data = maps.fit(volume(), "maugis", **SETTINGS)
    for name, truth in (("effective_modulus", modulus), ("work_of_adhesion", work)):
        pull = (data[name].values - truth) / data[f"{name}_sigma"].values
        assert abs(np.median(pull)) < 1.0  # 64 curves; sigma includes the calibration's 3 %, which is exact here
        assert np.percentile(np.abs(pull), 95) < 4.0
    step = data.contact_point.values[height > 0].mean() - data.contact_point.values[height == 0].mean()
    assert step == pytest.approx(5e-9, abs=0.1e-9)
    sticky = data.pull_off_force.values[work == STRONG]
    assert sticky.min() > 1.5 * data.pull_off_force.values[work == WEAK].max()


def test_neither_threads_nor_blocks_change_a_bit() -> None:
    source = volume(6)
    first = maps.fit(source, "jkr", radius=20e-9, threads=1, block=100)
    for threads, block in ((2, 100), (5, 7), (1, 1)):
        assert maps.fit(source, "jkr", radius=20e-9, threads=threads, block=block).equals(first)


def test_poisonous_curves_are_reported_and_harm_no_other() -> None:
    clean = volume(4)
    healthy = maps.fit(clean, "jkr", radius=20e-9)
    spoilt = maps.ArrayVolume(clean.values.copy(), clean.z, clean.spring_constant)
    bad = {"nan": (0, 1), "infinite": (0, 2), "constant": (1, 0), "huge": (2, 3), "one spike": (3, 3)}
    spoilt.values[0, 1, 100] = np.nan
    spoilt.values[0, 2, 700] = -np.inf
    spoilt.values[1, 0] = 3e-9
    spoilt.values[2, 3] *= 1e12
    spoilt.values[3, 3, 5] = 1e300
    data = maps.fit(spoilt, "jkr", radius=20e-9)
    names = dict(zip(data.status.attrs["flag_values"], data.status.attrs["flag_meanings"].split(), strict=True))
    places = np.zeros((4, 4), bool)
    for y, x in bad.values():
        places[y, x] = True
        assert np.isnan(data.effective_modulus.values[y, x])
        assert np.isnan(data.pull_off_force.values[y, x])
        assert data.reason.values[y, x]
    assert names[data.status.values[0, 1]] == names[data.status.values[0, 2]] == "NT_E_NOT_FINITE"
    assert names[data.status.values[1, 0]] == names[data.status.values[2, 3]] == "NT_E_RANGE"
    assert "force (span)" in data.reason.values[1, 0]
    assert np.array_equal(data.status.values != 0, places)
    assert data.attrs["curves_without_result"] == len(bad)
    for name in healthy:
        assert np.array_equal(data[name].values[~places], healthy[name].values[~places], equal_nan=name != "reason")


def test_missing_and_short_curves_have_a_reason() -> None:
    source = volume(2)
    curves = []
    for y, x in ((0, 0), (1, 1)):
        one = curve_of(source, y, x)
        place = {"grid index x": x, "grid index y": y, "grid shape x": 2, "grid shape y": 2}
        curves.append(nt.ForceCurve(one.segments, dict(one.meta) | place))
    short = curves[1]
    cut = tuple(
        nt.curves.Segment(s.role, s.time[:9], s.z[:9], s.z_channel, s.force[:9])  # type: ignore[index]
        for s in short.segments
    )
    data = maps.fit([curves[0], nt.ForceCurve(cut, short.meta)], "jkr", radius=20e-9)
    assert data.status.values[0, 0] == 0
    assert (data.status.values != 0).sum() == 3
    assert "count" in data.reason.values[1, 1]
    assert "count" in data.reason.values[0, 1]


def test_deflections_and_a_height_of_each_curve_give_the_same_as_forces() -> None:
    source = volume(3, spring_constant=0.5)
    forces = maps.fit(source.values, "jkr", z=source.z, spring_constant=0.5, radius=20e-9)
    each = np.broadcast_to(source.z, source.values.shape).copy()
    bent = maps.fit(source.values / 0.5, "jkr", z=each, deflection=True, spring_constant=0.5, radius=20e-9)
    assert np.allclose(bent.effective_modulus, forces.effective_modulus, rtol=1e-9)


@pytest.mark.parametrize("model", ["jkr", "cone"])
def test_youngs_modulus_and_the_uncertainty_of_the_calibration(model: str) -> None:
    """Both take differences of refitted curves, with steps of another size: they agree to first order."""
    source = volume(2)
    given: dict[str, Any] = {"tip": nt.Scene().tip, "poisson_ratio": 0.3}
    given["uncertainties"] = nt.fit.Uncertainties(spring_constant=0.05, radius=0.1, half_angle=0.02, poisson_ratio=0.05)
    here = maps.fit(source, model, **given).isel(y=1, x=1)
    one = nt.fit.fit_curve(curve_of(source, 1, 1), model, **given)
    assert float(here.youngs_modulus) == pytest.approx(one.values["youngs_modulus"], rel=1e-6)
    for name in ("youngs_modulus", "effective_modulus", "contact_point"):
        assert float(here[f"{name}_sigma"]) == pytest.approx(one.sigma[name], rel=0.02, abs=0.0)
        assert float(here[f"{name}_sigma_calibration"]) == pytest.approx(one.sigma_calibration[name], rel=0.02, abs=0.0)


def test_interference_is_taken_off_where_it_is_evident() -> None:
    """As fit_curve does it: an FFT there and single sums here agree to rounding."""
    source = volume(2, points=900, noise=20e-12, clearance=900e-9)
    source.values[0, 1] += 150e-12 * np.sin(2 * np.pi * source.z / 320e-9 + 0.4)
    data = maps.fit(source, "jkr", radius=20e-9)
    assert maps.flag_counts(data)["waves"] == 1
    here = data.isel(y=0, x=1)
    one = nt.fit.fit_curve(curve_of(source, 0, 1), "jkr", radius=20e-9)
    assert one.report.branches["retract"].baseline.wave is not None
    for name in one.free:
        assert float(here[name]) == pytest.approx(one.values[name], abs=1e-6 * one.sigma[name])
    straight = maps.fit(source, "jkr", radius=20e-9, baseline="line").isel(y=0, x=1)
    assert abs(float(straight.work_of_adhesion) - WEAK) > abs(float(here.work_of_adhesion) - WEAK)


def test_what_is_written_reads_back_with_all_that_it_was_made_of(tmp_path: Path) -> None:
    source = volume(3)
    source.values[0, 0, 3] = np.nan
    data = maps.fit(source, "jkr", radius=20e-9)
    again = maps.read(maps.write(tmp_path / "map.nc", data))
    assert again.equals(data)
    assert again.effective_modulus.attrs["units"] == "Pa"
    assert json.loads(again.attrs["settings"])["radius"] == 20e-9
    assert json.loads(again.attrs["versions"])["nanotouch"] == nt.__version__
    assert again.attrs["input_sha256"] == source.digest()
    assert again.x.attrs["units"] == "m"
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "map.nc") as file:  # any HDF5 tool reads it
        assert file["effective_modulus"].attrs["units"] == "Pa"


def test_a_picture_shows_all_of_it(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    source = volume(4)
    source.values[0, 0, 3] = np.nan
    data = maps.fit(source, "maugis", **SETTINGS)
    figure = maps.draw(data, save=tmp_path / "map.png")
    titles = [axes.get_title() for axes in figure.axes if axes.get_title()]
    assert len(titles) == 6
    assert "1 without" in titles[0]
    assert (tmp_path / "map.png").stat().st_size > 20_000
    with pytest.raises(nt.errors.InvalidValue, match="nonsense"):
        maps.draw(data, ("nonsense",))


def test_dask_is_needed_for_clusters_only(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("dask", "distributed"):
        monkeypatch.setitem(sys.modules, module, None)
    source = volume(2)
    assert maps.fit(source, "hertz", radius=20e-9).attrs["curves_without_result"] == 0
    with pytest.raises(nt.errors.MissingExtra, match=r"distributed.*extra maps"):
        maps.fit(source, "hertz", radius=20e-9, cluster="local")


def test_laws_in_python_are_refused() -> None:
    law = nt.fit.Model(
        "punch_of_maps", lambda delta, radius, modulus: 2.0 * modulus * radius * delta.clip(0),
        (nt.fit.Parameter("effective_modulus", "Pa", 1e3, 1e12),), valid="flat punch",
    )  # fmt: skip
    nt.fit.register(law)
    with pytest.raises(nt.errors.InvalidValue, match="punch_of_maps"):
        maps.fit(volume(2), "punch_of_maps", radius=20e-9)


def test_what_cannot_be_a_map_is_refused_in_one_sentence() -> None:
    source = volume(2)
    with pytest.raises(nt.errors.InvalidValue, match="shape"):
        maps.fit(np.zeros((4, 5)), "jkr", z=np.zeros(5), spring_constant=1.0)
    with pytest.raises(nt.errors.InvalidValue, match="needs z"):
        maps.fit(source.values, "jkr")
    with pytest.raises(nt.errors.InvalidValue, match="radus"):
        maps.fit(source, "jkr", radus=3e-9)
    with pytest.raises(nt.errors.InvalidValue, match="stiffness"):
        maps.fit(source, "jkr", fixed={"stiffness": 1.0})
    with pytest.raises(nt.errors.InvalidValue, match="radius"):
        maps.fit(source, "jkr", radius=-1.0)


@pytest.mark.parametrize(("name", "shape"), [("fsas/Test.003", (16, 16)),
                                             ("map-data-2022.10.29-12.27.34.564.jpk-force-map", (4, 4))])  # fmt: skip
def test_measured_maps(name: str, shape: tuple[int, int]) -> None:
    pytest.importorskip("afmformats")
    file = DATA / "curves" / name
    if not file.exists():
        pytest.skip(f"{file} is not there")
    data = maps.fit(file, "dmt", radius=20e-9)
    assert data.status.shape == shape
    assert data.attrs["curves_without_result"] == 0


def test_bounds_where_a_stiff_contact_does_not_determine_the_modulus() -> None:
    """77 GPa on 0.5 N/m: the bound of the map lies below the truth, and below that of one fit, which knows more (the
    profile of chi^2 over the whole curve, where this is the slope alone)."""
    source = maps.synthesize(
        np.full((2, 3), 77e9), 0.03, radius=20e-9, spring_constant=0.5, noise=30e-12, depth=60e-9, points=800
    )
    data = maps.fit(source, "dmt", radius=20e-9)
    least = data["effective_modulus_least"].values
    unknown = ~maps.determined(data, "effective_modulus")
    assert unknown.any()
    assert (np.isfinite(least) <= unknown).all()
    assert np.isfinite(least).any()
    for y, x in np.argwhere(np.isfinite(least)):
        assert 0.0 < least[y, x] < 77e9
        one = nt.fit.fit_curve(curve_of(source, y, x), "dmt", radius=20e-9)
        assert least[y, x] < one.bounds["effective_modulus"][0]
        slope = 0.5 * np.exp(-1.96 * 0.03)  # of a rigid contact, whose sensitivity is as wrong as it may be
        force = source.values[y, x].max()
        softest = (1.0 / (1.0 / slope - 2.0)) ** 1.5 / (6.0 * 20e-9 * force) ** 0.5
        assert 0.5 < least[y, x] / softest < 2.0
    pytest.importorskip("matplotlib")
    assert f"{np.isfinite(least).sum()} a lower bound (^)" in maps.draw(data).axes[0].get_title()
    exact = maps.fit(source, "dmt", radius=20e-9, uncertainties=nt.fit.Uncertainties(sensitivity=0.0))
    assert np.isnan(exact["effective_modulus_least"].values).all()


@pytest.mark.parametrize("modulus", [20.0, 50.0, 100.0])
def test_bounds_where_a_soft_contact_hides_in_the_noise(modulus: float) -> None:
    """Hertz by hand, a bead of 2.5 um at 0.05 N/m: an upper bound wherever the interval is one, and above the truth."""
    z, stiffness, radius = np.linspace(1.5e-6, -0.4e-6, 700), 0.05, 2.5e-6
    depth = np.linspace(0.0, 2e-6, 4000)
    law = 4.0 / 3.0 * modulus * np.sqrt(radius) * depth**1.5
    pressed = np.interp(np.maximum(-z, 0.0), depth + law / stiffness, law)
    rng = np.random.default_rng(1)
    force = np.concatenate([pressed, pressed[::-1]]) + 15e-12 * rng.standard_normal((600, 1, 1400))
    heights = np.concatenate([z, z[::-1]])
    data = maps.fit(force, "hertz", z=heights, spring_constant=stiffness, radius=radius)
    most, unknown = data["effective_modulus_most"].values, ~maps.determined(data, "effective_modulus")
    bounded = np.isfinite(most)
    assert (bounded <= unknown).all()
    assert bounded.sum() > 20
    assert np.mean(most[bounded] >= modulus) > 0.9
    assert data["effective_modulus_most"].attrs["units"] == "Pa"
    stiff = maps.synthesize(np.full((1, 2), 77e9), 0.03, radius=20e-9, spring_constant=0.5, noise=30e-12, points=800)
    assert np.isnan(maps.fit(stiff, "dmt", radius=20e-9)["effective_modulus_most"].values).all()


def test_a_map_holds_the_interval_of_the_pull_off() -> None:
    source = volume(3)
    data = maps.fit(source, "maugis", **SETTINGS)
    report = nt.curves.analyse(curve_of(source, 1, 2), drag=(0.0, 0.0))
    assert data["pull_off_least"].values[1, 2] == pytest.approx(report.pull_off_interval[0], rel=1e-3)
    assert data["pull_off_most"].values[1, 2] == pytest.approx(report.pull_off_interval[1], rel=1e-3)
    assert data["ruptures"].values[1, 2] == len(report.ruptures)
    one = nt.fit.fit_curve(curve_of(source, 1, 2), "maugis", **SETTINGS)
    assert data["rating"].values[1, 2] == pytest.approx(one.rating, abs=0.05)


def test_the_radius_that_a_file_states_is_used() -> None:
    """As for one curve; several that differ are refused, and one that is given goes before."""
    curve = nt.curves.synthesize(nt.Contact(3e-6, 5e4), "hertz", spring_constant=0.1, noise=10e-12, depth=3e-7, seed=1)
    stated = replace(curve, meta=dict(curve.meta) | {"tip radius": 3e-6})
    data = nt.maps.fit([stated, stated], "hertz")
    assert float(data.effective_modulus[0, 0]) == nt.fit.fit_curve(stated, "hertz").values["effective_modulus"]
    assert "tip radius 3 µm (as the file states)" in data.attrs["assumptions"]
    given = nt.maps.fit([stated, stated], "hertz", radius=1e-6)
    assert float(given.effective_modulus[0, 0]) == pytest.approx(
        float(data.effective_modulus[0, 0]) * 3**0.5,
        rel=1e-3,  # E* goes as 1/sqrt(R)
    )
    other = replace(curve, meta=dict(curve.meta) | {"tip radius": 1e-6})
    with pytest.raises(nt.errors.InvalidValue, match="tip radii from 1e-06 to 3e-06 m"):
        nt.maps.fit([stated, other], "hertz")
