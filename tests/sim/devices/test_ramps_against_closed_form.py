"""A simulated drive's ramps against the closed form of its loop."""

import math
from dataclasses import replace

import pytest

from hardware.description.motor import Servo
from sim.devices.plant import Plant, PlantConditions
from sim.drive.prescribed_drive import DriveSettings
from sim.rig import vertical_rig


@pytest.mark.slow
def test_the_corners_of_a_ramp_at_no_eccentricity() -> None:
    """J d'' = -k_p d' - k_i d - J a from each corner on, whatever the sample rate."""
    motor = Servo(current_loop_hz=1e5)
    scale, inertia = motor.constant_n_m_a * motor.gear_ratio, motor.shaft_inertia_kg_m2
    half = motor.loop.proportional * scale / (2.0 * inertia)
    root = math.sqrt(half**2 - motor.loop.integral * scale / inertia)
    rig = replace(vertical_rig(), drive=DriveSettings(motor=motor))
    plant = Plant(rig, PlantConditions(), 100.0)
    plant.turn(2.0, 4.0)
    for k in range(100):
        since = [max(k / 100.0 - at, 0.0) for at in (0.0, 0.5)]
        told = 2.0 * (since[0] ** 2 - since[1] ** 2)
        behind = [
            4.0 * inertia / (motor.loop.integral * scale)
            * (1.0 - math.exp(-half * t)
               * (math.cosh(root * t) + half / root * math.sinh(root * t)))
            for t in since
        ]  # fmt: skip
        angle = plant.angle_rad + math.pi
        assert angle == pytest.approx(told - behind[0] + behind[1], abs=2e-4)
        plant.advance()
