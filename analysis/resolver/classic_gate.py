"""The gated integration of 1963: m periods between photocell pulses, then hold until reset.

A pulse opens the gate, the m-th after it closes it; the integral of ``y 2 sin(n theta)`` is divided
by the gate's measured time and held. Further pulses are ignored until the reset. The integrator is
a trapezoid from sample to sample, with the product interpolated straight to the pulses: nothing is
solved for and no drift is taken out. What this reading carries (``docs/modes-of-1963.md`` in
figures):

* mean and other harmonics through the gate's edges only;
* a drift of d per period as ``-d / (n pi)`` in phase, whatever m;
* interference at x times the fundamental by the boxcar's sidelobes.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from analysis.resolver.classic import check_harmonics, check_values, products
from analysis.resolver.classic_gate_state import GateReading, GatingState, IntegratorState
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity

SAMPLE_SLACK = 1e-7  # a pulse this near to a sample falls on it: times are rounded
GATE_TOLERANCE = 0.01  # of a revolution: what a gate may miss of m whole ones


@dataclass(frozen=True)
class GatedIntegrator:
    """The apparatus in its mode below 0.5 Hz.

    Attributes
    ----------
    channel_names
        The rows of each block.
    periods
        m: 1 to 4 on the apparatus, any other here.

    Raises
    ------
    ConfigurationError
        If ``periods`` or ``harmonics`` is below 1.
    """

    channel_names: tuple[str, ...]
    sample_rate_hz: float
    periods: int = 1
    harmonics: int = 3

    def __post_init__(self) -> None:
        check_harmonics(self.harmonics)
        if self.periods < 1:
            raise ConfigurationError(f"periods = {self.periods}: a gate needs at least 1")

    def advance(
        self,
        state: IntegratorState,
        values: FloatArray,
        pulses_s: FloatArray,
        cycles: Callable[[FloatArray], FloatArray],
    ) -> IntegratorState:
        """Take a block of samples and the pulses that came with it.

        The reading is the same however a record is cut into blocks.

        Parameters
        ----------
        values
            Shape ``(channels, samples)``, following on the last block's.
        pulses_s
            Times of new pulses, increasing. Those ahead of the samples wait; those before the very
            first sample are ignored.
        cycles
            Revolutions of the shaft at some times.

        Raises
        ------
        DataError
            If pulses do not increase or come later than their samples, or if a period has too few
            samples for the harmonics.
        """
        check_values(values, self.channel_names)
        state = self._queue(state, pulses_s)
        if values.shape[1] == 0:
            return state
        first, inputs = self._joined(state, values, cycles)
        last = first + inputs.shape[-1] - 1
        waiting = state.waiting_pulses_s
        due = [pulse for pulse in waiting if self._number(state, pulse) <= last]
        for pulse_s in due:
            number = self._number(state, pulse_s)
            state = self._pulse(_integrate(state, first, inputs, number), number, pulse_s, cycles)
        return replace(
            _integrate(state, first, inputs, last),
            sample_count=last + 1,
            reached=float(last),
            last=inputs[..., -1],
            waiting_pulses_s=waiting[len(due) :],
        )

    def reset(self, state: IntegratorState) -> IntegratorState:
        """Press the reset button: integrators to zero, the next pulse opens the gate."""
        return replace(state, gate=GatingState.ARMED, reading=None)

    def _number(self, state: IntegratorState, time_s: float) -> float:
        number = (time_s - state.start_s) * self.sample_rate_hz
        nearest = round(number)
        return float(nearest) if abs(number - nearest) <= SAMPLE_SLACK else number

    def _queue(self, state: IntegratorState, pulses_s: FloatArray) -> IntegratorState:
        new = [pulse for pulse in pulses_s if self._number(state, pulse) >= 0.0]
        waiting_s = np.append(state.waiting_pulses_s, new)
        if np.any(np.diff(waiting_s) <= 0.0):
            at = float(waiting_s[1:][np.diff(waiting_s) <= 0.0][0])
            raise DataError(f"the photocell pulse at {at:.6f} s does not come after the last one")
        if waiting_s.size and self._number(state, float(waiting_s[0])) < state.reached:
            raise DataError(
                f"the photocell pulse at {waiting_s[0]:.6f} s came after samples up to "
                f"{state.start_s + state.reached / self.sample_rate_hz:.6f} s; "
                "hand pulses over with their samples or before"
            )
        return replace(state, waiting_pulses_s=tuple(float(pulse) for pulse in waiting_s))

    def _joined(
        self,
        state: IntegratorState,
        values: FloatArray,
        cycles: Callable[[FloatArray], FloatArray],
    ) -> tuple[int, FloatArray]:
        """Products of the block, with the last sample of the one before in front."""
        numbers = np.arange(state.sample_count, state.sample_count + values.shape[1])
        times_s = state.start_s + numbers / self.sample_rate_hz
        inputs = products(values, cycles(times_s), self.harmonics)
        if state.last is None:
            return state.sample_count, inputs
        return state.sample_count - 1, np.concatenate((state.last[..., None], inputs), axis=-1)

    def _pulse(
        self,
        state: IntegratorState,
        number: float,
        pulse_s: float,
        cycles: Callable[[FloatArray], FloatArray],
    ) -> IntegratorState:
        """Let a pulse act on the gate."""
        if state.gate is GatingState.ARMED:
            zero = np.zeros((len(self.channel_names), 2 * self.harmonics))
            return replace(
                state,
                gate=GatingState.OPEN,
                opened_s=pulse_s,
                pulses=0,
                reached=number,
                integral=zero,
            )
        if state.gate is GatingState.HOLD:
            return state
        if state.pulses + 1 < self.periods:
            return replace(state, pulses=state.pulses + 1)
        return replace(state, gate=GatingState.HOLD, reading=self._read(state, pulse_s, cycles))

    def _read(
        self, state: IntegratorState, closed_s: float, cycles: Callable[[FloatArray], FloatArray]
    ) -> GateReading:
        gate_time_s = closed_s - state.opened_s
        samples = gate_time_s * self.sample_rate_hz / self.periods
        if samples <= 2.0 * self.harmonics:
            raise DataError(
                f"{samples:.1f} samples a period cannot carry harmonic {self.harmonics}; more than "
                f"{2 * self.harmonics} are needed: take fewer harmonics or sample faster"
            )
        mean = state.integral / (gate_time_s * self.sample_rate_hz)
        turns = float(np.diff(cycles(np.array([state.opened_s, closed_s])))[0])
        flags = (*self._missing(mean), *self._not_whole(turns))
        return GateReading(
            state.opened_s, closed_s, self.periods, mean[:, 0::2], mean[:, 1::2], flags
        )

    def _missing(self, mean: FloatArray) -> list[Flag]:
        message = "a sample is missing in the gate; reset and measure again"
        return [
            Flag("missing_samples", Severity.VOID, message, channel=name)
            for name, row in zip(self.channel_names, mean, strict=True)
            if not np.isfinite(row).all()
        ]

    def _not_whole(self, turns: float) -> list[Flag]:
        if abs(turns - self.periods) <= GATE_TOLERANCE:
            return []
        message = (
            f"the shaft made {turns:.3f} revolutions while the gate was open, not {self.periods}: "
            "the photocell missed a pulse or gave one too many"
        )
        return [Flag("gate_not_whole", Severity.WARNING, message)]


def _integrate(
    state: IntegratorState, first: int, inputs: FloatArray, number: float
) -> IntegratorState:
    """Carry an open gate's integral on to a fractional sample number."""
    if state.gate is not GatingState.OPEN:
        return state
    pieces = _trapezoids(inputs, state.reached - first, number - first)
    # One after the other, so that the sum does not depend on where blocks are cut.
    total = np.cumsum(np.concatenate((state.integral[..., None], pieces), axis=-1), axis=-1)[
        ..., -1
    ]
    return replace(state, integral=total, reached=number)


def _trapezoids(inputs: FloatArray, low: float, high: float) -> FloatArray:
    """Integrals of straight pieces between fractional sample numbers, shape ``(..., pieces)``."""
    inner = np.arange(np.floor(low) + 1.0, np.ceil(high))
    knots = np.concatenate(([low], inner, [high]))
    cell = np.minimum(knots.astype(np.intp), inputs.shape[-1] - 1)
    following = np.minimum(cell + 1, inputs.shape[-1] - 1)
    at = inputs[..., cell]
    share = knots - cell
    # Only between samples: a missing next sample must not reach a knot that lies on one.
    between = share > 0.0
    at[..., between] += share[between] * (inputs[..., following[between]] - at[..., between])
    return np.asarray(0.5 * (at[..., 1:] + at[..., :-1]) * np.diff(knots))
