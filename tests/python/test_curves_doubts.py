# SPDX-License-Identifier: BSD-3-Clause
"""What a curve says against itself is told, and what is as it should be is not; movements in several parts."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
import synthetic
from nanotouch import curves
from nanotouch.curves.doubts import doubts

K = 0.05
KNOWN = synthetic.known_curve()


def curve(approach: np.ndarray, retract: np.ndarray, **meta: float) -> curves.ForceCurve:
    z = np.linspace(2e-6, 0.0, approach.size)
    nothing = np.full(approach.size, np.nan)
    segments = (curves.Segment("approach", nothing, z, "height (measured)", approach),
                curves.Segment("retract", nothing, z[::-1], "height (measured)", retract))  # fmt: skip
    return curves.ForceCurve(segments, {"spring constant": K, **meta})


def indentation(noise: float = 0.0, seed: int = 0) -> np.ndarray:
    depth = np.clip(5e-7 - np.linspace(2e-6, 0.0, 1000), 0.0, None)
    return 3e10 * depth**1.5 * 1e-10 + np.random.default_rng(seed).normal(0.0, noise, 1000)


@pytest.mark.parametrize("noise", [0.0, 1e-12, 2e-11])
def test_a_saturated_detector(noise: float) -> None:
    force = indentation(noise)
    (note,) = doubts(curve(np.minimum(force, 0.8 * force.max()), force[::-1]))
    assert note.startswith("saturated: the largest")
    assert "approach" in note


def test_a_dip_that_the_detector_could_not_follow() -> None:
    back = indentation(1e-12, 1)[::-1].copy()
    back[250:300] = -4e-10
    (note,) = doubts(curve(indentation(1e-12), back))
    assert "the smallest 50 readings of the retract" in note


def test_an_inverted_deflection() -> None:
    force = indentation(1e-12)
    (note,) = doubts(curve(-force, -force[::-1]))
    assert "the sign of the deflection looks inverted" in note


def test_a_height_that_counts_the_other_way() -> None:
    force = indentation(1e-12)
    (note,) = doubts(curve(force[::-1], force))
    assert "its height looks reversed" in note
    tilted = np.linspace(0.0, 1e-9, 1000)  # a baseline with a tilt, and nothing touched
    assert doubts(curve(tilted[::-1], tilted)) == doubts(curve(tilted, tilted[::-1])) == ()


def test_an_approach_that_never_reached_its_trigger() -> None:
    force = np.random.default_rng(0).normal(0.0, 1e-11, 1000)
    (note,) = doubts(curve(force, force[::-1], setpoint=2e-9))
    assert note.startswith("no trigger: the approach ends at")


@pytest.mark.parametrize("seed", range(5))
def test_ordinary_curves_say_nothing(seed: int) -> None:
    """Adhesion, no contact, a coarse digitiser, a free lever without noise."""
    rng = np.random.default_rng(seed)
    force = indentation(1e-12, seed)
    back = force[::-1].copy()
    back[250:400] = np.linspace(-1e-9, 0.0, 150)
    coarse = np.round(rng.normal(0, 1, 1000)) * 1e-11
    cases = [(force * 0, force[::-1]), (rng.normal(0, 1e-11, 1000),) * 2, (coarse, coarse)]
    for there, here in cases:
        assert doubts(curve(there, here)) == ()
    for there, here in ((force, back), (indentation(), indentation()[::-1])):
        assert doubts(curve(there, here, setpoint=float(there.max()))) == ()


# --- several parts ----------------------------------------------------------------------------------------------------


def test_an_approach_in_two_parts_is_one(tmp_path: Path) -> None:
    z, force = KNOWN.approach_z, KNOWN.approach_force
    cut = z.size * 3 // 4
    segments = [("extend", z[:cut], force[:cut]), ("pause", np.full(40, z[cut]), np.full(40, force[cut])),
                ("extend", z[cut:], force[cut:]), ("retract", KNOWN.retract_z, KNOWN.retract_force)]  # fmt: skip
    path = synthetic.write_jpk(tmp_path / "a.jpk-force", segments)
    (found,) = curves.read(path)
    assert [segment.role for segment in found.segments] == ["approach", "pause", "approach", "retract"]
    assert found.approach is not None
    np.testing.assert_allclose(found.approach.z, z, atol=1e-13)
    assert len(found.parts("approach")) == 2
    whole = curves.read(synthetic.write_jpk(tmp_path / "b.jpk-force", [("extend", z, force), segments[3]]))[0]
    parts, one = curves.analyse(found), curves.analyse(whole)
    assert parts.contact_point == pytest.approx(one.contact_point, abs=1e-10)
    curves.write(tmp_path / "c.h5", [found])
    pytest.importorskip("afmformats")
    (again,) = curves.read(tmp_path / "c.h5")
    np.testing.assert_allclose(again.approach.z, z, atol=1e-13)  # type: ignore[union-attr]


def test_two_cycles_are_not_joined() -> None:
    z, nothing = np.linspace(1e-6, 0.0, 100), np.full(100, np.nan)
    parts = [curves.Segment(role, nothing, z[::turn], "height (measured)", z)  # type: ignore[arg-type]
             for role, turn in (("approach", 1), ("retract", -1), ("approach", 1), ("retract", -1))]  # fmt: skip
    found = curves.ForceCurve(tuple(parts))
    assert found.approach is parts[0]
    assert found.retract is parts[3]


@pytest.mark.parametrize("kind", ["float", "double"])
def test_jpks_floats_are_read_without_an_encoder(tmp_path: Path, kind: str) -> None:
    """As JPK's data processing saves them: ``type=float-data``, big-endian, already in volts."""
    segments = [("extend", KNOWN.approach_z, KNOWN.approach_force), ("retract", KNOWN.retract_z, KNOWN.retract_force)]
    whole = synthetic.write_jpk(tmp_path / "a.jpk-force", segments)
    saved = tmp_path / "b.jpk-force"
    with zipfile.ZipFile(whole) as old, zipfile.ZipFile(saved, "w") as new:
        for item in old.infolist():
            content = old.read(item)
            if item.filename.endswith("segment-header.properties"):
                lines = [line for line in content.decode().splitlines() if "vDeflection.data.encoder" not in line]
                content = "\n".join([*lines, f"channel.vDeflection.data.type={kind}-data"]).encode()
            if item.filename.endswith("vDeflection.dat"):
                volts = segments[int(item.filename.split("/")[1])][2] / (K * 6e-8)
                content = volts.astype({"float": ">f4", "double": ">f8"}[kind]).tobytes()
            new.writestr(item.filename, content)
    expected, found = curves.read(whole)[0], curves.read(saved)[0]
    for one, other in zip(expected.segments, found.segments, strict=True):
        np.testing.assert_allclose(other.force, one.force, atol=1e-6 * float(np.ptp(one.force)))  # type: ignore[arg-type]


