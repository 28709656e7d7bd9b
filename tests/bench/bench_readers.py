# SPDX-License-Identifier: BSD-3-Clause
"""A teacher with a class: thirty pages watch one session, one of them slow, one stopped. What each is sent, and what it
costs the session. Prints JSON.

Usage: python tests/bench/bench_readers.py [READERS] [SECONDS]"""

from __future__ import annotations

import asyncio
import json
import multiprocessing
import resource
import sys
import threading
import time
from typing import Any

import aiohttp
from nanotouch_app.browser.desk import BrowserDesk
from nanotouch_app.browser.update import LAYOUT
from nanotouch_app.live.host import Host
from nanotouch_app.live.subject import of_preset

SLOW, STOPPED = 0.5, 1e9  # between two acknowledgements [s]


async def read(client: Any, address: str, key: str, seconds: float, pause: float) -> dict[str, float]:
    """One page: how many updates and bytes it was sent, and how many ticks lay between them at most."""
    socket = await client.ws_connect(f"{address}/session", headers={"Origin": address})
    await socket.send_json({"key": key, "token": ""})
    updates, size, first, last, summed = 0, 0, 0, 0, 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            message = await asyncio.wait_for(socket.receive(), max(end - time.monotonic(), 0.01))
        except TimeoutError:
            break
        if message.type is not aiohttp.WSMsgType.BINARY or message.data[0] != 1:
            continue
        told = LAYOUT.unpack(message.data)
        updates, size = updates + 1, size + len(message.data)
        first, last, summed = first or told[7], told[7], summed + (told[6] if first else 0)
        await asyncio.sleep(min(pause, max(end - time.monotonic(), 0.0)))
        await socket.send_str("{}")
    return {"updates": updates, "bytes": size, "ticks": last - first, "summed": summed}


def class_of(readers: int, address: str, key: str, seconds: float, answers: Any) -> None:
    """All pages, in a process of their own."""

    async def run() -> list[dict[str, float]]:
        async with aiohttp.ClientSession(connector=aiohttp.TCPConnector(limit=0)) as client:
            pauses = [0.0] * (readers - 2) + [SLOW, STOPPED]
            return await asyncio.gather(*(read(client, address, key, seconds, pause) for pause in pauses))

    answers.put(asyncio.run(run()))


def measured(readers: int, seconds: float) -> dict[str, Any]:
    """One run; 0 readers for what the session costs alone."""
    subject = of_preset("silicon_in_air")
    desk = BrowserDesk(subject.topography, b"")
    host = Host(subject, desk.tell)
    answers = multiprocessing.Queue()
    pages = None
    if readers:
        target = (readers, f"http://127.0.0.1:{desk.server.port}", desk.server.keys.watch, seconds, answers)
        pages = multiprocessing.Process(target=class_of, args=target)
        pages.start()
    used, began, ticks = cpu(), time.monotonic(), host.session.progress.ticks
    desk.serve(host, until=began + seconds)
    elapsed = time.monotonic() - began
    made = {"cpu": (cpu() - used) / elapsed, "rate": (host.session.progress.ticks - ticks) / elapsed,
            "slowdown": host.session.progress.slowdown}  # fmt: skip
    told = answers.get(timeout=60) if pages else []
    if pages:
        pages.join()
    host.close()
    desk.close()
    return {**made, "pages": told}


def cpu() -> float:
    """Processor time of this process [s]."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def main(readers: int = 30, seconds: float = 10.0) -> None:
    """Alone, then with the class."""
    alone, together = measured(0, seconds), measured(readers, seconds)
    pages = together["pages"]
    quick = pages[:-2]
    updates = sorted(page["updates"] / seconds for page in quick)
    report = {
        "readers": readers, "seconds": seconds, "bytes per update": quick[0]["bytes"] / max(quick[0]["updates"], 1),
        "updates per second and reader": [updates[0], updates[len(updates) // 2], updates[-1]],
        "kB/s of all": sum(page["bytes"] for page in pages) / seconds / 1e3,
        "slow reader: updates per second": pages[-2]["updates"] / seconds,
        "stopped reader: updates": pages[-1]["updates"],
        "ticks that no update sums up": max(abs(page["ticks"] - page["summed"]) for page in quick),
        "session rate [Hz], alone and with the class": [alone["rate"], together["rate"]],
        "slowdown, alone and with the class": [alone["slowdown"], together["slowdown"]],
        "processor share, alone and with the class": [alone["cpu"], together["cpu"]],
        "threads": threading.active_count(),
    }  # fmt: skip
    print(json.dumps(report, indent=1))


if __name__ == "__main__":
    multiprocessing.set_start_method("spawn")
    main(*(int(word) for word in sys.argv[1:2]), *(float(word) for word in sys.argv[2:3]))
