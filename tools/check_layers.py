# SPDX-License-Identifier: BSD-3-Clause
"""Check who includes whom, and that the list of sources is complete.

Prints each offence as file:line and exits with their number.
"""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIBRARY = ROOT / "libnanotouch"

# What each layer may use besides itself. A folder is a layer; hal/sim and hal/linux are layers of their own.
USES = {
    "core": "",
    "forces": "core",
    "contact": "core",
    "surface": "core",
    "control": "core",
    "dynamics": "core",
    "hal": "core",
    "scene": "core forces contact surface",
    "hal/sim": "core forces contact surface scene dynamics hal",
    "hal/linux": "core hal",
    "session": "core forces contact surface scene dynamics control hal hal/sim",
    "fit": "core forces contact",
}

# The layer that each public header belongs to, where it is not named after it (contact.h, contact_table.h).
HEADERS = {
    **dict.fromkeys(["status", "types", "material", "rig", "field", "version", "random"], "core"),
    "geometry": "contact",
    **dict.fromkeys(["guarantee", "margins", "passivity", "preflight", "scaling", "servo"], "control"),
    **dict.fromkeys(["settings", "stage_loop", "supervisor", "touch"], "control"),
    **dict.fromkeys(["plan", "interaction"], "scene"),
    "sim": "hal/sim",
    "faults": "hal/sim",
    "hal_linux": "hal/linux",
}

# What the portable layers may take from the C library: nothing that allocates, prints or knows an operating system.
PORTABLE = USES.keys() - {"hal", "hal/linux", "session", "fit"}
SYSTEM_HEADERS = {
    "complex", "float", "inttypes", "limits", "math", "stdarg", "stdatomic", "stdbool", "stddef", "stdint", "string",
}  # fmt: skip
HOSTED_FILES = {"hal/loop.c"}  # of hal, what is outside the portable core
PRINTING_FILES = {"core/status.c"}  # may use snprintf, into the caller's buffer

INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def layer_of_file(path: Path) -> str:
    """Return the layer that a file of the library belongs to."""
    relative = path.relative_to(LIBRARY)
    if relative.parts[0] == "include":
        return layer_of_header(path.stem)
    return relative.parent.as_posix()


def layer_of_header(stem: str) -> str:
    """Return the layer of a public header; "" for one that this script does not know."""
    prefix = stem.split("_")[0]
    return HEADERS.get(stem, prefix if prefix in USES else "")


def includes(path: Path) -> Iterator[tuple[int, str, str]]:
    """Yield line number, opening mark and name of each include of a C or C++ file."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if match := INCLUDE.match(line):
            yield number, match[1], match[2]


def check_system_include(path: Path, name: str) -> str:
    """Return what is wrong with an include of a header in angle brackets, or ""."""
    file, layer = path.relative_to(LIBRARY).as_posix(), layer_of_file(path)
    portable = layer in PORTABLE or (layer == "hal" and file not in HOSTED_FILES)
    allowed = SYSTEM_HEADERS | ({"stdio"} if file in PRINTING_FILES else set())
    return f"<{name}> is not portable" if portable and name.removesuffix(".h") not in allowed else ""


def check_own_include(path: Path, name: str) -> str:
    """Return what is wrong with an include of one of our headers, or ""."""
    layer = layer_of_file(path)
    beside = (path.parent / name).resolve()
    if name.startswith("nanotouch/"):
        used = layer_of_header(Path(name).stem)
        if not used:
            return f'"{name}" has no layer in tools/check_layers.py'
    else:
        used = (beside if beside.exists() else LIBRARY / name).parent.relative_to(LIBRARY).as_posix()
    return "" if used == layer or used in USES[layer].split() else f"{layer} may not include {used} ({name})"


def check_library() -> Iterator[str]:
    """Yield the offences of the library's own files."""
    for path in sorted(p for p in LIBRARY.rglob("*") if p.suffix in {".c", ".cpp", ".h", ".hpp"}):
        if path == LIBRARY / "include/nanotouch/nanotouch.h":  # the umbrella, which nobody inside may include
            continue
        if layer_of_file(path) not in USES:
            yield f"{path.relative_to(ROOT)}:1: belongs to no layer of tools/check_layers.py"
            continue
        for number, mark, name in includes(path):
            offence = check_system_include(path, name) if mark == "<" else check_own_include(path, name)
            if offence:
                yield f"{path.relative_to(ROOT)}:{number}: {offence}"


def check_sources() -> Iterator[str]:
    """Yield the sources that sources.cmake does not list, and those that it lists and are not there."""
    listed = set(re.findall(r"[\w/]+\.c(?:pp)?\b", (LIBRARY / "sources.cmake").read_text()))
    found = {p.relative_to(LIBRARY).as_posix() for p in LIBRARY.rglob("*") if p.suffix in {".c", ".cpp"}}
    yield from (
        f"libnanotouch/{name}:1: is not listed in libnanotouch/sources.cmake" for name in sorted(found - listed)
    )
    yield from (f"libnanotouch/sources.cmake:1: lists {name}, which is not there" for name in sorted(listed - found))


def check_users() -> Iterator[str]:
    """Yield the offences of bindings and apps: they include public headers and their own, nothing inside."""
    for folder in ("bindings", "apps"):
        for path in sorted(p for p in (ROOT / folder).rglob("*") if p.suffix in {".c", ".cpp", ".h", ".hpp"}):
            for number, mark, name in includes(path):
                own = mark == "<" or name.startswith("nanotouch/") or (path.parent / name).exists()
                if not own:
                    yield f'{path.relative_to(ROOT)}:{number}: "{name}" is not a public header'


def imported(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield line number and dotted name of every absolute import of a Python module."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield from ((node.lineno, f"{node.module}.{alias.name}") for alias in node.names)


def check_python() -> Iterator[str]:
    """Yield the offences of the Python code: the library knows no app, the app only the library's public names."""
    for folder, forbidden in (
        ("bindings/python/nanotouch", re.compile(r"nanotouch_app\b")),
        ("apps", re.compile(r"nanotouch\.(.*\.)?_")),
    ):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for number, name in imported(ast.parse(path.read_text())):
                if forbidden.match(name) and not name.endswith("__"):
                    yield f"{path.relative_to(ROOT)}:{number}: may not import {name}"


def main() -> int:
    """Print all offences."""
    offences = [*check_sources(), *check_library(), *check_users(), *check_python()]
    print("\n".join(offences) or "every source is listed, every include and import keeps to its layer")
    return min(len(offences), 99)


if __name__ == "__main__":
    sys.exit(main())
