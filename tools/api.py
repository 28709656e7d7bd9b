#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Write the public API as two listings, a declaration a line: docs/api/c.txt and docs/api/python.txt.

`tools/api.py` writes them, `tools/api.py --check` fails where they are out of date. A change of a listing is a
decision: it belongs into CHANGELOG.md, under what docs/stability.md promises. C needs the headers only (without
`nanotouch/advanced`, which has no promise), Python the package with its extras.
"""

from __future__ import annotations

import argparse
import difflib
import importlib
import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parents[1]
HEADERS = ROOT / "libnanotouch/include/nanotouch"
LISTINGS = ROOT / "docs/api"


# --- C ---------------------------------------------------------------------------------------------------------------
def _bare(text: str) -> str:
    """A header without comments, directives other than `#define`, and the bodies of inline functions."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", text, flags=re.S)
    text = re.sub(r"\\\n", " ", text)
    text = re.sub(r"^\s*#\s*(?!define\b).*$", "", text, flags=re.M)
    text = re.sub(r'extern "C"\s*\{', "", text)
    return re.sub(r"\)\s*\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\}", ");", text)


def _split(text: str) -> Iterator[str]:
    """Declarations at the outermost level, each in one line."""
    depth, begin = 0, 0
    for at, sign in enumerate(text):
        depth = max(0, depth + (sign == "{") - (sign == "}"))
        if sign == ";" and depth == 0:
            yield re.sub(r"\s+", " ", text[begin:at]).strip()
            begin = at + 1


def c_header(path: Path) -> list[str]:
    """The macros, types and functions of a header."""
    text = _bare(path.read_text(encoding="utf-8"))
    macros = re.findall(r"^\s*#\s*define\s+(NT_\w+(?:\([^)]*\))?)", text, flags=re.M)
    rest = re.sub(r"^\s*#.*$", "", text, flags=re.M)
    lines = [f"#define {macro}" for macro in macros]
    for declaration in _split(rest):
        bare = re.sub(r"^(?:[}\s]*)(?:NT_API|NT_INLINE|static inline)?\s*", "", declaration)
        if bare:
            lines.append(bare)
    return lines


def c_listing() -> str:
    """All public headers, in the order of their names."""
    parts = []
    for path in sorted(HEADERS.glob("*.h")):
        lines = c_header(path)
        if lines:
            parts.append("\n".join([f"nanotouch/{path.name}", *(f"  {line}" for line in lines)]))
    return "\n\n".join(parts) + "\n"


# --- Python ----------------------------------------------------------------------------------------------------------
def _signature(name: str, thing: object) -> str:
    first = (getattr(thing, "__doc__", None) or "").split("\n", 1)[0]
    if re.match(rf"{re.escape(name)}\(.*\)", first):  # pybind11 writes it there
        return re.sub(r" at 0x[0-9a-f]+", "", first)
    try:
        signature = inspect.signature(thing)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return f"{name}(...)"
    parameters = [p.replace(annotation=inspect.Parameter.empty) for p in signature.parameters.values()]
    text = str(signature.replace(parameters=parameters, return_annotation=inspect.Signature.empty))
    return name + re.sub(r"<([\w.]+)[^<>]*>", r"<\1>", text)


def _members(cls: type) -> Iterator[str]:
    """What a class of ours adds to Python's own: methods with their parameters, properties, fields."""
    shown: dict[str, object] = {}
    for base in reversed(cls.__mro__):
        if base.__module__.startswith("nanotouch"):
            shown.update({name: inspect.getattr_static(cls, name, None) for name in [*vars(base), *_fields(base)]})
    for name in sorted(shown):
        if name.startswith("_") and name != "__init__":
            continue
        member = shown[name]
        if isinstance(member, (staticmethod, classmethod)):
            member = member.__func__
        if inspect.isroutine(member) or type(member).__name__ == "instancemethod":
            yield _signature(name, getattr(cls, name))
        else:
            yield name


def _fields(cls: type) -> list[str]:
    return list(getattr(cls, "__annotations__", {}))


def _names(module: ModuleType) -> list[str]:
    listed = getattr(module, "__all__", None)
    if listed is not None:
        return sorted(listed)
    return sorted(
        name for name, value in vars(module).items() if not name.startswith("_") and _is_of(value, module.__name__)
    )  # fmt: skip


def _is_of(value: object, module: str) -> bool:
    """Whether the module brings this itself; what it only imports from a sibling is listed there, helpers nowhere."""
    home = getattr(value, "__module__", None) or ""
    ours = (f"{module}.", "nanotouch._" if inspect.isclass(value) else "nanotouch._core")
    return home == module or home.startswith(ours)


def python_listing() -> str:
    """All public modules of the package, in the order of their names."""
    package = importlib.import_module("nanotouch")
    parts = ["nanotouch\n" + "\n".join(f"  {name}" for name in sorted(package.__all__))]
    for short, full in sorted(package._MODULES.items()):
        module = importlib.import_module(f"nanotouch.{full}")
        lines = [f"nanotouch.{short}"]
        for name in _names(module):
            value = getattr(module, name)
            if inspect.isclass(value):
                lines.append(f"  class {name}")
                lines += [f"    {member}" for member in _members(value)]
            elif callable(value):
                lines.append(f"  {_signature(name, value)}")
            else:
                lines.append(f"  {name}")
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


# --- the two together ------------------------------------------------------------------------------------------------
def changes(path: Path, listing: str) -> str:
    """The difference between the listing that is kept and what the sources say; empty: none."""
    kept = path.read_text(encoding="utf-8") if path.exists() else ""
    return "\n".join(difflib.unified_diff(kept.splitlines(), listing.splitlines(), "kept", "sources", "", "", 0, ""))


def main() -> int:
    """Write the listings, or compare them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="change nothing; exit status 1 where one is out of date")
    args = parser.parse_args()
    failed = 0
    for name, listing in (("c", c_listing()), ("python", python_listing())):
        path = LISTINGS / f"{name}.txt"
        difference = changes(path, listing)
        if difference and args.check:
            print(difference)
            failed = 1
        elif difference:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(listing, encoding="utf-8")
            print(f"written: {path.relative_to(ROOT)}, {listing.count(chr(10))} lines")
    return failed


if __name__ == "__main__":
    sys.exit(main())
