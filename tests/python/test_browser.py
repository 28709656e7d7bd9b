# SPDX-License-Identifier: BSD-3-Clause
"""`nanotouch live --browser`: who may touch and who may look, what a reader is sent, what a slow one costs."""

from __future__ import annotations

import asyncio
import gc
import json
import threading
import time
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app import browser
from nanotouch_app.browser import access, page
from nanotouch_app.browser.readers import Reader, Readers
from nanotouch_app.browser.update import LAYOUT, SURFACE, Summary, message_text, stored_surface, surface_bytes

aiohttp = pytest.importorskip("aiohttp", reason="pip install 'nanotouch[browser]'")
from nanotouch_app.browser.desk import BrowserDesk  # noqa: E402
from nanotouch_app.live.host import Host  # noqa: E402
from nanotouch_app.live.subject import of_preset  # noqa: E402
from nanotouch_app.main import main  # noqa: E402

HTML = b"<!doctype html><title>page</title>"
LONG = 60.0  # on a loaded machine [s]
Call = Callable[[Any, str, BrowserDesk], Awaitable[None]]


@pytest.fixture(scope="module")
def desk() -> Iterator[BrowserDesk]:
    """A running session, served."""
    subject = of_preset("silicon_in_air")
    made = BrowserDesk(subject.topography, HTML)
    host = Host(subject, made.tell)
    ends = threading.Event()

    def serve() -> None:
        while not ends.is_set():
            made.serve(host, until=time.monotonic() + 0.2)

    thread = threading.Thread(target=serve)
    thread.start()
    yield made
    ends.set()
    thread.join()
    host.close()
    made.close()


OPENED: list[Any] = []  # the sockets of the present visit


def visit(desk: BrowserDesk, call: Call) -> None:
    """Run a visit; its address is http://127.0.0.1:port. Its sockets are closed: an open one warns in a later test."""

    async def run() -> None:
        async with aiohttp.ClientSession() as client:
            try:
                await asyncio.wait_for(call(client, f"http://127.0.0.1:{desk.server.port}", desk), LONG)
            finally:
                while OPENED:
                    await OPENED.pop().close()

    asyncio.run(run())
    gc.collect()  # what is left open warns here


async def opened(client: Any, address: str, key: str, token: str = "", **headers: str) -> Any:
    """A socket that has said its key."""
    socket = await client.ws_connect(f"{address}/session", headers={"Origin": address, **headers})
    OPENED.append(socket)
    await socket.send_json({"key": key, "token": token})
    return socket


async def heard(socket: Any, kind: str) -> Any:
    """The next message of a kind; updates on the way are taken."""
    while True:
        message = await socket.receive()
        if message.type is aiohttp.WSMsgType.BINARY:
            if message.data[0] == 1:
                await socket.send_str("{}")
                if kind == "update":
                    return message.data
        elif message.type is aiohttp.WSMsgType.TEXT:
            if (told := json.loads(message.data))["tell"] == kind:
                return told
        else:
            raise ConnectionError(str(socket.close_code))


async def refused(socket: Any) -> int:
    """The socket is closed without a word of the session."""
    message = await socket.receive()
    assert message.type in (aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED), message
    return int(socket.close_code)


def test_only_the_right_key_opens_and_operates_once(desk: BrowserDesk) -> None:
    async def call(client: Any, address: str, desk: BrowserDesk) -> None:
        keys = desk.server.keys
        for wrong in ("", "wrong", keys.operate[:-1], keys.operate + "x", None, 3, ["a"]):
            assert await refused(await opened(client, address, wrong)) == 4403
        first = await opened(client, address, keys.operate)
        granted = await heard(first, "granted")
        assert granted["operates"]
        assert await refused(await opened(client, address, keys.operate)) == 4403  # a second operator
        assert await refused(await opened(client, address, keys.operate, "guessed")) == 4403
        again = await opened(client, address, keys.operate, granted["token"])  # the same page, loaded again
        assert (await heard(again, "granted"))["operates"]
        watching = await opened(client, address, keys.watch)
        assert not (await heard(watching, "granted"))["operates"]
        world = await heard(watching, "world")
        assert world["scene"]["tip"]["radius"] == 20e-9
        await watching.send_json({"do": "wheel", "steps": 1.0})
        assert "watches" in (await heard(watching, "refused"))["why"]
        await again.send_json({"do": "change", "what": "scene", "field": "medium.relative_humidity", "value": 0.2})
        while (await heard(watching, "world"))["scene"]["medium"]["relative_humidity"] != 0.2:
            pass
        for hostile in ({"do": "open", "path": "/etc/passwd"}, {"do": "leave"}, {"do": "move", "way": [1, 2]},
                        {"do": "wheel", "steps": "1"}, {"do": "preset", "name": "../x"}, {"do": []}, [], 3,
                        {"do": "__init__"}, {"do": "change", "what": "core", "field": "a", "value": 1.0},
                        {"do": "wheel", "steps": 1e308}, {"do": "move", "way": [1e300, 0, 0]},
                        {"do": "change", "what": "scene", "field": "__class__", "value": 1.0},
                        {"do": "change", "what": "scene", "field": "tip", "value": 1.0},
                        {"do": "change", "what": "rig", "field": "tip.radius", "value": 1e-8},
                        {"do": "change", "what": "settings", "field": "limits.force", "value": 1.0},
                        {"do": "change", "what": "scene", "field": "tip.radius", "value": 1e308}):  # fmt: skip
            await again.send_json(hostile)
            await heard(again, "refused")
        for odd in ("[" * 4000, '{"do": "wheel", "steps": 1' + "0" * 400 + "}", '{"do": "preset", "name": []}',
                    '{"do": "task", "name": {}}', '{"do": "say", "text": 1}', '{"do": "wheel", "steps": NaN}',
                    '{"do": "choose", "number": 1e999}', "\ud800", ""):  # fmt: skip
            await again.send_str(odd.encode("utf-8", "surrogatepass").decode("utf-8", "replace"))
            await heard(again, "refused")
        deep = await client.ws_connect(f"{address}/session", headers={"Origin": address})
        await deep.send_str("[" * 4000)
        assert await refused(deep) == 4403

    visit(desk, call)


