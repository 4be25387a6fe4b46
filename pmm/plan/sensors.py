"""What is known of a rig's sensors once it has run: tables of the campaign that it leaves.

Only what the devices and the records tell. What ``[campaign]`` of the rig's file states goes before
that, but for which channels there are.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

import numpy as np

from hardware.description.channels import DISPLACEMENTS, SHAFT_ANGLE, STANDARD, Channel
from hardware.description.simulation_tables import GAUGES, merged
from hardware.dictionary import Entry, entry
from hardware.path_shaft_settings import STRUTS
from hardware.rig_configuration import RigConfiguration, RigPart
from pmm.campaign.calibration import Calibration
from pmm.plan.rig_file import RigFile

_FRACTIONS: Final = frozenset("fd")  # struct codes of what is no count


def dynamometers_table(rig: RigFile) -> dict[str, Any]:
    """Return ``[dynamometers]``: the gauges' full scales, and what the rig's file hands on."""
    ranges = {
        GAUGES[gauge.channel]: {"full_scale_n": gauge.full_scale_n}
        for gauge in rig.gauges
        if gauge.channel in GAUGES
    }
    return merged(ranges, rig.campaign.get("dynamometers", {}))


def acquisition_table(
    rig: RigFile, recorded: Sequence[Channel], noise_rms: Sequence[Mapping[str, float]]
) -> dict[str, Any]:
    """Return ``[acquisition]``: a table for each sensor that was recorded.

    Its step and range are the device's, its noise that of the records at rest. A calibrated gauge
    has none of its readings' steps and range, and its noise is that of the force.

    Parameters
    ----------
    recorded
        The channels of the recordings.
    noise_rms
        Of each record at rest, by channel (:func:`pmm.recorder.recording.white_noise_rms`).
    """
    channels = {one.name: one for one in recorded}
    steps = resolutions(rig.hardware)
    noise = _noise(noise_rms, steps, rig.calibration)
    gauges = rig.calibration.channels if rig.calibration is not None else ()
    stated = rig.campaign.get("acquisition", {})
    found: dict[str, Any] = {}
    for name in (one.name for one in STANDARD):
        if name not in channels:
            found[name] = False
            continue
        known = {"noise_rms": noise.get(name)}
        if name not in gauges:
            known |= {"resolution": steps.get(name), "full_scale": channels[name].full_scale}
        own = {key: one for key, one in known.items() if one is not None}
        found[name] = merged(own, stated.get(name) or {})
    return found


def resolutions(hardware: RigConfiguration) -> dict[str, float]:
    """Return the step of each channel whose device counts, in the channel's unit."""
    found = {one.name: abs(one.scale) for part in hardware.forces for one in _counting(part)}
    settings = None if hardware.shaft is None else hardware.shaft.settings
    counts = getattr(settings, "counts_per_turn", None)
    if counts:
        found[SHAFT_ANGLE.name] = 2.0 * math.pi / abs(counts)
    for strut, name in zip(STRUTS, DISPLACEMENTS, strict=True):
        if getattr(settings, "encoders", False) and name not in found:
            found[name] = 1.0 / abs(getattr(settings, strut).counts_per_unit)
    return found


def _counting(part: RigPart) -> Iterator[Any]:
    """Yield the channels of an amplifier whose objects are whole numbers."""
    whole = set(_whole_numbers(part))
    for one in getattr(part.settings, "channels", ()):
        if hasattr(one, "scale") and hasattr(one, "object") and entry(one.object) in whole:
            yield one


def _whole_numbers(part: RigPart) -> Iterator[Entry]:
    for plan in part.nodes():
        for layout in plan.layouts()[0]:
            codes = layout.code.format.lstrip("<")
            yield from (
                at for at, code in zip(layout.entries, codes, strict=True) if code not in _FRACTIONS
            )


def _noise(
    seen: Sequence[Mapping[str, float]], steps: Mapping[str, float], one: Calibration | None
) -> dict[str, float]:
    """Return the usual noise of each channel without its rounding; what is below that is left."""
    names = dict.fromkeys(name for record in seen for name in record)
    found: dict[str, float] = {}
    for name in names:
        squares = [
            record[name] ** 2 for record in seen if math.isfinite(record.get(name, math.nan))
        ]
        rounding = steps.get(name, 0.0) ** 2 / 12.0
        if squares and (own := float(np.median(squares)) - rounding) > rounding:
            found[name] = math.sqrt(own)
    if one is None or not set(one.channels) <= set(found):
        return {name: rms for name, rms in found.items() if one is None or name not in one.channels}
    forces = np.sqrt(np.linalg.inv(one.matrix) ** 2 @ [found[name] ** 2 for name in one.channels])
    return found | dict(zip(one.channels, map(float, forces), strict=True))
