"""What a diagnosis comes to: the one value from which every word about it is made.

The probabilities weigh all numbers of a campaign together, and the most probable answer is the
verdict; the walk looks at each step by itself, and the withheld runs at how much of the gap an
effect takes. Headline, tables and what is proposed all begin here.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final

from analysis.gap.inference.answers import UNKNOWN, effects_in
from pmm.gap.steps import StepRow

EFFECT: Final = "effect"
_FITS: Final = 2.0  # u: a step below it needs no coefficient to fit


@dataclass(frozen=True)
class Weighing:
    """What the evidence says.

    Attributes
    ----------
    shares
        Probabilities of the answers, most probable first.
    best
        The most probable named answer, right or not; ``""`` where none is.
    alike
        What these runs cannot tell from each of its effects.
    titles
        Effects by name in the field's words.
    takes
        Part of the withheld gap that goes away with it; NaN where nothing was withheld.
    stage
        Where the gap most probably comes from; ``""`` where there is none.
    odd_run
        The run that most probably went wrong by itself.
    restricted
        How many effects were considered, where that is not the whole catalogue.
    """

    shares: Mapping[str, float]
    best: str
    alike: Mapping[str, Sequence[str]]
    titles: Mapping[str, str]
    takes: float
    stage: str
    odd_run: str
    restricted: int | None = None


@dataclass(frozen=True)
class Conclusion:
    """What is said of a campaign, and what it rests on.

    Attributes
    ----------
    verdict
        ``"none"``, ``"coefficients"``, ``"unknown"``, ``"odd-run"`` or ``"effect"``.
    walk
        Steps along the chain.
    remains
        What is left of each with the effect that is named; with no effect where none is.
    """

    verdict: str
    weighing: Weighing
    walk: tuple[StepRow, ...]
    remains: tuple[StepRow, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The effects that the answer names; none unless ``verdict`` is ``"effect"``."""
        return (
            effects_in(self.weighing.best) if self.verdict == EFFECT and self.weighing.best else ()
        )

    @property
    def adds(self) -> bool:
        """Whether the effect is to be put into the simulation."""
        return self.verdict == EFFECT

    @property
    def fitted(self) -> bool:
        """Whether the coefficients had to be fitted for the steps to be without a gap."""
        return any(step.stated_u > _FITS for step in self.walk)

    @property
    def gap(self) -> bool:
        """Whether any step of the walk shows one."""
        return any(step.gap for step in self.walk)

    @property
    def unexplained(self) -> tuple[StepRow, ...]:
        """The steps that what is named does not explain; where that is unknown, all with a gap."""
        unknown = self.verdict == UNKNOWN
        return tuple(step for step in self.remains if step.beyond or (unknown and step.gap))

    @property
    def probability(self) -> float:
        """Of what the verdict says; of an effect with all that these runs cannot tell from it."""
        shares = self.weighing.shares
        if self.verdict != EFFECT:
            return shares.get(self.verdict, 0.0)
        return class_probability(shares, self.weighing.best, self.weighing.alike)


def class_probability(
    shares: Mapping[str, float], answer: str, alike: Mapping[str, Sequence[str]]
) -> float:
    """Return the probability of an answer, each of its effects or one alike."""
    groups = [[name, *alike.get(name, ())] for name in answer.split("+")]
    answers = {"+".join(sorted(combination)) for combination in product(*groups)}
    return min(sum(shares.get(name, 0.0) for name in answers), 1.0)


def verdict_of(weighing: Weighing) -> str:
    """Return the verdict: the most probable answer, ``"effect"`` where it names one or two."""
    best = next(iter(weighing.shares))
    return EFFECT if effects_in(best) else best
