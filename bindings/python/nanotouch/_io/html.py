# SPDX-License-Identifier: BSD-3-Clause
"""Small tables of HTML, for notebooks. All text is escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

CELL = "text-align:left;padding:1px 10px 1px 0"


def table(title: str, headers: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A title over a table."""
    head = "".join(f'<th style="{CELL}">{escape(name)}</th>' for name in headers)
    body = "".join(
        "<tr>" + "".join(f'<td style="{CELL}">{escape(cell)}</td>' for cell in row) + "</tr>" for row in rows
    )
    return f"<div><b>{escape(title)}</b><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"


def text(title: str, words: str) -> str:
    """A title over text with its own line ends."""
    return f'<div><b>{escape(title)}</b><pre style="line-height:1.3">{escape(words)}</pre></div>'
