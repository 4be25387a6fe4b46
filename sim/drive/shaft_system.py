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
    lifted_n: tuple[float, float]


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
    to_outputs, by_torque
        From states and from this sample's inputs (by way of the state too) to the outputs, shapes
        ``(n, 4)`` and ``(2, 4)``.
    at_once
        From this sample's inputs alone, where the state is known already.
    unloaded
        Angle, speed, acceleration without the struts' load, and the opening of a gear's clearance
        then: ``(samples, 4)``.
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
        As of the gauges' joints, N m and rad.
    """

    driven: bool
    step: FloatArray
    by_inputs: FloatArray
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
