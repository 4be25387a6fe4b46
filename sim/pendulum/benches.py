"""Tests ready to run, and the bodies of the two papers as data."""

import math
from dataclasses import replace

from sim.acquisition.channels import Digitiser
from sim.pendulum.bench import PendulumBench
from sim.pendulum.body import SwingingBody
from sim.pendulum.coordinates import ANGLE, PITCH, SURGE, SWAY, YAW
from sim.pendulum.floating import Floating
from sim.pendulum.photogate import Photogate
from sim.pendulum.pivot import HangingWeight, Pendulum, RigidPart
from sim.pendulum.release import Release
from sim.pendulum.sensors import Sensor, inclinometer, motion_capture, rate_gyro, stern_range
from sim.pendulum.suspension import Suspension

# The swing of 2021, by its drawings: upper pivot P2 this far above the lower one, P1.
PIVOT_SPACING_M = 1.2
INCLINOMETER_DEPTH_M = 0.92  # below P1
SWING_2021 = RigidPart(mass_kg=42.28, lever_m=0.0719, inertia_kg_m2=39.526)
SWING_MODEL_2021 = RigidPart(mass_kg=11.27, lever_m=0.8367, inertia_kg_m2=0.45)

# The keelboat and the model hull of 2014; depth and roll gyradius of the boat are estimates.
KEELBOAT_2014 = Suspension(
    mass_kg=622.7,
    line_length_m=3.477,
    half_spacing_m=0.9,
    depth_m=0.7,
    yaw_gyradius_m=1.057,
    pitch_gyradius_m=1.156,
    roll_gyradius_m=0.62,
)
MODEL_HULL_2014 = Suspension(
    mass_kg=13.18,
    line_length_m=0.504,
    half_spacing_m=0.28,
    depth_m=0.253,
    yaw_gyradius_m=0.303,
    pitch_gyradius_m=0.352,
    roll_gyradius_m=0.204,
)
# KVLCC2 at 1:68 in roll; restoring of 993.4 kg with GM = 5.73/68 m, inertia from T = 2.54 s.
KVLCC2_ROLL = Floating(inertia=115.2, added_inertia=18.9, restoring=821.0)


def swing_bench(
    *,
    upper_pivot: bool = False,
    swing: RigidPart = SWING_2021,
    model: RigidPart | None = None,
    weights: tuple[HangingWeight, ...] = (),
    release_rad: float = math.radians(2.0),
) -> PendulumBench:
    """Return a swing test with inclinometer and motion capture.

    Parameters
    ----------
    upper_pivot
        Swing about P2 in place of P1.
    swing, model
        Levers from P1; the model's own is left out of the truth's total where there is none.
    weights
        Calibration weights on ropes; the body is let go this far from where they let it rest.
    """
    rise = PIVOT_SPACING_M if upper_pivot else 0.0
    parts = tuple(
        replace(part, lever_m=part.lever_m + rise) for part in (swing, model) if part is not None
    )
    body = Pendulum(parts, weights)
    sensors = (inclinometer(INCLINOMETER_DEPTH_M + rise), motion_capture(ANGLE))
    return _bench(body, (body.rest_rad + release_rad,), sensors)


def compound_bench(body: Pendulum, *, release_rad: float = math.radians(5.0)) -> PendulumBench:
    """Return a compound pendulum with a rate gyro and motion capture."""
    return _bench(body, (release_rad,), (motion_capture(ANGLE), rate_gyro(ANGLE)))


def bifilar_bench(
    body: Suspension,
    *,
    yaw_rad: float = math.radians(5.0),
    sway_m: float = 0.0,
    stern_lever_m: float = 1.0,
    flag_width_m: float = 0.01,
) -> PendulumBench:
    """Return a yaw and sway test.

    A range finder at the stern, yaw and sway by motion capture, photogate A at the stern and B at
    the bow, flags at the same lever.
    """
    sensors = (stern_range(stern_lever_m), motion_capture(YAW), motion_capture(SWAY))
    gates = tuple(
        Photogate(label, ((SWAY, 1.0), (YAW, lever)), flag_width_m)
        for label, lever in (("A", -stern_lever_m), ("B", stern_lever_m))
    )
    return replace(_bench(body, (0.0, sway_m, yaw_rad, 0.0), sensors), photogates=gates)


def double_pendulum_bench(
    body: Suspension, *, surge_m: float = 0.02, pitch_rad: float = 0.0, sway_m: float = 0.0
) -> PendulumBench:
    """Return a surge and pitch test with motion capture and a rate gyro; sway gives T_s."""
    captured = tuple(motion_capture(coordinate) for coordinate in (SURGE, PITCH, SWAY))
    return _bench(body, (surge_m, sway_m, 0.0, pitch_rad), (*captured, rate_gyro(PITCH)))


def decay_bench(body: Floating, *, release: float) -> PendulumBench:
    """Return the free decay of a floating body from a displacement in rad, or m for heave."""
    return _bench(body, (release,), (motion_capture(body.coordinate),))


def _bench(
    body: SwingingBody, displacement: tuple[float, ...], sensors: tuple[Sensor, ...]
) -> PendulumBench:
    release = Release(body.coordinates, displacement)
    return PendulumBench(body, release, sensors, (Digitiser(),) * len(sensors))
