"""The model at rest where the drift sets it: there a zero run is made, and taken off all readings.

What the model weighs and what the water bears at rest is tared with the gauges' offsets. In another
attitude the same readings are other loads.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from analysis.kinematics.geometry import Geometry
from analysis.kinematics.motion import DrivenDisplacements, motion
from analysis.kinematics.projection import ROWS, check_surge_spared, load_matrix
from hardware.description.arrays import FloatArray


def _unturned() -> FloatArray:
    return np.eye(len(ROWS))[..., None]


@dataclass(frozen=True, eq=False)
class Tare:
    """Where a run's model rests, and what taring it there takes off; arrays may lead the axes.

    Attributes
    ----------
    place_m
        Of the reference point, as :attr:`analysis.kinematics.motion.MotionWaves.across_m`.
    of_load
        Loads in body axes, at each instant of the cycle, of what the gauges read of a unit load at
        rest: shape ``(..., 3, 2 or 3, instants or 1)``, by force, moment and surge force at rest.
    """

    place_m: FloatArray = field(default_factory=lambda: np.zeros(()))
    of_load: FloatArray = field(default_factory=_unturned)

    @classmethod
    def of(cls, geometry: Geometry, moved: DrivenDisplacements, gauges: int) -> "Tare":
        """Return that of a rig which moves so, with or without the X gauge (3 or 2)."""
        still = np.zeros((*np.shape(geometry.drift_rad)[:-1], 2, 1))
        at_rest = replace(geometry, varies_m_s=0.0)
        rest_motion = motion(at_rest, DrivenDisplacements(still, still, still))
        line = motion(geometry, moved).line_rad
        if gauges < len(ROWS):
            check_surge_spared(geometry)
        read = np.linalg.inv(load_matrix(geometry, rest_motion.line_rad))[..., :gauges, :]
        turned = (load_matrix(geometry, line)[..., :gauges, :gauges] @ read).swapaxes(-1, -2)
        return cls(rest_motion.across_m[..., 0], np.moveaxis(turned, -3, -1))

    @classmethod
    def stacked(cls, tares: Sequence["Tare"]) -> "Tare":
        """Return several as one, with an axis before theirs."""
        return cls(
            np.stack([tare.place_m for tare in tares]), np.stack([tare.of_load for tare in tares])
        )

    def missing_loads(self, load: FloatArray) -> FloatArray:
        """Return what is missing from the loads of a run that was tared under a load at rest.

        Parameters
        ----------
        load
            Force, moment and surge force of the struts, shape ``(..., 3, instants)``.
        """
        return np.asarray(np.einsum("...kt,...krt->...rt", load, self.of_load))
