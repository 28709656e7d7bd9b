# SPDX-License-Identifier: BSD-3-Clause
"""Recalibration by a lever of known stiffness: true values come back, with the right sigma."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import curves
from nanotouch.errors import InvalidValue, ReadError
from nanotouch_app.main import main

pytest.importorskip("afmformats")
BOLTZMANN_T = 1.380649e-23 * 295.0
STIFFNESS, SENSITIVITY, RADIUS, MODULUS = 0.04, 52e-9, 2e-6, 5e3


def tuned(rng: np.random.Generator, wrong: float, thermal: float) -> float:
    """k_th of a lever of STIFFNESS whose sensitivity is taken `wrong` times too large: from the volts' variance."""
    volts = BOLTZMANN_T / STIFFNESS / SENSITIVITY**2
    return float(BOLTZMANN_T / (volts * (wrong * SENSITIVITY) ** 2) * (1.0 + thermal * rng.standard_normal()))


def measured(wrong: float, k_th: float, seed: int, noise: float = 10e-12) -> curves.ForceCurve:
    """Hertz' contact as an instrument stores it that believes `wrong` SENSITIVITY and k_th: volts times both."""
    rng = np.random.default_rng(seed)
    z = np.linspace(1e-6, -6e-7, 1200)
    depth, scale = np.maximum(-z, 0.0), 4.0 / 3.0 * MODULUS * np.sqrt(RADIUS)
    for _ in range(60):  # depth + F(depth)/k = -z, by Newton
        excess = depth + scale * depth**1.5 / STIFFNESS - np.maximum(-z, 0.0)
        depth = np.maximum(depth - excess / (1.0 + 1.5 * scale * np.sqrt(depth) / STIFFNESS), 0.0)
    volts = scale * depth**1.5 / STIFFNESS / SENSITIVITY
    segments = []
    for role, order in (("approach", 1), ("retract", -1)):
        seen = volts[::order] + noise / STIFFNESS / SENSITIVITY * rng.standard_normal(z.size)
        force = k_th * wrong * SENSITIVITY * seen
        segments.append(curves.Segment(role, np.full(z.size, np.nan), z[::order], "height (measured)", force))  # type: ignore[arg-type]
    return curves.ForceCurve(tuple(segments), {"spring constant": k_th, "sensitivity": wrong * SENSITIVITY}, "curve")


def test_a_folder_comes_back_to_the_truth(tmp_path: Path) -> None:
    """Sensitivities that are wrong by up to 30 %, a perfect thermal tune: rounding alone is left."""
    rng = np.random.default_rng(0)
    folder = tmp_path / "day [1], cells"  # as a pattern and in a table that name needs care
    folder.mkdir()
    for number, wrong in enumerate((0.7, 0.9, 1.0, 1.3)):
        curves.write(folder / f"{number}.h5", [measured(wrong, tuned(rng, wrong, 0.0), number)])
    lever = curves.Lever(STIFFNESS, 0.04, 0.03)
    found = curves.recalibrate(sorted(folder.glob("*.h5")), lever)
    np.testing.assert_allclose([one.sensitivity for one in found], SENSITIVITY, rtol=1e-12)
    curves.write_table(tmp_path / "calibration.csv", found, lever)
    for file in sorted(folder.glob("*.h5")):
        (read,) = curves.read(file, calibration=tmp_path / "calibration.csv")
        assert read.spring_constant == STIFFNESS
        assert read.meta["sensitivity"] == pytest.approx(SENSITIVITY, rel=1e-12)
        truth = measured(1.0, STIFFNESS, int(file.stem)).segments[0].force
        np.testing.assert_allclose(read.segments[0].force, truth, rtol=1e-11, atol=1e-24)  # type: ignore[arg-type]


