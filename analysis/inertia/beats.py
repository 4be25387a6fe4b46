"""Beats of yaw and sway: equations 9 to 13, for a record or for a stopwatch and a tally."""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from analysis.inertia.elementary_functions import Value
from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError


def beat_period(yaw_s: Value, sway_s: Value) -> Value:
    """Time from one beat to the next: ``T_y T_s/(T_y - T_s)`` (eq 11).

    The envelope's cosine has twice this period. Negative where yaw is the faster.
    """
    return yaw_s * sway_s / (yaw_s - sway_s)


def ratio_from_beats(oscillations: Value, *, yaw_slower: bool = True) -> Value:
    """Return ``T_y/T_s`` from the oscillations per beat (eq 13).

    Parameters
    ----------
    yaw_slower
        Whether yaw has the longer period, as it has where the gyradius exceeds the half spacing.
    """
    ratio = (2.0 * oscillations + 1.0) / (2.0 * oscillations - 1.0)
    return ratio if yaw_slower else 1.0 / ratio


@dataclass(frozen=True)
class BeatCount:
    """Oscillations counted over whole beats.

    Attributes
    ----------
    oscillations, beats
        As counted; both may be fractions where read from a record.
    counting_error
        Largest error of the oscillations over all beats; half of one where a person counts.
    """

    oscillations: float
    beats: float
    counting_error: float = 0.5

    def per_beat(self) -> Estimate:
        """Return n with the counting's uncertainty, evenly spread.

        Raises
        ------
        DataError
            If no whole beat, or under one oscillation a beat, was counted.
        """
        if self.beats < 1.0 or self.oscillations / max(self.beats, 1e-9) <= 1.0:
            raise DataError(
                f"{self.oscillations:g} oscillations in {self.beats:g} beats; at least one whole "
                "beat of more than one oscillation is needed: watch longer"
            )
        spread = self.counting_error / self.beats / math.sqrt(3.0)
        return Estimate.of(self.oscillations / self.beats, spread)


def count_beats(time_s: FloatArray, values: FloatArray) -> BeatCount:
    """Count beats and oscillations of a record as a person would, between the quiet moments.

    Where yaw and sway are not of one size, what is counted runs with the larger of them: by up to
    half an oscillation a beat. How unequal they are shows in how shallow the beats are, and is in
    the counting error, beside half an oscillation for the count itself.

    Parameters
    ----------
    time_s, values
        Evenly sampled, shape ``(samples,)``, without gaps.

    Raises
    ------
    DataError
        If fewer than two quiet moments lie in the record: one whole beat is needed.
    """
    centred = values - values.mean()
    crossing = _crossings(time_s, centred)
    middle, half = 0.5 * (crossing[1:] + crossing[:-1]), np.diff(crossing)
    places = np.searchsorted(time_s, crossing)
    peaks = np.array([np.abs(centred[a:b]).max(initial=0.0) for a, b in pairwise(places)])
    quiet = _minima(peaks)
    if len(quiet) < 2:
        raise DataError(
            f"{len(quiet)} quiet moment(s) in {time_s[-1] - time_s[0]:.3g} s; two are needed for "
            "one whole beat: record longer, or bring yaw and sway to the same amplitude"
        )
    moments = np.array([_vertex(middle, peaks, k) for k in quiet])
    usual = float(np.average(half, weights=peaks**2))
    span = float(moments[-1] - moments[0])
    beats = float(len(quiet) - 1)
    shallow = float(np.mean([_inequality(peaks[a : b + 1]) for a, b in pairwise(quiet)]))
    return BeatCount(span / (2.0 * usual), beats, 0.5 + 0.5 * shallow * beats)


def _inequality(peaks: FloatArray) -> float:
    """Return ``|a^2 - b^2|/(a^2 + b^2)`` of the oscillations a and b that make one beat.

    The square of the envelope is ``a^2 + b^2 + 2 a b cos``: its mean and variance tell both.
    """
    square = peaks**2
    depth = 2.0 * float(square.var()) / float(square.mean()) ** 2
    return math.sqrt(max(1.0 - depth, 0.0))


def _crossings(time_s: FloatArray, values: FloatArray) -> FloatArray:
    at = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
    step = values[at] / (values[at] - values[at + 1])
    return np.asarray(time_s[at] + step * (time_s[at + 1] - time_s[at]))


def _minima(peaks: FloatArray) -> list[int]:
    """Return where the swings are smallest between beats, by a third below the beats beside."""
    from scipy.signal import find_peaks

    depth = -np.log(peaks + 0.02 * peaks.max())
    minima, _ = find_peaks(depth, prominence=0.4)
    return [int(k) for k in minima]


def _vertex(time_s: FloatArray, peaks: FloatArray, k: int) -> float:
    """Return where two straight flanks meet: |cos| has a corner at the quiet moment."""
    if not 1 < k < peaks.size - 2:
        return float(time_s[k])
    left = np.polyfit(time_s[k - 2 : k], peaks[k - 2 : k], 1)
    right = np.polyfit(time_s[k + 1 : k + 3], peaks[k + 1 : k + 3], 1)
    if left[0] >= 0.0 or right[0] <= 0.0:
        return float(time_s[k])
    meet = (right[1] - left[1]) / (left[0] - right[0])
    return float(np.clip(meet, time_s[k - 1], time_s[k + 1]))
