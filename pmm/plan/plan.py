"""Reading ``plan.toml``: a plan with all its runs, in the order in which they are made."""

import hashlib
from collections import Counter
from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from analysis.water import Water
from hardware.description.errors import ConfigurationError
from pmm.campaign.file_names import campaign_name_faults, no_file_name
from pmm.configuration import Fault, Place, as_error, limit_faults, read_toml_and_bytes, validate
from pmm.plan.expansion import MOST_RUNS, run_count
from pmm.plan.ordering import runs_of
from pmm.plan.plan_rules import (
    channel_faults,
    circle_faults,
    control_faults,
    end_faults,
    entry_faults,
    gate_faults,
    path_faults,
    rig_faults,
)
from pmm.plan.plan_tables import ControlTable, Defaults, PlanEntry, PlanTables
from pmm.plan.plan_units import EXTRA_KEYS, expand_units
from pmm.plan.rig_file import RigFile, RigFileReading, examine_rig
from pmm.plan.run_plan import RunPlan

T = TypeVar("T")
_FEWEST = 8  # samples of a period


@dataclass(frozen=True)
class Plan:
    """A plan, read and expanded.

    Attributes
    ----------
    name
        What the campaign is called; its folder too.
    path, rig_path
        Where the plan and the rig's file lie.
    runs
        In the order in which they are made.
    operator
        Who runs it, for the recordings; empty where the file does not say.
    sha256
        Of the plan's file.
    content
        That file, as it was read; empty for a plan that was not read from one.
    water
        What the tank is filled with; ``None`` where the plan does not say.
    grows
        Whether it changes from run to run.
    """

    name: str
    path: Path
    rig_path: Path
    runs: tuple[RunPlan, ...]
    operator: str
    sha256: str
    content: bytes = b""
    water: Water | None = None
    grows: bool = False


def read_plan(path: str | Path) -> Plan:
    """Read a plan and the rig that it names.

    Raises
    ------
    ConfigurationError
        With every error of both files.
    """
    return read_plan_and_rig(path)[0]


def read_plan_and_rig(path: str | Path) -> tuple[Plan, RigFile]:
    """Read a plan and its rig.

    Raises
    ------
    ConfigurationError
        If a file cannot be read, or for unknown keys (with a suggestion), wrong types, values
        beyond their limits, keys that a kind of run needs or has no use for, motions and channels
        that the rig does not have, and runs of the same name: all errors of both files.
    """
    path = Path(path)
    original, content = read_toml_and_bytes(path)
    reading = examine_plan(original, path)
    faults, tables, rig = list(reading.faults), reading.tables, reading.rig.rig
    runs: tuple[RunPlan, ...] = ()
    if tables is not None and not faults and rig is not None:
        runs = runs_of(tables, rig.oscillator, reading.channels)
        faults += _name_faults(runs)
    errors = [as_error(path, faults, original)] if faults else []
    errors += [reading.rig.error] if reading.rig.error is not None else []
    if errors or tables is None or rig is None:
        raise ConfigurationError("\n".join(map(str, errors)))
    sha256 = hashlib.sha256(content).hexdigest()
    name = tables.name or path.resolve().parent.name
    details = (tables.operator, sha256, content, tables.water, tables.grows)
    return Plan(name, path, reading.rig_path, runs, *details), rig


@dataclass(frozen=True)
class PlanReading:
    """What could be made of a plan's tables and of the rig that they name.

    Attributes
    ----------
    tables
        ``None`` where they have errors that do not let them be had.
    faults
        All errors of the tables; those of the rig's file are the rig's.
    """

    tables: PlanTables | None
    rig_path: Path
    rig: RigFileReading
    faults: tuple[Fault, ...]

    @property
    def channels(self) -> tuple[str, ...]:
        """The rig's force channels, as far as they could be read."""
        return self.rig.channels or ()


def examine_plan(original: dict[str, Any], path: Path) -> PlanReading:
    """Read a plan's tables as far as they go.

    Parameters
    ----------
    original
        Left as it is.
    path
        Of the plan: its rig is named from there.
    """
    table = deepcopy(original)
    faults: list[Fault] = []
    expand_units(table, faults)
    faults += read_recorded(table, path.parent)
    tables = validate(PlanTables, table, faults, EXTRA_KEYS)
    rig_path = _rig_path(path, table)
    rig_reading = examine_rig(rig_path)
    faults += _faults(table, rig_reading)
    if tables is not None and not faults and rig_reading.rig is not None:
        faults += _size_faults(tables, rig_reading.channels or ())
    return PlanReading(tables, rig_path, rig_reading, tuple(faults))


def _rig_path(path: Path, table: dict[str, Any]) -> Path:
    rig = table.get("rig")
    return path.parent / (rig if isinstance(rig, str) else "rig.toml")


