# SPDX-License-Identifier: BSD-3-Clause
"""What a page that may only watch sends: its rights are looked at before its words, and its refusals are few."""

from __future__ import annotations

import asyncio
import json
import random
import threading
from typing import Any

import pytest
from nanotouch.errors import InvalidValue
from nanotouch_app.browser.access import ASKED, checked

pytest.importorskip("aiohttp", reason="pip install 'nanotouch[browser]'")
from nanotouch_app.browser.readers import Reader
from nanotouch_app.browser.server import Server

ODD: list[Any] = [None, True, [], {}, [[]], "", "x" * 300, 10**400, -1, 0.5, 1e308, float("nan"), float("inf"),
                  "\ud800", {"a": 1}, [1, 2, 3], [1e300, 0, 0], [None] * 3]  # fmt: skip


def _message(dice: random.Random) -> Any:
    names = ["do", "name", "way", "steps", "on", "number", "text", "what", "field", "value"]
    made = {name: dice.choice(ODD) for name in dice.sample(names, dice.randint(0, len(names)))}
    if dice.random() < 0.8:
        made["do"] = dice.choice(list(ASKED))
    return dice.choice([made, made, made, dice.choice(ODD)])


def test_whatever_is_asked_is_taken_or_refused_in_words() -> None:
    dice, taken = random.Random(38), 0
    for _ in range(5000):
        try:
            json.dumps(checked(_message(dice)))
            taken += 1
        except InvalidValue as refused:
            assert str(refused)  # noqa: PT017  some are refused, some not
    assert 0 < taken < 2500


def test_a_page_that_watches_is_refused_whatever_it_says_and_costs_one_task(capfd: pytest.CaptureFixture[str]) -> None:
    server, dice = Server(b"page"), random.Random(1)
    sent: list[str] = []
    opened = asyncio.Event()

    async def send(data: bytes | str) -> None:
        await opened.wait()  # who does not read
        sent.append(str(data))

    reader, tasks, done = Reader(send, False), [], threading.Event()

    def flood() -> None:
        for text in ('{"do": "preset", "name": []}', "[" * 4000, "", "\x00", "{}", '{"do": 1' + "0" * 3000 + "}"):
            server._hear(reader, text)
        for _ in range(3000):
            server._hear(reader, json.dumps(_message(dice)))
        tasks.append(len(server._sent))
        opened.set()
        server.loop.call_later(0.1, done.set)

    try:
        server._call(flood)
        assert done.wait(60.0)
        assert tasks == [1]
        assert len(sent) == 1
        assert "this page watches" in sent[0]
        assert server.asked.empty()
    finally:
        server.close()
    assert "Traceback" not in capfd.readouterr().err
