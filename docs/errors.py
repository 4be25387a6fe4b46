"""Write ``errors.md``: ``python docs/errors.py``. Types and causes come from the code itself.

``errors.toml`` beside this file says what to do about each type and lists messages that are met
often; what it says has to be there in the code, and each type of the code has to be in it.
"""

import ast
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

HERE = Path(__file__).parent
ROOMS = ("hardware", "analysis", "sim", "pmm")
BASE = "PmmError"


@dataclass(frozen=True)
class ErrorType:
    """A class of errors as its source has it."""

    name: str
    module: str
    bases: tuple[str, ...]
    cause: str
    reaction: str | None


def sources() -> Iterator[Path]:
    """Return the program's sources."""
    yield HERE.parent / "planar_motion_mechanism.py"
    for room in ROOMS:
        yield from sorted((HERE.parent / room).rglob("*.py"))


@cache
def error_types() -> dict[str, ErrorType]:
    """Return all classes that come from :class:`PmmError`, by name, in the order of the rooms."""
    classes, _ = _read()
    found = {BASE: classes[BASE]}
    while more := {
        name: one
        for name, one in classes.items()
        if name not in found and any(base in found for base in one.bases)
    }:
        found |= more
    return {name: one for name, one in classes.items() if name in found}


@cache
def _read() -> tuple[dict[str, ErrorType], set[str]]:
    """Return all classes by name and all texts of the code, each source parsed once."""
    classes, texts = {}, set()
    for path in sources():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        classes |= {one.name: one for one in _classes(path, tree)}
        texts |= _texts(tree)
    return classes, texts


def _classes(path: Path, tree: ast.Module) -> Iterator[ErrorType]:
    module = ".".join(path.relative_to(HERE.parent).with_suffix("").parts)
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            bases = tuple(base.id for base in node.bases if isinstance(base, ast.Name))
            text = " ".join((ast.get_docstring(node) or "").split("\n\n")[0].split())
            yield ErrorType(node.name, module, bases, text, _reaction(node))


def _reaction(node: ast.ClassDef) -> str | None:
    for line in node.body:
        target = line.targets[0] if isinstance(line, ast.Assign) else getattr(line, "target", None)
        if isinstance(target, ast.Name) and target.id == "reaction":
            value = getattr(line, "value", None)
            return value.attr if isinstance(value, ast.Attribute) else None
    return None


def reaction(name: str, types: dict[str, ErrorType]) -> str:
    """Return what the rig does, as the class or the one it comes from says; empty for none."""
    one = types.get(name)
    if one is None:
        return ""
    if one.reaction is not None:
        return one.reaction.lower().replace("_", " ")
    return next((found for base in one.bases if (found := reaction(base, types))), "")


def templates() -> set[str]:
    """Return all texts of the code, with ``...`` where a value is put in."""
    return _read()[1]


def _texts(tree: ast.Module) -> set[str]:
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            parts = [one.value if isinstance(one, ast.Constant) else "..." for one in node.values]
            found.add("".join(map(str, parts)))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.add(node.value)
    return found


def page() -> str:
    """Return the page.

    Raises
    ------
    SystemExit
        If a message is not in the code, or types of the code and of the list differ.
    """
    told = tomllib.loads((HERE / "errors.toml").read_text(encoding="utf-8"))
    types, texts = error_types(), templates()
    lost = [one["text"] for one in told["messages"]
            if not any(one["text"] in text for text in texts)]  # fmt: skip
    apart = sorted(set(told["types"]) ^ set(types))
    if lost or apart:
        sys.exit(f"errors.toml: not in the code {lost}; types listed or defined alone {apart}")
    lines = [told["head"], "| message | cause | cure |", "|---|---|---|"]
    lines += [f"| {_cell(one['text'])} | {one['cause']} | {one['cure']} |"
              for one in told["messages"]]  # fmt: skip
    lines += [told["about_types"], "| type | cause | reaction | cure |", "|---|---|---|---|"]
    lines += [
        f"| `{one.module}.{name}` | {one.cause.replace('``', '`')} | {reaction(name, types)} | "
        f"{told['types'][name]} |"
        for name, one in types.items()
    ]
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    escaped = text.replace("|", "\\|")
    return f"`{escaped}`"


if __name__ == "__main__":
    (HERE / "errors.md").write_text(page(), encoding="utf-8")
