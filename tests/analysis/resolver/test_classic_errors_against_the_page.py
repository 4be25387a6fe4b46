"""The table of ``docs/modes-of-1963.md`` against the functions that it names."""

import ast
import re
from pathlib import Path

import pytest

from tests.analysis.resolver import classic_errors

PAGE = Path(__file__).parents[3] / "docs" / "modes-of-1963.md"
ROW = re.compile(r"\| `(\w+)\(([^)]*)\)` \| ([^|]+) \|")
ROWS = ROW.findall(PAGE.read_text(encoding="utf-8"))


def test_every_function_has_its_row() -> None:
    public = {
        name
        for name, value in vars(classic_errors).items()
        if callable(value) and not name.startswith("_")
    }
    assert {name for name, _, _ in ROWS} == public


@pytest.mark.parametrize(("name", "arguments", "printed"), ROWS)
def test_the_page_prints_what_the_function_gives(name: str, arguments: str, printed: str) -> None:
    value = getattr(classic_errors, name)(*ast.literal_eval(f"({arguments},)"))
    values = value if isinstance(value, tuple) else (value,)
    shown = [float(number) for number in printed.split(",")]
    assert shown == pytest.approx(values, rel=5e-3, abs=1e-12)
