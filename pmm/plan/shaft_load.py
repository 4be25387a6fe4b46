"""What a run's motion asks of the shaft over a turn, before it is made, and what turns the shaft.

The struts' forces are those of the estimate, and what they hold at rest as far as no counterweight
bears it; a rod's obliqueness is left out.
"""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from analysis.ideal_rig import held_at_rest_n
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.motor import Servo, ShuntMotor
from hardware.description.setpoint import Medium
from pmm.configuration import Fault, as_error, validate
from pmm.plan.force_estimate import force_estimate
from pmm.plan.motion_peaks import omega_of
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

_STEPS: Final = 256  # over a turn: Coulomb friction's corners to 1e-4 in the orders below
_ORDERS: Final = 6


@dataclass(frozen=True)
class _Drive:
    motor: ShuntMotor | Servo


@dataclass(frozen=True)
class ShaftLoad:
    """What loads the shaft in a run.

    Attributes
    ----------
    torques_n_m
        Phasors of the load torque over a turn, order 1 first: ``Re(T_k exp(i k theta))``.
    added_inertia_kg_m2
        Mean inertia at the shaft of what the struts move.
    """

    torques_n_m: ComplexArray
    added_inertia_kg_m2: float


def motor_of(rig: RigFile) -> ShuntMotor | Servo | None:
    """Return the motor that the rig's file states in ``[campaign.drive]``; ``None`` without.

    Raises
    ------
    ConfigurationError
        If its table is wrong.
    """
    drive: Any = rig.campaign.get("drive", {})
    if not isinstance(drive, dict) or "motor" not in drive:
        return None
    faults: list[Fault] = []
    drive_table = validate(_Drive, {"motor": drive["motor"]}, faults)
    if drive_table is None:
        placed = [Fault(("campaign", "drive", *fault.place), fault.message) for fault in faults]
        raise as_error(rig.path, placed, dict(rig.tables))
    return drive_table.motor


def shaft_load(run: RunPlan, rig: RigFile, motor: ShuntMotor | Servo) -> ShaftLoad | None:
    """Return the estimate for a run that oscillates; ``None`` without a model in the rig's file.

    Struts that follow lines have drives of their own: the shaft bears nothing of them.
    """
    bears = run.oscillates and not run.set_point.lines
    estimate = force_estimate(run, rig) if bears else None
    if estimate is None:
        return None
    point = run.set_point
    moved = point.eccentricity_m * np.exp(1j * np.array([0.0, point.strut_phase_rad]))
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, _STEPS, endpoint=False))
    lever = (1j * np.outer(moved, turn)).real  # of a strut: its way per angle of the shaft
    force = np.outer(estimate.forces, turn).real
    velocity = omega_of(run) * lever
    guides = motor.guides
    force = force + guides.viscous_n_s_m * velocity + guides.coulomb_n * np.sign(velocity)
    force += _lifted_n(rig, point.medium)[:, np.newaxis]
    torque = (force * lever).sum(axis=0)
    for cogging in motor.cogging:
        torque = (
            torque
            + cogging.torque_n_m * (turn**cogging.order * np.exp(1j * cogging.phase_rad)).imag
        )
    inertia = -float((estimate.forces @ np.conj(moved)).real) / (2.0 * omega_of(run) ** 2)
    phasors = 2.0 * np.fft.rfft(torque)[1 : _ORDERS + 1] / _STEPS
    return ShaftLoad(phasors, max(inertia, 0.0))


def _lifted_n(rig: RigFile, medium: Medium) -> FloatArray:
    """Return what the shaft lifts at each strut at rest, in N."""
    if rig.model is None:
        return np.zeros(2)
    held_n = held_at_rest_n(rig.model, rig.oscillator, medium)
    return np.asarray(rig.oscillator.lifted * held_n, np.float64)
