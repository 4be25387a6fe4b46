"""What a gauge's reading has beyond its force: curves, loops and soft limits."""

import math
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.motor import UNKNOWN_KEYS_REFUSED


class LoopState(NamedTuple):
    """Last value, which way it went (-1, 0, 1), and where it turned last, above and below."""

    last: float
    direction: float
    highest: float
    lowest: float


class Branch(NamedTuple):
    """At each value, which way it goes, and where it turned last; ``(samples,)`` each."""

    direction: FloatArray
    highest: FloatArray
    lowest: FloatArray


def follow(state: LoopState | None, values: FloatArray) -> tuple[LoopState, Branch]:
    """Return on which branch of a loop each value lies.

    Parameters
    ----------
    values
        Shape ``(samples,)``, at least one.
    """
    if state is None:
        first = float(values[0])
        state = LoopState(first, 0.0, first, first)
    joined = np.concatenate([[state.last], values])
    steps = np.sign(np.diff(joined))
    direction = _carried(steps, steps != 0.0, state.direction)
    before = np.concatenate([[state.direction], direction[:-1]])
    highest = _carried(joined[:-1], (before > 0.0) & (direction < 0.0), state.highest)
    lowest = _carried(joined[:-1], (before < 0.0) & (direction > 0.0), state.lowest)
    last = (values[-1], direction[-1], highest[-1], lowest[-1])
    return LoopState(*(float(value) for value in last)), Branch(direction, highest, lowest)


def _carried(values: FloatArray, renewed: np.ndarray, before: float) -> FloatArray:
    """Return at each sample the value at the latest one that is renewed."""
    at = np.maximum.accumulate(np.where(renewed, np.arange(values.size), -1))
    return np.where(at < 0, before, values[at])


@dataclass(frozen=True)
class PowerLoop:
    """A loop whose half width w goes with a power n of the force's half range A.

    Between the extremes F1 and F2 the reading lags by ``w (A/A_0)^n (F2 - F)(F - F1)/A^2``, and not
    at all beyond them. n = 2 is Rayleigh's loop; n = 1 loses the same share of the energy at all
    amplitudes, as structures and glue do (B. J. Lazan, "Damping of Materials and Members", 1968).

    Attributes
    ----------
    half_width_n
        w, at the half range ``reference_n``, A_0.
    swelling
        Share of what Rayleigh's law has in phase beside that, of a gauge whose gain was found at
        A_0: ``2 (w/A_0) ((A/A_0)^(n - 1) - 1)`` times the force from its middle.
    """

    half_width_n: float
    reference_n: float
    power: float = 2.0
    swelling: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def lag(self, force: FloatArray, branch: Branch) -> FloatArray:
        """Return by how much the reading lags behind the force, N."""
        half = (branch.highest - branch.lowest) / 2.0
        inside = np.maximum((branch.highest - force) * (force - branch.lowest), 0.0)
        size = self.half_width_n * np.abs(half / self.reference_n) ** self.power
        opened = np.where(half > 0.0, half, 1.0)
        lag = branch.direction * size * inside / opened**2
        if self.swelling:
            middle = (branch.highest + branch.lowest) / 2.0
            gain = size / opened - self.half_width_n / self.reference_n
            lag = lag - 2.0 * self.swelling * gain * (force - middle)
        return np.asarray(lag, dtype=np.float64)


@dataclass(frozen=True)
class SaturatingLoop:
    """A loop that becomes no wider: ``dz/dF = (1 - z sgn dF)/d``, reading ``F - h z``.

    That is Bouc's and Wen's law of order 1 (Y.-K. Wen, J. Eng. Mech. Div. ASCE 102, 1976), here
    with the z that it has between the extremes F1 and F2 once it repeats:
    ``1 - 2 exp(-(F - F1)/d)/(1 + exp(-(F2 - F1)/d))`` on the way up, and so on the way down. The
    gauge's gain was found at extremes of ``reference_n`` to either side, A_0, where the reading is
    right: ``h tanh(A_0/d)`` times the force over A_0 is added to it.
    """

    half_width_n: float
    distance_n: float
    reference_n: float

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def lag(self, force: FloatArray, branch: Branch) -> FloatArray:
        """Return by how much the reading lags behind the force, N."""
        behind = np.where(branch.direction > 0.0, force - branch.lowest, branch.highest - force)
        span = np.exp(-(branch.highest - branch.lowest) / self.distance_n)
        turned = 2.0 * np.exp(-np.maximum(behind, 0.0) / self.distance_n) / (1.0 + span)
        gain = math.tanh(self.reference_n / self.distance_n) / self.reference_n
        middle = (branch.highest + branch.lowest) / 2.0
        z = branch.direction * (1.0 - turned) - gain * (force - middle)
        return np.asarray(self.half_width_n * z, dtype=np.float64)


Loop: TypeAlias = PowerLoop | SaturatingLoop


@dataclass(frozen=True)
class Curve:
    """``c F_0 |F/F_0|^p``, or that with the force's sign where it is ``odd``.

    Attributes
    ----------
    relative
        c, at the force ``reference_n``, F_0.
    """

    relative: float
    reference_n: float
    power: float
    odd: bool = False

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def added(self, force: FloatArray) -> FloatArray:
        """Return by how much the reading exceeds the force, N."""
        size = self.relative * self.reference_n * np.abs(force / self.reference_n) ** self.power
        return np.sign(force) * size if self.odd else size


def limited(
    reading: FloatArray, lowest: float | None, highest: float | None, knee: float
) -> FloatArray:
    """Return a reading that stops at limits; with a knee k it bends towards them before.

    ``F/(1 + |F/L|^q)^(1/q)`` with q = 1/k and L the limit on that side (C. Rapp, Proc. 2nd European
    Conf. on Satellite Communications, 1991).
    """
    if not knee:
        return np.asarray(np.clip(reading, lowest, highest), dtype=np.float64)
    above = np.inf if highest is None else highest
    below = np.inf if lowest is None else -lowest
    relative = np.abs(reading) / np.where(reading > 0.0, above, below)
    larger = np.maximum(relative, 1.0)
    power_sum = (1.0 / larger) ** (1.0 / knee) + (relative / larger) ** (1.0 / knee)
    return np.asarray(reading / (larger * power_sum**knee), dtype=np.float64)
