# SPDX-License-Identifier: BSD-3-Clause
"""Mutants of Python: where a module may be changed, and the module with all drawn changes in it, behind switches."""

from __future__ import annotations

import ast
import copy
from pathlib import Path

from c_source import Mutant, numbered

COMPARED = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
            ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In}  # fmt: skip
CALCULATED = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
IMPORT = "from nanotouch_mutants import is_on as _mutant_is_on_on"


def changed(node: ast.AST) -> ast.expr | None:
    """Return this expression with one change; None where there is nothing to change."""
    new = copy.deepcopy(node)
    if isinstance(new, ast.Compare) and len(new.ops) == 1 and type(new.ops[0]) in COMPARED:
        new.ops = [COMPARED[type(new.ops[0])]()]
    elif isinstance(new, ast.BinOp) and type(new.op) in CALCULATED and not _is_text(new):
        new.op = CALCULATED[type(new.op)]()
    elif isinstance(new, ast.BoolOp):
        new.op = ast.Or() if isinstance(new.op, ast.And) else ast.And()
    elif isinstance(new, ast.UnaryOp) and isinstance(new.op, ast.Not | ast.USub):
        return new.operand
    elif isinstance(new, ast.Constant) and type(new.value) in (int, float):
        new.value = 2 * new.value if new.value else 1
    elif isinstance(new, ast.Constant) and isinstance(new.value, bool):
        new.value = not new.value
    else:
        return None
    return new


def _is_text(node: ast.BinOp) -> bool:
    texts = (ast.JoinedStr, ast.List, ast.Tuple)
    sides = (node.left, node.right)
    return any(isinstance(s, texts) or (isinstance(s, ast.Constant) and isinstance(s.value, str)) for s in sides)


class _Walk(ast.NodeTransformer):
    """Visits every place where a change may stand; `switched` maps the count of the place to its switch."""

    def __init__(self, path: str, source: str, switched: dict[int, int] | None = None):
        self.path, self.source, self.switched = path, source, switched or {}
        self.found: list[Mutant] = []
        self.function = ""

    def visit_FunctionDef(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> ast.AST:
        outer, self.function = self.function, f"{self.function}.{node.name}".lstrip(".")
        node.body = list(map(self.visit, node.body))
        self.function = outer
        return node

    visit_AsyncFunctionDef = visit_FunctionDef

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST:
        if node.value is not None:
            node.value = self.visit(node.value)
        return node

    def visit_JoinedStr(self, node: ast.JoinedStr) -> ast.AST:
        return node

    visit_Match = visit_JoinedStr  # type: ignore[assignment]

    def visit_Expr(self, node: ast.Expr) -> ast.AST:
        inner = self.generic_visit(node)
        if not self.function or not isinstance(node.value, ast.Call):
            return inner
        number = self._note(node, "")
        if number is None:
            return inner
        return ast.If(_is_off(number), [inner], [])

    def visit(self, node: ast.AST) -> ast.AST:
        if not self.function or not isinstance(node, ast.expr):
            return super().visit(node)
        new = changed(node)
        if new is None:
            return super().visit(node)
        number = self._note(node, ast.unparse(new))
        inner = super().visit(node)
        if number is None:
            return inner
        return ast.IfExp(_is_off(number), inner, new)

    def _note(self, node: ast.expr | ast.stmt, text: str) -> int | None:
        original = ast.unparse(node)
        self.found.append(Mutant(self.path, self.function, node.lineno, 0, 0, original, text))
        return self.switched.get(len(self.found) - 1)


def _is_off(number: int) -> ast.expr:
    call = ast.Call(ast.Name("_mutant_is_on_on", ast.Load()), [ast.Constant(number)], [])
    return ast.UnaryOp(ast.Not(), call)


def of_file(path: Path, root: Path) -> list[Mutant]:
    """Return every mutant of the functions in a module."""
    source = path.read_text()
    walk = _Walk(str(path.relative_to(root)), source)
    walk.visit(ast.parse(source))
    return numbered([m._replace(start=place) for place, m in enumerate(walk.found)])


def with_switches(source: str, mutants: dict[int, Mutant]) -> str:
    """Return the module with these mutants of it, by their numbers, each in force while its number is switched on."""
    walk = _Walk("", source, {mutant.start: number for number, mutant in mutants.items()})
    tree = walk.visit(ast.parse(source))
    after = next(
        (i for i, part in enumerate(tree.body) if not _is_first(part)),
        len(tree.body),
    )
    tree.body[after:after] = ast.parse(IMPORT).body
    return ast.unparse(ast.fix_missing_locations(tree))


def _is_first(part: ast.stmt) -> bool:
    is_docstring = isinstance(part, ast.Expr) and isinstance(part.value, ast.Constant)
    return is_docstring or (isinstance(part, ast.ImportFrom) and part.module == "__future__")
