"""The campaign file of what has been run: a folder that ``pmm analyse`` takes as a whole."""

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from hardware.description.body import DIMENSIONS
from hardware.description.channels import Channel
from hardware.description.oscillator import Range
from hardware.description.setpoint import SetPoint
from hardware.roles import Reading
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.plan.sensors import acquisition_table, dynamometers_table
from pmm.toml_text import toml_table, toml_value
from pmm.whole_file import write_whole

_NAME: Final = "campaign.toml"
_WITHIN: Final = 3.0  # standard uncertainties: a reading so near to a limit is that of the limit


@dataclass(frozen=True)
class FinishedRun:
    """A run that was made.

    Attributes
    ----------
    recording
        Its file, seen from the campaign's folder.
    readings
        Where the axes stood: ``"eccentricity"`` in metres and ``"phase"`` in radians, from an
        encoder or a dial.
    outcome
        ``"complete"``, ``"stopped"`` or ``"fault"``.
    channels
        What was recorded; empty where nobody says.
    noise_rms
        Of each channel, in a zero run.
    number
        Its place among the campaign's runs; 0 where nobody says, then the order given is taken.
    differs, recorded_with
        As in :class:`pmm.run.run_origin.RunOrigin`.
    """

    plan: RunPlan
    recording: str
    readings: Mapping[str, Reading] = field(default_factory=lambda: MappingProxyType({}))
    outcome: str = "complete"
    channels: tuple[Channel, ...] = ()
    noise_rms: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))
    number: int = 0
    differs: tuple[str, ...] = ()
    recorded_with: Mapping[str, Any] | None = None


def write_campaign(folder: Path, plan: Plan, rig: RigFile, runs: Sequence[FinishedRun]) -> Path:
    """Write the campaign file of the runs made so far, in their order; the old one is replaced.

    The file is whole at every moment: it is written beside and moved into place.
    """
    target = folder / _NAME
    write_whole(target, "\n".join(_tables(folder, plan, rig, runs)))
    return target


def _tables(folder: Path, plan: Plan, rig: RigFile, runs: Sequence[FinishedRun]) -> Iterator[str]:
    yield f"# Written by pmm run from {plan.path.name} and {rig.path.name}: docs/campaigns.md\n" + (
        f"name = {toml_value(plan.name)}\n"
        + ("" if rig.hardware.photocell else "photocell = false\n")
    )
    yield toml_table("oscillator", asdict(rig.oscillator))
    if rig.model is not None:
        body = {key: value for key, value in asdict(rig.model).items() if key not in DIMENSIONS}
        yield toml_table("model", body)
    if rig.hull is not None:
        yield toml_table("hull", asdict(rig.hull))
    if plan.water is not None:
        depth = None if rig.tank is None else rig.tank.depth_m
        yield toml_table("water", {**asdict(plan.water), "depth_m": depth})
    offset = {key: value for key, value in asdict(rig.reference).items() if value}
    if offset:
        yield toml_table("reference", offset)
    yield from _handed_on(folder, rig, runs)
    names = {run.plan.name for run in runs}
    for place, run in enumerate(runs, 1):
        array = "runs" if run.plan.oscillates else "at_rest"
        keys = _turning(run, rig) if run.plan.oscillates else _resting(run.plan)
        yield toml_table(array, keys | _common(run, names, run.number or place), array=True)


def _handed_on(folder: Path, rig: RigFile, runs: Sequence[FinishedRun]) -> Iterator[str]:
    """Yield what the rig's file hands on, with what the runs tell of sensors and sampling."""
    for name, table in {**rig.campaign, **_recorded_tables(rig, runs)}.items():
        if name == "radiation" and isinstance(table, Mapping) and "file" in table:
            file = os.path.relpath(rig.path.resolve().parent / table["file"], folder.resolve())
            yield toml_table(name, {**table, "file": Path(file).as_posix()})
        elif isinstance(table, Mapping):
            yield toml_table(name, table)
        elif isinstance(table, list):
            yield from (toml_table(name, row, array=True) for row in table)


def _recorded_tables(rig: RigFile, runs: Sequence[FinishedRun]) -> dict[str, Any]:
    simulation = rig.campaign.get("simulation", {})
    tables: dict[str, Any] = {"simulation": {**simulation, "sample_rate_hz": rig.sample_rate_hz}}
    if dynamometers := dynamometers_table(rig):
        tables["dynamometers"] = dynamometers
    recorded = {channel.name: channel for run in runs for channel in run.channels}
    if recorded:
        noise = [run.noise_rms for run in runs if run.noise_rms and run.outcome == "complete"]
        tables["acquisition"] = acquisition_table(rig, tuple(recorded.values()), noise)
    if rig.hardware.photocell is None:
        tables["photocell"] = None
    return tables


def _common(finished_run: FinishedRun, names: set[str], number: int) -> dict[str, Any]:
    """Return what runs and records at rest share; a zero that is not yet made is left out."""
    run = finished_run.plan
    point = run.set_point
    return {
        "kind": run.kind,
        "file": finished_run.recording,
        "carriage_speed_m_s": point.carriage_speed_m_s,
        "medium": point.medium,
        "drift_rad": point.drift_rad,
        **_set_besides(point),
        "repeat": run.repeat,
        "known_mass": None if run.known_mass is None else asdict(run.known_mass),
        "zero_before": run.zero_before if run.zero_before in names else None,
        "zero_after": run.zero_after if run.zero_after in names else None,
        "number": number,
        "outcome": finished_run.outcome,
        "differs": finished_run.differs or None,
        "recorded_with": finished_run.recorded_with,
    }


def _set_besides(point: SetPoint) -> dict[str, Any]:
    """Return what a run has set besides: rudder, propeller, heel, turn, waves, lines."""
    keys = ["rudder_angle_rad", "revolutions_hz", "heel_rad", "turn_rate_rad_s", "release_rad"]
    if point.wave_frequency_hz:
        keys += ["wave_frequency_hz", "wave_amplitude_m", "wave_heading_rad"]
    settings: dict[str, Any] = {key: getattr(point, key) for key in keys}
    settings["steady_ahead"] = point.steady_ahead
    settings["lines"] = [asdict(line) for line in point.lines]
    return {key: value for key, value in settings.items() if value}


def _turning(run: FinishedRun, rig: RigFile) -> dict[str, Any]:
    """Return the set-point as it was measured or read, else as it was planned."""
    point = run.plan.set_point
    keys: dict[str, Any] = {
        "name": run.plan.name,
        "motion": run.plan.motion,
        "frequency_hz": point.frequency_hz,
        "eccentricity_m": point.eccentricity_m,
        "strut_phase_rad": point.strut_phase_rad,
        "periods": run.plan.periods,
    }
    for axis, key in (("eccentricity", "eccentricity_m"), ("phase", "strut_phase_rad")):
        reading = run.readings.get(axis)
        if reading is not None:
            keys[key] = reading.value
            keys[f"u_{key}"] = reading.standard_uncertainty
            if axis == "eccentricity":
                keys[key] = _in_range(reading, rig.oscillator.eccentricity_m)
    return keys


def _in_range(reading: Reading, limits: Range) -> float:
    """Return a reading; at a limit, what its uncertainty puts beyond it is not beyond it."""
    nearest = min(max(reading.value, limits.low), limits.high)
    off = abs(reading.value - nearest)
    return nearest if off <= _WITHIN * reading.standard_uncertainty else reading.value


def _resting(run: RunPlan) -> dict[str, Any]:
    load = None if run.load is None else asdict(run.load)
    return {"name": run.name, "duration_s": run.duration_s, "load": load}