def test_sigma_of_modulus_and_force_is_that_of_many_laboratories() -> None:
    """300 vendors and thermal tunes with errors of 6 and 4 %: the scatter of what is fitted is the sigma it states.

    A standard deviation of 300 is known to 4 %; 15 % is over three of these. Taken as independent, both
    would be told nearly twice too much.
    """
    pytest.importorskip("nanotouch._fit")
    rng = np.random.default_rng(1)
    errors, sigmas, forces = [], [], []
    for number in range(300):
        vendor = STIFFNESS * (1.0 + 0.06 * rng.standard_normal())
        lever = curves.Lever(vendor, 0.06, 0.04)
        k_th = tuned(rng, 1.1, 0.04)
        stored = measured(1.1, k_th, number)
        given = curves.Calibration(vendor, lever.sensitivity(stored.meta["sensitivity"], k_th))
        curve = curves.calibration.calibrated(stored, given, Path("curve"))
        result = nt.fit.fit_curve(curve, "hertz", radius=RADIUS, uncertainties=nt.fit.Uncertainties(**lever.known_to))
        errors.append(np.log(result.values["effective_modulus"] / MODULUS))
        sigmas.append(result.sigma["effective_modulus"] / result.values["effective_modulus"])
        forces.append(np.log(curve.segments[0].force[-1]))  # type: ignore[index]
    assert np.std(errors) == pytest.approx(np.median(sigmas), rel=0.15)
    known = nt.fit.Uncertainties(**lever.known_to)
    assert np.std(forces) == pytest.approx(known.force, rel=0.15)
    assert known.force == pytest.approx(0.5 * np.hypot(0.06, 0.04), rel=1e-12)


def test_maps_carry_the_correlation() -> None:
    pytest.importorskip("nanotouch._fit")
    pytest.importorskip("xarray")
    lever = curves.Lever(STIFFNESS, 0.06, 0.04)
    known = nt.fit.Uncertainties(**lever.known_to)
    curve = measured(1.0, STIFFNESS, 0)
    single = nt.fit.fit_curve(curve, "hertz", radius=RADIUS, uncertainties=known)
    z = np.concatenate([segment.z for segment in curve.segments])
    force = np.concatenate([segment.force for segment in curve.segments])  # type: ignore[misc]
    block = nt.maps.block.Block(z, force, np.array([0, 1200, 2400]), np.array([STIFFNESS]))
    settings: dict[str, Any] = {"model": "hertz", "radius": RADIUS, "uncertainties": known}
    column = nt.maps.block.fit_block(nt.maps.settings.Settings(**settings).as_json(), block)
    assert column["effective_modulus_sigma"][0] == pytest.approx(single.sigma["effective_modulus"], rel=0.01)


def test_what_is_refused(tmp_path: Path) -> None:
    bare = measured(1.0, STIFFNESS, 0)
    curves.write(tmp_path / "a.h5", [curves.ForceCurve(bare.segments, {"spring constant": STIFFNESS}, "a")])
    with pytest.raises(ReadError, match=r"a\.h5: states no sensitivity"):
        curves.recalibrate([tmp_path / "a.h5"], curves.Lever(STIFFNESS, 0.04, 0.03))
    curves.write(tmp_path / "b.h5", [curves.ForceCurve(bare.segments, bare.meta | {"spring constant": 1.0}, "b")])
    with pytest.raises(ReadError, match="states no spring constant"):
        curves.recalibrate([tmp_path / "b.h5"], curves.Lever(STIFFNESS, 0.04, 0.03))
    for wrong in ((0.0, 0.04, 0.03), (STIFFNESS, -0.1, 0.0), (STIFFNESS, 0.04, np.nan)):
        with pytest.raises(InvalidValue, match="valid is"):
            curves.Lever(*wrong)
    with pytest.raises(InvalidValue, match="correlation"):
        nt.fit.Uncertainties(correlation=-1.1)


def test_the_table_may_lie_among_the_curves(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A second run took its own table for a force curve."""
    curves.write(tmp_path / "a.h5", [measured(1.0, STIFFNESS, 0)])
    line = ["recalibrate", str(tmp_path), "--lever", "0.04N/m", "--lever-known-to", "4", "--thermal-known-to", "3"]
    out = tmp_path / "cal.csv"
    assert main([*line, "--out", str(out)]) == 0
    assert main([*line, "--out", str(out), "--overwrite"]) == 0
    (tmp_path / "a.h5").unlink()
    assert main([*line, "--out", str(out), "--overwrite"]) == 2
    assert "no force curve" in capsys.readouterr().err
