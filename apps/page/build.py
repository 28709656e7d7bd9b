# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch-touch.html: the C library as WebAssembly, the words of the Python tables, the page's modules and vtk.js, in
one file. `make page` runs it; it needs ziglang (apps/page/requirements.txt), node and npm.

Usage: python apps/page/build.py FILE.html"""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import sys
from pathlib import Path

import build_wasm
import export

PAGE = Path(__file__).resolve().parent
LARGEST = 3_000_000  # [byte]
NEEDED = ("node", "npm")
BUNDLED = ("@kitware/vtk.js", "smol-toml")


def modules(folder: Path) -> Path:
    """What package-lock.json pins by hash, fetched once; no script of a package runs."""
    lock = (PAGE / "package-lock.json").read_text(encoding="utf-8")
    stamp = folder / "stamp.json"
    if not stamp.exists() or stamp.read_text(encoding="utf-8") != lock:
        folder.mkdir(parents=True, exist_ok=True)
        for name in ("package.json", "package-lock.json"):
            shutil.copy(PAGE / name, folder / name)
        quiet = ["--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"]
        subprocess.run(["npm", "ci", *quiet], cwd=folder, check=True)
        stamp.write_text(lock, encoding="utf-8")
    return folder / "node_modules"


def bundle(entry: str, packages: Path) -> str:
    """One module with all that it imports, as a script."""
    command = [
        packages / ".bin/esbuild", PAGE / "src" / entry, "--bundle", "--minify", "--format=iife", "--target=es2022",
        "--legal-comments=none", "--log-level=warning", '--define:process.env.NODE_ENV="production"',
        "--define:global=globalThis",
        f"--alias:@kitware/vtk.js={packages / '@kitware/vtk.js'}", f"--alias:smol-toml={packages / 'smol-toml'}",
    ]  # fmt: skip
    environment = {"NODE_PATH": str(packages), "PATH": str(Path(shutil.which("node") or "node").parent)}
    return subprocess.run(command, check=True, capture_output=True, env=environment).stdout.decode("utf-8")


def inline(script: str) -> str:
    """As it may stand between tags."""
    return script.replace("</script", r"<\/script").replace("<!--", r"<\!--")


def licences(packages: Path) -> str:
    """Of what is in the file."""
    own = (PAGE.parent.parent / "LICENSE").read_text(encoding="utf-8")
    texts = {name: (packages / name / "LICENSE").read_text(encoding="utf-8") for name in BUNDLED}
    return "\n\n".join(["libnanotouch", own, *(f"{name}\n{text}" for name, text in texts.items())]).replace("--", "- -")


def build(target: Path) -> None:
    """Make the page."""
    missing = [name for name in NEEDED if shutil.which(name) is None]
    if missing:
        raise SystemExit(f"the page needs {' and '.join(missing)}: install Node.js 18 or newer")
    folder = target.parent
    wasm = folder / "nanotouch.wasm"
    build_wasm.build(wasm)
    packages = modules(folder / "npm")
    parts = {
        "STYLE": (PAGE / "style.css").read_text(encoding="utf-8"),
        "TABLE": json.dumps(export.everything(), separators=(",", ":")).replace("</", r"<\/"),
        "WASM": base64.b64encode(wasm.read_bytes()).decode(),
        "WORKER": inline(bundle("worker.js", packages)),
        "MAIN": inline(bundle("main.js", packages)),
    }
    page = (PAGE / "page.html").read_text(encoding="utf-8")
    for name, text in parts.items():
        head, mark, tail = page.partition(f"/*{name}*/")
        assert mark, name
        page = head + text + tail
    page += f"<!--\n{licences(packages)}\n-->\n"
    size = len(page.encode())
    told = ", ".join(f"{name.lower()} {len(text.encode()) / 1e3:.0f} kB" for name, text in parts.items())
    if size > LARGEST:
        raise SystemExit(f"the page has {size} bytes; {LARGEST} are allowed ({told})")
    target.write_text(page, encoding="utf-8")
    print(f"{target}: {size / 1e6:.2f} MB ({told})")


if __name__ == "__main__":
    build(Path(sys.argv[1]).resolve())
