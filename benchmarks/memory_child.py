"""Analyse a long recording in a process of its own, and print what that took as JSON.

``python -m benchmarks.memory_child generated SECONDS``, ``... file PATH``, or ``... loaded PATH``:
the same file read into memory first.
"""

import json
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.readers import read_recording
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from benchmarks.peak import peak_bytes
from benchmarks.signals import Truth, draw_coefficients, recorded
from hardware.description.arrays import FloatArray

CHANNELS = 16
RATE_HZ = 10_000.0


@dataclass(frozen=True)
class Generated:
    """Samples that are computed when they are asked for, as a file's would be read."""

    truth: Truth
    sample_count: int

    @property
    def shape(self) -> tuple[int, ...]:
        """``(channels, samples)``."""
        return (len(self.truth.coefficients), self.sample_count)

    def __getitem__(self, key: tuple[slice | Sequence[int], slice], /) -> FloatArray:
        """Return the values of some channels between two sample numbers."""
        rows, when = key
        numbers = np.arange(*when.indices(self.sample_count))
        chosen = self.truth.coefficients[rows if isinstance(rows, slice) else list(rows)]
        return replace(self.truth, coefficients=chosen).values(numbers / RATE_HZ)


def generated(seconds: float) -> Recording:
    """Return a recording that takes no memory, of a motion of about 1 Hz."""
    rng = np.random.default_rng(1963)
    coefficients = draw_coefficients((10.0, 1.0, 0.3, 0.1), CHANNELS, rng)
    truth = Truth(1.0137, 0.3, coefficients)
    samples = Generated(truth, round(seconds * RATE_HZ))
    return recorded(samples, RATE_HZ, truth.edges_s(seconds))


def main(source: str, where: str) -> None:
    """Analyse as the command line would: the steady stretch found, one gate of all its periods."""
    before = peak_bytes()
    started = time.perf_counter()
    recording = generated(float(where)) if source == "generated" else read_recording(where)
    if source == "loaded":
        recording = replace(recording, samples=recording.samples[:, : recording.sample_count])
    analysis = analyse(recording, settings=ResolverSettings())
    found = {
        "before": before,
        "peak": peak_bytes(),
        "seconds": time.perf_counter() - started,
        "periods": analysis.readings[0].periods,
        "amplitude": float(analysis.readings[0].amplitude[0, 0]),
    }
    print(json.dumps(found))


if __name__ == "__main__":
    main(*sys.argv[1:])
