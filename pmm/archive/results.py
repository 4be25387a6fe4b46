"""What the analysis of a campaign's folder gives the archive."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

LEVEL: Final = 0.95  # probability of the intervals that are kept


@dataclass(frozen=True)
class HarmonicValue:
    """Mean (order 0) or harmonic of a run's channel in one gate, in SI units.

    ``in_phase`` goes with the sine of the phase, ``quadrature`` with its cosine; half-widths are
    those of :data:`LEVEL`.
    """

    run: str
    gate: int
    channel: str
    order: int
    unit: str
    in_phase: float
    quadrature: float | None
    in_phase_half_width: float
    quadrature_half_width: float | None


@dataclass(frozen=True)
class CoefficientValue:
    """A coefficient as it is recommended: value, standard uncertainty and half-width."""

    name: str
    unit: str
    speed_m_s: float
    frequency_hz: float
    value: float
    standard_uncertainty: float
    half_width: float


@dataclass(frozen=True)
class AnalysedCampaign:
    """Harmonics and coefficients of a campaign; ``refused`` says what could not be found."""

    harmonics: tuple[HarmonicValue, ...] = ()
    coefficients: tuple[CoefficientValue, ...] = ()
    refused: tuple[str, ...] = ()


@dataclass(frozen=True)
class GapVerdict:
    """What the gap diagnosis answers: its verdict, the first answer and its probability."""

    verdict: str
    answer: str | None
    probability: float | None


@dataclass(frozen=True)
class Analyses:
    """What is computed of a folder that is not known yet; ``None`` where it is not asked for."""

    analyse: Callable[[Path], AnalysedCampaign] | None = None
    diagnose: Callable[[Path], GapVerdict] | None = None
