"""A run in blocks, put together again."""

from collections.abc import Iterable

import numpy as np

from hardware.description.arrays import FloatArray
from sim.signals import Signals


def join(parts: Iterable[Signals]) -> dict[str, FloatArray]:
    """Join the signals of consecutive blocks into those of the whole stretch."""
    blocks = list(parts)
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}
