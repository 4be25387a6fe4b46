"""The evidence of each hypothesis of one problem, beside a deviation of each size."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

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
        axes = np.eye(int(self.sought.sum()))
        more = math.sqrt(WIDE**2 - 1.0)  # beside the tolerance itself
        wide = [more * axis for axis in (*axes, np.ones(len(axes)))]
        return _mean(self._smooth(self._scale(sought=scale)) for scale in wide)

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
        return {name: self._seen(self._within(kind.rows)) for name, kind in self.kinds.items()}

    def _within(self, rows: BoolArray) -> list[Reduced]:
        """Return the residual's products under a deviation of each size in some observations."""
        if rows.all():
            return [weighted.reduced(self._scale(), self._of) for weighted in self._calm]
        each = np.zeros((len(rows), int(rows.sum())))
        each[rows] = np.eye(each.shape[1])
        reduced = self._bare.reduced(self._scale(), np.hstack((self._of, each)))
        sizes, at = np.sqrt(self.kernel.values[rows]), range(1, 1 + each.shape[1])
        return [reduced.widened(1, at, tau * sizes) for tau in TAUS]

    def _spread(self, columns: FloatArray, share: float, rows: BoolArray) -> FloatArray:
        """Return the log evidence of shapes, and of a share of none in some observations.

        Parameters
        ----------
        columns
            The tolerances, and shapes behind them.
        """
        turned, shared = self.kernel.turned(columns), self.tolerances.shape[1]
        shapes, values = columns.shape[1] - shared, share * self.kernel.values * rows
        return self._seen(
            [
                Weighted(turned, 1.0 + tau**2 * values, shared).reduced(
                    np.full(shapes, tau), self._of
                )
                for tau in TAUS
            ]
        )

    def odd_runs(self) -> dict[str, FloatArray]:
        """Return that of one run with a gain or a zero of its own, by run."""
        of, at = self._with_own(self._of)
        calm = [weighted.reduced(self._scale(), of) for weighted in self._tolerated]
        return {
            run: _mean(
                self._seen([reduced.widened(1, rows, tau) for tau in TAUS]) for reduced in calm
            )
            for run, rows in at.items()
        }

    def named(self, sets: Sequence[Hypothesis]) -> list[list[Evidence]]:
        """Return what each set of named effects is worth beside a deviation of each size."""
        shapes = [self.shapes.beside(hypothesis.names) for hypothesis in sets]
        turned = [self._turned(hypothesis) for hypothesis in sets]
        evidences: list[list[Evidence]] = [[] for _ in sets]
        for tau, plain in zip(TAUS, self._plain, strict=True):
            beside = [self._beside(tau, shape) for shape in shapes]
            for set_evidences, hypothesis, reduced in zip(
                evidences, sets, plain.each(beside, turned), strict=True
            ):
                set_evidences.append(_in_any_form(hypothesis, reduced))
        return evidences

    def named_beside(self, hypothesis: Hypothesis, run: str) -> FloatArray:
        """Return the log evidence of named effects beside one odd run."""
        large = np.array(TAUS) > TOLERATED
        of, at = self._with_own(self._turned(hypothesis))
        logs = np.full((len(self._tolerated), len(TAUS)), -np.inf)
        for row, under in enumerate(self._tolerated):
            calm = under.reduced(self._scale(), of)
            for column in np.flatnonzero(large):
                evidence = _in_any_form(hypothesis, calm, at[run], TAUS[column])
                logs[row, column] = evidence.log_evidence
        return _mean(logs)

    def _turned(self, hypothesis: Hypothesis) -> FloatArray:
        """Return target, slopes and forms of a hypothesis in the kernel's coordinates."""
        return self.kernel.turned(
            np.column_stack((hypothesis.target, hypothesis.columns, hypothesis.forms))
        )

    def _with_own(self, of: FloatArray) -> tuple[FloatArray, dict[str, list[int]]]:
        """Return columns with those of each run's own behind them, and where those are."""
        ends = np.cumsum([of.shape[1], *(columns.shape[1] for columns in self._owned)])
        at = [[*range(first, last)] for first, last in pairwise(ends.tolist())]
        run_columns = self.kernel.turned(np.hstack(self._owned)) if self.own else of[:, :0]
        return np.hstack((of, run_columns)), dict(zip(self.own, at, strict=True))

    @cached_property
    def _columns(self) -> FloatArray:
        sought = self.tolerances[:, self.sought]
        blocks = (self.tolerances, self.shapes.columns, *self._owned, sought)
        return self.kernel.turned(np.hstack(blocks))

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
        return [
            weighted for weighted, tau in zip(self._calm, TAUS, strict=True) if tau <= TOLERATED
        ]

    @cached_property
    def _plain(self) -> Sequence[Weighted]:
        """Under the part of a deviation of each size that has no shape."""
        return self._under(PLAIN)

    def _under(self, share: float) -> Sequence[Weighted]:
        values = share * self.kernel.values
        shared = self.tolerances.shape[1]
        return [Weighted(self._columns, 1.0 + tau**2 * values, shared) for tau in TAUS]

    @property
    def _owned(self) -> Sequence[FloatArray]:
        return tuple(self.own.values())

    def _scale(
        self,
        shapes: FloatArray | float = 0.0,
        own: float = 0.0,
        sought: FloatArray | float = 0.0,
    ) -> FloatArray:
        """Return what each of the columns behind the tolerances counts."""
        return np.concatenate(
            (
                np.broadcast_to(shapes, self.shapes.columns.shape[1]),
                np.full(sum(columns.shape[1] for columns in self._owned), own),
                np.broadcast_to(sought, int(self.sought.sum())),
            )
        )

    def _beside(self, tau: float, shapes: FloatArray) -> FloatArray:
        """Return the scale of a deviation with some shapes, and of each run's own part of it."""
        return self._scale(shapes=tau * shapes, own=tau * math.sqrt(PLAIN))

    def _smooth(self, scale: FloatArray) -> FloatArray:
        """Return the log evidence at each tolerated size, minus infinity at larger ones."""
        small = [at for at, tau in enumerate(TAUS) if tau <= TOLERATED]
        logs = np.full(len(TAUS), -np.inf)
        logs[small] = [_density(self._calm[at].reduced(scale, self._of)) for at in small]
        return logs

    @cached_property
    def _bare(self) -> Weighted:
        """Under no deviation."""
        return Weighted(self._columns, np.ones(len(self.residual)), self.tolerances.shape[1])

    @cached_property
    def _least(self) -> float:
        """Log determinant of tolerances and of a deviation that these runs hardly show."""
        return self._bare.reduced(self._scale(), self._of).log_determinant + 2.0 * VISIBLE

    def _seen(self, products: Sequence[Reduced]) -> FloatArray:
        """Return log evidences, minus infinity where these runs would hardly show a deviation."""
        return np.array(
            [
                _density(reduced) if reduced.log_determinant > self._least else -np.inf
                for reduced in products
            ]
        )


