"""Whatever a user puts in a key: the file is read, or refused with a message; nothing else."""

import json
import tomllib
from collections.abc import Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.errors import ConfigurationError
from pmm.inertia.bifilar_tables import BifilarTable
from pmm.inertia.incline import InclineJob
from pmm.inertia.parts import BallastJob, CombineJob
from pmm.inertia.pendulum import PendulumJob
from pmm.inertia.plan import PlanJob
from pmm.inertia.reading import read_job
from pmm.inertia.swing_tables import SwingTable

EXAMPLES = Path(__file__).parents[3] / "examples" / "inertia"
KINDS = {
    "swing": SwingTable,
    "hull": BifilarTable,
    "axes": BifilarTable,
    "pendulum": PendulumJob,
    "incline": InclineJob,
    "combine": CombineJob,
    "ballast": BallastJob,
    "plan": PlanJob,
}
ODD: list[Any] = [True, -1.0, 0, 3, "text", "", [], [1, "a"], {}, {"x": 1}, [{}], [[]]]


def _places(table: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    parts = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in parts:
        yield (*place, key)
        if isinstance(value, dict | list):
            yield from _places(value, (*place, key))


def _toml(value: Any) -> str:
    """Return an inline value."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return json.dumps(value)


def _write(path: Path, table: dict[str, Any]) -> None:
    path.write_text("".join(f"{json.dumps(key)} = {_toml(one)}\n" for key, one in table.items()))


@pytest.mark.parametrize("name", KINDS)
def test_the_examples_are_read(name: str) -> None:
    assert read_job(EXAMPLES / f"{name}.toml", KINDS[name]).table.name


@pytest.mark.slow
@given(data=st.data())
def test_a_spoiled_file_is_read_or_refused(
    data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    name = data.draw(st.sampled_from(sorted(KINDS)))
    table = deepcopy(tomllib.loads((EXAMPLES / f"{name}.toml").read_text()))
    *way, last = data.draw(st.sampled_from(list(_places(table))))
    holder: Any = table
    for key in way:
        holder = holder[key]
    if data.draw(st.booleans()):
        holder[last] = data.draw(st.sampled_from(ODD))
    else:
        del holder[last]
    path = tmp_path_factory.mktemp("spoiled") / "job.toml"
    _write(path, table)
    try:
        assert read_job(path, KINDS[name]).path == path
    except ConfigurationError as error:
        assert str(path) in str(error)  # noqa: PT017


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("model = 3", "model"),
        ("suspensions = 3", "suspensions"),
        ("suspensions = []", "suspensions is empty"),
        ("suspensions = [{ name = [] }]", "suspensions[1].name"),
        ("columns = 3", "columns should be a table"),
    ],
)
def test_wrong_kinds_of_values(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "job.toml"
    path.write_text(text)
    for kind in (SwingTable, BifilarTable):
        with pytest.raises(ConfigurationError) as refused:
            read_job(path, kind)
        if kind is BifilarTable:
            assert message in str(refused.value)
