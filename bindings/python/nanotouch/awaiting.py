# SPDX-License-Identifier: BSD-3-Clause
"""Work in threads of its own, so that Ctrl-C is answered at once: Python handles a signal only between two steps of the
main thread, and what the compiled code has in hand may take a minute."""

from __future__ import annotations

import contextvars
import ctypes
import os
import threading
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

ASKED_EVERY = 0.1  # whether the work is to end [s]
_LET_END = 0.3  # time that abandoned work has to put away what it holds [s]

Result = TypeVar("Result")
_abandoned: list[threading.Thread] = []


class Abandoned(KeyboardInterrupt):
    """Ends a thread whose result nobody waits for any more; passes wherever a stop by the user passes."""


def awaited(work: Callable[[], Result]) -> Result:
    """The result of `work`, or what it raises. What a signal raises here in the meantime leaves the work behind: its
    Python code is ended, and what the compiled code has in hand is not waited for."""
    if threading.current_thread() is not threading.main_thread():  # signals do not come here
        return work()
    done, found = threading.Event(), list[tuple[Result | None, BaseException | None]]()
    context = contextvars.copy_context()

    def labor() -> None:
        try:
            found.append((context.run(work), None))
        except BaseException as error:
            found.append((None, error))
        finally:
            done.set()

    thread = threading.Thread(target=labor, daemon=True)
    try:
        thread.start()
        while not done.wait(ASKED_EVERY):
            pass
    except BaseException:
        _abandon(thread)
        raise
    result, error = found.pop()
    if error is not None:
        raise error
    return result  # type: ignore[return-value]


def _abandon(thread: threading.Thread) -> None:
    _abandoned.append(thread)
    if thread.ident is not None:
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), ctypes.py_object(Abandoned))
        thread.join(_LET_END)


def left() -> bool:
    """Whether work that was left behind still goes on: the interpreter must not be taken down beneath it."""
    return any(thread.is_alive() for thread in _abandoned)


def each(
    work: Callable[[int], Result], items: range, kept: Callable[[int, Result], bool | None],
    waits: Callable[[int], bool | None], threads: int | None,
) -> int:  # fmt: skip
    """Work on the cores; results are reported in order, with their number. False, or what that raises, ends the
    rest. How many were told.

    While one is awaited ``waits`` is asked, with how many were told, and may end it likewise. What the compiled code
    has in hand then is not waited for: it may take a minute."""
    found: dict[int, Result | BaseException] = {}
    left: list[bool] = []
    todo, arrived = iter(items), threading.Condition()

    def labor() -> None:
        while not left:
            with arrived:
                number = next(todo, None)
            if number is None:
                return
            try:
                result: Result | BaseException = work(number)
            except BaseException as error:
                result = error
            with arrived:
                found[number] = result
                arrived.notify()

    for _ in range(min(threads or os.cpu_count() or 1, len(items))):
        threading.Thread(target=labor, daemon=True).start()
    try:
        for told, number in enumerate(items):
            while not _has(found, number, arrived):
                if waits(told) is False:
                    return told
            result = found.pop(number)
            if isinstance(result, BaseException):
                raise result
            if kept(told, result) is False:
                return told + 1
    finally:
        left.append(True)
    return len(items)


def _has(found: Mapping[int, Any], number: int, arrived: threading.Condition) -> bool:
    """Whether it has arrived, after a short wait."""
    with arrived:
        return arrived.wait_for(lambda: number in found, ASKED_EVERY)
