"""One run of a plan, with all defaults resolved."""

import json
from dataclasses import asdict, dataclass
from pathlib import Path

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.kinds import Motion, RunKind
from hardware.description.known_loads import KnownMass, LoadStep
from hardware.description.setpoint import SetPoint
from pmm.configuration import STRICT_TABLE, Fault, as_error, validate


@dataclass(frozen=True, slots=True)
class RunPlan:
    """One run.

    Attributes
    ----------
    name
        Unique within the plan; the run's folder and recording are named by it.
    kind, motion
        What the run is for, and how the model moves.
    set_point
        Frequency (0 for a run at rest), eccentricity (**amplitude** of each strut, half its
        stroke), strut phase, carriage speed, medium and drift angle.
    periods
        Periods of the gate; 0 for a run at rest. With a target, the fewest.
    settling_periods
        Periods after the run-up and before the gate may open.
    duration_s
        How long a run at rest is recorded; 0 for an oscillation.
    pause_before_s
        Wait for calm water before the run.
    repeat
        Which repeat of its condition this is, from 1.
    target_relative
        Stop when the 95 % half-width of the first harmonic of every force channel is below this
        part of its size; ``None`` to run the periods that are planned.
    max_periods
        Where a run with a target ends at the latest; equals ``periods`` without one.
    load, known_mass
        Of check weights and pushes, and of the run with a known mass.
    prompts
        What the operator is told and confirms before the run, besides what the settings say by
        themselves (medium, drift, load, mass).
    zero_before, zero_after
        Names of the runs that tell the gauges' zero before and after; empty where there is none.
    entry
        Name of the plan's entry that the run comes from.
    changed
        What an operator changed of it in the queue, in words; empty where nothing. Such a run is
        as it was decided then, whatever the plan's file says.
    """

    name: str
    kind: RunKind
    motion: Motion
    set_point: SetPoint
    periods: int = 0
    settling_periods: int = 0
    duration_s: float = 0.0
    pause_before_s: float = 0.0
    repeat: int = 1
    target_relative: float | None = None
    max_periods: int = 0
    load: LoadStep | None = None
    known_mass: KnownMass | None = None
    prompts: tuple[str, ...] = ()
    zero_before: str = ""
    zero_after: str = ""
    entry: str = ""
    changed: tuple[str, ...] = ()

    __pydantic_config__ = STRICT_TABLE

    @property
    def oscillates(self) -> bool:
        """Whether the shaft turns in this run."""
        return self.set_point.frequency_hz > 0.0

    @property
    def measured_s(self) -> float:
        """Longest time that is measured, in seconds: the periods at most, or the duration."""
        if not self.oscillates:
            return self.duration_s
        return self.max_periods / self.set_point.frequency_hz

    @property
    def moving_s(self) -> float:
        """Longest time at speed: settling, one period to find the pulse, and what is measured."""
        if not self.oscillates:
            return self.duration_s
        return self.measured_s + (self.settling_periods + 1) / self.set_point.frequency_hz

    def to_json(self) -> str:
        """Return the run as a JSON document, to be kept with its recording."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str, where: str) -> "RunPlan":
        """Return the run that a document holds.

        Raises
        ------
        DataError
            If it is none; the message names ``where``.
        """
        faults: list[Fault] = []
        try:
            run = validate(cls, json.loads(text), faults)
        except (ValueError, TypeError, ConfigurationError) as error:
            raise DataError(f"{where}: damaged plan of the run: {error!r}") from error
        if run is None:
            raise DataError(str(as_error(Path(where), faults, {})))
        return run
