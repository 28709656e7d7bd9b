# SPDX-License-Identifier: BSD-3-Clause
"""Lengths of images are told under the prefix that suits them."""

from __future__ import annotations

import numpy as np
import pytest
from nanotouch.images import Topography
from nanotouch.images.words import length, lengths, prefixed


@pytest.mark.parametrize(
    ("metres", "text"),
    [
        (0.0, "0 nm"), (-0.0, "0 nm"), (1.36e-10, "0.136 nm"), (2e-12, "0.002 nm"), (9.9999e-7, "1 µm"),
        (3.495e-5, "34.95 µm"), (-1.2e-6, "-1.2 µm"), (0.06, "60 mm"), (np.inf, "inf nm"),
    ],
)  # fmt: skip
def test_a_length_in_words(metres: float, text: str) -> None:
    assert length(metres) == text


def test_several_share_a_unit() -> None:
    assert lengths([0.03, 0.06]) == "30 x 60 mm"
    assert lengths([1.77e-7, 1.135e-6], between=" .. ") == "0.177 .. 1.135 µm"
    assert prefixed([1e-12, 5e-11]) == ("nm", pytest.approx(1e9))


def test_an_image_of_a_profiler_says_its_size() -> None:
    said = repr(Topography(np.linspace(0.0, 3.495e-5, 64).reshape(8, 8), (2e-4, 1e-4)))
    assert "0.8 x 1.6 mm" in said
    assert "34.95 µm" in said
