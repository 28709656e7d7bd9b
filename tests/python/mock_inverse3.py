# SPDX-License-Identifier: BSD-3-Clause
"""A mock of Haply's Inverse Service: it sends the first frame by itself, then one for each command, as the service
does, and notes the forces. A test tells it what to send instead, or to be silent, or to close.

With NANOTOUCH_DESK in the environment the device is that of mock_sdk/desk.py; else it stands still.

Usage: mock_inverse3.py [PORT]    prints the port that it serves
"""

from __future__ import annotations

import asyncio
import json
import os
import sys
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).with_name("mock_sdk")))
from desk import Desk

ID = "04BA"


def frame(z: float = 0.2, device: str = ID, pressed: str = "", x: float = 0.01, y: float = -0.15) -> str:
    """As the service sends it, with one Inverse3 and a grip."""
    state = {"cursor_position": {"x": x, "y": y, "z": z}, "cursor_velocity": {"x": 0.0, "y": 0.0, "z": 0.0}}
    buttons = {name: name in pressed for name in "abc"}
    grip = {"device_id": "61548", "state": {"buttons": buttons, "orientation": {"w": 1.0, "x": 0, "y": 0, "z": 0}}}
    return json.dumps({"inverse3": [{"device_id": device, "state": state}], "wireless_verse_grip": [grip]})


@dataclass
class Service:
    """One at a time; `port` once it is started."""

    instead: deque[str | bytes | None] = field(default_factory=deque)
    """what it sends next; None: it closes the connection"""
    silent: bool = False
    pressed: str = ""
    forces: list[dict[str, float]] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)
    """commands that the service would not understand"""
    connections: int = 0
    open: int = 0
    """of them"""
    port: int = 0
    desk: Desk | None = None

    async def start(self) -> None:
        """Listen on a free port of the loopback."""
        from aiohttp import web

        application = web.Application()
        application.router.add_get("/", self._talk)
        self.runner = web.AppRunner(application, shutdown_timeout=0.1)
        await self.runner.setup()
        site = web.TCPSite(self.runner, "127.0.0.1", self.port)
        await site.start()
        self.port = self.runner.addresses[0][1]

    async def stop(self) -> None:
        """The service ends; its connections are cut."""
        await self.runner.cleanup()

    async def _talk(self, request: Any) -> Any:
        from aiohttp import WSMsgType, web

        link = web.WebSocketResponse()
        await link.prepare(request)
        self.connections += 1
        self.open += 1
        try:
            await self._send(link)
            async for message in link:  # to its end: what the other end said last is taken, though it has gone
                if message.type != WSMsgType.TEXT or not self._take(message.data):
                    self.wrong.append(str(message.data))
                if not await self._send(link):
                    break
        finally:
            self.open -= 1
        return link

    def _take(self, text: str) -> bool:
        try:
            (one,) = json.loads(text)["inverse3"]
            values = one["commands"]["set_cursor_force"]["values"]
        except (ValueError, KeyError, TypeError):
            return False
        self.forces.append(values)
        if self.desk is not None:
            self.desk.force(*(values[axis] for axis in "xyz"))
            self.forces.clear()
        return one["device_id"] == ID and sorted(values) == ["x", "y", "z"]

    async def _send(self, link: Any) -> bool:
        await asyncio.sleep(1e-3)
        if self.silent or (self.desk is not None and self.desk.stall == 1.0):
            return True
        what = self.instead.popleft() if self.instead else self._frame()
        if what is None:
            await link.close()
            return False
        with suppress(ConnectionError):  # the other end has gone
            await (link.send_bytes(what) if isinstance(what, bytes) else link.send_str(what))
        return True

    def _frame(self) -> str:
        if self.desk is None:
            return frame(pressed=self.pressed)
        self.desk.move()
        if self.desk.present != 1.0:
            return json.dumps({"inverse3": []})
        if self.desk.garbage == 1.0:
            return frame(z=1e300)
        return frame(self.desk.z, x=self.desk.x, y=self.desk.y, pressed="a" * int(self.desk.buttons))


async def serve(port: int) -> None:
    """Serve until the process ends; before other programs where that is granted, as the bridge does."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(10))
    service = Service(port=port, desk=Desk() if "NANOTOUCH_DESK" in os.environ else None)
    await service.start()
    print(service.port, flush=True)
    await asyncio.Event().wait()


if __name__ == "__main__":
    asyncio.run(serve(int(sys.argv[1]) if len(sys.argv) > 1 else 0))
