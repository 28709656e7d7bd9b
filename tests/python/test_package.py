# SPDX-License-Identifier: BSD-3-Clause
"""The package as a whole: light to import, names that resolve, stubs that match, no extra needed for the core."""

from __future__ import annotations

import importlib.util
import os
import pickle
import subprocess
import sys
from pathlib import Path

import nanotouch as nt
import pytest
from nanotouch import errors

HEAVY = (
    "scipy", "cv2", "SurfaceTopography", "afmformats", "mcap", "h5py", "vtk", "vtkmodules", "aiohttp", "anywidget",
    "tqdm",
    "matplotlib", "pandas", "dask", "xarray", "PIL", "asyncio", "nanotouch_app",
)  # fmt: skip
PACKAGE = Path(nt.__file__).parent


def python(code: str) -> str:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_import_brings_numpy_only() -> None:
    loaded = set(python("import sys, nanotouch; print(*{name.partition('.')[0] for name in sys.modules})").split())
    assert "numpy" not in HEAVY
    assert not loaded & set(HEAVY)


def test_a_whole_touch_needs_numpy_only() -> None:
    """Laws, scene, surface, session, recording in memory: without any extra."""
    code = f"""
import sys
for name in {HEAVY!r}:
    sys.modules[name] = None
import nanotouch as nt
nt.contact.force("hertz", 1e-9, nt.Contact(2e-8, 1e11))
nt.forces.vdw(1e-9, radius=2e-8, hamaker_constant=1e-19)
surface = nt.Surface(nt.surface.grating(pixels=32), 2e-8)
recording = nt.Session(surface=surface).run(0.5)
print(len(recording))
try:
    nt.record.Writer("never.mcap")
except nt.Error as error:
    print(error)
"""
    lines = python(code).splitlines()
    assert int(lines[0]) == pytest.approx(5000, abs=8)
    assert "(extra record, recordings: nanotouch touch): pip install mcap h5py" in lines[1]


def test_every_name_resolves() -> None:
    assert set(nt.__all__) <= set(dir(nt))
    for name in nt.__all__:
        assert getattr(nt, name) is not None
    python("from nanotouch import *; Session, fit, Error")


def test_unknown_name() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Sesion'"):
        nt.Sesion  # noqa: B018


def test_errors_have_one_base_and_pickle() -> None:
    kinds = [kind for kind in vars(errors).values() if isinstance(kind, type) and issubclass(kind, Exception)]
    assert len(kinds) >= 6
    for kind in kinds:
        assert issubclass(kind, nt.Error)
        again = pickle.loads(pickle.dumps(kind("what went wrong")))
        assert type(again) is kind
        assert str(again) == "what went wrong"


def test_stubs_match_the_extensions(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    names = ["nanotouch._core", *(["nanotouch._fit"] if importlib.util.find_spec("nanotouch._fit") else [])]
    allowed = []
    for name in names:
        classes = [key for key, value in vars(importlib.import_module(name)).items() if isinstance(value, type)]
        # pybind11's metaclass, and aliases that only the stub has; members of the classes are compared all the same.
        # gpio_lines is there where libgpiod is.
        allowed += [f"{name}.{key}" for key in (*classes, "Floats", "LawColumns", "_Described", "gpio_lines")]
    allowlist = tmp_path / "allowed"
    allowlist.write_text("\n".join(allowed))
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE.parent), "MYPY_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-m", "mypy.stubtest", *names, "--allowlist", str(allowlist)]
    command += ["--ignore-unused-allowlist"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
