# SPDX-License-Identifier: BSD-3-Clause
"""Where a command leaves its files, and the bar that shows how far it is."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path
from typing import Any

from nanotouch.errors import Error, MissingExtra, require

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]


DEFAULT = "nanotouch-out"


def add_options(group: Any, metavar: str = "DIR", what: str = "folder for the results") -> None:
    """Where the results go."""
    group.add_argument("--out", metavar=metavar, help=f"{what} (default: a new folder, {DEFAULT}, {DEFAULT}-2, ...)")
    takes_overwrite(group)


def takes_overwrite(group: Any) -> None:
    """The command may be told ``--overwrite``, without which nothing is replaced."""
    group.set_defaults(overwrite=False)


def check_free(file: Path, args: Any, option: str = "--out") -> None:
    """Refuse to replace a file that ``option`` names, unless ``--overwrite`` asks for it."""
    if os.path.lexists(file) and not args.overwrite:
        raise Error(f"{file} exists already: name another {option}, or add --overwrite")


@contextmanager
def folder(args: Any, names: Iterable[str]) -> Iterator[Path]:
    """The folder of this run, and of no other at the same time.

    Without ``--out`` it is new. One that holds results by these names is refused, or with ``--overwrite`` cleared of
    them, so that no old result stands beside new ones. If it stays empty it is removed again.
    """
    with made(args.out) as out, _alone(out):
        held = [name for name in names if os.path.lexists(out / name)]
        if held and not args.overwrite:
            raise Error(f"{out} holds results already ({', '.join(held)}): name another --out, or add --overwrite")
        for name in held:
            try:
                (out / name).unlink()
            except OSError as error:
                raise Error(f"cannot replace {out / name}: {error.strerror}") from error
        yield out


@contextmanager
def made(path: str | os.PathLike[str] | None) -> Iterator[Path]:
    """The folder, known to be writable; without a path a new one. What this makes and nothing fills is removed."""
    new: list[Path] = []
    try:
        try:
            out = _fresh(new) if path is None else _grown(Path(path), new)
            probe = out / f".nanotouch-{os.getpid()}"
            probe.touch()
            probe.unlink()
        except FileExistsError as error:
            raise Error(f"cannot write into {path}: it is a file, not a folder") from error
        except OSError as error:
            raise Error(f"cannot write into {path or DEFAULT}: {error.strerror}") from error
        yield out
    finally:
        for folder in reversed(new):
            with suppress(OSError):  # it holds something
                folder.rmdir()


def _fresh(new: list[Path]) -> Path:
    """A folder that no other run has: making it fails where it exists."""
    for number in count(1):
        path = Path(DEFAULT if number == 1 else f"{DEFAULT}-{number}")
        with suppress(FileExistsError):
            path.mkdir()
            new.append(path)
            return path
    raise AssertionError


def _grown(path: Path, new: list[Path]) -> Path:
    """The folder with those above it; what had to be made goes to `new`."""
    for folder in (*reversed([above for above in path.parents if not above.exists()]), path):
        try:
            folder.mkdir()
            new.append(folder)
        except FileExistsError:
            if not folder.is_dir():
                raise
    return path


@contextmanager
def _alone(out: Path) -> Iterator[None]:
    """Refuse a folder that another run writes into now. The system lets go of it when the process ends, however."""
    if fcntl is None:
        yield
        return
    descriptor = os.open(out, os.O_RDONLY)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Error(f"another run writes into {out} at this moment: name another --out") from None
        except OSError:  # a file system without locks
            pass
        yield
    finally:
        os.close(descriptor)


def write_json(path: Path, data: Mapping[str, Any]) -> None:
    """Write JSON, whole or not at all."""
    part = path.with_name(f".{path.name}.part")
    try:
        part.write_text(json.dumps(data, indent=2) + "\n", encoding="utf-8")
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise Error(f"cannot write {path}: {error.strerror}") from error


def in_short(report: object) -> str:
    """What was done to an image and what speaks against it, without each step and its rivals."""
    first, *rest = str(report).splitlines()
    return "\n".join((first, *(line for line in rest if line.strip().startswith("warning:"))))


def as_json(value: Any) -> Any:
    """What JSON has a spelling for: NaN (not known) is null, infinities are the strings ``"inf"`` and ``"-inf"``."""
    if isinstance(value, Mapping):
        return {key: as_json(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    return value


def wrapped(text: str, width: int) -> str:
    """The lines, none longer than ``width`` where blanks allow it. What goes on stands below the text, right of a
    label and its column (``limits:  force ...``)."""
    lines = []
    for line in text.splitlines():
        label = re.match(r" *(\S+( \S+)?(  +|: ))?", line)
        column = label.end() if label else 0
        indent = " " * (column if 0 < column <= width // 3 else 4)
        lines += textwrap.wrap(
            line, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
        ) or [""]
    return "\n".join(lines)


def say(text: object) -> None:
    """Print; on a terminal no line is wider than it. A file or a pipe gets the lines as they are."""
    width = max(40, shutil.get_terminal_size().columns - 1)
    print(wrapped(str(text), width) if sys.stdout.isatty() else text)


@contextmanager
def busy(title: str, after: float = 2.0) -> Iterator[Callable[[str], None]]:
    """Seconds on the terminal, for what takes longer than ``after`` [s] and cannot tell how far it is. What it yields
    is called with what is done from now on."""
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    done, start, titles = threading.Event(), time.monotonic(), [title]

    def show() -> None:
        wait = after
        while not done.wait(wait):
            wait = 0.5
            sys.stderr.write(f"\r{titles[-1]} ... {time.monotonic() - start:.0f} s \033[K")
            sys.stderr.flush()

    shower = threading.Thread(target=show, daemon=True)
    shower.start()
    try:
        yield titles.append
    finally:
        done.set()
        shower.join()
        if time.monotonic() - start > after:
            sys.stderr.write(f"\r{' ' * (max(map(len, titles)) + 16)}\r")


@contextmanager
def picture() -> Iterator[None]:
    """Draw it, or say why it is left out."""
    try:
        yield
    except MissingExtra as missing:
        print(f"picture left out: {missing}")


def answered(out: Path, names: Iterable[str], facts: Mapping[str, Any], words: str) -> dict[str, Any]:
    """Say the facts in words, and which files there are; the answer for --json."""
    files = [name for name in names if (out / name).exists()]
    say(words)
    say(f"written to {out}/: {', '.join(files)}")
    return {**facts, "folder": str(out), "files": files}


@contextmanager
def progress_bar(title: str) -> Iterator[Callable[[float], None]]:
    """A bar on the terminal, for what takes longer than a second; called with the fraction done. None in a log, and
    none where tqdm is missing."""
    try:
        tqdm = require("tqdm", "app").tqdm
    except MissingExtra:
        with busy(title):
            yield lambda _: None
        return
    tqdm.monitor_interval = 0  # no thread of its own: the guard forks only a process that has none
    layout = "{l_bar}{bar}| {elapsed}<{remaining}"
    options = {"desc": title, "delay": 1.0, "bar_format": layout, "leave": False, "file": sys.stderr}
    with tqdm(total=1.0, disable=not sys.stderr.isatty(), **options) as bar:
        yield lambda fraction: bar.update(fraction - bar.n)
