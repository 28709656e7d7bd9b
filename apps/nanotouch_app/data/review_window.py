# SPDX-License-Identifier: BSD-3-Clause
"""A window for :class:`nanotouch.batch.Review`: contact point and baseline are dragged, keys decide."""

from __future__ import annotations

from typing import Any

import numpy as np
from nanotouch.batch import Review
from nanotouch.errors import Error

_NEAR = 0.02  # of the width: from there on a line is grabbed
_NM = 1e-9
BLUE, VERMILION = "#0072B2", "#D55E00"
_WITHOUT_WINDOW = ("agg", "cairo", "pdf", "pgf", "ps", "svg", "template")
REASON = "rejected by hand"


class Board:
    """What is drawn of a review on a matplotlib figure, and what mouse and keys do there."""

    def __init__(self, review: Review, figure: Any) -> None:
        self.review, self.figure, self.number = review, figure, 0
        self.panel = figure.add_subplot()
        self.grabbed: str | None = None
        self.lines: dict[str, float] = {}
        for event, act in (("button_press_event", self._press), ("button_release_event", self._release),
                           ("key_press_event", self._key)):  # fmt: skip
            figure.canvas.mpl_connect(event, act)
        self.draw()

    @property
    def place(self) -> Any:
        """The curve that is shown."""
        return self.review.places[self.number]

    def draw(self) -> None:
        """The curve as it is decided now."""
        place, decision = self.place, self.review.decision(self.place)
        panel, curve, result = self.panel, place.curve, self.review.fitted(place)
        panel.clear()
        for segment in curve.segments:
            if segment.force is not None:
                panel.plot(segment.z / _NM, segment.force / _NM, lw=0.7, label=segment.role)
        reach = np.concatenate([segment.z for segment in curve.segments])
        low, high = decision.baseline or (float(np.quantile(reach, 0.5)), float(reach.max()))
        contact = decision.contact_point
        told = result if isinstance(result, str) else f"{result.status}, rating {result.rating:.1f}"
        if contact is None:
            contact = float(reach.min()) if isinstance(result, str) else float(result.report.contact_point)
        self.lines = {"contact": contact, "low": low, "high": high}
        for name, z in self.lines.items():
            held = decision.contact_point if name == "contact" else decision.baseline
            panel.axvline(z / _NM, color=VERMILION if name == "contact" else BLUE, ls=":" if held is None else "-")
        verdict = f"EXCLUDED: {decision.exclude}" if decision.exclude else "kept"
        panel.set_title(
            f"{self.number + 1}/{len(self.review.places)} {place.name}: {verdict}\n{told}", parse_math=False, fontsize=9
        )
        panel.set_xlabel("z (nm)")
        panel.set_ylabel("force (nN)")
        panel.legend(fontsize=8)
        self.figure.canvas.draw_idle()

    def _press(self, event: Any) -> None:
        if event.inaxes is not self.panel or event.xdata is None:
            return
        left, right = self.panel.get_xlim()
        distance = {name: abs(z / _NM - event.xdata) / abs(right - left) for name, z in self.lines.items()}
        name = min(distance, key=distance.__getitem__)
        self.grabbed = name if distance[name] < _NEAR else None

    def _release(self, event: Any) -> None:
        name, self.grabbed = self.grabbed, None
        if name is None or event.xdata is None:
            return
        self.lines[name] = event.xdata * _NM
        try:
            if name == "contact":
                self.review.decide(self.place, contact_point=self.lines[name])
            else:
                self.review.decide(self.place, baseline=(self.lines["low"], self.lines["high"]))
        except Error as error:  # ends that cross: drawn again as they were
            self.draw()
            self._tell(error)
        else:
            self.draw()

    def _tell(self, error: Error) -> None:
        """Why a decision was not written."""
        self.panel.set_title(str(error), parse_math=False, fontsize=9, color=VERMILION, wrap=True)
        self.figure.canvas.draw_idle()

    def _key(self, event: Any) -> None:
        place = self.place
        if event.key == "q":
            self.figure.canvas.manager.destroy()
            return
        try:
            if event.key in ("k", "x"):
                self.review.decide(place, exclude="" if event.key == "k" else REASON)
            elif event.key == "u":
                self.review.decide(place, exclude="", contact_point=None, baseline=None)
        except Error as error:
            self._tell(error)
            return
        step = {"k": 1, "x": 1, "right": 1, "left": -1}.get(event.key, 0)
        self.number = min(max(self.number + step, 0), len(self.review.places) - 1)
        self.draw()


def show(review: Review) -> None:
    """A window until it is closed; Error where there is no display."""
    import matplotlib.pyplot as plt

    for key in ("keymap.save", "keymap.quit", "keymap.back", "keymap.forward", "keymap.xscale"):
        plt.rcParams[key] = []
    if plt.get_backend().lower() in _WITHOUT_WINDOW:
        raise Error("no window can be opened here: leave out --show, and decide in the terminal")
    figure = plt.figure(figsize=(9.0, 5.5))
    board = Board(review, figure)
    plt.show()
    del board
