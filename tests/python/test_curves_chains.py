# SPDX-License-Identifier: BSD-3-Clause
"""Contour lengths of ruptures, on curves pulled by the exact worm-like chain and by Langevin's function."""

from __future__ import annotations

import chain_oracle
import draws
import numpy as np
import pytest
from nanotouch import curves
from nanotouch.curves.chain import worm_like
from nanotouch.errors import InvalidValue

K_T, STIFFNESS = 1.380649e-23 * 298.15, 0.05
PART, FORCE = chain_oracle.worm_like_table()


def pulled(
    seed: int, contours: tuple[float, ...], ends: tuple[float, ...], segment: float, kind: str, noise: float = 8e-12
) -> curves.ForceCurve:
    """A stiff contact at z = 0 and chains that hold one after the other, each to its force."""
    rng = np.random.default_rng(seed)
    z = np.linspace(-50e-9, 600e-9, 2000)
    force = STIFFNESS * np.maximum(-z, 0.0)
    pull, start = np.zeros(z.size), 0.0
    for contour, end in zip(contours, ends, strict=True):
        tension = np.geomspace(1e-16, end, 3000)
        if kind == "worm-like":
            part = np.interp(tension * segment / K_T, FORCE, PART)
        else:
            argument = tension * segment / K_T
            part = 1.0 / np.tanh(argument) - 1.0 / argument
        height = contour * part + tension / STIFFNESS
        inside = (z > start) & (z <= height[-1])
        pull[inside] = np.interp(z[inside], height, tension, left=0.0)
        start = float(height[-1])
    parts = []
    for role, order, by in (("approach", slice(None, None, -1), 0.0 * z), ("retract", slice(None), pull)):
        measured = (force - by)[order] + rng.normal(0.0, noise, z.size)
        time = np.arange(z.size) * 5e-4 + (2.0 if role == "retract" else 0.0)
        parts.append(curves.Segment(role, time, z[order], "height (measured)", measured))  # type: ignore[arg-type]
    return curves.ForceCurve(tuple(parts), {"spring constant": STIFFNESS}, "chain")


def test_the_law_is_the_exact_chain() -> None:
    inside = (FORCE > 0.0) & (PART < 0.97)
    np.testing.assert_allclose(worm_like(PART[inside]), FORCE[inside], rtol=4e-3)


@pytest.mark.parametrize(("kind", "segment"), [("worm-like", 0.4e-9), ("freely-jointed", 0.8e-9)])
def test_three_chains_give_their_contour_lengths(kind: str, segment: float) -> None:
    contours = (120e-9, 240e-9, 400e-9)
    pulls, lengths = [], []
    for seed in range(4):
        curve = pulled(seed, contours, (200e-12, 250e-12, 300e-12), segment, kind)
        found = curves.chains(curve, curves.analyse(curve), kind, segment_length="free")  # type: ignore[arg-type]
        assert len(found) == 3
        for chain, truth in zip(found, contours, strict=True):
            assert chain.misfit < 1.5
            assert abs(chain.contour_length / truth - 1.0) < 0.05
            pulls.append((chain.contour_length - truth) / chain.contour_length_sigma)
            lengths.append((chain.segment_length - segment) / chain.segment_length_sigma)
    for errors in (np.array(pulls), np.array(lengths)):
        assert 0.4 < np.sqrt(np.mean(errors**2)) < 1.5
        assert np.mean(np.abs(errors) < 1.96) > 0.8


@pytest.mark.parametrize(("kind", "segment"), [("worm-like", 0.4e-9), ("freely-jointed", 0.8e-9)])
def test_contour_lengths_have_no_bias(kind: str, segment: float) -> None:
    """On a stiff sample the contact's place was 0.4 nm inside, and every chain by as much too long."""
    contours, errors = (120e-9, 240e-9, 400e-9), []
    for seed in range(20, 20 + draws.count(5, 12)):
        curve = pulled(seed, contours, (200e-12, 250e-12, 300e-12), segment, kind)
        found = curves.chains(curve, curves.analyse(curve), kind, segment_length="free")  # type: ignore[arg-type]
        errors += [chain.contour_length - truth for chain, truth in zip(found, contours, strict=True)]
    assert abs(np.mean(errors)) < 3.0 * np.std(errors) / np.sqrt(len(errors)) + 0.1e-9


def test_a_plateau_is_no_chain_and_a_weak_rupture_says_nothing() -> None:
    curve = pulled(1, (400e-9,), (300e-12,), 0.4e-9, "worm-like")
    z, retract = curve.segments[1].z, curve.segments[1]
    rng = np.random.default_rng(2)
    force = STIFFNESS * np.maximum(-z, 0.0) - 2e-10 * ((z > 4e-9) & (z < 300e-9)) + rng.normal(0.0, 8e-12, z.size)
    held = curves.Segment("retract", retract.time, z, retract.z_channel, force)
    plateau = curves.ForceCurve((curve.segments[0], held), curve.meta, "plateau")
    for chain in curves.chains(plateau, curves.analyse(plateau)):
        assert np.isnan(chain.contour_length)
        assert not chain.misfit < 3.0


def test_a_held_segment_length_and_what_is_refused() -> None:
    curve = pulled(3, (300e-9,), (250e-12,), 0.4e-9, "worm-like")
    report = curves.analyse(curve)
    (chain,) = curves.chains(curve, report, segment_length=0.4e-9)
    assert chain.segment_length == pytest.approx(0.4e-9)
    assert chain.segment_length_sigma == 0.0
    (usual,) = curves.chains(curve, report)
    assert usual == chain
    (free,) = curves.chains(curve, report, segment_length="free")
    assert chain.contour_length_sigma < free.contour_length_sigma
    assert chain.contour_length == pytest.approx(300e-9, rel=0.02)
    with pytest.raises(InvalidValue, match="worm-like, freely-jointed"):
        curves.chains(curve, report, "rubber")  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="segment_length"):
        curves.chains(curve, report, segment_length=1.0)
    with pytest.raises(InvalidValue, match="temperature"):
        curves.chains(curve, report, temperature=25000.0)


def test_lengths_never_fall_within_a_pull() -> None:
    """Steps 1 nm apart, within the noise of their lengths: as a free persistence length has it, they fell."""
    for seed in range(4):
        curve = pulled(seed, (300e-9, 301e-9, 302e-9), (100e-12, 160e-12, 250e-12), 0.4e-9, "worm-like", 20e-12)
        found = curves.chains(curve, curves.analyse(curve))
        lengths = [chain.contour_length for chain in found if np.isfinite(chain.contour_length)]
        assert lengths
        assert np.all(np.diff(lengths) >= 0.0)
        assert all(abs(length / 301e-9 - 1.0) < 0.1 for length in lengths)
