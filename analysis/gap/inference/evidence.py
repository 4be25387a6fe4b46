"""The evidence of each hypothesis of one problem, beside a deviation of each size."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analysis.gap.inference.constants import FORMS, PLAIN, STRANGE, TAUS, TOLERATED, VISIBLE, WIDE
from analysis.gap.inference.gram import Reduced, Weighted
from analysis.gap.inference.hypothesis import Evidence, Hypothesis, weighed
from analysis.gap.inference.kernel import Kernel
from analysis.gap.inference.shapes import Shapes
from hardware.description.arrays import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class Kind:
    """Observations in which something unknown may show, and no others.

    Attributes
    ----------
    rows
        Which ones, shape ``(observations,)``; whole cells of the kernel.
    stages
        Where something acts that shows in these alone, each as probable as the others.
    """

    rows: BoolArray
    stages: tuple[str, ...]


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
    behind
        By stage, the observations in which something that acts there may show; whole cells of the
        kernel.
    kinds
        Observations in which something may show alone, by name.
    """

    residual: FloatArray
    tolerances: FloatArray
    sought: BoolArray
    kernel: Kernel
    shapes: Shapes
    own: Mapping[str, FloatArray]
    behind: Mapping[str, BoolArray]
    kinds: Mapping[str, Kind]

    def none(self) -> FloatArray:
        """Return the log evidence of no effect, beside a smooth deviation of each size."""
        return self._smooth(self._scale())

    def coefficients(self) -> FloatArray:
        """Return that of coefficients that are off by more than anybody thought: one, or all."""
        if not self.sought.any():
            return np.full(len(TAUS), -np.inf)
        ones = [np.arange(len(self.sought)) == at for at in np.flatnonzero(self.sought)]
        wide = [np.where(own, WIDE, 1.0) for own in (*ones, self.sought)]
        return _mean(self._smooth(self._scale(tolerances=one)) for one in wide)

    def unknown(self) -> dict[str, FloatArray]:
        """Return that of something unknown, by the stage whose effects it looks like."""
        shaped = {
            stage: np.hstack((self.tolerances, self.shapes.at(stage)))
            for stage in dict.fromkeys(self.shapes.stages)
        }
        return {
            stage: self._spread(columns, STRANGE, self.behind[stage])
            for stage, columns in shaped.items()
        }

    def alone(self) -> dict[str, FloatArray]:
        """Return that of something unknown, by the kind of observations in which it shows."""
        return {
            kind: self._spread(self.tolerances, 1.0, one.rows) for kind, one in self.kinds.items()
        }

    def _spread(self, columns: FloatArray, share: float, rows: BoolArray) -> FloatArray:
        """Return the log evidence of shapes, and of a share of none in some observations.

        Parameters
        ----------
        columns
            The tolerances, and shapes behind them.
        """
        turned, count = self.kernel.turned(columns), self.tolerances.shape[1]
        shape = np.arange(columns.shape[1]) >= count
        values = share * self.kernel.values * rows
        return self._seen(
            [
                Weighted(turned, 1.0 + tau**2 * values).reduced(np.where(shape, tau, 1.0), self._of)
                for tau in TAUS
            ]
        )

    def odd_runs(self) -> dict[str, FloatArray]:
        """Return that of one run with a gain or a zero of its own, by run."""
        return {
            run: _mean(
                self._seen([calm.reduced(self._odd(run, tau), self._of) for tau in TAUS])
                for calm in self._tolerated
            )
            for run in self.own
        }

    def named(self, one: Hypothesis) -> list[Evidence]:
        """Return what named effects are worth beside a deviation of each size."""
        beside = self.shapes.beside(one.names)
        return [
            self._weighed(one, self._plain[at], self._beside(tau, beside))
            for at, tau in enumerate(TAUS)
        ]

    def named_beside(self, one: Hypothesis, run: str) -> FloatArray:
        """Return the log evidence of named effects beside one odd run."""
        return _mean(
            np.array(
                [
                    self._weighed(one, calm, self._odd(run, tau)).log_evidence
                    if tau > TOLERATED
                    else -np.inf
                    for tau in TAUS
                ]
            )
            for calm in self._tolerated
        )

    def _weighed(self, one: Hypothesis, under: Weighted, scale: FloatArray) -> Evidence:
        """Return what named effects are worth, in whichever form of their families they are."""
        turned = self.kernel.turned(np.column_stack((one.target, one.columns)))
        forms = self.kernel.turned(one.forms)
        every = FORMS if one.forms.shape[1] else FORMS[:1]
        found = [weighed(one, under.reduced(scale, turned, share * forms)) for share in every]
        logs = [each.log_evidence for each in found]
        best = found[int(np.argmax(logs))]
        return replace(best, log_evidence=float(_mean(np.array(logs))))

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

    @property
    def _tolerated(self) -> Sequence[Weighted]:
        """Under a smooth deviation of each tolerated size."""
        return [one for one, tau in zip(self._calm, TAUS, strict=True) if tau <= TOLERATED]

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


def _mean(each: Iterable[FloatArray]) -> FloatArray:
    """Return the log of the mean evidence over equally probable deviations."""
    logs = list(each)
    return np.asarray(np.logaddexp.reduce(logs, axis=0) - math.log(len(logs)), np.float64)


def _density(found: Reduced) -> float:
    return -0.5 * (float(found.gram[0, 0]) + found.log_determinant)
