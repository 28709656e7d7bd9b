# SPDX-License-Identifier: BSD-3-Clause
"""Files with known answers: writes them from random variants of every format, reads them as users do, and counts what
is right, refused and silently wrong: ``make corpus``.

    python tests/corpus/generated.py --count 2000 --first 1 [--formats JPK nid] [--keep FOLDER] [--write PAGE]
"""

from __future__ import annotations

import argparse
import importlib
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from judge import Verdict, judge
from made import Made, Writer

MODULES = (
    "nanoscope_image",
    "nanoscope_force",
    "jpk",
    "asylum_curve",
    "nanoscope_text",
    "nova_curve",
    "nanonis_curve",
    "asylum_image",
    "nanonis_image",
    "nanosurf_image",
    "surf_image",
    "wsxm_image",
    "text_image",
    "gwyddion_image",
    "gsf_image",
    "hdf5_image",
)


MARK, END = (
    "<!-- made by tests/corpus/generated.py -->\n",
    "<!-- end of it -->\n",
)  # the tables lie between, in the docs


def writers() -> dict[str, Writer]:
    found: dict[str, Writer] = {}
    for name in MODULES:
        module = importlib.import_module(name)
        found[module.FORMAT] = module.write
    return found


@dataclass(frozen=True)
class Row:
    seed: int
    made: Made
    verdict: Verdict


def rows(count: int, first: int, formats: Sequence[str], folder: Path) -> Iterator[Row]:
    """`count` files with the seeds from `first` on, the formats in turn."""
    known = {name: write for name, write in writers().items() if not formats or any(f in name for f in formats)}
    if not known:
        raise SystemExit(f"no such format: {', '.join(formats)}; known: {', '.join(writers())}")
    for seed in range(first, first + count):
        name = list(known)[seed % len(known)]
        place = folder / str(seed)
        place.mkdir()
        made = known[name](np.random.default_rng(seed), place)
        yield Row(seed, made, judge(made))


def table(found: Sequence[Row]) -> str:
    """Per format: what is right, refused and wrong."""
    lines = [
        "| format | files | right | refused rightly | refused, though readable | silently wrong |",
        "|---|---|---|---|---|---|",
    ]
    for name in [*dict.fromkeys(row.made.format for row in found), "all"]:
        counts = Counter(_class(row) for row in found if name in (row.made.format, "all"))
        total = sum(counts.values())
        lines.append(
            f"| {name} | {total} | {counts['right']} | {counts['rightly']} | {counts['refused']} | {counts['wrong']} |"
        )
    return "\n".join(lines)


def _class(row: Row) -> str:
    if row.verdict.kind == "refused" and (row.made.may_refuse or row.made.must_refuse):
        return "rightly"
    return row.verdict.kind


def fields() -> list[str]:
    """A row for each format: what varies, and how."""
    modules = [importlib.import_module(name) for name in MODULES]
    varied = ["; ".join(f"{key}: {_values(row)}" for key, row in module.GRID.items()) for module in modules]
    return [f"| {module.FORMAT} | {text} |" for module, text in zip(modules, varied, strict=True)]


def page(found: Sequence[Row], asked: str) -> str:
    """What is read, with which fields, and what is refused and how: for the documentation."""
    lines = [f"`{asked}`:", "", table(found), "", "| format | fields that vary |", "|---|---|", *fields()]
    lines += ["", "| format | refused | files | how |", "|---|---|---|---|"]
    reasons = Counter((row.made.format, _class(row), _pattern(row)) for row in found if row.verdict.kind == "refused")
    for (name, kind, reason), number in sorted(reasons.items()):
        lines.append(f"| {name} | {'rightly' if kind == 'rightly' else 'though readable'} | {number} | {reason} |")
    if not reasons:
        lines.append("| | none | 0 | |")
    return "\n".join([*lines, ""])


def _values(row: Sequence[object]) -> str:
    known = dict.fromkeys("yes" if v is True else "no" if v is False else "none" if v in ("", None) else v for v in row)
    return ", ".join(f"`{value.strip() or repr(value)}`" if isinstance(value, str) else str(value) for value in known)


def _pattern(row: Row) -> str:
    """The reason without its numbers."""
    return re.sub(r"\d[\d.e+-]*", "#", row.verdict.reason).replace("|", "/")[:160]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--first", type=int, default=1, help="first seed")
    parser.add_argument("--formats", nargs="*", default=[], help="part of the name of a format")
    parser.add_argument("--keep", type=Path, help="folder in which the files stay")
    parser.add_argument("--write", type=Path, help="page of the documentation that takes the tables, after its mark")
    parser.add_argument("--all", action="store_true", help="print every verdict")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = asked.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        found = []
        for row in rows(asked.count, asked.first, asked.formats, folder):
            found.append(row)
            if asked.all or _class(row) in ("wrong", "refused"):
                told = ", ".join(f"{key}={value!r}" for key, value in row.made.variant.items())
                print(f"{row.seed} {row.made.format}: {row.verdict.kind}: {row.verdict.reason}\n    {told}", flush=True)
    print(table(found))
    readable = [row for row in found if not row.made.must_refuse]
    wrong = sum(_class(row) == "wrong" for row in found)
    refused = sum(_class(row) == "refused" for row in readable)
    if asked.write:
        before, _, rest = asked.write.read_text(encoding="utf-8").partition(MARK)
        command = f"python tests/corpus/generated.py --count {asked.count} --first {asked.first}"
        after = rest.partition(END)[2]
        asked.write.write_text(before + MARK + page(found, command) + END + after, encoding="utf-8")
    print(f"{wrong} of {len(found)} silently wrong; {refused} of {len(readable)} readable ones refused")
    return int(wrong > 0 or refused > 0.02 * len(readable))


if __name__ == "__main__":
    sys.exit(main())
