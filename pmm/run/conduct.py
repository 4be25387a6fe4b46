"""What run control acts on: the rig, the present run, and where it stands."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from hardware.demand import Demand
from hardware.description.carriage_path import CarriagePath
from hardware.description.kinds import RunKind
from hardware.description.setpoint import ANGLE_KEYS
from hardware.errors import NotAtRestError
from hardware.limits import (
    CARRIAGE_S,
    CARRIAGE_SHARE,
    FREQUENCY_S,
    FREQUENCY_SHARE,
    RAMP_MARGIN,
    RESTLESS_S,
    SHAFT_REST_SHARE,
)
from hardware.rig import Rig
from hardware.rig_configuration import RigPart
from hardware.roles import PositionAxis
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.live_path import LivePath
from pmm.recorder.run_recorder import RunEnd
from pmm.run.errors import CarriageOffSpeedError, FrequencyError
from pmm.run.measurement import Measurement
from pmm.run.questions import Questions
from pmm.run.states import RunStateMachine, State
from pmm.run.surroundings import Surroundings

Begin = Callable[[RunPlan], Measurement]
_UNKNOWN_RAMP_S: Final = 60.0  # of a shaft that states no acceleration
_UNDISPLACED: Final = frozenset(
    {RunKind.ZERO, RunKind.FREE_DECAY, *(kind for kind in RunKind if kind.towed)}
)


@dataclass
class Conduct:
    """The run that is being carried out.

    Attributes
    ----------
    begin
        Opens the recorder of a run.
    waits
        Whether the loop may wait for the disk: on a rig whose time is counted in cycles.
    since
        Cycle in which the present state was entered.
    rested_since
        Cycle since which shaft and carriage have been at rest: calm water is counted from there.
        ``None`` in a run that moves them, and before the first one.
    command_given
        Whether the present state has given its command.
    placed
        Where each axis was last sent.
    towed
        Whether the carriage has been told the run's speed.
    speed_path
        What the carriage's speed follows; ``None`` where it is steady.
    leads
        Whether it is led along it, since the shaft has been told to turn.
    restless, astray, off_speed
        For how many cycles the shaft has moved where it has to stand, or turned at a frequency that
        is not the run's, or the carriage has run at another speed.
    path
        What brings samples and pulses; a recording begins with a new one, as its replay does.
    pushed
        How far a push test has come: 0 nobody pushes, 1 pushed, 2 let go.
    ending
        How the run ends once it is at rest.
    leaves_plan
        Whether no other run follows it: somebody stopped.
    """

    rig: Rig
    rig_file: RigFile
    begin: Begin
    waits: bool
    run: RunPlan | None = None
    measurement: Measurement | None = None
    surroundings: Surroundings = field(default_factory=Surroundings)
    since: int = 0
    rested_since: int | None = None
    command_given: bool = False
    pushed: int = 0
    restless: int = 0
    astray: int = 0
    off_speed: int = 0
    towed: bool = False
    leads: bool = False
    speed_path: CarriagePath | None = None
    ending: RunEnd = RunEnd.COMPLETE
    leaves_plan: bool = False
    placed: dict[str, float] = field(default_factory=dict)
    machine: RunStateMachine = field(default_factory=RunStateMachine)
    questions: Questions = field(init=False)
    path: LivePath = field(init=False)

    def __post_init__(self) -> None:
        self.questions = Questions(self.rig.prompt, self._answered)
        self.path = LivePath(self.rig)

    def take(self, run: RunPlan) -> None:
        """Make a run the present one; nothing of the run before is left."""
        self.run, self.pushed, self.towed, self.leads = run, 0, False, False
        self.speed_path = CarriagePath.of(self.rig_file.oscillator, run.set_point)
        self.ending, self.leaves_plan = RunEnd.COMPLETE, False

    def go(self, state: State) -> None:
        """Enter a state in the present cycle; raises as the state machine does."""
        self.machine.go(state)
        self.since, self.command_given = self.rig.number, False

    @property
    def state(self) -> State:
        """Where run control stands."""
        return self.machine.state

    @property
    def present(self) -> RunPlan:
        """The run that is being carried out."""
        if self.run is None:
            raise AssertionError("a phase of a run without a run")
        return self.run

    @property
    def recording(self) -> Measurement:
        """The measurement that is under way."""
        if self.measurement is None:
            raise AssertionError("a phase that records without a recording")
        return self.measurement

    @property
    def rate_hz(self) -> float:
        """Cycles per second."""
        return self.rig.configuration.sample_rate_hz

    @property
    def elapsed_s(self) -> float:
        """Time in the present state, counted in cycles."""
        return (self.rig.number - self.since) / self.rate_hz

    def carriage_speed_m_s(self, ahead_s: float = 0.0) -> float:
        """Return the speed that the carriage is to have so much later, by the master angle."""
        if self.speed_path is None or self.rig.path is None:
            return self.present.set_point.carriage_speed_m_s
        angle = self.rig.path.angle_at(self.rig.number)
        return self.speed_path.at(angle + self.speed_path.omega_rad_s * ahead_s)

    @property
    def moving(self) -> bool:
        """Whether any axis moves."""
        return any(axis.moving for axis in self.rig.powered())

    @property
    def ramp_s(self) -> float:
        """Longest time that a profile stop may take, from shaft's and carriage's own settings."""
        devices = self.rig.configuration
        highest_hz = self.rig_file.oscillator.frequency_hz.high
        shaft_s = _ramp_s(devices.shaft, highest_hz, "acceleration_hz_per_s")
        carriage = devices.carriage
        if carriage is None:
            return shaft_s
        highest = getattr(carriage.settings, "highest_speed_m_s", math.inf)
        return max(shaft_s, _ramp_s(carriage, highest, "acceleration_m_s2"))

    def axes(self) -> tuple[tuple[PositionAxis, float], ...]:
        """Return the axes with where the run wants them.

        What is to read the gauges without the restoring force stands at eccentricity 0; for other
        runs at rest it does not matter where the struts are.
        """
        point = self.present.set_point
        angles = tuple(
            (axis, float(getattr(point, ANGLE_KEYS[name])))
            for name, axis in self.rig.angles.items()
        )
        if not self.present.oscillates:
            axis = self.rig.eccentricity
            wanted = self.present.kind in _UNDISPLACED and axis is not None and 0.0 in axis.limits
            return (*angles, *(((axis, 0.0),) if wanted and axis is not None else ()))
        pairs = (
            (self.rig.eccentricity, point.eccentricity_m),
            (self.rig.phase, point.strut_phase_rad),
        )
        return (*angles, *((axis, wanted) for axis, wanted in pairs if axis is not None))

    def _answered(self, demand: Demand, answer: str) -> None:
        if self.measurement is not None:
            self.measurement.event("operator", f"{demand} -> {answer or 'done'}")


def check_frequency(c: Conduct) -> None:
    """Compare the frequency by the encoder, and that by the gate's pulses, with the run's.

    Raises
    ------
    FrequencyError
        If one is further off than the tolerance for longer than its time.
    """
    shaft, wanted_hz = c.rig.shaft, c.present.set_point.frequency_hz
    if shaft is None or not c.present.oscillates:
        return
    allowed_hz = FREQUENCY_SHARE * wanted_hz + SHAFT_REST_SHARE * shaft.frequency_hz.high
    gate = c.recording.gate
    by_pulses = gate.periods / (gate.last_s - gate.opened_s) if gate.periods else math.nan
    off = [
        (measured_hz, by)
        for measured_hz, by in ((shaft.measured_frequency_hz, "encoder"), (by_pulses, "photocell"))
        if abs(measured_hz - wanted_hz) > allowed_hz
    ]
    c.astray = c.astray + 1 if off else 0
    if c.astray > FREQUENCY_S * c.rate_hz:
        measured_hz, by = off[0]
        raise FrequencyError(
            shaft.name,
            f"turns at {measured_hz:.4g} Hz by its {by} where the run wants {wanted_hz:g} Hz "
            f"(limit {allowed_hz:.2g} Hz off); check the drive, and counts_per_turn",
        )


def check_speed(c: Conduct) -> None:
    """Compare the carriage's speed, and on a circle its rate of turn, with the run's.

    Raises
    ------
    CarriageOffSpeedError
        If it is further off than allowed for longer than its time.
    """
    carriage, point = c.rig.carriage, c.present.set_point
    if carriage is None:
        return
    speed, rate = c.carriage_speed_m_s(), point.turn_rate_rad_s
    of_speed = CARRIAGE_SHARE * speed + carriage.tolerance_m_s
    checks = [(carriage.measured_speed_m_s, speed, of_speed, "runs", "m/s")]
    if rate:  # as far off as the speed may be where the radius is right
        turned, allowed = carriage.measured_turn_rate_rad_s, abs(rate) * of_speed / speed
        checks.append((turned, rate, allowed, "turns", "rad/s"))
    off = [check for check in checks if not abs(check[0] - check[1]) <= check[2]]
    c.off_speed = c.off_speed + 1 if off else 0
    if c.off_speed > CARRIAGE_S * c.rate_hz:
        measured, wanted, allowed, does, unit = off[0]
        raise CarriageOffSpeedError(
            carriage.name,
            f"{does} at {measured:.4g} {unit} where the run wants {wanted:.4g} {unit} (limit "
            f"{allowed:.2g} {unit} off); look at its drive and rails, then tow again",
        )


def lead_carriage(c: Conduct) -> None:
    """Tell a carriage that follows a path the speed that it is to have by when it is there."""
    part, follower = c.rig.configuration.carriage, c.rig.follower
    if c.leads and part is not None and follower is not None:
        follower.lead(c.carriage_speed_m_s(getattr(part.settings, "lag_s", 0.0)))


def check_standing(c: Conduct, ramp_s: float = 0.0) -> None:
    """Look whether the shaft stands, as it has to while axes are homed and set and water calms.

    One that is not heard is a fault of its own; a hand-set one is asked for first.

    Parameters
    ----------
    ramp_s
        For a shaft that may turn when it is enabled: it runs down first.

    Raises
    ------
    NotAtRestError
        If it has been seen to turn for longer than a drive takes to hold it.
    """
    shaft, allowed_s = c.rig.shaft, RESTLESS_S + ramp_s
    turns = shaft is not None and shaft.moving and not math.isnan(shaft.measured_frequency_hz)
    c.restless = c.restless + 1 if turns else 0
    if shaft is not None and c.restless > allowed_s * c.rate_hz:
        raise NotAtRestError(
            shaft.name,
            f"moves for {allowed_s:g} s ({shaft.measured_frequency_hz:.3g} Hz) though nothing "
            "told it to; look at it, and use the emergency stop if it turns",
        )


def _ramp_s(part: RigPart | None, highest: float, key: str) -> float:
    """Return the longest time of a ramp by a device's settings."""
    acceleration = getattr(part.settings, key, None) if part else None
    return RAMP_MARGIN * highest / acceleration if acceleration else _UNKNOWN_RAMP_S
