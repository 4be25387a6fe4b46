"""How well each component is known: the scatter of one run is few numbers, that of all is not.

A run of six periods knows its own scatter to 30 %; taken at its word it calls small deviations
large or large ones small. The noise of a channel is much the same in all runs, so each run's own
variance is drawn towards what the lines between the harmonics of all runs say, at the run's own
level where runs differ (:mod:`analysis.gap.observe.spectrum`), or, where there are none, the
scatter of all runs. No mean and no trend is known better than the zero's wander between records at
rest allows, or its tolerance where there are none.
"""

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.gap.forward.simulator import DRAWS
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import SETTLING, STEADY_PARTS, TRENDS, Component, GapRun, Part
from analysis.gap.observe.sensors import heard_rms
from analysis.gap.observe.spectrum import Loudness, levels, loudness
from analysis.gap.observe.wander import wander, wandered
from hardware.description.channels import SHAFT_ANGLE
from sim.acquisition.channels import Digitiser
from sim.rig import SimulatedRig

# Of the first harmonic of the channel: what a simulation by harmonics does not promise to hold.
SIMULATION: Final = 3e-6
# Of an encoder whose steps nobody stated: they do not average out of a shaft that turns evenly.
ENCODER_RAD: Final = 3e-5
_FREEDOM = 12.0  # numbers by which the usual scatter of the cycles is known
_LINES_FREEDOM = 60.0  # and the usual power between the harmonics
# What is simulated in time has noise of its own, as large as the record's in each of its draws.
RECORDS: Final = (1.0 + 1.0 / DRAWS) ** 0.5
_POOLED: Final = frozenset({*STEADY_PARTS, *TRENDS})
_OF_HARMONICS: Final = frozenset({Part.IN_PHASE, Part.QUADRATURE, *SETTLING})


def pooled(runs: Sequence[GapRun], rig: SimulatedRig, tolerances: Tolerances) -> tuple[GapRun, ...]:
    """Return the runs with uncertainties that borrow strength from each other.

    The rig's encoder says what its steps leave in the shaft's harmonics.
    """
    usual = Usual.of(runs)
    encoder_rad = encoder_floor_rad(rig.acquisition.shaft_angle, heard_rms(runs, SHAFT_ANGLE.name))
    wandering = wander(rig, runs, tolerances.wander)
    return tuple(wandered(_with_usual_noise(run, usual, encoder_rad), wandering) for run in runs)


@dataclass(frozen=True, eq=False)
class ChannelNoise:
    """What lies between the harmonics of one channel.

    Attributes
    ----------
    overall
        Of all runs.
    by_run
        By run, the logarithm of its power over what all runs say, and its variance.
    """

    overall: Loudness
    by_run: Mapping[str, tuple[float, float]]


def channel_noise(runs: Sequence[GapRun]) -> dict[str, ChannelNoise]:
    """Return what the lines of all runs say of each channel that has enough of them."""
    names = dict.fromkeys(name for run in runs for name in run.observed.quiet)
    noises = {}
    for name in names:
        quiet_runs = [run for run in runs if name in run.observed.quiet]
        lines = [run.observed.quiet[name] for run in quiet_runs]
        together = loudness(lines)
        if together is not None:
            run_levels = levels(lines, together)
            each = zip(run_levels.values, run_levels.variances, strict=True)
            by_run = dict(zip((run.name for run in quiet_runs), each, strict=True))
            noises[name] = ChannelNoise(together, by_run)
    return noises


@dataclass(frozen=True, eq=False)
class Usual:
    """What the runs together say of each channel's noise.

    Attributes
    ----------
    loud
        By channel, from the lines between the harmonics.
    scatter
        By channel and kind, from the scatter of the cycles: as a power density.
    """

    loud: Mapping[str, ChannelNoise]
    scatter: Mapping[tuple[str, Part, int], float]

    @classmethod
    def of(cls, runs: Sequence[GapRun]) -> "Usual":
        """Ask all runs."""
        densities: dict[tuple[str, Part, int], list[float]] = defaultdict(list)
        for run in runs:
            for key, density in _densities(run):
                densities[key].append(density)
        return cls(
            channel_noise(runs),
            {key: float(np.median(values)) for key, values in densities.items()},
        )

    def variance(self, component: Component, run: GapRun) -> tuple[float, float] | None:
        """Return a component's usual variance, and how many numbers it is known by."""
        share = _share(component.part, run)
        if component.channel in self.loud:
            # A trend is half a wave over the whole record.
            order = component.order or (0.5 / run.periods if component.part is Part.TREND else 0)
            heard = self.loud[component.channel]
            density = heard.overall.at(order * run.set_point.frequency_hz)
            twice = component.part in _OF_HARMONICS
            level, variance = heard.by_run.get(run.name, (0.0, 0.0))
            freedom = 1.0 / (1.0 / _LINES_FREEDOM + 0.5 * variance)
            return density * math.exp(level) * share * (2.0 if twice else 1.0), freedom
        key = _kind(component)
        return (self.scatter[key] * share, _FREEDOM) if key in self.scatter else None


