# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch map``: on a NanoScope force volume with a known answer."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nanotouch import curves
from nanotouch.errors import InvalidValue
from nanotouch_app.main import main
from synthetic import write_nanoscope

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")
pytest.importorskip("matplotlib")

from nanotouch import maps
from nanotouch.fit import fit_curve

RAMP, SENSITIVITY, STIFFNESS = 300e-9, 41e-9, 0.5  # m, m/V, N/m
KNOWN = ["--model", "dmt", "--radius", "20nm", "--spring-constant", "0.5N/m"]


@pytest.fixture
def volume_file(tmp_path: Path) -> Path:
    """2 x 2 curves of one contact, more adhesive in the second row; both directions as stored, deepest first."""
    sample = maps.synthesize(
        np.full((2, 2), 1e8), np.array([[0.01], [0.02]]), radius=20e-9, spring_constant=STIFFNESS, depth=20e-9,
        clearance=RAMP - 20e-9, points=600, noise=20e-12, model="dmt",
    )  # fmt: skip
    volts = sample.values / STIFFNESS / SENSITIVITY
    curves = [(curve[:600][::-1], curve[600:]) for curve in volts.reshape(4, 1200)]
    return write_nanoscope(tmp_path / "volume.000", curves, ramp=RAMP, sensitivity=SENSITIVITY)


def test_leaves_the_map_a_picture_and_a_summary(
    volume_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["map", str(volume_file), *KNOWN, "--out", str(out)]) == 0
    assert sorted(path.name for path in out.iterdir()) == ["map.json", "map.nc", "map.png"]
    data = maps.read(out / "map.nc")
    assert data.effective_modulus.shape == (2, 2)
    assert data.work_of_adhesion.values == pytest.approx(np.array([[0.01, 0.01], [0.02, 0.02]]), rel=0.15)
    found = json.loads((out / "map.json").read_text())
    assert found["quantities"]["pull_off_force"]["unit"] == "N"
    assert found["calibration"]["spring_constant"] == STIFFNESS
    assert found["curves_without_result"] == 0
    said = capsys.readouterr().out
    assert "2 x 2 curves, 4 fitted" in said
    assert "effective_modulus" in said


@pytest.mark.usefixtures("undrawn")
def test_goes_on_from_what_a_stopped_run_left(
    volume_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"

    def stop(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr("nanotouch.maps.write", stop)
        assert main(["map", str(volume_file), *KNOWN, "--out", str(out)]) == 130
    assert len(list((out / "map.blocks").glob("block-*.npz"))) == 1
    other = [*KNOWN[:3], "30nm", *KNOWN[4:]]
    assert main(["map", str(volume_file), *other, "--out", str(out)]) == 2
    assert "radius" in capsys.readouterr().err
    assert main(["map", str(volume_file), *other, "--out", str(out), "--restart"]) == 0
    assert not (out / "map.blocks").exists()


def test_names_the_extra_that_is_missing(
    volume_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "h5netcdf", None)
    assert main(["map", str(volume_file), *KNOWN, "--out", str(tmp_path / "out")]) == 2
    assert "(extra maps, force maps, also on a cluster)" in capsys.readouterr().err


def test_a_file_that_is_no_map_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "notes.txt").write_text("a good day")
    assert main(["map", str(tmp_path / "notes.txt"), "--out", str(tmp_path / "out")]) == 2
    assert "notes.txt" in capsys.readouterr().err


@pytest.mark.usefixtures("undrawn")
def test_a_sidecar_holds_for_maps_too(volume_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Left out, a contact point and a baseline by hand: as one fit of that curve; all others as without."""
    plain = maps.fit(volume_file, "dmt", radius=20e-9, spring_constant=STIFFNESS)
    contact = float(plain.contact_point[1, 0]) + 1e-9
    sidecar = tmp_path / "day.toml"
    sidecar.write_text(
        '["volume.000#1"]\nexclude = "dust"\n\n'
        f'["volume.000#2"]\ncontact_point_nm = {contact * 1e9!r}\n\n'
        '["volume.000#3"]\nbaseline_nm = [150.0, 250.0]\n\n["volume.000#4"]\nexclude = "beyond"\n'
    )
    out = tmp_path / "out"
    assert main(["map", str(volume_file), *KNOWN, "--sidecar", str(sidecar), "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "1 x no result: excluded: dust" in said
    assert "'volume.000#4' of the sidecar is no curve of this map" in said
    data = maps.read(out / "map.nc")
    assert np.isnan(data.effective_modulus.values[0, 1])
    assert float(data.contact_point[1, 0]) == pytest.approx(contact, rel=1e-12)
    curve = curves.read(volume_file, spring_constant=STIFFNESS)[3]
    one = fit_curve(curve, "dmt", radius=20e-9, baseline=(150e-9, 250e-9))
    assert float(data.effective_modulus[1, 1]) == pytest.approx(one.values["effective_modulus"], rel=1e-6)
    assert float(data.effective_modulus[1, 1]) != float(plain.effective_modulus[1, 1])
    assert float(data.effective_modulus[0, 0]) == float(plain.effective_modulus[0, 0])
    with pytest.raises(InvalidValue, match="names curves of a file"):
        maps.fit(np.zeros((1, 1, 64)), z=np.arange(64.0), spring_constant=1.0, sidecar=sidecar)
