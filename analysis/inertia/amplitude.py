"""How period and decay change with amplitude, and the period at none.

With a frequency that changes with the amplitude A as ``2 pi/T = (2 pi/T_0) (1 - slope A^p)``, the
oscillation's phase is

    phi(t) = phi_0 + (2 pi/T_0) (t - slope int_0^t A^p dt')

linear in phi_0, 2 pi/T_0 and their products with the slope. What geometry alone does to the period
of an angle (:mod:`analysis.inertia.lengthening`) is taken out first: what is left is what is not
known. It is fitted to the phases and
frequencies of successive parts of a record (:mod:`analysis.inertia.local_periods`) at once: phases
that count through know a period by the record's whole length, periods by that of a part. Constant,
linear and quadratic laws (p = 0, 1, 2) are averaged with Akaike's weights, so that the choice of
the law is part of the extrapolation's uncertainty.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from analysis.inertia.lengthening import Powers, longer
from analysis.inertia.local_periods import FEWEST_PARTS, LocalPeriods
from analysis.inertia.projection import inverse_gram
from analysis.uncertainty.averaging import averaged
from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

POWERS = (0, 1, 2)
_EXACT_RAD, _EXACT = 1e-10, 1e-11  # of a phase, and relative of a frequency: below are roundings


@dataclass(frozen=True)
class AmplitudeLaw:
    """One law: ``T = T_0/(1 - slope A^power)``; power 0 is no dependence.

    Attributes
    ----------
    known
        How the period lengthens besides, by geometry.
    """

    power: int
    period_s: float
    uncertainty_s: float
    slope: float
    weight: float
    known: Powers = ()

    def at(self, amplitude: FloatArray) -> FloatArray:
        """Return the period, s, at some amplitudes."""
        unknown = 1.0 - self.slope * amplitude**self.power
        return np.asarray(self.period_s * longer(self.known, amplitude) / unknown)


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


def zero_amplitude_period(local: LocalPeriods, known: Powers = ()) -> ZeroAmplitude:
    """Extrapolate the period to zero amplitude.

    Parameters
    ----------
    known
        How the period lengthens with the amplitude by geometry; it is taken out first.

    Raises
    ------
    DataError
        Under four parts.
    """
    size = local.period_s.size
    if size < FEWEST_PARTS:
        raise DataError(f"{size} parts; at least {FEWEST_PARTS} are needed to extrapolate")
    small = _without(local, known)
    fits = [_law(small, power) for power in POWERS]
    # the common misfit of the best law scales all uncertainties (Birge)
    scale = max(min(chi2 / freedom for _, chi2, freedom in fits), 1.0)
    scores = np.array([chi2 / scale + _penalty(2 * size, freedom) for _, chi2, freedom in fits])
    periods, own = np.array([[law.period_s, law.uncertainty_s] for law, *_ in fits]).T
    mean, variance, weights = averaged(periods, scale * own**2, scores)
    laws = tuple(
        replace(
            law,
            uncertainty_s=law.uncertainty_s * math.sqrt(scale),
            weight=weight,
            known=known,
        )
        for (law, _, _), weight in zip(fits, weights.tolist(), strict=True)
    )
    likeliest = max(laws, key=lambda law: law.weight)
    change = likeliest.at(local.amplitude.max(keepdims=True))[0] / likeliest.period_s - 1.0
    freedom = float(min(freedom for _, _, freedom in fits))
    return ZeroAmplitude(Estimate.of(mean, math.sqrt(variance), "s", freedom), laws, float(change))


def _without(local: LocalPeriods, known: Powers) -> LocalPeriods:
    """Return the phases and periods that would be there without what geometry does."""
    omega = float(local.omega_rad_s.mean())
    late = sum(
        (c * amplitude_integral(local.time_s, local.amplitude, power) for power, c in known),
        0.0 * local.time_s,
    )
    return replace(
        local,
        phase_rad=local.phase_rad + omega * late,
        period_s=local.period_s / longer(known, local.amplitude),
    )


def _penalty(size: int, freedom: int) -> float:
    """Return Akaike's for the unknowns, with Hurvich and Tsai's correction for few data."""
    unknown = size - freedom
    return 2.0 * unknown * size / max(freedom - 1, 1)


def _law(local: LocalPeriods, power: int) -> tuple[AmplitudeLaw, float, int]:
    """Fit one law; return it with its chi-squared and degrees of freedom."""
    rounding = np.zeros_like(local.covariance)
    rounding[:, 0, 0], rounding[:, 1, 1] = _EXACT_RAD**2, (_EXACT * local.omega_rad_s) ** 2
    whiten = np.linalg.inv(np.linalg.cholesky(local.covariance + rounding))
    rows = _rows(local, power)
    matrix = (whiten @ rows).reshape(-1, rows.shape[2])
    measured = np.stack([local.phase_rad, local.omega_rad_s], axis=1)[:, :, np.newaxis]
    data = (whiten @ measured).ravel()
    covariance = inverse_gram(matrix)
    solved = covariance @ (matrix.T @ data)
    chi2 = float(((data - matrix @ solved) ** 2).sum())
    omega, period = float(solved[0]), 2.0 * math.pi / float(solved[0])
    slope = -float(solved[1]) / omega if power else 0.0
    uncertainty = period / omega * math.sqrt(float(covariance[0, 0]))
    law = AmplitudeLaw(power, period, uncertainty, slope, 0.0)
    return law, chi2, data.size - matrix.shape[1]


def _rows(local: LocalPeriods, power: int) -> FloatArray:
    """Derivative of each part's (phase, frequency) by the unknowns, shape ``(parts, 2, unknowns)``.

    The unknowns are the frequency at no amplitude, its change with ``A^power`` (not for power 0),
    and the phase of each stretch.
    """
    unit_column = np.ones(local.time_s.size)
    columns = [np.stack([local.time_s - local.time_s[0], unit_column])]
    if power:
        columns.append(
            np.stack(
                [amplitude_integral(local.time_s, local.amplitude, power), local.amplitude**power]
            )
        )
    columns += [
        np.stack([local.stretch == number, 0.0 * unit_column])
        for number in range(int(local.stretch[-1]) + 1)
    ]
    return np.asarray(np.stack(columns).transpose(2, 1, 0))


def amplitude_integral(time_s: FloatArray, amplitude: FloatArray, power: int) -> FloatArray:
    """Integrate ``A^power`` from the first time to each, by Gauss and Legendre.

    Between the times the logarithm of the amplitude is Fritsch and Carlson's monotone cubic:
    a decay by friction or drag bends across a gap.
    """
    from scipy.interpolate import PchipInterpolator

    log = PchipInterpolator(time_s, np.log(np.maximum(amplitude, 1e-300)))
    nodes, weights = np.polynomial.legendre.leggauss(5)
    half = 0.5 * np.diff(time_s)
    inside = (time_s[:-1] + half)[:, np.newaxis] + half[:, np.newaxis] * nodes
    return np.concatenate([[0.0], np.cumsum(half * (np.exp(power * log(inside)) @ weights))])


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
