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
    channels = {channel.name: channel for channel in recorded}
    steps = resolutions(rig.hardware)
    noise = _noise(noise_rms, steps, rig.calibration)
    gauges = rig.calibration.channels if rig.calibration is not None else ()
    stated = rig.campaign.get("acquisition", {})
    tables: dict[str, Any] = {}
    for name in (channel.name for channel in STANDARD):
        if name not in channels:
            tables[name] = False
            continue
        settings = {"noise_rms": noise.get(name)}
        if name not in gauges:
            settings |= {"resolution": steps.get(name), "full_scale": channels[name].full_scale}
        table = {key: value for key, value in settings.items() if value is not None}
        tables[name] = merged(table, stated.get(name) or {})
    return tables


def resolutions(hardware: RigConfiguration) -> dict[str, float]:
    """Return the step of each channel whose device counts, in the channel's unit."""
    steps = {
        channel.name: abs(channel.scale) for part in hardware.forces for channel in _counting(part)
    }
    settings = None if hardware.shaft is None else hardware.shaft.settings
    counts = getattr(settings, "counts_per_turn", None)
    if counts:
        steps[SHAFT_ANGLE.name] = 2.0 * math.pi / abs(counts)
    for strut, name in zip(STRUTS, DISPLACEMENTS, strict=True):
        if getattr(settings, "encoders", False) and name not in steps:
            steps[name] = 1.0 / abs(getattr(settings, strut).counts_per_unit)
    return steps


def _counting(part: RigPart) -> Iterator[Any]:
    """Yield the channels of an amplifier whose objects are whole numbers."""
    integers = set(_whole_numbers(part))
    for channel in getattr(part.settings, "channels", ()):
        if (
            hasattr(channel, "scale")
            and hasattr(channel, "object")
            and entry(channel.object) in integers
        ):
            yield channel


def _whole_numbers(part: RigPart) -> Iterator[Entry]:
    for plan in part.nodes():
        for layout in plan.layouts()[0]:
            codes = layout.code.format.lstrip("<")
            yield from (
                at for at, code in zip(layout.entries, codes, strict=True) if code not in _FRACTIONS
            )


def _noise(
    records: Sequence[Mapping[str, float]],
    steps: Mapping[str, float],
    calibration: Calibration | None,
) -> dict[str, float]:
    """Return the usual noise of each channel without its rounding; what is below that is left."""
    names = dict.fromkeys(name for record in records for name in record)
    noise: dict[str, float] = {}
    for name in names:
        squares = [
            record[name] ** 2 for record in records if math.isfinite(record.get(name, math.nan))
        ]
        rounding = steps.get(name, 0.0) ** 2 / 12.0
        if squares and (variance := float(np.median(squares)) - rounding) > rounding:
            noise[name] = math.sqrt(variance)
    if calibration is None or not set(calibration.channels) <= set(noise):
        return {
            name: rms
            for name, rms in noise.items()
            if calibration is None or name not in calibration.channels
        }
    forces = np.sqrt(
        np.linalg.inv(calibration.matrix) ** 2 @ [noise[name] ** 2 for name in calibration.channels]
    )
    return noise | dict(zip(calibration.channels, map(float, forces), strict=True))
