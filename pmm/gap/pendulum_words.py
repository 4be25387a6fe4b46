"""A pendulum's diagnosis in plain sentences: what is wrong, how large it is, what to do next."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Final

import numpy as np

from analysis.gap.inference.answers import NONE, ODD_RUN, UNKNOWN
from analysis.gap.judge.confounded import separating_measurements
from analysis.gap.pendulum.causes import BEYOND_LINEAR, DAMPING
from analysis.gap.pendulum.diagnose import PendulumDiagnosis
from analysis.gap.pendulum.laws import DampingLaw, open_laws
from analysis.gap.pendulum.remainder import as_stated
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.pendulum.verdict import TOLD_APART
from analysis.inertia.spread import cause_statement
from hardware.description.arrays import FloatArray
from pmm.gap.pendulum_conclusion import PendulumConclusion, conclusion_of, fitted
from pmm.gap.words import OUTSIDE, listed

_ALIKE: Final = 4  # causes that a sentence names
FASTER: Final = "damping that grows faster than linearly"
_DECAY, _PERIOD = (KINDS.index(kind) for kind in ("decay", "period"))


def sentences(diagnosis: PendulumDiagnosis) -> tuple[str, str, str]:
    """Return the three sentences."""
    concluded = conclusion_of(diagnosis)
    return (
        what_is_wrong(diagnosis, concluded),
        how_large_it_is(diagnosis),
        what_to_do(diagnosis, concluded),
    )


def what_is_wrong(diagnosis: PendulumDiagnosis, concluded: PendulumConclusion) -> str:
    """Return what separates the record from its simulation, and what of it is open."""
    if concluded.turned:
        return f"{_turned_sentence(concluded.turned)}."
    return f"{'; '.join(_verdict_sentences(diagnosis, concluded))}."


def _verdict_sentences(
    diagnosis: PendulumDiagnosis, concluded: PendulumConclusion
) -> Iterator[str]:
    if concluded.verdict == NONE:
        yield _no_gap(diagnosis)
        return
    if concluded.verdict == ODD_RUN:
        yield f"Record {concluded.odd} alone is off, by a gain, a period or a zero of its own"
        return
    if concluded.verdict == UNKNOWN:
        yield f"{OUTSIDE[0].upper()}{OUTSIDE[1:]} separates the record from its simulation"
        return
    if not concluded.names:
        yield f"The cause cannot be told; {_strange(concluded)}"
        return
    rivals = open_laws(diagnosis.laws)
    causes = [
        " or ".join(_alike_names(concluded, name))
        for name in concluded.names
        if name not in DAMPING
    ]
    damped = len(causes) < len(concluded.names)
    damping = [_damping(diagnosis.laws, rivals, concluded.names)] if damped else []
    cause = " and ".join([*damping, *causes])
    said = _cause_text(diagnosis, concluded, cause)
    yield f"{said[0].upper()}{said[1:]}"
    if concluded.strange:
        yield _strange(concluded)
    for shares in concluded.alike_causes.values():
        yield _alike(shares)
    if rivals:
        yield _undecided(diagnosis.laws[0], rivals)


def _cause_text(diagnosis: PendulumDiagnosis, concluded: PendulumConclusion, cause: str) -> str:
    if math.isfinite(diagnosis.foretells):
        return cause_statement(cause, diagnosis.foretells, certain=concluded.adds)
    heading = "the cause" if concluded.adds else "the cause cannot be told; likeliest cause"
    return f"{heading}: {cause}"


def _strange(concluded: PendulumConclusion) -> str:
    return f"that it is {OUTSIDE} has probability {concluded.unknown:.2f}"


def _no_gap(diagnosis: PendulumDiagnosis) -> str:
    kinds = [row.kind for row in diagnosis.gap_by_kind if row.out_of_tolerance]
    if kinds:
        return f"Nothing that was considered explains the difference in {' and '.join(kinds)}"
    off = any(row.gap for row in diagnosis.gap_by_kind)
    once = " once what is known within tolerances is fitted," if off else ""
    return f"No gap: the record and its simulation agree{once} within what the record can tell"


def _turned_sentence(runs: Sequence[str]) -> str:
    subject, verb = ("Records", "are") if len(runs) > 1 else ("Record", "is")
    sign = "half a turn off: the force or the reading has the other sign there"
    return f"{subject} {' and '.join(runs)} {verb} {sign}"


def _alike_names(concluded: PendulumConclusion, name: str) -> tuple[str, ...]:
    """Return a cause with what these records cannot tell from it, where it is named at all."""
    return tuple(concluded.alike_causes.get(name, (name,))) if concluded.adds else (name,)


def _alike(shares: Mapping[str, float]) -> str:
    said = [f"{name} ({share:.2f})" for name, share in shares.items()]
    more = [f"{len(said) - _ALIKE} others"] if len(said) > _ALIKE else []
    return f"{listed([*said[:_ALIKE], *more])} cannot be told apart by these records"


def _damping(laws: Sequence[DampingLaw], rivals: Sequence[DampingLaw], names: Sequence[str]) -> str:
    """Return the law, or only that it is damping, as far as the laws can be told apart."""
    if not rivals:
        return " and ".join(name for name in names if name in DAMPING)
    possible = [law.hypothesis.names for law in (laws[0], *rivals)]
    return FASTER if all(set(causes) & set(BEYOND_LINEAR) for causes in possible) else "damping"


def _undecided(first: DampingLaw, rivals: Sequence[DampingLaw]) -> str:
    return (
        f"its law cannot be told: {first.name} is the most probable, but it cannot be told apart "
        f"from {', '.join(law.name for law in rivals)}"
    )


def how_large_it_is(diagnosis: PendulumDiagnosis) -> str:
    """Return by how much the simulation as it is stated is off, and the cause's own size."""
    sizes = [*_largest(diagnosis, _DECAY, _amplitude), *_largest(diagnosis, _PERIOD, _phase)]
    named = fitted(diagnosis.settled.best) if conclusion_of(diagnosis).adds else ()
    off = f"As it is stated, the simulation is off {' and '.join(sizes)}"
    return f"{'; '.join([off, *named])}."


