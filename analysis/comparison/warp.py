"""What may lie between two records of one channel: other times, and lost motion.

Values at any times are quintic splines through the samples and those of the derivatives. Lost
motion is the play operator (M. A. Krasnosel'skii and A. V. Pokrovskii, Systems with Hysteresis,
1989): the follower is pushed where the leader is ``h`` ahead of it, and is at rest in between.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from analysis.comparison.band import BandTrack
from hardware.description.arrays import BoolArray, FloatArray

_ORDER: Final = 5
_EDGE: Final = 8  # samples at each end in which the spline feels that it ends


class Warped:
    """Several channels of one recording at times of another one's clock.

    Parameters
    ----------
    tracks
        At one rate, with the same orders.
    """

    def __init__(self, *tracks: BandTrack) -> None:
        self._tracks = tracks
        track = tracks[0]
        self.rate_hz = track.rate_hz
        self.start_s = track.start_s + _EDGE / track.rate_hz
        self.end_s = track.end_s - _EDGE / track.rate_hz

    @cached_property
    def _splines(self) -> FloatArray:
        from scipy.ndimage import spline_filter1d

        values = np.array([track.derivatives for track in self._tracks])
        return np.asarray(spline_filter1d(values, _ORDER, axis=-1, mode="mirror"))

    def covers(self, time_s: FloatArray) -> BoolArray:
        """Tell at which times there are samples on both sides."""
        return np.asarray((time_s >= self.start_s) & (time_s <= self.end_s))

    def values(self, time_s: FloatArray, order: int, channel: int = 0) -> FloatArray:
        """Return a channel, or a derivative of it, at some times; zero where it was not recorded.

        Parameters
        ----------
        order
            Row of the tracks' derivatives.
        """
        from scipy.ndimage import map_coordinates

        track = self._tracks[channel]
        places = (time_s - track.start_s) * self.rate_hz
        samples = map_coordinates(
            self._splines[channel, order], [places], order=_ORDER, mode="mirror", prefilter=False
        )
        return np.where(self.covers(time_s), samples, 0.0)


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

    def decimated(self, step: int) -> "Play":
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
    places = np.empty(len(up))
    last = leader[0] - (half if up[0] else -half)
    for k, (goes_up, end) in enumerate(zip(up.tolist(), ends.tolist(), strict=True)):
        places[k] = last
        last = max(last, end) if goes_up else min(last, end)
    long = np.diff(bounds)
    before, way = np.repeat(places, long), np.where(np.repeat(up, long), 1.0, -1.0)
    pushing = leader - way * half
    pushed = way * (pushing - before) > 0.0
    pushed[0] = True
    held = np.maximum.accumulate(np.where(pushed, np.arange(len(leader)), 0))
    return Play(np.where(pushed, pushing, before), way[held], pushed)
