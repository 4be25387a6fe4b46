"""The best that a linear matcher could do with a campaign's own runs, sensors and noise."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from tests.sealed.generator.catalogue import CATALOGUE
from tests.sealed.generator.design import Campaign
from tests.sealed.generator.effect import Effect
from tests.sealed.generator.features import ORDERS, recorded
from tests.sealed.generator.parameters import FloatArray
from tests.sealed.generator.rig import Rig, Run
from tests.sealed.generator.signatures import Projection, Situation

DRAWS = 600
FALSE_ALARM = 0.01
SAME = 0.99
VANISHES = 1e-3


def applicable(effect: Effect, campaign: Campaign) -> bool:
    """Tell whether a campaign can have an effect."""
    rod = campaign.rig.rod_length_m is not None
    wet = all(run.medium == "water" for run in campaign.runs)
    return {"yoke": not rod, "rod": rod, "wet": wet}.get(effect.needs or "", True)


@dataclass(frozen=True)
class Library:
    """Unit signatures of the catalogue's effects in one campaign, nuisances taken out."""

    effects: tuple[Effect, ...]
    units: FloatArray  # (features + nuisances, effects)
    norms: FloatArray  # at typical size

    @classmethod
    def of(cls, situation: Situation, projection: Projection, campaign: Campaign) -> Self:
        """Return the library of all effects that this rig can have and these runs can show."""
        known = [effect for effect in campaign.effects if applicable(effect, campaign)]
        return cls.out_of(known, [situation.tamed(e, e.typical)[1] for e in known], projection)

    @classmethod
    def out_of(
        cls, effects: Sequence[Effect], signatures: Sequence[FloatArray], projection: Projection
    ) -> Self:
        """Return the library of these signatures, those that vanish left out."""
        columns = [projection.left(signature) for signature in signatures]
        norms = np.array([float(np.linalg.norm(column)) for column in columns])
        seen = np.flatnonzero(norms > VANISHES)
        units = np.column_stack([columns[i] / norms[i] for i in seen])
        return cls(tuple(effects[int(i)] for i in seen), units, norms[seen])

    @property
    def names(self) -> list[str]:
        """Names of the effects, in the order of the columns."""
        return [effect.name for effect in self.effects]

    def classes(self) -> dict[str, list[str]]:
        """Return for each effect of the catalogue what these runs cannot tell from it."""
        gram = np.abs(self.units.T @ self.units)
        out: dict[str, list[str]] = {effect.name: [] for effect in CATALOGUE}
        for i, name in enumerate(self.names):
            out[name] = sorted(self.names[j] for j in np.flatnonzero(gram[i] > SAME))
        return out

    def imitators(self, signature: FloatArray, absent: Sequence[str]) -> list[tuple[str, float]]:
        """Return the cosine of a signature with each effect but those ``absent``, largest first."""
        cosines = self.units.T @ signature / max(float(np.linalg.norm(signature)), 1e-12)
        for i, effect in enumerate(self.effects):
            cosines[i] = abs(cosines[i]) if effect.signed else max(cosines[i], 0.0)
        order = np.argsort(-cosines)
        rest = [(self.names[i], float(cosines[i])) for i in order if self.names[i] not in absent]
        return rest[:5]

    def scores(self, matched: FloatArray) -> FloatArray:
        """Return what each effect explains, from products with its unit signature."""
        signed = np.array([effect.signed for effect in self.effects])
        return np.where(signed, matched, np.maximum(matched, 0.0)) ** 2

    def noise(self, rng: np.random.Generator) -> FloatArray:
        """Return products of noise with the unit signatures, ``(draws, effects)``."""
        root = np.linalg.cholesky(self.units.T @ self.units + 1e-9 * np.eye(len(self.effects)))
        return rng.standard_normal((DRAWS, len(self.effects))) @ root.T


