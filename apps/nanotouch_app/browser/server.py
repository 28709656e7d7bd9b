# SPDX-License-Identifier: BSD-3-Clause
"""The server: one page, one socket, in a thread of its own with its own observer of the session's frames."""

from __future__ import annotations

import asyncio
import itertools
import json
import queue
import shutil
import threading
from collections.abc import Awaitable, Callable
from typing import Any

from nanotouch.errors import Error
from nanotouch.errors import missing as missing_extra
from nanotouch.touch.scratch import Scratch

from nanotouch_app.browser.access import LOOPBACK, Keys, Refused, checked, file_name, host_is_ours, origin_is_ours
from nanotouch_app.browser.readers import Reader, Readers
from nanotouch_app.browser.update import message_text, stored_surface

try:
    from aiohttp import WSMsgType, web

    from nanotouch_app.browser.door import Door, quiet_log
except ImportError as missing:
    raise missing_extra("aiohttp", "browser") from missing

TURN = 1.0 / 60.0  # between two looks at the frames [s]
GREETING = 10.0  # within which a socket must say its key [s]
LARGEST = 4096  # message of a page [byte]
LARGEST_FILE = 64_000_000  # that a page sends [byte]
WATCHERS = 100  # at once; the page that operates always finds a place
START = 10.0  # [s]
WRONG_KEY, NO_ROOM = 4403, 4429  # why a socket is closed
HEADERS = {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff", "X-Frame-Options": "DENY",
           "Referrer-Policy": "no-referrer", "Cross-Origin-Resource-Policy": "same-origin"}  # fmt: skip
Message = dict[str, Any]


