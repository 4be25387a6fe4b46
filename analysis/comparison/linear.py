"""The model of a second channel and its derivatives by gain, lag, clock rate and dead band."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.comparison.band import BandTrack
from analysis.comparison.first_guess import Alignment
from analysis.comparison.warp import Play, Warped, follow
from hardware.description.arrays import BoolArray, ComplexArray, FloatArray

_TAPER: Final = 0.1  # of the record, both ends together
_FIRST: Final = 3  # bins: below, what is seen is a drift
_A_PERIOD: Final = 200.0  # steps in which a dead band is followed: 1e-4 of the amplitude


@dataclass(frozen=True)
class ComparisonProblem:
    """Two channels as they are compared.

    Attributes
    ----------
    first
        The first channel and those with a lever; rows 0 and 1 are what the second one shows, and
        its derivative.
    low_hz, top_hz
        Frequencies that count.
    """

    first: Warped
    channels: int
    second: BandTrack
    motion_hz: float
    low_hz: float
    top_hz: float


@dataclass(frozen=True)
class Model:
    """Parameters: where the clocks stand, a gain of each channel, half the dead band or ``None``.

    ``half`` is in the first channel's unit.
    """

    alignment: Alignment
    gains: FloatArray
    half: float | None = None

    @property
    def parameters(self) -> FloatArray:
        """``[gains, lag, rate]``, and half the dead band where there is one."""
        half = () if self.half is None else (self.half,)
        return np.array([*self.gains, self.alignment.lag_s, self.alignment.rate, *half])


class NothingInCommonError(Exception):
    """No frequency at which one channel follows the other."""


@dataclass(frozen=True, eq=False)
class Linear:
    """The model's columns at one set of parameters, and the second channel, as spectra."""

    start: int
    taper: FloatArray
    target: ComplexArray
    channels: ComplexArray
    motions: ComplexArray
    slides: ComplexArray
    by_play: ComplexArray
    side: ComplexArray | None
    drift: ComplexArray
    first_bin: int

    def other_derivatives(self, gains: FloatArray) -> ComplexArray:
        """Return the derivatives by all but the gains."""
        side = () if self.side is None else (gains[0] * self.side,)
        return np.array([gains @ self.motions, gains @ self.slides, *side, *self.drift])

    def residual(self, gains: FloatArray) -> ComplexArray:
        """Return what the channels leave of the second one."""
        residual: ComplexArray = self.target - gains @ self.channels - gains[0] * self.by_play
        return residual

    def columns(self, gains: FloatArray, stands_out: BoolArray) -> ComplexArray:
        """Return the derivatives, without the channels where they are noise."""
        rows = np.concatenate((self.channels, self.other_derivatives(gains)))
        rows[: len(self.channels) + 2] *= stands_out
        if self.side is not None:
            rows[0] += self.by_play
        return rows


def linearised(problem: ComparisonProblem, model: Model) -> Linear:
    """Return the columns on the samples that both channels have.

    Raises
    ------
    NothingInCommonError
        If there are hardly any.
    """
    from scipy.fft import rfft
    from scipy.signal.windows import tukey

    second, where = problem.second, model.alignment
    time_s = second.time_s[where.stretch]
    covered = np.flatnonzero(problem.first.covers(where.times_s(time_s)))
    if len(covered) < 16:
        raise NothingInCommonError
    start, count = int(covered[0]), _fast(len(covered))
    time_s = time_s[start : start + count]
    asked_s = where.times_s(time_s)
    taper = tukey(count, _TAPER)
    step_hz = second.rate_hz / count
    low = max(_FIRST, int(np.ceil(problem.low_hz / step_hz)))
    high = min(int(problem.top_hz / step_hz), count // 2 - 1)

    def spectrum(values: FloatArray) -> ComplexArray:
        return np.asarray(rfft(values * taper)[low : high + 1])

    values = [problem.first.values(asked_s, 0, k) for k in range(problem.channels)]
    motions = [-problem.first.values(asked_s, 1, k) for k in range(problem.channels)]
    play = play_at(problem, model, time_s)
    if play is not None:
        motions = [np.where(play.pushed, motion, 0.0) for motion in motions]
    begin = where.stretch.start + start
    return Linear(
        begin,
        taper,
        spectrum(second.derivatives[0][begin : begin + count]),
        np.array([spectrum(channel) for channel in values]),
        np.array([spectrum(motion) for motion in motions]),
        np.array([spectrum(motion * (time_s - where.mid_s)) for motion in motions]),
        spectrum(np.zeros(count) if play is None else play.values - values[0]),
        None if play is None else spectrum(-play.side),
        np.array([spectrum(np.ones(count)), spectrum(np.linspace(-1.0, 1.0, count))]),
        low,
    )


def play_at(problem: ComparisonProblem, model: Model, time_s: FloatArray) -> Play | None:
    """Return the play at even times, followed in steps fine enough not to cut its reversals."""
    if model.half is None:
        return None
    rate_hz = problem.second.rate_hz
    fine = int(np.ceil(_A_PERIOD * problem.motion_hz / rate_hz))
    steps_s = time_s[0] + np.arange((len(time_s) - 1) * fine + 1) / (fine * rate_hz)
    leader = problem.first.values(model.alignment.times_s(steps_s), 0)
    return follow(leader, model.half).decimated(fine)


def _fast(count: int) -> int:
    """Return the largest length up to a count that transforms fast."""
    from scipy.fft import prev_fast_len

    return int(prev_fast_len(count))
