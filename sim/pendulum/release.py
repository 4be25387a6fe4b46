"""Release of a body: where it was held, how long the release takes, and its side push."""

import math
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.acquisition.noise import draw_normal, start_stream
from sim.pendulum.coordinates import RELEASE_HOLD, Coordinate
from sim.signals import Signal, Signals
from sim.stage import Block


@dataclass(frozen=True)
class Release:
    """Hold the body at a displacement, then let it go.

    Attributes
    ----------
    coordinates
        Those of the body.
    displacement
        Where each is held, in its unit.
    rate
        With what each is let go, in its unit per second.
    after_s
        For how long it is held in the record; it is let go at the first sample from then on.
    displacement_scatter, rate_scatter
        Standard deviations by which each release misses those, from the run's seed.
    """

    coordinates: tuple[Coordinate, ...]
    displacement: tuple[float, ...]
    rate: tuple[float, ...] = ()
    after_s: float = 0.0
    displacement_scatter: tuple[float, ...] = ()
    rate_scatter: tuple[float, ...] = ()

    name = "release"
    reads = ()

    def __post_init__(self) -> None:
        n = len(self.coordinates)
        for key in ("displacement", "rate", "displacement_scatter", "rate_scatter"):
            values = getattr(self, key)
            if len(values) not in ({n} if key == "displacement" else {0, n}):
                names = ", ".join(coordinate.name for coordinate in self.coordinates)
                raise ConfigurationError(
                    f"release: {key} has {len(values)} values for the {n} coordinates {names}"
                )
            if not all(math.isfinite(value) for value in values):
                raise ConfigurationError(f"release: {key} = {values} must be finite")

    @property
    def writes(self) -> tuple[Signal, ...]:
        """Whether it is held, where, and with what rate it is let go."""
        held = tuple(coordinate.held_position for coordinate in self.coordinates)
        return (RELEASE_HOLD, *held, *(coordinate.kick for coordinate in self.coordinates))

    def start(self, sample_rate_hz: float, seed: int) -> tuple[float, ...]:
        """Return this run's displacements and rates."""
        n = len(self.coordinates)
        _, draws = draw_normal(start_stream(seed, self.name), 2 * n)
        wanted = _filled(self.displacement, n), _filled(self.rate, n)
        missed = _filled(self.displacement_scatter, n), _filled(self.rate_scatter, n)
        values = np.concatenate(wanted) + np.concatenate(missed) * draws
        return tuple(float(value) for value in values)

    def run(
        self,
        state: tuple[float, ...],
        block: Block,
        inputs: Signals,
    ) -> tuple[tuple[float, ...], Signals]:
        """Return the same for every sample but the hold, which ends."""
        # half a part in 1e9 of a sample: a whole number of samples stays one
        hold = (block.time_s + 5e-10 / block.sample_rate_hz < self.after_s).astype(np.float64)
        rows = [hold, *(np.full(block.count, value) for value in state)]
        return state, {signal.name: row for signal, row in zip(self.writes, rows, strict=True)}


def _filled(values: tuple[float, ...], count: int) -> FloatArray:
    return np.array(values) if values else np.zeros(count)
