"""What a stage of the chain is: signals in, signals out, and a state that is a value."""

from dataclasses import dataclass
from typing import Any, Protocol, TypeVar, runtime_checkable

import numpy as np

from hardware.description.arrays import FloatArray
from sim.signals import Signal, Signals
from sim.solve.period import Period, Spectra

StateT = TypeVar("StateT")


@dataclass(frozen=True)
class Block:
    """A stretch of consecutive samples.

    Attributes
    ----------
    first
        Number of the first sample; the run starts with sample 0 at time 0. Times follow from the
        sample's number alone, so they are the same whatever blocks a run is cut into.
    count
        Number of samples; may be 0.
    """

    first: int
    count: int
    sample_rate_hz: float

    @property
    def time_s(self) -> FloatArray:
        """Time of each sample, shape ``(count,)``."""
        return np.arange(self.first, self.first + self.count) / self.sample_rate_hz


class Stage(Protocol[StateT]):
    """One link of the chain: parameters only, usually a frozen dataclass.

    Everything that a stage remembers from one block to the next is in its state, an immutable value
    built from numbers, strings, tuples and frozen dataclasses of these (so it can be hashed), or
    ``None``. Parts of a rig that act back on each other are one stage, which reads and writes the
    signals of all of them.
    """

    @property
    def name(self) -> str:
        """Unique within a chain; effects address the stage by it."""
        ...

    @property
    def reads(self) -> tuple[Signal, ...]:
        """Signals that :meth:`run` needs, written further up the chain."""
        ...

    @property
    def writes(self) -> tuple[Signal, ...]:
        """Signals that :meth:`run` returns."""
        ...

    def start(self, sample_rate_hz: float, seed: int) -> StateT:
        """Return the state before the first sample.

        Parameters
        ----------
        seed
            The run's seed. A stage that draws random numbers derives its own stream from the seed
            and its name, so that no stage's noise depends on which other stages there are.
        """
        ...

    def run(self, state: StateT, block: Block, inputs: Signals) -> tuple[StateT, Signals]:
        """Return the state after the block and the signals written in it.

        Parameters
        ----------
        inputs
            The signals of ``reads`` over the block; never changed in place. Of the stage's own
            signals, those that are substituted are there too: a stage that is one link only may
            ignore them.
        """
        ...


@runtime_checkable
class Periodic(Protocol):
    """A stage that has a periodic steady state of its own, beside its samples."""

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the period (only a drive changes it) and the harmonics of the outputs.

        Parameters
        ----------
        inputs
            Harmonics of the signals of ``reads``, as :data:`sim.solve.period.Spectra`; of the
            stage's own signals, those that are substituted.
        """
        ...


@runtime_checkable
class Composite(Protocol):
    """A stage that solves parts together; each part is a stage that effects may change."""

    @property
    def parts(self) -> "tuple[Stage[Any], ...]":
        """The parts, in order."""
        ...

    def with_part(self, name: str, part: "Stage[Any]") -> "Stage[Any]":
        """Return the stage with one part changed."""
        ...
