"""The evidence of each hypothesis of one problem, beside a deviation of each size."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analysis.gap.inference.constants import PLAIN, TAUS, TOLERATED, VISIBLE, WIDE
from analysis.gap.inference.gram import Reduced, Weighted
from analysis.gap.inference.hypothesis import Evidence, Hypothesis, weighed
from analysis.gap.inference.kernel import Kernel
from analysis.gap.inference.shapes import Shapes
from hardware.description.arrays import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class Background:
    """What every hypothesis of a problem has: tolerances, and a deviation of no particular form.

    Attributes
    ----------
    residual
        Measured minus simulated as stated, in sigma, shape ``(observations,)``.
    tolerances
        Columns of what every good rig and model is off by, ``(observations, tolerances)``.
    sought
        Which of them are the coefficients that a test is made to find, shape ``(tolerances,)``.
    own
        By run, its own gains and zeros at a deviation of 1, each ``(observations, any)``.
    kinds
        The observations of each kind, by its name; of whole cells of the kernel.
    """

    residual: FloatArray
    tolerances: FloatArray
    sought: BoolArray
    kernel: Kernel
    shapes: Shapes
    own: Mapping[str, FloatArray]
    kinds: Mapping[str, BoolArray]

    def none(self) -> FloatArray:
        """Return the log evidence of no effect, beside a smooth deviation of each size."""
        return self._smooth(self._scale())

    def coefficients(self) -> FloatArray:
        """Return that of coefficients that are off by more than anybody thought: one, or all."""
        ones = [np.arange(len(self.sought)) == at for at in np.flatnonzero(self.sought)]
        wide = [np.where(own, WIDE, 1.0) for own in (*ones, self.sought)]
        logs = [self._smooth(self._scale(tolerances=one)) for one in wide]
        return np.asarray(np.logaddexp.reduce(logs, axis=0) - math.log(len(logs)), np.float64)

    def unknown(self) -> dict[str, FloatArray]:
        """Return that of something unknown, by the stage whose effects it looks like."""
        return {
            stage: self._seen(
                [
                    self._plain[at].reduced(self._beside(tau, self.shapes.at(stage)), self._of)
                    for at, tau in enumerate(TAUS)
                ]
            )
            for stage in dict.fromkeys(self.shapes.stages)
        }

    def alone(self) -> dict[str, FloatArray]:
        """Return that of something unknown, by the kind of observations in which it shows."""
        values, scale = self.kernel.values, self._scale()
        return {
            kind: self._seen(
                [
                    Weighted(self._columns, 1.0 + tau**2 * values * rows).reduced(scale, self._of)
                    for tau in TAUS
                ]
            )
            for kind, rows in self.kinds.items()
        }

    def odd_runs(self) -> dict[str, FloatArray]:
        """Return that of one run with a gain or a zero of its own, by run."""
        small = [one for one, tau in zip(self._calm, TAUS, strict=True) if tau <= TOLERATED]
        found = {}
        for run in self.own:
            logs = [
                self._seen([calm.reduced(self._odd(run, tau), self._of) for tau in TAUS])
                for calm in small
            ]
            found[run] = np.logaddexp.reduce(logs, axis=0) - math.log(len(small))
        return found

    def named(self, one: Hypothesis) -> list[Evidence]:
        """Return what named effects are worth beside a deviation of each size."""
        beside = self.shapes.beside(one.names)
        return [
            self._weighed(one, self._plain[at], self._beside(tau, beside))
            for at, tau in enumerate(TAUS)
        ]

    def named_beside(self, one: Hypothesis, run: str, tau: float) -> FloatArray:
        """Return the log evidence of named effects beside one odd run.

        Parameters
        ----------
        tau
            Size of the smooth deviation that is there too.
        """
        calm = self._calm[TAUS.index(tau)]
        found = [
            self._weighed(one, calm, self._odd(run, own)).log_evidence
            if own > TOLERATED
            else -np.inf
            for own in TAUS
        ]
        return np.array(found)

    def _weighed(self, one: Hypothesis, under: Weighted, scale: FloatArray) -> Evidence:
        turned = self.kernel.turned(np.column_stack((one.target, one.columns)))
        return weighed(one, under.reduced(scale, turned, self.kernel.turned(one.forms)))

    @cached_property
    def _columns(self) -> FloatArray:
        return self.kernel.turned(np.hstack((self.tolerances, self.shapes.columns, *self._owned)))

    @cached_property
    def _of(self) -> FloatArray:
        return self.kernel.turned(self.residual[:, None])

    @cached_property
    def _calm(self) -> Sequence[Weighted]:
        """Under a smooth deviation of each size."""
        return self._under(1.0)

    @cached_property
    def _plain(self) -> Sequence[Weighted]:
        """Under the part of a deviation of each size that has no shape."""
        return self._under(PLAIN)

    def _under(self, share: float) -> Sequence[Weighted]:
        values = share * self.kernel.values
        return [Weighted(self._columns, 1.0 + tau**2 * values) for tau in TAUS]

    @property
    def _owned(self) -> Sequence[FloatArray]:
        return tuple(self.own.values())

    def _scale(
        self,
        tolerances: FloatArray | float = 1.0,
        shapes: FloatArray | float = 0.0,
        own: Mapping[str, float] | float = 0.0,
    ) -> FloatArray:
        """Return what each of the columns counts."""
        runs = dict.fromkeys(self.own, own) if isinstance(own, float) else own
        each = [np.full(one.shape[1], runs.get(run, 0.0)) for run, one in self.own.items()]
        return np.concatenate(
            (
                np.broadcast_to(tolerances, self.tolerances.shape[1]),
                np.broadcast_to(shapes, self.shapes.columns.shape[1]),
                *each,
            )
        )

    def _beside(self, tau: float, shapes: FloatArray) -> FloatArray:
        """Return the scale of a deviation with some shapes, and of each run's own part of it."""
        return self._scale(shapes=tau * shapes, own=tau * math.sqrt(PLAIN))

    def _odd(self, run: str, tau: float) -> FloatArray:
        return self._scale(own={run: tau})

    def _smooth(self, scale: FloatArray) -> FloatArray:
        """Return the log evidence at each tolerated size, minus infinity at larger ones."""
        small = [at for at, tau in enumerate(TAUS) if tau <= TOLERATED]
        logs = np.full(len(TAUS), -np.inf)
        logs[small] = [_density(self._calm[at].reduced(scale, self._of)) for at in small]
        return logs

    @cached_property
    def _least(self) -> float:
        """Log determinant of tolerances and of a deviation that these runs hardly show."""
        bare = Weighted(self._columns, np.ones(len(self.residual)))
        return bare.reduced(self._scale(), self._of).log_determinant + 2.0 * VISIBLE

    def _seen(self, found: Sequence[Reduced]) -> FloatArray:
        """Return log evidences, minus infinity where these runs would hardly show a deviation."""
        return np.array(
            [_density(one) if one.log_determinant > self._least else -np.inf for one in found]
        )


def _density(found: Reduced) -> float:
    return -0.5 * (float(found.gram[0, 0]) + found.log_determinant)
