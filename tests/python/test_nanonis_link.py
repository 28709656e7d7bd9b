# SPDX-License-Identifier: BSD-3-Clause
"""Nanonis' TCP protocol: what goes over the wire, and replies that cannot be."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mock_nanonis import MANGLES, Controller
from nanotouch_app.devices.nanonis_link import HEADER, LARGEST, Address, Link, LinkError


@pytest.fixture
def controller() -> Iterator[Controller]:
    made = Controller()
    yield made
    made.stop()


def linked(controller: Controller, patience: float = 10.0) -> Link:
    return Link(Address("127.0.0.1", controller.port), patience)


def test_a_request_on_the_wire() -> None:
    """The bytes of a withdrawal, typed by hand from the protocol."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        with Link(Address("127.0.0.1", server.getsockname()[1]), 1.0) as link:
            there, _ = server.accept()
            link.tell("ZCtrl.Withdraw", "Ii", 1, -1, wants_reply=True)
        with there, there.makefile("rb") as stream:
            told = stream.read()
    assert told == (b"ZCtrl.Withdraw" + bytes(18) + b"\0\0\0\x08" + b"\0\x01" + b"\0\0"
                    + b"\0\0\0\x01" + b"\xff\xff\xff\xff")  # fmt: skip


def test_values_come_and_go(controller: Controller) -> None:
    with linked(controller) as link:
        link.call("ZCtrl.SetpntSet", "f", 0.5)
        assert link.call("ZCtrl.SetpntGet", gives="f") == (0.5,)
        assert link.names() == ["Current (A)", "Bias (V)", "Deflection (m)"]
        with pytest.raises(LinkError, match=r"ZCtrl\.Home: the controller refuses: ZCtrl\.Home is not possible"):
            link.call("ZCtrl.Home")


@pytest.mark.parametrize("way", sorted(set(MANGLES) - {"no"}))
def test_what_is_no_reply_is_an_error(controller: Controller, way: str) -> None:
    controller.mangle = MANGLES[way]
    with linked(controller, 0.1) as link, pytest.raises(LinkError):
        link.call("ZCtrl.ZPosGet", gives="f")


def raw(reply: bytes, patience: float = 5.0, pause: float = 0.0) -> tuple[Any, ...]:
    """What a link makes of these bytes, byte by byte if there is a pause."""
    ours, theirs = socket.socketpair()
    link = object.__new__(Link)
    link._socket, link.patience = ours, patience

    def serve() -> None:
        with suppress(OSError), theirs:
            theirs.recv(1000)
            for each in [reply] if pause == 0.0 else [bytes([byte]) for byte in reply]:
                theirs.sendall(each)
                time.sleep(pause)

    server = threading.Thread(target=serve)
    server.start()
    try:
        return link.call("ZCtrl.ZPosGet", gives="f")
    finally:
        link.close()
        server.join()


GOOD = HEADER.pack(b"ZCtrl.ZPosGet", 12, 0, 0) + b"\x3f\x80\0\0" + bytes(8)


def test_a_reply_in_pieces_is_put_together_and_its_deadline_stands() -> None:
    assert raw(GOOD) == raw(GOOD, pause=1e-4) == (1.0,)
    with pytest.raises(LinkError, match="no reply within"):
        raw(GOOD, patience=0.05, pause=0.01)


@pytest.mark.parametrize(
    "reply",
    [
        HEADER.pack(b"ZCtrl.ZPosSet", 12, 0, 0) + GOOD[40:],
        HEADER.pack(b"ZCtrl.ZPosGet", LARGEST + 1, 0, 0) + GOOD[40:],
        HEADER.pack(b"ZCtrl.ZPosGet", -1, 0, 0) + GOOD[40:],
        HEADER.pack(b"ZCtrl.ZPosGet", 8, 0, 0) + GOOD[44:],  # no value
        HEADER.pack(b"ZCtrl.ZPosGet", 16, 0, 0) + GOOD[40:] + bytes(4),  # more than it says
        HEADER.pack(b"ZCtrl.ZPosGet", 12, 0, 0) + GOOD[40:48] + b"\x7f\xff\xff\xff",  # a text that is not there
    ],
)
def test_a_reply_that_cannot_be_is_refused(reply: bytes) -> None:
    with pytest.raises(LinkError):
        raw(reply)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, len(GOOD) - 1), st.integers(1, 255))
def test_a_flipped_byte_is_a_number_or_an_error(place: int, flip: int) -> None:
    """The protocol has no check sum: the four bytes of a value cannot be told from another value."""
    broken = bytearray(GOOD)
    broken[place] ^= flip
    if 36 <= place < 44:  # the value, and what no reply uses
        assert len(raw(bytes(broken))) == 1
    else:
        with pytest.raises(LinkError):
            raw(bytes(broken))
