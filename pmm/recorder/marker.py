"""The completion marker of a run, as anybody finds it: of the right shape, or none."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hardware.description.flags import Flag
from pmm.recorder.files import MARKER, RECOVERED
from pmm.recorder.line_shapes import is_marker, is_recovered


def read_marker(folder: Path) -> dict[str, Any] | None:
    """Return what a run's marker says; ``None`` where there is none, or it cannot be one."""
    found = _read(folder / MARKER)
    return found if found is not None and is_marker(found) and _are_flags(found["flags"]) else None


def read_recovered(folder: Path) -> dict[str, Any]:
    """Return what an earlier recovery wrote; nothing where there was none, or it is damaged."""
    found = _read(folder / RECOVERED)
    whole = found is not None and is_recovered(found) and _are_flags(found["flags"])
    return found if found is not None and whole else {}


def _read(path: Path) -> dict[str, Any] | None:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def _are_flags(told: list[Mapping[str, Any]]) -> bool:
    try:
        tuple(map(Flag.read, told))
    except (ValueError, TypeError, KeyError):
        return False
    return True
