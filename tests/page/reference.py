# SPDX-License-Identifier: BSD-3-Clause
"""The reference session natively and as WebAssembly in Node: forces within 1e-12 of the largest one.

Usage: reference.py NATIVE FILE.wasm. Status 77, with a word, where node or zig's compiler is not there."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ALLOWED = 1e-12
OLDEST = 18  # major version of node


def skip(why: str) -> None:
    """Nothing can be compared."""
    print(f"skipped: {why}")
    sys.exit(77)


def python_with_zig() -> str:
    """This one, or that of the venv."""
    for python in (ROOT / ".venv/bin/python", Path(sys.executable)):
        if python.exists() and not subprocess.run([python, "-c", "import ziglang"], capture_output=True).returncode:
            return str(python)
    skip("ziglang is not installed: pip install --require-hashes -r apps/page/requirements.txt")
    raise AssertionError


def node_that_runs() -> str:
    """A new one."""
    node = shutil.which("node")
    if node is None:
        skip("there is no node")
    assert node is not None
    version = subprocess.run([node, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    if int(version[1:].split(".")[0]) < OLDEST:
        skip(f"node {version} is older than {OLDEST}")
    return node


def main(native: str, wasm: str) -> int:
    """Compare."""
    node = node_that_runs()
    subprocess.run([python_with_zig(), ROOT / "apps/page/build_wasm.py", wasm], check=True)
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / "native.txt"
        rows.write_bytes(subprocess.run([native], capture_output=True, check=True).stdout)
        told = subprocess.run([node, HERE / "reference.mjs", wasm, rows], capture_output=True, text=True, check=True)
    found = json.loads(told.stdout)
    print(found)
    good = found["rows"] == found["wanted"] == 900 and found["contacts"] > 100 and found["largest"] > 1e-7
    return 0 if good and max(found["force"], found["gap"]) <= ALLOWED and found["time"] == 0.0 else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
