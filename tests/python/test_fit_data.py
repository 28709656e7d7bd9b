# SPDX-License-Identifier: BSD-3-Clause
"""Every measured curve that is there is analysed and fitted; what stands out in its picture must be in the numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("afmformats")
CURVES = Path(__file__).parents[3] / "shared" / "data" / "curves"
pytestmark = pytest.mark.skipif(not CURVES.is_dir(), reason="the measured curves are not there")

FILES = (
    sorted(path for path in CURVES.rglob("*") if path.is_file() and path.suffix != ".txt") if CURVES.is_dir() else []
)


def first_of(name: str, **calibration: float) -> Any:
    return nt.curves.read(CURVES / name, **calibration)[0]


@pytest.mark.parametrize("file", FILES, ids=lambda path: path.name)
def test_every_curve(file: Path) -> None:
    """First and last of a map; every number finite, or said not to be determined."""
    curves = nt.curves.read(file)
    for curve in {0: curves[0], len(curves) - 1: curves[-1]}.values():
        report = nt.curves.analyse(curve)
        assert report.noise > 0.0
        assert report.pull_off_force >= 0.0
        assert np.isfinite(report.contact_point)
        for model in ("maugis", "hertz", "cone"):
            result = nt.fit.fit_curve(curve, model, report=report)
            assert np.isfinite(result.fitted).all()
            assert np.isfinite(result.residual_rms)
            for name, determined in result.identifiable.items():
                low, high = result.interval[name]
                assert not determined or low < result.values[name] < high
            assert str(result)
            assert result._repr_html_()


def test_silicon_nitride_tip() -> None:
    """A textbook snap-in and pull-off; its contact is a straight line at half the slope that the cantilever would
    show on it, which no contact model with this sensitivity explains."""
    curve = first_of("fmt-igor-fd_SiN_FD_plot.ibw")
    report = nt.curves.analyse(curve)
    assert report.pull_off_force == pytest.approx(12.8e-9, abs=0.05e-9)
    assert report.snap_in_force == pytest.approx(3.0e-9, abs=0.05e-9)
    result = nt.fit.fit_curve(curve, "maugis", report=report)
    assert not result.identifiable["effective_modulus"]
    assert any("calibration" in note for note in result.notes)


def test_mica_finds_its_sensitivity() -> None:
    """Its file says 41.14 nm/V; the slope on mica asks for 30.5. The fit of the retraction finds that ratio."""
    ratio = 30.5 / 41.14
    result = nt.fit.fit_curve(first_of("fsas/Test.000"), "maugis")
    assert result.values["sensitivity"] == pytest.approx(ratio, rel=0.02)
    assert not result.identifiable["effective_modulus"]
    assert any("disagrees with its calibration" in note for note in result.notes)
    assert any("placeholder" in note for note in result.notes)
    corrected = first_of("fsas/Test.000", sensitivity=30.5e-9, spring_constant=1.2)
    assert nt.fit.fit_curve(corrected, "maugis").values["sensitivity"] == pytest.approx(1.0, abs=0.02)


def test_interference_is_taken_off() -> None:
    """Waves of 330 nm, half the wavelength of a red laser, on both branches, over a tilt that both show: below them the
    pull-off is some 3 nN, below the level of the far half, which the tilt carries away from the contact, 10 nN."""
    curve = first_of("fmt-jpk-fd_qi-data-2021.04.13.jpk-qi-series")
    report = nt.curves.analyse(curve)
    periods = [baseline.wave.period for baseline in report.baselines.values() if baseline.wave is not None]
    assert periods == pytest.approx([330e-9, 330e-9], abs=5e-9)
    assert report.pull_off_force == pytest.approx(3.2e-9, abs=1e-9)
    assert nt.curves.analyse(curve, baseline="line").pull_off_force == pytest.approx(4.4e-9, abs=0.3e-9)
    assert nt.curves.analyse(curve, baseline="constant").pull_off_force == pytest.approx(10.4e-9, abs=0.3e-9)
    assert any("10.4 nN" in note for note in report.notes)


def test_gel_is_no_sphere_on_a_half_space() -> None:
    """It comes off in steps: several necks."""
    result = nt.fit.fit_curve(first_of("fmt-jpk-cc_pr14-polymergel-2021.06.30.jpk-force"), "maugis")
    assert not any(result.identifiable.values())
    assert any("model is wrong" in note for note in result.notes)
