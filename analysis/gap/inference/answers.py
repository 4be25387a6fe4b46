"""From evidence and prior odds to probabilities; nothing is patched afterwards."""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.inference.constants import ETA, ODDS, SHAPED, TAUS, TOLERATED
from analysis.gap.inference.evidence import Background
from analysis.gap.inference.hypothesis import Evidence, Hypothesis
from hardware.description.arrays import BoolArray, FloatArray

NONE: Final = "none"
UNKNOWN: Final = "unknown"
COEFFICIENTS: Final = "coefficients"
ODD_RUN: Final = "odd-run"
NAMELESS: Final = (NONE, UNKNOWN, COEFFICIENTS, ODD_RUN)
_SMALL: Final = np.array(TAUS) <= TOLERATED
_LEADING, _ODDEST = 4, 2  # effects, and runs, that are tried beside each other


@dataclass(frozen=True, eq=False)
class Answers:
    """What is how probable.

    Attributes
    ----------
    by_answer
        Over :data:`NAMELESS`, effects, and pairs ``"a+b"``; sums to 1.
    unknown_stages
        Of what is unknown, from which stage it comes; sums to 1, empty where nothing tells.
    odd_runs
        How probable it is that each run is odd, alone or beside an effect.
    besides
        Of each named answer, how probable it is that something else is there too.
    settled
        Each named answer's parameters beside the deviation that suits it best.
    """

    by_answer: Mapping[str, float]
    unknown_stages: Mapping[str, float]
    odd_runs: Mapping[str, float]
    besides: Mapping[str, float]
    settled: Mapping[str, Evidence]

    @property
    def best(self) -> str:
        """The most probable answer."""
        return max(self.by_answer, key=lambda name: self.by_answer[name])


@dataclass(frozen=True, eq=False)
class ConsideredHypotheses:
    """What was considered.

    Attributes
    ----------
    sets
        What was fitted: single effects, pairs, sets of three.
    count
        How many effects were considered.
    concealed
        How many these runs cannot show, or do not: as good as none.
    """

    sets: Sequence[Hypothesis]
    count: int
    concealed: int

    @property
    def prior_of_none(self) -> float:
        """The prior probability of no effect, or of one that these runs do not show."""
        share = self.concealed / max(self.count, 1)
        return ODDS.none + ODDS.single * share * (1.0 + ODDS.further * share)

    def log_prior(self, answer: str) -> float:
        """Return the log of the prior probability of a named answer."""
        return math.log(prior(len(effects_in(answer)), self.count))


def answers(considered: ConsideredHypotheses, beside: Background) -> Answers:
    """Weigh every hypothesis.

    Posterior is prior odds times evidence to a power, summed over the sizes of a deviation of no
    particular form: small ones only where nothing is there, or coefficients or one run are what
    differs, visible ones where something unknown is, any beside a named effect.
    """
    evidence_pairs = zip(considered.sets, beside.effect_evidence(considered.sets), strict=True)
    named = {answer_of(hypothesis.names): evidences for hypothesis, evidences in evidence_pairs}
    logs = {
        name: weight(evidences) + considered.log_prior(name) for name, evidences in named.items()
    }
    odd = _odd_runs(beside)
    by_effect = _beside_odd_runs(considered, beside, logs, odd)
    stages = _of_unknown(beside.unknown_by_stage(), SHAPED * ODDS.unknown)
    kinds = _of_unknown(beside.unknown_by_kind(), (1.0 - SHAPED) * ODDS.unknown)
    logs |= {name: _sum([logs[name], *by_run.values()]) for name, by_run in by_effect.items()}
    logs |= {
        NONE: _log_weight(beside.no_effect(), _equal_weights(_SMALL), considered.prior_of_none),
        COEFFICIENTS: _log_weight(beside.coefficients(), _equal_weights(_SMALL), ODDS.mistake),
        UNKNOWN: _sum([*stages.values(), *kinds.values()]),
        ODD_RUN: _sum(list(odd.values())),
    }
    total = _sum(list(logs.values()))
    runs = {
        run: [log, *(by_run[run] for by_run in by_effect.values() if run in by_run)]
        for run, log in odd.items()
    }
    return Answers(
        {name: math.exp(log - total) for name, log in logs.items()},
        _located(stages, kinds, beside),
        {run: math.exp(_sum(run_logs) - total) for run, run_logs in runs.items()},
        {name: _weight_above(evidences) for name, evidences in named.items()},
        {
            name: max(evidences, key=lambda evidence: evidence.log_evidence)
            for name, evidences in named.items()
        },
    )


def _odd_runs(beside: Background) -> dict[str, float]:
    """Return the log weight of each run being odd."""
    each = ODDS.mistake / max(len(beside.run_columns), 1)
    return {
        run: _log_weight(logs, _finite_weights(logs), each)
        for run, logs in beside.odd_runs().items()
    }


