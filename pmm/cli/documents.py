"""What the JSON documents of all commands have in common."""

import math
from typing import Any


def without_nan(value: Any) -> Any:
    """Return the same with ``None`` for every number that JSON does not have."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: without_nan(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [without_nan(part) for part in value]
    return value
