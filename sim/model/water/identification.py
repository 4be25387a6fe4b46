"""Least squares of a ladder's numbers against added mass and damping, in scaled units."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import DataError
from sim.model.water.ladder import Ladder

_EVALUATIONS: Final = 300
# Rate, relative to the lowest frequency, at which every state has to fade at least.
_SLOWEST_FADING: Final = 0.05
# Standard deviation of the starts around an uncoupled pair, relative to its numbers.
_SPREAD: Final = 0.1
# Root mean square deviation that no panel method's table deserves to be fitted better than.
_GOOD_ENOUGH: Final = 2e-6


@dataclass(frozen=True)
class MemoryTarget:
    """What a memory of m degrees of freedom has to reproduce at k frequencies.

    Attributes
    ----------
    omega
        Shape ``(k,)``.
    added_mass, damping
        Shape ``(k, m, m)``.
    weight_added_mass, weight_damping
        What a deviation is multiplied with, shape ``(k, m, m)``.
    infinite
        Added mass at infinite frequency, ``(m, m)``, if it is known.
    """

    omega: FloatArray
    added_mass: FloatArray
    damping: FloatArray
    weight_added_mass: FloatArray
    weight_damping: FloatArray
    infinite: FloatArray | None

    def weighted(self, impedance: ComplexArray) -> FloatArray:
        """Return real part and imaginary part / w, weighted, in the last axis of the result."""
        a = impedance.imag / self.omega[:, None, None] * self.weight_added_mass
        b = impedance.real * self.weight_damping
        shape = (*impedance.shape[:-3], -1)
        return np.concatenate([a.reshape(shape), b.reshape(shape)], axis=-1)

    def refine(self, ladder: Ladder, start: FloatArray) -> tuple[FloatArray, float]:
        """Return the numbers of the nearest least, and its root mean square deviation."""
        from scipy.optimize import least_squares

        free = start.size if self.infinite is None else int(ladder.cuts[-1])
        aim = self.damping + 1j * self.omega[:, None, None] * self.added_mass

        def deviation(numbers: FloatArray) -> FloatArray:
            response = ladder.response(np.append(numbers, start[free:]), self.omega)
            return self.weighted(response - aim)

        def slope(numbers: FloatArray) -> FloatArray:
            slopes = ladder.slope(np.append(numbers, start[free:]), self.omega)
            return self.weighted(slopes).T[:, :free]

        least = least_squares(deviation, start[:free], slope, max_nfev=_EVALUATIONS)
        mean_square = 2.0 * float(least.cost) / least.fun.size
        return np.append(least.x, start[free:]), float(np.sqrt(mean_square))


def best_ladder(
    target: MemoryTarget, states: int, starts: int, generator: np.random.Generator
) -> tuple[Ladder, FloatArray]:
    """Return the ladder of one degree of freedom that comes nearest from several starts."""
    ladder = Ladder(states, 1)
    drawn = (_draw(ladder, target, generator) for _ in range(starts))
    return ladder, _best(target, ladder, drawn)


def best_joint_ladder(
    target: MemoryTarget,
    first: tuple[Ladder, FloatArray],
    second: tuple[Ladder, FloatArray],
    starts: int,
    generator: np.random.Generator,
) -> tuple[Ladder, FloatArray]:
    """Return the ladder of two coupled degrees of freedom, from the ladders of either alone.

    A third as many starts serve: the first is the uncoupled pair, the others lie around it.
    """
    ladder, pair = joint_ladder(first, second)
    spread = generator.normal(0.0, _SPREAD, (max(starts // 3, 1), pair.size))
    spread[0] = 0.0
    size = np.sqrt(np.mean(pair**2))
    return ladder, _best(target, ladder, (pair + size * offset for offset in spread))


def _best(target: MemoryTarget, ladder: Ladder, candidates: Iterable[FloatArray]) -> FloatArray:
    """Refine the candidates and return the best result that fades."""
    best, least = None, np.inf
    for start in candidates:
        numbers, deviation = target.refine(ladder, start)
        if deviation < least and _fades(target, ladder, numbers):
            best, least = numbers, deviation
        if least < _GOOD_ENOUGH:
            break
    if best is None:
        raise DataError(
            f"no start led to a memory of {ladder.states} states that fades within some periods of "
            f"the table's lowest frequency; use fewer states or more starts"
        )
    return best


def _fades(target: MemoryTarget, ladder: Ladder, numbers: FloatArray) -> bool:
    """Tell whether the slowest state fades; one that does not is an artefact of the fit."""
    slowest = np.linalg.eigvals(ladder.matrices(numbers).state).real.max()
    return bool(slowest < -_SLOWEST_FADING * target.omega[0])


def joint_ladder(
    first: tuple[Ladder, FloatArray], second: tuple[Ladder, FloatArray]
) -> tuple[Ladder, FloatArray]:
    """Put two ladders of one degree of freedom side by side into one of two, not yet coupled."""
    ladder = Ladder(first[0].blocks, 2)
    n = ladder.states
    skew, lower, inner = np.zeros((n, n)), np.zeros((n, 2)), np.zeros((n, 2))
    added = np.zeros((2, 2))
    for i, (chain, numbers) in enumerate((first, second)):
        own = slice(i, n, 2)
        skew[own, own], low, x, a = chain.split(numbers)
        lower[own, i], inner[own, i], added[i, i] = low[:, 0], x[:, 0], a[0, 0]
    return ladder, ladder.join(skew, lower, inner, added)


def _draw(ladder: Ladder, target: MemoryTarget, generator: np.random.Generator) -> FloatArray:
    """Draw numbers around those of a memory that peaks where the damping does."""
    peak = target.omega[np.argmax(target.damping[:, 0, 0])]
    size = np.sqrt(np.ptp(target.added_mass) + np.ptp(target.damping) / peak)
    n, rates = ladder.blocks, peak * np.exp(generator.normal(0.0, 0.5, ladder.blocks))
    added = target.added_mass.min() if target.infinite is None else target.infinite[0, 0]
    inner = size * generator.normal(0.0, 1.0, n - 1)
    return np.concatenate([rates[:-1], np.sqrt(2.0 * rates[-1:]), inner, [added]])
