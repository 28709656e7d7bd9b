# SPDX-License-Identifier: BSD-3-Clause
"""The site: ``make docs``. Pages on the command and the headers are written when it is built."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
ROOT = HERE.parent
sys.path.insert(0, str(HERE))

project = "nanotouch"
author = "The libnanotouch authors"
version = release = re.search(r'NT_VERSION "([^"]+)"', (ROOT / "libnanotouch/include/nanotouch/version.h").read_text())[
    1
]  # type: ignore[index]
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "sphinx.ext.doctest",
    "sphinx_gallery.gen_gallery",
    "sphinx_copybutton",
]
html_theme = "furo"
html_title = f"nanotouch {version}"
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = [
    "README.md",
    "examples/**",
    "build",
    "gallery/*.md5",
    "notebooks/*.md5",
    "decisions/README.md",
]
myst_enable_extensions = ["deflist", "colon_fence"]
myst_heading_anchors = 4
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_preserve_defaults = True
napoleon_use_ivar = True
doctest_global_setup = """
import os, tempfile
os.chdir(tempfile.mkdtemp())  # what a page writes stays out of the checkout
import numpy as np
import nanotouch as nt
from nanotouch import *
from nanotouch.contact.geometry import Shape, validity
"""
html_copy_source = False
# The tip of the page on pages about physics, where `make page` has built it (build/page): a page, what it touches.
TOUCH = ROOT / "build/page/nanotouch-touch.html"
TOUCHED = {
    "contact": "silicon_in_air",
    "forces": "silicon_on_gold",
    "geometry": "polyester",
    "interaction": "mica_in_air",
    "deformation": "cell_in_liquid",
}
html_extra_path = [str(TOUCH)] if TOUCH.exists() else []
suppress_warnings = ["ref.python"]  # fields of many records have the same name, such as x
linkcheck_ignore = [r"https?://localhost.*", r"tcp://.*"]
sphinx_gallery_conf = {
    "image_scrapers": ("gallery_figures.drawn_figures", "matplotlib"),
    "examples_dirs": ["examples/gallery", "examples/notebooks"],
    "gallery_dirs": ["gallery", "notebooks"],
    "filename_pattern": r"/plot_",
    "remove_config_comments": True,
    "abort_on_example_error": True,
    "within_subsection_order": "FileNameSortKey",
    "min_reported_time": 1000,
    "show_memory": False,
    "capture_repr": (),
    "download_all_examples": False,
    "default_thumb_file": str(HERE / "pictures/touch.png"),
}


def command_page() -> str:
    """The reference of the command: its own help texts."""
    from nanotouch_app.main import COMMANDS, build_parser

    parser = build_parser()
    (commands,) = (action for action in parser._actions if isinstance(action.choices, dict))
    parts = ["# The command\n", f"```text\n{parser.format_help()}```\n"]
    for name in COMMANDS:
        parts.append(f"## nanotouch {name}\n\n```text\n{commands.choices[name].format_help()}```\n")
    return "\n".join(parts)


DECLARED = re.compile(
    r"(?P<comment>/\*(?:(?!\*/).)*\*/\n)?(?P<text>NT_API[^;]*?\b(?P<name>nt_\w+)\s*\([^;]*;"
    r"|typedef (?:struct|enum)\b[^{;]*\{.*?^\} (?P<type>nt_\w+);)",
    re.DOTALL | re.MULTILINE,
)


def header_page() -> str:
    """The reference of the C library: a heading for each function and type, with what its header says of it."""
    folder = ROOT / "libnanotouch/include/nanotouch"
    parts = ["# The C library\n", "Include `nanotouch/nanotouch.h`, or the header that is needed.\n"]
    for title, headers in (("", folder.glob("*.h")), (" (may change in any version)", folder.glob("advanced/*.h"))):
        for header in sorted(headers):
            found = list(DECLARED.finditer(header.read_text(encoding="utf-8")))
            parts += [f"## {header.relative_to(folder.parent)}{title}\n"] * bool(found)
            for one in found:
                comment = re.sub(r"^/\*+ ?|\s*\*/$|^ \* ?", "", (one["comment"] or "").strip(), flags=re.MULTILINE)
                parts.append(f"### {one['name'] or one['type']}\n\n```c\n{one['text']}\n```\n")
                parts.append(f"```text\n{comment}\n```\n" if comment else "")
    return "\n".join(parts)


def write_pages(app: Any) -> None:
    """Write what is made from the sources; unchanged pages keep their time, so that nothing is built again."""
    for name, text in (("command.md", command_page()), ("headers.md", header_page())):
        path = HERE / "reference" / name
        if not path.exists() or path.read_text() != text:
            path.write_text(text)


def keep_links_inside(app: Any, name: str, source: list[str]) -> None:
    """Links to folders and to sources, which the site does not have, become plain text."""
    folder = Path(app.srcdir, name).parent

    def plain(link: re.Match[str]) -> str:
        target = (folder / link[2]).resolve()
        return link[1] if target.is_dir() or (target.exists() and HERE not in target.parents) else link[0]

    source[0] = re.sub(r"\[([^\]]+)\]\(([^)#:\s]+)\)", plain, source[0])


def touch_here(app: Any, name: str, source: list[str]) -> None:
    """Put the tip at the end of a page about physics."""
    if name in TOUCHED and TOUCH.exists():
        preset = TOUCHED[name]
        frame = f'<iframe src="{TOUCH.name}#preset={preset}" title="a tip over a surface" loading="lazy"'
        frame += ' style="width:100%; height:34rem; border:0"></iframe>'
        words = f"Scroll down over the surface, or run `nanotouch live {preset}`."
        source[0] += f"\n\n## Touch it\n\n{words}\n\n```{{raw}} html\n{frame}\n```\n"


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("source-read", touch_here)
    app.connect("builder-inited", write_pages)
    app.connect("source-read", keep_links_inside)
