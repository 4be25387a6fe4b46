"""Signatures: what changes in the features of all runs, with everything that has a prior taken out.

With J the signatures of one prior standard deviation of each nuisance, the whitened covariance of
features is 1 + J J'. Its inverse square root is applied by adding one row per nuisance to J and to
every signature and taking what least squares leave: norms and angles are then those of the best
linear matcher that knows the priors.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, Self

import numpy as np

from tests.sealed.generator.effect import Effect
from tests.sealed.generator.features import FREQUENCY_RELATIVE, StalledError, embedded, features
from tests.sealed.generator.mechanism import Truth, happen, set_run, shortened
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.priors import Prior
from tests.sealed.generator.rig import Rig, Run
from tests.sealed.generator.sensing import sense

Drawn = Mapping[P, float]


class Shown(Protocol):
    """A nuisance that says itself what it changes."""

    def shown(self, situation: "Situation") -> FloatArray:
        """Return what one standard deviation changes, in sigma."""
        ...


@dataclass(frozen=True)
class Situation:
    """A rig as it truly is (without effects) and the runs that are made with it."""

    rig: Rig
    runs: tuple[Run, ...]
    parameters: FloatArray

    def features_of(self, p: FloatArray, settles: float | None) -> FloatArray:
        """Return the features of all runs under parameters ``p``."""
        return np.concatenate([self._of(p, run, settles) for run in self.runs])

    def _of(self, p: FloatArray, run: Run, settles: float | None) -> FloatArray:
        if settles is None or not run.turns:
            truth = happen(p, run, self.rig)
            return features(sense(set_run(p, run), truth, run, self.rig, None), run, self.rig)
        brief = shortened(run)
        truth = happen(p, brief, self.rig, settling=settles)
        short = features(sense(set_run(p, run), truth, brief, self.rig, None), brief, self.rig)
        return embedded(short, brief, run, self.rig)

    @cached_property
    def _happened(self) -> tuple[Truth, ...]:
        return tuple(happen(self.parameters, run, self.rig) for run in self.runs)

    def measured(self, p: FloatArray) -> FloatArray:
        """Return the features where only sensors differ from the rig's own."""
        return np.concatenate(
            [
                features(sense(set_run(p, run), truth, run, self.rig, None), run, self.rig)
                for run, truth in zip(self.runs, self._happened, strict=True)
            ]
        )

    @cached_property
    def _bases(self) -> dict[tuple[float | None, bytes], FloatArray]:
        return {}

    def base(self, settles: float | None) -> FloatArray:
        """Return the features without any effect."""
        return self._kept(self.parameters, settles)

    def _kept(self, p: FloatArray, settles: float | None) -> FloatArray:
        key = (settles, p.tobytes())
        if key not in self._bases:
            self._bases[key] = self.features_of(p, settles)
        return self._bases[key]

    def signature(self, effect: Effect, size: float, drawn: Drawn | None = None) -> FloatArray:
        """Return what an effect at a size changes, in sigma, beside the effect's own base."""
        p = effect.put(self.parameters, size, drawn)
        if effect.measured:
            return self.measured(p) - self.base(None)
        base = self.base(effect.settles)
        if effect.own_base:
            base = self._kept(effect.put(self.parameters, 0.0, drawn), effect.settles)
        return self.features_of(p, effect.settles) - base

    def tamed(
        self, effect: Effect, size: float, drawn: Drawn | None = None
    ) -> tuple[float, FloatArray]:
        """Return size and signature, the size a fifth as long as the shaft stalls."""
        for _ in range(5):
            try:
                return size, self.signature(effect, size, drawn)
            except StalledError:
                size *= 0.2
        raise StalledError(f"{effect.name} stalls the shaft even at {size:g}")

    def gap(self, p: FloatArray) -> FloatArray:
        """Return by how much other parameters change the features, whole records throughout."""
        return self.features_of(p, None) - self.base(None)

    def of_prior(self, prior: "Prior | Shown") -> FloatArray:
        """Return what one standard deviation of a nuisance changes, in sigma."""
        if not isinstance(prior, Prior):
            return prior.shown(self)
        p = prior.put(self.parameters, 1.0)
        return self.features_of(p, 0.25) - self.base(0.25)

    def of_pulses(self) -> FloatArray:
        """Return what each run's own scatter of pulses and speed changes, ``(features, 3 runs)``.

        The line through the pulses is late, its slope off, and the speed off by its repeatability.
        """
        p = self.parameters.copy()
        p[P.SPEED_ERROR] += FREQUENCY_RELATIVE
        fast = self.features_of(p, 0.25) - self.base(0.25)
        own, columns, start = self.base(None), [], 0
        for run, truth in zip(self.runs, self._happened, strict=True):
            record = sense(set_run(self.parameters, run), truth, run, self.rig, None)
            size = len(features(record, run, self.rig))
            here = slice(start, start + size)
            for late, slow in ((1.0, 0.0), (0.0, 1.0)):
                shown = features(record, run, self.rig, late=late, slow=slow)
                columns.append(_within(len(own), here, shown - own[here]))
            columns.append(_within(len(own), here, fast[here]))
            start += size
        return np.column_stack(columns)


def _within(size: int, here: slice, values: FloatArray) -> FloatArray:
    out = np.zeros(size)
    out[here] = values
    return out


@dataclass(frozen=True)
class Projection:
    """What takes the nuisances out of signatures."""

    basis: FloatArray  # (features + nuisances, nuisances), orthonormal

    @classmethod
    def of(cls, situation: Situation, priors: "tuple[Prior | Shown, ...]") -> Self:
        """Return the projection of a situation with these priors."""
        given = [situation.of_prior(prior) for prior in priors]
        return cls.out_of(np.column_stack([*given, situation.of_pulses()]))

    @classmethod
    def out_of(cls, columns: FloatArray) -> Self:
        """Return the projection for nuisances' signatures, ``(features, nuisances)``."""
        stacked = np.vstack([columns, np.eye(columns.shape[1])])
        root = np.linalg.cholesky(stacked.T @ stacked)
        return cls(np.ascontiguousarray(np.linalg.solve(root, stacked.T).T))

    def left(self, signatures: FloatArray) -> FloatArray:
        """Return what is left of signatures, ``(features + nuisances, ...)``."""
        zeros = np.zeros((self.basis.shape[1], *signatures.shape[1:]))
        padded = np.concatenate([signatures, zeros])
        return np.asarray(padded - self.basis @ (self.basis.T @ padded))

    def snr(self, signature: FloatArray) -> float:
        """Return a signature's norm, in sigma."""
        return float(np.linalg.norm(self.left(signature)))
