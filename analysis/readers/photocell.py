"""The photocell's edges, from a sampled level or a list of times."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from analysis.readers.columns import Edge, TextLayout
from analysis.readers.headers import Header
from analysis.readers.text_layout import find_layout
from analysis.readers.text_source import TextSource
from analysis.readers.text_table import read_numbers
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity
from hardware.description.units import unit

# Half-width of the band around the threshold that a pulse must cross, over the level's span:
# noise within it makes no edges.
HYSTERESIS = 0.1


def edges_of_level(
    level: FloatArray, threshold: float | None = None, edge: Edge = Edge.RISING
) -> FloatArray:
    """Find the pulses' edges in a sampled level.

    The result holds the edges' fractional sample numbers: the straight line between the two samples
    around the threshold crosses it there. A pulse counts once it is 10 % of the span past the
    threshold.

    Parameters
    ----------
    level
        Shape ``(samples,)``; NaN where a sample is missing.
    threshold
        Level of an edge; ``None`` takes the middle of the extremes.
    """
    sign = 1.0 if edge is Edge.RISING else -1.0
    good = np.flatnonzero(np.isfinite(level))
    values = sign * level[good]
    if not values.size or values.min() == values.max():
        return np.empty(0)
    middle = 0.5 * (values.min() + values.max()) if threshold is None else sign * threshold
    band = HYSTERESIS * (values.max() - values.min())
    state = np.where(values > middle + band, 1, np.where(values < middle - band, -1, 0))
    sure = np.flatnonzero(state)
    turns = np.flatnonzero((state[sure[:-1]] < 0) & (state[sure[1:]] > 0))
    edges = [_crossing(values, good, sure[turn], sure[turn + 1], middle) for turn in turns]
    return np.array([place for place in edges if place is not None])


def _crossing(
    values: FloatArray, good: NDArray[np.intp], low: int, high: int, middle: float
) -> float | None:
    """Return where the values cross for the last time between a low and a high sample."""
    after = low + 1 + int(np.flatnonzero(values[low:high] <= middle)[-1])
    if good[after] - good[after - 1] > 1:
        return None  # the edge lies in a gap
    rise = values[after] - values[after - 1]
    return float(good[after] - 1 + (middle - values[after - 1]) / rise)


def read_edges(path: Path) -> FloatArray:
    """Read a CSV of edge times: its only column, or the one named as time; seconds by default.

    Empty lines and cells are passed over.

    Raises
    ------
    DataError
        If the file is missing, has no such column, or the times do not increase.
    """
    source = TextSource(path)
    layout = find_layout(source, TextLayout())
    header = _time_header(layout.headers, path)
    numbers = read_numbers(source, layout, [header])
    factor = unit(header.unit).factor if header.unit else 1.0
    edges_s = numbers.columns[header] * factor
    return check_edges(edges_s[~np.isnan(edges_s)], str(path))


def _time_header(headers: tuple[Header, ...], path: Path) -> Header:
    candidates = headers if len(headers) == 1 else [header for header in headers if header.is_time]
    if len(candidates) != 1:
        names = ", ".join(header.text or header.generic for header in headers)
        raise DataError(
            f"{path}: name the column of edge times 'time', or leave it alone (columns: {names})"
        )
    header = candidates[0]
    try:
        if header.unit and unit(header.unit).si != "s":
            raise DataError(f"{path}: edge times in {header.unit!r}; give them in seconds")
    except ConfigurationError as error:
        raise DataError(f"{path}: {error}") from None
    return header


def check_edges(edges_s: FloatArray, where: str) -> FloatArray:
    """Return edge times as they are, or refuse them.

    Raises
    ------
    DataError
        If one is missing or does not come after the one before.
    """
    bad = np.flatnonzero(~(np.diff(edges_s) > 0.0))
    if bad.size or not np.isfinite(edges_s).all():
        number = int(bad[0]) + 2 if bad.size else 1
        raise DataError(
            f"{where}: photocell edge {number} does not come after the one before "
            f"({edges_s[max(number - 2, 0) : number].tolist()} s); edges must increase"
        )
    return edges_s


def edge_flags(edges_s: FloatArray, interval_s: float | None) -> tuple[Flag, ...]:
    """Say that there are no edges, or that they are no sharper than the sampling allows."""
    if not edges_s.size:
        message = "the photocell has no edge in this recording; check column and threshold"
        return (Flag("no_photocell_edges", Severity.WARNING, message),)
    if interval_s is None:
        return ()
    message = (
        f"photocell edges were taken from a level sampled every {interval_s:.3g} s; a sharp pulse "
        "is known no better than that"
    )
    return (Flag("photocell_sampled", Severity.NOTE, message),)
