"""The periodic steady state of a stage from its samples over a period."""

from typing import Any

import numpy as np

from sim import signals
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block, Periodic, Stage


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
    own: Periodic | None = stage if hasattr(stage, "steady") else None  # type: ignore[assignment]
    return steady_by_samples(stage, period, inputs) if own is None else own.steady(period, inputs)


def _with_angle(values: dict[str, np.ndarray], angle: np.ndarray) -> Signals:
    name = signals.SHAFT_ANGLE.name
    return {**values, name: values[name] + angle} if name in values else values
