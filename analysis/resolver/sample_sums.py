"""Sums over the whole samples inside periods of linear phase: the costly part of the resolver.

A phasor at sample ``r * ROW + j`` is one of row ``r`` times one of place ``j``. So the samples are
multiplied with a table of the places, small enough for the fastest memory and the same for all
rows, and the rows' sums are turned to their own phase and added: every sample is read once, and
sines are taken of the rows and of a few places only. The rows of many periods are one call of
NumPy: threads wait for each other between calls, not within.
"""

import itertools
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from analysis.resolver.basis import phasors
from hardware.description.arrays import ComplexArray, FloatArray, IntArray

_FEW: Final = 16
ROW: Final = _FEW**2
"""Samples a row. Measured from 128 to 4096: a table of 16 KiB (three harmonics) stays in 32 KiB of
first-level cache, and a row of eight channels outweighs the call of the matrix product."""


def phasor_sums(
    samples: FloatArray,
    first: IntArray,
    count: IntArray,
    cycle: FloatArray,
    step: FloatArray,
    harmonics: int,
) -> ComplexArray:
    """Sum ``y exp(i n theta)`` for n = 0 to N over each period, all samples of weight 1.

    The result has the shape ``(periods, channels, N + 1)``.

    Parameters
    ----------
    samples
        Shape ``(channels, samples)``.
    first, count, cycle, step
        First sample, number of samples, cycles there and per sample, shape ``(periods,)``.
    """
    samples = samples if samples.strides[-1] == samples.itemsize else np.ascontiguousarray(samples)
    windows = _windows(first, count)
    after = windows.lead + ROW * windows.rows
    tail = count - after
    places = _places(step, max(ROW, int(tail.max())), harmonics)
    tables = places.view(np.float64).swapaxes(1, 2)
    begins = np.empty((len(first), 2 + int(windows.rows.max())), dtype=np.int64)
    begins[:, 0], begins[:, 1] = 0, after
    begins[:, 2:] = windows.lead[:, None] + ROW * np.arange(begins.shape[1] - 2)
    parts = np.zeros((*begins.shape, tables.shape[1], len(samples)))
    parts[:, 0] = _sum_strips(samples, first, windows.lead, tables)
    parts[:, 1] = _sum_strips(samples, first + after, tail, tables)
    _sum_windows(samples, first + windows.lead, windows, tables[:, :, :ROW], parts[:, 2:])
    rows = phasors(cycle[:, None] + step[:, None] * begins, harmonics)
    turns = rows.view(np.float64).reshape(*rows.shape, 2).transpose(0, 2, 3, 1)
    by_order = parts.reshape(*begins.shape, harmonics + 1, -1).transpose(0, 2, 1, 3)
    return _complex(turns @ by_order)


@dataclass(frozen=True)
class _Windows:
    """Whole rows inside periods; those of neighbours lie evenly spaced and are one product.

    Attributes
    ----------
    lead, rows
        Samples of a period before its window, and rows of the window, shape ``(periods,)``.
    runs
        Periods whose windows are one product.
    spacing
        Samples from one window of a run to the next.
    """

    lead: IntArray
    rows: IntArray
    runs: list[slice]
    spacing: int


def _windows(first: IntArray, count: IntArray) -> _Windows:
    """Lay windows into periods: less than a row is left before each, less than two rows after it.

    Where either end of a period has strayed by a row from even spacing, a new run begins. Periods
    too short for a window have none.
    """
    periods = len(first)
    spacing = max(1, int(first[-1] - first[0]) // max(1, periods - 1))
    even = spacing * np.arange(periods)
    opening, closing = first - even, first + count - even
    late, lead = np.divmod(opening.max() - opening, ROW)
    early, trail = np.divmod(closing - closing.min(), ROW)
    rows = np.maximum((count - lead - trail) // ROW, 0)
    new = np.flatnonzero((np.diff(late) != 0) | (np.diff(early) != 0)) + 1
    edges = [0, *new.tolist(), periods]
    runs = [slice(begin, end) for begin, end in itertools.pairwise(edges) if rows[begin]]
    return _Windows(np.where(rows > 0, lead, 0), rows, runs, spacing)


def _places(step: FloatArray, count: int, harmonics: int) -> ComplexArray:
    """Return the phasors of at least the first places, shape ``(periods, places, N + 1)``.

    They are products of the phasors of the first few places and of one of every so many.
    """
    few = np.arange(_FEW)
    fine = phasors(step[:, None] * few, harmonics)
    coarse = phasors(step[:, None] * np.arange(0, count, _FEW), harmonics)
    products = np.repeat(coarse, _FEW, axis=1)
    runs = products.reshape(len(step), -1, _FEW * (harmonics + 1))  # long ones: quicker than few
    runs *= fine.reshape(len(step), 1, -1)
    return products


def _sum_windows(
    samples: FloatArray, start: IntArray, windows: _Windows, tables: FloatArray, into: FloatArray
) -> None:
    """Sum the rows of windows with the phasors of their places, a run at a time.

    Parameters
    ----------
    start
        First sample of each window, shape ``(periods,)``.
    tables
        Shape ``(periods, 2 (N + 1), ROW)``: real and imaginary parts in turns.
    into
        Shape ``(periods, rows, 2 (N + 1), channels)``.
    """
    for run in windows.runs:
        rows = int(windows.rows[run.start])
        windows_of_rows = sliding_window_view(samples[:, start[run.start] :], rows * ROW, axis=1)
        run_windows = windows_of_rows[:, :: windows.spacing][:, : run.stop - run.start]
        by_row = run_windows.reshape(*run_windows.shape[:2], rows, ROW).transpose(1, 2, 3, 0)
        np.matmul(tables[run, None], by_row, out=into[run, :rows])


def _sum_strips(
    samples: FloatArray, start: IntArray, count: IntArray, tables: FloatArray
) -> FloatArray:
    """Sum a few samples of each period with the phasors of their places.

    The result has the shape ``(periods, 2 (N + 1), channels)``.
    """
    place = np.arange(int(count.max()))
    number = np.minimum(start[:, None] + place, samples.shape[1] - 1)
    strips = samples[:, number]
    strips[:, place >= count[:, None]] = 0.0  # of another strip
    return np.asarray(tables[:, :, : len(place)] @ strips.transpose(1, 2, 0))


def _complex(turned: FloatArray) -> ComplexArray:
    """Join products of real and imaginary parts, shape ``(periods, N + 1, 2, 2 channels)``.

    The real and the imaginary part of the rows' phasors, each times the real parts of the rows'
    sums and then the imaginary ones.
    """
    periods, orders = turned.shape[:2]
    by_real, by_imaginary = turned.reshape(periods, orders, 2, 2, -1).transpose(2, 3, 0, 4, 1)
    return np.asarray(by_real[0] - by_imaginary[1] + 1j * (by_real[1] + by_imaginary[0]))
