# SPDX-License-Identifier: BSD-3-Clause
"""The public API as it is listed in docs/api: a change of it is a decision, not an accident."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(not (ROOT / "tools/api.py").exists(), reason="only in a checkout")

ADVICE = "the public API changed: if that is meant, run tools/api.py and write it into CHANGELOG.md (docs/stability.md)"


@pytest.fixture(scope="module")
def api() -> ModuleType:
    spec = importlib.util.spec_from_file_location("nanotouch_api_listing", ROOT / "tools/api.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("language", ["c", "python"])
def test_the_listing_is_that_of_the_sources(api: ModuleType, language: str) -> None:
    listing = getattr(api, f"{language}_listing")()
    difference = api.changes(ROOT / f"docs/api/{language}.txt", listing)
    assert not difference, f"{ADVICE}\n{difference}"


def test_the_c_surface_stays_one_that_can_be_learned() -> None:
    declared = re.compile(r"^NT_API[^;{}]*?\b(nt_\w+)\s*\(", re.MULTILINE)
    folder = ROOT / "libnanotouch/include/nanotouch"
    public, advanced = (
        {name for header in folder.glob(pattern) for name in declared.findall(header.read_text(encoding="utf-8"))}
        for pattern in ("*.h", "advanced/*.h")
    )
    assert 200 < len(public) <= 300
    assert len(public) + len(advanced) <= 400
    assert {"nt_hertz_force", "nt_interaction_eval", "nt_cantilever_step"} <= public  # what users link for
    assert len(list(folder.rglob("*.h"))) <= 50


def test_what_a_header_declares_is_a_line_each(api: ModuleType, tmp_path: Path) -> None:
    header = tmp_path / "sample.h"
    header.write_text(
        "#ifndef NANOTOUCH_SAMPLE_H\n#define NANOTOUCH_SAMPLE_H\n#include <stdint.h>\n"
        "#define NT_TWICE(x) \\\n    (2 * (x))\n"
        '#ifdef __cplusplus\nextern "C" {\n#endif\n'
        "/* A point; [m] */\ntypedef struct nt_point {\n    double x; /* [m] */\n    double y;\n} nt_point;\n"
        "NT_API nt_status nt_point_make(double x, double y,\n                               nt_point *point);\n"
        "static inline double nt_point_x(const nt_point *p) { if (p) { return p->x; } return 0.0; }\n"
        "#ifdef __cplusplus\n}\n#endif\n#endif\n"
    )
    assert api.c_header(header) == [
        "#define NT_TWICE(x)",
        "typedef struct nt_point { double x; double y; } nt_point",
        "nt_status nt_point_make(double x, double y, nt_point *point)",
        "double nt_point_x(const nt_point *p)",
    ]


def test_a_renamed_parameter_is_seen(api: ModuleType) -> None:
    listing = api.python_listing()
    assert "nanotouch.contact\n" in listing
    kept = ROOT / "docs/api/python.txt"
    assert api.changes(kept, listing.replace("(self, gap, history='approach')", "(self, distance)"))
