# SPDX-License-Identifier: BSD-3-Clause
"""What a page at a link of `nanotouch live --browser` is told, without a browser."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable
from typing import Any

from nanotouch_app.browser.update import LAYOUT

LONG = 60.0  # on a loaded machine [s]
MOTOR = -5  # the motor's force in an update


def visited(link: str, take: Callable[[tuple[Any, ...]], bool]) -> list[dict[str, Any]]:
    """Its messages, until an update is taken."""
    return asyncio.run(_visited(link, take))


async def _visited(link: str, take: Callable[[tuple[Any, ...]], bool]) -> list[dict[str, Any]]:
    import aiohttp

    (address, key), told = link.split("/#key="), []
    async with (
        asyncio.timeout(LONG), aiohttp.ClientSession() as client,
        client.ws_connect(f"{address}/session", headers={"Origin": address}) as socket,
    ):  # fmt: skip
        await socket.send_json({"key": key, "token": ""})
        async for message in socket:
            if message.type is aiohttp.WSMsgType.TEXT:
                told.append(json.loads(message.data))
            elif message.data[0] == 1:
                await socket.send_str("{}")
                if take(LAYOUT.unpack(message.data)):
                    break
    return told
