"""A body on springs or afloat under a known force: one run, seen by one sensor.

The motion is that to which the body settles under the force's harmonics
(:mod:`sim.pendulum.driven`). What is observed is the response: each window's amplitude and phase
are taken against those of the force in the same window. A force that grows evenly or turns is
followed as exp(s t) is, at a complex s: so the body's memory does no harm, but for what varies
faster. A window of a run is what a window of swings is in a decay.
"""

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, ClassVar, cast

import numpy as np
from numpy.polynomial import Polynomial

from analysis.gap.pendulum.swings import (
    FEWEST_WINDOWS,
    KINDS,
    Windows,
    cut_into_windows,
    swings_of_samples,
)
from analysis.gap.pendulum.trial import Trial
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import DataError
from sim.pendulum.bench import PendulumBench
from sim.pendulum.driven import ORDERS, DrivenBody, PeriodicForce, impedance, settled
from sim.pendulum.effects.base import PendulumEffect

_DECAY, _PERIOD, _MEAN = (KINDS.index(kind) for kind in ("decay", "period", "mean"))
_ORDERS = 23  # of the motion that a window is shown
_MOST_SAMPLES = 256  # a period: more do not change what a window makes of it
_ANOTHER_TURN = 1.5 * math.pi  # rad: halfway from half a turn off to a whole one
_EVEN = 1e-3  # rad: so that exactly half a turn is a late one in every record
_OCTAVE = math.log(2.0)  # of frequency, over which a deviation keeps its value


