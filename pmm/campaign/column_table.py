"""The table ``[columns]``: which column of a text recording is what."""

from pathlib import Path
from typing import Any

from analysis.readers import ColumnMap
from analysis.readers.columns_toml import parse_column_map
from hardware.description.errors import ConfigurationError
from pmm.configuration import Fault


def take_columns(table: dict[str, Any], path: Path, faults: list[Fault]) -> ColumnMap | None:
    """Take the table out of a file's; what is wrong with it is noted."""
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
