# SPDX-License-Identifier: BSD-3-Clause
"""What is remembered of earlier runs: a test's program and a mutant's number decide whether the test passes."""

from __future__ import annotations

from pathlib import Path
from typing import Self


class Runs:
    """One line per run in a file that only grows; written as they end, so that an interrupted draw goes on."""

    def __init__(self, path: Path):
        self.path = path
        self.passed: dict[tuple[str, int], bool] = {}
        self.killers: dict[str, str] = {}

    def __enter__(self) -> Self:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        for line in self.path.read_text().splitlines() if self.path.exists() else ():
            kind, first, second, *last = line.split("\t")
            if kind == "run" and last:
                self.passed[first, int(second)] = last[0] == "1"
            elif kind == "killer":
                self.killers[first] = second
        self.file = self.path.open("a", buffering=1)
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def known(self, program: str, number: int) -> bool | None:
        """Return whether this program passes with this mutant; None: not known."""
        return self.passed.get((program, number))

    def note(self, program: str, number: int, passed: bool) -> None:
        """Remember a run."""
        self.passed[program, number] = passed
        self.file.write(f"run\t{program}\t{number}\t{int(passed)}\n")

    def killer_of(self, key: str) -> str | None:
        """Return the test that killed a mutant in an earlier build, to be tried first."""
        return self.killers.get(key)

    def note_killer(self, key: str, test: str) -> None:
        """Remember which test killed it."""
        if self.killers.get(key) != test:
            self.killers[key] = test
            self.file.write(f"killer\t{key}\t{test}\n")
