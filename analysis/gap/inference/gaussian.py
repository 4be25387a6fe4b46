"""Gaussian evidence with nuisances integrated out: the one mechanism behind every hypothesis.

A hypothesis says that the whitened difference r between measurement and simulation is

    r = N b + J t + e,      b ~ N(0, 1),  t ~ N(m, 1),  e ~ N(0, 1)

with the nuisances' columns N and the effect's columns J both in units of their prior. Integrating
over b and t leaves a Gaussian, whose density at the measured r is the evidence.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Final

import numpy as np

from analysis.gap.inference.constants import VISIBLE
from hardware.description.arrays import BoolArray, FloatArray

_APART: Final = 3.0  # from one width of a size's prior to the next
_HARDLY: Final = math.exp(VISIBLE)  # sigma of a prior deviation's signature at least
_MOST_SCALES: Final = 6


@dataclass(frozen=True, eq=False)
class Nuisances:
    """Columns that every hypothesis has, with unit normal priors.

    Attributes
    ----------
    columns
        Shape ``(observations, nuisances)``, whitened.
    names
        Of the first columns: coefficients, settings, what is always on.
    always_on
        How many of these, the last ones, are of what is always on.
    """

    columns: FloatArray
    names: tuple[str, ...] = ()
    always_on: int = 0

    @property
    def settings(self) -> "Nuisances":
        """Coefficients and settings alone."""
        count = len(self.names) - self.always_on
        return Nuisances(self.columns[:, :count], self.names[:count])

    @property
    def without_always_on(self) -> "Nuisances":
        """All but what is always on."""
        count = len(self.names) - self.always_on
        columns = np.delete(self.columns, np.s_[count : len(self.names)], axis=1)
        return Nuisances(columns, self.names[:count])

    @cached_property
    def _gain(self) -> FloatArray:
        gram = self.columns.T @ self.columns
        return np.asarray(np.linalg.solve(np.eye(len(gram)) + gram, self.columns.T), np.float64)

    @cached_property
    def log_determinant(self) -> float:
        """Log of the determinant of ``1 + N N^T``."""
        gram = self.columns.T @ self.columns
        return float(np.linalg.slogdet(np.eye(len(gram)) + gram)[1])

    def whiten(self, columns: FloatArray) -> FloatArray:
        """Return ``(1 + N N^T)^-1`` times columns: what the nuisances leave of them."""
        remainder: FloatArray = columns - self.columns @ (self._gain @ columns)
        return remainder

    def fitted(self, residual: FloatArray) -> FloatArray:
        """Return the nuisances' most probable values, in units of their prior."""
        return self._gain @ residual

    def among(self, rows: BoolArray) -> "Nuisances":
        """Return the nuisances over some of the observations."""
        return Nuisances(self.columns[rows], self.names, self.always_on)


@dataclass(frozen=True, eq=False)
class Posterior:
    """What the data say of an effect's parameters, to first order about where it was linearised.

    Attributes
    ----------
    mean, precision
        Of the parameters in units of their prior, shapes ``(p,)`` and ``(p, p)``; the prior's
        precision is in it.
    """

    mean: FloatArray
    precision: FloatArray

    @classmethod
    def of(cls, data_precision: FloatArray, pull: FloatArray) -> "Posterior":
        """Return it under a unit normal prior.

        Parameters
        ----------
        data_precision
            Precision by the data alone, shape ``(p, p)``.
        pull
            That times what the data alone ask for, shape ``(p,)``.
        """
        precision = np.eye(len(data_precision)) + data_precision
        return cls(np.asarray(np.linalg.solve(precision, pull), np.float64), precision)

    @cached_property
    def covariance(self) -> FloatArray:
        """Inverse of the precision."""
        return np.asarray(np.linalg.inv(self.precision), np.float64)

    @cached_property
    def root(self) -> FloatArray:
        """What times its transpose is the covariance; no precision is below the prior's 1."""
        values, turn = np.linalg.eigh(self.precision)
        return np.asarray(turn / np.sqrt(np.maximum(values, 1.0)), np.float64)

    @property
    def log_volume(self) -> float:
        """Half the log of the covariance's determinant: what is left of the prior's volume."""
        return -0.5 * float(np.linalg.slogdet(self.precision)[1])


