"""Effects on the light gates that time a body's passages."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from hardware.description.errors import ConfigurationError
from sim.effects.parameter import parameter
from sim.pendulum.bench import PendulumBench
from sim.pendulum.photogate import Photogate


@dataclass(frozen=True)
class FlagWidth:
    """A flag of another width in the photogates."""

    flag_width_m: float = parameter(0.01, 1e-4, 0.1, "m", "its width")

    name = "flag_width"
    stage = "photogate"
    summary = "blocked while the flag is in the beam"
    signature = "edges lie width/speed apart; single edges are early or late"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _gates(bench, self.name, lambda gate: replace(gate, flag_width_m=self.flag_width_m))


@dataclass(frozen=True)
class GateOffset:
    """A beam beside the rest position."""

    beam_offset_m: float = parameter(
        0.002, -0.05, 0.05, "m", "how far the beam is from where the flag hangs"
    )

    name = "gate_offset"
    stage = "photogate"
    summary = "the beam is not where the flag hangs"
    signature = "half-swings alternate by T/pi asin(offset/A), more as A falls"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _gates(
            bench, self.name, lambda gate: replace(gate, beam_offset_m=self.beam_offset_m)
        )


@dataclass(frozen=True)
class MissedPassages:
    """Passages that a photogate does not notice."""

    missed_share: float = parameter(0.02, 0.0, 0.3, "1", "probability of each")

    name = "missed_passages"
    stage = "photogate"
    summary = "both edges of a passage are lost, at random"
    signature = "gaps of two or more half-swings"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _gates(bench, self.name, lambda gate: replace(gate, missed_share=self.missed_share))


@dataclass(frozen=True)
class GateJitter:
    """Edges that come a little early or late."""

    jitter_rms_s: float = parameter(1e-4, 0.0, 0.01, "s", "standard deviation of an edge's delay")

    name = "gate_jitter"
    stage = "photogate"
    summary = "random delay of each edge"
    signature = "white scatter of passage times"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _gates(bench, self.name, lambda gate: replace(gate, jitter_rms_s=self.jitter_rms_s))


def _gates(
    bench: PendulumBench, effect: str, change: Callable[[Photogate], Photogate]
) -> PendulumBench:
    if not bench.photogates:
        raise ConfigurationError(f"{effect}: this test has no photogate; add one, or leave it out")
    return replace(bench, photogates=tuple(change(photogate) for photogate in bench.photogates))
