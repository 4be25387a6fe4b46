"""What a further run is worth to a linear matcher: the log-odds of the true class."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np

from tests.sealed.generator.case import Case
from tests.sealed.generator.ceiling import Library, applicable
from tests.sealed.generator.effect import Effect
from tests.sealed.generator.features import StalledError
from tests.sealed.generator.further import case_of, parsed
from tests.sealed.generator.parameters import FloatArray
from tests.sealed.generator.signatures import Projection, Situation

DRAWS = 300
Sizes = Sequence[tuple[Effect, float]]


def _signature(situation: Situation, effect: Effect, size: float) -> FloatArray:
    try:
        return situation.signature(effect, size)
    except StalledError:  # the run tells nothing of an effect under which it would not end
        return np.zeros_like(situation.base(None))


@dataclass(frozen=True)
class Told:
    """What some runs tell, nuisances still in it: columns over the runs' features.

    Attributes
    ----------
    given
        Of the priors that all runs share.
    own
        Of each run's own scatter.
    effects
        Of the catalogue's effects.
    truth
        Of what is there.
    """

    given: FloatArray
    own: FloatArray
    effects: FloatArray
    truth: FloatArray

    @classmethod
    def by(cls, case: Case, situation: Situation, sizes: Sizes) -> Self:
        """Return what a situation's runs tell of a case."""
        p = situation.parameters
        for effect in case.content.effects:
            p = effect.put(p)
        known = case.campaign.known
        return cls(
            np.column_stack([situation.of_prior(prior) for prior in known]),
            situation.of_pulses(),
            np.column_stack([_signature(situation, effect, size) for effect, size in sizes]),
            situation.gap(p),
        )

    def beside(self, other: "Told") -> "Told":
        """Return what both tell."""
        own = np.zeros((len(self.own) + len(other.own), self.own.shape[1] + other.own.shape[1]))
        own[: len(self.own), : self.own.shape[1]] = self.own
        own[len(self.own) :, self.own.shape[1] :] = other.own
        return Told(
            np.vstack([self.given, other.given]),
            own,
            np.vstack([self.effects, other.effects]),
            np.concatenate([self.truth, other.truth]),
        )

    def log_odds(self, effects: Sequence[Effect], right: set[str], seed: Sequence[int]) -> float:
        """Return the mean log-odds of the right effects, each weighed by what it explains."""
        projection = Projection.out_of(np.column_stack([self.given, self.own]))
        library = Library.out_of(effects, list(self.effects.T), projection)
        noise = library.noise(np.random.default_rng(list(seed)))[:DRAWS]
        signature = projection.left(self.truth)
        scores = library.scores(noise + library.units.T @ signature) / 2.0
        weights = np.exp(scores - scores.max(axis=1, keepdims=True))
        weights /= weights.sum(axis=1, keepdims=True)
        own = weights[:, [name in right for name in library.names]].sum(axis=1)
        own = np.clip(own, 1e-9, 1.0 - 1e-9)
        return float(np.mean(np.log(own / (1.0 - own))))


def values(key: Path, wanted: Sequence[Mapping[str, Any]]) -> list[float]:
    """Return by how much each further run alone raises the log-odds of the true class.

    Parameters
    ----------
    key
        Folder of the case's key.
    wanted
        Further runs, as docs/sealed.md describes them.

    Raises
    ------
    ValueError
        For a case that no effect of the catalogue is right for: it has no true class.
    """
    case = case_of(key)
    right = {name for answer in case.right for name in answer}
    if not right:
        raise ValueError(f"{key.name}: nothing of the catalogue is right, so no run has a worth")
    effects = [effect for effect in case.campaign.effects if applicable(effect, case.campaign)]
    sizes = [(e, case.situation.tamed(e, e.typical)[0]) for e in effects]
    told = Told.by(case, case.situation, sizes)
    seed = (case.seed, case.index, 4)
    before = told.log_odds(effects, right, seed)
    last = case.campaign.runs[-1]
    runs = [parsed(run, last) for run in wanted]
    out = []
    for run in runs:
        alone = replace(case.situation, runs=(run,))
        further = told.beside(Told.by(case, alone, sizes))
        out.append(further.log_odds(effects, right, seed) - before)
    return out
