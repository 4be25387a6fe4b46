"""The numbers of whole cycles, which a fit follows, and the moves that they describe.

The numbers of a cycle are its hull's phasors, real and imaginary part in turn, order by order, and
behind them its steady rate of turn and the relative error of its frequency.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.names import Form
from analysis.coefficients.phasors import interleaved
from analysis.coefficients.stated_uncertainties import STATED
from analysis.coefficients.term_waves import MOVES, UPRIGHT
from analysis.coefficients.terms import RUDDER_LETTER
from analysis.kinematics.body_frame import CHANNELS, HEEL, HEELED
from analysis.kinematics.cycle import basis
from analysis.uncertainty.values import Contribution
from hardware.description.arrays import FloatArray

_AHEAD, _ROTATION, _TRANSLATION = 2, 1, 0
_TURN, _PACE, _BEHIND = -2, -1, 2
_ACROSS = {Form.MANOEUVRING: 3, Form.SEAKEEPING: _TRANSLATION}


@dataclass(frozen=True, eq=False)
class CycleNumbers:
    """Cycles of one plane on one oscillator as numbers.

    Attributes
    ----------
    highest
        Harmonic of the motion that is taken into account; a cycle of fewer has nothing beyond.
    form
        Which velocity goes with the translation: through the water, or across the tank.
    """

    cycles: tuple[BodyCycle, ...]
    highest: int
    form: Form = Form.MANOEUVRING

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """Of the cycles' numbers: all, those of heel where a cycle has them."""
        return HEELED if any(HEEL in cycle.channels for cycle in self.cycles) else CHANNELS

    @cached_property
    def parts(self) -> FloatArray:
        """The cycles' numbers, shape ``(cycles, numbers)``."""
        return np.stack([self.of_cycle(cycle, interleaved(cycle.hull.phasors.values))
                         for cycle in self.cycles])  # fmt: skip

    def of_cycle(self, cycle: BodyCycle, rows: FloatArray) -> FloatArray:
        """Return a cycle's numbers, of its hull's phasors as :meth:`padded` takes them."""
        parts = self.padded(cycle, rows)
        parts[_TURN] = cycle.turn_rate_rad_s
        return parts

    def padded(self, cycle: BodyCycle, rows: FloatArray) -> FloatArray:
        """Return what stands by a cycle's own phasors as it stands by its numbers here.

        Parameters
        ----------
        rows
            Shape ``(2 n, k)``, to ``(numbers, k)``: a surge force not measured has nothing, nor
            have turn and frequency.
        """
        shaped = rows.reshape(cycle.orders + 1, len(cycle.channels), 2, *rows.shape[1:])
        count = self.highest + 1
        rows_by_order = np.zeros((count, len(self.channels), 2, *rows.shape[1:]))
        places = [self.channels.index(name) for name in cycle.channels]
        rows_by_order[: len(shaped), places] = shaped[:count]
        return np.concatenate(
            (rows_by_order.reshape(-1, *rows.shape[1:]), np.zeros((_BEHIND, *rows.shape[1:])))
        )

    def scatter(self, cycle: BodyCycle, source: Contribution) -> FloatArray:
        """Return how a cycle's numbers follow the deviates of a source, ``(numbers, k)``."""
        return self.padded(cycle, source.dense(2 * len(cycle.phasors.names)))

    def sensitivity(self, cycle: BodyCycle) -> FloatArray:
        """Return how a cycle's numbers follow what is stated, ``(numbers, len(STATED))``."""
        sensitivity = self.padded(cycle, cycle.hull.sensitivity)
        sensitivity[_PACE, STATED.index("frequency_relative")] = 1.0
        sensitivity[_TURN, STATED.index("turn_rate_relative")] = cycle.turn_rate_rad_s
        return sensitivity

    def shaped(self, parts: FloatArray) -> FloatArray:
        """Return numbers by order and channel, ``(..., highest + 1, channels, 2)``."""
        shape = (*parts.shape[:-1], self.highest + 1, len(self.channels), 2)
        return parts[..., :-_BEHIND].reshape(shape)

    @cached_property
    def _omega(self) -> FloatArray:
        return np.array([2.0 * math.pi * cycle.frequency_hz for cycle in self.cycles])

    @cached_property
    def _made_of(self) -> dict[str, tuple[int, int]]:
        """Channel that each move is of, and how often it is differentiated."""
        across = _ACROSS[self.form]
        first = int(across == _TRANSLATION)
        sources = {
            "u": (_AHEAD, 0),
            "udot": (_AHEAD, 1),
            "v": (across, first),
            "r": (_ROTATION, 1),
            "vdot": (across, first + 1),
            "rdot": (_ROTATION, 2),
        }
        if HEEL in self.channels:
            heel = self.channels.index(HEEL)
            sources |= {"phi": (heel, 0), "p": (heel, 1), "pdot": (heel, 2)}
        return sources

    def moves(self, parts: FloatArray) -> FloatArray:
        """Return :data:`MOVES` over the cycles, shape ``(..., cycles, 7 or 10, instants)``."""
        shaped = self.shaped(parts)
        pace = self._omega * (1.0 + parts[..., _PACE])
        moves = {}
        for name, (channel, times) in self._made_of.items():
            waves = shaped[..., channel, :].reshape(*parts.shape[:-1], -1)
            moves[name] = (pace**times)[..., None] * (waves @ basis(self.highest + 1, times))
        moves["r"] = moves["r"] + parts[..., _TURN, None]
        rudder = np.array([cycle.rudder_rad for cycle in self.cycles])[:, None]
        moves[RUDDER_LETTER] = np.broadcast_to(rudder, moves["u"].shape)
        moving = len(MOVES) if HEEL in self.channels else UPRIGHT
        return np.stack([moves[name] for name in MOVES[:moving]], axis=-2)

    @cached_property
    def moved(self) -> FloatArray:
        """:meth:`moves` of the cycles as they are."""
        return self.moves(self.parts)

    def follow(self, over: FloatArray) -> FloatArray:
        """Return what changes per move and instant are per number: the moves' own slope after.

        The rudder is none of a cycle's numbers. Shape ``(cycles, k, 7 or 10, instants)`` to
        ``(cycles, k, numbers)``.
        """
        count = self.highest + 1
        slopes = np.zeros((*over.shape[:2], count, len(self.channels), 2))
        by_pace = np.zeros(over.shape[:2])
        for name, (channel, times) in self._made_of.items():
            k = MOVES.index(name)
            slope = over[:, :, k] @ basis(count, times).T * (self._omega**times)[:, None, None]
            slopes[..., channel, :] += slope.reshape(*over.shape[:2], count, 2)
            by_pace += times * np.einsum("kct,kt->kc", over[:, :, k], self.moved[:, k])
        flat = slopes.reshape(*over.shape[:2], -1)
        by_turn = over[:, :, MOVES.index("r")].sum(axis=-1)
        return np.concatenate((flat, by_turn[..., None], by_pace[..., None]), axis=-1)
