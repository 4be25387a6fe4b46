"""The test files that a module's mutations are tried on first: those that import it, then wider."""

import ast
import re
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path


def rings(root: Path, packages: Sequence[str], file: str) -> Iterator[list[str]]:
    """Yield test files by how many imports lie between them and a file, each file once."""
    imports = _imports(root, (*packages, "tests"))
    importers: dict[str, set[str]] = {}
    for one, imported in imports.items():
        for name in imported:
            importers.setdefault(name, set()).add(one)
    asked, ring, words = {file}, {file}, _words(file)
    while ring:
        ring = {by for one in ring for by in importers.get(one, ())} - asked
        asked |= ring
        tests = [one for one in ring if Path(one).name.startswith("test_")]
        if tests:
            yield sorted(tests, key=lambda one: (-len(words & _words(one)), one))


def _words(file: str) -> set[str]:
    """Return the words of a path: tests are named much as what they test."""
    return {*re.split(r"\W|_", file)}


@cache
def _imports(root: Path, packages: tuple[str, ...]) -> dict[str, frozenset[str]]:
    """Return the files that each file imports."""
    files = [path for name in packages for path in sorted((root / name).rglob("*.py"))]
    names = {_module(root, path): path.relative_to(root).as_posix() for path in files}
    return {
        path.relative_to(root).as_posix(): frozenset(
            names[name]
            for name in _imported(path.read_text(encoding="utf-8"))
            if name in names
        )
        for path in files
    }  # fmt: skip


def _module(root: Path, path: Path) -> str:
    return ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")


def _imported(source: str) -> Iterator[str]:
    """Yield the names that may be modules, of every import at whatever depth."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (one.name for one in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{one.name}" for one in node.names)
