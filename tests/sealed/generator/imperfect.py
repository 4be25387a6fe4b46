"""World C: what is always on, within its tolerance and seen all the same."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.sealed.generator.effect import Effect, heavier
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.signatures import Projection, Situation
from tests.sealed.generator.sizing import Sized
from tests.sealed.generator.worlds import World

_EIGHTHS = tuple(math.pi / 4.0 * number for number in range(4))
LARGEST = 2.0  # standard deviations of a tolerance


def _shaft(p: FloatArray, size: float) -> None:
    """Let the shaft give way to the load: ``size`` is the inverse of what turns with it."""
    if size > 0.0:
        turning = float(p[P.MOTOR_INERTIA] + p[P.CRANK_INERTIA])
        heavier(p, 1.0 / (size + 1.0 / turning) / turning)


def _one(
    name: str,
    form: str,
    place: P,
    *,
    signed: bool = True,
    settles: float | None = 0.25,
    draws: tuple[tuple[P, tuple[float, float]], ...] = (),
    measured: bool = False,
) -> Effect:
    return Effect(name, "always on", form, 1.0, math.inf, {place: 1.0}, draws=dict(draws),
                  signed=signed, settles=settles, measured=measured)  # fmt: skip


_TURN = (-math.pi, math.pi)
# Tolerance by name -> what it is: one effect for each of its phases.
_KINDS: dict[str, tuple[Effect, ...]] = {
    "ripple_1_relative": (_one("ripple-1-sine", "once a revolution", P.RIPPLE_1S),
                          _one("ripple-1-cosine", "once a revolution", P.RIPPLE_1C)),
    "ripple_2_relative": (_one("ripple-2-sine", "twice a revolution", P.RIPPLE_2S),
                          _one("ripple-2-cosine", "twice a revolution", P.RIPPLE_2C)),
    "load_ripple_1_kg_m2": (Effect("shaft-under-load", "always on", "lighter shaft", 1.0, math.inf,
                                   change=_shaft, settles=None),),
    "warming_n_s": (_one("warming", "zero that warms up", P.WARMING_AFT, settles=None,
                         measured=True),),
    "hum_n": (_one("mains", "mains with its third harmonic", P.HUM, signed=False, settles=None,
                   measured=True, draws=((P.HUM_PHASE, _TURN),)),),
    "carriage_relative": (_one("uneven-carriage", "swell with a line at 1.41 times", P.SURGE,
                               signed=False, settles=None,
                               draws=((P.SURGE_HZ, (0.13, 0.9)), (P.SURGE_PHASE, _TURN))),),
}  # fmt: skip


@dataclass(frozen=True)
class Tolerance:
    """One number of what is always on, known within a standard deviation."""

    name: str
    effect: Effect
    sigma: float
    drawn: dict[P, float] = field(default_factory=dict)

    def shown(self, situation: Situation) -> FloatArray:
        """Return what one standard deviation changes, in sigma of the features.

        Nobody knows its phase: of what has one there are four columns an eighth of a turn apart,
        which make any phase of its line and of the triple of that, ``(features, 1 or 4)``.
        """
        phases = [place for place in self.drawn if place.name.endswith("PHASE")]
        turns = _EIGHTHS if phases else (0.0,)
        drawn = [{**self.drawn, **{at: self.drawn[at] + turn for at in phases}} for turn in turns]
        columns = [situation.signature(self.effect, self.sigma, each) for each in drawn]
        return np.column_stack(columns)


def tolerated(world: World, rng: np.random.Generator) -> tuple[Tolerance, ...]:
    """Return all tolerances of what is always on, with what a case draws for them."""
    return tuple(
        Tolerance(name, effect, world.tolerances[name], effect.draw(rng))
        for name, effects in _KINDS.items()
        if name in world.tolerances
        for effect in effects
    )


Snr = Callable[[FloatArray], float]


def imperfections(
    world: World,
    known: tuple[Tolerance, ...],
    situation: Situation,
    projection: Projection,
    rng: np.random.Generator,
) -> tuple[Sized, ...]:
    """Return what is always on: some kinds, each at a drawn SNR or at its tolerance's end.

    ``projection`` takes out what else is known, so that the SNR is that of the imperfection alone.
    """
    kinds = sorted({one.name for one in known})
    chosen = rng.permutation(len(kinds))[: world.count("imperfections", rng)]
    out: list[Sized] = []
    for i in sorted(chosen):
        own = [one for one in known if one.name == kinds[i]]
        weights = rng.standard_normal(len(own))
        weights /= float(np.linalg.norm(weights))
        wanted = world.value("imperfection_snr", rng)
        sizes = [
            one.sigma * (float(w) if one.effect.signed else abs(float(w)))
            for one, w in zip(own, weights, strict=True)
        ]
        snr = projection.snr(
            sum(
                (situation.signature(one.effect, size, one.drawn)
                 for one, size in zip(own, sizes, strict=True)),
                start=np.zeros_like(situation.base(None)),
            )
        )  # fmt: skip
        if snr < 1e-6:  # these runs and sensors do not show it
            continue
        share = min(wanted / snr, LARGEST)
        out += [
            Sized(one.effect, share * size, one.drawn, share * snr)
            for one, size in zip(own, sizes, strict=True)
        ]
    return tuple(out)
