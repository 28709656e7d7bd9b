# SPDX-License-Identifier: BSD-3-Clause
"""The five pages: what is changed, and how the simulation finds the right answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import nanotouch as nt
import numpy as np

from nanotouch_app.common.quantity import digits
from nanotouch_app.training.facts import Facts

Found = tuple[int, dict[str, str]]
"""which choice is right, and the figures of the explanation"""
SAME = 0.02  # a change of less than this is none


@dataclass(frozen=True)
class Page:
    """One of them; ``changes`` are made at its beginning, ``then`` between the two touches."""

    key: str
    preset: str
    right: Callable[[Facts], Found]
    then: tuple[str, str, float] | None = None
    """what, field, and by what it is multiplied"""
    changes: tuple[tuple[str, float], ...] = ()


def jump_gap(scene: nt.Scene, spring: float, accuracy: float = 0.01) -> float:
    """The largest gap at which attraction grows faster with nearness than a spring [N/m] pulls back [m]; 0: none."""
    gaps = np.geomspace(1e-11, 1e-7, 6000)
    steep = -scene.plan(relative_accuracy=accuracy).run(gaps, "approach").k > spring
    return float(gaps[steep].max(initial=0.0))


def _way(before: float, after: float) -> int:
    """0, 1, 2: smaller, the same, larger."""
    return 1 if abs(after - before) <= SAME * abs(before) else 2 * int(after > before)


def _changed(facts: Facts, field: str, value: float) -> nt.Scene:
    scene = facts.scene.copy()
    scene[field] = value
    return scene


def _jump(facts: Facts) -> Found:
    soft = 0.25 * facts.spring
    near, far = (jump_gap(facts.scene, spring, facts.accuracy) for spring in (facts.spring, soft))
    return _way(near, far), {"stiff": digits(facts.spring, "N/m"), "soft": digits(soft, "N/m"),
                             "near": digits(near, "m"), "far": digits(far, "m")}  # fmt: skip


def _stick(facts: Facts) -> Found:
    dry = _changed(facts, "medium.relative_humidity", 0.0).plan(relative_accuracy=facts.accuracy).pull_off_force
    return _way(facts.pull_off, dry), {"wet": digits(facts.pull_off, "N"), "dry": digits(dry, "N")}


def _deep(facts: Facts) -> Found:
    """The scene of this page has lost its adhesion; the explanation tells of the preset's own."""
    plan, load = facts.scene.plan(relative_accuracy=facts.accuracy), 0.4 * facts.load
    gaps = np.linspace(-1.5 * float(plan.explain()["largest_indentation"]), 0.0, 4001)
    depth = [float(np.interp(-part * load, -plan.force(gaps, "retract"), -gaps)) for part in (1.0, 2.0)]
    ratio = depth[1] / depth[0]
    sticky = _changed(facts, "adhesion.work_of_adhesion", RUBBER_ADHESION).plan(relative_accuracy=facts.accuracy)
    law = sticky.run(gaps, "retract")
    radius = float(np.interp(0.0, -law.F, law.a))
    choice = int(np.argmin(np.abs(np.log(np.array([2**0.5, 2 ** (2 / 3), 2.0]) / ratio))))
    return choice, {"ratio": f"{ratio:.2f}", "radius": digits(radius, "m")}


def _sticky(facts: Facts) -> Found:
    soft = facts.scene.plan(relative_accuracy=facts.accuracy).maugis_lambda
    stiffer = _changed(facts, "sample.youngs_modulus", STIFFER * facts.scene.sample.youngs_modulus)
    stiff = stiffer.plan(relative_accuracy=facts.accuracy).maugis_lambda
    return _way(soft, stiff), {"soft": digits(soft, "", 3), "stiff": digits(stiff, "", 3)}


def _felt(facts: Facts) -> Found:
    """With the paper's rig, whose master has a motor."""
    rig = nt.Rig()
    settings, stiffness = nt.Settings.for_rig(rig), facts.scene.plan(relative_accuracy=facts.accuracy).maximum_stiffness
    before = nt.margins.compute(rig, settings, stiffness).margin
    settings["gains.alpha_f"] = 0.5 * settings.gains.alpha_f
    after = nt.margins.compute(rig, settings, stiffness).margin
    return _way(before, after), {"before": digits(before, "", 3), "after": digits(after, "", 3)}


RUBBER_ADHESION = float(nt.presets.silicone_rubber()[0].adhesion.work_of_adhesion)  # [J/m^2]
STIFFER = 20.0

PAGES = (
    Page("jump", "mica_in_air", _jump, ("settings", "gains.coupling_stiffness", 0.2)),
    Page("stick", "silicon_in_air", _stick, ("scene", "medium.relative_humidity", 0.0)),
    Page("deep", "silicone_rubber", _deep, None, (("adhesion.work_of_adhesion", 0.0),)),
    Page("sticky", "silicone_rubber", _sticky, ("scene", "sample.youngs_modulus", STIFFER)),
    Page("felt", "silicon_in_air", _felt, ("settings", "gains.alpha_f", 0.5)),
)