def _kind(component: Component) -> tuple[str, Part, int]:
    """Return the class within which noise is alike: mean, trend, low orders, high orders."""
    alone = component.part in (Part.MEAN, Part.TREND)
    return component.channel, component.part if alone else Part.IN_PHASE, min(component.order, 2)


def _share(part: Part, run: GapRun) -> float:
    """Return the variance of a component per power density of white noise, in Hz.

    That of a line through the periods' means, for a trend per period.
    """
    frequency_hz, count = run.set_point.frequency_hz, run.periods
    if part in TRENDS:
        return 12.0 * frequency_hz / (count * (count**2 - 1.0))
    return frequency_hz / count


def _densities(run: GapRun) -> list[tuple[tuple[str, Part, int], float]]:
    observation = run.observed
    return [
        (_kind(component), float(sigma**2) / _share(component.part, run))
        for component, sigma in zip(observation.components, observation.uncertainty, strict=True)
        if component.part in _POOLED and component.channel and np.isfinite(sigma)
    ]


def _with_usual_noise(run: GapRun, usual: Usual, encoder_rad: float) -> GapRun:
    observation = run.observed
    own_freedom = max(run.periods - 2.0, 0.0)
    uncertainty = observation.uncertainty.copy()
    for at, component in enumerate(observation.components):
        pooled = usual.variance(component, run) if component.part in _POOLED else None
        if pooled is not None:
            pooled_variance, pooled_freedom = pooled
            run_variance = uncertainty[at] ** 2 if np.isfinite(uncertainty[at]) else 0.0
            freedom = own_freedom if run_variance else 0.0
            variance = (freedom * run_variance + pooled_freedom * pooled_variance) / (
                freedom + pooled_freedom
            )
            # Pulses that scatter move harmonics, not what lies between.
            if component.part in SETTLING:
                variance = max(variance, run_variance)
            floor = 0.0 if component.part in TRENDS else _floor(run, component.channel, encoder_rad)
            uncertainty[at] = np.sqrt(variance + floor**2)
        if component.part not in (*STEADY_PARTS, *SETTLING):
            uncertainty[at] *= RECORDS
    return replace(run, observed=replace(observation, uncertainty=uncertainty))


def _floor(run: GapRun, channel: str, encoder_rad: float) -> float:
    if channel == SHAFT_ANGLE.name:
        return encoder_rad
    observation = run.observed
    parts = [observation.value(channel, part, 1) for part in (Part.IN_PHASE, Part.QUADRATURE)]
    return SIMULATION * math.hypot(*parts) if np.isfinite(parts).all() else 0.0


def encoder_floor_rad(encoder: Digitiser | None, recorded_rms: float = 0.0) -> float:
    """Return the largest line that an encoder's steps leave in an even turn, in rad.

    The error of rounding to steps of q is a saw of first amplitude q / pi; noise of standard
    deviation s ahead of it leaves exp(-2 pi² s² / q²) of it (Widrow and Kollár 2008, the
    characteristic function of the quantiser's input at 2 pi / q).

    Parameters
    ----------
    recorded_rms
        Of the noise in the records, white or coloured, with the rounding's own q² / 12; 0 where
        there are too few lines, and the noise is the one that is stated.
    """
    if encoder is None or not encoder.resolution:
        return ENCODER_RAD
    dither = encoder.noise_rms / encoder.resolution
    if recorded_rms:
        dither = math.sqrt(max((recorded_rms / encoder.resolution) ** 2 - 1.0 / 12.0, 0.0))
    return encoder.resolution / math.pi * math.exp(-2.0 * (math.pi * dither) ** 2)
