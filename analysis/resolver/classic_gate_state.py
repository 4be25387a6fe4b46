"""States and reading of the gated integration (:mod:`analysis.resolver.classic_gate`)."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag


class GatingState(StrEnum):
    """State of the gating circuit."""

    ARMED = "armed"  # closed; the next pulse opens it
    OPEN = "open"
    HOLD = "hold"  # closed; pulses are ignored until the reset


@dataclass(frozen=True)
class GateReading:
    """What the integrators hold.

    Attributes
    ----------
    opened_s, closed_s
        The pulses that opened and closed the gate.
    in_phase, quadrature
        ``S_n`` and ``C_n``, shape ``(channels, harmonics)``; NaN where a sample was missing.
    """

    opened_s: float
    closed_s: float
    periods: int
    in_phase: FloatArray
    quadrature: FloatArray
    flags: tuple[Flag, ...] = ()


@dataclass(frozen=True)
class IntegratorState:
    """All that the apparatus remembers; begin with ``IntegratorState(start_s)``.

    Attributes
    ----------
    start_s
        Time of the first sample.
    sample_count
        Samples taken so far.
    waiting_pulses_s
        Pulses that came ahead of their samples.
    opened_s, pulses
        The pulse that opened the gate and how many came since.
    reached
        Fractional sample number up to which ``integral`` reaches.
    integral, last
        Integral since the opening, in units of the sample spacing, and the last sample's products,
        shapes ``(channels, 2 * harmonics)``.
    reading
        The held reading; ``None`` but in HOLD.
    """

    start_s: float
    gate: GatingState = GatingState.ARMED
    sample_count: int = 0
    waiting_pulses_s: tuple[float, ...] = ()
    opened_s: float = np.nan
    pulses: int = 0
    reached: float = 0.0
    integral: FloatArray = field(default_factory=lambda: np.zeros(0))
    last: FloatArray | None = None
    reading: GateReading | None = None
