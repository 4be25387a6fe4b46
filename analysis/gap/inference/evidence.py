"""The evidence of each hypothesis of one problem, beside a deviation of each size."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from analysis.gap.inference.constants import FORMS, PLAIN, STRANGE, TAUS, TOLERATED, VISIBLE, WIDE
from analysis.gap.inference.gram import Reduced, Weighted
from analysis.gap.inference.hypothesis import Evidence, Hypothesis, laplace_evidence
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
        Where something may act that shows in these alone.
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
    run_columns
        By run, its own gains and zeros at a deviation of 1, each ``(observations, any)``.
    rows_by_stage
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
    run_columns: Mapping[str, FloatArray]
    rows_by_stage: Mapping[str, BoolArray]
    kinds: Mapping[str, Kind]

    def no_effect(self) -> FloatArray:
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

    def unknown_by_stage(self) -> dict[str, FloatArray]:
        """Return that of something unknown, by the stage whose effects it looks like."""
        shaped = {
            stage: np.hstack((self.tolerances, self.shapes.of_stage(stage)))
            for stage in dict.fromkeys(self.shapes.stages)
        }
        return {
            stage: self._spread(columns, STRANGE, self.rows_by_stage[stage])
            for stage, columns in shaped.items()
        }

    def unknown_by_kind(self) -> dict[str, FloatArray]:
        """Return that of something unknown, by the kind of observations in which it shows."""
        return {name: self._logs(self._within_rows(kind.rows)) for name, kind in self.kinds.items()}

    def _within_rows(self, rows: BoolArray) -> list[Reduced]:
        """Return the residual's products under a deviation of each size in some observations."""
        if rows.all():
            return [weighted.reduced(self._scale(), self._target) for weighted in self._smoothed]
        sizes = np.sqrt(self.kernel.values[rows])
        reduced, at = self._under_none.at_rows(self._target, rows), range(1, 1 + len(sizes))
        return [reduced.widened(1, at, tau * sizes) for tau in TAUS]

    def _spread(self, columns: FloatArray, share: float, rows: BoolArray) -> FloatArray:
        """Return the log evidence of shapes, and of a share of none in some observations.

        Parameters
        ----------
        columns
            The tolerances, and shapes behind them.
        """
        turned, shared = self.kernel.rotated(columns), self.tolerances.shape[1]
        shapes, values = columns.shape[1] - shared, share * self.kernel.values * rows
        return self._logs(
            [
                Weighted(turned, 1.0 + tau**2 * values, shared).reduced(
                    np.full(shapes, tau), self._target
                )
                for tau in TAUS
            ]
        )

    def odd_runs(self) -> dict[str, FloatArray]:
        """Return that of one run with a gain or a zero of its own, by run."""
        of, at = self._with_own(self._target)
        calm = [weighted.reduced(self._scale(), of) for weighted in self._tolerated]
        return {
            run: _mean(
                self._logs([reduced.widened(1, rows, tau) for tau in TAUS]) for reduced in calm
            )
            for run, rows in at.items()
        }

    def effect_evidence(self, sets: Sequence[Hypothesis]) -> list[list[Evidence]]:
        """Return what each set of named effects is worth beside a deviation of each size."""
        shapes = [self.shapes.weights_beside(hypothesis.names) for hypothesis in sets]
        turned = [self._rotated(hypothesis) for hypothesis in sets]
        evidences: list[list[Evidence]] = [[] for _ in sets]
        for tau, plain in zip(TAUS, self._weighted(PLAIN), strict=True):
            beside = [self._shape_scale(tau, shape) for shape in shapes]
            for set_evidences, hypothesis, reduced in zip(
                evidences, sets, plain.each(beside, turned), strict=True
            ):
                set_evidences.append(_in_any_form(hypothesis, reduced))
        return evidences

    def named_beside(self, hypothesis: Hypothesis, run: str) -> FloatArray:
        """Return the log evidence of named effects beside one odd run."""
        large = np.array(TAUS) > TOLERATED
        of, at = self._with_own(self._rotated(hypothesis))
        logs = np.full((len(self._tolerated), len(TAUS)), -np.inf)
        for row, under in enumerate(self._tolerated):
            calm = under.reduced(self._scale(), of)
            for column in np.flatnonzero(large):
                evidence = _in_any_form(hypothesis, calm, at[run], TAUS[column])
                logs[row, column] = evidence.log_evidence
        return _mean(logs)

    def _rotated(self, hypothesis: Hypothesis) -> FloatArray:
        """Return target, slopes and forms of a hypothesis in the kernel's coordinates."""
        return self.kernel.rotated(
            np.column_stack((hypothesis.target, hypothesis.columns, hypothesis.forms))
        )

    def _with_own(self, of: FloatArray) -> tuple[FloatArray, dict[str, list[int]]]:
        """Return columns with those of each run's own behind them, and where those are."""
        ends = np.cumsum([of.shape[1], *(columns.shape[1] for columns in self._run_blocks)])
        at = [[*range(first, last)] for first, last in pairwise(ends.tolist())]
        run_columns = (
            self.kernel.rotated(np.hstack(self._run_blocks)) if self.run_columns else of[:, :0]
        )
        return np.hstack((of, run_columns)), dict(zip(self.run_columns, at, strict=True))

    @cached_property
    def _columns(self) -> FloatArray:
        sought = self.tolerances[:, self.sought]
        blocks = (self.tolerances, self.shapes.columns, *self._run_blocks, sought)
        return self.kernel.rotated(np.hstack(blocks))

    @cached_property
    def _target(self) -> FloatArray:
        return self.kernel.rotated(self.residual[:, None])

    @cached_property
    def _smoothed(self) -> Sequence[Weighted]:
        """Under a smooth deviation of each size."""
        return tuple(self._weighted(1.0))

    @property
    def _tolerated(self) -> Sequence[Weighted]:
        """Under a smooth deviation of each tolerated size."""
        return [
            weighted for weighted, tau in zip(self._smoothed, TAUS, strict=True) if tau <= TOLERATED
        ]

    def _weighted(self, share: float) -> Iterator[Weighted]:
        """Yield what all have under a share of a deviation of each size; each is large."""
        values = share * self.kernel.values
        shared = self.tolerances.shape[1]
        for tau in TAUS:
            yield Weighted(self._columns, 1.0 + tau**2 * values, shared)

    @property
    def _run_blocks(self) -> Sequence[FloatArray]:
        return tuple(self.run_columns.values())

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
                np.full(sum(columns.shape[1] for columns in self._run_blocks), own),
                np.broadcast_to(sought, int(self.sought.sum())),
            )
        )

    def _shape_scale(self, tau: float, shapes: FloatArray) -> FloatArray:
        """Return the scale of a deviation with some shapes, and of each run's own part of it."""
        return self._scale(shapes=tau * shapes, own=tau * math.sqrt(PLAIN))

    def _smooth(self, scale: FloatArray) -> FloatArray:
        """Return the log evidence at each tolerated size, minus infinity at larger ones."""
        small = [at for at, tau in enumerate(TAUS) if tau <= TOLERATED]
        logs = np.full(len(TAUS), -np.inf)
        logs[small] = [_density(self._smoothed[at].reduced(scale, self._target)) for at in small]
        return logs

    @cached_property
    def _under_none(self) -> Weighted:
        """Under no deviation."""
        return Weighted(self._columns, np.ones(len(self.residual)), self.tolerances.shape[1])

    @cached_property
    def _least(self) -> float:
        """Log determinant of tolerances and of a deviation that these runs hardly show."""
        return self._under_none.reduced(self._scale(), self._target).log_determinant + 2.0 * VISIBLE

    def _logs(self, products: Sequence[Reduced]) -> FloatArray:
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
        laplace_evidence(
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
