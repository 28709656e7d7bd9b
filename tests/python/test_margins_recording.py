# SPDX-License-Identifier: BSD-3-Clause
"""Margins, energy and Z-width of recordings: with sensors that failed, without a gauge, of laws of one's own."""

from __future__ import annotations

import math
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import margins
from nanotouch._core import Signals


@pytest.mark.filterwarnings("ignore:the session was stopped")
def test_recording_with_a_dead_sensor() -> None:
    faults = nt.Faults().add("nan", "deflection", at=0.5, duration=1e-3)
    recording = nt.Session(faults=faults).run(2.0)
    assert not np.isfinite(recording.slave_force).all()
    felt = margins.of_recording(recording)
    assert felt.is_passive
    assert np.isfinite(felt.dissipated).all()
    assert math.isfinite(margins.force_range(recording).lowest)


def test_z_width_of_a_recording(tmp_path: Path) -> None:
    recording = nt.Session().run()
    width = margins.z_width(recording)
    low = width.frequency < 1.0  # below the mass's and the contact's own bandwidth
    assert width.free[low] == pytest.approx(width.drag, rel=0.1)
    felt = margins.of_recording(recording)
    spring = felt.felt_stiffness / (2.0 * math.pi * width.frequency)
    assert width.contact[low] == pytest.approx(spring[low], rel=0.15)
    assert (width.stable > width.passive).all()
    assert (width.passive[low] > width.contact[low]).all()
    nt.plots.z_width(recording, save=tmp_path / "z.png")
    assert (tmp_path / "z.png").stat().st_size > 10_000


def test_recording_of_a_law_of_ones_own() -> None:
    def stiff(signals: Signals) -> tuple[float, float]:
        reflected = signals.alpha_f * signals.felt_force
        return -reflected - 30.0 * (reflected - signals.smooth_force), signals.target

    scale = {"alpha_f": 3e6}  # K_f = 30 in the law leaves a margin of 1.4 at the scale of a first touch
    with pytest.raises(nt.Error, match=r"stability margin \(R5 noise\)"):
        nt.Session(control=stiff)
    session = nt.Session(control=stiff, gains=scale)
    settings = nt.Session(gains={"force_gain": 30.0, **scale}).settings
    same = margins.compute(session.rig, settings, session.plan.maximum_stiffness)
    assert session.margins().rule == same.rule
    assert session.margins()[:14] == pytest.approx(same[:14], rel=1e-6)
    recording = session.run(3.0)
    assert margins.of_recording(recording).margins.exact_limit == pytest.approx(same.exact_limit, rel=1e-6)
    unknown = nt.Session(control=lambda _signals: (0.0, 0.0), minimum_margin=0.0)
    assert math.isnan(unknown.margins().least)
    assert "own law" in str(unknown.margins().refusal)
    recording = unknown.run(1.0)
    assert math.isnan(margins.of_recording(recording).margins.margin)
    with pytest.raises(nt.Error, match="own law"):
        margins.z_width(recording)
    assert math.isfinite(nt.Session(control=lambda _signals: (0.0, 0.0), mode="topography").stability_margin)


@pytest.mark.parametrize("column", ["master_position", "operator_force", "deflection", "slave_force"])
def test_energy_goes_on_where_a_sensor_has_failed(column: str) -> None:
    whole = nt.Session().run(4.0)
    spoilt = {name: values.copy() for name, values in whole.columns.items()}
    spoilt[column][20_000:20_010] = math.nan
    felt = margins.of_recording(nt.Recording(spoilt, whole.metadata))
    # the last good reading stands for 1 ms
    assert felt.energy[-1] == pytest.approx(margins.of_recording(whole).energy[-1], rel=1e-3)
    assert felt.is_passive


def test_energy_without_a_gauge() -> None:
    rig = nt.Rig(master={"gauge": 0.0})
    recording = nt.Session(rig=rig).run()
    felt = margins.of_recording(recording)
    assert felt.is_passive
    # against the truth: the script's hand force on the master's way, known in the simulation only
    true = nt.Session(rig=nt.Rig(), control="impedance", seed=0).run()
    truth = margins.of_recording(true)
    # of the master's speed over 20 ms one step is 2 mm/s, 0.2 N behind its damping, beside a push of 2 N and less
    assert felt.energy[-1] == pytest.approx(truth.energy[-1], rel=0.3)
