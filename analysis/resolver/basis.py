"""The resolver's basis ``[1, sin theta, cos theta, sin 2 theta, ...]`` over some samples."""

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray


def harmonic_basis(cycles: FloatArray, orders: FloatArray) -> FloatArray:
    """Return the basis for any orders at some phases, shape ``(2 * orders + 1, samples)``."""
    basis = np.empty((2 * len(orders) + 1, len(cycles)))
    basis[0] = 1.0
    for k, order in enumerate(orders):
        phase = 2.0 * np.pi * ((order * cycles) % 1.0)
        np.sin(phase, out=basis[2 * k + 1])
        np.cos(phase, out=basis[2 * k + 2])
    return basis


def phasors(cycles: FloatArray, highest: int) -> ComplexArray:
    """Return ``exp(i n theta)`` for n = 0 to ``highest``, shape ``(*cycles.shape, highest + 1)``.

    A sine and a cosine are taken of each phase, the orders above the first are their powers.
    """
    angle = 2.0 * np.pi * (cycles % 1.0)
    phasors = np.ones((*cycles.shape, highest + 1), dtype=np.complex128)
    if highest > 0:
        phasors.real[..., 1], phasors.imag[..., 1] = np.cos(angle), np.sin(angle)
    for n in range(2, highest + 1):
        np.multiply(phasors[..., n - 1], phasors[..., 1], out=phasors[..., n])
    return phasors


def basis_of(turned: ComplexArray) -> FloatArray:
    """Turn phasors of orders 0 to N into the basis: shape ``(..., N + 1)`` to ``(..., 2 N + 1)``.

    Sums of phasors become sums of the basis.
    """
    basis = np.empty((*turned.shape[:-1], 2 * turned.shape[-1] - 1))
    basis[..., 0] = turned[..., 0].real
    basis[..., 1::2] = turned[..., 1:].imag
    basis[..., 2::2] = turned[..., 1:].real
    return basis
