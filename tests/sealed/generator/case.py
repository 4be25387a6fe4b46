"""One case: what is believed, what is there, what was recorded, and the key to it."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tests.sealed.generator.background import Background, with_all
from tests.sealed.generator.catalogue import BY_NAME
from tests.sealed.generator.ceiling import SAME, Library, ceiling, harmonic_blocks
from tests.sealed.generator.design import Campaign, design
from tests.sealed.generator.features import (
    FREQUENCY_RELATIVE,
    PULSE_RAD,
    Reference,
    StalledError,
    reference,
)
from tests.sealed.generator.imperfect import Tolerance, imperfections
from tests.sealed.generator.kinds import (
    DETERMINABLE,
    Content,
    Drawing,
    NothingFitsError,
    drawn_kind,
    least_snr,
)
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.priors import drawn, priors
from tests.sealed.generator.rig import Record, Run
from tests.sealed.generator.sensing import record
from tests.sealed.generator.signatures import Projection, Situation
from tests.sealed.generator.sizing import Sized, nuisances
from tests.sealed.generator.water import of_speed, remembering, table_of
from tests.sealed.generator.wider import working
from tests.sealed.generator.worlds import World, world

TRIES, MORE_TRIES = 5, 20


@dataclass(frozen=True)
class Case:
    """A sealed case, made from its seed and index alone.

    Attributes
    ----------
    parameters
        The reality: nuisances and effects in it.
    background
        What is there besides the effects, all runs together, in sigma.
    """

    seed: int
    index: int
    null: bool
    campaign: Campaign
    situation: Situation
    projection: Projection
    content: Content
    always: tuple[Sized, ...]
    background: float
    parameters: FloatArray

    @property
    def name(self) -> str:
        """Name of the case's folder."""
        return f"case-{self.index:04d}"

    def recorded(self, run: Run, number: int) -> Record:
        """Return the record of a run with noise; ``number`` sets its noise apart from others'."""
        rng = np.random.default_rng([self.seed, self.index, 1, number])
        p = self.parameters.copy()
        p[P.SPEED_ERROR] += FREQUENCY_RELATIVE * float(rng.standard_normal())
        p[P.JITTER] = np.hypot(p[P.JITTER], PULSE_RAD)
        named = replace(run, name=f"{self.seed}-{self.index}-{number}")
        return record(p, named, self.campaign.rig, rng)

    @cached_property
    def withheld(self) -> tuple[tuple[Record, Reference], ...]:
        """Withheld runs as they would be without noise, each with the phase of its shaft."""
        rig = self.campaign.rig
        records = [record(self.parameters, run, rig) for run in self.campaign.held_out]
        return tuple(
            (made, reference(made, run, rig.sensors))
            for made, run in zip(records, self.campaign.held_out, strict=True)
        )

    @cached_property
    def signature(self) -> FloatArray:
        """What all effects together change in the features, nuisances taken out."""
        if not self.content.effects:
            return np.zeros(self.projection.basis.shape[0])
        p = self.situation.parameters
        for effect in self.content.effects:
            p = effect.put(p)
        return self.projection.left(self.situation.gap(p))

    @property
    def snr(self) -> float:
        """Norm of the signature, in sigma."""
        return float(np.linalg.norm(self.signature))

    @cached_property
    def templates(self) -> Library:
        """The catalogue's signatures in this campaign."""
        return Library.of(self.situation, self.projection, self.campaign)

    @cached_property
    def right(self) -> tuple[tuple[str, ...], ...]:
        """Right answers: the content's own; with twins, whatever else these runs take for it."""
        own = self.content.right
        if self.content.kind != "twin":
            return own
        known = [name for answer in own for name in answer]
        near = self.templates.imitators(self.signature, known)
        return (*own, *((name,) for name, cosine in near if cosine > SAME))

    @property
    def stages(self) -> tuple[str, ...]:
        """Right stages: the content's own, and those of what is right besides."""
        more = {BY_NAME[answer[0]].stage for answer in self.right[len(self.content.right) :]}
        return (*self.content.stages, *sorted(more - set(self.content.stages)))

    def alone(self, sized: Sized) -> float:
        """Return what is left of one member of a pair, the other and its class taken out, sigma."""
        own = self.projection.left(self.situation.signature(sized.effect, sized.size, sized.drawn))
        classes = self.templates.classes()
        rivals = {
            name
            for other in self.content.effects
            if other is not sized
            for name in classes.get(other.effect.name) or [other.effect.name]
        }
        columns = [i for i, name in enumerate(self.templates.names) if name in rivals]
        if columns:
            basis = np.linalg.qr(self.templates.units[:, columns])[0]
            own = own - basis @ (basis.T @ own)
        return float(np.linalg.norm(own))

    def reach(self) -> dict[str, Any]:
        """Return the ceiling of this case."""
        rng = np.random.default_rng([self.seed, self.index, 2])
        blocks = harmonic_blocks(self.campaign.runs, self.campaign.rig)
        return dict(ceiling(self.templates, self.signature, self.right, self.stages, blocks, rng))

    @property
    def determinable(self) -> bool:
        """Whether what is there can be seen at all."""
        return not self.content.effects or self.snr >= DETERMINABLE


