"""A stage's measured input put in place of the simulated one.

A difference that stays with the measured input comes from the stage or from behind it; one that
goes came in with it. The measured frequency, of the photocell's pulses, takes the place of the one
that was set; the measured shaft that of the drive, the measured motion of the struts that of drive
and mechanism. Orders are differentiated one by one in the frequency domain: samples are never
differenced.
"""

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.at_rest import steady_at_rest
from analysis.gap.components import GapRun, Part
from analysis.gap.fit import Problem
from analysis.gap.forward import Simulator, read_steady
from analysis.gap.gaussian import Nuisances
from analysis.gap.observe import STRUTS
from hardware.description.channels import SHAFT_ANGLE
from sim import signals
from sim.drive import shaft_over
from sim.effects.applied import switch_on
from sim.period import Period
from sim.periodic import steady_state

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Spectra = dict[str, ComplexArray]

_ORDERS: Final = 8
_POINTS: Final = 64
_MOTIONS: Final = (
    (signals.DISPLACEMENT_AFT, signals.VELOCITY_AFT, signals.ACCELERATION_AFT),
    (signals.DISPLACEMENT_FORE, signals.VELOCITY_FORE, signals.ACCELERATION_FORE),
)


@dataclass(frozen=True)
class Feed:
    """Which measured channels are fed, and what a stage gets of them.

    Attributes
    ----------
    channels
        All of them have to be recorded.
    signals
        Of the channels' harmonics, time counted as the simulation does, the chain's signals.
    """

    channels: tuple[str, ...]
    signals: Callable[[Period, Mapping[str, ComplexArray]], Spectra]


def fed(problem: Problem, feed: Feed, rows: NDArray[np.bool_]) -> FloatArray | None:
    """Return what is left with measured channels fed to the chain, in u, shape ``(observations,)``.

    Their own noise, carried through the chain, widens u. The free numbers are fitted to what is
    compared alone.

    Parameters
    ----------
    rows
        What is compared, behind the channels; all else is 0.

    Returns
    -------
    ndarray or None
        ``None`` where a channel is not recorded.
    """
    simulator = problem.simulator
    if not {*feed.channels} <= {one.channel for one in simulator.stack.components}:
        return None
    pairs = [_run_fed(simulator, run, feed) for run in simulator.stack.runs]
    found, wider = (np.concatenate(parts) for parts in zip(*pairs, strict=True))
    sigma = simulator.stack.uncertainty
    shrink = sigma / np.hypot(sigma, wider)
    residual: FloatArray = problem.whitened(simulator.stack.values - found) * shrink
    part = Nuisances((problem.nuisances.columns * shrink[:, None])[rows])
    left: FloatArray = np.zeros_like(residual)
    left[rows] = residual[rows] - part.columns @ part.fitted(residual[rows])
    return left


def _run_fed(simulator: Simulator, run: GapRun, feed: Feed) -> tuple[FloatArray, FloatArray]:
    """Return a run with the measured channels, and what their noise makes of it."""
    rig, set_point = switch_on(simulator.on, simulator.rig, run.set_point, run.place)
    if not run.turns:  # where its struts stand is measured in any case
        still = steady_at_rest(rig, set_point, run)
        return still, np.zeros_like(still)
    # What is fed is there already: nothing acts back on it, whatever turns the shaft.
    rig = replace(rig, drive=replace(rig.drive, motor=None, gear=None))
    chain = rig.chain(set_point)
    period = Period(_measured_hz(run, set_point.frequency_hz), _ORDERS, _POINTS)
    turn = np.exp(-period.s * steady_state(chain, period).reference_s)
    seen = {name: _spectrum(run, name, period.orders) for name in feed.channels}

    def read(channels: Mapping[str, ComplexArray]) -> FloatArray:
        given = feed.signals(period, {name: own * turn for name, own in channels.items()})
        state = steady_state(chain, period, given)
        layout = run.observed.layout
        return read_steady(state, layout, run.set_point, simulator.reference_channel)

    base = read(seen)
    noises = {name: _noise(run, name, period.orders) for name in feed.channels}
    moved = [read({**seen, name: seen[name] + one}) - base for name, one in noises.items()]
    squares = np.sum([_whole(run, change) ** 2 for change in moved], axis=0)
    return base, np.sqrt(squares)


def _measured_hz(run: GapRun, set_hz: float) -> float:
    ratio = run.observed.value("", Part.FREQUENCY)
    return set_hz if np.isnan(ratio) else run.set_point.frequency_hz * float(np.exp(ratio))


def _noise(run: GapRun, channel: str, orders: int) -> ComplexArray:
    """Return one standard deviation of each harmonic's cosine."""
    found = np.zeros(orders + 1, dtype=np.complex128)
    seen = run.observed
    for one, sigma in zip(seen.components, seen.uncertainty, strict=True):
        if one.channel == channel and one.part in (Part.MEAN, Part.QUADRATURE):
            found[one.order] = sigma
    return found


def _whole(run: GapRun, change: FloatArray) -> FloatArray:
    """Return each harmonic's amplitude in place of both its parts: noise has any phase."""
    squares: dict[tuple[str, int], float] = defaultdict(float)
    keys = [(one.channel, one.order) for one in run.observed.components]
    for key, value in zip(keys, change, strict=True):
        squares[key] += float(value) ** 2
    return np.sqrt([squares[key] for key in keys])


def _spectrum(run: GapRun, channel: str, orders: int) -> ComplexArray:
    """Return a channel's harmonics; 0 for what is not observed, as is the mean of the shaft."""
    found = np.zeros(orders + 1, dtype=np.complex128)
    mean = run.observed.value(channel, Part.MEAN)
    found[0] = 0.0 if np.isnan(mean) else mean
    for order in range(1, orders + 1):
        part = [run.observed.value(channel, one, order) for one in (Part.QUADRATURE, Part.IN_PHASE)]
        if np.isfinite(part).all():
            found[order] = complex(part[0], -part[1])
    return found


def _motion(period: Period, channels: Mapping[str, ComplexArray]) -> Spectra:
    """Return displacement, velocity and acceleration of both struts."""
    given: Spectra = {}
    for names in _MOTIONS:
        own = channels[names[0].name]
        given |= {one.name: period.s**times * own for times, one in enumerate(names)}
    return given


def _shaft(period: Period, channels: Mapping[str, ComplexArray]) -> Spectra:
    """Return angle, speed and acceleration of the shaft."""
    return dict(shaft_over(period, channels[SHAFT_ANGLE.name]))


MEASURED_SHAFT: Final = Feed((SHAFT_ANGLE.name,), _shaft)
MEASURED_MOTION: Final = Feed(STRUTS, _motion)
