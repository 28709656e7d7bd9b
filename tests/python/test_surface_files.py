# SPDX-License-Identifier: BSD-3-Clause
"""What a sample is made of comes from channels of files: units, missing pixels, other grids, adhesion given as a force;
named by a TOML file or options, recorded, made again, refused when the file has changed."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import Scene, SurfaceFile
from nanotouch.errors import InvalidValue, ReadError
from nanotouch.images import read_values
from nanotouch_app.live import files
from nanotouch_app.main import main
from synthetic import DATA, write_gwy, write_ibw_image
from synthetic_images import write_nanoscope_channel

pytest.importorskip("SurfaceTopography")
pytest.importorskip("cv2")

N, SIDE = 32, 320e-9
RNG = np.random.default_rng(5)
HEIGHTS = 1e-9 * np.cumsum(np.cumsum(RNG.normal(size=(N, N)), 0), 1) / N
MODULUS = np.where(np.arange(N) < N // 2, 1e9, 10e9) * np.ones((N, 1))
WORK = np.where(np.arange(N) < N // 2, 0.08, 0.02) * np.ones((N, 1))
DRY: dict[str, Any] = {
    "tip": {"radius": 20e-9}, "medium": {"relative_humidity": 0.0}, "adhesion": {"hamaker_constant": 1e-20},
    "range": {"maximum_load": 50e-9},
}  # fmt: skip
TOML = """
[medium]
relative_humidity_percent = 0
[adhesion]
hamaker_constant_zJ = 10
[range]
maximum_load_nN = 50
[surface]
image = "film.gwy"
level = "none"
youngs_modulus = "DMT modulus"
work_of_adhesion = "Adhesion"
"""


def film(folder: Path, modulus: Any = MODULUS, work: Any = WORK) -> Path:
    return write_gwy(
        folder / "film.gwy", HEIGHTS, (SIDE, SIDE), more={"DMT modulus": (modulus, "Pa"), "Adhesion": (work, "J/m^2")}
    )


def test_gwyddions_other_channels_are_listed_and_read(tmp_path: Path) -> None:
    file = film(tmp_path)
    listed = {channel.name: channel for channel in nt.images.channels(file)}
    assert listed["DMT modulus"].unit == "Pa"
    assert listed["Height"].default
    found = read_values(file, "dmt MODULUS", "youngs_modulus")
    np.testing.assert_array_equal(found.values, MODULUS)
    assert found.pixel_size == pytest.approx((SIDE / N, SIDE / N))
    np.testing.assert_allclose(nt.images.read(file).heights, HEIGHTS)
    with pytest.raises(ReadError, match="'Pa', not a length"):
        nt.images.read(file, "DMT modulus")


@pytest.mark.parametrize("cut", [40, 300, 3000, 20000])
def test_a_damaged_gwyddion_file_is_refused(cut: int, tmp_path: Path) -> None:
    file = film(tmp_path)
    file.write_bytes(file.read_bytes()[:cut])
    with pytest.raises(ReadError):
        read_values(file, "DMT modulus", "youngs_modulus")


def test_nanoscope_counts_become_the_sensitivitys_unit(tmp_path: Path) -> None:
    values = RNG.uniform(500.0, 3000.0, (N, N))  # MPa
    file = write_nanoscope_channel(tmp_path / "q.spm", values, (SIDE, SIDE), "DMTModulus", "250.0 MPa/V")
    found = read_values(file, "DMTModulus", "youngs_modulus")
    np.testing.assert_allclose(found.values, 1e6 * values, atol=1e6 * 3000.0 * 2.1 / 65536)
    logs = write_nanoscope_channel(tmp_path / "l.spm", np.log10(1e6 * values), (SIDE, SIDE), "LogM", "1.0 log(Pa)/V")
    with pytest.raises(ReadError, match=r"youngs_modulus in 'log\(Pa\)'"):
        read_values(logs, "LogM", "youngs_modulus")


def test_asylums_channels_without_a_unit_ask_for_it(tmp_path: Path) -> None:
    file = write_ibw_image(tmp_path / "a.ibw", {"ZSensorTrace": HEIGHTS, "YoungsTrace": MODULUS}, SIDE / N)
    with pytest.raises(ReadError, match="unit of channel 'YoungsTrace' is not stated; give it, as GPa"):
        read_values(file, "YoungsTrace", "youngs_modulus")
    np.testing.assert_array_equal(read_values(file, "YoungsTrace", "youngs_modulus", unit="Pa").values, MODULUS)
    with pytest.raises(ReadError, match=r"youngs_modulus of 1e\+18 \.\. 1e\+19 Pa"):
        read_values(file, "YoungsTrace", "youngs_modulus", unit="GPa")
    with pytest.raises(ReadError, match="youngs_modulus in 'nN'"):
        read_values(file, "YoungsTrace", "youngs_modulus", unit="nN")


def test_units_are_checked_against_the_quantity(tmp_path: Path) -> None:
    file = film(tmp_path)
    with pytest.raises(ReadError, match="states 'Pa' for channel 'DMT modulus', which contradicts the unit 'GPa'"):
        read_values(file, "DMT modulus", "youngs_modulus", unit="GPa")
    with pytest.raises(ReadError, match="youngs_modulus in 'J/m\\^2'"):
        read_values(file, "Adhesion", "youngs_modulus")
    force = write_gwy(tmp_path / "f.gwy", HEIGHTS, (SIDE, SIDE), more={"A": (WORK * 1e-7, "N")})
    with pytest.raises(ReadError, match="a force is a pull_off_force"):
        read_values(force, "A", "work_of_adhesion")
    other = write_gwy(tmp_path / "o.gwy", HEIGHTS, (SIDE, SIDE), more={"A": (WORK * 1e3, "mN m^-1")})
    np.testing.assert_allclose(read_values(other, "A", "work_of_adhesion").values, WORK)


def test_missing_pixels_are_refused_or_filled_and_told(tmp_path: Path) -> None:
    holes = MODULUS.copy()
    holes[3, 4], holes[20, 25], holes[21, 25] = np.nan, 0.0, -1.0
    file = film(tmp_path, holes)
    with pytest.raises(ReadError, match=r"3 of 1024 pixels of 'DMT modulus' have no youngs_modulus \(the first at "):
        read_values(file, "DMT modulus", "youngs_modulus")
    filled = read_values(file, "DMT modulus", "youngs_modulus", fill_by="neighbours")
    np.testing.assert_allclose(filled.values, MODULUS, rtol=1e-12)  # each hole lies within one material
    assert filled.mask.sum() == 3
    assert filled.notes == ("3 of 1024 pixels filled by neighbours",)
    middle = read_values(file, "DMT modulus", "youngs_modulus", fill_by="median")
    assert middle.values[3, 4] == middle.values[20, 25] == pytest.approx(1e9)  # two of the hard ones are missing
    with pytest.raises(ReadError, match="up to 90 % are filled"):
        read_values(film(tmp_path, np.where(MODULUS > 2e10, MODULUS, np.nan)), "DMT modulus", "youngs_modulus",
                    fill_by="median")  # fmt: skip


@pytest.mark.parametrize("pixels", [8, 20, 32, 77, 128])
def test_other_grids_are_resampled_within_their_range(pixels: int, tmp_path: Path) -> None:
    """A ramp of the logarithm, at x = i dx of both grids; and never outside what was measured."""
    x = np.arange(pixels) / pixels
    ramp = np.exp(np.log(1e8) + np.log(1e3) * x) * np.ones((pixels, 1))
    file = write_gwy(tmp_path / "r.gwy", HEIGHTS, (SIDE, SIDE), more={"E": (ramp, "Pa")})
    found = read_values(file, "E", "youngs_modulus").on(nt.images.read(file))
    assert found.shape == (N, N)
    expected = np.exp(np.log(1e8) + np.log(1e3) * np.minimum(np.arange(N) / N, x[-1]))
    exact = 1e-9 if pixels <= N or pixels % N == 0 else 5e-3  # a mean over so few pixels has a step of them
    inside = slice(max(1, N // pixels), N - max(2, 2 * N // pixels))
    np.testing.assert_allclose(found[:, inside], np.broadcast_to(expected[inside], found[:, inside].shape), rtol=exact)
    assert ramp.min() * (1 - 1e-12) <= found.min() <= found.max() <= ramp.max() * (1 + 1e-12)


def test_values_of_another_place_are_refused(tmp_path: Path) -> None:
    file = film(tmp_path)
    other = nt.Topography(HEIGHTS, (1.1 * SIDE / N, 1.1 * SIDE / N))
    values = read_values(file, "DMT modulus", "youngs_modulus")
    with pytest.raises(InvalidValue, match="not of one place"):
        nt.Surface.touched_by(Scene(**DRY), other, youngs_modulus=values)
    with pytest.raises(InvalidValue, match="was read as youngs_modulus"):
        nt.Surface.touched_by(Scene(**DRY), nt.images.read(file), work_of_adhesion=values)


@pytest.mark.parametrize("given", ["alone", "with a modulus"])
def test_a_measured_pull_off_is_that_of_the_plan_there(given: str) -> None:
    """Beside a van der Waals tail and a potential: at 12 pixels a plan over a level surface of that w and E."""
    scene = Scene(**DRY)
    scene.adhesion.contact_potential = 0.3
    level = nt.Topography(np.zeros((12, 12)), (1e-9, 1e-9))
    forces = RNG.uniform(2e-9, 20e-9, (12, 12))
    moduli = 10.0 ** RNG.uniform(8.0, 10.5, (12, 12))
    made_of = {"youngs_modulus": moduli} if given == "with a modulus" else {}
    surface = nt.Surface.touched_by(scene, level, pull_off_force=forces, **made_of)
    assert surface.work_of_adhesion is not None
    for j, i in RNG.integers(0, 12, (12, 2)):
        one = {"work_of_adhesion": surface.work_of_adhesion[j, i]} | {k: v[j, i] for k, v in made_of.items()}
        tiny = nt.Surface(nt.Topography(np.zeros((4, 4)), (1e-9, 1e-9)),
                          **{k: np.full((4, 4), v) for k, v in one.items()})  # fmt: skip
        assert scene.plan(bound="exact", surface=tiny).pull_off_force == pytest.approx(forces[j, i], rel=0.01)


def test_a_force_that_no_adhesion_makes_is_refused() -> None:
    level = nt.Topography(np.zeros((4, 4)), (1e-9, 1e-9))
    scene = Scene(**DRY | {"adhesion": {"hamaker_constant": 1e-20, "contact_potential": 5.0}})
    with pytest.raises(InvalidValue, match="pull"):
        nt.Surface.touched_by(scene, level, pull_off_force=np.full((4, 4), 1e-10))


def test_an_effective_modulus_is_that_of_the_contact() -> None:
    scene = Scene(**DRY)
    level = nt.Topography(np.zeros((4, 4)), (1e-9, 1e-9))
    surface = nt.Surface.touched_by(scene, level, effective_modulus=np.full((4, 4), 5e9))
    assert surface.youngs_modulus is not None
    tip = (1 - scene.tip.poisson_ratio**2) / scene.tip.youngs_modulus
    sample = (1 - scene.sample.poisson_ratio**2) / surface.youngs_modulus[0, 0]
    assert 1.0 / (tip + sample) == pytest.approx(5e9, rel=1e-12)
    with pytest.raises(InvalidValue, match="give one of them"):
        nt.Surface.touched_by(scene, level, effective_modulus=np.full((4, 4), 5e9), youngs_modulus=np.full((4, 4), 5e9))


def test_a_toml_file_names_them_for_plan_touch_and_live(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None
) -> None:
    """All three have the surface of the arrays; the recording names files and digests, from which it is made again."""
    pytest.importorskip("mcap")
    film(tmp_path)
    toml = tmp_path / "film.toml"
    toml.write_text(TOML, encoding="utf-8")
    by_hand = nt.Surface.touched_by(
        Scene(**DRY), nt.images.prepare(nt.images.read(tmp_path / "film.gwy"), "none")[0],
        youngs_modulus=MODULUS, work_of_adhesion=WORK,
    )  # fmt: skip
    expected = str(Scene.from_toml(toml).plan(surface=by_hand))
    assert main(["plan", str(toml)]) == 0
    said = capsys.readouterr().out
    assert said.startswith(expected)
    assert "youngs modulus: 1 GPa .. 10 GPa, channel 'DMT modulus' of film.gwy" in said
    subject = files.of(str(toml))
    assert str(subject.scene.plan(surface=subject.touched(subject.scene))) == expected
    arguments = ["touch", "--scene", str(toml), "--duration", "1s", "--no-window", "--out", str(tmp_path / "out")]
    assert main(arguments) == 0
    recording = nt.record.read(tmp_path / "out" / "recording.mcap")
    assert recording.metadata["plan"][0] == expected.splitlines()[0]
    replayed = recording.replay()
    np.testing.assert_array_equal(replayed.columns["motor_force"], recording.columns["motor_force"])
    named = SurfaceFile(**recording.metadata["surface"])
    again = named.touched_by(Scene(**dict(recording.metadata["scene"].items())))
    np.testing.assert_array_equal(again.work_of_adhesion, by_hand.work_of_adhesion)
    assert again.height(1e-7, 2e-7) == by_hand.height(1e-7, 2e-7)
    assert pickle.loads(pickle.dumps(again)).origin == json.loads(json.dumps(recording.metadata["surface"]))
    film(tmp_path, 1.5 * MODULUS)
    with pytest.raises(InvalidValue, match="it has changed since"):
        named.touched_by(Scene(**DRY))


def test_a_scene_file_names_them_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, toml = film(tmp_path), tmp_path / "film.toml"
    toml.write_text(TOML, encoding="utf-8")
    for arguments, sentence in (
        (["plan", str(toml), "--image", str(file)], "give it or an IMAGE, not both"),
        (["touch", "--scene", str(toml), "--surface", "dots"], "not both"),
    ):
        assert main(arguments) == 2
        assert sentence in capsys.readouterr().err


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ('[surface]\nyoungs_modulus = "E"', "[surface] lacks image"),
        ("[surface]\nimage = 3", "[surface] image = 3: it must be a text"),
        ('[surface]\nimage = "a.gwy"\nmodulus = "E"', "[surface] has no key modulus"),
        ('[surface]\nimage = "a.gwy"\nyoungs_modulus_unit = "GPa"', "no channel is named for youngs_modulus"),
    ],
)
def test_tables_that_are_wrong(table: str, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    toml = tmp_path / "x.toml"
    toml.write_text(table, encoding="utf-8")
    assert main(["plan", str(toml)]) != 0
    assert sentence in capsys.readouterr().err


def test_untrusted_files_are_read_in_a_worker(tmp_path: Path) -> None:
    file = film(tmp_path)
    found = read_values(file, "Adhesion", "work_of_adhesion", untrusted=True)
    np.testing.assert_array_equal(found.values, WORK)


def test_a_fitted_map_gives_what_it_has_found(tmp_path: Path) -> None:
    maps = pytest.importorskip("nanotouch.maps")
    pytest.importorskip("h5netcdf")
    pytest.importorskip("nanotouch._fit")
    from test_maps import SETTINGS, pattern, volume

    data = maps.fit(volume(6), model="maugis", **SETTINGS)
    data["effective_modulus"].values[2, 3] = np.nan
    file = tmp_path / "map.nc"
    maps.write(file, data)
    with pytest.raises(ReadError, match="1 of 36 pixels of 'effective_modulus' have no effective_modulus"):
        read_values(file, "effective_modulus", "effective_modulus", pixel_size=1e-8)
    found = read_values(file, "effective_modulus", "effective_modulus", pixel_size=1e-8, fill_by="neighbours")
    known = np.isfinite(data["effective_modulus"].values)
    np.testing.assert_allclose(found.values[known], pattern(6)[0][known], rtol=0.2)
    with pytest.raises(ReadError, match="no quantity 'hardness' of each place; it holds"):
        read_values(file, "hardness", "youngs_modulus")


@pytest.mark.skipif(not (DATA / "corpus/images/fdc_image_1.ibw").exists(), reason="no real data here")
def test_a_real_map_of_adhesion_is_touched() -> None:
    """Asylum's force map of 26 x 26: its MapAdhesion is a force, whose unit the file does not state."""
    scene = Scene(**DRY | {"tip": {"radius": 500e-9}, "range": {"maximum_load": 200e-9}})
    named = SurfaceFile(str(DATA / "corpus/images/fdc_image_1.ibw"), properties={"pull_off_force": "MapAdhesion"},
                        units={"pull_off_force": "N"})  # fmt: skip
    surface = named.touched_by(scene)
    assert scene.plan(surface=surface).pull_off_force == pytest.approx(71.14e-9, rel=0.01)  # the least of the map
    assert surface.notes[-1].startswith("pull off force: 71.1 nN .. 509 nN, channel 'MapAdhesion'")
    blunt = {"tip": {"radius": 500e-9}, "range": {"maximum_load": 200e-9}}
    soft = Scene(**DRY | blunt | {"sample": {"youngs_modulus": 2e9}})
    touched = named.touched_by(soft)
    with pytest.raises(InvalidValue, match="deforms under van der Waals before contact"):
        soft.plan(surface=touched)
    told = next(warning for warning in soft.plan(bound="exact", surface=touched).warnings if "jumps" in warning.text)
    assert told.value > told.limit == 0.55
    assert np.isfinite(told.value)