def test_another_page_and_a_rebound_name_are_refused(desk: BrowserDesk) -> None:
    async def call(client: Any, address: str, desk: BrowserDesk) -> None:
        port = desk.server.port
        for headers in ({"Origin": "http://evil.example"}, {"Origin": "null"}, {"Origin": f"http://localhost:{port}"},
                        {"Origin": f"{address}.evil.example"}, {}):  # fmt: skip
            with pytest.raises(aiohttp.WSServerHandshakeError) as caught:
                await client.ws_connect(f"{address}/session", headers=headers)
            assert caught.value.status == 403
        rebound = f"evil.example:{port}"
        for path in ("/", "/session"):
            async with client.get(address + path, headers={"Host": rebound, "Origin": f"http://{rebound}"}) as answer:
                assert answer.status == 403
        tunnel = f"localhost:{port + 1 if port < 65535 else 1}"  # ssh -L with another port
        async with client.get(address, headers={"Host": tunnel}) as answer:
            assert answer.status == 200
            assert await answer.read() == HTML
            assert answer.headers["X-Frame-Options"] == "DENY"
        socket = await opened(client, address, desk.server.keys.watch, Host=tunnel, Origin=f"http://{tunnel}")
        assert await heard(socket, "granted")

    visit(desk, call)


def test_the_server_is_on_this_machine_only(desk: BrowserDesk) -> None:
    assert [socket.getsockname()[0] for socket in desk.server.listener.sockets] == ["127.0.0.1"]
    assert all(f":{desk.server.port}/#key=" in line for line in desk.links().splitlines() if "http" in line)


def test_an_update_has_128_bytes_and_is_the_frame(desk: BrowserDesk) -> None:
    async def call(client: Any, address: str, desk: BrowserDesk) -> None:
        socket = await opened(client, address, desk.server.keys.watch)
        first, second = LAYOUT.unpack(await heard(socket, "update")), LAYOUT.unpack(await heard(socket, "update"))
        assert first[0] == 1
        assert second[7] > first[7]  # the tick
        assert second[8] == pytest.approx(second[7] / 1e4, abs=2e-4)  # and its time
        least, force, largest = second[16], second[13], second[17]
        assert least - 1e-15 <= force <= largest + 1e-15

    visit(desk, call)


def frames(count: int, **columns: Any) -> Any:
    """Frames of nothing but these columns."""
    made = np.zeros(count, dtype=nt.frames.FRAME)
    for name, values in columns.items():
        made[name] = values
    return made


def test_a_slow_reader_is_given_the_newest_and_every_spike() -> None:
    readers, sent = Readers(), Reader(lambda data: None, False)
    readers.all.append(sent)
    blocks = [frames(50, sequence=np.arange(50) + 50 * number) for number in range(40)]
    blocks[3]["tip_force"][7, 2] = 9e-9
    blocks[20]["tip_force"][40, 2] = -5e-9
    blocks[20]["contact_radius"][40] = 1e-9

    class Blocks:
        def read(self) -> Any:
            return blocks.pop(0) if blocks else frames(0)

    readers.observer = Blocks()  # type: ignore[assignment]
    first = readers.look()
    assert len(first) == 1
    while blocks:  # it takes nothing
        assert readers.look() == []
    assert (sent.updates, sent.dropped) == (1, 39)
    sent.free = True
    blocks.append(frames(50, sequence=np.arange(2000, 2050)))
    [(_, update)] = readers.look()
    told = LAYOUT.unpack(update)
    assert (told[7], told[6]) == (2049, 40 * 50)  # the newest tick, and all that it sums up
    assert told[16:18] == (pytest.approx(-5e-9), pytest.approx(9e-9))
    assert told[3] == 3  # snap and tear
    assert len(update) == 128


