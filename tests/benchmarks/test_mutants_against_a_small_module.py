"""A mutation that a test notices is killed, one that none looks at survives; and what is drawn."""

from pathlib import Path

import pytest

from benchmarks.mutants.command import drawn
from benchmarks.mutants.nearest import rings
from benchmarks.mutants.sites import mutations
from benchmarks.mutants.trial import Covering, House

SOURCE = """
def larger(a: float, b: float) -> float:
    return a if a > b else b
"""
TESTS = """
from room.small import larger

def test_larger():
    assert larger(1.0, 2.0) == 2.0

def test_broken():
    assert larger(1.0, 2.0) == 3.0
"""


@pytest.fixture
def house(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> House:
    (tmp_path / "room").mkdir()
    (tmp_path / "room" / "__init__.py").touch()
    (tmp_path / "room" / "small.py").write_text(SOURCE)
    (tmp_path / "test_small.py").write_text(TESTS)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    monkeypatch.setenv("PYTEST_PLUGINS", "pytest_timeout")  # these tests need no other
    return House(tmp_path)


@pytest.mark.slow
def test_what_is_noticed_is_killed_and_the_boundary_survives(house: House) -> None:
    tests = ["test_small.py::test_broken", "test_small.py::test_larger"]
    covering = Covering({2: [""], 3: tests})
    assert covering.of(2) == covering.of(3) == tests
    assert covering.of(4) == []
    outcomes = {
        one.kind: house.judge("room/small.py", one, [covering.of(one.line)])
        for one in mutations(SOURCE)
    }
    assert outcomes == {
        "boundary": {"outcome": "survived", "tests": 1},
        "comparison": {"outcome": "killed", "by": "test_small.py::test_larger", "tests": 1},
    }
    assert (house.folder / "room" / "small.py").read_text() == SOURCE


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("a * (b + c)", {"(a / (b + c))", "a * ((b - c))"}),
        ("not a", {"(a)"}),
        ("-a", {"(a)"}),
        ("a and b", {"(a or b)"}),
        ("a <= b", {"(a > b)", "(a < b)"}),
        ("f(a, b)", {"(f(b, a))"}),
        ("f(*a, b)", set()),
        ("3", {"(4)"}),
        ("0.0", {"(1.0)"}),
        ("'é' + f'{a + b}'", {"('é' - f'{a + b}')"}),
    ],
)
def test_each_kind(before: str, after: set[str]) -> None:
    source = f"x: 1 + 1 = {before}"
    told = {one.applied(source).removeprefix("x: 1 + 1 = ") for one in mutations(source)}
    assert told == after


def test_a_seed_draws_the_same_and_no_mutation_twice(tmp_path: Path) -> None:
    (tmp_path / "room").mkdir()
    (tmp_path / "room" / "small.py").write_text("x = 1 + 2 < 3 * 4\n")
    first, again = (drawn(tmp_path, ["room"], 60, 1) for _ in range(2))
    assert first == again
    assert len(set(first)) == len(first) == len(mutations("x = 1 + 2 < 3 * 4\n"))


def test_only_what_stands_once_in_both_states_is_drawn(tmp_path: Path) -> None:
    states = {"now": "x = 1 + 2\ny = a < b\ny = a < b\n", "before": "y = a < b\nx = 1 + 2\nz = 7\n"}
    for name, source in states.items():
        (tmp_path / name / "room").mkdir(parents=True)
        (tmp_path / name / "room" / f"{name}.py").write_text(source)
    found = drawn(tmp_path / "now", ["room"], 60, 1, tmp_path / "before")
    assert {(file, one.text) for file, one in found} == {("room/now.py", "x = 1 + 2")}


def test_who_imports_a_file_is_asked_before_who_imports_it_through_another(tmp_path: Path) -> None:
    sources = {
        "room/small.py": SOURCE,
        "room/user.py": "def used():\n    from room import small\n",
        "tests/test_near.py": "from room.small import larger\nimport room.user\n",
        "tests/test_far.py": "import room.user\n",
        "tests/test_elsewhere.py": "import json\n",
    }
    for name, source in sources.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(source)
    found = list(rings(tmp_path, ["room"], "room/small.py"))
    assert found == [["tests/test_near.py"], ["tests/test_far.py"]]
