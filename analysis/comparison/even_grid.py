"""Channels with time stamps of their own on an even grid, by least squares.

A spline with evenly spaced knots is fitted to the samples where they lie (P. H. C. Eilers and
B. D. Marx, Flexible smoothing with B-splines and penalties, 1996). The penalty only decides where
there are no samples.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.comparison.band import edge_of, without_line
from analysis.recording import Recording
from hardware.description.arrays import FloatArray

if TYPE_CHECKING:
    from scipy.sparse import csr_array

_ORDER: Final = 5
_KNOTS: Final = 20.0  # over the edge of the motion's power: harmonics of a dead band fit in
_FEWER: Final = 0.5  # knots a sample, at most
_PENALTY: Final = 1e-4  # of a third difference, in samples: 1e-6 of a sine of six knots a period
_LONGEST: Final = 0.4  # of a period at the edge, below which lies nearly all; a longer gap is one
_LEAST_GAP: Final = 4.0  # mean steps that are no gap


def on_even_grid(recording: Recording, names: Sequence[str]) -> Recording:
    """Return some channels on an even grid; one that is evenly sampled is returned as it is.

    Where no samples are for longer than two fifths of the shortest period, values are
    missing.
    """
    if recording.stamps_s is None:
        return recording
    record = recording.select(names).complete()
    stamps_s, values = record.time_s(), np.array([record.values(name) for name in names])
    if stamps_s.size < 2 * _ORDER:
        return replace(record, stamps_s=None)
    rate_hz = record.sample_count / float(stamps_s[-1] - stamps_s[0])
    look_s = stamps_s[0] + np.arange(record.sample_count) / rate_hz
    looks = (without_line(np.interp(look_s, stamps_s, channel)) for channel in values)
    edge_hz = max(edge_of(trace, rate_hz)[1] for trace in looks)
    knots_hz = min(_KNOTS * edge_hz, _FEWER * rate_hz)
    count = int(np.floor((stamps_s[-1] - stamps_s[0]) * knots_hz)) + 1
    grid_s = stamps_s[0] + np.arange(count) / knots_hz
    fitted = _fit_splines((stamps_s - stamps_s[0]) * knots_hz, values, count)
    after = np.clip(np.searchsorted(stamps_s, grid_s), 1, stamps_s.size - 1)
    fitted[:, np.diff(stamps_s)[after - 1] > max(_LONGEST / edge_hz, _LEAST_GAP / rate_hz)] = np.nan
    return replace(
        record, samples=fitted, sample_rate_hz=knots_hz, start_s=float(stamps_s[0]), stamps_s=None
    )


def _fit_splines(places: FloatArray, values: FloatArray, count: int) -> FloatArray:
    """Return splines with knots at whole numbers, fitted to values at some places, at the knots."""
    from scipy.interpolate import BSpline
    from scipy.linalg import solveh_banded

    knots = np.arange(-_ORDER, count + _ORDER + 1, dtype=np.float64)
    design: csr_array = BSpline.design_matrix(places, knots, _ORDER)
    size = design.shape[1]
    third = np.diff(np.eye(4), 3, axis=0)[0]
    normal = np.zeros((_ORDER + 1, size))
    product = design.T @ design
    for above in range(_ORDER + 1):
        normal[_ORDER - above, above:] = product.diagonal(above)
        if above < 4:
            for first in range(4 - above):
                ends = slice(first + above, size - 3 + first + above)
                normal[_ORDER - above, ends] += _PENALTY * third[first] * third[first + above]
    weights = solveh_banded(normal, np.asarray(design.T @ values.T))
    at = BSpline.design_matrix(np.arange(count, dtype=np.float64), knots, _ORDER)
    return np.ascontiguousarray((at @ weights).T)
