# SPDX-License-Identifier: BSD-3-Clause
"""The commands of docs/measured.md, as they stand there, on files with a known answer."""

from __future__ import annotations

import csv
import re
import shlex
from pathlib import Path

import draws
import nanotouch as nt
import numpy as np
import pytest
from nanotouch.contact import Contact
from nanotouch_app.main import main
from synthetic_images import write_nanoscope_image

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("afmformats")
pytest.importorskip("h5py")
pytest.importorskip("matplotlib")
pytest.importorskip("SurfaceTopography")

PAGE = Path(__file__).resolve().parents[2] / "docs" / "measured.md"
SOFT, HARD, CURVES = 5e3, 2e4, draws.count(40, 100)  # Pa


def commands() -> dict[str, list[str]]:
    """The arguments of each command by its name."""
    if not PAGE.is_file():
        pytest.skip("without the pages")
    found = re.findall(r"^```\n(nanotouch .*?)\n```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    assert all("\n" not in command for command in found)
    return {command.split()[1]: shlex.split(command)[1:] for command in found}


def a_group(folder: Path, modulus: float, seed: int) -> None:
    """One file of many curves of a gel whose modulus scatters log-normally by a factor of 1.3."""
    rng = np.random.default_rng(seed)
    made = []
    for number in range(CURVES):
        contact = Contact(1e-6, float(modulus * np.exp(np.log(1.3) * rng.standard_normal())), 0.0)
        made.append(
            nt.curves.synthesize(
                contact, "hertz", spring_constant=0.05, depth=0.6e-6, clearance=1.5e-6, points=300, noise=10e-12,
                seed=seed + number,
            )
        )  # fmt: skip
    folder.mkdir(parents=True)
    nt.curves.write(folder / "curves.h5", made)


@pytest.mark.slow
def test_many_curves_to_a_histogram(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    a_group(tmp_path / "gels" / "soft", SOFT, 10)
    a_group(tmp_path / "gels" / "hard", HARD, 5000)
    assert main(commands()["report"]) == 0
    said = capsys.readouterr().out
    assert f"{2 * CURVES} curves: {2 * CURVES} ok" in said
    with Path("nanotouch-out/results.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    for group, modulus in (("soft", SOFT), ("hard", HARD)):
        values = np.array([float(row["E* [Pa]"]) for row in rows if row["group"] == group])
        assert values.size == CURVES
        assert np.median(values) == pytest.approx(modulus, rel=0.1)  # 1.25 * 30 % / sqrt(100) is one sigma: 4 %
    page = Path("nanotouch-out/report.html").read_text()
    assert page.count("data:image/png") >= 2
    assert "Methods" in page


def test_an_image_to_roughness_and_grains(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Twelve dots of 6 nm on a tilted plane with offsets of its lines."""
    monkeypatch.chdir(tmp_path)
    rng = np.random.default_rng(4)
    y, x = np.mgrid[:200, :200] * 5e-9
    heights = 0.02 * x + 0.01 * y + 0.2e-9 * rng.standard_normal((200, 200)) + 0.5e-9 * rng.standard_normal((200, 1))
    for j in range(3):
        for i in range(4):
            near = (x - (0.12 + 0.25 * i) * 1e-6) ** 2 + (y - (0.17 + 0.33 * j) * 1e-6) ** 2
            heights += 6e-9 * np.exp(-0.5 * near / 15e-9**2)
    write_nanoscope_image(tmp_path / "dots.spm", heights, (1e-6, 1e-6))
    assert main(commands()["image"]) == 0
    with Path("nanotouch-out/grains.csv").open(newline="") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    assert len(rows) == 12
    assert {"image.png", "image.gwy", "image.json"} <= {path.name for path in Path("nanotouch-out").iterdir()}
    flat = nt.images.read("nanotouch-out/image.gwy")
    background = flat.heights[flat.heights < np.median(flat.heights) + 1e-9]
    assert background.std() < 0.35e-9
