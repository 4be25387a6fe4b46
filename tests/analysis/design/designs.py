"""Beliefs, noise and candidates that the tests of designs share."""

from itertools import product

from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.belief import Belief
from analysis.design.candidate import CandidateRun
from analysis.design.noise import Noise
from benchmarks.coefficients_campaigns import BODY, CUBIC, HORIZONTAL
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
