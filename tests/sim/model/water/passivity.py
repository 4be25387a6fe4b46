"""Whether a memory of the water can give back more energy than it has taken."""

import numpy as np

from hardware.description.arrays import FloatArray
from sim.model.water.radiation import Radiation


def is_passive(radiation: Radiation, tolerance: float = 1e-9) -> bool:
    """Tell whether the memory can never give back more energy than it has taken.

    That is so if the Hermitian part of K(i w) has no negative eigenvalue at any frequency.
    Adding ``tolerance`` (of the largest value of K) to it makes the frequencies at which its
    sign can change eigenvalues of a Hamiltonian matrix; the sign is tested between each
    neighbouring two, so that no violation is too narrow to be seen.
    """
    scaled = _unit_size(radiation)
    touched = np.abs(np.linalg.eigvals(_hamiltonian(scaled, tolerance)).imag)
    edges = np.unique(np.concatenate([[0.0], touched]))
    between = (edges[1:] + edges[:-1]) / 2.0
    memory = scaled.memory(np.concatenate([edges, between, 2.0 * edges[-1:]]))
    hermitian = (memory + memory.conj().swapaxes(-1, -2)) / 2.0
    return bool(np.linalg.eigvalsh(hermitian).min() >= -tolerance * (1.0 + 1e-6))


def _unit_size(radiation: Radiation) -> Radiation:
    """Scale forces and velocities, the same in both, so that the largest |K_ii| is about one."""
    omega = np.abs(np.linalg.eigvals(radiation.state_matrix))
    diagonal = np.abs(radiation.memory(omega)[:, (0, 1), (0, 1)]).max(axis=0, initial=0.0)
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    return Radiation(
        radiation.added_mass_infinite,
        radiation.state_matrix,
        radiation.input_matrix * scale,
        radiation.output_matrix * scale[:, None],
    )


def _hamiltonian(radiation: Radiation, tolerance: float) -> FloatArray:
    """Return the matrix whose eigenvalues i w are where K + K^H + 2 tolerance turns singular."""
    a, b, c = radiation.state_matrix, radiation.input_matrix, radiation.output_matrix
    inverse = 1.0 / (2.0 * tolerance)
    return np.block(
        [[a - inverse * b @ c, -inverse * b @ b.T], [inverse * c.T @ c, c.T @ b.T * inverse - a.T]]
    )