def _faults(table: dict[str, Any], rig_reading: RigFileReading) -> Iterator[Fault]:
    """Yield what is wrong with tables that are right key by key; each is looked at by itself."""
    yield from limit_faults(table)
    yield from campaign_name_faults(table)
    runs = table.get("runs")
    if not runs:
        yield Fault((), "the plan has no runs; add a table [[runs]] for each motion")
    defaults = _part(Defaults, table, "defaults") or Defaults()
    for number, run in enumerate(runs if isinstance(runs, list) else []):
        entry = validate(PlanEntry, run, []) if isinstance(run, dict) else None
        if entry is not None:
            yield from _entry_faults(run, entry, defaults, rig_reading, ("runs", number))
    yield from _table_faults(table, rig_reading)


def _entry_faults(
    table: dict[str, Any],
    entry: PlanEntry,
    defaults: Defaults,
    rig_reading: RigFileReading,
    place: Place,
) -> Iterator[Fault]:
    fault = no_file_name(entry.name) if entry.name else None
    if fault is not None:
        yield Fault((*place, "name"), f"= {entry.name!r} {fault}")
    yield from entry_faults(table, entry, place)
    yield from end_faults(entry, defaults, place)
    yield from rig_faults(entry.motion, rig_reading.oscillator, place)
    yield from path_faults(entry, rig_reading.oscillator, place)
    yield from circle_faults(entry, rig_reading.oscillator, place)
    yield from channel_faults(entry, rig_reading.channels, place)
    for key, angles in (("heels_deg", entry.heels_rad), ("releases_deg", entry.releases_rad)):
        if any(angles) and rig_reading.rig is not None and "heel" not in rig_reading.rig.campaign:
            text = "needs [campaign.heel] in the rig's file: how the model is held in roll"
            yield Fault((*place, key), text)


def _table_faults(table: dict[str, Any], rig_reading: RigFileReading) -> Iterator[Fault]:
    """Yield what is wrong with the tables beside the runs."""
    defaults = _part(Defaults, table, "defaults")
    if defaults is not None:
        yield from gate_faults(defaults, ("defaults",))
    control = _part(ControlTable, table, "control")
    if control is not None:
        yield from control_faults(control, ("control",))
        yield from rig_faults(control.motion, rig_reading.oscillator, ("control",))


def _part(kind: type[T], table: dict[str, Any], key: str) -> T | None:
    part = table.get(key)
    return validate(kind, part, []) if isinstance(part, dict) else None


def _size_faults(tables: PlanTables, channels: Sequence[str]) -> Iterator[Fault]:
    """Yield that there are too many runs, before there are."""
    count = sum(run_count(run, tables.defaults, channels) for run in tables.runs)
    if count > MOST_RUNS:
        message = f"asks for {count} runs; the limit is {MOST_RUNS}: make several plans of it"
        yield Fault(("runs",), message)


def _name_faults(runs: tuple[RunPlan, ...]) -> Iterator[Fault]:
    counts = Counter(run.name.casefold() for run in runs)
    for name, count in counts.items():
        if count > 1:
            yield Fault(
                (),
                f"{count} runs would be called {name!r}; a recording is named by its run: give the "
                "entries names of their own, and each value of a list once",
            )


def read_recorded(table: dict[str, Any], folder: Path) -> Iterator[Fault]:
    """Put the samples of each entry's ``recorded`` file in its place; yield what is wrong.

    A file has one number a line, of the struts over one base period, evenly spaced and in any unit;
    what follows a ``#`` is a comment.

    Parameters
    ----------
    folder
        Of the plan: files are named from there.
    """
    runs = table.get("runs")
    for number, run in enumerate(runs if isinstance(runs, list) else []):
        if isinstance(run, dict) and "recorded" in run:
            place: Place = ("runs", number, "recorded")
            try:
                run["recorded"] = _samples(folder / str(run["recorded"]))
            except (OSError, ValueError) as error:
                del run["recorded"]
                yield Fault(place, f": {error}")


def _samples(path: Path) -> list[float]:
    if not path.is_file():
        raise ValueError(f"{path}: no such file; give one number a line, over one base period")
    said = (line.partition("#")[0].strip() for line in path.read_text("utf-8-sig").splitlines())
    values = []
    for number, text in enumerate(said, 1):
        if text:
            try:
                values.append(float(text))
            except ValueError:
                raise ValueError(f"{path}, line {number}: {text!r} is not one number") from None
    if len(values) < _FEWEST or len(set(values)) == 1:
        raise ValueError(
            f"{path}: {len(values)} numbers that do not move; give {_FEWEST} or more over one "
            "period"
        )
    return values
