"""Measurements beside their simulation: what every hypothesis is held against."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from analysis.gap.forward.candidate import Candidate
from analysis.gap.forward.free_numbers import Free
from analysis.gap.forward.simulator import Simulator
from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.observe.components import Part
from hardware.description.arrays import FloatArray


class ComparedProblem(Protocol):
    """Measurements beside their simulation: what hypotheses are fitted to, whatever was tested."""

    @property
    def residual(self) -> FloatArray:
        """Measured minus simulated in sigma, shape ``(observations,)``."""
        ...

    @property
    def stated(self) -> FloatArray:
        """The same of the simulation as it is stated, should it have been moved."""
        ...

    @property
    def nuisances(self) -> Nuisances:
        """What is free in every hypothesis."""
        ...

    def signature(self, parts: Sequence[Candidate], units: FloatArray) -> FloatArray:
        """Return what effects change of the observations, in sigma, shape ``(observations,)``.

        Raises
        ------
        PmmError
            If the simulator cannot run them.
        """
        ...


@dataclass(frozen=True, eq=False)
class Problem:
    """A campaign beside its simulation.

    Attributes
    ----------
    simulator
        The nominal rig and the runs.
    nuisances
        Free coefficients and noise levels.
    numbers
        Coefficients and settings to change a rig by, where effects are to act on it as its
        coefficients are.
    moved
        By how many tolerances the rig was moved from what is stated, by name.
    """

    simulator: Simulator
    nuisances: Nuisances
    numbers: tuple[Free, ...] = ()
    moved: Mapping[str, float] = field(default_factory=dict)

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the nuisances' first columns."""
        return self.nuisances.names

    @cached_property
    def residual(self) -> FloatArray:
        """Measured minus nominal in sigma, shape ``(observations,)``.

        Pulses that scatter less than is believed of any rig are no gap.
        """
        stack = self.simulator.stack
        residual = self.whitened(stack.values - self.simulator.nominal)
        pulses = np.array([component.part is Part.PERIOD_SCATTER for component in stack.components])
        if pulses.any() and residual[pulses].mean() < 0.0:
            residual[pulses] = 0.0
        return residual

    @cached_property
    def steady(self) -> FloatArray:
        """What the simulation says of what repeats with the shaft, without any effect."""
        return self.simulator.steady(())

    @cached_property
    def stated(self) -> FloatArray:
        """Measured minus the rig as it is stated, in sigma, to first order about the moved one."""
        moved = np.array([self.moved.get(name, 0.0) for name in self.free])
        shift = self.nuisances.columns[:, : len(moved)] @ moved
        return np.asarray(self.residual + shift, np.float64)

    def whitened(self, change: FloatArray) -> FloatArray:
        """Return a change of the observations in sigma."""
        return change / self.simulator.stack.uncertainty

    def signature(self, parts: Sequence[Candidate], units: FloatArray) -> FloatArray:
        """Return what effects change of the observations, as :class:`ComparedProblem` says."""
        values = self.simulator.predict(built(parts, units))
        return self.whitened(values - self.simulator.nominal)


def built(parts: Sequence[Candidate], units: FloatArray) -> tuple[Any, ...]:
    """Return the effects at some parameters."""
    if not parts:
        return ()
    cuts = np.cumsum([len(part.axes) for part in parts])[:-1]
    pieces = np.split(units, cuts)
    return tuple(part.effect(piece) for part, piece in zip(parts, pieces, strict=True))
