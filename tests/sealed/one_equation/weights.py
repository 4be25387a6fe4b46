"""From evidence and prior odds to probabilities; nothing is patched afterwards."""

import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from analysis.gap.hypotheses import Weighed
from analysis.gap.verdict import COEFFICIENTS, NONE, UNKNOWN, answer_of, effects_in
from hardware.description.arrays import BoolArray, FloatArray
from sim.effects.catalogue import catalogue
from tests.sealed.one_equation.constants import ETA, SHAPED, TAUS, TOLERATED, WITHIN, Odds
from tests.sealed.one_equation.evidence import Beside

_TINY = 1e-300


@dataclass(frozen=True)
class Weights:
    """What is how probable.

    Attributes
    ----------
    by_answer
        Over ``"none"``, ``"coefficients"``, ``"unknown"``, effects, and pairs ``"a+b"``; sums to 1.
    unknown_stages
        Of what is unknown, from which stage it comes; sums to 1.
    """

    by_answer: Mapping[str, float]
    unknown_stages: Mapping[str, float]

    @property
    def stages(self) -> dict[str, float]:
        """How probable it is that the gap comes from each stage; sums to 1."""
        shares: dict[str, float] = defaultdict(float)
        for answer, share in self.by_answer.items():
            names = effects_in(answer)
            for name in names:
                shares[catalogue()[name].stage.value] += share / len(names)
        for stage, part in self.unknown_stages.items():
            shares[stage] += self.by_answer[UNKNOWN] * part
        total = sum(shares.values())
        return {name: value / total for name, value in shares.items()} if total > 0.0 else {}


def weigh_again(searched: Weighed, beside: Beside) -> Weights:
    """Weigh what a search has fitted.

    Posterior is prior odds times evidence to a power, summed over the sizes of a deviation of no
    particular form: small ones only where nothing is there, or the coefficients are what differs,
    visible ones where something unknown is, any beside a named effect. Effects that these runs
    cannot show, or do not, are as good as none. Where a part of the catalogue is considered, it has
    its part of the odds, and so has what is unknown.
    """
    odds = Odds()
    considered = max(len(searched.looked) + len(searched.skipped), 1)
    count = max(considered, len(catalogue()))
    concealed = (len(searched.hidden) + len(searched.skipped)) / count
    none = odds.none + odds.single * concealed + odds.pair * concealed**2
    unknown = odds.unknown * considered / count
    small = _even(np.array(TAUS) <= TOLERATED)
    any_size = WITHIN * small + (1.0 - WITHIN) * _even(np.array(TAUS) > TOLERATED)
    pair = odds.pair / max(count * (count - 1) / 2, 1)
    terms = {
        NONE: _log_weight(beside.none(), small, none),
        COEFFICIENTS: _log_weight(beside.coefficients(), small, odds.coefficients),
    }
    for each, ones in ((odds.single / count, searched.singles), (pair, searched.pairs)):
        for one in ones:
            terms[answer_of(one.fit)] = _log_weight(beside.named(one.fit), any_size, each)
    stages = _of_unknown(beside.unknown(), SHAPED * unknown)
    kinds = _of_unknown(beside.alone(), (1.0 - SHAPED) * unknown)
    logs = {**terms, UNKNOWN: float(np.logaddexp.reduce([*stages.values(), *kinds.values()]))}
    total = float(np.logaddexp.reduce(list(logs.values())))
    shaped = float(np.logaddexp.reduce(list(stages.values()))) if stages else 0.0
    return Weights(
        {name: math.exp(log - total) for name, log in logs.items()},
        {stage: math.exp(log - shaped) for stage, log in stages.items()},
    )


def _of_unknown(found: Mapping[str, FloatArray], share: float) -> dict[str, float]:
    """Return the log weights of something unknown, each way of it as likely as the others."""
    each = share / max(len(found), 1)
    return {name: _log_weight(logs, _even(np.isfinite(logs)), each) for name, logs in found.items()}


def _even(sizes: BoolArray) -> FloatArray:
    """Return equal prior weights for some sizes, 0 for all others."""
    return np.asarray(sizes / max(int(sizes.sum()), 1), np.float64)


def _log_weight(logs: FloatArray, sizes: FloatArray, share: float) -> float:
    """Return the log weight of an answer, over all sizes of the deviation."""
    there = sizes > 0.0
    if not there.any():
        return math.log(_TINY)
    each = ETA * logs[there] + np.log(sizes[there])
    return float(np.logaddexp.reduce(each)) + math.log(max(share, _TINY))
