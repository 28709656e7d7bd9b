# SPDX-License-Identifier: BSD-3-Clause
"""The site without building it: every page is in a table of contents, every link within it leads somewhere, every
example of the gallery is Python, and the citation file has what GitHub wants. ``make docs`` builds and runs it all."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
pytestmark = pytest.mark.skipif(not (DOCS / "conf.py").exists(), reason="needs the source tree")
MADE = {
    "reference/command.md",
    "reference/headers.md",
    "gallery/index.rst",
    "notebooks/index.rst",
}  # when the site is built
OWN = {"README.md", "index.md", "decisions/README.md"}


def pages() -> list[Path]:
    found = [
        path
        for path in DOCS.rglob("*.md")
        if not {"examples", "gallery", "notebooks"} & set(path.relative_to(DOCS).parts)
    ]
    return [path for path in found if path.relative_to(DOCS).as_posix() not in MADE]


def contents(page: Path) -> list[Path]:
    """The pages that its tables of contents name."""
    blocks = re.findall(r"^```\{toctree\}\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)
    names = [line.strip() for block in blocks for line in block.splitlines() if line.strip() and line[0] != ":"]
    found = [sorted(page.parent.glob(f"{name}.md")) if "*" in name else [page.parent / name] for name in names]
    return [path.resolve().with_suffix("") for paths in found for path in paths]


def test_every_page_is_in_a_table_of_contents_once() -> None:
    listed = [entry for page in pages() for entry in contents(page)]
    assert len(listed) == len(set(listed))
    own = {path.resolve().with_suffix("") for path in pages()} - {(DOCS / name).with_suffix("") for name in OWN}
    missing = {path.relative_to(DOCS).as_posix() for path in own - set(listed)}
    assert not missing, f"in no table of contents (docs/*/index.md): {missing}"
    made = {(DOCS / name).with_suffix("") for name in MADE}
    assert not {path.as_posix() for path in set(listed) - own - made}


def test_links_between_pages_lead_somewhere() -> None:
    broken = []
    for page in pages():
        text = re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL)
        for target in re.findall(r"\]\(([^)#:\s]+[./][^)#:\s]*)(?:#[^)]*)?\)", text):
            path = page.parent / target
            if not path.exists() and path.resolve().relative_to(DOCS).as_posix() not in MADE:
                broken.append(f"{page.relative_to(DOCS)}: {target}")
    assert not broken


def test_the_gallery_has_its_examples() -> None:
    examples = sorted((DOCS / "examples/gallery").glob("plot_*.py"))
    notebooks = sorted((DOCS / "examples/notebooks").glob("plot_*.py"))
    assert len(examples) >= 25
    assert len(notebooks) == len(list((DOCS / "tutorials").glob("[0-9]*.md")))
    for path in examples + notebooks:
        tree = ast.parse(path.read_text())
        title = (ast.get_docstring(tree) or "").splitlines()
        assert len(title) >= 3, path.name
        assert set(title[1]) == {"="}, path.name
        assert any(isinstance(node, ast.Name) and node.id == "figure" for node in ast.walk(tree)), path.name


def test_it_can_be_cited() -> None:
    text = (DOCS.parent / "CITATION.cff").read_text()
    assert all(f"\n{key}:" in f"\n{text}" for key in ("cff-version", "message", "title", "authors", "license"))
