"""One case: what is believed, what is there, what was recorded, and the key to it."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tests.sealed.generator.background import Background
from tests.sealed.generator.ceiling import Library, ceiling, harmonic_blocks
from tests.sealed.generator.design import Campaign, design
from tests.sealed.generator.features import FREQUENCY_RELATIVE, PULSE_RAD
from tests.sealed.generator.kinds import DETERMINABLE, Content, Drawing, drawn_kind
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.priors import drawn, priors
from tests.sealed.generator.rig import Record, Run
from tests.sealed.generator.sensing import record
from tests.sealed.generator.signatures import Projection, Situation
from tests.sealed.generator.sizing import Sized, nuisances


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

    def noise_free(self, run: Run) -> Record:
        """Return the record of a run as it would be without noise."""
        return record(self.parameters, run, self.campaign.rig)

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
        return dict(
            ceiling(
                self.templates, self.signature, self.content.right, self.content.stages, blocks, rng
            )
        )

    @property
    def determinable(self) -> bool:
        """Whether what is there can be seen at all."""
        return not self.content.effects or self.snr >= DETERMINABLE


def make(seed: int, index: int, *, null: bool) -> Case:
    """Return case ``index`` of a seed; the same two numbers give the same case."""
    rng = np.random.default_rng([seed, index, 0])
    campaign = design(rng)
    known = priors(campaign.believed)
    true = drawn(campaign.believed, known, rng)
    situation = Situation(campaign.rig, campaign.runs, true)
    projection = Projection.of(situation, known)
    kind = drawn_kind(rng, null=null)
    background = Background(situation, projection)
    content = Drawing(campaign, situation, projection, background, rng).draw(kind)
    always, total = background.quieted(
        content.without_size(true), nuisances(situation, projection, rng)
    )
    p = true
    for sized in (*always, *content.effects):
        p = sized.put(p)
    return Case(seed, index, null, campaign, situation, projection, content, always, total, p)
