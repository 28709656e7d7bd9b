# SPDX-License-Identifier: BSD-3-Clause
"""``--trusted`` and ``--calibration`` on the commands that open files, which are guarded by default."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
import synthetic

for module in ("SurfaceTopography", "cv2", "afmformats"):
    pytest.importorskip(module)

from nanotouch._io import worker  # noqa: E402
from nanotouch_app.main import main  # noqa: E402

linux = pytest.mark.skipif(sys.platform != "linux", reason="the worker runs on Linux")


@linux
@pytest.mark.parametrize("kind", ["image", "curve", "neither"])
def test_info_says_the_same_with_the_guard(tmp_path: Path, kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "file.ibw"
    if kind == "image":
        synthetic.write_ibw_image(path, {"HeightTrace": synthetic.asymmetric()}, 1.25e-7)
    elif kind == "curve":
        synthetic.write_ibw_curve(path, synthetic.known_curve(n=100))
    else:
        path.write_text("Call me Ishmael.\n")
    answers = [(main(["info", str(path), *extra]), capsys.readouterr()) for extra in (["--trusted"], [])]
    assert answers[0] == answers[1]
    assert answers[0][0] == (2 if kind == "neither" else 0)
    assert worker._current is not None


@linux
def test_fit_reads_with_the_guard_and_the_table(tmp_path: Path) -> None:
    pytest.importorskip("nanotouch._fit", reason="built without Ceres")
    pytest.importorskip("matplotlib")
    file = synthetic.write_ibw_curve(tmp_path / "curve.ibw", synthetic.known_curve())
    table = tmp_path / "table.csv"
    table.write_text("file,spring_constant,sensitivity\n*.ibw,1.6N/m,\n")
    found = []
    for number, extra in enumerate((["--trusted"], [], ["--calibration", str(table)])):
        out = tmp_path / str(number)
        assert main(["fit", str(file), "--model", "jkr", "--radius", "30nm", "--out", str(out), *extra]) == 0
        found.append(json.loads((out / "fit.json").read_text())["pull_off_force_N"])
    assert found[1] == found[0]
    assert found[2] == pytest.approx(2.0 * found[0], rel=1e-6)
