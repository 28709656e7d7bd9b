# SPDX-License-Identifier: BSD-3-Clause
"""Which small faults the tests would not notice: `python tools/mutate c --count 400 --seed 1`.

Draws mutants of the sources, builds one program per test with all of them behind switches, runs for each mutant the
tests that pass through it, and reports those that no test kills. A mutant that changes no result is listed in
equivalents.toml with the reason and does not count. Exits with 1 where a folder's killed fraction is below its floor.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tomllib
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Protocol

import c_build
import python_build
from c_source import Mutant

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FLOORS = {"libnanotouch/control": 0.95, "libnanotouch/session": 0.95, "libnanotouch/hal": 0.95}
"""the fraction that has to be killed; elsewhere it is reported alone"""


class Build(Protocol):
    """A mutated build and its tests."""

    def mutants(self, paths: list[str]) -> list[Mutant]: ...
    def make(self, chosen: dict[int, Mutant]) -> None: ...
    def tests(self) -> list[str]: ...
    def run(self, test: str, mutant: int, reached: Path | None, timeout: float) -> tuple[bool, float]: ...


def baseline(build: Build, jobs: int) -> tuple[dict[int, list[str]], dict[str, float]]:
    """Return for each mutant the tests that pass through it, the quickest first, and what each test takes [s]."""
    tests = build.tests()
    folder = ROOT / "build/mutate/reached"
    folder.mkdir(parents=True, exist_ok=True)
    notes = {test: folder / test.replace("/", "_") for test in tests}
    for note in notes.values():
        note.unlink(missing_ok=True)
    with ThreadPoolExecutor(jobs) as pool:
        results = dict(zip(tests, pool.map(lambda test: build.run(test, 0, notes[test], 900.0), tests), strict=True))
    for test, (passed, _) in results.items():
        if not passed:
            print(f"left out, fails without a mutant: {test}")
    times = {test: seconds for test, (passed, seconds) in results.items() if passed}
    through: dict[int, list[str]] = {}
    for test in sorted(times, key=times.__getitem__):
        if notes[test].exists():
            for number in {int(line) for line in notes[test].read_text().split()}:
                through.setdefault(number, []).append(test)
    return through, times


def killer(build: Build, number: int, tests: list[str], times: dict[str, float]) -> str | None:
    """Return the first test that fails with this mutant; None: it survives all."""
    for test in tests:
        passed, _ = build.run(test, number, None, 10.0 + 5.0 * times[test])
        if not passed:
            return test
    return None


def folder_of(path: str) -> str:
    """Return the folder that a file's mutants are counted under."""
    parts = Path(path).parts
    return "/".join(parts[: 2 if parts[0] == "libnanotouch" else 4][: len(parts) - 1])


def report(chosen: dict[int, Mutant], killed_by: dict[int, str | None], through: dict[int, list[str]]) -> int:
    """Print survivors and the table of folders; return how many folders are below their floor."""
    killed, counted, below = Counter[str](), Counter[str](), 0
    for number, mutant in sorted(chosen.items(), key=lambda item: item[1][:4]):
        folder = folder_of(mutant.path)
        counted[folder] += 1
        killed[folder] += killed_by[number] is not None
        if killed_by[number] is None:
            how = f"survives {len(through[number])} tests" if number in through else "no test passes through it"
            print(f"{mutant.path}:{mutant.line}: {how}\n    {mutant.key}")
    print(f"\n{'folder':<40} {'mutants':>8} {'killed':>7} {'fraction':>9}")
    for folder in sorted(counted):
        fraction = killed[folder] / counted[folder]
        floor = FLOORS.get(folder, 0.0)
        below += fraction < floor
        words = f"  below {floor:.0%}" if fraction < floor else ""
        print(f"{folder:<40} {counted[folder]:>8} {killed[folder]:>7} {fraction:>9.1%}{words}")
    return below


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("language", choices=("c", "python"))
    parser.add_argument("paths", nargs="*", help="files or folders to draw from; all by default")
    parser.add_argument("--count", type=int, default=400, help="of mutants; 0: every one (%(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the sample (%(default)s)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="tests at once (%(default)s)")
    parser.add_argument("--tests", default="", help="regular expression of the tests to run; all by default")
    args = parser.parse_args()
    build: Build = (c_build.Build if args.language == "c" else python_build.Build)(ROOT, args.tests)
    listed = tomllib.loads((HERE / "equivalents.toml").read_text())
    everything = build.mutants(args.paths)
    mutants = [mutant for mutant in everything if mutant.key not in listed]
    if args.count and args.count < len(mutants):
        mutants = random.Random(args.seed).sample(mutants, args.count)
    chosen = dict(enumerate(mutants, 1))
    print(f"{len(chosen)} of {len(everything)} mutants drawn, seed {args.seed}", flush=True)
    build.make(chosen)
    through, times = baseline(build, args.jobs)
    with ThreadPoolExecutor(args.jobs) as pool:
        numbers = list(chosen)
        found = pool.map(lambda number: killer(build, number, through.get(number, []), times), numbers)
        killed_by = dict(zip(numbers, found, strict=True))
    return min(report(chosen, killed_by, through), 1)


if __name__ == "__main__":
    sys.exit(main())
