"""Writing TOML: plain values, lists, tables inside tables."""

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any


def toml_table(name: str, table: Mapping[str, Any], *, array: bool = False) -> str:
    """Return a table under its heading; keys without a value (``None``) are left out.

    Parameters
    ----------
    array
        Whether it is one of an array of tables.
    """
    heading = f"[[{name}]]" if array else f"[{name}]"
    lines = [
        f"{toml_key(key)} = {toml_value(value)}"
        for key, value in table.items()
        if value is not None
    ]
    return "\n".join([heading, *lines]) + "\n"


def toml_value(value: Any) -> str:
    """Return a value in one line.

    Raises
    ------
    TypeError
        If TOML has no such value.
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # JSON's strings are TOML's, but for the one control character that JSON lets through.
        return json.dumps(str(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else ("inf" if value > 0.0 else "-inf")
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, Mapping):
        inner = (
            f"{toml_key(key)} = {toml_value(entry)}"
            for key, entry in value.items()
            if entry is not None
        )
        return f"{{ {', '.join(inner)} }}"
    if isinstance(value, Sequence):
        return f"[{', '.join(map(toml_value, value))}]"
    raise TypeError(f"{value!r} cannot be written as TOML")


def toml_key(key: str) -> str:
    """Return a key as TOML has it: in quotes where it needs them."""
    plain = key.isascii() and key.replace("_", "").replace("-", "").isalnum()
    return key if plain else toml_value(key)
