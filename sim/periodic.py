"""The exact periodic steady state of a chain: one period's harmonics of every signal.

Linear parts are exact in the frequency domain; what is not linear is evaluated at the points of one
period and balanced harmonic by harmonic. No transient has to die out, and no sample is taken: this
is the form for whoever needs a run ten thousand times. What does not repeat with the shaft (noise,
drift, jitter, hum, tones) has no part in it.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from hardware.description.arrays import ComplexArray
from hardware.description.errors import ConfigurationError
from sim import signals
from sim.chain import Chain
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block, Periodic, Stage


@dataclass(frozen=True, eq=False)
class SteadyState:
    """One period of every signal.

    Attributes
    ----------
    period
        The period that is really run.
    spectra
        Harmonics by signal name, ``x(t) = Re sum X_n exp(i n w t)``; see :data:`Spectra`.
    """

    period: Period
    spectra: Spectra

    @property
    def reference_s(self) -> float:
        """Time of the photocell's pulse within the period; 0 without a photocell."""
        edges = self.spectra.get(signals.PHOTOCELL_EDGE_TIME.name)
        return 0.0 if edges is None else float(edges[0].real)

    def referred(self, name: str) -> ComplexArray:
        """Return a signal's harmonics with time counted from the photocell's pulse.

        That is how a recording is analysed: the in-phase part of order n is minus the imaginary
        part, the quadrature the real part.
        """
        turned: ComplexArray = self.spectra[name] * np.exp(self.period.s * self.reference_s)
        return turned


def steady_state(
    chain: Chain, period: Period, substitute: Mapping[str, ComplexArray] | None = None
) -> SteadyState:
    """Return the periodic steady state of a chain.

    Parameters
    ----------
    period
        Frequency that is set, highest order, and points of the period.
    substitute
        Harmonics to use in place of the simulated ones, by signal; shape ``(orders + 1,)``.

    Raises
    ------
    ConfigurationError
        If a substituted signal is not one of the chain's or has not as many orders, an input of the
        chain is missing, or the points do not resolve the orders.
    """
    supply = _checked(chain, period, substitute or {})
    spectra: dict[str, ComplexArray] = {signal.name: supply[signal.name] for signal in chain.inputs}
    for stage in chain.stages:
        fed = {signal.name: spectra[signal.name] for signal in stage.reads}
        fed |= {
            signal.name: supply[signal.name] for signal in stage.writes if signal.name in supply
        }
        period, written = steady_of(stage, period, fed)
        spectra |= {name: supply.get(name, values) for name, values in written.items()}
    return SteadyState(period, spectra)


def _checked(
    chain: Chain, period: Period, supply: Mapping[str, ComplexArray]
) -> Mapping[str, ComplexArray]:
    if period.points <= 2 * period.orders or period.points % 2:
        raise ConfigurationError(
            f"points = {period.points} must be even and more than twice the orders "
            f"({period.orders})"
        )
    names = {signal.name for signal in chain.signals}
    for name, values in supply.items():
        if name not in names:
            raise ConfigurationError(f"the chain has no signal {name!r}")
        if np.shape(values) != (period.orders + 1,):
            raise ConfigurationError(
                f"signal {name!r}: harmonics of shape {np.shape(values)} were given where "
                f"({period.orders + 1},) is needed: the mean and each order"
            )
    for signal in chain.inputs:
        if signal.name not in supply:
            raise ConfigurationError(
                f"signal {signal.name!r} is an input: its harmonics are needed"
            )
    return supply


def steady_by_samples(
    stage: Stage[Any], period: Period, inputs: Spectra, settling: int = 1
) -> tuple[Period, Spectra]:
    """Run a stage over a period at the period's points and return its outputs' harmonics.

    Exact for a stage without memory whose outputs have no harmonics above those that the points
    resolve. A stage with a memory that is shorter than ``settling`` periods comes close; one with a
    longer memory needs a form of its own.
    """
    rate = period.points * period.frequency_hz
    ramp = period.omega_rad_s * period.time_s
    inputs_once: dict[str, np.ndarray] = {
        signal.name: period.values(inputs[signal.name]) for signal in stage.reads if signal.sampled
    }
    state, written = stage.start(rate, 0), dict[str, np.ndarray]()
    for turn in range(settling + 1):
        fed = _with_angle(inputs_once, ramp + 2.0 * np.pi * turn)
        block = Block(turn * period.points, period.points, rate)
        state, out = stage.run(state, block, fed)
        written = dict(out)
    if signals.SHAFT_ANGLE.name in written:
        written[signals.SHAFT_ANGLE.name] = (
            written[signals.SHAFT_ANGLE.name] - ramp - 2.0 * np.pi * settling
        )
    sampled = [signal.name for signal in stage.writes if signal.sampled]
    return period, {name: period.harmonics(written[name]) for name in sampled}


def steady_of(stage: Stage[Any], period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
    """Return a stage's periodic steady state: its own, or from its samples where it has none."""
    # Not isinstance: that looks through the protocol's members every time.
    periodic: Periodic | None = stage if hasattr(stage, "steady") else None  # type: ignore[assignment]
    return (
        steady_by_samples(stage, period, inputs)
        if periodic is None
        else periodic.steady(period, inputs)
    )


def _with_angle(values: dict[str, np.ndarray], angle: np.ndarray) -> Signals:
    name = signals.SHAFT_ANGLE.name
    return {**values, name: values[name] + angle} if name in values else values