def _largest(
    diagnosis: PendulumDiagnosis, kind: int, said: Callable[[float], str]
) -> Iterator[str]:
    """Yield the largest difference of a kind in its own unit, and where; nothing of no data."""
    problem, difference = diagnosis.problem, _stated(diagnosis)
    rows = np.flatnonzero(problem.kind == kind)
    if rows.size:
        at = int(rows[np.argmax(np.abs(difference[rows]))])
        trial = problem.trials[problem.trial[at]]
        yield f"{said(float(difference[at]))} ({trial.name}, {problem.centre_s[at]:.3g} s)"


def _stated(diagnosis: PendulumDiagnosis) -> FloatArray:
    """Return measured less simulated as it is stated: logarithms of amplitudes, rad of phases."""
    return as_stated(diagnosis.problem) * diagnosis.problem.uncertainty


def _amplitude(log_ratio: float) -> str:
    return f"by up to {_two_digits(100.0 * abs(math.expm1(log_ratio)))} % of its amplitude"


def _phase(size_rad: float) -> str:
    return f"by up to {_two_digits(abs(math.degrees(size_rad)))} degrees of a swing in phase"


def _two_digits(value: float) -> str:
    """Return a number with two digits that tell, and no power of ten."""
    return f"{float(f'{value:.2g}'):g}"


def what_to_do(diagnosis: PendulumDiagnosis, concluded: PendulumConclusion) -> str:
    """Return what to do next."""
    tell = _told_by(concluded) or _would_tell(diagnosis)
    if concluded.adds:
        put = 'put it into the simulation with "pmm gap add-pendulum", and look again'
        return f"{tell}; or {put}." if tell else f"{put[0].upper()}{put[1:]}."
    odd = " and ".join(concluded.turned) or concluded.odd
    if odd:
        return f"Correct {odd}, or leave it out of the file, and look again."
    if concluded.verdict == NONE and not any(row.out_of_tolerance for row in diagnosis.gap_by_kind):
        return "Nothing has to be done."
    return f"{tell or 'Look at what remains, below, and record longer or from another release'}."


def _told_by(concluded: PendulumConclusion) -> str:
    """Return the measurements that tell apart what these records cannot; empty if none is known."""
    how: dict[str, tuple[str, ...]] = {}
    for names in concluded.alike_causes.values():
        how |= separating_measurements([name.partition(" of ")[0] for name in names])
    return "; ".join(f"Tell {listed(names)} apart by {what}" for what, names in how.items())


def _would_tell(diagnosis: PendulumDiagnosis) -> str:
    """Return the record that would tell the leading answers apart; empty where all is told."""
    if not (diagnosis.rivals and diagnosis.proposals):
        return ""
    first = diagnosis.proposals[0]
    if first.gain > math.log(TOLD_APART):
        return f"Make the record that would tell it: {first.record}"
    return f"No further record within reach would tell it: {first.record} comes nearest"
