# SPDX-License-Identifier: BSD-3-Clause
"""A mock of RPSPMC's app on the Red Pitaya, after Gxsm's sources (json_talk, rpspmc_pacpll_json_data): gzipped JSON of
all parameters each PARAMETER_PERIOD, and parameters that are set by JSON text. Its z servo, in volts, + down, moves the
tip until the signal is at the set-point, never beyond its limits; the sample lies at SURFACE.

Usage: mock_rpspmc.py    prints the port that it serves
"""

from __future__ import annotations

import asyncio
import gzip
import json
from dataclasses import dataclass, field
from typing import Any

SURFACE, STIFFNESS, SPEED = 2.0, 4.0, 40.0  # [V], [V/V], [V/s]


def _values() -> dict[str, float]:
    return {"PARAMETER_PERIOD": 200.0, "SPMC_Z_SERVO_MODE": 0.0, "SPMC_Z_SERVO_SETPOINT": 0.1,
            "SPMC_Z_SERVO_UPPER": 5.0, "SPMC_Z_SERVO_LOWER": -5.0, "SPMC_Z_MONITOR": 0.0,
            "SPMC_SIGNAL_MONITOR": 0.0}  # fmt: skip


@dataclass
class Controller:
    """One at a time."""

    values: dict[str, float] = field(default_factory=_values)
    deaf: set[str] = field(default_factory=set)
    """parameters that it does not take"""
    instead: bytes | None = None
    """what it sends in place of its parameters"""
    silent: bool = False
    wrong: list[str] = field(default_factory=list)
    port: int = 0

    async def start(self) -> None:
        from aiohttp import web

        application = web.Application()
        application.router.add_get("/", self._talk)
        self.runner = web.AppRunner(application, shutdown_timeout=0.1)
        await self.runner.setup()
        await web.TCPSite(self.runner, "127.0.0.1", self.port).start()
        self.port = self.runner.addresses[0][1]
        self.servo = asyncio.create_task(self._servo())

    async def stop(self) -> None:
        self.servo.cancel()
        await self.runner.cleanup()

    async def _servo(self) -> None:
        while True:
            await asyncio.sleep(0.002)
            v = self.values
            step = 0.002 * SPEED
            z = v["SPMC_Z_MONITOR"]
            if int(v["SPMC_Z_SERVO_MODE"]) & 1:
                wanted = z + max(-step, min(step, (v["SPMC_Z_SERVO_SETPOINT"] - self._signal(z)) / STIFFNESS))
                z = max(v["SPMC_Z_SERVO_LOWER"], min(v["SPMC_Z_SERVO_UPPER"], wanted))
            v["SPMC_Z_MONITOR"], v["SPMC_SIGNAL_MONITOR"] = z, self._signal(z)

    @staticmethod
    def _signal(z: float) -> float:
        return STIFFNESS * max(0.0, z - SURFACE)

    async def _talk(self, request: Any) -> Any:
        from aiohttp import WSMsgType, web

        socket = web.WebSocketResponse()
        await socket.prepare(request)
        sender = asyncio.create_task(self._send(socket))
        try:
            async for message in socket:
                if message.type == WSMsgType.TEXT:
                    self._take(message.data)
        finally:
            sender.cancel()
        return socket

    def _take(self, text: str) -> None:
        try:
            for name, one in json.loads(text)["parameters"].items():
                if name not in self.values:
                    raise KeyError(name)
                if name not in self.deaf:
                    self.values[name] = float(one["value"])
        except (ValueError, KeyError, TypeError):
            self.wrong.append(text)

    async def _send(self, socket: Any) -> None:
        while True:
            await asyncio.sleep(1e-3 * self.values["PARAMETER_PERIOD"])
            if not self.silent:
                described = {name: {"value": v, "min": -1e9, "max": 1e9, "access_mode": 0, "fpga_update": 0}
                             for name, v in self.values.items()}  # fmt: skip
                told = self.instead or gzip.compress(json.dumps({"parameters": described}).encode())
                await socket.send_bytes(told)
