"""Reading a job's TOML: every error of the file at once, each with its place in it."""

from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, is_dataclass
from pathlib import Path
from typing import Any, Generic, TypeVar, get_args, get_type_hints

from analysis.readers import ColumnMap
from analysis.readers.columns_toml import parse_column_map
from hardware.description.errors import ConfigurationError
from hardware.description.toml import is_number
from pmm.configuration import Fault, Place, as_error, limit_faults, read_toml, validate

Table = TypeVar("Table")

# What a number of that name must be, in whichever table it stands; beside those of all files.
_ABOVE_0 = (
    "apart_m",
    "beats",
    "body_density_kg_m3",
    "coefficient",
    "depth_m",
    "diameter_m",
    "duration_s",
    "gravity_m_s2",
    "known_inertia_kg_m2",
    "known_scatter_degrees_of_freedom",
    "known_scatter_s",
    "length_m",
    "lever_m",
    "line_m",
    "moment_kg_m",
    "moment_relative",
    "oscillations",
    "period_degrees_of_freedom",
    "period_s",
    "period_scatter_relative",
    "pivot_distance_m",
    "reaction_s",
    "square_half_side_m",
    "stiffness_n_m_rad",
    "tolerance",
    "tolerance_kg",
    "tolerance_m",
    "weight_kg",
)
_NOT_BELOW_0 = (
    "air_density_kg_m3",
    "counting_error",
    "k_pitch_m",
    "k_roll_m",
    "k_yaw_m",
    "sway_coefficient",
)


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

    def beside(self, name: str) -> Path:
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
    table, faults = deepcopy(original), list(_limits(original))
    columns = _take_columns(table, path, faults)
    found = validate(kind, table, faults)
    faults += rule_faults(kind, table)
    if found is None or faults:
        raise as_error(path, faults, original)
    return Job(path, found, columns)


def _take_columns(table: dict[str, Any], path: Path, faults: list[Fault]) -> ColumnMap | None:
    columns = table.pop("columns", None)
    if columns is None:
        return None
    origin = f"{path.name} [columns]"
    if not isinstance(columns, dict):
        faults.append(Fault(("columns",), "should be a table"))
        return None
    try:
        return parse_column_map(columns, origin)
    except ConfigurationError as error:
        faults.append(Fault((), f"[columns] {str(error).removeprefix(f'{origin}: ')}"))
        return None


def _limits(original: dict[str, Any]) -> Iterator[Fault]:
    table = {key: value for key, value in original.items() if key != "columns"}
    yield from limit_faults(table)
    yield from _own_limits(table)


def _own_limits(table: Any, place: Place = ()) -> Iterator[Fault]:
    parts = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in parts:
        here: Place = (*place, key)
        if isinstance(value, dict | list):
            yield from _own_limits(value, here)
        elif is_number(value):
            if key in _ABOVE_0 and value <= 0:
                yield Fault(here, f"= {value:g} should be above 0")
            elif _never_below_0(key) and value < 0:
                yield Fault(here, f"= {value:g} should be 0 or more")


def _never_below_0(key: object) -> bool:
    return isinstance(key, str) and (key in _NOT_BELOW_0 or key.startswith("u_"))


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
        for number, one in _tables(value) if inner is not None else ():
            yield from rule_faults(inner, one, (*place, key, *number))


def _no_rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:  # noqa: ARG001
    yield from ()


def _lonely_uncertainties(kind: Any, table: Mapping[str, Any], place: Place) -> Iterator[Fault]:
    known = get_type_hints(kind)
    for key in table:
        of = key.removeprefix("u_")
        if key in known and of != key and of in known and of not in table:
            yield Fault((*place, key), f"is given without {of}, whose uncertainty it is")


def _tables(value: object) -> list[tuple[tuple[int, ...], dict[str, Any]]]:
    if isinstance(value, dict):
        return [((), value)]
    rows = value if isinstance(value, list) else []
    return [((number,), one) for number, one in enumerate(rows) if isinstance(one, dict)]


def _table_class(hint: Any) -> Any:
    """Return the dataclass within ``T``, ``T | None`` or ``tuple[T, ...]``, if there is one."""
    if is_dataclass(hint):
        return hint
    return next((one for one in map(_table_class, get_args(hint)) if one is not None), None)


def one_of(table: Mapping[str, Any], *keys: str, needed: bool = True) -> Iterator[tuple[str, str]]:
    """Yield a rule's message unless exactly one of these keys is given (or none, if not needed)."""
    given = [key for key in keys if table.get(key) not in (None, [])]
    if len(given) > 1:
        yield given[-1], f"and {given[0]} are both given; one is enough"
    elif needed and not given:
        yield "", f"needs one of {', '.join(keys)}"


def together(table: Mapping[str, Any], *keys: str) -> Iterator[tuple[str, str]]:
    """Yield a rule's message where some of these keys are given and others are not."""
    given = [key for key in keys if key in table]
    for key in keys:
        if given and key not in given:
            yield key, f"is missing beside {given[0]}"
