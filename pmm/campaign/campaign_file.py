"""Reading ``campaign.toml``: presets, units for people, and every error of the file at once."""

import math
from collections.abc import Iterator
from copy import deepcopy
from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any, TypeVar

from hardware.description.errors import ConfigurationError
from hardware.description.kinds import RunKind
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import Medium, check_within
from pmm.campaign.attitude import attitude_faults
from pmm.campaign.campaign import Campaign
from pmm.campaign.column_table import take_columns
from pmm.campaign.file_names import campaign_name_faults, no_file_name
from pmm.campaign.model_uncertainty import expand_preset, take_uncertainty
from pmm.campaign.runs import AtRest, Run
from pmm.configuration import Fault, Place, as_error, limit_faults, read_toml, validate

T = TypeVar("T")

# Key for people -> key in SI, and the factor between.
_UNITS = {
    "eccentricity_mm": ("eccentricity_m", 1e-3),
    "strut_phase_deg": ("strut_phase_rad", math.pi / 180.0),
    "drift_deg": ("drift_rad", math.pi / 180.0),
    "rudder_angle_deg": ("rudder_angle_rad", math.pi / 180.0),
    "heel_deg": ("heel_rad", math.pi / 180.0),
    "turn_rate_deg_s": ("turn_rate_rad_s", math.pi / 180.0),
    "release_deg": ("release_rad", math.pi / 180.0),
    "wave_amplitude_mm": ("wave_amplitude_m", 1e-3),
    "wave_heading_deg": ("wave_heading_rad", math.pi / 180.0),
}
_RESTING = ("drift_deg", "rudder_angle_deg", "heel_deg", "turn_rate_deg_s", "release_deg")
_EXTRA_KEYS = {"oscillator": ("preset",), "runs": tuple(_UNITS), "at_rest": _RESTING}
# Tables and keys for which ``false`` says that the rig has no such thing.
_MAY_BE_FALSE = ("photocell", "acquisition")


def read_campaign(path: str | Path) -> Campaign:
    """Read a campaign file.

    Raises
    ------
    ConfigurationError
        If the file cannot be read, or for unknown keys (with a suggestion), wrong types, values
        beyond their limits or those of the oscillator, and runs of the same name: all errors of
        the file in one message, each with its path in the file.
    """
    path = Path(path)
    original = read_toml(path)
    faults: list[Fault] = []
    table = deepcopy(original)
    uncertainty = take_uncertainty(table, faults)
    faults += limit_faults(table)
    columns = take_columns(table, path, faults)
    expand_preset(table, faults)
    _expand_units(table, faults)
    _none_for_false(table)
    campaign = validate(Campaign, table, faults, _EXTRA_KEYS)
    faults += _run_faults(table)
    faults += campaign_name_faults(original)
    if campaign is None or faults:
        raise as_error(path, faults, original)
    name = campaign.name if "name" in original else path.resolve().parent.name
    radiation = campaign.radiation
    if radiation is not None:
        radiation = replace(radiation, file=str(path.parent / radiation.file))
    return replace(
        campaign, name=name, columns=columns, model_uncertainty=uncertainty, radiation=radiation
    )


def _expand_units(table: dict[str, Any], faults: list[Fault]) -> None:
    """Turn millimetres and degrees of the runs into metres and radians."""
    for array in ("runs", "at_rest"):
        runs = table.get(array)
        for number, run in enumerate(runs if isinstance(runs, list) else []):
            if isinstance(run, dict):
                _expand_units_of(run, (array, number), faults)


def _expand_units_of(run: dict[str, Any], run_place: Place, faults: list[Fault]) -> None:
    for key in [key for key in _UNITS if key in run]:
        value, (si_key, factor) = run.pop(key), _UNITS[key]
        place = (*run_place, key)
        if si_key in run:
            faults.append(Fault(place, f"and {si_key} are both given; one is enough"))
        elif isinstance(value, bool) or not isinstance(value, int | float):
            faults.append(Fault(place, f"= {value!r} should be a number"))
            run[si_key] = 0.0  # so that it is not reported as missing too
        else:
            run[si_key] = value * factor


