"""Sums of periods in which the phase is linear in time: the usual case, and the quick one.

All samples strictly inside a period count once; the six around either edge carry a correction
(:mod:`analysis.resolver.weights`). The inside takes the time: :mod:`analysis.resolver.sample_sums`.
"""

from dataclasses import dataclass, fields
from functools import cache
from typing import TypeAlias

import numpy as np

from analysis.resolver.basis import basis_of, phasors
from analysis.resolver.sample_sums import phasor_sums
from analysis.resolver.weights import REACH, edge_corrections
from hardware.description.arrays import BoolArray, ComplexArray, FloatArray, IntArray

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

    def __getitem__(self, chosen: slice | BoolArray) -> "Gates":
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


def sum_straight(samples: FloatArray, gates: Gates, harmonics: int) -> Sums:
    """Sum some periods of samples, shape ``(channels, samples)``.

    Every period needs three samples beyond either edge.
    """
    first = np.floor(gates.opening).astype(np.int64) + 1
    count = np.floor(gates.closing).astype(np.int64) + 1 - first
    cycle = gates.opening_cycle + (first - gates.opening) * gates.step
    moment = phasor_sums(samples, first, count, cycle, gates.step, harmonics)
    series, about_middle = phasor_series(cycle, gates.step, count, 2 * harmonics)
    ramp = (first + (count - 1) / 2.0)[:, None] * series + about_middle

    numbers, weights = _edges(gates)
    phase = gates.opening_cycle[:, None] + (numbers - gates.opening[:, None]) * gates.step[:, None]
    weighted = phasors(phase, 2 * harmonics) * weights[:, :, None]
    series += weighted.sum(axis=1)
    ramp += np.einsum("pj,pjn->pn", numbers, weighted)
    moment += samples[:, numbers].transpose(1, 0, 2) @ weighted[..., : harmonics + 1]
    return gram_of(series, harmonics), basis_of(moment), basis_of(ramp[:, : harmonics + 1])


def _edges(gates: Gates) -> tuple[IntArray, FloatArray]:
    """Numbers and weights of the samples around both edges, shapes ``(periods, 12)``."""
    offsets = np.arange(1 - REACH, REACH + 1)
    below = [np.floor(edge).astype(np.int64) for edge in (gates.opening, gates.closing)]
    numbers = np.concatenate([edge[:, None] + offsets for edge in below], axis=1)
    opening = edge_corrections(gates.opening - below[0])
    closing = edge_corrections(gates.closing - below[1])
    return numbers, np.concatenate((opening, -closing), axis=1)


def phasor_series(
    first_cycle: FloatArray, step: FloatArray, count: IntArray, highest: int
) -> tuple[ComplexArray, ComplexArray]:
    """Sum ``exp(i n theta)`` over ``count`` samples whose cycles are ``first_cycle + k * step``.

    The results are sums, moments: for n = 0 to ``highest``, shape ``(periods, highest + 1)``: of
    the phasors, and of the phasors times the samples' distance from the middle one.
    """
    orders = np.arange(1, highest + 1)
    middle = (first_cycle + step * (count - 1) / 2.0)[:, None] * orders
    turned = np.exp(2j * np.pi * (middle % 1.0))
    half = np.pi * step[:, None] * orders
    sine, total_angle = np.sin(half), count[:, None] * half
    kernel = np.sin(total_angle) / sine
    # Its derivative by the angle from one sample to the next.
    slope = (count[:, None] * np.cos(total_angle) - kernel * np.cos(half)) / (2.0 * sine)
    plain = count[:, None].astype(np.complex128)
    sums = np.concatenate((plain, kernel * turned), axis=1)
    return sums, np.concatenate((0.0 * plain, -1j * slope * turned), axis=1)


def gram_of(sums: ComplexArray, harmonics: int) -> FloatArray:
    """Turn sums of phasors, shape ``(periods, 2 N + 1)``, into those of ``b b^T``."""
    order = np.arange(-harmonics, harmonics + 1)
    order_sums = order[:, None] + order
    phasors = np.where(
        order_sums >= 0, sums[:, np.abs(order_sums)], sums[:, np.abs(order_sums)].conj()
    )
    mixing = _mixing(harmonics)
    return np.asarray((mixing @ phasors @ mixing.T).real)


@cache
def _mixing(harmonics: int) -> ComplexArray:
    """Matrix from the phasors ``exp(i n theta)``, n = -N to N, to the basis."""
    matrix = np.zeros((2 * harmonics + 1, 2 * harmonics + 1), dtype=np.complex128)
    matrix[0, harmonics] = 1.0
    for n in range(1, harmonics + 1):
        matrix[2 * n - 1, harmonics + n], matrix[2 * n - 1, harmonics - n] = -0.5j, 0.5j
        matrix[2 * n, harmonics + n], matrix[2 * n, harmonics - n] = 0.5, 0.5
    return matrix
