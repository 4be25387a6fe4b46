"""How period and decay change with amplitude, and the period at none.

The record is cut into parts of some periods; each gives amplitude and period. Constant, linear and
quadratic laws are fitted to period over amplitude; they are averaged with Akaike's weights, so that
the choice of the law is part of the extrapolation's uncertainty.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from analysis.inertia.damped import DampedFit, fit_damped
from analysis.inertia.estimate import Estimate
from analysis.inertia.numeric import FloatArray
from hardware.description.errors import DataError

FEWEST_PARTS = 4
MOST_PARTS = 16
FEWEST_SWINGS = 1.5  # in a part
STRAYED = 0.1  # relative difference from the whole record's period: another oscillation


@dataclass(frozen=True)
class LocalPeriods:
    """Period and amplitude of successive parts of a record.

    Attributes
    ----------
    time_s, amplitude, period_s, uncertainty_s
        Of each part, shape ``(parts,)``: its middle, the amplitude there, its period and that
        fit's standard uncertainty.
    """

    time_s: FloatArray
    amplitude: FloatArray
    period_s: FloatArray
    uncertainty_s: FloatArray


@dataclass(frozen=True)
class AmplitudeLaw:
    """One law: ``T = T_0 (1 + slope A^power)``; power 0 is no dependence."""

    power: int
    period_s: float
    uncertainty_s: float
    slope: float
    weight: float


@dataclass(frozen=True)
class ZeroAmplitude:
    """A period extrapolated to zero amplitude.

    Attributes
    ----------
    period
        With the uncertainty of the laws' fits and of the choice between them.
    laws
        Constant, linear and quadratic, with Akaike's weights.
    change
        Relative change of the period from none to the largest amplitude, by the likeliest law.
    """

    period: Estimate
    laws: tuple[AmplitudeLaw, ...]
    change: float


@dataclass(frozen=True)
class PowerDecay:
    """Decay ``dA/dt = -A (A/A_0)^beta/tau_0``: beta 0 is linear damping, 1 quadratic.

    Attributes
    ----------
    amplitude, time_constant_s
        ``A_0`` and ``tau_0`` at the first part's time.
    covariance
        Of (ln A_0, 1/tau_0, beta), shape ``(3, 3)``.
    """

    amplitude: float
    time_constant_s: float
    beta: float
    covariance: FloatArray
    converged: bool

    @property
    def beta_uncertainty(self) -> float:
        """Standard uncertainty of beta, from the scatter about the fit."""
        return float(np.sqrt(self.covariance[2, 2]))


def local_periods(
    time_s: FloatArray,
    values: FloatArray,
    fit: DampedFit,
    *,
    mode: int = 0,
    parts: int | None = None,
    where: str = "record",
) -> LocalPeriods:
    """Cut a record into parts and fit each; parts that show another oscillation are left out.

    Parameters
    ----------
    fit
        The whole record's fit; its other modes are taken off first.
    parts
        How many; by default as many as leave three periods in each, 4 to 16.

    Raises
    ------
    DataError
        If the record has not six periods (too few swings), or under four parts are left.
    """
    chosen = fit.modes[mode]
    swings = (time_s[-1] - time_s[0]) / chosen.period_s
    count = parts or int(np.clip(swings // 3, FEWEST_PARTS, MOST_PARTS))
    if swings / count < FEWEST_SWINGS:
        raise DataError(
            f"{where}: too few swings: {swings:.3g} of {chosen.period_s:.3g} s are usable, at "
            f"least {FEWEST_SWINGS * count:g} are needed to see how the period changes with the "
            "amplitude; record longer or release from further out"
        )
    rest = values - _others(fit, mode, time_s)
    edges = np.linspace(time_s[0], time_s[-1], count + 1)
    rows = []
    for low, high in pairwise(edges):
        inside = (time_s >= low) & (time_s <= high)
        if np.isfinite(rest[inside]).mean() < 0.5:
            continue
        own = fit_damped(time_s[inside], rest[inside], start_periods_s=(chosen.period_s,))
        best = own.modes[0]
        if not own.converged or abs(best.period_s / chosen.period_s - 1.0) > STRAYED:
            continue
        middle = 0.5 * (low + high)
        there = best.amplitude * math.exp(-best.decay_1_s * (middle - own.start_s))
        rows.append((middle, there, best.period_s, own.period_uncertainty_s()))
    if len(rows) < FEWEST_PARTS:
        raise DataError(
            f"{where}: {len(rows)} of {count} parts show the oscillation of {chosen.period_s:.4g} "
            f"s; at least {FEWEST_PARTS} are needed: a record with fewer gaps, or less of other "
            "motions"
        )
    return LocalPeriods(*np.array(rows).T)


def _others(fit: DampedFit, mode: int, time_s: FloatArray) -> FloatArray:
    total = np.zeros(time_s.shape)
    t = time_s - fit.start_s
    for k, other in enumerate(fit.modes):
        if k != mode:
            angle = 2.0 * np.pi * t / other.period_s + other.phase_rad
            total += other.amplitude * np.exp(-other.decay_1_s * t) * np.cos(angle)
    return total


def zero_amplitude_period(local: LocalPeriods) -> ZeroAmplitude:
    """Extrapolate the period to zero amplitude.

    Raises
    ------
    DataError
        Under four parts.
    """
    if local.period_s.size < FEWEST_PARTS:
        raise DataError(
            f"{local.period_s.size} parts; at least {FEWEST_PARTS} are needed to extrapolate"
        )
    fits = [_law(local, power) for power in (0, 1, 2)]
    # the common misfit of the best law scales all uncertainties (Birge)
    best = min(chi2 / freedom for _, chi2, freedom in fits)
    scale = max(best, 1.0)
    size = local.period_s.size
    scores = []
    for law, chi2, _ in fits:
        k = 1 + (law.power > 0)
        correction = 2.0 * k * (k + 1) / max(size - k - 1, 1)
        scores.append(chi2 / scale + 2.0 * k + correction)
    weights = np.exp(-0.5 * (np.array(scores) - min(scores)))
    weights /= weights.sum()
    laws = tuple(
        AmplitudeLaw(law.power, law.period_s, law.uncertainty_s * math.sqrt(scale), law.slope, w)
        for (law, _, _), w in zip(fits, weights.tolist(), strict=True)
    )
    mean = sum(law.weight * law.period_s for law in laws)
    variance = sum(law.weight * (law.uncertainty_s**2 + (law.period_s - mean) ** 2) for law in laws)
    likeliest = max(laws, key=lambda law: law.weight)
    change = likeliest.slope * float(local.amplitude.max()) ** likeliest.power
    period = Estimate(mean, math.sqrt(variance), "s", float(size - 2))
    return ZeroAmplitude(period, laws, change if likeliest.power else 0.0)


def _law(local: LocalPeriods, power: int) -> tuple[AmplitudeLaw, float, int]:
    """Fit one law; return it with its chi-squared and degrees of freedom."""
    weight = 1.0 / np.maximum(local.uncertainty_s, 1e-12 * local.period_s)
    parts = [np.ones(local.period_s.size)]
    if power:
        parts.append(local.amplitude**power)
    matrix = np.column_stack(parts) * weight[:, None]
    covariance = np.linalg.pinv(matrix.T @ matrix, hermitian=True)
    solved = covariance @ (matrix.T @ (local.period_s * weight))
    chi2 = float((((local.period_s * weight) - matrix @ solved) ** 2).sum())
    slope = float(solved[1] / solved[0]) if power else 0.0
    law = AmplitudeLaw(power, float(solved[0]), float(np.sqrt(covariance[0, 0])), slope, 0.0)
    return law, chi2, local.period_s.size - len(parts)


def fit_power_decay(time_s: FloatArray, amplitude: FloatArray) -> PowerDecay:
    """Fit ``A = A_0 (1 + beta t/tau_0)^(-1/beta)`` to amplitudes, evenly in their logarithm.

    Raises
    ------
    DataError
        Under four amplitudes, or where one is not above zero.
    """
    from scipy.optimize import least_squares

    if amplitude.size < FEWEST_PARTS or not (amplitude > 0.0).all():
        raise DataError(
            f"{amplitude.size} amplitudes, the least {amplitude.min(initial=math.inf):.3g}; at "
            f"least {FEWEST_PARTS} above 0 are needed for a decay"
        )
    t, log = time_s - time_s[0], np.log(amplitude)

    def misfit(place: FloatArray) -> FloatArray:
        return np.asarray(_log_amplitude(t, *place) - log)

    rate = max((log[0] - log[-1]) / max(t[-1], 1e-300), 1e-12)
    outcome = least_squares(misfit, np.array([log[0], rate, 0.3]), x_scale=[1.0, rate, 1.0])
    jacobian = np.asarray(outcome.jac)
    covariance = np.linalg.pinv(jacobian.T @ jacobian, hermitian=True)
    covariance *= 2.0 * outcome.cost / max(log.size - 3, 1)
    a, inverse, beta = outcome.x
    tau = math.inf if inverse == 0.0 else 1.0 / float(inverse)
    return PowerDecay(math.exp(a), tau, float(beta), covariance, bool(outcome.success))


def _log_amplitude(t: FloatArray, log0: float, rate: float, beta: float) -> FloatArray:
    if abs(beta) < 1e-6:
        return log0 - rate * t
    return np.asarray(log0 - np.log(np.maximum(1.0 + beta * rate * t, 1e-12)) / beta)
