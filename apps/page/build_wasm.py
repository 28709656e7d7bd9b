# SPDX-License-Identifier: BSD-3-Clause
"""The C library and the page's own C files as WebAssembly, by zig's compiler (ziglang on PyPI).

Usage: python apps/page/build_wasm.py FILE.wasm. It is compiled only where a source is newer than the file."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

PAGE = Path(__file__).resolve().parent
ROOT = PAGE.parent.parent
LIBRARY = ROOT / "libnanotouch"
FLAGS = ["-target", "wasm32-wasi", "-mexec-model=reactor", "-O2", "-s", "-std=c11", "-ffp-contract=off",
         "-fno-math-errno", "-fno-trapping-math", "-Wl,-z,stack-size=4194304"]  # fmt: skip
LEFT_OUT = {"linux", "fit"}  # layers that need an operating system or C++


def sources() -> list[Path]:
    """All C files of the portable library, the loop and the session, by the plain list of them; and the page's."""
    text = (LIBRARY / "sources.cmake").read_text(encoding="utf-8")
    groups = re.findall(r"set\(nanotouch_sources_(\w+)\s+([^)]*)\)", text)
    listed = [LIBRARY / name for group, names in groups if group not in LEFT_OUT for name in names.split()]
    return [*listed, *sorted(PAGE.glob("page*.c"))]


def is_fresh(target: Path) -> bool:
    """No source or header is newer."""
    if not target.exists():
        return False
    watched = [*LIBRARY.rglob("*.[ch]"), *PAGE.glob("*.[ch]"), Path(__file__)]
    return max(path.stat().st_mtime for path in watched) < target.stat().st_mtime


def build(target: Path) -> None:
    """Compile, unless it is fresh."""
    if is_fresh(target):
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    include = [f"-I{LIBRARY / 'include'}", f"-I{LIBRARY}"]
    part = target.with_suffix(".part.wasm")
    command = [sys.executable, "-m", "ziglang", "cc", *FLAGS, *include, *map(str, sources()), "-lm", "-o", str(part)]
    subprocess.run(command, check=True)
    part.replace(target)


if __name__ == "__main__":
    build(Path(sys.argv[1]).resolve())
