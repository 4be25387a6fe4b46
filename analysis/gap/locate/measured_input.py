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
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.gap.forward.always_on import is_of_drive
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import ORDERS, POINTS, Simulator, read_steady, reference_turn
from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.observe.at_rest import steady_at_rest
from analysis.gap.observe.components import GapRun, Part
from hardware.description.arrays import BoolArray, ComplexArray, FloatArray
from hardware.description.channels import DISPLACEMENTS, SHAFT_ANGLE
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.chain import Chain
from sim.drive.prescribed_drive import shaft_over
from sim.effects.switching import switch_on
from sim.periodic import steady_state
from sim.rig import SimulatedRig
from sim.solve.period import Period

if TYPE_CHECKING:
    from sim.acquisition.channels import Digitiser

Spectra = dict[str, ComplexArray]

_ROUNDS: Final = 3  # until the phase reference is that of what is fed


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


@dataclass(frozen=True, eq=False)
class FedRemainder:
    """What is left behind a measured input.

    Attributes
    ----------
    rows
        What is compared: of the runs in which all channels were recorded.
    remainder
        With the measured input, in u, shape ``(observations,)``; 0 for what is not compared. The
        input's own noise, carried through the chain, widens u.
    simulated_remainder
        The same with the simulated input, against the same u.
    """

    rows: BoolArray
    remainder: FloatArray
    simulated_remainder: FloatArray


def fed_remainder(problem: Problem, feed: Feed, rows: BoolArray) -> FedRemainder | None:
    """Return what is left with measured channels fed to the chain; ``None`` where none were.

    Of the free numbers the frequency is as it was measured; the others are fitted to what is
    compared alone.

    Parameters
    ----------
    rows
        What is to be compared, behind the channels.
    """
    simulator = problem.simulator
    stack = simulator.stack
    runs = [_run_fed(simulator, run, feed) for run in stack.runs]
    is_fed = np.array([pair is not None for pair in runs])[stack.run]
    compared = rows & is_fed
    if not compared.any():
        return None
    simulated, wider = np.where(is_fed, simulator.nominal, 0.0), np.zeros(len(rows))
    for number, pair in enumerate(runs):
        if pair is not None:
            simulated[stack.run == number], wider[stack.run == number] = pair
    shrink = stack.uncertainty / np.hypot(stack.uncertainty, wider)
    timed = is_fed & np.array([component.part is Part.FREQUENCY for component in stack.components])
    names = problem.nuisances.names
    turns = np.array([not is_of_drive(name) for name in names])  # the shaft is as it was measured
    columns = problem.nuisances.columns * shrink[:, None]
    columns[:, : len(names)] *= turns
    part = Nuisances(columns, names)
    with_it = problem.whitened(stack.values - simulated) * shrink
    return FedRemainder(
        compared,
        _remainder(part, with_it, compared, timed),
        _remainder(part, problem.residual * shrink, compared, timed),
    )


def _remainder(
    nuisances: Nuisances,
    residual: FloatArray,
    rows: BoolArray,
    timed: BoolArray,
) -> FloatArray:
    """Return what the free numbers leave of a difference, each run's frequency as measured."""
    fitted = nuisances.among(rows | timed).fitted(residual[rows | timed])
    return np.where(rows, residual - nuisances.columns @ fitted, 0.0)


def _run_fed(simulator: Simulator, run: GapRun, feed: Feed) -> tuple[FloatArray, FloatArray] | None:
    """Return a run with the measured channels, and what their noise makes of it."""
    rig, set_point = switch_on(simulator.active_effects, simulator.rig, run.set_point, run.place)
    if not run.turns:  # where its struts stand is measured in any case
        still = steady_at_rest(rig, set_point, run)
        return still, np.zeros_like(still)
    if not {*feed.channels} <= {component.channel for component in run.observed.components}:
        return None
    chain = _Chain.of(rig, set_point, run, simulator.reference_channel)
    spectra = {name: _spectrum(run, name, ORDERS) for name in feed.channels}
    base, turn = chain.read(feed, spectra, chain.simulated_turn)
    noises = {name: _noise(run, name, ORDERS) for name in feed.channels}
    moved = [
        chain.read(feed, {**spectra, name: spectra[name] + noise}, turn)[0] - base
        for name, noise in noises.items()
    ]
    squares = np.sum([_amplitudes(run, change) ** 2 for change in moved], axis=0)
    return base, np.sqrt(squares)


