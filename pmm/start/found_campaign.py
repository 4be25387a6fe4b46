"""What is found in the recordings of another system, as the campaign's file will have it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from hardware.description.channels import (
    CARRIAGE_SPEED,
    COMMANDS,
    DISPLACEMENTS,
    FORCE_X,
    FORCES,
    HEELING,
    POSITIONS,
    SHAFT_ANGLE,
    STEERING,
)
from hardware.description.setpoint import Medium
from hardware.description.units import unit

PHOTOCELL: Final = "photocell"
ON_MODEL: Final = (*(channel.name for channel in (*STEERING, *HEELING)), *POSITIONS)
"""What the model has of its own: the simulation needs to be told of it."""
CHANNELS: Final = (
    *FORCES, FORCE_X.name, *DISPLACEMENTS, SHAFT_ANGLE.name, CARRIAGE_SPEED.name, *COMMANDS,
    *ON_MODEL, PHOTOCELL,
)  # fmt: skip


@dataclass(frozen=True)
class FoundColumn:
    """A channel of the campaign and the column that it is taken from.

    Attributes
    ----------
    source
        The column and, after a colon, its unit, as TOML has it.
    remark
        What to look at.
    doubt
        Why it may be another one; the channel is then commented out. Empty where it is sure.
    """

    name: str
    column: str
    unit: str = ""
    remark: str = ""
    doubt: str = ""

    @property
    def factor(self) -> float:
        """What turns the numbers that were looked at into SI."""
        return unit(self.unit).factor if self.unit else 1.0

    @property
    def source(self) -> str | Mapping[str, str]:
        """What a column map says: the short form where the name allows it."""
        if ":" in self.column or self.column.startswith("-"):
            return {"column": self.column} | ({"unit": self.unit} if self.unit else {})
        return f"{self.column}:{self.unit}" if self.unit else self.column


@dataclass(frozen=True)
class FoundRun:
    """A recording as a run; remarks say where a number was not found, ``doubt`` why it is none."""

    name: str
    file: str
    frequency_hz: float
    eccentricity_mm: float
    strut_phase_deg: float
    carriage_speed_m_s: float
    medium: str = Medium.WATER
    remarks: Mapping[str, str] = field(default_factory=dict)
    doubt: str = ""


@dataclass(frozen=True)
class FoundRest:
    """A recording of a rig that stands."""

    name: str
    file: str
    kind: str
    duration_s: float
    carriage_speed_m_s: float
    doubt: str = ""


@dataclass(frozen=True)
class FoundCampaign:
    """What all recordings together tell.

    Attributes
    ----------
    columns
        Channels of the rig, sure or not, and columns that keep their names.
    other_columns
        Names of columns that are not taken.
    by_order
        Whether nothing but the order of the names says which strut is aft.
    mapped
        Whether there is a column map: recordings of the product's own say their channels.
    reference
        A column that tells the phase where no channel of the rig does.
    sensors
        By channel, what ``[acquisition]`` can say.
    not_recorded
        Channels that are taken for recorded where nothing is said.
    photocell
        Whether there are pulses.
    edges_file
        How the files of their times are called that lie beside the recordings; empty without.
    """

    runs: tuple[FoundRun, ...] = ()
    at_rest: tuple[FoundRest, ...] = ()
    columns: tuple[FoundColumn, ...] = ()
    other_columns: tuple[str, ...] = ()
    by_order: bool = False
    mapped: bool = True
    reference: str = ""
    sample_rate_hz: float = 0.0
    sensors: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    not_recorded: tuple[str, ...] = ()
    photocell: bool = False
    edges_file: str = ""

    def notes(self) -> Iterator[str]:
        """Yield what is not sure and what was not found, a line each."""
        for column in self.columns:
            if column.doubt:
                yield f"not sure, commented out: {column.name} = {column.column!r}: {column.doubt}"
        doubts = {run.name: run.doubt for run in self.runs}
        doubts |= {rest.name: rest.doubt for rest in self.at_rest}
        for name, doubt in doubts.items():
            if doubt:
                yield f"not sure, commented out: {name}: {doubt}"
        for key in dict.fromkeys(key for run in self.runs for key in run.remarks):
            missing = sum(key in run.remarks for run in self.runs)
            yield f"not in the recordings, put it in: {key} of {missing} of {len(self.runs)} runs"
