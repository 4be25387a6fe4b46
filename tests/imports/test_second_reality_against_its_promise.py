"""The sealed generator shares no code with the product: its files' own imports are read."""

import ast
import re
from pathlib import Path

GENERATOR = Path(__file__).parents[1] / "sealed" / "generator"
PRODUCT = {"pmm", "analysis", "sim", "hardware", "planar_motion_mechanism", "benchmarks"}


def _imported(path: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path.name}: imports are written out here"
            names.add(node.module or "")
    return names


def test_it_imports_nothing_of_what_it_judges() -> None:
    imported = {path.name: _imported(path) for path in GENERATOR.glob("*.py")}
    assert len(imported) > 30
    roots = {name: {one.partition(".")[0] for one in found} for name, found in imported.items()}
    assert {name: sorted(found & PRODUCT) for name, found in roots.items() if found & PRODUCT} == {}
    tests = {one for found in imported.values() for one in found if one.startswith("tests.")}
    assert all(one.startswith("tests.sealed.generator") for one in tests)


def test_its_page_names_files_that_are_there() -> None:
    text = (GENERATOR / "README.md").read_text(encoding="utf-8")
    there = {path.name for path in GENERATOR.glob("*.py")}
    beside = {path.name for path in GENERATOR.parent.glob("test_*.py")} | {"geometry.py"}
    named = set(re.findall(r"\b[a-z_]+\.py\b", text))
    assert named <= there | beside
    assert len(named & there) > 20
