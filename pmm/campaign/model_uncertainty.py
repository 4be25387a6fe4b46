"""Tables that need more than a check of their keys: [oscillator] and [model_uncertainty]."""

import math
from dataclasses import asdict, dataclass
from difflib import get_close_matches
from typing import Any

from hardware.description.oscillator import PRESETS
from pmm.configuration import STRICT_TABLE, Fault, validate


@dataclass(frozen=True)
class ModelUncertainty:
    """Standard uncertainties of the model's mass properties, under the same keys.

    Attributes
    ----------
    inertia_degrees_of_freedom
        Behind the inertia's; infinite where it does not rest on repeats.
    """

    mass_kg: float = 0.0
    inertia_kg_m2: float = 0.0
    cg_x_m: float = 0.0
    cg_z_m: float = 0.0
    inertia_degrees_of_freedom: float = math.inf

    __pydantic_config__ = STRICT_TABLE


def take_uncertainty(table: dict[str, Any], faults: list[Fault]) -> ModelUncertainty | None:
    """Take the table out of a campaign's; what is wrong with it is noted."""
    entry = table.pop("model_uncertainty", None)
    if entry is None:
        return None
    place = "model_uncertainty"
    if not isinstance(entry, dict):
        faults.append(Fault((place,), "should be a table"))
        return None
    finite = {key: value for key, value in entry.items() if value != math.inf or key != _FREEDOM}
    entry_faults: list[Fault] = []
    uncertainty = validate(ModelUncertainty, finite, entry_faults)
    faults += [Fault((place, *fault.place), fault.message) for fault in entry_faults]
    for key, value in finite.items():
        if isinstance(value, int | float) and value < 0.0:
            faults.append(Fault((place, key), f"= {value:g} should be 0 or more"))
    return uncertainty


_FREEDOM = "inertia_degrees_of_freedom"


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
