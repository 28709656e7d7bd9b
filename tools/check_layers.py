# SPDX-License-Identifier: BSD-3-Clause
"""Check who includes or imports whom, and that the list of sources is complete.

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
    "contact": "core contact/maugis",
    "contact/maugis": "core contact",
    "contact/shapes": "core contact",
    "friction": "core contact contact/maugis",
    "manipulation": "core contact contact/maugis friction",
    "surface": "core",
    "plasticity": "core contact surface",
    "rheology": "core contact",
    "control": "core",
    "curves": "core",
    "dynamics": "core",
    "hal": "core",
    "hal/chips": "core hal",
    "scene": "core forces contact friction plasticity rheology surface scene/terms scene/deformation",
    "scene/terms": "core forces contact friction plasticity rheology surface scene",
    "scene/deformation": "core forces contact friction plasticity rheology surface scene scene/terms",
    "scan": "core forces contact friction plasticity rheology surface scene dynamics",
    "view": "core forces contact friction plasticity rheology surface scene",
    "hal/sim": "core forces contact friction manipulation plasticity rheology surface scene dynamics scan hal",
    "hal/linux": "core hal hal/chips",
    "session": "core forces contact friction manipulation plasticity rheology surface scene dynamics scan control hal "
    "hal/sim",
    "host": "core forces contact friction manipulation plasticity rheology surface scene control hal hal/sim session",
    "fit": "core forces contact contact/maugis curves rheology fit/models",
    "fit/models": "core contact contact/maugis curves fit",
    "testing": "core control session",
}

# The layer that each public or internal header belongs to, where it is not named after it (contact_equilibrium.h).
HEADERS = {
    **dict.fromkeys(["status", "types", "material", "rig", "field", "version", "random"], "core"),
    **dict.fromkeys(["geometry", "maugis"], "contact"),
    "corrugation": "friction",
    **dict.fromkeys(["margins", "settings", "touch"], "control"),
    **dict.fromkeys(["plan", "interaction", "force_table"], "scene"),
    **dict.fromkeys(["balance", "steady", "tapping"], "scan"),
    "sim": "hal/sim",
    **dict.fromkeys(["frames", "hazard", "observer", "terrain"], "session"),
    **dict.fromkeys(["converters", "hal_iio"], "hal/chips"),
    "hal_linux": "hal/linux",
    **dict.fromkeys(["hal_replay", "mailbox", "timing"], "hal"),
}

# What the portable layers may take from the C library: nothing that allocates, prints or knows an operating system.
PORTABLE = USES.keys() - {"hal", "hal/linux", "session", "fit", "testing"}
SYSTEM_HEADERS = {
    "complex", "float", "inttypes", "limits", "math", "stdarg", "stdatomic", "stdbool", "stddef", "stdint", "string",
}  # fmt: skip
# Of hal, what is outside the portable core.
HOSTED = "clock load loop mailbox mailbox_half shared_memory shared_memory_windows timed_loop"
HOSTED_FILES = {f"hal/{name}.c" for name in HOSTED.split()}
PRINTING_FILES = {"core/status.c", "host/text.c"}  # may use snprintf, into the caller's buffer

# Added as a file, without a line in sources.cmake.
FOUND_BY_CMAKE = "fit/models/"

# The modules and packages of the Python library from the bottom up; each may import what stands before it.
PYTHON = ROOT / "bindings/python/nanotouch"
PYTHON_LAYERS = {
    "what all need": "extras _core errors formats units guard _arrays awaiting _io",
    "laws": "ufuncs contact forces friction lateral",
    "objects": "manipulation plasticity rheology",
    "measured": "images curves",
    "what there is": "scene reference scan",
    "a touch": "touch",
    "results": "plots fit batch maps testing",
    "a process of its own": "_worker_process __main__",
}
# Methods for convenience, such as Recording.plot, may import what makes their answer: in a function, or for its type.
CONVENIENT = {("touch", "plots"), ("images", "maps"), ("scene", "maps")}

INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


def layer_of_file(path: Path) -> str:
    """Return the layer that a file of the library belongs to."""
    relative = path.relative_to(LIBRARY)
    if relative.parts[0] in ("include", "internal"):
        return layer_of_header(path.stem)
    return relative.parent.as_posix()


def layer_of_header(stem: str) -> str:
    """Return the layer of a public or internal header; "" for one that this script does not know."""
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
    if name.startswith(("nanotouch/", "internal/")):
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
    found = {name for name in found if not name.startswith(FOUND_BY_CMAKE)}
    yield from (
        f"libnanotouch/{name}:1: is not listed in libnanotouch/sources.cmake" for name in sorted(found - listed)
    )
    yield from (f"libnanotouch/sources.cmake:1: lists {name}, which is not there" for name in sorted(listed - found))


def check_users() -> Iterator[str]:
    """Yield the offences of bindings and apps: they include public headers, those that tools/single.py writes and their
    own; the bindings, which are built from the same sources, internal headers, too; nothing else inside."""
    for folder, inside in (("bindings", "internal/"), ("apps", "nanotouch/")):
        for path in sorted(p for p in (ROOT / folder).rglob("*") if p.suffix in {".c", ".cpp", ".h", ".hpp"}):
            for number, mark, name in includes(path):
                public = name.startswith(("nanotouch/", "nanotouch_single", inside))
                own = mark == "<" or public or (path.parent / name).exists()
                if not own:
                    yield f'{path.relative_to(ROOT)}:{number}: "{name}" is not a public header'


def imported(path: Path) -> Iterator[tuple[ast.stmt, str]]:
    """Yield the statement and the dotted name of every import of a Python file."""
    package = list(path.relative_to(PYTHON.parent).parts[:-1]) if path.is_relative_to(PYTHON) else []
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from ((node, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = package[: len(package) + 1 - node.level] if node.level else []
            yield from ((node, ".".join([*start, *filter(None, [node.module]), alias.name])) for alias in node.names)


def check_python() -> Iterator[str]:
    """Yield the offences of the Python code: the library knows no app, the app only the library's public names."""
    for folder, forbidden in (
        ("bindings/python/nanotouch", re.compile(r"nanotouch_app\b")),
        ("apps", re.compile(r"nanotouch\.(.*\.)?_")),
    ):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for node, name in imported(path):
                if forbidden.match(name) and not name.endswith("__"):
                    yield f"{path.relative_to(ROOT)}:{node.lineno}: may not import {name}"


def check_python_layers() -> Iterator[str]:
    """Yield the imports within the Python library that go up, and modules without a layer."""
    ranks = {name: rank for rank, name in enumerate(" ".join(PYTHON_LAYERS.values()).split())}
    for path in sorted(PYTHON.rglob("*.py")):
        layer = path.relative_to(PYTHON).parts[0].removesuffix(".py")
        if layer == "__init__":  # the names of the whole, loaded when they are first used
            continue
        if layer not in ranks:
            yield f"{path.relative_to(ROOT)}:1: {layer} has no layer in tools/check_layers.py"
            continue
        for node, name in imported(path):
            used = name.split(".")[1] if name.startswith("nanotouch.") else ""
            convenient = (layer, used) in CONVENIENT and node.col_offset > 0
            if ranks.get(used, -1) > ranks[layer] and not convenient:
                yield f"{path.relative_to(ROOT)}:{node.lineno}: {layer} may not import {used}"


def main() -> int:
    """Print all offences."""
    offences = [*check_sources(), *check_library(), *check_users(), *check_python(), *check_python_layers()]
    print("\n".join(offences) or "every source is listed, every include and import keeps to its layer")
    return min(len(offences), 99)


if __name__ == "__main__":
    sys.exit(main())
