"""Where the rig that is simulated is another one than that of ``rig.toml``.

What it takes from the file cannot differ. What ``simulated.toml`` states itself can, on purpose or
not; so it is said before a run, and kept with every recording.
"""

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from hardware.description.simulation_tables import simulation_tables, with_preset
from hardware.simulation_identity import SimulatedTables, simulated_behind
from pmm.configuration import read_toml
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile

CODE: Final = "simulated_differs"
PROVENANCE: Final = "simulated_differs"  # key -> what the file states, what is simulated; as JSON
_QUANTITY: Final = "simulated rig"
_NEEDED: Final = ("model", "hull")  # without them the nominal rig's are simulated
_NEVER: Final = ("effects",)  # of a whole campaign's runs; devices have none


@dataclass(frozen=True)
class Departure:
    """A key in which the simulated rig is not that of the rig's file.

    Attributes
    ----------
    key
        Its path, called as in ``campaign.toml``: ``"model.mass_kg"``.
    stated, simulated
        What ``rig.toml`` has, ``None`` where it does not say; what is simulated.
    message
        Both in words, and what to do.
    """

    key: str
    stated: Any
    simulated: Any
    message: str

    @property
    def contradicts(self) -> bool:
        """Whether the rig's file states something else."""
        return self.stated is not None


def departures(rig: RigFile) -> tuple[Departure, ...]:
    """Return where the simulated rig departs from the rig's file; none for a real rig.

    Raises
    ------
    ConfigurationError
        If the simulated rig's file is wrong.
    """
    simulated = simulated_behind(rig.hardware.bus)
    return () if simulated is None else _departing(rig, simulated)


def _departing(rig: RigFile, simulated: SimulatedTables) -> tuple[Departure, ...]:
    stated = simulation_tables(read_toml(rig.path))
    return tuple(_departures(stated, simulated, rig.path.name))


def departure_findings(plan: Plan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield what a plan's check says of it.

    A simulated rig that cannot be made is refused, and one without waves that are asked of it.
    """
    try:
        simulated = simulated_behind(rig.hardware.bus)
    except ConfigurationError as error:
        yield _refused(f"the simulated rig: {error}")
        return
    if simulated is None:
        return
    rough = [run.name for run in plan.runs if run.set_point.wave_frequency_hz]
    if rough and not simulated.rig.get("waves"):
        file = Path(simulated.file).name
        yield _refused(
            f"no waves are simulated, and {rough[0]} asks for some; say in [campaign.waves] of "
            f"{rig.path.name}, or in [waves] of {file}, what they do to the model",
            rough[0],
        )
    for departure in _departing(rig, simulated):
        verdict = PlanVerdict.WARN if departure.contradicts else PlanVerdict.NOTE
        yield PlanFinding(verdict, _QUANTITY, _number(departure.simulated),
                          _number(departure.stated), "", departure.message)  # fmt: skip


def _refused(text: str, run: str = "") -> PlanFinding:
    return PlanFinding(PlanVerdict.REFUSE, _QUANTITY, math.nan, math.nan, run, text)


def departure_flag(departures: tuple[Departure, ...]) -> Iterator[Flag]:
    """Yield the flag that a recording gets; nothing where the rig is that of its file."""
    if departures:
        severity = (
            Severity.WARNING
            if any(departure.contradicts for departure in departures)
            else Severity.NOTE
        )
        yield Flag(CODE, severity, "; ".join(departure.message for departure in departures))


def provenance_of_departures(departures: tuple[Departure, ...]) -> dict[str, str]:
    """Return what a recording's provenance keeps of it."""
    rows = {
        departure.key: {"stated": departure.stated, "simulated": departure.simulated}
        for departure in departures
    }
    return {PROVENANCE: json.dumps(rows)} if rows else {}


def _departures(
    stated: Mapping[str, Any], simulated: SimulatedTables, name: str
) -> Iterator[Departure]:
    file = Path(simulated.file).name
    own_tables = dict(simulated.file_tables)
    if "oscillator" in own_tables:
        own_tables["oscillator"] = with_preset(own_tables["oscillator"])
    for key, value in _leaves(stated):
        if key.partition(".")[0] in simulated.rig and not _agree(value, _at(simulated.rig, key)):
            simulated_value = _at(simulated.rig, key)
            text = (
                f"{key} = {_text(simulated_value)} is simulated, {name} states {_text(value)}; "
                f"take it out of {file} unless it is meant"
            )
            yield Departure(key, value, simulated_value, text)
    said = {key for key, _ in _leaves(stated)}
    for key, value in _leaves(own_tables):
        if key not in said:
            text = f"{key} = {_text(value)} is simulated as {file} states; {name} has no such key"
            yield Departure(key, None, value, text)
    yield from _unstated(stated, own_tables, name)


def _unstated(
    stated: Mapping[str, Any], own_tables: Mapping[str, Any], name: str
) -> Iterator[Departure]:
    for table in _NEEDED:
        if table not in stated and table not in own_tables:
            text = f"{name} has no [{table}]: that of a nominal model of 2.5 m is simulated"
            yield Departure(table, None, "nominal", text)
    for table in _NEVER:
        if table in stated:
            text = f"{name}: campaign.{table} are not simulated on devices; pmm simulate does"
            yield Departure(table, stated[table], None, text)


def _leaves(table: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the keys that hold values, with their paths; lists are values."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value


def _at(table: Mapping[str, Any], path: str) -> Any:
    value: Any = table
    for key in path.split("."):
        value = value.get(key) if isinstance(value, Mapping) else None
    return value


def _agree(stated: Any, simulated: Any) -> bool:
    """Whether all that is stated is simulated; ``false`` says that there is no such thing."""
    if isinstance(stated, Mapping):
        return isinstance(simulated, Mapping) and all(
            _agree(value, simulated.get(key)) for key, value in stated.items()
        )
    if isinstance(stated, list | tuple):
        return (
            isinstance(simulated, list | tuple)
            and len(stated) == len(simulated)
            and all(map(_agree, stated, simulated))
        )
    return bool(stated == simulated) or (stated is False and simulated is None)


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else json.dumps(value, default=str)


def _number(value: Any) -> float:
    return float(value) if isinstance(value, int | float) else float("nan")