def _in_any_form(
    hypothesis: Hypothesis, products: Reduced, run_columns: Sequence[int] = (), tau: float = 0.0
) -> Evidence:
    """Return what named effects are worth, in whichever form of their families they are.

    Parameters
    ----------
    products
        Products of the target, the slopes, the forms and more.
    run_columns
        Which of them are a run's own, where one is odd.
    tau
        Size of its deviation.
    """
    linear_count, count = 1 + hypothesis.columns.shape[1], hypothesis.forms.shape[1]
    at = [*range(linear_count, linear_count + count), *run_columns]
    evidences = [
        weighed(
            hypothesis,
            products.widened(linear_count, at, np.repeat((share, tau), (count, len(run_columns)))),
        )
        for share in (FORMS if count else FORMS[:1])
    ]
    logs = np.array([each.log_evidence for each in evidences])
    return replace(evidences[int(np.argmax(logs))], log_evidence=float(_mean(logs)))


def _mean(each: Iterable[FloatArray]) -> FloatArray:
    """Return the log of the mean evidence over equally probable deviations."""
    logs = list(each)
    return np.asarray(np.logaddexp.reduce(logs, axis=0) - math.log(len(logs)), np.float64)


def _density(reduced: Reduced) -> float:
    return -0.5 * (float(reduced.gram[0, 0]) + reduced.log_determinant)
