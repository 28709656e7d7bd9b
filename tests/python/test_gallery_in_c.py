# SPDX-License-Identifier: BSD-3-Clause
"""Programs in C beside examples of the gallery print the curves that the example draws."""

from __future__ import annotations

import runpy
import subprocess
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.lines import Line2D

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = sorted((ROOT / "docs/examples/gallery").glob("*.c"))
BUILT = ROOT / "build/dev/apps/c"


def curves(lines: list[Line2D], columns: int) -> np.ndarray:
    """Of a figure's lines: one after the other in two columns, or side by side over places that all share."""
    drawn = [np.column_stack([line.get_xdata(), line.get_ydata()]) for line in lines if len(line.get_xdata()) > 2]
    if columns == 2:
        return np.concatenate(drawn)
    assert all(np.array_equal(one[:, 0], drawn[0][:, 0]) for one in drawn)
    return np.column_stack([drawn[0][:, 0], *(one[:, 1] for one in drawn)])


@pytest.mark.parametrize("source", PROGRAMS, ids=lambda path: path.stem)
def test_a_program_prints_what_the_example_draws(source: Path) -> None:
    program = BUILT / source.stem
    if not program.exists():
        pytest.skip(f"{program.relative_to(ROOT)} is not built: make test builds it")
    said = subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout
    printed = np.array([line.split() for line in said.splitlines()], dtype=float)
    with mpl.rc_context({"backend": "agg"}):
        figure = runpy.run_path(str(source.with_suffix(".py")))["figure"]
    expected = curves(figure.axes[0].get_lines(), printed.shape[1])
    np.testing.assert_allclose(printed, expected, rtol=1e-9, atol=1e-9)  # 12 digits are printed


def test_there_are_some() -> None:
    assert len(PROGRAMS) >= 6