def harmonic_blocks(runs: Sequence[Run], rig: Rig) -> list[NDArray[np.int_]]:
    """Return where the harmonics of each run's force channels lie among all features."""
    rows = recorded(rig.sensors)
    forces = sum(row in (3, 4) for row in rows)
    blocks, start = [], 0
    for run in runs:
        size = 2 * ORDERS * run.periods + 1
        own = np.arange(1, ORDERS + 1) * run.periods
        places = np.concatenate([[0], own, own + ORDERS * run.periods])
        blocks += [start + i * size + places for i, row in enumerate(rows) if row in (3, 4)]
        start += len(rows) * size + 2 * forces + 1 + run.periods
    return blocks


def unknown_power(rest: FloatArray, blocks: Sequence[NDArray[np.int_]]) -> float:
    """Return the probability that a remainder is seen: all features at once, or one block."""
    from scipy.special import chdtri, chndtr

    whole, largest = float(rest @ rest), max(float(rest[b] @ rest[b]) for b in blocks)
    few, many, part = len(blocks[0]), len(rest), FALSE_ALARM / 2.0
    missed = chndtr(chdtri(many, part), many, whole)
    missed_block = chndtr(chdtri(few, part / len(blocks)), few, largest)
    return float(1.0 - min(missed, missed_block))


def _greedy(library: Library, matched: FloatArray) -> NDArray[np.int_]:
    """Return the best two effects of each draw, the second beside the first; ``(draws, 2)``."""
    first = np.argmax(library.scores(matched), axis=1)
    beside = (library.units.T @ library.units)[first]
    own = matched[np.arange(len(first)), first]
    left = matched - beside * own[:, None]
    gain = library.scores(left) / np.maximum(1.0 - beside**2, 1e-3)
    gain[beside**2 > SAME**2] = 0.0
    return np.column_stack([first, np.argmax(gain, axis=1)])


def ceiling(
    library: Library,
    signature: FloatArray,
    right: Sequence[Sequence[str]],
    stages: Sequence[str],
    blocks: Sequence[NDArray[np.int_]],
    rng: np.random.Generator,
) -> dict[str, float | None]:
    """Return what the matcher reaches on one case; see docs/sealed.md.

    Parameters
    ----------
    signature
        Of all that is there, nuisances taken out.
    right
        Right answers, each a list of names.
    """
    noise = library.noise(rng)
    limit = np.quantile(library.scores(noise).max(axis=1), 1.0 - FALSE_ALARM)
    matched = noise + library.units.T @ signature
    scores = library.scores(matched)
    best = np.argmax(scores, axis=1)
    out: dict[str, float | None] = {"detection": float(np.mean(scores.max(axis=1) > limit))}
    classes, names = library.classes(), np.array(library.names)
    pairs = max((len(answer) for answer in right), default=0) == 2
    chosen = names[_greedy(library, matched)] if pairs else names[best][:, None]
    answers = {frozenset(answer) for answer in right}
    widened = _widened(right, classes)
    out["top_1"] = float(np.mean([frozenset(row) in answers for row in chosen]))
    out["top_1_by_class"] = float(np.mean([frozenset(row) in widened for row in chosen]))
    members = [len(classes.get(name, [])) for answer in right for name in answer]
    out["class_size"] = float(np.mean(members)) if members else None
    own = {effect.name: effect.stage for effect in library.effects}
    out["stage"] = float(np.mean([own[name] in stages for name in names[best]]))
    absent = {name for answer in right for name in answer}
    keep = [i for i, name in enumerate(library.names) if name not in absent]
    explained = library.scores((library.units.T @ signature)[None, :])[0][keep]
    top = keep[int(np.argmax(explained))]
    rest = signature - library.units[:, top] * (library.units[:, top] @ signature)
    if float(explained.max()) == 0.0:
        rest = signature
    out["unknown"] = unknown_power(rest, blocks)
    return out


def _widened(right: Sequence[Sequence[str]], classes: dict[str, list[str]]) -> set[frozenset[str]]:
    """Return all answers that are right when each name stands for its class."""
    out: set[frozenset[str]] = set()
    for answer in right:
        groups = [classes.get(name) or [name] for name in answer]
        if len(groups) == 1:
            out |= {frozenset([name]) for name in groups[0]}
        elif len(groups) == 2:
            out |= {frozenset([a, b]) for a in groups[0] for b in groups[1]}
    return out
