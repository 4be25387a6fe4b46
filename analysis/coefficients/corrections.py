"""What is known of the measuring chain, taken out: calibration, lag and filters, zero runs.

Responses are functions of ``s = i omega``: the ones below, or any single channel LTI object of
python-control (continuous, or sampled with its ``dt``). A channel with response G reads ``G(i n
omega) H`` for a harmonic H, so the reading is divided by it.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.phasors import Phasors
from analysis.recording import Recording
from analysis.uncertainty.values import Contribution
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.channels import FORCES
from hardware.description.errors import ConfigurationError, DataError

Response = Callable[[complex], complex]

_LEAST_GAIN = 0.1  # a channel filtered below this tells about its noise, not about the force
ZERO_BLOCKS = 10  # of a zero run: their scatter sees slow noise too


@dataclass(frozen=True)
class Delay:
    """A channel that is late by ``lag_s`` (skew, converter) and reads ``gain`` times the truth."""

    lag_s: float
    gain: float = 1.0

    def __call__(self, s: complex) -> complex:
        """Return the response."""
        return complex(self.gain * np.exp(-s * self.lag_s))


@dataclass(frozen=True)
class AmplifierFilter:
    """An amplifier's low-pass filter.

    Attributes
    ----------
    cutoff_hz
        Where it lets half the power through.
    kind
        ``"butterworth"`` (of order 1: a resistor and a capacitor) or ``"bessel"``.
    """

    cutoff_hz: float
    order: int = 1
    kind: str = "butterworth"

    def __post_init__(self) -> None:
        if self.kind not in ("butterworth", "bessel"):
            raise ConfigurationError(f"filter {self.kind!r}; known are butterworth and bessel")
        if not self.cutoff_hz > 0.0 or self.order < 1:
            raise ConfigurationError(
                f"a filter of order {self.order} at {self.cutoff_hz:g} Hz; both must be above 0"
            )

    def __call__(self, s: complex) -> complex:
        """Return the response."""
        from scipy import signal

        cutoff = 2.0 * math.pi * self.cutoff_hz
        if self.kind == "bessel":
            design = signal.bessel(self.order, cutoff, analog=True, output="ba", norm="mag")
        else:
            design = signal.butter(self.order, cutoff, analog=True, output="ba")
        above, below = (np.asarray(part) for part in design)
        return complex(np.polyval(above, s) / np.polyval(below, s))


def response_factors(
    run: str, frequency_hz: float, order: int, responses: Mapping[str, Response]
) -> dict[str, complex]:
    """Return what each channel's harmonic is multiplied by to take its response out.

    Raises
    ------
    DataError
        If a channel lets less than a tenth of this harmonic through.
    """
    factors = {}
    for name, response in responses.items():
        value = response_at(response, 2.0 * math.pi * frequency_hz * order)
        if not abs(value) > _LEAST_GAIN:
            raise DataError(
                f"{run}: {name} lets {abs(value):.2g} of harmonic {order} at "
                f"{frequency_hz:g} Hz through, less than {_LEAST_GAIN:g}; raise the filter's "
                "frequency or take a lower harmonic"
            )
        factors[name] = 1.0 / value
    return factors


def response_at(response: Response, omega: float) -> complex:
    """Return a response at an angular frequency; a sampled system's at ``z = exp(i omega dt)``."""
    step = getattr(response, "dt", None)  # python-control: None, 0 and True say nothing of seconds
    step_s = 0.0 if step is None or step is True else float(step)
    argument = complex(np.exp(1j * omega * step_s)) if step_s > 0.0 else 1j * omega
    return complex(np.asarray(response(argument)).item())


def calibration(matrix: FloatArray) -> FloatArray:
    """Return a calibration matrix that was checked.

    Raises
    ------
    ConfigurationError
        If its shape is not (2, 2), or it is singular.
    """
    matrix = np.asarray(matrix, dtype=np.float64)
    if matrix.shape != (2, 2) or not np.linalg.cond(matrix) < 1e6:
        raise ConfigurationError(
            f"the calibration matrix {matrix.tolist()} must be 2 by 2 and not singular"
        )
    return matrix


def zero_reading(recording: Recording, names: tuple[str, ...] = FORCES) -> Phasors:
    """Read a zero run: the mean of each channel, with the scatter between ten blocks.

    The means are real phasors of order 0.

    Raises
    ------
    DataError
        If a sample is missing or there are fewer than twenty.
    """
    values = np.stack([recording.values(name) for name in names])
    if values.shape[1] < 2 * ZERO_BLOCKS or not np.isfinite(values).all():
        raise DataError(
            f"{recording.name}: a zero run needs {2 * ZERO_BLOCKS} samples or more, none missing; "
            f"it has {values.shape[1]}, {int((~np.isfinite(values)).sum())} of them missing"
        )
    length = values.shape[1] // ZERO_BLOCKS
    blocks = values[:, : length * ZERO_BLOCKS].reshape(len(names), ZERO_BLOCKS, length).mean(axis=2)
    deviations = blocks - blocks.mean(axis=1, keepdims=True)
    parts = deviations / np.sqrt(ZERO_BLOCKS * (ZERO_BLOCKS - 1.0))
    rows = 2 * np.arange(len(names))  # a mean has no quadrature
    source = Contribution(f"zero run {recording.name}", ZERO_BLOCKS - 1.0, rows, parts)
    units = tuple(recording.channels[recording.index(name)].unit for name in names)
    means: ComplexArray = values.mean(axis=1).astype(np.complex128)
    return Phasors.of(tuple(names), units, means, (source,))


def zero_at(before: Phasors, after: Phasors, share: float) -> Phasors:
    """Return the offsets after a share of the time between two zero runs, on a straight line."""
    count = len(before.values)
    first = before.mapped((1.0 - share) * np.eye(count))
    return first.minus(after.mapped(-share * np.eye(count)))
