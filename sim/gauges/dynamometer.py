"""The dynamometers: readings from the forces in the struts."""

from dataclasses import dataclass, replace
from typing import TypeAlias, TypeVar

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim import signals
from sim.gauges.characteristic import Curve, Loop, LoopState, PowerLoop, follow, limited
from sim.periodic import steady_by_samples
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block

DynamometerState: TypeAlias = tuple[LoopState | None, LoopState | None]
ValuesT = TypeVar("ValuesT", FloatArray, ComplexArray)


@dataclass(frozen=True)
class Dynamometer:
    """One dynamometer: reading = gain * (force + curves - loops) + offset, within its limits.

    Attributes
    ----------
    full_scale_n
        Largest force that it is made for; ``None`` if unknown. Beyond it a run is flagged.
    curvature_1_n
        Quadratic part of the characteristic.
    curves, loops
        Further parts of it, and further loops.
    hysteresis_1_n
        beta of a Rayleigh loop: between the extremes F1 and F2 the reading lags by
        (beta/2) (F2 - F)(F - F1), which is (beta/2) (F_m^2 - F^2) between -F_m and F_m.
    zero_drift_n_s
        Slope of the zero.
    zero_drifted_n
        What it has drifted by before time 0; 0 where the zero is taken then.
    zero_settling_s
        Time constant with which the drift dies out; ``None`` for a straight one.
    lowest_n, highest_n
        Where the reading stops: a mechanical stop, or an amplifier that saturates.
    limit_knee
        How softly; see :func:`sim.gauges.characteristic.limited`.
    """

    gain: float = 1.0
    offset_n: float = 0.0
    full_scale_n: float | None = None
    curvature_1_n: float = 0.0
    hysteresis_1_n: float = 0.0
    zero_drift_n_s: float = 0.0
    zero_drifted_n: float = 0.0
    lowest_n: float | None = None
    highest_n: float | None = None
    limit_knee: float = 0.0
    zero_settling_s: float | None = None
    curves: tuple[Curve, ...] = ()
    loops: tuple[Loop, ...] = ()

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def read(
        self, state: LoopState | None, block: Block, force: FloatArray
    ) -> tuple[LoopState | None, FloatArray]:
        """Return the reading over the block, and what the hysteresis remembers."""
        true = force
        if self.curvature_1_n:
            force = force + self.curvature_1_n * true**2
        for curve in self.curves:
            force = force + curve.added(true)
        if self.remembers and block.count:
            state, branch = follow(state, true)
            for loop in self._all_loops:
                force = force - loop.lag(true, branch)
        reading = self.gain * force + self.offset_n
        if self._drifts:
            reading = reading + (self.zero_drifted_n + self._drift_n(block.time_s))
        if self.lowest_n is not None or self.highest_n is not None:
            reading = limited(reading, self.lowest_n, self.highest_n, self.limit_knee)
        return state, reading

    @property
    def remembers(self) -> bool:
        """Whether the reading depends on forces that were before."""
        return bool(self.hysteresis_1_n or self.loops)

    @property
    def is_straight(self) -> bool:
        """Whether the reading is a line over the force, whatever its size."""
        bent = self.curvature_1_n or self.curves or self.remembers
        return not bent and self.lowest_n is None and self.highest_n is None

    @property
    def _all_loops(self) -> tuple[Loop, ...]:
        loops = (PowerLoop(self.hysteresis_1_n / 2.0, 1.0),) if self.hysteresis_1_n else ()
        return (*loops, *self.loops)

    @property
    def _drifts(self) -> bool:
        return bool(self.zero_drift_n_s or self.zero_drifted_n)

    def without_drift(self) -> "Dynamometer":
        """Return the gauge with a zero that stays where it was taken."""
        return replace(self, zero_drift_n_s=0.0, zero_drifted_n=0.0) if self._drifts else self

    def drifting_from(self, time_s: float) -> "Dynamometer":
        """Return the gauge with a zero that drifts by as much at this time as before at time 0."""
        if not self.zero_drift_n_s:
            return self
        before = float(self._drift_n(np.array(time_s)))
        return replace(self, zero_drifted_n=self.zero_drifted_n - before)

    def _drift_n(self, time_s: FloatArray) -> FloatArray:
        """Return what the zero has drifted by since time 0."""
        settling_s = self.zero_settling_s
        if settling_s is None:
            return self.zero_drift_n_s * time_s
        drift = -self.zero_drift_n_s * settling_s * np.expm1(-time_s / settling_s)
        return np.asarray(drift, dtype=np.float64)


@dataclass(frozen=True)
class Dynamometers:
    """The dynamometer at each strut; its stiffness is that of :class:`sim.model.mounting.Mounting`.

    Attributes
    ----------
    cross_talk_aft, cross_talk_fore
        What the gauge at that strut feels of the other strut's force.
    """

    aft: Dynamometer = Dynamometer()
    fore: Dynamometer = Dynamometer()
    cross_talk_aft: float = 0.0
    cross_talk_fore: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED
    name = "dynamometers"
    reads = (signals.FORCE_AFT, signals.FORCE_FORE)
    writes = (
        signals.DYNAMOMETER_FORCE_AFT,
        signals.DYNAMOMETER_FORCE_FORE,
    )

    def drifting_from(self, time_s: float) -> "Dynamometers":
        """Return the dynamometers with both zeros' clocks begun at this time."""
        aft, fore = self.aft.drifting_from(time_s), self.fore.drifting_from(time_s)
        return replace(self, aft=aft, fore=fore)

    def start(self, sample_rate_hz: float, seed: int) -> DynamometerState:
        """Return the state before the first sample."""
        return (None, None)

    def run(
        self, state: DynamometerState, block: Block, inputs: Signals
    ) -> tuple[DynamometerState, Signals]:
        """Return the readings of both dynamometers over the block."""
        aft, fore = self._with_cross_talk(*(inputs[signal.name] for signal in self.reads))
        aft_state, aft_reading = self.aft.read(state[0], block, aft)
        fore_state, fore_reading = self.fore.read(state[1], block, fore)
        return (aft_state, fore_state), self._by_signal(aft_reading, fore_reading)

    def _with_cross_talk(self, aft: ValuesT, fore: ValuesT) -> tuple[ValuesT, ValuesT]:
        if self.cross_talk_aft or self.cross_talk_fore:
            return aft + self.cross_talk_aft * fore, fore + self.cross_talk_fore * aft
        return aft, fore

    def _by_signal(self, aft: ValuesT, fore: ValuesT) -> dict[str, ValuesT]:
        return {signal.name: value for signal, value in zip(self.writes, (aft, fore), strict=True)}

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the harmonics of the readings; the drift of the zero is left out."""
        if self.aft.is_straight and self.fore.is_straight:
            felt = self._with_cross_talk(*(inputs[signal.name] for signal in self.reads))
            gauges = zip((self.aft, self.fore), felt, strict=True)
            read = (gauge.gain * force + period.constant(gauge.offset_n) for gauge, force in gauges)
            return period, self._by_signal(*read)
        steady = Dynamometers(
            self.aft.without_drift(),
            self.fore.without_drift(),
            self.cross_talk_aft,
            self.cross_talk_fore,
        )
        remembers = self.aft.remembers or self.fore.remembers
        return steady_by_samples(steady, period, inputs, settling=1 if remembers else 0)
