"""The simulator's chain behind the devices: computed ahead in blocks, taken back on a command.

A chain's state is a value. So the plant keeps the state before the present block, and when a
command comes in the middle of it, the block's first part is run again to have the state at that
sample; from there the changed chain goes on. A run in which nothing changes costs next to nothing
a sample.
"""

import math
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from hardware.description.lines import Line
from hardware.description.setpoint import Medium, SetPoint
from sim import signals
from sim.chain import Chain, ChainState
from sim.devices.profile import Friction, SpeedProfile, following
from sim.rig import SimulatedRig
from sim.signals import Signals

if TYPE_CHECKING:
    from hardware.description.arrays import FloatArray

_LARGEST_BLOCK: Final = 256
# A shaft at 1 Hz coasts for 2.8 s and 1.1 turns, as one with a flywheel's inertia in its bearings.
SHAFT_FRICTION: Final = Friction(time_constant_s=2.0, deceleration=1.0)


@dataclass(frozen=True)
class PlantConditions:
    """Conditions outside the rig: carriage, medium, seed of all noise, and what people set."""

    carriage_speed_m_s: float = 0.0
    medium: Medium = Medium.WATER
    seed: int = 1
    drift_rad: float = 0.0
    rudder_angle_rad: float = 0.0
    revolutions_hz: float = 0.0
    heel_rad: float = 0.0
    lines: tuple[Line, ...] = ()
    turn_rate_rad_s: float = 0.0
    release_rad: float = 0.0
    wave_frequency_hz: float = 0.0
    wave_amplitude_m: float = 0.0
    wave_heading_rad: float = math.pi


@dataclass(frozen=True)
class Passage:
    """A pulse of the photocell: when, and at which shaft angle."""

    time_s: float
    angle_rad: float


@dataclass(frozen=True)
class _Stretch:
    """A block: the state before and after it, its signals as lists, pulses due before it."""

    chain: Chain
    before: ChainState
    after: ChainState
    columns: dict[str, list[float]]
    carried: tuple[float, ...]

    @property
    def first(self) -> int:
        return self.before.next_sample

    @property
    def end(self) -> int:
        return self.after.next_sample


