# SPDX-License-Identifier: BSD-3-Clause
"""Who may look and who may touch. Two keys in the fragments of two links, which no browser sends to a server: one that
operates, once; one that watches. Host and origin of each request are checked, against other pages and rebound names."""

from __future__ import annotations

import hmac
import re
import secrets
import sys
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any
from urllib.parse import unquote, urlsplit

from nanotouch.errors import InvalidValue
from nanotouch.touch import host

from nanotouch_app.live.board import TASKS
from nanotouch_app.live.subject import PRESETS

LOOPBACK = frozenset({"127.0.0.1", "localhost", "::1"})
MOST_STEPS = 100.0  # of the wheel at once
LONGEST = 200  # letters of a text that is asked
KEY_BYTES = 24
NAMES_FILES = (".toml", ".nc", ".mcap")  # may name other files, or are played
Message = dict[str, Any]


class Refused(Exception):
    """In words for the page."""


class Keys:
    """The keys of one run."""

    def __init__(self) -> None:
        self.operate, self.watch = secrets.token_urlsafe(KEY_BYTES), secrets.token_urlsafe(KEY_BYTES)
        self.token = ""
        """of the page that operates, so that it may be loaded again"""

    def grant(self, key: object, token: object) -> tuple[bool, str]:
        """Whether this page operates, and its token; :class:`Refused` for a wrong or used key."""
        if self.token and _same(token, self.token) and _same(key, self.operate):
            return True, self.token
        if _same(key, self.watch):
            return False, ""
        if not _same(key, self.operate):
            raise Refused("wrong key: open the link that nanotouch has printed")
        if self.token:
            raise Refused("this link operates once, and has been used: ask for the one that watches")
        self.token = secrets.token_urlsafe(KEY_BYTES)
        return True, self.token

    def operates(self, token: object) -> bool:
        """Whether this is the token of the page that operates."""
        return bool(self.token) and _same(token, self.token)


def file_name(said: str | None) -> str:
    """A name for a file that a page sends, whatever it says; :class:`~nanotouch.errors.InvalidValue` for what is named
    on the command line instead."""
    name = re.sub(r"[^\w.() -]", "_", PurePosixPath(unquote(said or "")).name)[-LONGEST // 2 :].lstrip(".")
    if not name or PurePosixPath(name).suffix.lower() in NAMES_FILES:
        raise InvalidValue(
            f"{name or 'a file without a name'}: images and force curves may be dropped; name it on the command line"
        )
    return name


def _same(given: object, wanted: str) -> bool:
    return isinstance(given, str) and hmac.compare_digest(given.encode(), wanted.encode())


def host_is_ours(host: str | None, allowed: frozenset[str] = LOOPBACK) -> bool:
    """Whether a request names this machine, at any port (a tunnel has its own): a rebound name does not."""
    try:
        return bool(host) and urlsplit(f"//{host}").hostname in allowed
    except ValueError:
        return False


def origin_is_ours(origin: str | None, host: str | None) -> bool:
    """Whether a socket is opened by our own page: its origin is the host that it asks."""
    if not origin or not host:
        return False
    parts = urlsplit(origin)
    return parts.scheme in ("http", "https") and parts.netloc == host and not parts.path


def _number(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= sys.float_info.max  # neither NaN, nor whole numbers that no double holds


def _steps(value: object) -> bool:
    return _number(value) and abs(value) <= MOST_STEPS  # type: ignore[arg-type]


def _way(value: object) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(_number(part) and abs(part) <= 1.0 for part in value)


def _text(value: object) -> bool:
    return isinstance(value, str) and len(value) <= LONGEST


def _task(value: object) -> bool:
    return isinstance(value, str) and value in ("", *TASKS)


def _preset(value: object) -> bool:
    return isinstance(value, str) and value in PRESETS


FIELDS: dict[str, str] = host.slider_fields()  # that have a slider; no other is changed from a page
# what may be asked over a socket: no file of this machine, no end
ASKED: dict[str, dict[str, Callable[[object], bool]]] = {
    "move": {"way": _way}, "wheel": {"steps": _steps}, "press": {"on": lambda value: isinstance(value, bool)},
    "retract": {}, "stop": {}, "arm": {}, "pause": {}, "step": {}, "slower": {}, "faster": {}, "rewind": {}, "undo": {},
    "redo": {},
    "preset": {"name": _preset}, "task": {"name": _task}, "choose": {"number": _number},
    "say": {"text": _text}, "device": {"name": _text},
    "change": {"what": _text, "field": lambda value: isinstance(value, str) and value in FIELDS, "value": _number},
}  # fmt: skip


def checked(message: object) -> Message:
    """A message of a page, its known parts only; :class:`~nanotouch.errors.InvalidValue` for anything else."""
    what = message.get("do") if isinstance(message, dict) else None
    if not isinstance(message, dict) or not isinstance(what, str) or what not in ASKED:
        raise InvalidValue(f"a page cannot ask for {str(what)[:40]!r}")
    wanted = ASKED[what]
    wrong = [name for name, is_good in wanted.items() if not is_good(message.get(name))]
    if wrong:
        raise InvalidValue(f"{what}: {wrong[0]} is not valid")
    if what == "change" and message["what"] != FIELDS[message["field"]]:
        raise InvalidValue(f"change: {message['field']} is of the {FIELDS[message['field']]}")
    made = {"do": what, **{name: message[name] for name in wanted}}
    if what == "choose":
        made["number"] = int(made["number"])
    return made | ({"lay": True} if what == "task" else {})
