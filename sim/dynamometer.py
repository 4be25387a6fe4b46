"""The dynamometers: what the gauges make of the forces in the struts."""

from dataclasses import dataclass
from typing import ClassVar

from sim import signals
from sim.signals import Signal, Signals
from sim.stage import UNKNOWN_KEYS_REFUSED, Block


@dataclass(frozen=True)
class Gauge:
    """One dynamometer: reading = gain * force + offset.

    Attributes
    ----------
    full_scale_n
        Largest force that it is made for; ``None`` if unknown. Beyond it a run is flagged.
    """

    gain: float = 1.0
    offset_n: float = 0.0
    full_scale_n: float | None = None

    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Dynamometers:
    """The dynamometer at each strut, stiff and without lag."""

    aft: Gauge = Gauge()
    fore: Gauge = Gauge()

    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED
    name: ClassVar[str] = "dynamometers"
    reads: ClassVar[tuple[Signal, ...]] = (signals.FORCE_AFT, signals.FORCE_FORE)
    writes: ClassVar[tuple[Signal, ...]] = (
        signals.DYNAMOMETER_FORCE_AFT,
        signals.DYNAMOMETER_FORCE_FORE,
    )

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the gauges follow at once."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:  # noqa: ARG002
        """Return the readings of both dynamometers over the block."""
        return state, {
            out.name: gauge.gain * inputs[force.name] + gauge.offset_n
            for gauge, force, out in zip(
                (self.aft, self.fore), self.reads, self.writes, strict=True
            )
        }
