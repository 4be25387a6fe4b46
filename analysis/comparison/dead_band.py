"""Lost motion: a follower that stands still after each reversal until its play is taken up.

The play operator (M. A. Krasnosel'skii and A. V. Pokrovskii, Systems with Hysteresis, 1989): the
follower is pushed where the leader is ``h`` ahead of it, and is at rest in between.
"""

from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import BoolArray, FloatArray


@dataclass(frozen=True)
class Play:
    """What a follower does.

    Attributes
    ----------
    values
        Where it is, shape ``(samples,)``.
    side
        +1 where it was last pushed upwards, -1 downwards: ``-d values / d h``.
    pushed
        Where it moves.
    """

    values: FloatArray
    side: FloatArray
    pushed: BoolArray

    def every(self, step: int) -> "Play":
        """Return one of so many samples."""
        return Play(self.values[::step], self.side[::step], self.pushed[::step])


def follow(leader: FloatArray, half: float) -> Play:
    """Return what a follower does with ``half`` of a play on each side.

    Between two reversals of the leader the follower is the larger of where it stood and what pushes
    it (the smaller on the way down), so that only the reversals need be gone through one by one.
    """
    step = np.diff(leader)
    rising = np.concatenate((step[:1] > 0.0, step > 0.0))
    runs = np.flatnonzero(np.diff(rising)) + 1
    bounds = np.concatenate(([0], runs, [len(leader)]))
    up = rising[bounds[:-1]]
    ends = leader[bounds[1:] - 1] - np.where(up, half, -half)
    stood = np.empty(len(up))
    last = leader[0] - (half if up[0] else -half)
    for k, (goes_up, end) in enumerate(zip(up.tolist(), ends.tolist(), strict=True)):
        stood[k] = last
        last = max(last, end) if goes_up else min(last, end)
    long = np.diff(bounds)
    before, way = np.repeat(stood, long), np.where(np.repeat(up, long), 1.0, -1.0)
    pushing = leader - way * half
    pushed = way * (pushing - before) > 0.0
    pushed[0] = True
    held = np.maximum.accumulate(np.where(pushed, np.arange(len(leader)), 0))
    return Play(np.where(pushed, pushing, before), way[held], pushed)