def _none_for_false(table: dict[str, Any]) -> None:
    for key in _MAY_BE_FALSE:
        value = table.get(key)
        if value is False:
            table[key] = None
        elif isinstance(value, dict):
            table[key] = {part: None if entry is False else entry for part, entry in value.items()}


def _run_faults(table: dict[str, Any]) -> Iterator[Fault]:
    """Yield what is wrong with runs that are right by themselves."""
    oscillator = validate(Oscillator, table.get("oscillator", {}), [])
    yield from attitude_faults(oscillator, table)
    runs = list(_valid(table, "runs", Run))
    rest = list(_valid(table, "at_rest", AtRest))
    records: list[tuple[Place, Run | AtRest]] = [*runs, *rest]
    names: set[str] = set()
    for place, record in records:
        yield from _name_faults(record.name, (*place, "name"), names)
    for place, run in runs:
        yield from _run_kind_faults(run, place)
        run_oscillator = run.recorded_with.oscillator if run.recorded_with is not None else None
        if (rig := run_oscillator or oscillator) is not None:
            yield from _oscillator_faults(rig, run, place)
    zeros = [record.name for _, record in rest if record.kind is RunKind.ZERO]
    for place, record in records:
        yield from _zero_faults(record, place, zeros)
    for place, rest_record in rest:
        yield from _kind_faults(rest_record, place)


def _valid(table: dict[str, Any], array: str, kind: type[T]) -> Iterator[tuple[Place, T]]:
    entries = table.get(array)
    for number, entry in enumerate(entries if isinstance(entries, list) else []):
        item = validate(kind, entry, [])
        if item is not None:
            yield (array, number), item


def _name_faults(name: str, place: Place, names: set[str]) -> Iterator[Fault]:
    if name.casefold() in names:
        yield Fault(place, "is taken already; a recording is named by it")
    fault = no_file_name(name)
    if fault is not None:
        yield Fault(place, f"= {name!r} {fault}")
    names.add(name.casefold())


def _zero_faults(run: Run | AtRest, place: Place, zeros: list[str]) -> Iterator[Fault]:
    for key in ("zero_before", "zero_after"):
        name = getattr(run, key)
        if name is not None and name not in zeros:
            near = get_close_matches(name, zeros, n=1, cutoff=0.5)
            hint = f"did you mean {near[0]!r}?" if near else "list it in [[at_rest]], kind zero"
            yield Fault((*place, key), f"= {name!r} is no zero run of the campaign; {hint}")


def _run_kind_faults(run: Run, place: Place) -> Iterator[Fault]:
    if not run.kind.oscillates:
        yield Fault((*place, "kind"), f"= {run.kind.value!r} is of [[at_rest]]: the shaft stands")
    elif run.kind.in_air and run.medium is not Medium.AIR:
        yield Fault(place, f'needs medium = "air": a run of kind {run.kind} is one in air')


def _kind_faults(record: AtRest, place: Place) -> Iterator[Fault]:
    if record.kind.oscillates:
        yield Fault((*place, "kind"), f"= {record.kind.value!r} is of [[runs]]: the shaft turns")
    if record.kind is RunKind.CIRCLE and not (
        record.turn_rate_rad_s and record.carriage_speed_m_s > 0.0
    ):
        yield Fault(place, "needs carriage_speed_m_s and turn_rate_deg_s for a run of kind circle")
    elif record.turn_rate_rad_s and record.kind is not RunKind.CIRCLE:
        yield Fault((*place, "turn_rate_deg_s"), f"is of no use to a run of kind {record.kind}")
    if record.release_rad and record.kind is not RunKind.FREE_DECAY:
        yield Fault((*place, "release_deg"), f"is of no use to a run of kind {record.kind}")


def _oscillator_faults(oscillator: Oscillator, run: Run, place: Place) -> Iterator[Fault]:
    try:
        check_within(oscillator, run.set_point)
    except ConfigurationError as error:
        yield Fault(place, str(error))