def _beside_odd_runs(
    considered: ConsideredHypotheses,
    beside: Background,
    logs: Mapping[str, float],
    odd: Mapping[str, float],
) -> dict[str, dict[str, float]]:
    """Return by single effect and run the log weight of both, of those that lead."""
    each = math.log(ODDS.mistake / max(len(beside.run_columns), 1))
    singles = [hypothesis for hypothesis in considered.sets if len(hypothesis.names) == 1]
    leading = sorted(singles, key=lambda hypothesis: -logs[answer_of(hypothesis.names)])[:_LEADING]
    oddest = sorted(odd, key=lambda run: -odd[run])[:_ODDEST]
    return {
        name: {
            run: _log_weight(beside.named_beside(hypothesis, run), _equal_weights(~_SMALL), 1.0)
            + each
            + considered.log_prior(name)
            for run in oddest
        }
        for hypothesis in leading
        for name in [answer_of(hypothesis.names)]
    }


def _located(
    shaped: Mapping[str, float], alone: Mapping[str, float], beside: Background
) -> dict[str, float]:
    """Return from which stage what is unknown comes, by what it looks like and where it shows.

    A kind of observations that tells no stage counts to each as the catalogue's effects do.
    """
    parts: dict[str, list[float]] = {stage: [log] for stage, log in shaped.items()}
    for kind, log in alone.items():
        stages = beside.kinds[kind].stages
        for stage in stages:
            share = beside.shapes.stage_share(stage, stages)
            parts.setdefault(stage, []).append(log + math.log(share))
    logs = {stage: _sum(stage_logs) for stage, stage_logs in parts.items()}
    total = _sum(list(logs.values()))
    return {stage: math.exp(log - total) for stage, log in logs.items() if total > -math.inf}


def prior(size: int, count: int) -> float:
    """Return the prior probability of one set of effects of some size, out of a catalogue's."""
    return ODDS.single * ODDS.further ** (size - 1) / max(math.comb(count, size), 1)


def weight(evidences: Sequence[Evidence]) -> float:
    """Return the log weight of a named answer but for its prior odds, beside any deviation."""
    return _log_weight(_evidences(evidences), _any_size(), 1.0)


def answer_of(names: Sequence[str]) -> str:
    """Return the name of a hypothesis: its effects in alphabetical order."""
    return "+".join(sorted(names))


def effects_in(answer: str) -> tuple[str, ...]:
    """Return the effects that an answer names; none for one that names no effect."""
    return () if answer in NAMELESS else tuple(answer.split("+"))


def by_effect(by_answer: Mapping[str, float]) -> dict[str, float]:
    """Return the probability of each effect in any answer, most probable first.

    Parameters
    ----------
    by_answer
        Probabilities of answers, as :class:`Answers` has them.
    """
    names = {name for answer in by_answer for name in effects_in(answer)}
    shares = {name: of_any(by_answer, [name]) for name in names}
    return dict(sorted(shares.items(), key=lambda pair: (-pair[1], pair[0])))


def of_any(by_answer: Mapping[str, float], *groups: Collection[str]) -> float:
    """Return the probability of all answers with an effect of each group; 0 of no group."""
    total = math.fsum(
        share
        for answer, share in by_answer.items()
        if groups and all(set(effects_in(answer)).intersection(group) for group in groups)
    )
    return min(total, 1.0)


def _any_size() -> FloatArray:
    """Return the prior weights of a deviation's size beside what is named."""
    return _equal_weights(np.ones_like(_SMALL))


def _evidences(evidences: Sequence[Evidence]) -> FloatArray:
    return np.array([evidence.log_evidence for evidence in evidences])


def _weight_above(evidences: Sequence[Evidence]) -> float:
    """Return the part of a named answer's weight at deviations larger than is tolerated."""
    logs = ETA * _evidences(evidences)
    return float(np.exp(np.logaddexp.reduce(logs[~_SMALL]) - np.logaddexp.reduce(logs)))


def _of_unknown(logs_by_name: Mapping[str, FloatArray], share: float) -> dict[str, float]:
    """Return the log weights of something unknown, each way of it as likely as the others."""
    each = share / max(len(logs_by_name), 1)
    return {
        name: _log_weight(logs, _finite_weights(logs), each) for name, logs in logs_by_name.items()
    }


def _finite_weights(logs: FloatArray) -> FloatArray:
    return _equal_weights(np.isfinite(logs))


def _equal_weights(sizes: BoolArray) -> FloatArray:
    """Return equal prior weights for some sizes, 0 for all others."""
    return np.asarray(sizes / max(int(sizes.sum()), 1), np.float64)


def _log_weight(logs: FloatArray, sizes: FloatArray, share: float) -> float:
    """Return the log weight of an answer, over all sizes of the deviation."""
    positive = sizes > 0.0
    if not positive.any():
        return -math.inf
    each = ETA * logs[positive] + np.log(sizes[positive])
    return float(np.logaddexp.reduce(each)) + (math.log(share) if share > 0.0 else -math.inf)


def _sum(logs: Sequence[float]) -> float:
    return float(np.logaddexp.reduce(logs)) if len(logs) else -math.inf
