"""Sources of scatter as tests state them: by covariance, or by the draws of some periods."""

import numpy as np

from analysis.coefficients.phasors import Phasors
from analysis.uncertainty.values import Contribution


def of_covariance(label: str, covariance: np.ndarray, degrees_of_freedom: float) -> Contribution:
    """Return a source whose deviates make some covariance of all numbers."""
    values, vectors = np.linalg.eigh(covariance)
    root = vectors * np.sqrt(np.clip(values, 0.0, None))
    return Contribution(label, degrees_of_freedom, np.arange(len(root)), root)


def scattering(
    phasors: Phasors, *sources: Contribution, values: np.ndarray | None = None
) -> Phasors:
    """Return phasors whose scatter comes from these sources alone; other values, where given."""
    own = phasors.values if values is None else values
    return Phasors.of(phasors.names, phasors.units, own, sources)


def of_draws(label: str, draws: np.ndarray) -> Contribution:
    """Return what the mean of draws, shape ``(count, numbers)``, scatters by their own account."""
    count = len(draws)
    parts = (draws - draws.mean(axis=0)).T / np.sqrt(count * (count - 1.0))
    return Contribution(label, count - 1.0, np.arange(len(parts)), parts)