class Plant:
    """Oscillator, model, water and sensors, sample by sample.

    Attributes
    ----------
    number
        The present sample; it comes ``number / sample_rate_hz`` after the start.
    profile
        What the shaft's drive is told.
    blocks
        How many blocks have been computed, for tests and measurements.
    """

    def __init__(
        self,
        rig: SimulatedRig,
        around: PlantConditions,
        sample_rate_hz: float,
        eccentricity_m: float = 0.0,
        strut_phase_rad: float = 0.0,
    ) -> None:
        self.number = 0
        self.sample_rate_hz = sample_rate_hz
        self.profile = SpeedProfile()
        self.blocks = 0
        self._rig, self._around = rig, around
        self._body = rig.body
        self._linkage = (eccentricity_m, strut_phase_rad)
        self._size, self._changed = 1, False
        chain = self._chain()
        self._due: tuple[float, ...] = ()
        self._led: dict[str, FloatArray] = {}
        self._angle_and_speed_before = (0.0, 0.0)
        self._stretch = self._run(chain, chain.start(sample_rate_hz, around.seed), 1)

    @property
    def time_s(self) -> float:
        """Time of the present sample."""
        return self.number / self.sample_rate_hz

    @property
    def angle_rad(self) -> float:
        """The shaft's true angle now."""
        return self.value(signals.SHAFT_ANGLE.name)

    @property
    def speed_rad_s(self) -> float:
        """The shaft's true speed now."""
        return self.value(signals.SHAFT_SPEED.name)

    def value(self, name: str) -> float:
        """Return a sampled signal now."""
        return self._stretch.columns[name][self.number - self._stretch.before.next_sample]

    def knows(self, name: str) -> bool:
        """Tell whether the chain has such a sampled signal."""
        return name in self._stretch.columns

    @property
    def recorded(self) -> list[str]:
        """Names of the recorded channels."""
        names = (column for column in self._stretch.columns if column.startswith("recorded_"))
        return [name.removeprefix("recorded_") for name in names]

    def turn(self, target_rad_s: float, acceleration_rad_s2: float) -> None:
        """Command a speed: from the present sample on."""
        self.profile = self.profile.then(self.time_s, target_rad_s, acceleration_rad_s2)
        self._changed = True

    def coast(self) -> None:
        """Take the torque off the shaft: from the present sample on."""
        self.profile = self.profile.without_torque(self.time_s, SHAFT_FRICTION)
        self._changed = True

    def set_linkage(
        self, eccentricity_m: float | None = None, strut_phase_rad: float | None = None
    ) -> None:
        """Set eccentricity or phase; the mechanism has it from the next sample on."""
        before, (e, phase) = self._linkage, self._linkage
        self._linkage = (
            e if eccentricity_m is None else eccentricity_m,
            phase if strut_phase_rad is None else strut_phase_rad,
        )
        self._changed = self._changed or self._linkage != before

    @property
    def linkage(self) -> tuple[float, float]:
        """Eccentricity in metres and strut phase in radians, as they are set."""
        return self._linkage

    def lead(self, strut: int, motion: tuple[float, float, float]) -> None:
        """Have a drive of its own move a strut (0 aft, 1 fore): the next sample's motion.

        It is displacement, velocity and acceleration. From the first call on the shaft and its
        linkage move nothing.
        """
        names = (signal.name for signal in signals.STRUT_MOTIONS[strut])
        self._led |= {name: np.array([value]) for name, value in zip(names, motion, strict=True)}

    @property
    def conditions(self) -> PlantConditions:
        """The conditions outside the rig that hold now."""
        return self._around

    def surround(self, **changes: Any) -> None:
        """Change what is given of the :class:`PlantConditions`, from the next sample on."""
        before = self._around
        self._around = replace(before, **changes)
        self._changed = self._changed or self._around != before

    def load(self, mass_kg: float, at_m: float = 0.0) -> None:
        """Let the model carry a small mass on its midline besides its own; 0 takes it off."""
        bare_body = self._body
        total = bare_body.mass_kg + mass_kg
        body = replace(
            bare_body,
            mass_kg=total,
            inertia_kg_m2=bare_body.inertia_kg_m2 + mass_kg * at_m**2,
            cg_x_m=(bare_body.mass_kg * bare_body.cg_x_m + mass_kg * at_m) / total,
            cg_z_m=bare_body.mass_kg * bare_body.cg_z_m / total,
        )
        self._changed = self._changed or body != self._rig.body
        self._rig = replace(self._rig, body=body)

    def advance(self) -> None:
        """Go on to the next sample."""
        self._angle_and_speed_before = self.angle_rad, self.speed_rad_s
        if self._changed:
            state = self._state_after_present()
            self._changed, self._size = False, 1
            self._stretch = self._run(self._chain(), state, 1)
        elif self.number + 1 == self._stretch.end:
            self._size = 1 if self._led else min(2 * self._size, _LARGEST_BLOCK)
            self._stretch = self._run(self._stretch.chain, self._stretch.after, self._size)
        self.number += 1

    def passed(self) -> tuple[Passage, ...]:
        """Return the photocell's pulses up to the present sample that were not returned yet."""
        if not self._due or self._due[0] > self.time_s:
            return ()
        now = tuple(edge for edge in self._due if edge <= self.time_s)
        self._due = self._due[len(now) :]
        return tuple(Passage(edge, self._angle_at(edge)) for edge in now)

    def _angle_at(self, time_s: float) -> float:
        """Return the shaft angle shortly before the present sample, from both samples around."""
        since = time_s - self.time_s
        speed = self.speed_rad_s
        slope = (speed - self._angle_and_speed_before[1]) * self.sample_rate_hz
        return self.angle_rad + (speed + slope / 2.0 * since) * since

    def _chain(self) -> Chain:
        """Return the rig's chain as it is set now; the profile says how fast, not the set-point."""
        eccentricity, phase = self._linkage
        rig = replace(self._rig, drive=following(self._rig.drive, self.profile))
        around = self._around
        orders = SetPoint(0.0, 0.0, lines=around.lines).own_orders
        any_hz = self._rig.oscillator.frequency_hz.high / max(orders, default=1)
        names = (field.name for field in fields(around) if field.name != "seed")
        conditions = {name: getattr(around, name) for name in names}
        return rig.chain(SetPoint(any_hz, eccentricity, phase, **conditions))

    def _run(self, chain: Chain, state: ChainState, count: int) -> _Stretch:
        carried = self._due
        after, run = chain.run(state, count, self._led)
        self.blocks += 1
        self._due = carried + _edges(run)
        columns = {
            signal.name: run[signal.name].tolist() for signal in chain.signals if signal.sampled
        }
        return _Stretch(chain, state, after, columns, carried)

    def _state_after_present(self) -> ChainState:
        """Return the state after the present sample, and forget what lies beyond it."""
        stretch = self._stretch
        if self.number + 1 == stretch.end:
            return stretch.after
        after, run = stretch.chain.run(stretch.before, self.number + 1 - stretch.first)
        passages = stretch.carried + _edges(run)
        self._due = tuple(edge for edge in passages if edge > self.time_s)
        return after


def _edges(run: Signals) -> tuple[float, ...]:
    edges = run.get(signals.PHOTOCELL_EDGE_TIME.name)
    return () if edges is None else tuple(edges.tolist())
