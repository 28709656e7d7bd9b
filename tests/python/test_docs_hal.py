# SPDX-License-Identifier: BSD-3-Clause
"""The pages on backends say what is so: the code is that of the examples, the tables are those of the headers."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import threading
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/hal.md").read_text(encoding="utf-8")
GUIDE = (ROOT / "docs/howto/backend.md").read_text(encoding="utf-8")
EXAMPLES = ROOT / "docs/examples/hal"
HEADER = (ROOT / "libnanotouch/include/nanotouch/hal_backend.h").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", GUIDE, re.DOTALL | re.MULTILINE)


def test_code_is_that_of_the_examples() -> None:
    python = "".join(path.read_text(encoding="utf-8") for path in sorted(EXAMPLES.glob("*.py")))
    excerpts = [block for block in blocks("python") if not block.startswith("import nanotouch")]
    assert len(excerpts) == 6
    assert all(block in python for block in excerpts)
    c = (EXAMPLES / "pointer.c").read_text(encoding="utf-8")
    assert len(blocks("c")) == 2
    assert all(block in c for block in blocks("c"))


def test_operations_are_those_of_the_header() -> None:
    (table,) = re.findall(r"typedef struct nt_backend \{(.*?)\} nt_backend;", HEADER, re.DOTALL)
    operations = re.findall(r"\(\*(\w+)\)", table)
    assert re.findall(r"^\| `(\w+)` \|", PAGE, re.MULTILINE) == operations


def test_links_lead_somewhere() -> None:
    for link in re.findall(r"\]\(([^)]+)\)", PAGE):
        assert (ROOT / "docs" / link).exists(), link


def test_page_is_followed_step_by_step(tmp_path: Path) -> None:
    """Its commands, as they stand: compile, start the device, rehearse the object."""
    if shutil.which("cc") is None:
        pytest.skip("no C compiler")
    compile_it, start_it, _ = blocks("sh")
    command = compile_it.replace("-o pointer.so", f"-o {tmp_path}/pointer.so")
    subprocess.run(command, shell=True, check=True, cwd=ROOT)
    script = next(block for block in blocks("python") if "rehearse" in block)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    device = [sys.executable, *start_it.split()[1:-1]]  # on a port that is free
    with subprocess.Popen(device, stdout=subprocess.PIPE, text=True, cwd=ROOT) as served:
        assert served.stdout is not None
        timer = threading.Timer(60.0, served.kill)
        timer.start()
        port = served.stdout.readline().strip()
        code = script.replace("47001", port)
        for _ in range(5):  # a busy machine: the device may not get its turn in time
            done = subprocess.run(
                [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
            )
            if done.returncode == 0 or "age of a reading" not in done.stderr:
                break
        timer.cancel()
        served.kill()
    assert "Rehearsed(readings=" in done.stdout or "age of a reading" in done.stderr, done.stderr
