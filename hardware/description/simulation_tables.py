"""What ``rig.toml`` states of the rig that is simulated, under the names of ``campaign.toml``.

One mapping for all who need it: the simulated devices build their rig from it, a plan's check tells
where they depart from it, and the campaign that run control leaves behind has it.
"""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any, Final

from hardware.description.body import DIMENSIONS
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from hardware.description.oscillator import PRESETS

GAUGES: Final = {FORCE_AFT.name: "aft", FORCE_FORE.name: "fore"}  # channel -> key of [dynamometers]
_PHOTOCELL: Final = {"angle_offset_rad": "mark_angle_rad", "latency_s": "latency_s"}


def simulation_tables(rig: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of a simulation that a rig's file states, and only these.

    ``[oscillator]`` with its preset's keys, ``[model]`` without its dimensions, ``[hull]``, the
    gauges' full scales as ``[dynamometers]``, ``[reference]`` as ``[photocell]``, and what stands
    in ``[campaign]``, which goes before.

    Parameters
    ----------
    rig
        The file's tables as they were read; whoever runs the rig has checked them.
    """
    tables: dict[str, Any] = {}
    if "oscillator" in rig:
        tables["oscillator"] = with_preset(rig["oscillator"])
    if "model" in rig:
        tables["model"] = {
            key: value for key, value in rig["model"].items() if key not in DIMENSIONS
        }
    if "hull" in rig:
        tables["hull"] = dict(rig["hull"])
    if ranges := _gauge_ranges(rig):
        tables["dynamometers"] = ranges
    reference = rig.get("reference", {})
    if cell := {to: reference[key] for key, to in _PHOTOCELL.items() if key in reference}:
        tables["photocell"] = cell
    return merged(tables, rig.get("campaign", {}))


def with_preset(oscillator: Mapping[str, Any]) -> dict[str, Any]:
    """Return ``[oscillator]`` with what its preset stands for; the keys beside it win."""
    table = {key: value for key, value in oscillator.items() if key != "preset"}
    preset = PRESETS.get(oscillator.get("preset", ""))
    return table if preset is None else asdict(preset) | table


def channels_of(rig: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Return the table of each channel of the amplifiers, by its name."""
    return {
        channel["name"]: channel
        for part in rig.get("forces", ())
        for channel in part.get("channels", ())
    }


def merged(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Return tables with others over them, key by key; lists are taken whole."""
    tables = dict(base)
    for key, value in over.items():
        before = tables.get(key)
        if isinstance(value, Mapping) and isinstance(before, Mapping):
            tables[key] = merged(before, value)
        else:
            tables[key] = value
    return tables


def _gauge_ranges(rig: Mapping[str, Any]) -> dict[str, Any]:
    """Return the full scale of the strut gauges: that of ``[[gauges]]``, else of the amplifiers."""
    ranges = {name: channel.get("full_scale") for name, channel in channels_of(rig).items()}
    if "gauges" in rig:
        ranges = {gauge["channel"]: gauge["full_scale_n"] for gauge in rig["gauges"]}
    strut_ranges = (
        (GAUGES[name], full_scale) for name, full_scale in ranges.items() if name in GAUGES
    )
    return {
        gauge: {"full_scale_n": full_scale}
        for gauge, full_scale in strut_ranges
        if full_scale is not None
    }
