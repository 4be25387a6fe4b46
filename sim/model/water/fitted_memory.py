"""A fitted memory of the water, and what the fit leaves of its table."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from sim.model.water.radiation import Radiation
from sim.model.water.tables import RadiationTable

# Part of its peak below which a diagonal value counts as that, in weights and deviations.
_FLOOR: Final = 0.01
_ROUNDING: Final = 1e-3  # of the peak: negative damping of a table that is not worth a word
_LOSS: Final = 1.1  # of agreement by the condition of passivity, as a factor, likewise


@dataclass(frozen=True, eq=False)
class FittedMemory:
    """A memory and how well it reproduces the table that it was fitted to.

    Attributes
    ----------
    table
        With the coupling of both directions averaged.
    uncertainty
        Standard uncertainty of the table's values, relative, that the fit was to reach.
    loss
        By which factor the condition that no damping is negative makes the misfit larger.
    """

    radiation: Radiation
    table: RadiationTable
    uncertainty: float
    loss: float

    def deviations(self) -> FloatArray:
        """Return what the memory is off the table, relative: added mass and damping.

        Shape ``(2, k, 2, 2)`` over the frequencies above 0: relative to the table's value on the
        diagonal, to the root of the product of both diagonal values off it. Zero for a degree of
        freedom that the table does not have.
        """
        rows = slice(int(self.table.omega_rad_s[0] == 0.0), None)
        omega = self.table.omega_rad_s[rows]
        values = (self.radiation.added_mass(omega), self.radiation.damping(omega))
        true = (self.table.added_mass[rows], self.table.damping[rows])
        scale = [matrices[rows] for matrices in scales(self.table)]
        parts = zip(values, true, scale, strict=True)
        return np.array([(value - true_value) / size for value, true_value, size in parts])

    @property
    def error(self) -> float:
        """Largest of all deviations."""
        return float(np.abs(self.deviations()).max())

    @property
    def misfit(self) -> float:
        """Root mean square of the deviations of that added mass and damping which is worst."""
        return float(np.sqrt(np.mean(self.deviations() ** 2, axis=1)).max())

    def standard_uncertainties(self, omega_rad_s: float) -> tuple[FloatArray, FloatArray]:
        """Return by how much added mass and damping may be off the table's, each ``(2, 2)``.

        The root mean square of the relative deviations, times what they are relative to at the
        frequency; beyond the table at its next frequency.
        """
        relative = np.sqrt(np.mean(self.deviations() ** 2, axis=1))
        omega = self.table.omega_rad_s
        at = min(max(omega_rad_s, float(omega[0])), float(omega[-1]))
        sizes = [
            np.array([[np.interp(at, omega, scale[:, i, j]) for j in (0, 1)] for i in (0, 1)])
            for scale in (np.where(np.isfinite(s), s, 0.0) for s in scales(self.table))
        ]
        return relative[0] * sizes[0], relative[1] * sizes[1]

    def __str__(self) -> str:
        """Return what the memory leaves of its table, in a sentence or two."""
        text = (
            f"{self.table.name}: {self.radiation.states} states reproduce the table within "
            f"{self.misfit:.2g} of its values (root mean square), {self.error:.2g} at most; its "
            f"values count as known to {self.uncertainty:.2g}"
        )
        if self.misfit > 2.0 * self.uncertainty:
            text += ", which the memory does not reach: coefficients carry the misfit"
        return text + "." + self._passivity()

    def _passivity(self) -> str:
        lowest, at = self._lowest_damping()
        if lowest < -_ROUNDING:
            return (
                f" The table is not passive: its damping is negative by {-lowest:.2g} of its peak "
                f"at {at:.4g} rad/s, where the memory takes no energy from the water."
            )
        if self.loss > _LOSS and self.misfit > self.uncertainty:
            return (
                f" That no damping be negative at any frequency makes the misfit {self.loss:.2g} "
                f"times as large: no passive water has both added mass and damping of the table."
            )
        return ""

    def _lowest_damping(self) -> tuple[float, float]:
        """Return the lowest eigenvalue of the table's damping, relative to the peak, and where."""
        diagonal = self.table.damping[:, (0, 1), (0, 1)].max(axis=0)
        size = np.sqrt(np.where(diagonal > 0.0, diagonal, np.inf))
        values = np.linalg.eigvalsh(self.table.damping / np.outer(size, size))[:, 0]
        lowest = int(values.argmin())
        return float(values[lowest]), float(self.table.omega_rad_s[lowest])


def scales(table: RadiationTable) -> tuple[FloatArray, FloatArray]:
    """Return what a deviation of added mass, of damping counts relative to, each ``(k, 2, 2)``.

    Infinite where the table has nothing.
    """
    return _scale(table.added_mass), _scale(table.damping)


def _scale(matrices: FloatArray) -> FloatArray:
    diagonal = np.abs(matrices[:, (0, 1), (0, 1)])
    diagonal = np.maximum(diagonal, _FLOOR * diagonal.max(axis=0))
    diagonal = np.sqrt(np.where(diagonal > 0.0, diagonal, np.inf))
    return np.asarray(diagonal[:, :, None] * diagonal[:, None, :])
