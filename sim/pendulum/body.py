"""The stage that swings: what every kind of body has in common."""

from dataclasses import dataclass
from functools import lru_cache
from math import ceil
from typing import Final, Protocol

import numpy as np

from hardware.description.arrays import FloatArray
from sim.pendulum.coordinates import RELEASE_HOLD, Coordinate
from sim.pendulum.propagators import propagators
from sim.pendulum.resistance import Resistance
from sim.signals import Signal, Signals
from sim.solve.linear_system import as_rows
from sim.stage import Block

# Numbers by which the compiled loop knows the kinds of restoring.
LINEAR: Final = 0
PENDULUM: Final = 1
SUSPENSION: Final = 2

# Longest step in radians of the fastest linear mode: 4e-8 rad after eight swings of 0.5 rad.
LONGEST_STEP_RAD: Final = 0.1


class SwingingBody(Protocol):
    """A body with a few coordinates: ``M q'' + C q' + K q = f`` about rest, and more beyond it."""

    def __hash__(self) -> int:
        """Return the same of equal bodies: what is prepared of one is kept."""
        ...

    @property
    def coordinates(self) -> tuple[Coordinate, ...]:
        """The degrees of freedom, in the matrices' order."""
        ...

    @property
    def resistances(self) -> tuple[Resistance, ...]:
        """What acts on each coordinate alone."""
        ...

    @property
    def mass(self) -> FloatArray:
        """M, shape ``(n, n)``."""
        ...

    @property
    def stiffness(self) -> FloatArray:
        """K, shape ``(n, n)``."""
        ...

    @property
    def kind(self) -> int:
        """Which restoring the compiled loop uses."""
        ...

    @property
    def parameters(self) -> FloatArray:
        """What that restoring needs beyond K."""
        ...

    @property
    def truth(self) -> dict[str, float]:
        """What an estimator should find, by name with unit."""
        ...


@dataclass(frozen=True)
class BodyState:
    """Where a body is before the next sample.

    Attributes
    ----------
    motion
        Displacements, then rates.
    sliding
        Direction in which dry friction last saw each coordinate slide; 0 where it is held or there
        is none.
    free
        Whether it has been let go.
    """

    motion: tuple[float, ...]
    sliding: tuple[float, ...]
    free: bool


@dataclass(frozen=True)
class FreeBody:
    """A body that is held, let go, and swings.

    Linear parts and dry friction are advanced exactly; the rest by a Runge-Kutta method of fourth
    order in steps of at most :data:`LONGEST_STEP_RAD`, the same number for each sample.
    """

    body: SwingingBody

    name = "body"

    @property
    def reads(self) -> tuple[Signal, ...]:
        """What the release hands over."""
        held = tuple(coordinate.held_position for coordinate in self.body.coordinates)
        return (RELEASE_HOLD, *held, *(coordinate.kick for coordinate in self.body.coordinates))

    @property
    def writes(self) -> tuple[Signal, ...]:
        """Displacements, rates and accelerations of all coordinates."""
        coordinates = self.body.coordinates
        moved = tuple(coordinate.displacement for coordinate in coordinates) + tuple(
            coordinate.rate for coordinate in coordinates
        )
        return moved + tuple(coordinate.acceleration for coordinate in coordinates)

    def start(self, sample_rate_hz: float, seed: int) -> BodyState:
        """Return a body at rest, not yet let go."""
        n = len(self.body.coordinates)
        return BodyState((0.0,) * (2 * n), (0.0,) * n, free=False)

    def run(self, state: BodyState, block: Block, inputs: Signals) -> tuple[BodyState, Signals]:
        """Return the motion over the block; it starts where the release's hold ends."""
        from sim.pendulum import kernel

        samples = np.stack([inputs[signal.name] for signal in self.reads]).astype(np.float64)
        out = np.empty((len(self.writes), block.count))
        sliding = np.array(state.sliding)
        model, tables, steps = _kernel_arguments(self.body, block.sample_rate_hz)
        clock = (block.first, block.count, 1.0 / block.sample_rate_hz, steps)
        after, free = kernel.run(
            model, tables, clock, samples, np.array(state.motion), sliding, state.free, out
        )
        signals = {signal.name: row for signal, row in zip(self.writes, out, strict=True)}
        return BodyState(tuple(after.tolist()), tuple(sliding.tolist()), bool(free)), signals


@lru_cache(maxsize=16)
def _kernel_arguments(body: SwingingBody, sample_rate_hz: float) -> tuple[object, object, int]:
    """Return model, tables and steps a sample, as the compiled loop takes them."""
    rows = np.array([resistance.row for resistance in body.resistances])
    damping = np.diag(rows[:, 0])
    steps = steps_per_sample(body, sample_rate_hz)
    rubbing = tuple(resistance.coulomb > 0.0 for resistance in body.resistances)
    propagation = propagators(
        as_rows(body.mass),
        as_rows(damping),
        as_rows(body.stiffness),
        rubbing,
        1.0 / (sample_rate_hz * steps),
    )
    plain = body.kind == LINEAR and all(resistance.linear for resistance in body.resistances)
    beyond = not plain or bool(np.any(body.parameters))
    inverse = np.linalg.inv(body.mass)
    model = (body.kind, body.parameters, inverse, body.stiffness, rows, beyond, any(rubbing))
    return model, propagation.arrays, steps


def natural_frequencies_rad_s(body: SwingingBody) -> FloatArray:
    """Return the undamped angular frequencies of small swings, slowest first, shape ``(n,)``.

    For a suspension the double pendulum's two (equation 17) are among them.
    """
    from scipy.linalg import eigh

    squares: FloatArray = eigh(body.stiffness, body.mass, eigvals_only=True)
    return np.sqrt(np.maximum(squares, 0.0))


def steps_per_sample(body: SwingingBody, sample_rate_hz: float) -> int:
    """Return how many steps the body takes from one sample to the next."""
    fastest = float(natural_frequencies_rad_s(body)[-1])
    return max(1, ceil(fastest / (sample_rate_hz * LONGEST_STEP_RAD)))