def test_what_json_cannot_say_is_null() -> None:
    assert json.loads(message_text({"a": [np.inf, np.nan, 1.5], "b": {"c": np.float64("nan")}, "d": np.int64(3)})) == {
        "a": [None, None, 1.5], "b": {"c": None}, "d": 3}  # fmt: skip


def test_the_summary_of_one_block_is_that_of_its_parts() -> None:
    rng = np.random.default_rng(1)
    force = np.zeros((100, 3))
    force[:, 2] = rng.normal(size=100)
    whole = frames(100, tip_force=force, contact_radius=rng.random(100) > 0.5)
    parts = Summary()
    touched = False
    for block in np.split(whole, [1, 17, 60]):
        parts.add(Summary.of(block, touched))
        touched = bool(block[-1]["contact_radius"] > 0)
    alone = Summary.of(whole, False)
    assert (parts.least, parts.largest, parts.ticks, parts.events) == (alone.least, alone.largest, 100, alone.events)


def test_a_surface_takes_what_is_known_of_each_place_along(tmp_path: Path) -> None:
    heights, modulus = np.arange(12.0).reshape(3, 4), np.full((3, 4), 2e9)
    plain, given = surface_bytes(heights, (1.0, 2.0)), surface_bytes(heights, (1.0, 2.0), {"work_of_adhesion": modulus})
    assert SURFACE.unpack_from(plain)[:4] == (2, 3, 4, 0)
    assert SURFACE.unpack_from(given)[:4] == (2, 3, 4, 0b10)
    assert given[SURFACE.size :] == plain[SURFACE.size :] + modulus.astype("<f4").tobytes()
    np.savez(tmp_path / "laid.npz", heights=heights, pixel_size=(1.0, 2.0), work_of_adhesion=modulus)
    assert stored_surface(str(tmp_path / "laid.npz")) == given


def test_readers_are_told_where_the_work_of_the_hand_goes() -> None:
    told: list[Any] = []
    host = Host(of_preset("silicon_in_air"), told.append, stepped=True)
    readers = Readers()
    readers.all.append(Reader(lambda data: None, True))
    readers.hear(host.world())
    for on in (True, False):
        host.answer({"do": "press", "on": on})
        for _ in range(100):
            host.advance(0.01)
            readers.look()
    readers.all[0].free = True  # it has taken its update
    ((_, text),) = readers.hear(host.clock())
    readers.close()
    host.close()
    hand, *parts = json.loads(text)["energies"]
    assert hand == pytest.approx(sum(parts), rel=1e-6)
    assert parts[2] > 0.0


def test_who_comes_later_is_told_the_dents_of_what_lies_there_now() -> None:
    readers = Readers()
    host = Host(of_preset("soft_gold"), readers.hear, stepped=True)
    readers.hear(host.world())
    host.answer({"do": "press", "on": True})
    host.advance(2.0)
    host.answer({"do": "press", "on": False})
    host.advance(0.5)
    (told,) = [message for message in map(json.loads, readers.greeting()) if message["tell"] == "dents"]
    assert [row[4] for row in told["dents"]] == [dent.imprint.radius for dent in host.dents]
    assert told["dents"]
    host.answer({"do": "preset", "name": "polyester"})
    assert "dents" not in readers.kept
    readers.close()
    host.close()


