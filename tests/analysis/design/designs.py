"""Beliefs, noise and candidates that the tests of designs share."""

from collections.abc import Sequence
from itertools import product

import numpy as np

from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.belief import Belief
from analysis.design.candidate import CandidateRun
from analysis.design.noise import Noise
from analysis.design.regression import Regression
from benchmarks.coefficients_campaigns import BODY, CUBIC, HORIZONTAL
from hardware.description.arrays import FloatArray
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint

LINEAR = Belief(HORIZONTAL_1963, BODY, HORIZONTAL)
WHOLE = Belief(HORIZONTAL_1963, BODY, {**HORIZONTAL, **CUBIC})
NOISE = Noise(force_n=2.0, sample_rate_hz=100.0)
EXACT = StatedUncertainties()


def grid(
    frequencies_hz: tuple[float, ...] = (0.1, 0.2),
    amplitudes_m: tuple[float, ...] = (0.1, 0.2),
    phases_rad: tuple[float, ...] = (0.0, 1.5),
    periods: tuple[int, ...] = (5,),
    speed_m_s: float = 1.2,
) -> list[CandidateRun]:
    """Return every combination; each run waits two minutes and settles for three periods."""
    return [
        CandidateRun(SetPoint(f, e, phase, speed_m_s), count, 120.0 + (count + 3) / f)
        for f, e, phase, count in product(frequencies_hz, amplitudes_m, phases_rad, periods)
    ]


def covariance(regression: Regression, chosen: Sequence[int]) -> FloatArray:
    """Return what the chosen candidates leave of the coefficients, shape ``(p, p)``.

    With a billionth of a typical candidate's information besides, so that none is singular.
    """
    typical = np.einsum("npp->p", regression.normals) / max(len(regression.members), 1)
    least = np.diag(1e-9 * typical + 1e-300)
    places = [k for one in chosen for k in np.flatnonzero(regression.members == one)]
    normal = least + regression.normals[places].sum(axis=0)
    meat, pull = least + regression.meats[places].sum(axis=0), regression.pulls[places].sum(axis=0)
    scale = 1.0 / np.sqrt(np.diagonal(normal))
    inverse = np.linalg.inv(normal * np.outer(scale, scale)) * np.outer(scale, scale)
    return np.asarray(inverse @ (meat + pull @ pull.T) @ inverse)
