"""Reading a JSON file against its schema."""

import json
from pathlib import Path
from typing import Any, TypeVar

from pmm.configuration import Fault, as_error, validate

T = TypeVar("T")


def read_json(path: Path, schema: str) -> dict[str, Any]:
    """Return a file's table.

    Raises
    ------
    ValueError
        If it is no JSON table of this schema.
    """
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ValueError(f"{path}: cannot be read: {error}") from None
    said = table.get("schema") if isinstance(table, dict) else None
    if said != schema:
        raise ValueError(f"{path}: schema is {said!r}, should be {schema!r}")
    return dict(table)


def checked(kind: type[T], path: Path, table: dict[str, Any]) -> T:
    """Return a file's table as a dataclass.

    Raises
    ------
    ValueError
        With every error of the file.
    """
    faults: list[Fault] = []
    found = validate(kind, table, faults)
    if found is None or faults:
        raise ValueError(str(as_error(path, faults, table)))
    return found
