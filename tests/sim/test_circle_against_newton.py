"""What struts hold on a circle: point masses placed in the tank, and Newton's law on them.

The masses are drawn in axes that stand: the rig's origin on its circle, the struts out of it, the
model on the struts. Their accelerations are second differences of where they are, so that no
Coriolis or centripetal term is written down.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from sim.acquisition.channels import Acquisition
from sim.acquisition.digitiser import Digitiser
from sim.drive.carriage import CarriageSettings
from sim.gauges.dynamometer import Dynamometers
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate

SPEED_M_S, RATE_HZ, STEP_S = 1.3, 200.0, 2e-4
MASSES = np.array([[30.0, 0.7], [25.0, -0.4], [12.0, 0.1]])  # kg; ahead of the midpoint, m
FORCES = ("force_aft", "force_fore", "force_x")
RECORDED = (*FORCES, "displacement_aft", "displacement_fore", "carriage_speed", "turn_rate")


def rig() -> SimulatedRig:
    mass, ahead = MASSES.T
    total = float(mass.sum())
    body = Body(total, float(mass @ ahead**2), float(mass @ ahead) / total)
    perfect = Acquisition(**{name: Digitiser() for name in RECORDED})
    return replace(horizontal_rig(), body=body, acquisition=perfect, dynamometers=Dynamometers())


def held(time_s: float, turn: float, drift: float, half_m: float, struts) -> np.ndarray:
    """Force aft, fore and along the model at a time; ``struts(t)`` are their displacements."""

    def drawn(t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        turned = turn * t
        origin = SPEED_M_S / turn * np.array([math.sin(turned), 1.0 - math.cos(turned)])
        heading = turned + drift
        ahead = np.array([math.cos(heading), math.sin(heading)])
        right = np.array([-ahead[1], ahead[0]])
        aft, fore = struts(t)
        angle = math.atan2(fore - aft, 2.0 * half_m)
        bow = math.cos(angle) * ahead + math.sin(angle) * right
        pivot = origin - half_m * ahead + aft * right
        return pivot, bow, pivot + (MASSES[:, 1:2] + half_m) * bow

    (_, _, before), (pivot, bow, now), (_, _, after) = (
        drawn(time_s + k * STEP_S) for k in (-1, 0, 1)
    )
    force = MASSES[:, :1] * (before - 2.0 * now + after) / STEP_S**2
    star = np.array([-bow[1], bow[0]])
    arms = (now - pivot) @ bow
    aft, fore = struts(time_s)
    reach = math.hypot(2.0 * half_m, fore - aft)  # the fore attachment slides along the model
    on_fore = float(arms @ (force @ star)) / reach
    return np.array([float((force @ star).sum()) - on_fore, on_fore, float((force @ bow).sum())])


@pytest.mark.parametrize(("turn", "drift"), [(0.2, 0.0), (-0.15, 0.09), (0.11, -0.2)])
def test_struts_hold_the_masses_on_their_circle_while_they_oscillate(turn, drift) -> None:
    point = SetPoint(0.4, 0.05, 1.9, SPEED_M_S, Medium.AIR, drift_rad=drift, turn_rate_rad_s=turn)
    own = rig()
    run = simulate(own, point, periods=1, settling_periods=0, sample_rate_hz=RATE_HZ, seed=1)
    time, omega = run["time"].values, 2.0 * math.pi * point.frequency_hz
    waves = np.stack([np.sin(omega * time), np.cos(omega * time)], axis=1)
    parts = [
        np.linalg.lstsq(waves, run[name].values, rcond=None)[0]
        for name in ("displacement_aft", "displacement_fore")
    ]

    def struts(t: float) -> tuple[float, float]:
        now = np.array([math.sin(omega * t), math.cos(omega * t)])
        return float(parts[0] @ now), float(parts[1] @ now)

    half = own.oscillator.half_spacing_m
    for k in range(0, len(time), 61):
        found = [float(run[name].values[k]) for name in FORCES]
        assert found == pytest.approx(held(time[k], turn, drift, half, struts), abs=2e-4)
    assert run["turn_rate"].values == pytest.approx(turn)


def test_a_carriage_that_turns_too_fast_is_recorded_so() -> None:
    fast = replace(rig(), carriage=CarriageSettings(turn_error=0.02))
    point = SetPoint(0.4, 0.05, 0.0, SPEED_M_S, Medium.AIR, turn_rate_rad_s=0.1)
    run = simulate(fast, point, periods=1, settling_periods=0, sample_rate_hz=RATE_HZ, seed=1)
    assert run["turn_rate"].values == pytest.approx(0.102)


def test_a_vertical_oscillator_goes_round_no_circle() -> None:
    point = SetPoint(0.4, 0.05, 0.0, SPEED_M_S, turn_rate_rad_s=0.1)
    with pytest.raises(ConfigurationError, match="horizontal"):
        simulate(vertical_rig(), point, periods=1, seed=1)