@dataclass(frozen=True, eq=False)
class DrivenTrial(Trial):
    """A run under a known force, and the bench whose one sensor saw it.

    Attributes
    ----------
    samples
        Of the record in a period of the force.
    grows_rad_s
        What the force does besides: growth of its logarithm, and 1j times how fast its phase
        leads on, in each window; shape ``(windows,)``, none where left out.
    """

    samples: int = 100
    grows_rad_s: ComplexArray = field(default_factory=lambda: np.zeros(1, np.complex128))

    driven: ClassVar[bool] = True

    @property
    def body(self) -> DrivenBody:
        """The body with its force."""
        return cast("DrivenBody", self.bench.body)

    @property
    def channel(self) -> str:
        """What the sensor is called."""
        return self.bench.sensors[0].channel.name

    @property
    def release_columns(self) -> int:
        """None: it has settled."""
        return 0

    def alike(self, other: Trial) -> float:
        """Return how alike a deviation is: over an octave of frequency, whichever sensor sees."""
        ratio = other.windows.reference_rad_s / self.windows.reference_rad_s
        return math.exp(-0.5 * (math.log(ratio) / _OCTAVE) ** 2)

    def simulate(self, effects: Iterable[PendulumEffect] = ()) -> FloatArray:
        """Return what the record would show with more effects on, shape ``(5, windows)``.

        Raises
        ------
        ConfigurationError
            If the body does not settle.
        """
        out, late_rad = self._simulated(effects)
        out[_PERIOD] += _whole_turns(self._turned - float(np.median(out[_PERIOD])) - _EVEN)
        out[_PERIOD] -= late_rad
        apart = self._phase_difference(out)
        if abs(apart) > _ANOTHER_TURN:  # a reversed sign turns either way, a delay by any amount
            out[_PERIOD] += _whole_turns(apart)
        return out

    @cached_property
    def _turned(self) -> float:
        """Phase without further effects, delays left out, in the turn of what was observed.

        Effects are followed from here: one that chose its turn anew would jump by a whole one
        where the phase is half a turn off.
        """
        out, late_rad = self._simulated(())
        phase = float(np.median(out[_PERIOD]))
        out[_PERIOD] -= late_rad
        return phase + _whole_turns(self._phase_difference(out))

    def _phase_difference(self, shown: FloatArray) -> float:
        """Return the observed phase less a simulated one; 0 where none was observed."""
        phases = self.observed[_PERIOD, np.isfinite(self.observed[_PERIOD])]
        return float(np.median(phases) - np.median(shown[_PERIOD])) if phases.size else 0.0

    def _simulated(self, effects: Iterable[PendulumEffect]) -> tuple[FloatArray, FloatArray]:
        """Return what the record would show, its phase in any turn, and by how much it is late."""
        bench = self.bench.with_effects(self.placed((*self.effects, *effects)))
        body, windows = cast("DrivenBody", bench.body), self.windows
        read = _read(bench, np.arange(1.0, _ORDERS + 1))
        out = self._window(settled(body, _ORDERS) * read).repeat(windows.count, axis=1)
        follows = self._growth_response(bench)
        out[_DECAY] += np.log(np.abs(follows))
        out[_PERIOD] += np.angle(follows)
        late_s = bench.delay_s + bench.clock_error * (windows.start_s + windows.centres_s)
        return out, body.force.omega_rad_s * late_s / (1.0 + bench.clock_error)

    def _growth_response(self, bench: PendulumBench) -> ComplexArray:
        """Return the response to the force as it grows over that to a steady one, by windows."""
        body = cast("DrivenBody", bench.body)
        orders = np.append(1.0, 1.0 - 1j * self.grows_rad_s / body.force.omega_rad_s)
        shown = _read(bench, orders) / impedance(body, orders)
        return np.asarray(shown[1:] / shown[0], np.complex128)

    @property
    def third_harmonic(self) -> float:
        """What a force of the third order makes that is as large as one of the first, over 3."""
        bench, orders = self.bench.with_effects(self.placed(self.effects)), np.array([1.0, 3.0])
        shown = np.abs(_read(bench, orders) / impedance(cast("DrivenBody", bench.body), orders))
        return float(shown[1] / shown[0] / orders[1])

    def _window(self, harmonics: ComplexArray) -> FloatArray:
        """Return what a window makes of a periodic signal, shape ``(5, 1)``.

        Measured and simulated motions pass the same windows, as in a decay.
        """
        count = min(self.samples, _MOST_SAMPLES)
        half = np.concatenate([[0.0], 0.5 * count * harmonics])
        values = np.tile(np.fft.irfft(half, count), self.windows.swings)
        time_s = np.linspace(0.0, self.windows.length_s, values.size, endpoint=False)
        return swings_of_samples(
            time_s, values, replace(self.windows, start_s=0.0, count=1), steady=True
        )

    def placed(self, effects: Iterable[PendulumEffect]) -> list[PendulumEffect]:
        """Return the effects that act on this run: those of another sensor do not."""
        channels = ("", self.channel)
        return super().placed(
            effect for effect in effects if getattr(effect, "channel", "") in channels
        )

    def pushed(self, factor: float) -> "DrivenTrial":
        """Return the run under another force of the same frequency."""
        body: Any = self.body
        return replace(
            self, bench=replace(self.bench, body=replace(body, force=body.force.scaled(factor)))
        )


def _whole_turns(phase_rad: float) -> float:
    """Return the whole turns that are nearest to a phase, rad."""
    return 2.0 * math.pi * round(phase_rad / (2.0 * math.pi))


def _read(bench: PendulumBench, orders: FloatArray | ComplexArray) -> ComplexArray:
    """Return what a bench's one sensor shows of the displacement at some orders of the force.

    An order may be complex: of a force that grows.
    """
    body, (sensor,) = cast("DrivenBody", bench.body), bench.sensors
    (coordinate,) = body.coordinates
    signals = [coordinate.displacement, coordinate.rate, coordinate.acceleration]
    ((felt, weight),) = sensor.weights
    turns = 1j * body.force.omega_rad_s * orders
    lag = 1.0 + turns * sensor.lag_s
    return np.asarray(weight * sensor.gain * turns ** signals.index(felt) / lag, np.complex128)


