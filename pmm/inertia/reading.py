"""Reading a job's TOML: every error of the file at once, each with its place in it."""

from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, is_dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar, get_args, get_type_hints

from analysis.readers import ColumnMap
from pmm.campaign.column_table import take_columns
from pmm.configuration import Fault, Place, as_error, limit_faults, read_toml, validate

Table = TypeVar("Table")


@dataclass(frozen=True)
class Job(Generic[Table]):
    """A job's file, read and checked.

    Attributes
    ----------
    table
        What it says.
    columns
        Column map of its text records, if it has one.
    """

    path: Path
    table: Table
    columns: ColumnMap | None

    def path_beside(self, name: str) -> Path:
        """Return where a file that the job names lies: beside the job's own."""
        return self.path.parent / name


def read_job(path: str | Path, kind: type[Table]) -> Job[Table]:
    """Read a job's file.

    Raises
    ------
    ConfigurationError
        If the file cannot be read, or for unknown keys (with a suggestion), wrong types, values
        beyond their limits, and alternatives of which none or several are given: all errors of the
        file in one message, each with its place in the file.
    """
    path = Path(path)
    original = read_toml(path)
    table: dict[str, Any] = deepcopy(original)
    faults: list[Fault] = []
    columns = take_columns(table, path, faults)
    faults += limit_faults(table)
    job_table = validate(kind, table, faults)
    faults += rule_faults(kind, table)
    if job_table is None or faults:
        raise as_error(path, faults, original)
    return Job(path, job_table, columns)


def rule_faults(kind: Any, table: Mapping[str, Any], place: Place = ()) -> Iterator[Fault]:
    """Yield what the rules of the tables' classes say of a table and of all within it.

    A class states its rules in a static method ``rules``, which takes the table as it stands in the
    file and yields pairs of key and message; an empty key means the table as a whole.
    """
    for key, message in getattr(kind, "rules", _no_rules)(table):
        yield Fault((*place, key) if key else place, message)
    yield from _lonely_uncertainties(kind, table, place)
    hints = get_type_hints(kind)
    for key, value in table.items():
        inner = _table_class(hints.get(key))
        for number, row in _tables(value) if inner is not None else ():
            yield from rule_faults(inner, row, (*place, key, *number))


def _no_rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:  # noqa: ARG001
    yield from ()


def _lonely_uncertainties(kind: Any, table: Mapping[str, Any], place: Place) -> Iterator[Fault]:
    hints = get_type_hints(kind)
    for key in table:
        of = key.removeprefix("u_")
        if key in hints and of != key and of in hints and of not in table:
            yield Fault((*place, key), f"is given without {of}, whose uncertainty it is")


def _tables(value: object) -> list[tuple[tuple[int, ...], dict[str, Any]]]:
    if isinstance(value, dict):
        return [((), value)]
    rows = value if isinstance(value, list) else []
    return [((number,), row) for number, row in enumerate(rows) if isinstance(row, dict)]


def _table_class(hint: Any) -> Any:
    """Return the dataclass within ``T``, ``T | None`` or ``tuple[T, ...]``, if there is one."""
    if is_dataclass(hint):
        return hint
    return next(
        (
            table_class
            for table_class in map(_table_class, get_args(hint))
            if table_class is not None
        ),
        None,
    )


def one_of(table: Mapping[str, Any], *keys: str, needed: bool = True) -> Iterator[tuple[str, str]]:
    """Yield a rule's message unless exactly one of these keys is given (or none, if not needed)."""
    stated_keys = [key for key in keys if table.get(key) not in (None, [])]
    if len(stated_keys) > 1:
        yield stated_keys[-1], f"and {stated_keys[0]} are both given; one is enough"
    elif needed and not stated_keys:
        yield "", f"needs one of {', '.join(keys)}"


def require_together(table: Mapping[str, Any], *keys: str) -> Iterator[tuple[str, str]]:
    """Yield a rule's message where some of these keys are given and others are not."""
    stated_keys = [key for key in keys if key in table]
    for key in keys:
        if stated_keys and key not in stated_keys:
            yield key, f"is missing beside {stated_keys[0]}"