def test_a_missing_page_is_a_plain_word(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(nt.Error, match="make page"):
        page(tmp_path / "none.html")
    assert main(["live", "--browser", "--page", str(tmp_path / "none.html")]) == 2
    assert "make page" in capsys.readouterr().err


def test_a_package_without_the_page_says_so_and_one_with_it_has_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(browser, "__file__", str(tmp_path / "__init__.py"))
    assert main(["live", "--browser"]) == 2
    said = capsys.readouterr().err
    assert "make page" in said
    assert "--page" in said
    (tmp_path / browser.NAME).write_bytes(HTML)
    assert page() == HTML


@pytest.mark.parametrize("host", [None, "", "evil.example", "127.0.0.1.evil.example", "[::1", "localhost@evil.example"])
def test_hosts_that_are_not_ours(host: str | None) -> None:
    assert not access.host_is_ours(host)


async def pause(desk: BrowserDesk, holds: Callable[[], bool]) -> None:
    """Until it holds."""
    while not holds():
        await asyncio.sleep(0.02)


def test_a_crowd_is_refused_in_words_and_the_operator_goes_on(
    desk: BrowserDesk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Watchers above the limit, connections above the limit, those that never say a word."""
    monkeypatch.setattr("nanotouch_app.browser.server.WATCHERS", 3)
    monkeypatch.setattr("nanotouch_app.browser.door.MOST", 12)
    monkeypatch.setattr("nanotouch_app.browser.door.SILENCE", 0.5)

    async def call(client: Any, address: str, desk: BrowserDesk) -> None:
        await pause(desk, lambda: not desk.server.readers.all)  # of the tests before
        keys, host = desk.server.keys, ("127.0.0.1", desk.server.port)
        for _ in range(3):
            await heard(await opened(client, address, keys.watch), "granted")
        fourth = await opened(client, address, keys.watch)
        assert (await fourth.receive()).extra == "3 pages watch already: no more can"
        operator = await opened(client, address, keys.operate, keys.token)
        assert (await heard(operator, "granted"))["operates"]  # there is always a place for it
        desk.server.loop.call_soon_threadsafe(time.sleep, 0.3)  # all knock within one of its turns
        mute = [await asyncio.open_connection(*host) for _ in range(20)]
        answers = [await asyncio.wait_for(reader.read(12), LONG) for reader, _ in mute]  # all are closed in the end
        for _, writer in mute:
            writer.close()
        assert answers.count(b"HTTP/1.1 503") >= 20 - 12
        assert b"" in answers
        await heard(operator, "update")
        async with client.get(address) as answer:  # there is room again
            assert answer.status == 200

    visit(desk, call)


def test_what_is_no_http_is_answered_and_prints_nothing(
    desk: BrowserDesk, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    async def call(client: Any, address: str, desk: BrowserDesk) -> None:
        long = b"GET / HTTP/1.1\r\nHost: localhost\r\nX-Long: " + 100_000 * b"a" + b"\r\n\r\n"
        for hostile in (long, b"GET / HTTP/1.1\r\nbad header\x00\r\n\r\n", b"\x16\x03\x01\x02\x00\x01\x00\r\n\r\n"):
            reader, writer = await asyncio.open_connection("127.0.0.1", desk.server.port)
            writer.write(hostile)
            assert b" 400 " in await asyncio.wait_for(reader.readline(), LONG)
            writer.close()

    visit(desk, call)
    assert not [record for record in caplog.records if record.name.startswith(("nanotouch", "aiohttp", "asyncio"))]
    assert "Traceback" not in capfd.readouterr().err


def test_a_file_is_opened_by_the_page_that_operates_alone(desk: BrowserDesk, tmp_path: Path) -> None:
    """As `live FILE` opens it; nothing else can be sent, and no name leads out of the folder."""
    image = tmp_path / "relief.gsf"
    heights = 1e-9 * np.random.default_rng(1).standard_normal((32, 32))
    nt.images.write(image, nt.Topography(heights, (1e-8, 1e-8), name="relief"))

    async def call(client: Any, address: str, desk: BrowserDesk) -> None:
        socket = await opened(client, address, desk.server.keys.operate, desk.server.keys.token)
        token = (await heard(socket, "granted"))["token"]

        async def send(name: str, data: bytes, **changed: str) -> tuple[int, str]:
            headers = {"Origin": address, "X-Nanotouch-Token": token, "X-Nanotouch-File": name, **changed}
            async with client.post(f"{address}/open", data=data, headers=headers) as answer:
                return answer.status, await answer.text()

        for wrong in ({"X-Nanotouch-Token": ""}, {"X-Nanotouch-Token": "guessed"}, {"Origin": "http://other.example"}):
            assert (await send("a.gsf", b"", **wrong))[0] == 403
        for name in ("rig.toml", "..", "", "map.NC", "touch.mcap"):
            status, why = await send(name, b"")
            assert (status, "command line" in why) == (400, True), name
        assert (await send("..%2F..%2Fno%20image.gsf", b"nothing"))[0] == 204
        assert "no image.gsf" in (await heard(socket, "refused"))["why"]
        assert (await send("relief.gsf", image.read_bytes()))[0] == 204
        while "relief" not in (world := await heard(socket, "world"))["title"] + world["felt"]:
            pass
        assert sorted(file.name for file in desk.server.folder.path.rglob("*.gsf")) == ["no image.gsf", "relief.gsf"]
        await socket.send_json({"do": "preset", "name": "silicon_in_air"})
        while (await heard(socket, "world"))["preset"] != "silicon_in_air":
            pass

    visit(desk, call)