def make(seed: int, index: int, *, null: bool, where: str = "A") -> Case:
    """Return case ``index`` of a seed in a world; the same of these give the same case.

    Where what is drawn stalls a shaft, no effect fits the rig, or the gap is below what the world
    has, all of it is drawn again.
    """
    for again in range(TRIES if where == "A" else MORE_TRIES):
        rng = _random(seed, index, again)
        try:
            case = _drawn(seed, index, null, world(where), rng)
            case.signature, case.withheld  # noqa: B018 (what has to turn, turns)
        except (StalledError, NothingFitsError):
            continue
        if null or case.snr >= least_snr(case.campaign.world):
            return case
    raise NothingFitsError(f"seed {seed}, case {index}: nothing fits in all tries")


def first_design(seed: int, index: int, where: str) -> Campaign:
    """Return the rig and the runs that a case is first tried with: this takes no simulation."""
    return design(_random(seed, index, 0), world(where))


def _random(seed: int, index: int, again: int) -> np.random.Generator:
    return np.random.default_rng([seed, index, 0, *([again] if again else [])])


def _drawn(seed: int, index: int, null: bool, where: World, rng: np.random.Generator) -> Case:
    campaign = design(rng, where)
    campaign, true = _truth(campaign, rng)
    situation = Situation(working(campaign.rig), campaign.runs, true)
    projection = Projection.of(situation, campaign.known)
    kind = drawn_kind(rng, where, null=null)
    background = Background(situation, projection)
    content = Drawing(campaign, situation, projection, background, rng).draw(kind)
    if "imperfections" in where:
        alone = Projection.of(situation, priors(campaign.believed))
        own = tuple(one for one in campaign.tolerances if isinstance(one, Tolerance))
        always = imperfections(where, own, situation, alone, rng)
        total = background.of(with_all(content.without_size(true), always))
    else:
        always, total = background.quieted(
            content.without_size(true), nuisances(situation, projection, rng)
        )
    p = with_all(true, (*always, *content.effects))
    return Case(seed, index, null, campaign, situation, projection, content, always, total, p)


def _truth(campaign: Campaign, rng: np.random.Generator) -> tuple[Campaign, FloatArray]:
    """Return what is true of the model and its water, and the campaign with what it believes."""
    where = campaign.world
    true = drawn(campaign.believed, priors(campaign.believed), rng)
    if "memory_per_octave" not in where:
        return campaign, true
    true = drawn(true, of_speed(where), rng, where.share("speed_sigmas"))
    true = remembering(true, campaign.runs, where, rng)
    if where.happens("table_share", rng):
        campaign = replace(campaign, table=table_of(true, where, rng))
    return campaign, true
