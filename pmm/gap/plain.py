"""Results as a JSON document can hold them."""

import math
from typing import Any

import numpy as np


def plain_values(value: Any) -> Any:
    """Return numbers, texts, lists and tables only; NaN and infinity as ``None``."""
    if isinstance(value, dict):
        return {str(key): plain_values(one) for key, one in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain_values(one) for one in value]
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return value
