# SPDX-License-Identifier: BSD-3-Clause
"""Which small faults the tests would not notice: `python tools/mutate c libnanotouch/control --count 200 --seed 1`.

Builds one program per test with every mutant of the sources behind a switch, draws some of them by folder, runs for
each the tests that pass through it until one fails, and reports those that survive. A mutant that changes no result is
listed in equivalents.toml with the reason and does not count. A run of a test with a mutant is remembered until the
program changes. Exits with 1 where a folder's killed fraction is below its floor.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import sys
import tomllib
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple, Protocol

import c_build
import python_build
from c_source import Mutant
from runs import Runs

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FLOORS = {"libnanotouch/control": 0.95, "libnanotouch/session": 0.95, "libnanotouch/hal": 0.95}
"""the fraction that has to be killed; elsewhere it is reported alone"""


class Build(Protocol):
    """A mutated build and its tests."""

    def mutants(self, paths: list[str]) -> list[Mutant]: ...
    def make(self, mutants: dict[int, Mutant]) -> None: ...
    def tests(self) -> list[str]: ...
    def fingerprint(self, test: str) -> str: ...
    def run(self, test: str, mutant: int, reached: Path | None, seconds: float | None) -> tuple[bool, float]: ...


class Reach(NamedTuple):
    """What the tests pass through without a mutant switched on."""

    through: dict[int, list[str]]
    """for each mutant the tests that reach it"""
    times: dict[str, float]
    """of each test that passes [s of processor time]"""


def baseline(build: Build, jobs: int, slowest: float) -> Reach:
    """Run every test without a mutant."""
    tests = build.tests()
    folder = ROOT / "build/mutate/reached"
    folder.mkdir(parents=True, exist_ok=True)
    notes = {test: folder / f"{test.replace('/', '_')}-{build.fingerprint(test)[:16]}-{slowest:g}" for test in tests}

    def run(test: str) -> tuple[bool, float]:
        took = Path(f"{notes[test]}.took")
        if not took.exists():
            notes[test].unlink(missing_ok=True)
            passed, seconds = build.run(test, 0, notes[test], slowest)
            took.write_text(f"{int(passed)} {seconds}")
        words = took.read_text().split()
        return words[0] == "1", float(words[1])

    with ThreadPoolExecutor(jobs) as pool:
        results = dict(zip(tests, pool.map(run, tests), strict=True))
    for test, (passed, seconds) in results.items():
        if not passed:
            print(f"left out, {f'takes over {slowest:g} s' if seconds > slowest else 'fails without a mutant'}: {test}")
    times = {test: seconds for test, (passed, seconds) in results.items() if passed}
    through: dict[int, list[str]] = {}
    for test in sorted(times, key=times.__getitem__):
        if notes[test].exists():
            for number in {int(line) for line in notes[test].read_text().split()}:
                through.setdefault(number, []).append(test)
    return Reach(through, times)


def distance(test: str, path: str) -> int:
    """Return how far a test is from a source: 0 for its own, 1 for its folder's, 2 for another's."""
    parts = Path(path).with_suffix("").parts
    if test.removeprefix("test_").removesuffix(".py").startswith((parts[-1], "_".join(parts[1:]))):
        return 0
    return 1 if f"test_{parts[1]}_" in test else 2


def killer(build: Build, mutant: tuple[int, Mutant], reach: Reach, runs: Runs) -> str | None:
    """Return the first test that fails with this mutant; None: it survives all."""
    number, (path, *_) = mutant
    tests = sorted(reach.through.get(number, []), key=lambda test: (distance(test, path), reach.times[test]))
    last = runs.killer_of(mutant[1].key)
    for test in sorted(tests, key=lambda test: test != last):
        print_of = build.fingerprint(test)
        passed = runs.known(print_of, number)
        if passed is None:
            passed, _ = build.run(test, number, None, 1.0 + 4.0 * reach.times[test])
            runs.note(print_of, number, passed)
        if not passed:
            runs.note_killer(mutant[1].key, test)
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


def drawn(everything: dict[int, Mutant], count: int, seed: int, pattern: str) -> dict[int, Mutant]:
    """Return up to `count` mutants of every folder, without those that are listed as equivalent; 0: all of them."""
    listed = tomllib.loads((HERE / "equivalents.toml").read_text())
    known = {mutant.key for mutant in everything.values()}
    paths = {mutant.path for mutant in everything.values()}
    for key in listed:
        if key.split(":")[0] in paths and key not in known:
            print(f"listed as equivalent, but no longer there: {key}")
    by_folder: dict[str, list[int]] = {}
    for number, mutant in everything.items():
        if re.search(pattern, mutant.key):
            by_folder.setdefault(folder_of(mutant.path), []).append(number)
    chosen = {}
    for folder, numbers in sorted(by_folder.items()):
        some = random.Random(f"{seed} {folder}").sample(numbers, min(count or len(numbers), len(numbers)))
        kept = {number: everything[number] for number in sorted(some) if everything[number].key not in listed}
        print(f"{folder}: {len(some)} of {len(numbers)} mutants, {len(some) - len(kept)} of them equivalent")
        chosen |= kept
    return chosen


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("language", choices=("c", "python"))
    parser.add_argument("paths", nargs="*", help="files or folders to change; all by default")
    parser.add_argument("--count", type=int, default=100, help="mutants of each folder; 0: every one (%(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the draw (%(default)s)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="tests at once (%(default)s)")
    parser.add_argument("--tests", default="", help="regular expression of the tests to run; all by default")
    parser.add_argument("--of", default="", help="regular expression of the mutants to draw from; all by default")
    parser.add_argument("--slowest", type=float, default=10.0, help="leave out slower tests [s] (%(default)s)")
    args = parser.parse_args()
    build: Build = (c_build.Build if args.language == "c" else python_build.Build)(ROOT, args.tests)
    everything = dict(enumerate(build.mutants(args.paths), 1))
    chosen = drawn(everything, args.count, args.seed, args.of)
    sys.stdout.flush()
    build.make(everything)
    reach = baseline(build, args.jobs, args.slowest)
    with Runs(ROOT / f"build/mutate/runs-{args.language}") as runs, ThreadPoolExecutor(args.jobs) as pool:
        found = pool.map(lambda item: killer(build, item, reach, runs), chosen.items())
        killed_by = dict(zip(chosen, found, strict=True))
    return min(report(chosen, killed_by, reach.through), 1)


if __name__ == "__main__":
    sys.exit(main())
