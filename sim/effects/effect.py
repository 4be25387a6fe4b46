"""An effect's interface: name, parameters with ranges, change to the rig, predicted signature."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import ClassVar, Self, TypeAlias

from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.parameter import OneSign, Parameter, check_ranges, parameter, parameters_of
from sim.effects.situation import Situation
from sim.rig import SimulatedRig

__all__ = [
    "DeviationTrace",
    "Effect",
    "FurtherMeasurement",
    "Lines",
    "OneSign",
    "Parameter",
    "Signature",
    "StageName",
    "parameter",
]

Signature: TypeAlias = Mapping[tuple[str, int], complex]
"""Change of a channel's harmonic, by channel name and order: ``H = S + i C``, the mean as order 0.

What is not named does not change, to the order of the theory.
"""

Lines: TypeAlias = Mapping[tuple[str, float], complex]
"""What an effect adds beside the harmonics, by channel name and frequency in Hz.

``S + i C`` of ``S sin(2 pi f t) + C cos(2 pi f t)``, with t from the first sample of the run.
"""


class StageName(StrEnum):
    """The link of the chain in which an effect acts."""

    DRIVE = "drive"
    MECHANISM = "mechanism"
    STRUCTURE = "structure"
    MODEL = "model and water"
    DYNAMOMETERS = "dynamometers"
    ACQUISITION = "acquisition"
    PHOTOCELL = "photocell"
    CARRIAGE = "carriage"


class DeviationTrace(StrEnum):
    """Kinds of deviation from the simulation that a recording may show beyond noise."""

    STEADY = "steady"  # means, harmonics and the frequency, whatever the channel
    MEAN = "mean"
    TREND = "trend"  # a mean that changes over a run
    PULSES = "pulses"  # of the photocell, that are missing
    PERIODS = "periods"  # their scatter
    CYCLES = "cycles"  # their harmonics' scatter
    BESIDE = "beside"  # lines and power between the harmonics
    MOTION = "motion"  # of struts or shaft
    SHAFT = "shaft"  # it turns unevenly, or at another frequency


class FurtherMeasurement(StrEnum):
    """Measurements besides oscillations that tell effects apart."""

    REST = "rest"
    CHECK_WEIGHT = "check-weight"
    INJECTION = "injection"  # of a signal in place of the bridges
    PRELOAD = "preload"  # a dead weight that takes up play


@dataclass(frozen=True)
class Effect(ABC):
    """One effect; a subclass is a frozen dataclass whose fields are made by :func:`parameter`.

    Attributes
    ----------
    code
        Its number in the literature of the field's effects, for example ``"S3"``.
    name
        What a user types, for example ``"coulomb-friction"``.
    title
        One line for people.
    stage
        Where it acts.
    repeats
        False where it does not repeat with the shaft, so that the periodic steady state has no part
        of it: its signature, if it has one, is what an average over a record finds, as its own
        description says.
    changes_others
        True for one that changes what all others do, too: it is switched on after them.
    by_chance
        True for one that does not repeat, and changes a harmonic by its phase or by luck, as likely
        to the one side as to the other: nobody can tell it beforehand.
    costly
        True for one that repeats, but is run in time until it does: it has to promise more than
        others do before a diagnosis fits it.
    shows_in
        For one that takes long to simulate: at least one of these deviates where it is at work, or
        a diagnosis does not look at it. If empty it is always looked at; what does not repeat,
        where anything deviates.
    shown_by
        For one that does not repeat: measurements besides oscillations that show it. Of what
        repeats the simulation tells.
    taken_up
        True for play that a dead weight on the model takes up.

    Raises
    ------
    ConfigurationError
        If a parameter lies outside its plausible range; the message gives the range.
    """

    code: ClassVar[str]
    name: ClassVar[str]
    title: ClassVar[str]
    stage: ClassVar[StageName]
    repeats: ClassVar[bool] = True
    changes_others: ClassVar[bool] = False
    by_chance: ClassVar[bool] = False
    costly: ClassVar[bool] = False
    shows_in: ClassVar[tuple[DeviationTrace, ...]] = ()
    shown_by: ClassVar[tuple[FurtherMeasurement, ...]] = ()
    taken_up: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_ranges(self)

    @classmethod
    def parameters(cls) -> tuple[Parameter, ...]:
        """Return the parameters, in order."""
        return parameters_of(cls)

    @classmethod
    def nearest(cls, name: str, value: float) -> float:
        """Return what is nearest to a value within a parameter's plausible range.

        A campaign may last longer than an effect goes on.
        """
        declared = next(one for one in cls.parameters() if one.name == name)
        return min(max(value, declared.low), declared.high)

    @abstractmethod
    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this effect, for a run at a set-point; the rig given stays as it was.

        What the rig has of the same kind already is added to, so that several effects compose.
        """

    @abstractmethod
    def signature(self, situation: Situation) -> Signature:
        """Return what theory predicts to first order: the change against the nominal rig.

        For tests, documentation and display only: nothing that diagnoses uses it.
        """

    def forms(self) -> "tuple[Effect, ...]":
        """Return the same effect, at the same size, in other forms of its family; most have none.

        One for each value that a parameter states as another form, the others left as they are. The
        size is the first harmonic's at the motion of :mod:`sim.effects.typical`, within a fifth.
        """
        return tuple(
            replace(self, **{parameter.name: form})
            for parameter in self.parameters()
            for form in parameter.forms
            if form != getattr(self, parameter.name)
        )

    def change_set_point(self, set_point: SetPoint, run_index: int) -> SetPoint:
        """Return the set-point that is really run; most effects leave it."""
        return set_point

    def lines(self, situation: Situation) -> Lines:
        """Return what theory predicts beside the multiples of the shaft's frequency.

        Most effects repeat with the shaft and have no such lines.
        """
        return {}

    def at_run(self, run: CampaignRun) -> Self:
        """Return the effect as it is during one run of a campaign; most are always the same.

        One that builds up or dies out over a campaign takes its own parameters for the time from
        the run's place, so that a run by itself is described by the parameters alone.
        """
        return self
