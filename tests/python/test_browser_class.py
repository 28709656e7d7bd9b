# SPDX-License-Identifier: BSD-3-Clause
"""A teacher goes through the whole lesson over a socket, as a page does, while thirty pages watch: each is shown the
same questions and explanations, a slow one and one that takes no update, too."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from typing import Any

import pytest
from nanotouch_app.live.board import TASKS

aiohttp = pytest.importorskip("aiohttp", reason="pip install 'nanotouch[browser]'")
from nanotouch_app.browser.desk import BrowserDesk  # noqa: E402
from nanotouch_app.browser.update import LAYOUT  # noqa: E402
from nanotouch_app.live.host import Host  # noqa: E402
from nanotouch_app.live.subject import of_preset  # noqa: E402

PAGES = [task for task in TASKS.values() if task["is_page"]]
READERS, SLOW = 30, 0.5
PATIENCE = 120.0  # of a loaded machine [s]
CONTACT = 20  # place of the contact radius in an update


class Page:
    """One open page: what it was told of the lesson, and its newest update."""

    def __init__(self, socket: Any, pause: float = 0.0) -> None:
        self.socket, self.pause = socket, pause
        self.update: tuple[Any, ...] = ()
        self.updates = 0
        self.task: dict[str, Any] = {}
        self.explained: dict[str, str] = {}
        self.asked: list[str] = []

    async def listen(self) -> None:
        """Until it is closed."""
        async for message in self.socket:
            if message.type is aiohttp.WSMsgType.TEXT:
                self._told(json.loads(message.data))
            elif message.data[0] == 1:
                self.update, self.updates = LAYOUT.unpack(message.data), self.updates + 1
                if self.pause:
                    await asyncio.sleep(self.pause)
                await self.socket.send_str("{}")

    def _told(self, message: dict[str, Any]) -> None:
        if message["tell"] != "task":
            return
        self.task = message
        if "passed" in message:
            self.explained[message["name"]] = message["now"]
        elif message["name"] not in ("", *self.asked):
            self.asked.append(message["name"])

    async def ask(self, what: str, **more: Any) -> None:
        """As the page asks."""
        await self.socket.send_json({"do": what, **more})

    async def until(self, holds: Any) -> None:
        """It comes, or the whole test runs out of time."""
        while not holds():
            await asyncio.sleep(0.01)


async def teach(teacher: Page) -> None:
    """Predict, touch and let go until it is explained, go on."""
    await teacher.ask("task", name="lesson")
    for page in PAGES:
        await teacher.until(lambda page=page: teacher.task.get("name") == page["name"])
        await teacher.ask("choose", number=1)
        await teacher.until(lambda: not teacher.task["choices"])
        while "passed" not in teacher.task:
            for on in (True, False):
                await teacher.ask("press", on=on)
                await teacher.until(lambda on=on: bool(teacher.update[CONTACT] > 0.0) == on or "passed" in teacher.task)
            await asyncio.sleep(0.1)
        await teacher.ask("choose", number=0)


def test_thirty_pages_watch_a_lesson() -> None:
    subject = of_preset("silicon_in_air")
    desk, pages = BrowserDesk(subject.topography, b""), []
    host, ends = Host(subject, desk.tell), threading.Event()

    def serve() -> None:
        while not ends.is_set():
            desk.serve(host, until=time.monotonic() + 0.1)

    async def lesson() -> None:
        address = f"http://127.0.0.1:{desk.server.port}"
        async with aiohttp.ClientSession(connector=aiohttp.TCPConnector(limit=0)) as client:
            for number in range(READERS + 1):
                socket = await client.ws_connect(f"{address}/session", headers={"Origin": address})
                key = desk.server.keys.watch if number else desk.server.keys.operate
                await socket.send_json({"key": key, "token": ""})
                pages.append(Page(socket, {1: SLOW, 2: 1e9}.get(number, 0.0)))
            tasks = [asyncio.create_task(page.listen()) for page in pages]
            await pages[0].until(lambda: pages[0].update)
            await teach(pages[0])
            for page in [*pages[:2], *pages[3:]]:
                await page.until(lambda page=page: len(page.explained) == len(PAGES))
            for page, task in zip(pages, tasks, strict=True):
                task.cancel()
                await page.socket.close()

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        asyncio.run(asyncio.wait_for(lesson(), PATIENCE))
    finally:
        ends.set()
        thread.join()
        host.close()
        desk.close()
    names = [page["name"] for page in PAGES]
    for page in [*pages[:2], *pages[3:]]:
        assert page.asked == names
        assert page.explained == pages[0].explained
    assert pages[2].updates == 1  # it took none
    assert pages[1].updates < pages[3].updates
