"""Effects at a wanted size, and the nuisances that no rig is without."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tests.sealed.generator.catalogue import BY_NAME
from tests.sealed.generator.effect import Effect
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.signatures import Projection, Situation

# A nuisance stays below this, in sigma after projection.
INVISIBLE = 0.8
_NUISANCES = ("speed-ripple", "zero-drift", "hum", "carriage-fluctuation")


@dataclass(frozen=True)
class Sized:
    """An effect at a size, with what a case drew for it, and its norm in sigma."""

    effect: Effect
    size: float
    drawn: Mapping[P, float]
    snr: float

    def put(self, p: FloatArray) -> FloatArray:
        """Return the parameters with the effect in them."""
        return self.effect.put(p, self.size, self.drawn)

    @property
    def equivalent(self) -> dict[str, float]:
        """The catalogue's parameter that comes nearest, where the two mean the same."""
        return {self.effect.parameter: self.size} if self.effect.parameter else {}


def sized(
    situation: Situation,
    projection: Projection,
    effect: Effect,
    wanted: float,
    rng: np.random.Generator,
    steps: int = 3,
) -> Sized:
    """Return an effect whose signature's norm comes near ``wanted``, within plausible sizes."""
    drawn = effect.draw(rng)
    sign = -1.0 if effect.signed and rng.random() < 0.5 else 1.0
    size, snr = sign * effect.typical, 0.0
    for step in range(1 if effect.fixed else steps):
        size, signature = situation.tamed(effect, size, drawn)
        snr = projection.snr(signature)
        close = 0.8 < snr / wanted < 1.25 or (abs(size) == effect.top and snr < wanted)
        if effect.fixed or close or step == steps - 1:
            break
        size = sign * min(abs(size) * wanted / max(snr, 1e-9), effect.top)
    return Sized(effect, size, drawn, snr)


def nuisances(
    situation: Situation, projection: Projection, rng: np.random.Generator
) -> tuple[Sized, ...]:
    """Return ripple, drift, hum and an uneven carriage, each below one sigma."""
    out = []
    for name in _NUISANCES:
        effect, wanted = BY_NAME[name], float(rng.uniform(0.2, INVISIBLE))
        drawn = effect.draw(rng)
        snr = projection.snr(situation.signature(effect, effect.typical, drawn))
        if snr > 1e-6:
            share = min(wanted / snr, 1.0)
            out.append(Sized(effect, share * effect.typical, drawn, share * snr))
    return tuple(out)
