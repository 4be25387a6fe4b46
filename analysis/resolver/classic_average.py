"""The running average of 1963: needles behind a first-order low-pass.

The product of the signal with ``2 sin(n theta)`` and ``2 cos(n theta)`` goes through
``1 / (1 + tau p)``; what the needles settle to is ``S_n`` and ``C_n``. What this reading carries
(``docs/modes-of-1963.md`` in figures):

* ripple at ``n w`` from the mean, and at ``|k - n| w`` and ``(k + n) w`` from harmonic k (and from
  anything else in the signal);
* 1 % of the step while "settled" lights up, after 4.6 time constants;
* 2.3 times (1.52 squared) the variance of a least-squares fit over those 4.6 time constants, 3.5
  times (1.86 squared) over the 6.9 that settling to 0.1 % takes.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from analysis.resolver.classic import check_frequency, check_harmonics, check_values, products
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import ConfigurationError, DataError

LEAST_TIME_CONSTANT_PERIODS = 1.5
SETTLED_AFTER = 4.6  # time constants: 1 % of the step is left


@dataclass(frozen=True)
class NeedleReadings:
    """Where the needles stand over time.

    Attributes
    ----------
    times_s
        Shape ``(samples,)``.
    in_phase, quadrature
        ``S_n`` and ``C_n`` as they are shown, shape ``(channels, harmonics, samples)``.
    settled
        Whether 4.6 time constants have passed since the start, shape ``(samples,)``.
    """

    times_s: FloatArray
    in_phase: FloatArray
    quadrature: FloatArray
    settled: BoolArray

    def reading(self) -> tuple[FloatArray, FloatArray]:
        """Return the last ``S_n`` and ``C_n``, shapes ``(channels, harmonics)``.

        Raises
        ------
        DataError
            If the needles have not settled by then.
        """
        if not self.settled.any():
            raise DataError(
                f"the needles have not settled after {np.ptp(self.times_s):.3g} s; wait for "
                f"{SETTLED_AFTER} time constants, or take the gated integration"
            )
        return self.in_phase[..., -1], self.quadrature[..., -1]


@dataclass(frozen=True)
class AverageState:
    """What the filters remember between blocks; begin with ``AverageState(start_s)``.

    Attributes
    ----------
    start_s
        Time of the first sample, at which every needle stands at zero.
    sample_count
        Samples taken so far.
    memory
        Of the filters, shape ``(channels, 2 * harmonics, 1)``; ``None`` before the first sample.
    """

    start_s: float
    sample_count: int = 0
    memory: FloatArray | None = None


@dataclass(frozen=True)
class RunningAverage:
    """The apparatus in its mode above 0.5 Hz.

    Attributes
    ----------
    channel_names
        The rows of each block.
    frequency_hz
        Of the oscillation, for the limits; the phase comes with each block.
    time_constant_s
        ``tau``, at least 1.5 periods.

    Raises
    ------
    ConfigurationError
        If the time constant is below 1.5 periods, the sample rate too low for the harmonics, or the
        frequency not above 0.
    """

    channel_names: tuple[str, ...]
    sample_rate_hz: float
    frequency_hz: float
    time_constant_s: float
    harmonics: int = 3

    def __post_init__(self) -> None:
        check_harmonics(self.harmonics)
        check_frequency(self.frequency_hz)
        least = LEAST_TIME_CONSTANT_PERIODS / self.frequency_hz
        if not self.time_constant_s >= least * (1.0 - 1e-12):
            raise ConfigurationError(
                f"time_constant_s = {self.time_constant_s:g} s is below {least:g} s, "
                f"{LEAST_TIME_CONSTANT_PERIODS} periods of {self.frequency_hz:g} Hz; "
                "the needles would not stand still: take a longer one"
            )
        if not self.sample_rate_hz > 2.0 * self.harmonics * self.frequency_hz:
            raise ConfigurationError(
                f"sample_rate_hz = {self.sample_rate_hz:g} cannot carry harmonic {self.harmonics} "
                f"of {self.frequency_hz:g} Hz; it must exceed "
                f"{2.0 * self.harmonics * self.frequency_hz:g} Hz"
            )

    def advance(
        self,
        state: AverageState,
        values: FloatArray,
        cycles: Callable[[FloatArray], FloatArray],
    ) -> tuple[AverageState, NeedleReadings]:
        """Take a block of samples; the needles are the same however a record is cut into blocks.

        The filter is exact for products that run straight from sample to sample.

        Parameters
        ----------
        values
            Shape ``(channels, samples)``, following on the last block's.
        cycles
            Revolutions of the shaft at some times: :meth:`PhaseReference.cycles_at`, for example.

        Raises
        ------
        DataError
            If a sample is missing: the filter would never recover.
        """
        check_values(values, self.channel_names)
        numbers = np.arange(state.sample_count, state.sample_count + values.shape[1])
        times_s = state.start_s + numbers / self.sample_rate_hz
        self._refuse_missing(values, times_s)
        inputs = products(values, cycles(times_s), self.harmonics)
        shown, memory = self._low_pass(inputs, state.memory)
        settled = numbers / self.sample_rate_hz >= SETTLED_AFTER * self.time_constant_s
        needles = NeedleReadings(times_s, shown[:, 0::2], shown[:, 1::2], settled)
        return AverageState(state.start_s, state.sample_count + len(numbers), memory), needles

    def _refuse_missing(self, values: FloatArray, times_s: FloatArray) -> None:
        rows, columns = np.nonzero(~np.isfinite(values))
        if rows.size:
            raise DataError(
                f"{self.channel_names[rows[0]]}: sample at {times_s[columns[0]]:.6g} s is missing; "
                "the running average needs every sample: choose another stretch or mode"
            )

    def _low_pass(
        self, inputs: FloatArray, memory: FloatArray | None
    ) -> tuple[FloatArray, FloatArray | None]:
        from scipy.signal import lfilter

        if inputs.shape[-1] == 0:
            return inputs, memory
        step = 1.0 / (self.sample_rate_hz * self.time_constant_s)
        decay, mean_decay = np.exp(-step), -np.expm1(-step) / step
        newest, last = 1.0 - mean_decay, mean_decay - decay
        if memory is None:
            memory = -newest * inputs[..., :1]  # the needles start from zero
        shown, memory = lfilter([newest, last], [1.0, -decay], inputs, zi=memory)
        return np.asarray(shown), np.asarray(memory)
