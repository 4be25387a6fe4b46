"""A channel at any times: quintic splines through its samples and those of its derivatives."""

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
        one = tracks[0]
        self.rate_hz = one.rate_hz
        self.start_s = one.start_s + _EDGE / one.rate_hz
        self.end_s = one.end_s - _EDGE / one.rate_hz

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
        found = map_coordinates(
            self._splines[channel, order], [places], order=_ORDER, mode="mirror", prefilter=False
        )
        return np.where(self.covers(time_s), found, 0.0)
