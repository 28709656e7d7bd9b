# SPDX-License-Identifier: BSD-3-Clause
"""Tell the stiffer of two samples: the smallest difference of modulus that is felt, by a staircase."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from nanotouch_app.training.exercise import Exercise, Result
from nanotouch_app.training.staircase import RIGHT, Staircase
from nanotouch_app.training.task_texts import TEXTS

LOAD = 0.4  # of the largest one: where stiffness is told
DULL = 0.5  # the sample is stiffer than the lever if less than this part of 2/3 is felt


class Stiffer(Exercise):
    """A and B differ in their modulus alone. No answer is said to be right or wrong before the end."""

    name, title, preset = "stiffer", TEXTS["stiffer.title"], "cell_in_liquid"
    hides = frozenset({"law", "contact", "sliders"})

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.stairs = Staircase()
        self.modulus = float(self.facts.scene.sample.youngs_modulus)
        self.trials: list[dict[str, Any]] = []
        self.felt = ""
        self._deal()

    def _deal(self) -> None:
        self.stiff = "AB"[int(self.rng.integers(2))]
        self._show("A")

    def _show(self, letter: str) -> None:
        """The two lie around the scene's modulus, at equal distances on a logarithmic scale."""
        half = self.stairs.ratio**0.5
        self.felt = letter
        modulus = self.modulus * (half if letter == self.stiff else 1.0 / half)
        self.changes.append(("scene", "sample.youngs_modulus", modulus))

    @property
    def words(self) -> str:
        share = self.facts.felt_share(LOAD * self.facts.load)
        dull = TEXTS["stiffer.dull"] if share < DULL * 2.0 / 3.0 else ""
        return TEXTS["stiffer.words"].format(felt=f"{10 * share:.1f}") + dull

    @property
    def now(self) -> str:
        return TEXTS["stiffer.now"].format(felt=self.felt, pair=self.stairs.trials + 1)

    @property
    def choices(self) -> Sequence[str]:
        return TEXTS["stiffer.choices"].split("|")

    def judge(self, frames: Any) -> None:
        """Nothing is judged but the answers."""

    def choose(self, number: int) -> None:
        """Lay a sample, or answer."""
        if self.result is not None:
            return
        if self.touches:
            raise self.early(TEXTS["stiffer.early"])
        if number < 2:
            self._show("AB"[number])
            return
        answer = "AB"[number - 2]
        self.trials.append({"pair": self.stairs.trials + 1, "ratio of moduli": round(self.stairs.ratio, 6),
                            "stiffer": self.stiff, "answer": answer, "right": int(answer == self.stiff)})  # fmt: skip
        self.stairs.take(answer == self.stiff)
        if self.stairs.done:
            self._finish()
        else:
            self._deal()

    def _finish(self) -> None:
        """Weber fractions: of the modulus, and of what is felt through the spring."""
        ratio, load, facts = self.stairs.threshold, LOAD * self.facts.load, self.facts
        half = ratio**0.5
        felt = facts.felt_stiffness(load, half) / facts.felt_stiffness(load, 1.0 / half) - 1.0
        told = {"right": f"{100 * RIGHT:.0f}", "modulus": f"{100 * (ratio - 1):.0f}", "stiffness": f"{100 * felt:.1f}"}
        said = TEXTS["stiffer.said"].format(**told)
        self.changes.append(("scene", "sample.youngs_modulus", self.modulus))
        right = sum(trial["right"] for trial in self.trials) / len(self.trials)
        figures = {"Weber fraction of the modulus": (ratio - 1.0, ""), "Weber fraction of felt stiffness": (felt, ""),
                   "d ln k/d ln E": (facts.felt_share(load), ""), "right answers": (right, "")}  # fmt: skip
        self.result = Result(self.name, felt <= 0.15, 100.0 * min(1.0, 0.05 / max(felt, 1e-9)), said, figures,
                             self.trace, self.trials)  # fmt: skip
