#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Words that are not the field's: how often they stand in names of files, of the public C library and of Python, and in
what the command prints. ``words.py --list`` shows where. A test keeps the counts from growing."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
WORDS = {
    "half": "device",
    "halves": "devices",
    "leader": "clock source",
    "bank": "table family",
    "terrain": "contact surface",
    "calm": "haptic quality",
    "hazard": "overload bound",
    "guarantee": "force bound",
    "lay": "place",
    "laid": "placed",
    "fur": "brush",
    "share": "fraction",
    "largest": "max",
    "least": "min",
    "told": "reported",
    "tells": "reports",
    "seen": "client state",
    "desk": "process manager",
    "door": "connection limit",
    "reel": "playback",
    "rehearse": "check conformance",
    "rehearsal": "conformance check",
}
"""word: what the field says"""
ENGLISH = {"half_angle", "half_space", "half_width", "half_period", "half_power", "at_least", "share_memory"}
"""names in which the word is plain English"""


def parts(name: str) -> list[str]:
    """The words of an identifier or a file name."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()
    for english in ENGLISH:
        spaced = spaced.replace(english, "")
    return re.split(r"[^a-z]+", spaced)


def tracked(*endings: str) -> list[Path]:
    """The files of the project that end like this, without tests and evidence."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    skipped = ("tests/", "docs/evidence/")
    return [Path(name) for name in listed.splitlines() if name.endswith(endings) and not name.startswith(skipped)]


def files() -> list[tuple[str, str]]:
    """Names of files, with where they are."""
    return [(path.stem, path.as_posix()) for path in tracked(".py", ".c", ".h", ".cpp", ".hpp", ".js", ".md")]


def c_names() -> list[tuple[str, str]]:
    """Functions, types and constants of the public and internal headers."""
    found = set()
    for path in tracked(".h"):
        if path.parts[:2] in (("libnanotouch", "include"), ("libnanotouch", "internal")):
            text = re.sub(r"/\*.*?\*/", "", (ROOT / path).read_text(encoding="utf-8"), flags=re.DOTALL)
            found |= {(name, path.as_posix()) for name in re.findall(r"\b(?:nt_|NT_)\w+", text)}
    return sorted(dict(sorted(found)).items())


def python_names() -> list[tuple[str, str]]:
    """Public functions, classes and parameters of the Python package."""
    found = []
    for path in tracked(".py"):
        if not path.is_relative_to("bindings/python/nanotouch") or any(one.startswith("_") for one in path.parts[3:]):
            continue
        for node in ast.walk(ast.parse((ROOT / path).read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
                found.append((node.name, path.as_posix()))
                if isinstance(node, ast.FunctionDef):
                    names = (*node.args.args, *node.args.kwonlyargs)
                    found += [(one.arg, path.as_posix()) for one in names]
    return found


def messages() -> list[tuple[str, str]]:
    """Texts of the command's own packages that a user may see: not docstrings, not keys."""
    found = []
    for path in tracked(".py"):
        if not path.is_relative_to("apps/nanotouch_app"):
            continue
        tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
        docs = {
            id(node.body[0].value)
            for node in ast.walk(tree)
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and isinstance(node.body[0], ast.Expr)
        }
        found += [
            (node.value, path.as_posix())
            for node in ast.walk(tree)
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value
            and id(node) not in docs
        ]  # fmt: skip
    return found


def counted() -> dict[str, dict[str, list[str]]]:
    """For each kind of name the words that are in it, with where."""
    kinds = {"files": files, "C": c_names, "Python": python_names, "messages": messages}
    found: dict[str, dict[str, list[str]]] = {}
    for kind, names in kinds.items():
        found[kind] = defaultdict(list)
        for name, place in names():
            for word in parts(name) if kind != "messages" else re.findall(r"[a-z]+", name.lower()):
                if word in WORDS:
                    found[kind][word].append(f"{place}: {name}")
    return found


def main() -> None:
    """Print the counts."""
    for kind, words in counted().items():
        print(f"{kind}: {sum(map(len, words.values()))}")
        for word, places in sorted(words.items(), key=lambda one: -len(one[1])):
            print(f"  {len(places):4} {word} ({WORDS[word]})")
            if "--list" in sys.argv:
                print("\n".join(f"       {place[:140]}" for place in places))


if __name__ == "__main__":
    main()
