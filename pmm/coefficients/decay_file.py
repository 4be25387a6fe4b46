"""``[[roll_decays]]`` that name what ``pmm inertia pendulum --json`` told of their records."""

import json
import math
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, Final

from pmm.configuration import Fault

_KEY: Final = "result"
_TAKEN: Final = {  # name of a finding: keys of its value, standard uncertainty and freedom
    "period_s": ("period_s", "u_period_s", "period_degrees_of_freedom"),
    "small_damping_ratio": ("damping_ratio", "u_damping_ratio", "damping_degrees_of_freedom"),
}
_REMEDY: Final = "`pmm inertia pendulum FILE --json` of roll records writes one"


def fill_decays(table: dict[str, Any], folder: Path) -> Iterator[Fault]:
    """Put period and damping ratio of each named result in its decay; yield what is wrong."""
    decays = table.get("roll_decays")
    for k, decay in enumerate(decays if isinstance(decays, list) else []):
        if isinstance(decay, dict) and isinstance(decay.get(_KEY), str):
            message = _fill(decay, folder / decay.pop(_KEY))
            if message:
                yield Fault(("roll_decays", k, _KEY), message)


def _fill(decay: dict[str, Any], path: Path) -> str:
    """Fill one decay, or return in words why it cannot be."""
    typed = [key for keys in _TAKEN.values() for key in keys if key in decay]
    findings: dict[str, Any] = {}
    with suppress(OSError, ValueError, KeyError, TypeError):
        findings = dict(json.loads(path.read_text(encoding="utf-8"))["results"])
    missing = [name for name in _TAKEN if name not in findings]
    # Whatever is wrong, what a decay needs is there, so that this is the one sentence about it.
    for name, keys in _TAKEN.items():
        finding = findings.get(name, {"value": 0.5})
        numbers = (
            finding["value"],
            finding.get("standard_uncertainty"),
            finding.get("degrees_of_freedom"),
        )
        pairs = zip(keys, numbers, strict=True)
        decay.update({key: number for key, number in pairs if number is not None})
    with suppress(TypeError, ValueError, ZeroDivisionError):  # a decay's period is the damped one
        decay["period_s"] /= math.sqrt(1.0 - decay["damping_ratio"] ** 2)
    if typed:
        return f"and {', '.join(typed)} are both given; leave one of them out"
    if missing:
        return f"= {str(path)!r} tells no {' and no '.join(missing)}; {_REMEDY}"
    return ""
