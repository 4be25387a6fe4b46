"""From passages to the period at no amplitude.

    t_k = t_0 + (T_0/2) (k + c sum_{j<k} A_j^p) + (-1)^k o,     A_j from the speed through the gate

is linear in (t_0, T_0, T_0 c, o): one solve for every law p = 0, 1, 2. The laws are averaged with
Akaike's weights as in :mod:`analysis.inertia.amplitude`. What sway is left in the times makes the
residual coloured; the covariance is that of blocks of it.
"""

from dataclasses import dataclass

import numpy as np

from analysis.inertia.gates import Passages
from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

_BLOCKS = 12


@dataclass(frozen=True)
class PassageFit:
    """Period of a photogate record.

    Attributes
    ----------
    period
        At zero amplitude, from this record alone.
    mean_period_s
        Over the whole record, whatever the amplitude.
    change
        Relative change of the period from none to the first amplitude, by the likeliest law.
    asymmetry_s
        ``o``: how much later every second passage comes; a gate off the rest position.
    residual_s
        Shape ``(passages,)``.
    """

    period: Estimate
    mean_period_s: float
    change: float
    asymmetry_s: float
    weights: tuple[float, float, float]
    residual_s: FloatArray


def fit_passages(passages: Passages) -> PassageFit:
    """Fit the period and its change with amplitude.

    Raises
    ------
    DataError
        Under 24 passages.
    """
    if passages.time_s.size < 24:
        raise DataError(
            f"{passages.name}: {passages.time_s.size} passages; at least 24 (12 swings) are needed "
            "to tell a change with amplitude: record longer"
        )
    amplitude = smooth_amplitude(passages)
    rows = [_fit_law(passages, amplitude, power) for power in (0, 1, 2)]
    size = passages.time_s.size
    # coloured residuals carry fewer independent values than samples: as many as blocks
    scores = np.array(
        [
            _BLOCKS * np.log(row[2] @ row[2] / size) + 2.0 * (3 + (p > 0))
            for p, row in enumerate(rows)
        ]
    )
    weights = np.exp(-0.5 * (scores - scores.min()))
    weights /= weights.sum()
    periods, variances = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
    mean = float(weights @ periods)
    variance = float(weights @ (variances + (periods - mean) ** 2))
    best = int(np.argmax(weights))
    span = passages.number[-1] - passages.number[0]
    return PassageFit(
        period=Estimate.of(mean, float(np.sqrt(variance)), "s", float(_BLOCKS - 2)),
        mean_period_s=float(2.0 * (passages.time_s[-1] - passages.time_s[0]) / span),
        change=rows[best][3],
        asymmetry_s=rows[best][4],
        weights=(float(weights[0]), float(weights[1]), float(weights[2])),
        residual_s=rows[best][2],
    )


def smooth_amplitude(passages: Passages) -> FloatArray:
    """Return the amplitude at every passage over the first's: the speed's cubic in time."""
    t = passages.time_s - passages.time_s.mean()
    t /= np.abs(t).max()
    log = np.polynomial.Polynomial.fit(t, np.log(passages.speed), 3)(t)
    return np.asarray(np.exp(log - log[0]))


def _fit_law(
    passages: Passages, amplitude: FloatArray, power: int
) -> tuple[float, float, FloatArray, float, float]:
    """Return period, its variance, residual, relative change and asymmetry."""
    number = (passages.number - passages.number[0]).astype(np.float64)
    half_swings = np.arange(number[-1] + 1)
    powers = np.interp(half_swings, number, amplitude) ** power
    summed = np.concatenate(([0.0], np.cumsum(0.5 * (powers[1:] + powers[:-1]))))[
        number.astype(int)
    ]
    sign = np.where(passages.number % 2 == 0, 1.0, -1.0)
    parts = [np.ones(number.size), number, sign] + ([summed] if power else [])
    matrix = np.column_stack(parts)
    scale = np.abs(matrix).max(axis=0)
    scaled = matrix / scale
    solved, *_ = np.linalg.lstsq(scaled, passages.time_s, rcond=None)
    residual = passages.time_s - scaled @ solved
    variance = _block_covariance(scaled, residual)[1, 1] * 4.0 / scale[1] ** 2
    half = float(solved[1] / scale[1])
    change = float(solved[3] / scale[3]) / half if power else 0.0
    return 2.0 * half, float(variance), residual, change, float(solved[2])


def _block_covariance(matrix: FloatArray, residual: FloatArray) -> FloatArray:
    """Covariance from the scores of blocks of the record: residuals of any colour."""
    inverse = np.linalg.pinv(matrix.T @ matrix, hermitian=True)
    scores = matrix * residual[:, None]
    blocks = np.array([part.sum(axis=0) for part in np.array_split(scores, _BLOCKS)])
    rough = inverse @ (blocks.T @ blocks) @ inverse * _BLOCKS / (_BLOCKS - matrix.shape[1])
    freedom = residual.size - matrix.shape[1]
    white = inverse * float(residual @ residual) / freedom
    return np.asarray(np.where(np.diag(rough)[:, None] > np.diag(white)[:, None], rough, white))
