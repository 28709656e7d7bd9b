# SPDX-License-Identifier: BSD-3-Clause
"""What killed programs leave in shared memory goes when the next one makes something there; what lives stays."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import nanotouch as nt
import pytest

SHARED = Path("/dev/shm")
pytestmark = pytest.mark.skipif(not SHARED.is_dir(), reason="shared memory of Linux")
CODE = """
import os, sys, nanotouch as nt
session = nt.Session(seed=1, recorded=False)
session.publish(f"test-{os.getpid()}-1")
print("ready", flush=True)
sys.stdin.read()
"""


def _of(process: int) -> set[str]:
    return {one.name for one in SHARED.iterdir() if one.name.startswith("nanotouch.") and f"-{process}-" in one.name}


def test_what_a_killed_program_has_left_is_reclaimed() -> None:
    def started() -> subprocess.Popen[str]:
        made = subprocess.Popen([sys.executable, "-c", CODE], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert made.stdout is not None
        assert made.stdout.readline()
        return made

    with started() as killed, started() as living:
        assert _of(killed.pid)
        held = _of(living.pid)
        killed.send_signal(signal.SIGKILL)
        killed.wait()
        foreign = SHARED / "nanotouch-elsewhere"
        foreign.write_text("not ours")
        try:
            other = nt.Session(seed=2, recorded=False)
            other.publish(f"test-{os.getpid()}-2")
            assert not _of(killed.pid)
            assert _of(living.pid) == held
            assert foreign.exists()
            del other
        finally:
            foreign.unlink()
            living.terminate()
