"""The carriage: how fast the rig moves along the tank."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from sim import signals
from sim.signals import Signal, Signals
from sim.stage import Block


@dataclass(frozen=True)
class Carriage:
    """A carriage that holds its speed."""

    speed_m_s: float

    name: ClassVar[str] = "carriage"
    reads: ClassVar[tuple[Signal, ...]] = ()
    writes: ClassVar[tuple[Signal, ...]] = (signals.CARRIAGE_SPEED,)

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the speed does not change."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:  # noqa: ARG002
        """Return the carriage speed over the block."""
        return state, {signals.CARRIAGE_SPEED.name: np.full(block.count, self.speed_m_s)}
