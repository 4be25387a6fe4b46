"""What is compared between rig and simulation, component by component."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from analysis.gap.observe.following import Following
from analysis.gap.observe.plateau import Plateau
from analysis.gap.observe.spectrum import Lines
from hardware.description.arrays import BoolArray, ComplexArray, FloatArray
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.rest import Excitation


class Part(StrEnum):
    """Which number of a channel a component is."""

    MEAN = "mean"
    IN_PHASE = "in phase"
    QUADRATURE = "quadrature"
    FREQUENCY = "frequency"  # log of the measured over the set frequency
    PULSES = "pulses"  # share of the photocell's pulses that are missing
    TREND = "trend"  # change of the mean per period
    TREND_IN_PHASE = "trend in phase"  # change of a harmonic's part per period
    TREND_QUADRATURE = "trend in quadrature"
    PERIOD_SCATTER = "period scatter"  # log of the standard deviation of the pulses' intervals
    CYCLE_SCATTER = "cycle scatter"  # log of that of a harmonic from cycle to cycle
    BETWEEN = "between the harmonics"  # log of the power in a band
    LINE = "line"  # log of the strongest line over the band's usual power
    MAINS = "line of the mains"  # amplitude of the strongest line that the mains reach


STEADY_PARTS = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE, Part.FREQUENCY)
SETTLING = (Part.TREND_IN_PHASE, Part.TREND_QUADRATURE)  # nothing of it in a steady state
TRENDS = (Part.TREND, *SETTLING)


@dataclass(frozen=True, slots=True)
class Component:
    """One number of one run.

    Attributes
    ----------
    order
        Harmonic, number of the band, or frequency of the mains in Hz; 0 for what has none.
    """

    channel: str
    part: Part
    order: int = 0

    @property
    def what(self) -> str:
        """Which number it is of a channel or a harmonic; of a line of the mains with its Hz."""
        return f"{self.part} of {self.order} Hz" if self.part is Part.MAINS else str(self.part)

    def __str__(self) -> str:
        order = "" if self.part is Part.MAINS else f"n={self.order} "
        return f"{self.channel} {order}{self.what}" if self.channel else self.what


@dataclass(frozen=True, eq=False)
class Layout:
    """Where each component of a run is found among the harmonics of its channels.

    Attributes
    ----------
    channels
        Those that are asked for.
    row, order
        Channel and harmonic of each component, shape ``(components,)``; 0 for what has none.
    real, imaginary
        Weights of a harmonic's two parts, shape ``(components,)``.
    frequency, steady
        Which components are the frequency, and which a steady state tells: what repeats with the
        shaft, and that its harmonics do not change.
    """

    channels: tuple[str, ...]
    row: NDArray[np.intp]
    order: NDArray[np.intp]
    real: FloatArray
    imaginary: FloatArray
    frequency: BoolArray
    steady: BoolArray

    @classmethod
    def of(cls, components: Sequence[Component]) -> "Layout":
        """Find each component."""
        names = tuple(
            dict.fromkeys(component.channel for component in components if component.channel)
        )
        parts = [component.part for component in components]
        harmonic = [part in (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE) for part in parts]
        pairs = list(zip(components, harmonic, strict=True))
        return cls(
            names,
            np.array(
                [
                    names.index(component.channel) if is_harmonic else 0
                    for component, is_harmonic in pairs
                ]
            ),
            np.array([component.order if is_harmonic else 0 for component, is_harmonic in pairs]),
            np.array([float(part in (Part.MEAN, Part.QUADRATURE)) for part in parts]),
            np.array([-float(part is Part.IN_PHASE) for part in parts]),
            np.array([part is Part.FREQUENCY for part in parts]),
            np.array([part in (*STEADY_PARTS, *SETTLING) for part in parts]),
        )

    @cached_property
    def _recorded(self) -> tuple[str, ...]:
        return tuple(f"recorded_{name}" for name in self.channels)

    def read(
        self, spectra: Mapping[str, ComplexArray], turn: ComplexArray | float = 1.0
    ) -> FloatArray:
        """Return each component of recorded harmonics, shape ``(components,)``; 0 for all else.

        Parameters
        ----------
        spectra
            Of a chain's signals, mean first.
        turn
            By what each order is turned.
        """
        recorded = np.array([spectra[name] for name in self._recorded]) * turn
        harmonics = recorded[self.row, self.order]
        return np.asarray(self.real * harmonics.real + self.imaginary * harmonics.imag, np.float64)


@dataclass(frozen=True, eq=False)
class Observation:
    """What one run shows.

    Attributes
    ----------
    values, uncertainty
        Of each component, and one standard deviation, shape ``(components,)``. Harmonics, trends
        and lines of the mains are in the channel's SI unit, the rest are logarithms.
    quiet
        Lines between the harmonics, by channel; empty where nobody looked.
    steps
        Smallest step of each channel's values: no less than its resolution. NaN where the channel
        does not move; empty where nobody looked.
    plateaus
        What is cut off struts and forces, by channel; empty where nobody looked.
    turns_per_period
        By how many turns the shaft's angle goes on each period, taken as rad; NaN where nobody
        looked.
    """

    components: tuple[Component, ...]
    values: FloatArray
    uncertainty: FloatArray
    quiet: Mapping[str, Lines] = field(default_factory=dict)
    steps: Mapping[str, float] = field(default_factory=dict)
    plateaus: Mapping[str, Plateau] = field(default_factory=dict)
    turns_per_period: float = math.nan

    @cached_property
    def layout(self) -> Layout:
        """Where each component is found among the harmonics."""
        return Layout.of(self.components)

    def value(self, channel: str, part: Part, order: int = 0) -> float:
        """Return one component; NaN where the run does not have it."""
        wanted = Component(channel, part, order)
        if wanted not in self.components:
            return float("nan")
        return float(self.values[self.components.index(wanted)])


@dataclass(frozen=True, eq=False)
class GapRun:
    """One run of a campaign as the diagnosis sees it.

    Attributes
    ----------
    place
        Where it stands in its campaign, for effects that build up or die out.
    periods, sample_rate_hz
        Of the stretch that was analysed: what a simulated record has to match.
    lead_s
        From the beginning of the record, where its zero was taken, to that stretch.
    stands_at_m
        Of a record at rest (:mod:`analysis.gap.observe.at_rest`): where its aft and fore strut
        stand; ``None`` where the shaft turns.
    applied
        What is done to a rig that stands; ``None`` for nothing.
    preload_n
        Of a run that turns: a dead weight on the model that takes up play in the joints.
    following
        How each strut follows its command, by the displacement's channel.
    """

    name: str
    set_point: SetPoint
    place: CampaignRun
    observed: Observation
    periods: int
    sample_rate_hz: float
    lead_s: float = 0.0
    stands_at_m: tuple[float, float] | None = None
    applied: Excitation | None = None
    preload_n: float = 0.0
    following: Following = field(default_factory=dict)

    @property
    def turns(self) -> bool:
        """Whether it oscillates: not so a record at rest."""
        return self.stands_at_m is None


@dataclass(frozen=True, eq=False)
class Stack:
    """All runs' components one after the other.

    Attributes
    ----------
    run
        Number of the run of each component, shape ``(observations,)``.
    """

    runs: tuple[GapRun, ...]
    components: tuple[Component, ...]
    run: NDArray[np.intp]
    values: FloatArray
    uncertainty: FloatArray

    @classmethod
    def of(cls, runs: Sequence[GapRun]) -> "Stack":
        """Put runs together."""
        observations = [run.observed for run in runs]
        return cls(
            tuple(runs),
            tuple(part for observation in observations for part in observation.components),
            np.repeat(
                np.arange(len(runs)), [len(observation.components) for observation in observations]
            ),
            np.concatenate([observation.values for observation in observations]),
            np.concatenate([observation.uncertainty for observation in observations]),
        )

    @property
    def turning(self) -> tuple[GapRun, ...]:
        """The runs that oscillate."""
        return tuple(run for run in self.runs if run.turns)

    @cached_property
    def steady(self) -> BoolArray:
        """Which observations a steady state tells, shape ``(observations,)``."""
        return np.concatenate([run.observed.layout.steady for run in self.runs])

    @cached_property
    def rows_by_component(self) -> dict[Component, NDArray[np.intp]]:
        """Where each component stands among the observations, over all runs that have it."""
        places: dict[Component, list[int]] = {}
        for at, component in enumerate(self.components):
            places.setdefault(component, []).append(at)
        return {component: np.array(rows) for component, rows in places.items()}
