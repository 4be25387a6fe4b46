"""Where a source can be mutated, and what it then says.

A mutation replaces one expression: an operator by its rival, a comparison by its opposite or by the
one that differs at the boundary, a number by another, a flag by the other, ``not x`` by ``x``,
``f(a, b)`` by ``f(b, a)``. What stands in annotations and in f-strings is left alone.
"""

import ast
import copy
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

_ARITHMETIC: Final[dict[type[ast.operator], type[ast.operator]]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.Pow: ast.Mult, ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult,
    ast.BitAnd: ast.BitOr, ast.LShift: ast.RShift, ast.RShift: ast.LShift,
}  # fmt: skip
_OPPOSITE: Final[dict[type[ast.cmpop], type[ast.cmpop]]] = {
    ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
_BOUNDARY: Final[dict[type[ast.cmpop], type[ast.cmpop]]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt,
}  # fmt: skip


@dataclass(frozen=True)
class Mutation:
    """One expression and what takes its place.

    Attributes
    ----------
    begin, end
        Where the expression stands, in bytes of the source.
    line
        The line on which it begins, from 1.
    function
        The name of the innermost function around it; empty outside of functions.
    text
        The line on which it begins.
    """

    kind: str
    function: str
    text: str
    line: int
    begin: int
    end: int
    before: str
    after: str

    @property
    def told(self) -> tuple[str, ...]:
        """What is the same of a mutation in two states of the sources."""
        return self.kind, self.function, self.text, self.before, self.after

    def applied(self, source: str) -> str:
        """Return the mutated source."""
        text = source.encode()
        return (text[: self.begin] + self.after.encode() + text[self.end :]).decode()


def mutations(source: str) -> list[Mutation]:
    """Return every mutation of a source, in the order of its text."""
    data, starts = source.encode(), [0]
    for line in data.split(b"\n"):
        starts.append(starts[-1] + len(line) + 1)
    texts = [line.strip() for line in source.split("\n")]
    found = []
    for node, function in _expressions(ast.parse(source)):
        begin = starts[node.lineno - 1] + node.col_offset
        end = starts[(node.end_lineno or 1) - 1] + (node.end_col_offset or 0)
        before = data[begin:end].decode()
        for kind, changed in _changes(node):
            after = f"({ast.unparse(changed)})"
            text = texts[node.lineno - 1]
            found.append(Mutation(kind, function, text, node.lineno, begin, end, before, after))
    return sorted(found, key=lambda one: (one.begin, one.end, one.kind))


def _expressions(node: ast.AST, function: str = "") -> Iterator[tuple[ast.expr, str]]:
    """Yield the expressions that are computed, of whatever is below, with the function's name."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        function = node.name
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list"):
            continue
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, ast.AST) and not isinstance(one, ast.JoinedStr):
                if isinstance(one, ast.expr):
                    yield one, function
                yield from _expressions(one, function)


def _changes(node: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    changed = copy.copy(node)
    match changed:
        case ast.BinOp() if type(changed.op) in _ARITHMETIC:
            changed.op = _ARITHMETIC[type(changed.op)]()
            yield "arithmetic", changed
        case ast.BoolOp():
            changed.op = ast.Or() if isinstance(changed.op, ast.And) else ast.And()
            yield "and, or", changed
        case ast.UnaryOp(op=ast.USub() | ast.Not() as operator):
            yield "sign" if isinstance(operator, ast.USub) else "not", changed.operand
        case ast.Constant(value=bool() | int() | float() as value):
            yield _other(value)
        case ast.Call(args=[first, second, *more]) if not _starred(changed.args):
            changed.args = [second, first, *more]
            yield "arguments", changed
        case ast.Compare(ops=[only]):
            yield from _compared(changed, type(only))


def _compared(node: ast.Compare, operator: type[ast.cmpop]) -> Iterator[tuple[str, ast.expr]]:
    for kind, rivals in (("comparison", _OPPOSITE), ("boundary", _BOUNDARY)):
        if operator in rivals:
            yield kind, ast.Compare(node.left, [rivals[operator]()], node.comparators)


def _other(value: float) -> tuple[str, ast.expr]:
    if isinstance(value, bool):
        return "flag", ast.Constant(not value)
    return "number", ast.Constant(value + 1 if isinstance(value, int) else 2.0 * value or 1.0)


def _starred(arguments: list[ast.expr]) -> bool:
    return any(isinstance(one, ast.Starred) for one in arguments)
