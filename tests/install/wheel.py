# SPDX-License-Identifier: BSD-3-Clause
"""Check an installed nanotouch, with numpy and nothing else of its extras imported.

Run by any interpreter that has the package: `python tests/install/wheel.py`. With `page`, it must carry the page; with
`fit`, as published wheels, its own Ceres with the licences, and the command, a touch and a fit must work.
"""

import contextlib
import io
import runpy
import subprocess
import sys
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent


def foreign_modules(before: set[str]) -> set[str]:
    """Return the top-level modules imported since `before` that are neither ours nor of the standard library."""
    new = {name.split(".")[0] for name in sys.modules.keys() - before}
    return {name for name in new - sys.stdlib_module_names - {"nanotouch"} if not name.startswith("__")}


def check_fit(files: set[str]) -> None:
    """Check that fits need no library beside the wheel, and that it has the licences of what is linked in."""
    for name in ("LICENSE", "Ceres.txt", "Eigen.txt", "pybind11.txt"):
        assert any(file.endswith(f".dist-info/licenses/{name}") for file in files), (
            f"licenses/{name} is not in the wheel"
        )
    libraries = sorted(file for file in files if ".libs/" in file)
    assert not libraries, f"the wheel brings libraries whose licences nobody looked at: {libraries}"
    version = subprocess.run(
        [sys.executable, "-m", "nanotouch", "--version"], capture_output=True, text=True, check=True
    )
    assert metadata.version("nanotouch") in version.stdout, version.stdout
    for example in ("02_touch_simulated", "03_fit"):
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            runpy.run_path(str(ROOT / f"apps/python/{example}.py"))
        assert "pull-off" in printed.getvalue(), printed.getvalue()


def main() -> None:
    """Import, look, and complain by assertion."""
    before = set(sys.modules)
    import nanotouch

    foreign = foreign_modules(before)
    assert foreign <= {"numpy"}, f"import nanotouch also imports {sorted(foreign - {'numpy'})}"
    assert nanotouch.__version__ == metadata.version("nanotouch"), "the package and its metadata differ in version"
    assert nanotouch._core.__file__, "the extension is not a file of the package"

    files = {str(file) for file in metadata.files("nanotouch") or []}
    for wanted in ("nanotouch/py.typed", "nanotouch/_core.pyi", "nanotouch_app/main.py"):
        assert wanted in files, f"{wanted} is not in the wheel"
    page = "nanotouch_app/browser/nanotouch-touch.html"
    assert page in files or "page" not in sys.argv[1:], f"{page} is not in the wheel: make page"
    strays = sorted(f for f in files if f.endswith((".a", ".h", ".cmake", ".cpp")))
    assert not strays, f"the wheel contains {strays}"
    (script,) = metadata.entry_points(group="console_scripts", name="nanotouch")
    assert callable(script.load()), "the command cannot be loaded"
    if "fit" in sys.argv[1:]:
        check_fit(files)
    print(f"nanotouch {nanotouch.__version__} is well installed")


if __name__ == "__main__":
    main()
