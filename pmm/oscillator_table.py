"""The table ``[oscillator]``: a preset that fills in its keys."""

from collections.abc import Mapping
from dataclasses import asdict
from difflib import get_close_matches
from types import MappingProxyType
from typing import Any, Final

from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Oscillator
from pmm.configuration import Fault

PRESETS: Final[Mapping[str, Oscillator]] = MappingProxyType(
    {"vertical-1963": VERTICAL_1963, "horizontal-1963": HORIZONTAL_1963}
)


def expand_preset(table: dict[str, Any], faults: list[Fault]) -> None:
    """Fill in the oscillator that a preset stands for; the keys beside it win."""
    oscillator = table.get("oscillator")
    if not isinstance(oscillator, dict) or "preset" not in oscillator:
        return
    preset = oscillator.pop("preset")
    if preset not in PRESETS:
        names = " or ".join(PRESETS)
        faults.append(Fault(("oscillator", "preset"), f"= {preset!r} should be {names}"))
        preset = get_close_matches(str(preset), PRESETS, n=1, cutoff=0.0)[0]
    table["oscillator"] = asdict(PRESETS[preset]) | oscillator
