"""Coefficients at zero frequency, by a memory of the water that is not known.

Added mass and damping over frequency are one causal response, in which a constant A_inf and a
damping B_0 stand beside a memory of any shape (after Cummins 1962 and Ogilvie 1964)

    A(w) + B(w)/(i w) = A_inf + B_0/(i w) + tau sum_n a_n g(i w/w_n)    g(s) = 1/(1 + 2 z s + s^2)

with a_n normal, w_n from below the slowest run to above the fastest, and tau over orders of
magnitude, each weighed by its evidence. So A(0) = A_inf + tau sum_n a_n and B(0) = B_0: damping
tells what added mass does below the runs, and what it cannot tell is in the interval.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import DataError

# What each is, where it comes from and what happens when it is halved or doubled:
# docs/coefficients.md, Zero frequency.
_SIZES: Final = np.array([0.0, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 3.0])  # tau, of the load
_DAMPING: Final = 0.42  # z, of the critical one
_PER_OCTAVE: Final = 6  # responses
_BELOW: Final = 2.0  # octaves below the slowest run
_ABOVE: Final = 1.0  # octaves above the fastest
_FALL: Final = 4.0  # power of the frequency by which a_n falls below the slowest run
_OWN: Final = 0.02  # of tau, that each value may be off by itself


def at_zero_frequency(
    label: str,
    frequency_hz: FloatArray | Sequence[float],
    inertial: BoolArray | Sequence[bool],
    values: UncertainValues,
    *,
    restoring: bool = False,
) -> UncertainValues:
    """Return added mass and damping at zero frequency, those of the two that were measured.

    Parameters
    ----------
    label
        Of what is extrapolated, in budgets and messages.
    frequency_hz
        Of each value, shape ``(n,)``.
    inertial
        Whether each value is an added mass, shape ``(n,)``; a damping if not.
    values
        In SI units, with what they have in common.
    restoring
        Whether the added mass may hold a restoring C, as -C/w^2, which is returned as a further
        value.

    Raises
    ------
    DataError
        If there are fewer than two frequencies.
    """
    hertz = np.asarray(frequency_hz, dtype=np.float64)
    if len(np.unique(hertz)) < 2:
        raise DataError(
            f"{label} at zero frequency needs runs at two frequencies or more, and there is "
            f"{', '.join(f'{f:g} Hz' for f in np.unique(hertz))}; add runs at a lower one"
        )
    omega = 2.0 * np.pi * hertz
    kinds = np.asarray(inertial, dtype=np.bool_)
    per_unit = 1.0 / np.where(kinds, 1.0, omega)
    unit = float(np.sqrt(np.sum((values.values * per_unit) ** 2) / len(np.unique(hertz)))) or 1.0
    scaled = values.scaled(per_unit / unit)
    variance = own_variance(values) * (per_unit / unit) ** 2
    columns = _columns(omega, kinds, restoring=restoring)
    rows, doubt = _slow_motion(columns, scaled.values, variance)
    spread, directions = np.linalg.eigh(doubt)
    parts = directions * np.sqrt(np.maximum(spread, 0.0))
    found = scaled.mapped(rows)
    own = Contribution(f"extrapolation of {label}", np.inf, np.arange(len(rows)), parts)
    return UncertainValues(found.values, (*found.contributions, own)).scaled(
        np.full(len(rows), unit)
    )


def own_variance(values: UncertainValues) -> FloatArray:
    """Return the scatter that the values do not share; stated uncertainty moves them together."""
    by_input = values.variances()
    scattered = np.array(
        [np.isfinite(contribution.degrees_of_freedom) for contribution in values.contributions],
        dtype=bool,
    )
    variance = (
        np.asarray(by_input[scattered].sum(axis=0)) if scattered.any() else np.zeros(len(values))
    )
    size = np.abs(values.values).max() + 1e-300
    return np.asarray(np.maximum(np.nan_to_num(variance), (1e-9 * size) ** 2))


@dataclass(frozen=True, eq=False)
class _Columns:
    """What n values hold of the m steady parts and of k remembered ones.

    Attributes
    ----------
    steady, memory
        Shape ``(n, m)`` and ``(n, k)``.
    slow
        What is remembered, of the steady parts in slow motion, shape ``(m, k)``.
    """

    steady: FloatArray
    memory: FloatArray
    slow: FloatArray

    def at_size(
        self, tau: float, values: FloatArray, variance: FloatArray
    ) -> tuple[float, FloatArray, FloatArray]:
        """Return log evidence of a size, rows that make slow motion of the values, and doubt."""
        covariance = np.diag(variance + (tau * _OWN) ** 2) + tau**2 * self.memory @ self.memory.T
        root = np.linalg.cholesky(covariance)
        inverse = np.linalg.inv(root)
        white, seen = inverse @ self.steady, inverse @ values
        precision = white.T @ white
        fitted = np.linalg.solve(precision, white.T @ inverse)
        left = seen - white @ (fitted @ values)
        remembered = tau**2 * self.slow @ self.memory.T @ inverse.T @ inverse
        rows = fitted + remembered - remembered @ self.steady @ fitted
        missed = tau * (rows @ self.memory - self.slow)
        doubt = missed @ missed.T + (tau * _OWN) ** 2 * rows @ rows.T
        volume = float(np.log(np.diag(root)).sum()) + 0.5 * float(np.linalg.slogdet(precision)[1])
        return -0.5 * float(left @ left) - volume, rows, doubt


def _columns(omega: FloatArray, inertial: BoolArray, *, restoring: bool) -> _Columns:
    """Return what values of A, and of B/w where they are not inertial, hold."""
    lowest, highest = float(omega.min()), float(omega.max())
    octaves = np.log2(highest / lowest) + _BELOW + _ABOVE
    centres = lowest * 2.0 ** (np.linspace(-_BELOW, octaves - _BELOW, round(octaves * _PER_OCTAVE)))
    size = np.minimum(1.0, centres / lowest) ** _FALL / np.sqrt(_PER_OCTAVE)
    ratio = 1j * omega[:, None] / centres
    response = size / (1.0 + 2.0 * _DAMPING * ratio + ratio**2)
    memory = np.where(inertial[:, None], response.real, -response.imag)
    kinds = [inertial.astype(np.float64), ~inertial / omega, inertial / -(omega**2)]
    steady = np.stack(kinds[: 3 if restoring else 2], axis=1)
    told = steady.any(axis=0)
    slow = np.zeros((steady.shape[1], len(centres)))
    slow[0] = size
    return _Columns(steady[:, told], memory, slow[told])


def _slow_motion(
    columns: _Columns, values: FloatArray, variance: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the rows that make slow motion of the values, and the covariance of the rest."""
    evidence, rows, doubts = (
        np.array(each)
        for each in zip(*(columns.at_size(tau, values, variance) for tau in _SIZES), strict=True)
    )
    weights = np.exp(evidence - evidence.max())
    weights /= weights.sum()
    mean = np.tensordot(weights, rows, 1)
    apart = (rows - mean) @ values
    return mean, np.tensordot(weights, doubts, 1) + (weights * apart.T) @ apart
