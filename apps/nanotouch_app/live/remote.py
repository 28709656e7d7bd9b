# SPDX-License-Identifier: BSD-3-Clause
"""The way from a window to a session of another program: requests through shared memory, one lease at a time. The
session takes them between two ticks and answers; nobody waits."""

from __future__ import annotations

import copy
import json
import time
from typing import Any

import nanotouch as nt
from nanotouch.errors import DeviceError, Error
from nanotouch.touch.commands import Answer

from nanotouch_app.live.led import Hand
from nanotouch_app.live.reel import world_of

ARM, RESCALE, SETTING, SCENE = 2, 4, 6, 7  # nt_event_kind of session.h
WATCHED, LED = "watched: its program leads the hand", "your hand on the session of another program"
LEAD = "Scroll down until you feel it."
SIDEWAYS_HINT = "Drag over the surface: the device leads the height. Scroll to magnify."
SIDEWAYS = "its device leads z, your mouse x and y"
TAKEN = "another program drives this session; it may be asked again one second after its last request"
OVERTAKEN = -1  # the status of a request without an answer
LONGEST = 0.1  # what a hand does by itself in one turn [s]
Message = dict[str, Any]


class Lease:
    """Held while a hand is at work; it ends by itself a second after it was last used."""

    def __init__(self, name: str) -> None:
        self.client = nt.commands.attach(name)

    def take(self) -> None:
        """Take or renew it; :class:`~nanotouch.errors.Error` in words while another program holds it."""
        try:
            self.client.lease()
        except Error:
            raise Error(TAKEN) from None

    def close(self) -> None:
        """Let go."""
        self.client.close()


class Remote:
    """Changes, stop and arm of a session that this window does not lead; with ``leads`` its hand, too, with
    ``sideways`` in x and y alone."""

    def __init__(
        self, name: str, observer: nt.frames.Observer, leads: bool = False, sideways: bool = False
    ) -> None:  # fmt: skip
        self.name, self.observer, self.leads, self.sideways = name, observer, leads or sideways, sideways
        self.hand: Hand | None = None
        self.turned = time.monotonic()
        self.lease = Lease(name)
        self.asked: dict[int, Message] = {}
        self.described = 0
        self.world: Message = {}
        self._changed = False

    def news(self) -> Message | None:
        """The world, if it is another one than at the last call: the session has said so, whoever changed it."""
        if self.observer.changes != self.described:
            text, self.described = self.observer.description, self.observer.changes
            self.world, self._changed = world_of(json.loads(text), self.name, self._source()), True
            hint = SIDEWAYS_HINT if self.sideways else LEAD
            self.world["hint"] = hint if self.leads else ""
            self.world["leads"] = "xy" if self.sideways else "xyz" if self.leads else ""
            self.hand = None  # it begins anew where it is, in the world as it is now
        changed, self._changed = self._changed, False
        return copy.deepcopy(self.world) if changed else None

    def _source(self) -> str:
        return SIDEWAYS if self.sideways else LED if self.leads else WATCHED

    def ask(self, message: Message, frame: Any = None) -> None:
        """Post a request; what a window without a hand cannot ask is refused."""
        if message["do"] == "stop":
            self.lease.client.stop()
            return
        if self.leads and message["do"] in ("move", "wheel", "press", "retract"):
            self._lead(message, frame)
            return
        kind, field, values = self._request(message)
        self.lease.take()
        first, second = (*values, 0.0)[:2]
        self.asked[self.lease.client.post(kind, field, (first, second, 0.0, 0.0))] = message

    def _lead(self, message: Message, frame: Any) -> None:
        """Move the hand, from where it is at its first move."""
        if self.sideways and message["do"] != "move":
            raise Error("the device leads the height; drag to lead x and y")
        if frame is None or not self.world:
            return
        self.lease.take()
        if self.hand is None:
            self.hand = Hand(self.world, frame, self._post, self.sideways)
        self.hand.answer(message, frame)

    def _post(self, kind: int, field: int, values: tuple[float, float, float, float]) -> None:
        self.asked[self.lease.client.post(kind, field, values)] = {"do": "move"}

    def turn(self, frame: Any) -> list[Message]:
        """Some ten times a second: the hand goes on by itself; what is to be told of answers and of the world."""
        elapsed, self.turned = time.monotonic() - self.turned, time.monotonic()
        told: list[Message] = []
        if self.hand is not None and frame is not None and not self.sideways:
            try:
                self.hand.follow(frame, min(elapsed, LONGEST))
            except Error as error:  # another program has taken the lease
                self.hand = None
                told.append({"tell": "refused", "why": str(error)})
        told += [
            {"tell": "refused", "why": f"refused: {answer.message}", "field": message.get("field")}
            for message, answer in self.answers() if answer.status
        ]  # fmt: skip
        world = self.news()
        return told if world is None else [*told, world]

    def _request(self, message: Message) -> tuple[int, int, list[float]]:
        match message["do"]:
            case "arm":
                return ARM, 0, [1.0]
            case "change" if message["field"] in ("gains.alpha_p", "gains.alpha_f"):
                gains = self.world["settings"]["gains"]
                scales = {name: float(gains[name]) for name in ("alpha_p", "alpha_f")}
                scales[message["field"].removeprefix("gains.")] = float(message["value"])
                return RESCALE, 0, list(scales.values())
            case "change" if message["what"] in ("scene", "settings"):
                kind, fields = (SCENE, nt.Scene.fields) if message["what"] == "scene" else (SETTING, nt.Settings.fields)
                return kind, list(fields).index(message["field"]), [float(message["value"])]
        raise Error("this window watches: the program that has opened the session leads the hand")

    def answers(self) -> list[tuple[Message, Answer]]:
        """What has been decided since the last call."""
        found = [(asked, self._answer(asked)) for asked in self.asked]
        decided = [(self.asked.pop(asked), answer) for asked, answer in found if not answer.pending]
        for message, answer in decided:
            if message["do"] == "change" and not answer.status and self.world:
                section, key = message["field"].split(".")
                self.world[message["what"]][section][key] = message["value"]
                self._changed = True
        return decided

    def _answer(self, asked: int) -> Answer:
        """Pending, too, while the session stands still; a refusal where another program has taken the lease."""
        try:
            return self.lease.client.poll(asked)
        except DeviceError:
            return Answer(asked, 0, 0, True, "")
        except Error:
            return Answer(asked, 0, OVERTAKEN, False, TAKEN)

    def close(self) -> None:
        """Let go."""
        self.lease.close()