class Server:
    """Serves one session; ``asked`` holds what the page that operates asks."""

    def __init__(self, page: bytes, port: int = 0, address: str = "127.0.0.1") -> None:
        self.page, self.address, self.port = page, address, port
        self.keys, self.readers = Keys(), Readers()
        self.asked: queue.Queue[Message] = queue.Queue()
        self.loop = asyncio.new_event_loop()
        self.operator: Reader | None = None
        self.folder, self.files = Scratch(), itertools.count(1)  # what the page that operates has sent
        self._ready = threading.Event()
        self._error: OSError | None = None
        self._sent: set[asyncio.Task[Any]] = set()
        self.thread = threading.Thread(target=self._run, name="nanotouch-browser", daemon=True)
        self.thread.start()
        if not self._ready.wait(START) or self._error is not None:
            raise Error(f"port {port} of {address} cannot be served: {self._error or 'it takes too long'}")

    # --- the thread ---

    def _run(self) -> None:
        asyncio.set_event_loop(self.loop)
        try:
            self.runner = self.loop.run_until_complete(self._open())
        except OSError as error:
            self._error = error
            self._ready.set()
            return
        self._ready.set()
        task = self.loop.create_task(self._look())
        self.loop.run_forever()
        task.cancel()
        self.listener.close()
        self.loop.run_until_complete(self.runner.cleanup())
        self.readers.close()
        self.loop.close()

    async def _open(self) -> web.AppRunner:
        app = web.Application(middlewares=[self._guarded], client_max_size=LARGEST_FILE)
        app.router.add_get("/", self._page)
        app.router.add_get("/session", self._socket)
        app.router.add_post("/open", self._open_file)
        runner = web.AppRunner(
            app, access_log=None, shutdown_timeout=1.0, keepalive_timeout=GREETING, logger=quiet_log()
        )
        await runner.setup()
        self.door = Door(self.loop, runner.server)
        self.listener = await self.loop.create_server(self.door, self.address, self.port)
        self.port = self.listener.sockets[0].getsockname()[1]
        return runner

    async def _look(self) -> None:
        while True:
            await asyncio.sleep(TURN)
            for reader, update in self.readers.look():
                self._send(reader, update)

    def _send(self, reader: Reader, data: bytes | str) -> asyncio.Task[None]:
        task = self.loop.create_task(_quietly(reader.send, data))
        self._sent.add(task)
        task.add_done_callback(self._sent.discard)
        return task

    # --- requests ---

    @web.middleware
    async def _guarded(self, request: web.Request, handler: Any) -> web.StreamResponse:
        """A name that was rebound to this machine is not ours."""
        self.door.heard(request.protocol)
        if not host_is_ours(request.headers.get("Host"), LOOPBACK):
            raise web.HTTPForbidden(text="this server answers to localhost only")
        answer: web.StreamResponse = await handler(request)
        return answer

    async def _page(self, request: web.Request) -> web.Response:
        return web.Response(body=self.page, content_type="text/html", charset="utf-8", headers=HEADERS)

    async def _open_file(self, request: web.Request) -> web.Response:
        """A file that was dropped on the page that operates: the host reads it as one that is named."""
        said = request.headers
        is_ours = origin_is_ours(said.get("Origin"), said.get("Host"))
        if not (is_ours and self.keys.operates(said.get("X-Nanotouch-Token"))):
            raise web.HTTPForbidden(text="files are opened by the page that operates")
        try:
            name = file_name(said.get("X-Nanotouch-File"))
        except Error as error:
            raise web.HTTPBadRequest(text=str(error)) from None
        data, number = await request.read(), next(self.files)
        folder = self.folder.path / str(number)
        folder.mkdir()
        await asyncio.to_thread((folder / name).write_bytes, data)
        shutil.rmtree(self.folder.path / str(number - 2), ignore_errors=True)  # the one before may still be read
        self.asked.put({"do": "open", "path": str(folder / name)})
        return web.Response(status=204)

    async def _socket(self, request: web.Request) -> web.StreamResponse:
        if not origin_is_ours(request.headers.get("Origin"), request.headers.get("Host")):
            raise web.HTTPForbidden(text="another page may not open this socket")
        socket = web.WebSocketResponse(max_msg_size=LARGEST, compress=False, heartbeat=30.0)
        await socket.prepare(request)
        try:
            async with asyncio.timeout(GREETING):
                first = json.loads(await socket.receive_str())
            operates, token = self.keys.grant(first.get("key"), first.get("token"))
        except Refused as refused:
            await socket.close(code=WRONG_KEY, message=str(refused).encode())
            return socket
        except (TimeoutError, ValueError, TypeError, AttributeError, RecursionError):
            await socket.close(code=WRONG_KEY, message=b"no key was said")
            return socket
        if not operates and sum(not reader.operates for reader in self.readers.all) >= WATCHERS:
            await socket.close(code=NO_ROOM, message=f"{WATCHERS} pages watch already: no more can".encode())
            return socket
        await self._attend(socket, operates, token)
        return socket

    async def _attend(self, socket: web.WebSocketResponse, operates: bool, token: str) -> None:
        async def send(data: bytes | str) -> None:
            await (socket.send_str(data) if isinstance(data, str) else socket.send_bytes(data))

        reader = Reader(send, operates)
        if operates:
            if self.operator is not None:  # the same page, loaded again
                self.operator.operates = False
            self.operator = reader
        self._send(reader, message_text({"tell": "granted", "operates": operates, "token": token}))
        for greeting in self.readers.greeting():
            await send(greeting)
        self.readers.all.append(reader)
        try:
            async for message in socket:
                if message.type is WSMsgType.TEXT:
                    self._hear(reader, message.data)
        finally:
            self.readers.all.remove(reader)
            if self.operator is reader:
                self.operator = None
                self.asked.put({"do": "press", "on": False})  # nobody holds the tip any more

    def _hear(self, reader: Reader, text: str) -> None:
        if text == "{}":  # the last update was taken
            reader.free = True
            return
        if not reader.operates:  # whatever it says
            self._refuse(reader, "this page watches: another one holds the hand")
            return
        try:
            message = checked(json.loads(text))
        except Exception as error:  # a page's words are never a traceback in the operator's terminal
            self._refuse(reader, str(error) if isinstance(error, Error) else "this message cannot be read")
            return
        self.asked.put(message)

    def _refuse(self, reader: Reader, why: str) -> None:
        """In words, once until they are sent: who asks without end makes no tasks without end."""
        if reader.refusal is None or reader.refusal.done():
            reader.refusal = self._send(reader, message_text({"tell": "refused", "why": why, "field": None}))

    # --- from the host's thread ---

    def tell(self, message: Message) -> None:
        """To all readers, or to the one that operates; never waits."""
        surface = stored_surface(message["path"]) if message["tell"] == "laid" else b""

        def send() -> None:
            for reader, data in self.readers.hear(message, surface):
                self._send(reader, data)

        self._call(send)

    def _call(self, act: Callable[[], Any]) -> None:
        try:
            self.loop.call_soon_threadsafe(act)
        except RuntimeError:  # it is closed
            return

    def link(self, key: str) -> str:
        """An address that holds a key."""
        host = f"[{self.address}]" if ":" in self.address else self.address
        return f"http://{host}:{self.port}/#key={key}"

    def close(self) -> None:
        """End it."""
        self._call(self.loop.stop)
        self.thread.join(5.0)
        self.folder.close()


async def _quietly(send: Callable[[bytes | str], Awaitable[None] | None], data: bytes | str) -> None:
    """A reader that is gone is no error."""
    try:
        sent = send(data)
        if sent is not None:
            await sent
    except (ConnectionError, RuntimeError):
        return
