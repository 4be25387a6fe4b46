"""The table ``[oscillator]``: a preset that fills in its keys."""

from dataclasses import asdict
from difflib import get_close_matches
from typing import Any

from hardware.description.oscillator import PRESETS
from pmm.configuration import Fault


def expand_preset(table: dict[str, Any], faults: list[Fault]) -> None:
    """Fill in the oscillator that a preset stands for; the keys beside it win."""
    oscillator = table.get("oscillator")
    if not isinstance(oscillator, dict) or "preset" not in oscillator:
        return
    preset = oscillator.pop("preset")
    if not isinstance(preset, str) or preset not in PRESETS:
        names = " or ".join(PRESETS)
        faults.append(Fault(("oscillator", "preset"), f"= {preset!r} should be {names}"))
        preset = get_close_matches(str(preset), PRESETS, n=1, cutoff=0.0)[0]
    table["oscillator"] = asdict(PRESETS[preset]) | oscillator
