"""One measured release beside its simulation."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, cast

import numpy as np

from analysis.gap.pendulum.swings import KINDS, Windows, swings_of_samples
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from sim.pendulum.bench import PendulumBench
from sim.pendulum.effects.base import PendulumEffect
from sim.pendulum.effects.setup import ReleaseError
from sim.pendulum.suspension import Suspension
from sim.signals import recorded

_SAMPLES_A_SWING = 40
_SEED = 0  # nothing random is switched on
_DECAY, _PERIOD, _MEAN = (KINDS.index(kind) for kind in ("decay", "period", "mean"))
FURTHER, TURNED = 0.05, 0.1  # a release's tolerance where it is read off the record


@dataclass(frozen=True, eq=False)
class Trial:
    """One record and the bench that is to explain it.

    Attributes
    ----------
    coordinate
        Which of the body's is watched, by a sensor channel of the same name.
    observed, uncertainty
        Shape ``(5, windows)``, as :func:`~analysis.gap.pendulum.swings.swings_of_samples` gives
        them; NaN where there is none.
    scaled
        Whether the size of the amplitude is unknown (light gates).
    variants
        Benches that the nominal one may be as well, one standard deviation away each.
    effects
        What the simulation has on already.
    run
        Name of the run, where several sensors saw one; empty where it is a run by itself.
    """

    name: str
    bench: PendulumBench
    coordinate: str
    windows: Windows
    observed: FloatArray
    uncertainty: FloatArray
    scaled: bool = False
    variants: tuple[PendulumBench, ...] = ()
    effects: tuple[PendulumEffect, ...] = ()
    run: str = ""

    driven: ClassVar[bool] = False  # by a known force; else let go

    def alike(self, other: "Trial") -> float:
        """Return how alike a deviation is in two records: of one body in one set-up, or not."""
        return float(self.bench.body == other.bench.body)

    @property
    def third_harmonic(self) -> float:
        """Share of the amplitude that a deviation of 1 is in the third harmonic."""
        return 1.0

    @property
    def acts_on(self) -> str:
        """The coordinate as effects name it: empty where the body has only one."""
        return self.coordinate if isinstance(self.bench.body, Suspension) else ""

    def simulate(self, effects: Iterable[PendulumEffect] = ()) -> FloatArray:
        """Return what the record would show with more effects on, shape ``(5, windows)``."""
        bench = self.bench.with_effects(self.placed((*self.effects, *effects)))
        rate_hz = _SAMPLES_A_SWING * self.windows.reference_rad_s / (2.0 * math.pi)
        count = _SAMPLES_A_SWING * self.windows.swings * self.windows.count + 1
        true_rate_hz = rate_hz * (1.0 + bench.clock_error)
        chain = bench.chain()
        _, run = chain.run(chain.start(true_rate_hz, _SEED), count)
        (sensor,) = (sensor for sensor in bench.sensors if sensor.channel.name == self.coordinate)
        time_s = np.arange(count) / rate_hz
        since = replace(self.windows, start_s=0.0)
        swings = swings_of_samples(time_s, run[recorded(sensor.channel).name], since)
        return self._above_noise(swings)

    def _above_noise(self, swings: FloatArray) -> FloatArray:
        """Return what is seen of swings: of those that have died out the noise, and no more."""
        gone = swings[_DECAY] < self._log_noise
        if gone.any():
            last = max(int(np.argmax(gone)) - 1, 0)
            swings[_DECAY, gone], swings[_PERIOD, gone] = self._log_noise, swings[_PERIOD, last]
            swings[_MEAN + 1 :, gone] = 0.0
        return swings

    @cached_property
    def _log_noise(self) -> float:
        """Logarithm of the amplitude's uncertainty, in its own unit; a gate does not tell it."""
        noise = self.uncertainty[_DECAY]
        known = noise > 0.0
        if self.scaled or not known.any():
            return -math.inf
        return float(np.nanmedian(self.observed[_DECAY, known] + np.log(noise[known])))

    def placed(self, effects: Iterable[PendulumEffect]) -> list[PendulumEffect]:
        """Return effects on the coordinate that is watched, where they name none."""
        return [
            replace(cast("Any", effect), coordinate=self.acts_on)
            if getattr(effect, "coordinate", None) == ""
            else effect
            for effect in effects
        ]

    def released(self) -> "Trial":
        """Return the trial with the release read off its first windows."""
        good = np.flatnonzero(np.isfinite(self.observed[0]))[:4]
        if good.size < 4:
            raise DataError(f"{self.name}: fewer than 4 windows hold data; record longer")
        at_s = self.windows.centres_s[good]
        size, phase = (np.polyfit(at_s, self.observed[kind, good], 1)[1] for kind in (0, 1))
        amplitude, omega = math.exp(float(size)), self.windows.reference_rad_s
        names = [coordinate.name for coordinate in self.bench.body.coordinates]
        held, rates = [0.0] * len(names), [0.0] * len(names)
        at = names.index(self.coordinate)
        held[at], rates[at] = amplitude * math.cos(phase), -amplitude * omega * math.sin(phase)
        release = replace(self.bench.release, displacement=tuple(held), rate=tuple(rates))
        return replace(self, bench=replace(self.bench, release=release))

    @property
    def release_columns(self) -> int:
        """How many columns of a problem its release has."""
        return 3 if self.scaled else 2

    def as_released(self, further: float, turned: float) -> "Trial":
        """Return the trial let go as its release's columns say; a size that nobody knows stays."""
        error = self.release_error(0.0 if self.scaled else FURTHER * further, TURNED * turned)
        return replace(self, bench=replace(self.bench, release=error(self.bench).release))

    def release_error(self, further: float, turned: float) -> ReleaseError:
        """Return another release of this trial."""
        return ReleaseError(further, turned, self.acts_on, self.windows.reference_rad_s)
