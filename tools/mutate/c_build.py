# SPDX-License-Identifier: BSD-3-Clause
"""The C library and its tests, built once with all drawn mutants behind switches."""

from __future__ import annotations

import functools
import hashlib
import json
import os
import re
import resource
import subprocess
import sys
import threading
from pathlib import Path

import c_source
from c_source import Mutant

HERE = Path(__file__).resolve().parent
LEFT_OUT = ("libnanotouch/fit/", "libnanotouch/hal/shared_memory_windows.c", "libnanotouch/session/no_thread.c")
"""what these programs do not hold: C++, and the parts of another system"""


def _write(path: Path, content: bytes) -> None:
    """Write it where it differs, so that a build takes up what has changed alone."""
    if not path.exists() or path.read_bytes() != content:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


class Build:
    """Lies in build/mutate/tree, with its programs in build/mutate/c."""

    def __init__(self, root: Path, tests: str):
        self.root, self.pattern = root, re.compile(tests or "^test_")
        self.tree, self.folder = root / "build/mutate/tree", root / "build/mutate/c"
        self.commands: dict[str, list[str]] = {}
        resources = subprocess.run(["clang", "-print-resource-dir"], capture_output=True, text=True, check=True).stdout
        include = [f"-I{root}/libnanotouch/include", f"-I{root}/libnanotouch", f"-I{resources.strip()}/include"]
        self.flags = ["-std=c11", "-D_GNU_SOURCE", *include]

    def _tracked(self) -> dict[str, None]:
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=self.root, capture_output=True, text=True, check=True)
        return {name: None for name in listed.stdout.split("\0") if name and (self.root / name).is_file()}

    def mutants(self, paths: list[str]) -> list[Mutant]:
        """Return every mutant of the C files under these paths."""
        wanted = tuple(path.rstrip("/") for path in paths) or ("libnanotouch",)
        found: list[Mutant] = []
        for name in self._tracked():
            if name.endswith(".c") and name.startswith(wanted) and not name.startswith(LEFT_OUT):
                found += c_source.of_file(self.root / name, self.root, self.flags)
        return found

    def make(self, mutants: dict[int, Mutant]) -> None:
        """Copy the tree with these mutants in it and build its tests."""
        by_file: dict[str, dict[int, Mutant]] = {}
        for number, mutant in mutants.items():
            by_file.setdefault(mutant.path, {})[number] = mutant
        tracked = self._tracked()
        for path in self.tree.rglob("*"):
            name = str(path.relative_to(self.tree))
            if path.is_file() and name not in tracked and not name.startswith("build/"):
                path.unlink()
        fetched = self.tree / "build/deps"  # sources of libgpiod, where the system has none
        if (self.root / "build/deps").exists() and not fetched.exists():
            fetched.parent.mkdir(parents=True, exist_ok=True)
            fetched.symlink_to(self.root / "build/deps")
        for name in tracked:
            content = (self.root / name).read_bytes()
            if name in by_file:
                content = c_source.with_switches(content, by_file[name])
            _write(self.tree / name, content)
        switch = self.folder / "switch.o"
        self.folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cc", "-O1", "-fPIC", "-c", str(HERE / "switch.c"), "-o", str(switch)], check=True)
        flags = {"CMAKE_C_FLAGS": f"-w -include {HERE}/switch.h", "CMAKE_EXE_LINKER_FLAGS": str(switch)}
        options = {"CMAKE_BUILD_TYPE": "Release", **flags}
        off = ("BUILD_SHARED_LIBS", "NANOTOUCH_APPS", "NANOTOUCH_FIT", "NANOTOUCH_WERROR")
        options |= dict.fromkeys(off, "OFF")
        command = ["cmake", "-S", str(self.tree), "-B", str(self.folder), "-G", "Ninja", "--log-level=ERROR"]
        subprocess.run(command + [f"-D{key}={value}" for key, value in options.items()], check=True)
        with (self.folder / "build.log").open("w") as log:
            built = subprocess.run(["cmake", "--build", str(self.folder), "--", "-k", "0"], stdout=log)
        if built.returncode:
            sys.exit(f"the mutated tree does not build: {log.name}")
        shown = subprocess.run(
            ["ctest", "--show-only=json-v1"], cwd=self.folder, capture_output=True, text=True, check=True
        )
        for test in json.loads(shown.stdout)["tests"]:
            if self.pattern.search(test["name"]) and "command" in test:
                self.commands[test["name"]] = test["command"]

    def tests(self) -> list[str]:
        """Return the names of the tests."""
        return list(self.commands)

    @functools.cache  # noqa: B019  one build to a run
    def fingerprint(self, test: str) -> str:
        """Return what changes whenever the test's program does."""
        return hashlib.sha256(Path(self.commands[test][0]).read_bytes()).hexdigest()[:20]

    def run(self, test: str, mutant: int, reached: Path | None, seconds: float | None) -> tuple[bool, float]:
        """Run one test with one mutant switched on; return whether it passed, and its processor time [s]."""
        environment = dict(os.environ, NT_MUTANT=str(mutant))
        if reached:
            environment["NT_REACHED"] = str(reached)
        return run_quietly(self.commands[test], environment, self.folder / "tests/c", seconds)


def run_quietly(
    command: list[str], environment: dict[str, str], folder: Path, seconds: float | None
) -> tuple[bool, float]:
    """Run a command without its output; return whether it ended with 0, and what it took [s of processor time].

    It may take so much processor time, whatever else the machine does, and sleep for a minute besides.
    """
    quiet = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
    process = subprocess.Popen(command, env=environment, cwd=folder, start_new_session=True, **quiet)
    if seconds is not None:
        limit = int(seconds) + 1
        resource.prlimit(process.pid, resource.RLIMIT_CPU, (limit, limit))
    stop = threading.Timer(60.0 + 20.0 * (60.0 if seconds is None else seconds), os.killpg, (process.pid, 9))
    stop.start()
    _, status, used = os.wait4(process.pid, 0)
    stop.cancel()
    process.returncode = status
    return status == 0, used.ru_utime + used.ru_stime
