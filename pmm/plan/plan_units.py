"""Units for people in ``plan.toml``, and single numbers in place of lists."""

import math
from typing import Any, Final

from hardware.description.toml import is_number
from pmm.configuration import Fault, Place

_DEGREE: Final = math.pi / 180.0
# Key for people -> key in SI, and the factor between; the same for the lists of an entry.
_ONE: Final = {
    "amplitude_mm": ("amplitude_m", 1e-3),
    "strut_phase_deg": ("strut_phase_rad", _DEGREE),
    "drift_deg": ("drift_rad", _DEGREE),
}
_LISTS: Final = {
    "amplitudes_mm": ("amplitudes_m", 1e-3),
    "strut_phases_deg": ("strut_phases_rad", _DEGREE),
    "drifts_deg": ("drifts_rad", _DEGREE),
    "rudder_angles_deg": ("rudder_angles_rad", _DEGREE),
    "heels_deg": ("heels_rad", _DEGREE),
    "releases_deg": ("releases_rad", _DEGREE),
    "wave_amplitude_mm": ("wave_amplitude_m", 1e-3),
    "wave_heading_deg": ("wave_heading_rad", _DEGREE),
}
# Keys of lists that a single value may stand for.
_MANY: Final = (
    "frequencies_hz",
    "amplitudes_m",
    "speeds_m_s",
    "strut_phases_rad",
    "drifts_rad",
    "rudder_angles_rad",
    "revolutions_hz",
    "heels_rad",
    "radii_m",
    "releases_rad",
    "channels",
    "loads_n",
)
EXTRA_KEYS: Final = {"runs": tuple(_LISTS), "control": tuple(_ONE)}
# Sought, found elsewhere: half the stroke is what is meant here.
_STROKES: Final = ("stroke", "strokes", "stroke_m", "stroke_mm", "strokes_m", "strokes_mm")


def expand_units(table: dict[str, Any], faults: list[Fault]) -> None:
    """Turn millimetres and degrees into metres and radians, and single values into lists."""
    control = table.get("control")
    if isinstance(control, dict):
        _expand(control, _ONE, ("control",), faults)
    runs = table.get("runs")
    for number, run in enumerate(runs if isinstance(runs, list) else []):
        if isinstance(run, dict):
            _expand(run, _LISTS, ("runs", number), faults)
            for key in _MANY:
                if isinstance(run.get(key), int | float | str) and key in run:
                    run[key] = [run[key]]


def _expand(
    table: dict[str, Any],
    units: dict[str, tuple[str, float]],
    place: Place,
    faults: list[Fault],
) -> None:
    for key in [key for key in table if key in _STROKES]:
        del table[key]
        text = "is not taken: give the amplitude, half the stroke (amplitudes_mm)"
        faults.append(Fault((*place, key), text.replace("s_mm", "_mm") if "control" in place
                            else text))  # fmt: skip
    for key in [key for key in units if key in table]:
        value, (si_key, factor) = table.pop(key), units[key]
        if si_key in table:
            faults.append(Fault((*place, key), f"and {si_key} are both given; one is enough"))
        elif isinstance(value, list) and units is _LISTS and all(map(is_number, value)):
            table[si_key] = [number * factor for number in value]
        elif is_number(value):
            table[si_key] = value * factor
        else:
            many = " or a list of numbers" if units is _LISTS else ""
            faults.append(Fault((*place, key), f"= {value!r} should be a number{many}"))
            table[si_key] = [1.0] if units is _LISTS else 1.0  # not reported as missing too
