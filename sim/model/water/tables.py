"""Added mass and damping over frequency, as a panel method or a strip theory gives them.

The matrices have the rows force and moment and the columns translation and rotation, in the axes
of the plane (heave down and pitch bow up, sway to starboard and yaw bow to starboard), about the
midpoint between the struts and at zero speed: forward speed enters through the velocity of the
model through the water and through manoeuvring derivatives.

Files: :mod:`sim.model.water.table_files`. The memory: :mod:`sim.model.water.memory`.
"""

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane

# Standard uncertainty of a table's values, relative, where none is stated: what panel methods
# reach at best, so that the fit of a memory adds little to it.
UNCERTAINTY: Final = 2e-3
# Of the peak: negative damping beyond it is no noise of a table.
_MOST_NEGATIVE: Final = 0.05


@dataclass(frozen=True, eq=False)
class RadiationTable:
    """Added mass A and damping B of one plane at k frequencies.

    The loads on the hull are -(A v' + B v) for a velocity v = (translation, rotation) at one
    frequency; A and B are real, so no convention about the sign of the phase is in them.

    Attributes
    ----------
    omega_rad_s
        Shape ``(k,)``, rising, not negative.
    added_mass, damping
        Shape ``(k, 2, 2)``, SI units. A degree of freedom that nothing is known of is zero.
    added_mass_infinite
        Shape ``(2, 2)``, the limit at infinite frequency; ``None`` where it is not known.
    name
        What messages call the table.

    Raises
    ------
    DataError
        If a shape does not fit, a value is not finite, frequencies do not rise, or the damping of
        one degree of freedom is negative by more than a twentieth of its peak.
    """

    plane: Plane
    omega_rad_s: FloatArray
    added_mass: FloatArray
    damping: FloatArray
    added_mass_infinite: FloatArray | None = None
    name: str = "the radiation table"

    def __post_init__(self) -> None:
        k = np.size(self.omega_rad_s)
        shapes: dict[str, tuple[int, ...]] = {"omega_rad_s": (k,)}
        shapes |= {"added_mass": (k, 2, 2), "damping": (k, 2, 2)}
        if self.added_mass_infinite is not None:
            shapes["added_mass_infinite"] = (2, 2)
        for field, shape in shapes.items():
            object.__setattr__(self, field, self._checked(field, shape))
        self._check_frequencies()
        self._check_damping()

    def _checked(self, field: str, shape: tuple[int, ...]) -> FloatArray:
        array = np.array(getattr(self, field), dtype=np.float64)
        if array.shape != shape:
            raise DataError(f"{self.name}: {field} has shape {array.shape}; {shape} is needed")
        bad = array.size - int(np.count_nonzero(np.isfinite(array)))
        if bad:
            raise DataError(
                f"{self.name}: {bad} of {array.size} values of {field} are not finite; leave out "
                f"the frequencies that failed"
            )
        array.setflags(write=False)
        return array

    def _check_frequencies(self) -> None:
        omega = self.omega_rad_s
        if omega.size == 0 or omega[0] < 0.0 or (np.diff(omega) <= 0.0).any():
            raise DataError(
                f"{self.name}: the {omega.size} frequencies have to rise from 0 rad/s or more, "
                f"each once; sort them and remove repeated ones"
            )

    def _check_damping(self) -> None:
        diagonal = self.damping[:, (0, 1), (0, 1)]
        worst = np.unravel_index(int(diagonal.argmin()), diagonal.shape)
        if diagonal[worst] < -_MOST_NEGATIVE * diagonal[:, worst[1]].max(initial=0.0):
            raise DataError(
                f"{self.name}: the damping of the {('translation', 'rotation')[worst[1]]} is "
                f"{diagonal[worst]:.4g} at {self.omega_rad_s[worst[0]]:.4g} rad/s, where it cannot "
                f"be negative; an irregular frequency, or a wrong sign"
            )

    def asymmetry(self) -> float:
        """Return the largest ``|A_12 - A_21|`` or ``|B_12 - B_21|``, relative to the diagonal.

        The scale is sqrt(max X_11 max X_22) for each of both, so that the units cancel. Potential
        theory at zero speed has 0.
        """
        return max(_relative_asymmetry(self.added_mass), _relative_asymmetry(self.damping))

    def symmetrised(self, tolerance: float = 0.02) -> "RadiationTable":
        """Return the table with the coupling of both directions averaged.

        Raises
        ------
        DataError
            If :meth:`asymmetry` exceeds ``tolerance``: the file mixes signs, points of reference
            or speeds.
        """
        asymmetry = self.asymmetry()
        if asymmetry > tolerance:
            raise DataError(
                f"{self.name}: force due to rotation and moment due to translation differ by "
                f"{asymmetry:.2%} of the diagonal (limit {tolerance:.2%}); at zero speed they are "
                f"the same: check the signs, the point of reference and the speed"
            )
        infinite = self.added_mass_infinite
        return replace(
            self,
            added_mass=_symmetric(self.added_mass),
            damping=_symmetric(self.damping),
            added_mass_infinite=None if infinite is None else _symmetric(infinite),
        )

    def froude_scaled(self, length_ratio: float, density_ratio: float = 1.0) -> "RadiationTable":
        """Return the table of a geometrically similar hull at equal Froude number.

        Lengths grow by ``length_ratio``, frequencies by its power -1/2, masses by its cube times
        ``density_ratio``, damping by mass times frequency.

        Raises
        ------
        ConfigurationError
            If a ratio is not a positive number.
        """
        for name, ratio in (("length_ratio", length_ratio), ("density_ratio", density_ratio)):
            if not (math.isfinite(ratio) and ratio > 0.0):
                raise ConfigurationError(f"{name} = {ratio} must be a positive number")
        mass = density_ratio * length_ratio**3
        larger = self._transformed(np.diag([math.sqrt(mass), math.sqrt(mass) * length_ratio]))
        rate = length_ratio**-0.5
        return replace(larger, omega_rad_s=self.omega_rad_s * rate, damping=larger.damping * rate)

    def _transformed(self, old_from_new: FloatArray) -> "RadiationTable":
        """Return T^T X T for every matrix X."""
        infinite = self.added_mass_infinite
        left = old_from_new.T
        return replace(
            self,
            added_mass=left @ self.added_mass @ old_from_new,
            damping=left @ self.damping @ old_from_new,
            added_mass_infinite=None if infinite is None else left @ infinite @ old_from_new,
        )


def _symmetric(matrix: FloatArray) -> FloatArray:
    mean: FloatArray = (matrix + matrix.swapaxes(-1, -2)) / 2.0
    return mean


def _relative_asymmetry(matrices: FloatArray) -> float:
    difference = float(np.abs(matrices[:, 0, 1] - matrices[:, 1, 0]).max())
    scale = math.sqrt(float(np.prod(np.abs(matrices[:, (0, 1), (0, 1)]).max(axis=0))))
    if difference == 0.0:
        return 0.0
    return difference / scale if scale else math.inf