def asylum(path: Path, indexes: str, direction: str = "", **note: object) -> Path:
    z = np.concatenate([np.linspace(2e-6, 0.0, 1001), np.zeros(200), np.linspace(0.0, 2e-6, 999)])
    bent = np.clip(5e-7 - z, 0.0, None)
    facts: dict[str, object] = {"InvOLS": 6e-8, "SpringConstant": 0.5, "Indexes": indexes}
    facts |= {"Direction": direction} if direction else {}
    return synthetic.write_ibw(path, np.stack([-z, bent, -z], axis=-1), ["Raw", "Defl", "ZSnsr"], note=facts | note)


@pytest.mark.parametrize("direction", ["", "NaN,1,0,-1"])
def test_a_dwell_in_an_asylum_note(tmp_path: Path, direction: str) -> None:
    pytest.importorskip("igor2")
    (found,) = curves.read(asylum(tmp_path / "a.ibw", "0,1000,1200,2199", direction))
    assert [(segment.role, len(segment)) for segment in found.segments] == [
        ("approach", 1001), ("pause", 200), ("retract", 999),
    ]  # fmt: skip
    assert "setpoint" not in found.meta  # the note states no trigger point, and is read all the same


def test_an_asylum_note_that_does_not_fit_is_told(tmp_path: Path) -> None:
    pytest.importorskip("igor2")
    (found,) = curves.read(asylum(tmp_path / "a.ibw", "0,5000,9000"))
    assert "do not fit 2200 points" in found.meta["notes"][0]
    assert [segment.role for segment in found.segments] == ["approach", "pause", "retract"]  # as z goes


def test_what_follows_from_the_calibration_is_computed_from_it(tmp_path: Path) -> None:
    pytest.importorskip("igor2")
    path = asylum(tmp_path / "a.ibw", "0,1000,1200,2199", TriggerChannel="Force", TriggerPoint=2e-9)
    assert curves.read(path)[0].meta["setpoint"] == pytest.approx(2e-9)
    assert curves.read(path, spring_constant=1.0)[0].meta["setpoint"] == pytest.approx(4e-9)
    assert curves.read(path, sensitivity=3e-8)[0].meta["setpoint"] == pytest.approx(1e-9)
    (written,) = curves.read(path, spring_constant=1.0)
    curves.write(tmp_path / "b.ibw", [written])
    (again,) = curves.read(tmp_path / "b.ibw")
    assert again.meta["setpoint"] == pytest.approx(4e-9)
