"""Values and tables as the text of a TOML file."""

import json
from collections.abc import Mapping
from typing import Any


def as_toml(value: Any) -> str:
    """Return a value as TOML; mappings inline."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {as_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(as_toml(item) for item in value) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    return str(value) if isinstance(value, int) else repr(float(value))


def table(head: str, rows: Mapping[str, Any]) -> str:
    """Return a table of TOML under its header line."""
    return "\n".join([head, *(f"{key} = {as_toml(value)}" for key, value in rows.items()), ""])
