# SPDX-License-Identifier: BSD-3-Clause
"""The installed Python package, copied with all drawn mutants behind switches."""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import python_source
from c_build import run_quietly
from c_source import Mutant

HERE = Path(__file__).resolve().parent
PACKAGES = {"nanotouch": "bindings/python/nanotouch", "nanotouch_app": "apps/nanotouch_app"}


class Build:
    """Lies in build/mutate/python, which goes before the installed package."""

    def __init__(self, root: Path, tests: str):
        self.root, self.pattern = root, re.compile(tests or "")
        self.folder = root / "build/mutate/python"

    def mutants(self, paths: list[str]) -> list[Mutant]:
        """Return every mutant of the modules under these paths."""
        found: list[Mutant] = []
        for path in paths or list(PACKAGES.values()):
            under = self.root / path
            for file in [under] if under.is_file() else sorted(under.rglob("*.py")):
                found += python_source.of_file(file, self.root)
        return found

    def make(self, mutants: dict[int, Mutant]) -> None:
        """Copy the package as it is installed, with the sources of this tree and these mutants in them."""
        shutil.rmtree(self.folder, ignore_errors=True)
        for package, source in PACKAGES.items():
            spec = importlib.util.find_spec(package)
            if spec is None or not spec.submodule_search_locations:
                sys.exit(f"{package} is not installed: tools/setup.sh test")
            shutil.copytree(list(spec.submodule_search_locations)[-1], self.folder / package)
            listed = subprocess.run(
                ["git", "ls-files", source], cwd=self.root, capture_output=True, text=True, check=True
            )
            for name in listed.stdout.split():
                target = self.folder / package / Path(name).relative_to(source)
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(self.root / name, target)
        shutil.copy(HERE / "nanotouch_mutants.py", self.folder)
        by_file: dict[str, dict[int, Mutant]] = {}
        for number, mutant in mutants.items():
            by_file.setdefault(mutant.path, {})[number] = mutant
        for name, mutants in by_file.items():
            package, source = next((p, s) for p, s in PACKAGES.items() if name.startswith(s + "/"))
            target = self.folder / package / Path(name).relative_to(source)
            target.write_text(python_source.with_switches((self.root / name).read_text(), mutants))

        self._check_import()

    def _check_import(self) -> None:
        """An editable install goes before any path: its finder would hide the copy."""
        environment = dict(os.environ, PYTHONPATH=str(self.folder), NT_MUTANT="0")
        command = [sys.executable, "-c", "import importlib.util; print(importlib.util.find_spec('nanotouch').origin)"]
        found = subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout.strip()
        if not Path(found).is_relative_to(self.folder):
            sys.exit(f"tests would import {found}: mutants of Python need a package that is not installed as editable")

    def tests(self) -> list[str]:
        """Return the test files."""
        names = sorted(path.name for path in (self.root / "tests/python").glob("test_*.py"))
        return [name for name in names if self.pattern.search(name)]

    @functools.cache  # noqa: B019  one build to a run
    def fingerprint(self, test: str) -> str:
        """Return what changes whenever the mutated package or the tests' modules do."""
        found = hashlib.sha256()
        for file in [*sorted(self.folder.rglob("*.py")), *self._shared(), self.root / "tests/python" / test]:
            found.update(file.read_bytes())
        return found.hexdigest()[:20]

    def _shared(self) -> list[Path]:
        found = sorted((self.root / "tests/python").glob("*.py"))
        return [file for file in found if not file.name.startswith("test_")]

    def run(self, test: str, mutant: int, reached: Path | None, seconds: float | None) -> tuple[bool, float]:
        """Run one test file with one mutant switched on; return whether it passed, and its processor time [s]."""
        environment = dict(os.environ, NT_MUTANT=str(mutant), PYTHONPATH=str(self.folder))
        if reached:
            environment["NT_REACHED"] = str(reached)
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", f"tests/python/{test}"]
        return run_quietly(command, environment, self.root, seconds)