@dataclass(frozen=True, eq=False)
class KnownForce:
    """A force over the gate of a run.

    Attributes
    ----------
    harmonics
        Its phase is that at the first window's beginning.
    first
        First harmonic of what was recorded: of the force, or of the wave that makes it.
    swings
        Windows of that, as :func:`~analysis.gap.pendulum.swings.swings_of_samples` gives them, its
        even growth taken off.
    growth
        That growth: a polynomial of the logarithm over the time since the first window began.
    changes
        Logarithm of the largest amplitude of a window over the smallest.
    """

    windows: Windows
    harmonics: PeriodicForce
    first: complex
    swings: FloatArray
    growth: Polynomial
    changes: float

    @classmethod
    def of(cls, name: str, time_s: FloatArray, values: FloatArray, period_s: float) -> "KnownForce":
        """Find a force's frequency, harmonics and windows in the samples of a gate.

        Parameters
        ----------
        period_s
            Of the force, roughly.

        Raises
        ------
        DataError
            If the gate is shorter than two windows.
        """
        start_s, stop_s = float(time_s[0]), float(time_s[-1])
        rate_hz = (time_s.size - 1) / (stop_s - start_s)
        for _ in range(2):  # the second time at the force's own frequency
            windows = cut_into_windows(start_s, stop_s, period_s, rate_hz)
            if windows.count < 2:
                raise DataError(f"{name}: no two windows of {period_s:.3g} s; record longer")
            swings = swings_of_samples(time_s, values, windows, steady=True)
            slope = np.polyfit(windows.centres_s, swings[_PERIOD], 1)[0]
            period_s = 2.0 * math.pi / (windows.reference_rad_s + float(slope))
        since, omega = time_s - start_s, windows.reference_rad_s
        grew, changes = _smooth(windows, swings[_DECAY]), float(np.ptp(_finite(swings[_DECAY])))
        grew -= grew(since).mean()
        values = _without_growth(values, grew(since))
        swings = swings_of_samples(time_s, values, windows, steady=True)
        inside = (since < windows.length_s * windows.count) & np.isfinite(values)
        turns = np.exp(1j * omega * since[inside, None] * np.arange(1, ORDERS + 1))
        columns = np.column_stack([np.ones(len(turns)), turns.real, turns.imag])
        _, *solved = np.linalg.lstsq(columns, values[inside], rcond=None)[0]
        harmonics = [complex(a, -b) for a, b in zip(solved[:ORDERS], solved[ORDERS:], strict=True)]
        return cls(
            windows, PeriodicForce(omega, tuple(harmonics)), harmonics[0], swings, grew, changes
        )

    @property
    def grows_rad_s(self) -> ComplexArray:
        """As :class:`DrivenTrial` has it."""
        at_s = self.windows.centres_s
        turned = _smooth(self.windows, self.swings[_PERIOD]).deriv()(at_s)
        return np.asarray(self.growth.deriv()(at_s) + 1j * turned, np.complex128)

    def of_wave(self, transfer: complex) -> "KnownForce":
        """Return the force of a wave by its transfer function; of the first order alone."""
        made = PeriodicForce(self.harmonics.omega_rad_s, (transfer * self.first,))
        return replace(self, harmonics=made)

    def response(self, time_s: FloatArray, values: FloatArray) -> FloatArray:
        """Return what a motion shows against the force, shape ``(5, windows)``.

        A mean is left out, since nothing says where a sensor is zero; so is the third harmonic
        where that of the force is not known.
        """
        values = _without_growth(values, self.growth(time_s - self.windows.start_s))
        swings = swings_of_samples(time_s, values, self.windows, steady=True)
        swings[_DECAY] -= self.swings[_DECAY] - math.log(abs(self.first))
        swings[_PERIOD] -= self.swings[_PERIOD] - cmath.phase(self.first)
        swings[_MEAN] = np.nan
        if len(self.harmonics.harmonics) < 3:
            swings[_MEAN + 1 :] = np.nan
        return swings


def _smooth(windows: Windows, values: FloatArray) -> Polynomial:
    """Return a parabola through the values of windows, a line where they are few."""
    good = np.isfinite(values)
    degree = 2 if good.sum() >= FEWEST_WINDOWS else 1
    fit = Polynomial.fit(windows.centres_s[good], values[good], degree)
    return fit.convert()


def _without_growth(values: FloatArray, grew: FloatArray) -> FloatArray:
    """Return an oscillation with its growth taken off, its mean as it is."""
    mean = np.nanmean(values)
    return np.asarray(mean + (values - mean) * np.exp(-grew), np.float64)


def _finite(values: FloatArray) -> FloatArray:
    return values[np.isfinite(values)]
