"""Samples of a test's cases: as many as asked for, evenly drawn, the others slow."""

import pytest

from tests.conftest import pytest_collection_modifyitems


class Case:
    """A case of a test, as far as drawing looks at it."""

    def __init__(self, nodeid: str, count: int | None) -> None:
        self.nodeid = nodeid
        self.marks = {"sample": pytest.mark.sample(count).mark} if count else {}

    def get_closest_marker(self, name: str) -> object:
        return self.marks.get(name)

    def add_marker(self, mark: pytest.MarkDecorator) -> None:
        self.marks[mark.name] = mark.mark


@pytest.mark.parametrize(
    ("cases", "count", "drawn"),
    [(10, 1, [5]), (10, 2, [2, 7]), (3, 3, [0, 1, 2]), (1, 4, [0]), (4, None, [0, 1, 2, 3])],
)
def test_they_are_drawn_evenly(cases: int, count: int | None, drawn: list[int]) -> None:
    items = [Case(f"tests/test_one.py::test[{k}]", count) for k in range(cases)]
    other = Case("tests/test_one.py::test_other", None)
    pytest_collection_modifyitems([*items, other])  # type: ignore[list-item]
    assert [k for k, one in enumerate(items) if "slow" not in one.marks] == drawn
    assert "slow" not in other.marks
