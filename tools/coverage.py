# SPDX-License-Identifier: BSD-3-Clause
"""Measure the coverage of the C library by its C tests: lines, branches and MC/DC, by layer (docs/assurance.md).

Usage: coverage.py [--only REGEX] [--missing PATH...] [--raise] [--no-run]

Exits with 1 where a figure lies below its floor in tests/coverage/floors.toml. ``--raise`` lifts the floors to what was
measured; no option lowers them. Needs clang 18 or newer with llvm-profdata and llvm-cov of the same version.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/coverage"
FLOORS = ROOT / "tests/coverage/floors.toml"
INFEASIBLE = ROOT / "tests/coverage/infeasible.toml"
STEP = 0.5  # of a floor [%]
ROOM = 0.25  # below what was measured, unless that is all [%]: threads do not run the same lines every time
KINDS = ("lines", "branches", "mcdc")
UNITS = {
    "supervisor": "control/(supervisor|supervisor_make|follow|lift|stuck)\\.c",
    "touch": "control/(touch|touch_make)\\.c",
    "force bound": "control/(guarantee|motor_bound)\\.c",
}
"""Parts of a layer that have floors of their own: what a sample and a hand are protected by."""

# [first line, first column, last line, last column]
Place = tuple[int, int, int, int]


@dataclass
class File:
    """What the tests reached of one source file."""

    lines: tuple[int, int]  # all, reached
    branches: dict[Place, tuple[bool, bool]] = field(default_factory=dict)  # was it true, was it false
    decisions: dict[Place, list[bool]] = field(default_factory=dict)  # whose conditions were shown to matter alone
    infeasible: int = 0  # conditions that no input can show, by tests/coverage/infeasible.toml

    def counts(self) -> dict[str, tuple[int, int]]:
        """All and reached, by kind; an infeasible condition is neither."""
        conditions = [shown for decision in self.decisions.values() for shown in decision]
        return {
            "lines": self.lines,
            "branches": (2 * len(self.branches), sum(map(sum, self.branches.values()))),
            "mcdc": (len(conditions) - self.infeasible, sum(conditions)),
        }


def newest_clang() -> str:
    """Return the suffix of the newest clang that measures MC/DC: "-19", or "" of a plain clang."""
    for suffix in [f"-{version}" for version in range(30, 17, -1)] + [""]:
        if not all(shutil.which(f"{tool}{suffix}") for tool in ("clang", "clang++", "llvm-cov", "llvm-profdata")):
            continue
        version = subprocess.run([f"clang{suffix}", "-dumpversion"], capture_output=True, text=True, check=True).stdout
        if int(version.split(".")[0]) >= 18:
            return suffix
    raise SystemExit(
        "coverage.py: clang 18 or newer with llvm-cov and llvm-profdata is needed (Debian: clang-19 llvm-19)"
    )


def _run(*command: str) -> None:
    subprocess.run(command, check=True, cwd=ROOT)


def build_and_run(suffix: str, only: str, jobs: int) -> None:
    """Build the tests, run them and merge what each has counted."""
    flags = "-O1 -fprofile-instr-generate -fcoverage-mapping -fcoverage-mcdc -Wno-unknown-warning-option"
    options = {
        "CMAKE_BUILD_TYPE": "None", "CMAKE_C_COMPILER": f"clang{suffix}", "CMAKE_CXX_COMPILER": f"clang++{suffix}",
        "CMAKE_C_FLAGS": flags, "CMAKE_CXX_FLAGS": flags, "BUILD_SHARED_LIBS": "ON", "NANOTOUCH_APPS": "OFF",
        "NANOTOUCH_FIT": "OFF", "NANOTOUCH_INSTALL": "OFF",
    }  # fmt: skip
    defines = [f"-D{name}={value}" for name, value in options.items()]
    _run("cmake", "-S", ".", "-B", str(BUILD), "-G", "Ninja", "--log-level", "WARNING", *defines)
    _run("cmake", "--build", str(BUILD), "-j", str(jobs), "--target", "tests/c/all", "libnanotouch/all")
    profiles = BUILD / "profiles"
    shutil.rmtree(profiles, ignore_errors=True)
    environment = os.environ | {"LLVM_PROFILE_FILE": f"{profiles}/%m.profraw"}
    command = ["ctest", "--test-dir", str(BUILD), "-j", str(jobs), "-R", only, "-E", "^test_fuzz", "--timeout", "600"]
    told = subprocess.run(command, env=environment, capture_output=True, text=True).stdout
    failed = re.findall(r"^\s*\d+ - (\S+) \((?:Failed|Timeout|SEGFAULT|Child).*$", told, re.MULTILINE)
    if failed:  # one that looks at the clock may: `make test` says whether it counts
        print("failed here, where all code is slower:", " ".join(failed), file=sys.stderr)
    _run(f"llvm-profdata{suffix}", "merge", "--failure-mode=all", "-o", str(BUILD / "merged.profdata"),
        *map(str, sorted(profiles.glob("*.profraw"))))  # fmt: skip


def export(suffix: str) -> dict[str, Any]:
    """Return what llvm-cov says of all libraries."""
    libraries = sorted({path.resolve() for path in BUILD.rglob("libnanotouch*.so")})
    objects = [argument for path in libraries[1:] for argument in ("-object", str(path))]
    command = [f"llvm-cov{suffix}", "export", str(libraries[0]), *objects, "-instr-profile",
               str(BUILD / "merged.profdata"), "-skip-expansions", "-skip-functions"]  # fmt: skip
    text = subprocess.run(command, capture_output=True, check=True).stdout
    parsed: dict[str, Any] = json.loads(text)
    return parsed


def files_of(exported: dict[str, Any]) -> dict[str, File]:
    """Return each file of the library by its path below libnanotouch/."""
    found = {}
    for entry in exported["data"][0]["files"]:
        name = entry["filename"].partition("/libnanotouch/")[2]
        if not name or not (ROOT / "libnanotouch" / name).is_file():
            continue
        lines = entry["summary"]["lines"]
        file = found[name] = File((lines["count"], lines["covered"]))
        for branch in entry["branches"]:
            place, (true, false) = tuple(branch[:4]), branch[4:6]
            was = file.branches.get(place, (False, False))
            file.branches[place] = (was[0] or true > 0, was[1] or false > 0)
        for record in entry.get("mcdc_records", []):
            place, shown = tuple(record[:4]), record[-1]
            before = file.decisions.get(place, [False] * len(shown))
            file.decisions[place] = [a or bool(b) for a, b in zip(before, shown, strict=True)]
    return found


def text_at(name: str, place: Place) -> str:
    """Return the source of a decision, on one line."""
    first, left, last, right = place
    lines = (ROOT / "libnanotouch" / name).read_text().splitlines()[first - 1 : last]
    lines[-1] = lines[-1][: right - 1]
    lines[0] = lines[0][left - 1 :]
    return " ".join(" ".join(lines).split())


def set_apart(files: dict[str, File]) -> list[str]:
    """Count the conditions that no input can show; return what is wrong with their list."""
    wrong = []
    for row in tomllib.loads(INFEASIBLE.read_text()).get("condition", []):
        file = files.get(row["file"])
        places = [p for p in file.decisions if text_at(row["file"], p) == row["decision"]] if file else []
        if not file or not places:
            wrong.append(f"{row['file']}: there is no decision `{row['decision']}` any more")
            continue
        for place in places:
            for number in row["conditions"]:
                if file.decisions[place][number - 1]:
                    wrong.append(f"{row['file']}: condition {number} of `{row['decision']}` has been shown")
                else:
                    file.infeasible += 1
    return wrong


def groups(files: dict[str, File]) -> dict[str, list[File]]:
    """Return the files of each layer, then of each unit."""
    found: dict[str, list[File]] = {}
    for name, file in sorted(files.items()):
        layer = "headers" if name.startswith("include/") else name.split("/")[0]
        found.setdefault(layer, []).append(file)
    for unit, pattern in UNITS.items():
        found[unit] = [file for name, file in files.items() if re.fullmatch(pattern, name)]
    found["all"] = list(files.values())
    return found


def share(group: list[File], kind: str) -> float:
    """Return how much of a group was reached [%]; 100 where there is nothing to reach."""
    count, reached = (sum(file.counts()[kind][i] for file in group) for i in (0, 1))
    return 100.0 * reached / count if count else 100.0


def missing(files: dict[str, File], paths: list[str]) -> Iterator[str]:
    """Say what was not reached in files whose name begins with one of these."""
    for name, file in sorted(files.items()):
        if not name.startswith(tuple(paths)):
            continue
        for place, shown in sorted(file.decisions.items()):
            numbers = [i + 1 for i, one in enumerate(shown) if not one]
            if numbers:
                yield f"{name}:{place[0]}: condition {', '.join(map(str, numbers))} of `{text_at(name, place)}`"
        for place, (true, false) in sorted(file.branches.items()):
            if not (true and false):
                never = "false" if true else "true" if false else "reached"
                yield f"{name}:{place[0]}: never {never}: `{text_at(name, place)}`"


def judge(figures: dict[str, dict[str, float]], floors: dict[str, dict[str, float]]) -> list[str]:
    """Return what lies below its floor, or is missing."""
    wrong = []
    for name, row in floors.items():
        for kind, floor in row.items():
            figure = figures.get(name, {}).get(kind)
            if figure is None:
                wrong.append(f"{name}: nothing was measured")
            elif figure < floor:
                wrong.append(f"{name}: {kind} {figure:.2f} %, below {floor} %")
    return wrong


def lowered(older: dict[str, dict[str, float]], newer: dict[str, dict[str, float]]) -> list[str]:
    """Return the floors of a newer file that are lower than those of an older one, or have gone."""
    found = []
    for name, row in older.items():
        for kind, floor in row.items():
            now = newer.get(name, {}).get(kind, 0.0)
            if now < floor:
                found.append(f"{name}: {kind} {floor} % -> {now} %")
    return found


def raised(figures: dict[str, dict[str, float]], floors: dict[str, dict[str, float]]) -> str:
    """Return the file of the floors, each as high as was measured or as high as it was."""
    lines = [
        "# SPDX-License-Identifier: BSD-3-Clause",
        "# Coverage by the C tests, which no change may lower [%]. tools/coverage.py --raise writes this; the figures",
        "# only rise (tests/python/test_floors.py). Instructions of the hot paths: tests/bench/instructions.json.",
        "",
    ]
    for name, row in figures.items():
        old = floors.get(name, {})
        room = {kind: 0.0 if row[kind] == 100.0 else ROOM for kind in KINDS}
        now = {kind: max(math.floor((row[kind] - room[kind]) / STEP) * STEP, old.get(kind, 0.0)) for kind in KINDS}
        key = name if re.fullmatch(r"\w+", name) else f'"{name}"'
        lines.append(f"{key} = {{ " + ", ".join(f"{kind} = {now[kind]:.1f}" for kind in KINDS) + " }")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Print the table; 1 where a figure has fallen."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="^test_", help="tests to run (default: %(default)s)")
    parser.add_argument("--missing", nargs="*", default=[], help="files whose holes are listed: control/lift")
    parser.add_argument("--raise", dest="raises", action="store_true", help="lift the floors to what is measured")
    parser.add_argument("--no-run", action="store_true", help="look at the counts of the last run")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    args = parser.parse_args()
    suffix = newest_clang()
    if not args.no_run:
        build_and_run(suffix, args.only, args.jobs)
    files = files_of(export(suffix))
    wrong = set_apart(files)
    figures = {name: {kind: share(group, kind) for kind in KINDS} for name, group in groups(files).items()}
    print("| layer | lines [%] | branches [%] | MC/DC [%] |\n|---|---|---|---|")
    for name, row in figures.items():
        print(f"| {name} | " + " | ".join(f"{row[kind]:.1f}" for kind in KINDS) + " |")
    print(*missing(files, args.missing), sep="\n")
    floors = tomllib.loads(FLOORS.read_text()) if FLOORS.exists() else {}
    if args.raises:
        FLOORS.write_text(raised(figures, floors))
    if args.only == parser.get_default("only"):
        wrong += judge(figures, floors)
    print(*wrong, sep="\n", file=sys.stderr)
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
