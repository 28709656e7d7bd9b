# SPDX-License-Identifier: BSD-3-Clause
"""The lesson: five pages from van der Waals to Maugis' map, each predict, touch, explain. The answer is that of the
simulation, not of a table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from nanotouch_app.common.quantity import digits
from nanotouch_app.training.exercise import Exercise, touching
from nanotouch_app.training.lesson_pages import PAGES, Page
from nanotouch_app.training.lesson_texts import TEXTS


class LessonPage(Exercise):
    """One page. A prediction unlocks the touch; after the touch, and a second one after a change, it explains."""

    page: ClassVar[Page]

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.changes += [("scene", field, value) for field, value in self.page.changes]
        for field, value in self.page.changes:
            self.facts.scene[field] = value
        self.predicted: int | None = None
        self.pulls: list[float] = []
        self.lowest = 0.0

    def text(self, key: str) -> str:
        """Of this page."""
        return TEXTS[f"{self.page.key}.{key}"]

    @property
    def locked(self) -> bool:
        return self.predicted is None

    @property
    def words(self) -> str:
        return self.text("question") if self.locked else self.text("do")

    @property
    def now(self) -> str:
        return TEXTS["predict" if self.locked else "again" if self.pulls else "touch"]

    @property
    def choices(self) -> Sequence[str]:
        return self.text("choices").split("|") if self.locked else ()

    def choose(self, number: int) -> None:
        """The prediction."""
        if not self.locked:
            raise self.early("touch and let go first")
        if not 0 <= number < len(self.choices):
            raise self.early(f"choose one of {len(self.choices)}")
        self.predicted = number

    def judge(self, frames: Any) -> None:
        """Count touches; between the first and the second the world is changed."""
        if self.locked:
            return
        touched, needed = self.touches, 2 if self.page.then else 1
        for force, touches in zip(frames["tip_force"][:, 2], touching(frames), strict=True):
            self.lowest = min(self.lowest, float(force)) if touched or touches else 0.0
            if touched and not touches:
                self.pulls.append(-self.lowest)
                if len(self.pulls) == 1 and self.page.then is not None:
                    self.changes.append(self._then())
            touched = bool(touches)
        if len(self.pulls) >= needed and self.result is None:
            self._explain()

    def _then(self) -> tuple[str, str, float]:
        assert self.page.then is not None
        what, field, factor = self.page.then
        if what == "settings":
            return "scaled", field, factor
        return what, field, factor * float(self.facts.scene[field])

    def _explain(self) -> None:
        right, figures = self.page.right(self.facts)
        choices = self.text("choices").split("|")
        said = TEXTS["right"] if self.predicted == right else TEXTS["wrong"].format(wanted=choices[right])
        said += " " + self.text("explain").format(**figures)
        if self.page.key == "stick":
            first, second = (digits(pull, "N") for pull in self.pulls[:2])
            said += TEXTS["measured"].format(first=first, second=second)
        pulls = {f"pull-off {number + 1}": (pull, "N") for number, pull in enumerate(self.pulls[:2])}
        self.end(self.predicted == right, 100.0 * (self.predicted == right), said, pulls)


def _made(number: int, page: Page) -> type[LessonPage]:
    follows = f"lesson-{number + 2}" if number + 1 < len(PAGES) else ""
    about = {"page": page, "name": f"lesson-{number + 1}", "title": TEXTS[f"{page.key}.title"],
             "preset": page.preset, "follows": follows}  # fmt: skip
    return type(f"Page{number + 1}", (LessonPage,), about)


LESSON: tuple[type[LessonPage], ...] = tuple(_made(number, page) for number, page in enumerate(PAGES))
