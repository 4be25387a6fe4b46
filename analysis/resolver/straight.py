"""Sums of periods in which the phase runs straight: the usual case, and the quick one.

All samples strictly inside a period count once; the six around either edge carry a correction
(:mod:`analysis.resolver.weights`). The inside takes the time, so it is summed by a matrix product
with a basis made without a sine for each sample, or by compiled code.
"""

from dataclasses import dataclass, fields
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from analysis.resolver.compiled import WORTH_COMPILING, available, moments
from analysis.resolver.gram import gram_of, phasor_series
from analysis.resolver.template import straight_template
from analysis.resolver.weights import REACH, edge_corrections

FloatArray = NDArray[np.float64]

Sums: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]
"""``gram``, ``moment`` and ``ramp`` of some periods; the ramp counts samples here."""


@dataclass(frozen=True)
class Gates:
    """Periods to sum, each array of shape ``(periods,)``.

    Attributes
    ----------
    opening, closing
        Fractional sample numbers.
    opening_cycle, closing_cycle
        Revolutions there; in between they run straight.
    """

    opening: FloatArray
    closing: FloatArray
    opening_cycle: FloatArray
    closing_cycle: FloatArray

    def __getitem__(self, chosen: slice | NDArray[np.bool_]) -> "Gates":
        """Return some of the periods."""
        return Gates(*(getattr(self, field.name)[chosen] for field in fields(self)))

    def counted_from(self, first: int) -> "Gates":
        """Return the same periods with samples counted from number ``first`` on."""
        return Gates(
            self.opening - first, self.closing - first, self.opening_cycle, self.closing_cycle
        )

    @property
    def step(self) -> FloatArray:
        """Revolutions from one sample to the next."""
        return (self.closing_cycle - self.opening_cycle) / (self.closing - self.opening)

    def cycles_of_first(self, numbers: FloatArray) -> FloatArray:
        """Return the revolutions at some sample numbers of the first period."""
        return np.asarray(self.opening_cycle[0] + (numbers - self.opening[0]) * self.step[0])


def sum_straight(
    samples: FloatArray, gates: Gates, harmonics: int, compiled: bool | None = None
) -> Sums:
    """Sum some periods of samples, shape ``(channels, samples)``.

    Every period needs three samples beyond either edge.
    """
    first = np.floor(gates.opening).astype(np.int64) + 1
    count = np.floor(gates.closing).astype(np.int64) + 1 - first
    cycle = gates.opening_cycle + (first - gates.opening) * gates.step
    if compiled is None:
        compiled = available() and samples.size > WORTH_COMPILING
    inside = moments if compiled else _moments
    moment, ramp = inside(samples, first, count, cycle, gates.step, harmonics)
    series = phasor_series(cycle, gates.step, count, 2 * harmonics)

    numbers, weights = _edges(gates)
    phase = gates.opening_cycle[:, None] + (numbers - gates.opening[:, None]) * gates.step[:, None]
    phasors = np.exp(2j * np.pi * ((phase[:, None] * np.arange(2 * harmonics + 1)[:, None]) % 1.0))
    weighted = phasors * weights[:, None]
    series += weighted.sum(axis=2)
    basis = _basis_of(weighted[:, : harmonics + 1])
    moment += np.einsum("cpj,pkj->pck", samples[:, numbers], basis)
    ramp += np.einsum("pj,pkj->pk", numbers.astype(np.float64), basis)
    return gram_of(series, harmonics), moment, ramp


def _edges(gates: Gates) -> tuple[NDArray[np.int64], FloatArray]:
    """Numbers and weights of the samples around both edges, shapes ``(periods, 12)``."""
    around = np.arange(1 - REACH, REACH + 1)
    below = [np.floor(edge).astype(np.int64) for edge in (gates.opening, gates.closing)]
    numbers = np.concatenate([edge[:, None] + around for edge in below], axis=1)
    opening = edge_corrections(gates.opening - below[0])
    closing = edge_corrections(gates.closing - below[1])
    return numbers, np.concatenate((opening, -closing), axis=1)


def _basis_of(phasors: NDArray[np.complex128]) -> FloatArray:
    """Turn phasors of orders 0 to N, shape ``(periods, N + 1, j)``, into ``(periods, K, j)``."""
    periods, orders, count = phasors.shape
    basis = np.empty((periods, 2 * orders - 1, count))
    basis[:, 0] = phasors[:, 0].real
    basis[:, 1::2] = phasors[:, 1:].imag
    basis[:, 2::2] = phasors[:, 1:].real
    return basis


def _moments(
    samples: FloatArray,
    first: NDArray[np.int64],
    count: NDArray[np.int64],
    cycle: FloatArray,
    step: FloatArray,
    harmonics: int,
) -> tuple[FloatArray, FloatArray]:
    """Sums of ``b y`` and of ``b`` times the sample number, over whole samples of weight 1.

    Returns
    -------
    moment, ramp
        Shapes ``(periods, channels, K)`` and ``(periods, K)``.
    """
    size = 2 * harmonics + 1
    moment = np.empty((len(first), samples.shape[0], size))
    ramp = np.empty((len(first), size))
    for k, (start, width) in enumerate(zip(first.tolist(), count.tolist(), strict=True)):
        basis = straight_template(cycle[k], step[k], width, harmonics)
        np.matmul(samples[:, start : start + width], basis.T, out=moment[k])
        ramp[k] = basis @ np.arange(start, start + width, dtype=np.float64)
    return moment, ramp
