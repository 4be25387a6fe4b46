"""What a case holds: drawn by kind, with the right answers that go with it."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from tests.sealed.generator.background import QUIET_PARTS, Background
from tests.sealed.generator.catalogue import BY_NAME
from tests.sealed.generator.ceiling import applicable
from tests.sealed.generator.design import Campaign
from tests.sealed.generator.effect import Effect
from tests.sealed.generator.outside import ABOVE, ALSO_RIGHT, OUTSIDE, TWINS
from tests.sealed.generator.parameters import FloatArray
from tests.sealed.generator.signatures import Projection, Situation
from tests.sealed.generator.sizing import INVISIBLE, Sized, sized
from tests.sealed.generator.worlds import World

if TYPE_CHECKING:
    from collections.abc import Callable

Kind = Literal["none", "friction-above", "coefficients", "single", "pair", "outside", "twin"]
Verdict = Literal["none", "coefficients", "gap", "unknown"]

CASE_KINDS: dict[Kind, float] = {
    "none": 0.08,
    "friction-above": 0.06,
    "coefficients": 0.06,
    "single": 0.45,
    "pair": 0.15,
    "outside": 0.15,
    "twin": 0.05,
}
GAP_KINDS: dict[Kind, float] = {"single": 0.46, "pair": 0.15, "outside": 0.34, "twin": 0.05}
"""Of the worlds whose cases all have a gap."""
NULL_KINDS: dict[Kind, float] = {"none": 0.8, "friction-above": 0.2}
COEFFICIENTS = ("added-mass-error", "damping-error")
DETERMINABLE = 3.0


class NothingFitsError(ValueError):
    """What was drawn does not go together: no effect fits this rig."""


@dataclass(frozen=True)
class Content:
    """What is there, and what is right to say of it.

    Attributes
    ----------
    right
        Right answers, each a sorted tuple of effects' names; the empty one is "none".
    separated_by
        The further run that tells twins apart: a special run's kind, or a medium.
    """

    kind: Kind
    verdict: Verdict
    effects: tuple[Sized, ...]
    right: tuple[tuple[str, ...], ...]
    stages: tuple[str, ...]
    separated_by: str | None = None

    def without_size(self, p: FloatArray) -> FloatArray:
        """Return the parameters with what the effects bring before they have a size.

        What no answer is to name, friction above the dynamometers, is there as it is.
        """
        for found in self.effects:
            if self.verdict == "none":
                p = found.put(p)
            elif found.effect.own_base:
                p = found.effect.put(p, 0.0, found.drawn)
        return p


def drawn_kind(rng: np.random.Generator, where: World, *, null: bool) -> Kind:
    """Return a kind with its share as probability."""
    gaps = GAP_KINDS if "clear_snr" in where else CASE_KINDS
    shares = NULL_KINDS if null else gaps
    kinds = list(shares)
    return kinds[int(rng.choice(len(kinds), p=list(shares.values())))]


def wanted_snr(rng: np.random.Generator, where: World) -> float:
    """Return an SNR: evenly on a logarithmic scale from 2 to 200, or as the world has it."""
    if "clear_snr" not in where:
        return float(np.exp(rng.uniform(np.log(2.0), np.log(200.0))))
    return where.value("weak_snr" if where.happens("weak_share", rng) else "clear_snr", rng)


def least_snr(where: World) -> float:
    """Return the SNR below which a world has no gap."""
    return float(where.draws["weak_snr"][0]) if "weak_snr" in where else 0.0


@dataclass(frozen=True)
class Drawing:
    """What the contents of a case are drawn from."""

    campaign: Campaign
    situation: Situation
    projection: Projection
    background: Background
    rng: np.random.Generator

    def _one(self, pool: list[Effect], wanted: float, tries: int = 5) -> Sized:
        """Return an effect of the pool with half of what is wanted, or the last quiet one.

        One that does not show at all in these runs, a saturation that they do not reach, is none.
        """
        kept = None
        for i in self.rng.permutation(len(pool))[:tries]:
            found = sized(self.situation, self.projection, pool[i], wanted, self.rng)
            if self.background.of_parts(found) > QUIET_PARTS or found.snr < INVISIBLE:
                continue
            kept = found
            if 0.5 * wanted < found.snr < 2.0 * wanted:
                break
        if kept is None:
            raise NothingFitsError(f"no effect in {tries} tries whose own parts stay unseen")
        return kept

    def _wanted(self) -> float:
        return wanted_snr(self.rng, self.campaign.world)

    def _pool(self, effects: tuple[Effect, ...]) -> list[Effect]:
        return [
            effect
            for effect in effects
            if effect.name not in COEFFICIENTS and applicable(effect, self.campaign)
        ]

    def draw(self, kind: Kind) -> Content:
        """Return the content of a case of this kind."""
        contents: dict[Kind, Callable[[], Content]] = {
            "none": self._none,
            "friction-above": self._friction_above,
            "coefficients": self._coefficients,
            "single": self._single,
            "pair": self._pair,
            "outside": self._outside,
            "twin": self._twin,
        }
        return contents[kind]()

    def _none(self) -> Content:
        return Content("none", "none", (), ((),), ())

    def _friction_above(self) -> Content:
        effect = sized(self.situation, self.projection, ABOVE, INVISIBLE, self.rng)
        return Content("friction-above", "none", (effect,), ((),), ())

    def _coefficients(self) -> Content:
        pool = [BY_NAME[name] for name in COEFFICIENTS]
        effects = tuple(sized(self.situation, self.projection, e, 5.0, self.rng) for e in pool)
        return Content(
            "coefficients",
            "coefficients",
            effects,
            (*((name,) for name in COEFFICIENTS), COEFFICIENTS),
            (BY_NAME[COEFFICIENTS[0]].stage,),
        )

    def _single(self) -> Content:
        found = self._one(self._pool(self.campaign.effects), self._wanted())
        return Content("single", "gap", (found,), ((found.effect.name,),), (found.effect.stage,))

    def _pair(self) -> Content:
        pool = self._pool(self.campaign.effects)
        wanted = max(self._wanted(), 8.0)
        first = self._one(pool, wanted)
        others = [e for e in pool if e.name != first.effect.name and not e.rebased]
        second = self._one(others, wanted * float(self.rng.uniform(0.6, 1.6)))
        if self.rng.random() < 0.5:
            second = self._against(first, second)
        names = tuple(sorted(x.effect.name for x in (first, second)))
        stages = tuple(sorted({x.effect.stage for x in (first, second)}))
        return Content("pair", "gap", (first, second), (names,), stages)

    def _against(self, first: Sized, second: Sized) -> Sized:
        """Return the second with the sign that takes from the first, where it has a sign."""
        if not second.effect.signed:
            return second
        one, two = (
            self.projection.left(self.situation.signature(x.effect, x.size, x.drawn))
            for x in (first, second)
        )
        return replace(second, size=-second.size) if float(one @ two) > 0.0 else second

    def _outside(self) -> Content:
        found = self._one(self._pool(OUTSIDE), max(self._wanted(), 5.0))
        also = tuple((name,) for name in ALSO_RIGHT.get(found.effect.name, ()))
        return Content("outside", "unknown", (found,), also, (found.effect.stage,))

    def _twin(self) -> Content:
        there = [twin for twin in TWINS if applicable(twin.effect, self.campaign)]
        twin = there[int(self.rng.integers(len(there)))]
        found = sized(
            self.situation, self.projection, twin.effect, max(self._wanted(), 5.0), self.rng
        )
        right = tuple((name,) for name in twin.right)
        return Content("twin", twin.verdict, (found,), right, twin.stages, twin.separated_by)
