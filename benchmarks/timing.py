"""Times of rivals, interleaved so that a disturbance of the machine strikes all of them."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field


@dataclass
class Contender:
    """Something to time.

    Attributes
    ----------
    call
        Does the work once.
    scale
        Times the whole work that a call does a part of: 20 where it does a twentieth.
    repeats
        How often at most it is timed.
    """

    name: str
    call: Callable[[], object]
    scale: float = 1.0
    repeats: int = 1_000
    times_s: list[float] = field(default_factory=list)
    processor_times_s: list[float] = field(default_factory=list)

    @property
    def best_s(self) -> float:
        """Best time of the whole work."""
        return min(self.times_s) * self.scale

    @property
    def best_processor_s(self) -> float:
        """Best processor time of the whole work, all threads together; others' load counts less."""
        return min(self.processor_times_s) * self.scale


def interleave(contenders: list[Contender], rounds: int, report: Callable[[str], None]) -> None:
    """Time each contender once a round."""
    for k in range(rounds):
        for contender in contenders:
            if k < contender.repeats:
                report(f"{contender.name}, round {k + 1} of {rounds}")
                started, busy_s = time.perf_counter(), time.process_time()
                contender.call()
                contender.times_s.append(time.perf_counter() - started)
                contender.processor_times_s.append(time.process_time() - busy_s)
