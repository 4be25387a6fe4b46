"""A document for programs: keys, numbers and texts, as JSON can hold them."""

import json
import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np

from pmm.document.content import Document


def as_data(document: Document) -> dict[str, Any]:
    """Return what programs get, by key; what is not known is ``None``."""
    keyed = {content.key: content.data for content in document.contents if content.key}
    return {"schema": document.schema, **{key: plain(value) for key, value in keyed.items()}}


def as_json(document: Document) -> str:
    """Return :func:`as_data` of a document as JSON, without NaN."""
    return json.dumps(as_data(document), indent=1, allow_nan=False)


def plain(value: Any) -> Any:
    """Return numbers, texts, lists and tables only; NaN and infinity as ``None``."""
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain(item) for item in value]
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, np.integer | np.bool_):
        return value.item()
    if isinstance(value, Path):
        return str(value)
    return value.value if isinstance(value, Enum) else value