def any_size(posterior: Posterior, groups: Sequence[BoolArray], reaches: Sequence[float]) -> float:
    """Return the log evidence gained by not knowing by orders of magnitude how large effects are.

    A size's prior is a mixture of normals: as wide as it is, thrice that up to what is plausible, a
    third of that and so on down to where these runs would hardly show the effect, each as likely as
    the others: an effect that they hardly show is none. One wide normal would ask more evidence of
    an effect the better a rig shows it, and the more, the further it is from what is typical.

    Parameters
    ----------
    posterior
        Under unit normal priors.
    groups
        For each effect which parameters are sizes, of shape ``(p,)``; those share their scale.
    reaches
        For each effect the largest plausible standard deviation.
    """
    informs = posterior.precision @ posterior.mean
    data_precision = posterior.precision - np.eye(len(informs))
    group_scales = [
        scales(np.diagonal(data_precision)[group], reach)
        for group, reach in zip(groups, reaches, strict=True)
    ]
    each = [
        np.ones(len(data_precision))
        + sum((width - 1.0) * group for width, group in zip(widths, groups, strict=True))
        for widths in product(*group_scales)
    ]
    logs = _under_priors(data_precision, informs, np.array([np.ones(len(data_precision)), *each]))
    return float(np.logaddexp.reduce(logs[1:]) - math.log(len(each)) - logs[0])


def scales(squares: FloatArray, reach: float) -> FloatArray:
    """Return the widths of a size's mixture of priors, in prior deviations.

    Parameters
    ----------
    squares
        Squared signatures of a prior deviation of the sizes that share their scale.
    reach
        Their largest plausible standard deviation.
    """
    shown = math.sqrt(max(float(squares.max(initial=0.0)), 0.0))
    down, up = (math.log(max(ratio, 1.0)) / math.log(_APART) for ratio in (shown / _HARDLY, reach))
    return _APART ** np.arange(-min(int(down), _MOST_SCALES), int(up) + 1.0)


def _under_priors(
    data_precision: FloatArray, informs: FloatArray, widths: FloatArray
) -> FloatArray:
    """Return log evidences but for a constant; prior widths of shape ``(priors, p)``."""
    precision = (
        np.eye(len(data_precision)) + widths[:, :, None] * data_precision * widths[:, None, :]
    )
    pulls = widths * informs
    solved = np.linalg.solve(precision, pulls[:, :, None])[:, :, 0]
    logs = 0.5 * np.sum(pulls * solved, axis=1) - 0.5 * np.linalg.slogdet(precision)[1]
    return np.asarray(logs, np.float64)


def posterior(residual: FloatArray, columns: FloatArray, nuisances: Nuisances) -> Posterior:
    """Return the posterior of an effect's parameters, whose priors are unit normals.

    Parameters
    ----------
    residual
        Whitened difference that is to be explained, shape ``(observations,)``.
    columns
        Change of the simulation per prior unit of each parameter, shape ``(observations, p)``.
    """
    weighted = nuisances.whiten(columns)
    return Posterior.of(columns.T @ weighted, weighted.T @ residual)


def null_evidence(residual: FloatArray, nuisances: Nuisances) -> float:
    """Return the log evidence of the nuisances alone, but for a constant that all share."""
    return -0.5 * (misfit(residual, nuisances) + nuisances.log_determinant)


def misfit(residual: FloatArray, nuisances: Nuisances) -> float:
    """Return the chi-square of what the nuisances leave of a whitened difference."""
    return float(residual @ nuisances.whiten(residual))


def left_over(columns: FloatArray, nuisances: Nuisances) -> float:
    """Return the norm of a signature after the nuisances have taken what they can, in sigma."""
    return float(np.sqrt(max(float(np.sum(columns * nuisances.whiten(columns))), 0.0)))


def rooted(nuisances: Nuisances, columns: FloatArray) -> FloatArray:
    """Return ``(1 + N N^T)^(-1/2)`` times columns."""
    u, s, _ = np.linalg.svd(nuisances.columns, full_matrices=False)
    shrink = 1.0 - 1.0 / np.sqrt(1.0 + s**2)
    remainder: FloatArray = columns - u @ (shrink[:, None] * (u.T @ columns))
    return remainder
