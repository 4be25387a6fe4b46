"""What a pendulum's diagnosis comes to, in sentences; what cannot be told is said to be so."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from analysis.gap.pendulum.causes import BEYOND_LINEAR, DAMPING
from analysis.gap.pendulum.diagnose import Diagnosis
from analysis.gap.pendulum.verdict import TOLD_APART, UNKNOWN, Law, foretells_better, told_apart
from analysis.inertia.spread import said_of

FASTER: Final = "damping that grows faster than linearly"


def said(found: Diagnosis) -> tuple[str, ...]:
    """Return the answer: the cause, or that it cannot be told, and what of it is open."""
    return tuple(_said(found))


def _said(found: Diagnosis) -> Iterator[str]:
    best = found.verdict.best
    if not best:
        yield "no gap beyond u"
        return
    if best == (UNKNOWN,):
        yield "something that the catalogue does not have"
        return
    names = found.best.names
    rivals = open_laws(found.laws)
    others = [one for one in names if one not in DAMPING]
    damping = [] if len(others) == len(names) else [_damping(found.laws, rivals, names)]
    what = " and ".join([*damping, *others])
    yield said_of(what, found.foretells) if found.regimes else f"the likeliest cause: {what}"
    if rivals:
        yield from _undecided(found.laws[0], rivals)
    if found.rivals and found.proposals:
        yield _would_tell(found)


def _would_tell(found: Diagnosis) -> str:
    one, other = (" + ".join(rival.names) for rival in found.rivals or ())
    first = found.proposals[0]
    told = first.gain > math.log(TOLD_APART)
    would = "what would tell it" if told else "no further record within reach would; nearest to it"
    return (
        f"{would}: {first.what}, expected to bring {first.gain:.1f} in ln evidence between "
        f"{one} and {other}"
    )


def open_laws(laws: Sequence[Law]) -> tuple[Law, ...]:
    """Return the laws of damping that cannot be told from the one of the best evidence."""
    return tuple(law for law in laws[1:] if not told_apart(laws[0], law))


def _damping(laws: Sequence[Law], rivals: Sequence[Law], names: Sequence[str]) -> str:
    """Return the law, or only that it is damping, as far as the laws can be told apart."""
    if not rivals:
        return " and ".join(one for one in names if one in DAMPING)
    possible = [law.hypothesis.names for law in (laws[0], *rivals)]
    return FASTER if all(set(one) & set(BEYOND_LINEAR) for one in possible) else "damping"


def _undecided(first: Law, rivals: Sequence[Law]) -> Iterator[str]:
    yield (
        f"its law cannot be told: {first.name} has the best evidence, but it cannot be told apart "
        f"from {', '.join(law.name for law in rivals)}"
    )
    better = [law.name for law in rivals if foretells_better(law, first)]
    if better:
        yield f"withheld swings are foretold better by {', '.join(better)}"
