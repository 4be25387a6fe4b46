"""What the march of drive, mechanism and model needs of a drive."""

from dataclasses import dataclass
from typing import NamedTuple

from hardware.description.arrays import FloatArray
from sim.drive.prescribed_drive import DriveSettings
from sim.solve.linear_system import LinearSystem

TORQUE_DEGREE = 3  # of the polynomial by which the torque goes on between samples


@dataclass(frozen=True, eq=False)
class ShaftSystem:
    """What the march needs of a drive.

    Attributes
    ----------
    system
        From the torques (load, and what a gear with a clearance gives back) to angle, speed and
        acceleration beyond what the drive is told; with a clearance, its opening too.
    reflected_inertia_kg_m2
        Of the model at the shaft, solved as part of it.
    gap
        Stiffness and half clearance of the gear, or zeros.
    relaxation_s
        In which what the teeth have given way dies out once they touch nothing.
    lifted_n
        What each strut holds at rest beside what its gauge reads.
    """

    settings: DriveSettings
    frequency_hz: float
    system: LinearSystem
    reflected_inertia_kg_m2: float
    friction: tuple[float, float]
    cogging: tuple[tuple[float, float, float], ...]
    gap: tuple[float, float]
    relaxation_s: float
    lifted_n: tuple[float, float]

    @property
    def leads_s(self) -> tuple[float, ...]:
        """By which the inputs lead what the march knows of them: the teeth's damper feels rates."""
        return (0.0, self.relaxation_s)[: self.system.B.shape[1]]


class MarchedShaft(NamedTuple):
    """The drive, ready to march.

    Attributes
    ----------
    driven
        False where the struts' motion is given, so that nothing here counts.
    step
        What a sample leaves of the n states, shape ``(n, n)``.
    by_inputs
        What the load torque and the gear's return add, oldest sample first, shape ``(4, n, 2)``.
    past_to_outputs
        What the gear's return at the three samples before adds to the outputs: ``(3, 1, 4)``.
    to_outputs, by_torque
        From states and from this sample's inputs (by way of the state too) to the outputs, shapes
        ``(n, 4)`` and ``(2, 4)``.
    at_once
        From this sample's inputs alone, where the state is known already.
    unloaded
        Angle, speed, acceleration without the struts' load, and the opening of a gear's clearance
        then: at the sample before the first (of which only the opening counts) and at each one,
        ``(samples + 1, 4)``.
    states, torques
        At the three samples before the first and, once solved, at each: ``(samples + 3, n)`` and
        ``(samples + 3, 1)``, or 2 with a gear that has a clearance.
    motion
        Filled in: angle, speed, acceleration and both levers, ``(samples, 5)``.
    numbers
        Inertia of the model as far as it is solved as the shaft's; viscous and Coulomb friction of
        each strut's guides; what each strut holds at rest.
    cogging
        Order, torque and phase, one a row.
    gap
        As of the gauges' joints, N m and rad, and what a sample leaves of the teeth's give.
    """

    driven: bool
    step: FloatArray
    by_inputs: FloatArray
    past_to_outputs: FloatArray
    to_outputs: FloatArray
    by_torque: FloatArray
    at_once: FloatArray
    unloaded: FloatArray
    states: FloatArray
    torques: FloatArray
    motion: FloatArray
    numbers: FloatArray
    cogging: FloatArray
    gap: FloatArray
