"""A photogate: when a flag on the body enters and leaves a light beam."""

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import ConfigurationError
from sim.acquisition.crossings import quintic, root
from sim.acquisition.noise import NoiseState, draw_normal, start_stream
from sim.pendulum.coordinates import Coordinate
from sim.signals import Signal, Signals
from sim.stage import Block


@dataclass(frozen=True)
class PhotogateState:
    """What is remembered of the last sample, and whether the flag that is in the beam is seen.

    Attributes
    ----------
    last
        Position, velocity and acceleration of the flag at the last sample; ``None`` before it.
    missing
        Whether the passage now in the beam, if any, goes unnoticed.
    """

    last: tuple[float, float, float] | None
    missing: bool
    chance: NoiseState
    jitter: NoiseState


@dataclass(frozen=True)
class Photogate:
    """Times at which a flag enters and leaves the beam, found between samples.

    The flag is where the weighted sum of the coordinates says. An excursion that enters and leaves
    again between two samples goes unseen.

    Attributes
    ----------
    label
        Name of the gate, ``A`` for example.
    weights
        Coordinates that move the flag and how much of each.
    flag_width_m
        Blocked while the flag's middle is within half of this of the beam.
    beam_offset_m
        Where the beam is, from the flag's position at rest.
    missed_share
        Probability that a passage, both of its edges, goes unnoticed.
    jitter_rms_s
        Standard deviation of each edge's time.
    """

    label: str
    weights: tuple[tuple[Coordinate, float], ...]
    flag_width_m: float = 0.01
    beam_offset_m: float = 0.0
    missed_share: float = 0.0
    jitter_rms_s: float = 0.0

    def __post_init__(self) -> None:
        if not self.flag_width_m > 0.0:
            raise ConfigurationError(f"flag_width_m = {self.flag_width_m:g} must be above 0")
        if not 0.0 <= self.missed_share < 1.0:
            raise ConfigurationError(
                f"missed_share = {self.missed_share:g} must be at least 0 and below 1"
            )

    @property
    def name(self) -> str:
        """Unique by the label."""
        return f"photogate_{self.label}"

    @property
    def edge_time(self) -> Signal:
        """Times of the edges in seconds."""
        return Signal(f"{self.name}_edge_time", "s", sampled=False)

    @property
    def blocked(self) -> Signal:
        """1 where the beam is blocked from that edge on, 0 where it is free."""
        return Signal(f"{self.name}_blocked", "1", sampled=False)

    @property
    def reads(self) -> tuple[Signal, ...]:
        """Displacement, rate and acceleration of each coordinate that moves the flag."""
        motions = [(c.displacement, c.rate, c.acceleration) for c, _ in self.weights]
        return tuple(signal for three in motions for signal in three)

    @property
    def writes(self) -> tuple[Signal, ...]:
        """The edges."""
        return (self.edge_time, self.blocked)

    def start(self, sample_rate_hz: float, seed: int) -> PhotogateState:
        """Return the state before the first sample."""
        chance, jitter = (start_stream(seed, self.name, of) for of in ("chance", "jitter"))
        return PhotogateState(None, missing=False, chance=chance, jitter=jitter)

    def run(
        self, state: PhotogateState, block: Block, inputs: Signals
    ) -> tuple[PhotogateState, Signals]:
        """Return the edges up to the block's last sample."""
        flag, first = self._flag(state, block, inputs)
        edges, blocked = self._edges(flag, block.sample_rate_hz)
        chance, is_seen, missing = self._detected(state, blocked)
        jitter, delays = draw_normal(state.jitter, edges.size)
        times = (first + edges) / block.sample_rate_hz + self.jitter_rms_s * delays
        last = state.last
        if flag.shape[1]:
            last = (float(flag[0, -1]), float(flag[1, -1]), float(flag[2, -1]))
        after = PhotogateState(last, missing, chance, jitter)
        return after, {self.edge_time.name: times[is_seen], self.blocked.name: blocked[is_seen]}

    def _flag(self, state: PhotogateState, block: Block, inputs: Signals) -> tuple[FloatArray, int]:
        """Return position, velocity and acceleration, the last block's end before them."""
        flag = np.zeros((3, block.count))
        for coordinate, weight in self.weights:
            moved = (coordinate.displacement, coordinate.rate, coordinate.acceleration)
            flag += weight * np.stack([inputs[signal.name] for signal in moved])
        if state.last is None:
            return flag, block.first
        return np.hstack([np.array(state.last)[:, np.newaxis], flag]), block.first - 1

    def _edges(self, flag: FloatArray, sample_rate_hz: float) -> tuple[FloatArray, FloatArray]:
        """Return where the flag's ends cross the beam, in samples, and what the gate is then."""
        half = 0.5 * self.flag_width_m
        times, states = [], []
        for level, inside_above in ((-half, True), (half, False)):
            at, rising = crossings(flag, self.beam_offset_m + level, sample_rate_hz)
            times.append(at)
            states.append((rising == inside_above).astype(np.float64))
        edges, blocked = np.concatenate(times), np.concatenate(states)
        order = np.argsort(edges, kind="stable")
        return edges[order], blocked[order]

    def _detected(
        self, state: PhotogateState, blocked: FloatArray
    ) -> tuple[NoiseState, BoolArray, bool]:
        """Draw for each entry whether the passage is seen; its exit follows it."""
        entries = np.flatnonzero(blocked == 1.0)
        chance, draws = draw_normal(state.chance, entries.size)
        limit = NormalDist().inv_cdf(self.missed_share) if self.missed_share else -np.inf
        missed = np.concatenate([[state.missing], draws < limit])
        passage = np.cumsum(blocked == 1.0)
        return chance, ~missed[passage].astype(bool), bool(missed[-1])


def crossings(
    moved: FloatArray, level: float, sample_rate_hz: float
) -> tuple[FloatArray, BoolArray]:
    """Return where a motion crosses a level, in samples from the first, and whether upwards.

    Between samples it is the polynomial of fifth degree that has value, rate and acceleration of
    both, as for the photocell of the towing tank.

    Parameters
    ----------
    moved
        Rows of value, rate and acceleration, shape ``(3, samples)``.
    """
    scale = (1.0, 1.0 / sample_rate_hz, 1.0 / sample_rate_hz**2)
    rows = np.stack([row * factor for row, factor in zip(moved, scale, strict=True)])
    rows[0] -= level
    above = rows[0] >= 0.0
    at = np.flatnonzero(above[1:] != above[:-1])
    before, after = rows[:, at], rows[:, at + 1]
    where: FloatArray = at + root(quintic(before, after), after[0])
    return where, above[at + 1]
