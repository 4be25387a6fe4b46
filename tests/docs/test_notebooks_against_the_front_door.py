"""The notebooks use what docs/python.md lists; `make docs` and `make release` run them."""

import ast
import re
import sys
from pathlib import Path

import pytest

import pmm

NOTEBOOKS = Path(__file__).parents[2] / "docs" / "notebooks"
PAGES = sorted(set(NOTEBOOKS.glob("*.md")) - {NOTEBOOKS / "index.md"})


def _program(page: Path) -> ast.Module:
    cells = re.findall(r"^```\{code-cell\}\n(.*?)^```$", page.read_text("utf-8"), re.M | re.S)
    return ast.parse("".join(cells), str(page))


def test_each_is_in_the_index() -> None:
    index = (NOTEBOOKS / "index.md").read_text(encoding="utf-8")
    assert {one.stem for one in PAGES} == {"recordings", "inertia", "gap", "planning"}
    assert {one.stem for one in PAGES} <= set(index.split())


@pytest.mark.parametrize("page", PAGES, ids=lambda one: one.stem)
def test_only_the_front_door_is_used(page: Path) -> None:
    used, drawn = set(), False
    for node in ast.walk(_program(page)):
        match node:
            case ast.Import(names=[ast.alias(name=name)]) | ast.ImportFrom(module=str(name)):
                assert name == "pmm" or name in sys.stdlib_module_names
            case ast.Attribute(value=ast.Name(id="pmm"), attr=name):
                used.add(name)
            case ast.Attribute(attr=name):
                drawn = drawn or name.startswith("plot")
                assert not name.startswith("_")
    assert used
    assert used <= set(pmm.__all__)
    assert drawn


@pytest.mark.parametrize("page", PAGES, ids=lambda one: one.stem)
def test_the_examples_are_there(page: Path) -> None:
    for node in ast.walk(_program(page)):
        if isinstance(node, ast.Constant) and str(node.value).startswith(".."):
            assert (NOTEBOOKS / str(node.value)).exists()
