"""Shapes that a deviation may have: those of the catalogue's effects, as these runs show them.

What nobody knows looks like physics: it moves, pushes or delays something that is there. So the
covariance of what is unknown is that of the effects' signatures in this very campaign.
"""

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.inference.constants import ALIKE, PLAIN, STRANGE
from analysis.gap.inference.gaussian import Nuisances
from hardware.description.arrays import BoolArray, FloatArray

_LEAST: Final = 0.03  # of an effect's largest direction, below which one is as good as none
# Of a deviation of 1: less is rounding. A saturation that no run reaches changes 1e-16; brought to
# the size of the others, that would be a shape drawn by chance, another one on each machine.
_ROUNDING: Final = 1e-12  # measured: rounding 1e-16, the least that any effect changes 1e-9


@dataclass(frozen=True, eq=False)
class SignatureOfEffect:
    """What a first look at an effect shows.

    Attributes
    ----------
    stage
        Where it acts.
    signature, columns
        What it changes, and its slopes, in sigma: shapes ``(observations,)`` and
        ``(observations, p)``.
    """

    name: str
    stage: str
    signature: FloatArray
    columns: FloatArray


@dataclass(frozen=True, eq=False)
class Shapes:
    """Directions in which effects move the observations.

    Attributes
    ----------
    columns
        Each effect's signature and slopes, orthogonal, in sigma at a root mean square of 1 in units
        of a deviation, shape ``(observations, directions)``.
    effects, stages
        Whose they are, and where that one acts, one for each direction.
    alike
        For each effect those whose signatures these runs hardly tell from its own, itself included.
    """

    columns: FloatArray
    effects: tuple[str, ...]
    stages: tuple[str, ...]
    alike: dict[str, frozenset[str]]

    @classmethod
    def of(
        cls, looked: Sequence[SignatureOfEffect], scale: FloatArray, tolerances: Nuisances
    ) -> "Shapes":
        """Learn from first looks at effects.

        Parameters
        ----------
        scale
            How large a deviation of 1 is at each observation, in sigma.
        """
        columns, effects, stages = [np.zeros((len(scale), 0))], [], []
        for effect in looked:
            directions = _directions(np.column_stack((effect.signature, effect.columns)), scale)
            columns.append(directions)
            effects += [effect.name] * directions.shape[1]
            stages += [effect.stage] * directions.shape[1]
        return cls(np.hstack(columns), tuple(effects), tuple(stages), _alike(looked, tolerances))

    def stage_share(self, stage: str, among: Sequence[str]) -> float:
        """Return how probable a stage is where nothing tells it, out of some.

        As the effects have it whose shapes these are, one of each stage that is not known added
        (Laplace's rule of succession).
        """
        known = Counter(dict(zip(self.effects, self.stages, strict=True)).values())
        return (known[stage] + 1) / (sum(known[other] for other in among) + len(among))

    def weights_beside(self, names: Sequence[str]) -> FloatArray:
        """Return the weights of what may stand beside effects: of all that is not like them."""
        out = frozenset[str]().union(*(self.alike.get(name, frozenset((name,))) for name in names))
        return self._weights(lambda at: self.effects[at] not in out, PLAIN)

    def of_stage(self, stage: str) -> FloatArray:
        """Return the shapes of what is unknown in a stage, ``(observations, directions)``."""
        weights = self._weights(lambda at: self.stages[at] == stage, STRANGE)
        return np.asarray((self.columns * weights)[:, weights > 0.0], np.float64)

    def _weights(self, chosen: Callable[[int], bool], plain: float) -> FloatArray:
        """Return by what directions are scaled so that together they have a mean square of 1.

        Parameters
        ----------
        plain
            Share of it that has no shape.
        """
        mask: BoolArray = np.array([chosen(at) for at in range(len(self.effects))], dtype=bool)
        count = len({self.effects[at] for at in np.flatnonzero(mask)})
        return np.asarray(mask * math.sqrt((1.0 - plain) / max(count, 1)), np.float64)


def _directions(changes: FloatArray, scale: FloatArray) -> FloatArray:
    sizes = np.sqrt(np.mean((changes / scale[:, None]) ** 2, axis=0))
    nonzero = sizes > _ROUNDING
    directions = changes[:, nonzero] / sizes[nonzero] / np.sqrt(max(int(nonzero.sum()), 1))
    left, values, _ = np.linalg.svd(directions, full_matrices=False)
    significant = values > _LEAST * values.max(initial=0.0)
    return np.asarray(left[:, significant] * values[significant], np.float64)


def _alike(looked: Sequence[SignatureOfEffect], tolerances: Nuisances) -> dict[str, frozenset[str]]:
    if not looked:
        return {}
    names, signatures = (
        [effect.name for effect in looked],
        np.column_stack([effect.signature for effect in looked]),
    )
    gram = signatures.T @ tolerances.whiten(signatures)
    size = np.sqrt(np.maximum(np.diagonal(gram), 1e-12))
    near = np.abs(gram) > ALIKE * np.outer(size, size)
    return {
        name: frozenset((name, *(names[at] for at in np.flatnonzero(row))))
        for name, row in zip(names, near, strict=True)
    }