@dataclass(frozen=True, eq=False)
class _Chain:
    """The chain of one run at the frequency that was measured."""

    chain: Chain
    period: Period
    rig: SimulatedRig
    run: GapRun
    reference_channel: str | None

    @classmethod
    def of(
        cls, rig: SimulatedRig, set_point: SetPoint, run: GapRun, reference_channel: str | None
    ) -> "_Chain":
        # What is fed is there already: nothing acts back on it, whatever turns the shaft.
        rig = replace(rig, drive=replace(rig.drive, motor=None, gear=None, speed_error=0.0))
        point = replace(set_point, frequency_hz=_measured_hz(run, set_point.frequency_hz))
        period = Period(point.frequency_hz, ORDERS, POINTS)
        return cls(rig.chain(point), period, rig, run, reference_channel)

    @property
    def simulated_turn(self) -> ComplexArray:
        """How the phase reference turns each order, by the simulated input."""
        return reference_turn(steady_state(self.chain, self.period), self.reference_channel)

    def read(
        self, feed: Feed, spectra: Mapping[str, ComplexArray], turn: ComplexArray
    ) -> tuple[FloatArray, ComplexArray]:
        """Return the components with the measured channels, and how the reference then turns.

        Parameters
        ----------
        spectra
            Recorded harmonics by channel, counted from the phase reference.
        turn
            About how the reference turns each order: where it is depends on what is fed.
        """
        for _ in range(_ROUNDS):
            recorded = {name: spectrum * np.conj(turn) for name, spectrum in spectra.items()}
            physical = {name: self._physical(name, spectrum) for name, spectrum in recorded.items()}
            state = steady_state(self.chain, self.period, feed.signals(self.period, physical))
            turn = reference_turn(state, self.reference_channel)
        layout = self.run.observed.layout
        values = read_steady(state, layout, self.run.set_point, self.reference_channel)
        return values, turn

    def _physical(self, name: str, recorded: ComplexArray) -> ComplexArray:
        """Return what a channel measures, by the calibration that it is believed to have."""
        digitiser: Digitiser | None = getattr(self.rig.acquisition, name)
        if digitiser is None:
            return recorded
        measured = recorded / digitiser.response(self.period.s)
        measured[0] -= digitiser.offset
        return measured


def _measured_hz(run: GapRun, set_hz: float) -> float:
    ratio = run.observed.value("", Part.FREQUENCY)
    return set_hz if np.isnan(ratio) else run.set_point.frequency_hz * float(np.exp(ratio))


def _noise(run: GapRun, channel: str, orders: int) -> ComplexArray:
    """Return one standard deviation of each harmonic's cosine."""
    noise = np.zeros(orders + 1, dtype=np.complex128)
    observation = run.observed
    for component, sigma in zip(observation.components, observation.uncertainty, strict=True):
        if component.channel == channel and component.part in (Part.MEAN, Part.QUADRATURE):
            noise[component.order] = sigma
    return noise


def _amplitudes(run: GapRun, change: FloatArray) -> FloatArray:
    """Return each harmonic's amplitude in place of both its parts: noise has any phase."""
    squares: dict[tuple[str, int], float] = defaultdict(float)
    keys = [(component.channel, component.order) for component in run.observed.components]
    for key, value in zip(keys, change, strict=True):
        squares[key] += float(value) ** 2
    return np.sqrt([squares[key] for key in keys])


def _spectrum(run: GapRun, channel: str, orders: int) -> ComplexArray:
    """Return a channel's harmonics; 0 for what is not observed, as is the mean of the shaft."""
    spectrum = np.zeros(orders + 1, dtype=np.complex128)
    mean = run.observed.value(channel, Part.MEAN)
    spectrum[0] = 0.0 if np.isnan(mean) else mean
    for order in range(1, orders + 1):
        pair = [
            run.observed.value(channel, part, order) for part in (Part.QUADRATURE, Part.IN_PHASE)
        ]
        if np.isfinite(pair).all():
            spectrum[order] = complex(pair[0], -pair[1])
    return spectrum


def _motion(period: Period, channels: Mapping[str, ComplexArray]) -> Spectra:
    """Return displacement, velocity and acceleration of both struts."""
    spectra: Spectra = {}
    for names in signals.STRUT_MOTIONS:
        displacement = channels[names[0].name]
        spectra |= {
            signal.name: period.s**times * displacement for times, signal in enumerate(names)
        }
    return spectra


def _shaft(period: Period, channels: Mapping[str, ComplexArray]) -> Spectra:
    """Return angle, speed and acceleration of the shaft."""
    return dict(shaft_over(period, channels[SHAFT_ANGLE.name]))


MEASURED_SHAFT: Final = Feed((SHAFT_ANGLE.name,), _shaft)
MEASURED_MOTION: Final = Feed(DISPLACEMENTS, _motion)
