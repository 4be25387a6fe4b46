"""Measured releases as one problem: observations, and what is free in every hypothesis."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analysis.gap.forward.candidate import Candidate
from analysis.gap.forward.problem import built
from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.pendulum.trial import FURTHER, TURNED, Trial
from hardware.description.arrays import BoolArray, FloatArray
from sim.pendulum.bench import PendulumBench
from sim.pendulum.effects.base import PendulumEffect
from sim.pendulum.suspension import Suspension

_LONG = 0.4  # of a record: over which a smooth deviation keeps its value
_FAINT = 1e-3  # variance of a curve that is left out
_ANY_SIZE = 1.0  # of the logarithm: a light gate does not tell the amplitude


@dataclass(frozen=True)
class Tolerance:
    """A number of the set-up that is known within a standard deviation.

    Attributes
    ----------
    effect
        What changes if it is off by that.
    is_per_trial
        Whether each trial has its own error; all share one otherwise.
    """

    name: str
    effect: PendulumEffect
    is_per_trial: bool = False


@dataclass(frozen=True, eq=False)
class PendulumProblem:
    """Records of releases beside their simulation, as a ``ComparedProblem``.

    Attributes
    ----------
    kinds
        The observables that count, of :data:`~analysis.gap.pendulum.swings.KINDS`.
    model_error
        Standard deviation of what the nominal simulation itself is unsure of, one for each kind;
        a smooth curve over each trial.
    present_effects
        Effects beside which releases and tolerances act; none where left out.
    """

    trials: tuple[Trial, ...]
    tolerances: tuple[Tolerance, ...] = ()
    kinds: tuple[str, ...] = KINDS
    model_error: tuple[float, ...] = (0.0,) * len(KINDS)
    present_effects: tuple[PendulumEffect, ...] = ()

    @property
    def suspensions(self) -> bool:
        """Whether the records are of one body on several suspensions, watched by light gates."""
        return len(self.trials) > 2 and self.on_lines

    @property
    def driven(self) -> bool:
        """Whether the records are of runs under a known force."""
        return all(trial.driven for trial in self.trials)

    @cached_property
    def runs(self) -> NDArray[np.intp]:
        """Number of each trial's run, shape ``(trials,)``; sensors of one run share it."""
        names = [trial.run or f"#{at}" for at, trial in enumerate(self.trials)]
        return np.array([names.index(name) for name in names])

    @cached_property
    def names(self) -> tuple[str, ...]:
        """What each of :data:`~analysis.gap.pendulum.swings.KINDS` is called in these records."""
        return ("amplitude", "phase", *KINDS[2:]) if self.driven else KINDS

    @property
    def on_lines(self) -> bool:
        """Whether light gates watch a body on two lines."""
        return all(
            trial.scaled and isinstance(trial.bench.body, Suspension) for trial in self.trials
        )

    @cached_property
    def _compared(self) -> tuple[BoolArray, ...]:
        counts = np.array([name in self.kinds for name in KINDS])[:, None]
        return tuple(
            counts & np.isfinite(trial.observed) & np.isfinite(trial.uncertainty)
            for trial in self.trials
        )

    def flat(self, parts: Sequence[FloatArray]) -> FloatArray:
        """Return the trials' values that count, one after the other."""
        return np.concatenate(
            [part[rows] for part, rows in zip(parts, self._compared, strict=True)]
        )

    @cached_property
    def uncertainty(self) -> FloatArray:
        """Standard deviation of each observation, shape ``(observations,)``."""
        return self.flat([trial.uncertainty for trial in self.trials])

    @cached_property
    def observed(self) -> FloatArray:
        """The observations, shape ``(observations,)``."""
        return self.flat([trial.observed for trial in self.trials])

    @cached_property
    def trial(self) -> NDArray[np.intp]:
        """Number of each observation's trial."""
        parts = [np.full(rows.shape, at) for at, rows in enumerate(self._compared)]
        return np.concatenate([p[rows] for p, rows in zip(parts, self._compared, strict=True)])

    @cached_property
    def kind(self) -> NDArray[np.intp]:
        """Number of each observation's kind."""
        return np.concatenate([np.nonzero(rows)[0] for rows in self._compared])

    @cached_property
    def amplitude(self) -> FloatArray:
        """Amplitude of the window that each observation belongs to."""
        parts = [
            np.broadcast_to(np.exp(trial.observed[0]), trial.observed.shape)
            for trial in self.trials
        ]
        return self.flat(parts)

    @cached_property
    def centre_s(self) -> FloatArray:
        """Middle of the window that each observation belongs to."""
        parts = [
            np.broadcast_to(trial.windows.centres_s, trial.observed.shape) for trial in self.trials
        ]
        return self.flat(parts)

    def predict(self, effects: Sequence[PendulumEffect] = ()) -> FloatArray:
        """Return what all records would show, shape ``(observations,)``."""
        return self.flat([trial.simulate(effects) for trial in self.trials])

    def signature(self, parts: Sequence[Candidate], units: FloatArray) -> FloatArray:
        """Return what effects change of the observations, in sigma."""
        return (self.predict(built(parts, units)) - self.nominal) / self.uncertainty

    @cached_property
    def nominal(self) -> FloatArray:
        """What the nominal simulation shows."""
        return self.predict()

    @cached_property
    def residual(self) -> FloatArray:
        """Measured less nominal, in sigma."""
        return (self.observed - self.nominal) / self.uncertainty

    @property
    def stated(self) -> FloatArray:
        """The same: the simulation is as it is stated."""
        return self.residual

    @cached_property
    def nuisances(self) -> Nuisances:
        """Releases, amplitudes of gates, tolerances: columns in sigma."""
        return Nuisances(
            np.hstack([self.releases, self.set_ups, self.shared_columns, self.model_error_columns])
        )

    @cached_property
    def releases(self) -> FloatArray:
        """Columns of how each record began, and of its scale where that is unknown."""
        columns: list[FloatArray] = []
        for at, trial in enumerate(self.trials):
            if trial.driven:
                continue
            spread = _ANY_SIZE if trial.scaled else FURTHER
            further = trial.release_error(0.2 * spread, 0.0)
            columns.append(self._column(at, further, 0.2))
            columns.append(self._column(at, trial.release_error(0.0, 0.2 * TURNED), 0.2))
            if trial.scaled:
                rows = (self.trial == at) & (self.kind == 0)
                columns.append(_ANY_SIZE * rows / self.uncertainty)
        return self._stacked(columns)

    @cached_property
    def set_ups(self) -> FloatArray:
        """Columns of what each trial's own set-up leaves open: variants, its own tolerances."""
        columns = [
            self._release_change(at, bench)
            for at, trial in enumerate(self.trials)
            for bench in trial.variants
        ]
        for tolerance in self.tolerances:
            columns += self._tolerated(tolerance) if tolerance.is_per_trial else []
        return self._stacked(columns)

    @cached_property
    def shared_columns(self) -> FloatArray:
        """Columns of the tolerances that all trials share."""
        tolerated = [
            self._tolerated(tolerance)
            for tolerance in self.tolerances
            if not tolerance.is_per_trial
        ]
        return self._stacked([np.sum(each, axis=0) for each in tolerated])

    @cached_property
    def model_error_columns(self) -> FloatArray:
        """Columns of what the nominal simulation itself may be wrong by."""
        columns: list[FloatArray] = []
        for kind, error in enumerate(self.model_error):
            for at in range(len(self.trials)) if error > 0.0 else ():
                smooth = self.smooth((self.trial == at) & (self.kind == kind))
                columns += list((error * smooth / self.uncertainty[:, None]).T)
        return self._stacked(columns)

    @cached_property
    def tolerance_names(self) -> tuple[str, ...]:
        """What each nuisance is the error of; empty for those that are no tolerance."""
        variants = sum(len(trial.variants) for trial in self.trials)
        names = [""] * (self.releases.shape[1] + variants)
        for tolerance in self.tolerances:
            if tolerance.is_per_trial:
                names += [f"{tolerance.name} of {trial.name}" for trial in self.trials]
        names += [tolerance.name for tolerance in self.tolerances if not tolerance.is_per_trial]
        return (*names, *[""] * self.model_error_columns.shape[1])

    def _stacked(self, columns: Sequence[FloatArray]) -> FloatArray:
        return np.column_stack(columns) if columns else np.empty((self.uncertainty.size, 0))

    def smooth(self, rows: BoolArray) -> FloatArray:
        """Return columns whose random sum is a smooth curve of unit size over some windows.

        Parameters
        ----------
        rows
            Observations of one kind and trial; the columns are zero elsewhere.
        """
        if not rows.any():
            return np.empty((rows.size, 0))
        time_s = self.centre_s[rows]
        apart = (time_s[:, None] - time_s) / (_LONG * max(float(np.ptp(time_s)), 1e-9))
        values, vectors = np.linalg.eigh(np.exp(-0.5 * apart**2))
        is_clear = values > _FAINT
        columns = np.zeros((rows.size, int(is_clear.sum())))
        columns[rows] = vectors[:, is_clear] * np.sqrt(values[is_clear])
        return columns

    def _tolerated(self, tolerance: Tolerance) -> list[FloatArray]:
        return [self._column(at, tolerance.effect, 1.0) for at in range(len(self.trials))]

    def _release_change(self, at: int, bench: PendulumBench) -> FloatArray:
        trial = self.trials[at]
        variant = replace(trial, bench=replace(bench, release=trial.bench.release))
        return self._change(
            at, variant.simulate(self.present_effects) - trial.simulate(self.present_effects)
        )

    def _column(self, at: int, effect: PendulumEffect, share: float) -> FloatArray:
        """Return the change by an effect on one trial, per whole of which it is a share."""
        trial = self.trials[at]
        change = trial.simulate([*self.present_effects, effect]) - trial.simulate(
            self.present_effects
        )
        return self._change(at, change / share)

    def _change(self, at: int, change: FloatArray) -> FloatArray:
        parts = [np.zeros(trial.observed.shape) for trial in self.trials]
        parts[at] = change
        return self.flat(parts) / self.uncertainty
