"""The inside of straight periods summed by compiled code: the same numbers, faster.

Needs numba (``pip install 'pmm[fast]'``); loading it takes a moment, worth it for large recordings.
"""

import importlib.util

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

WORTH_COMPILING = 20_000_000  # values; below it NumPy is done before the compiled code is loaded
_CHUNK = 1024  # samples whose basis stays in the fastest memory


def available() -> bool:
    """Tell whether numba is installed."""
    return importlib.util.find_spec("numba") is not None


def moments(
    samples: FloatArray,
    first: NDArray[np.int64],
    count: NDArray[np.int64],
    cycle: FloatArray,
    step: FloatArray,
    harmonics: int,
) -> tuple[FloatArray, FloatArray]:
    """Do what :func:`analysis.resolver.straight.sum_straight` needs inside its periods."""
    from analysis.resolver.kernel import all_periods

    sums = all_periods(np.ascontiguousarray(samples), first, count, cycle, step, harmonics, _CHUNK)
    return sums[:, :-1], sums[:, -1]
