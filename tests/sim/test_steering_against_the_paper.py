"""Propeller and rudder of the simulated model, against the MMG paper's equations for KVLCC2.

The equations are written out in the test's own file for one ship on plain numbers
(``tests/analysis/manoeuvring/published.py``); gauges are turned into loads on the model here.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Acquisition, Digitiser
from sim.model.hull import HullCoefficients
from sim.model.propeller import OpenWater, PropellerBehind
from sim.model.rudder import RudderBehind
from sim.model.steering import Steering
from sim.rest import state_at_rest
from sim.rig import SimulatedRig, horizontal_rig
from sim.run import simulate, steady_run
from tests.analysis.manoeuvring.published import kvlcc2 as paper

ADVANCE = tuple(float(j) for j in np.linspace(0.0, 0.9, 91))
THRUST = tuple(paper.K[0] + paper.K[1] * j + paper.K[2] * j * j for j in ADVANCE)
TABLE = OpenWater(paper.D_P, ADVANCE, THRUST, tuple(0.1 * one + 0.005 for one in THRUST))
STEERING = Steering(
    PropellerBehind(
        TABLE, paper.T_P, paper.W_P0, paper.X_P * paper.L, paper.C1, *paper.C2
    ),
    RudderBehind(
        paper.A_R, paper.H_R, paper.F_ALPHA, -0.5 * paper.L, paper.X_H * paper.L,
        paper.L_R * paper.L, paper.T_R, paper.A_H, paper.EPSILON, paper.KAPPA, *paper.GAMMA,
    ),
    paper.RHO,
)  # fmt: skip
BEHIND = ("rudder_angle", "revolutions", "propeller_thrust", "propeller_torque",
          "rudder_normal_force")  # fmt: skip
RATE_HZ = 9.0


def rig(steering: Steering | None = STEERING) -> SimulatedRig:
    own = horizontal_rig()
    perfect = {name: Digitiser() for name in BEHIND} if steering is not None else {}
    return replace(
        own,
        water=HullCoefficients(),
        steering=steering,
        acquisition=Acquisition(force_x=Digitiser(), **perfect),
    )


def tow(drift_deg: float, rudder_deg: float, rate_hz: float, speed: float) -> SetPoint:
    return SetPoint(
        0.5, 0.0, carriage_speed_m_s=speed, drift_rad=math.radians(drift_deg),
        rudder_angle_rad=math.radians(rudder_deg), revolutions_hz=rate_hz,
    )  # fmt: skip


@pytest.mark.parametrize("drift", [-12.0, 0.0, 9.0])
@pytest.mark.parametrize("rudder", [-20.0, 0.0, 15.0])
@pytest.mark.parametrize("rate", [7.0, RATE_HZ])
def test_a_tow_reads_the_papers_loads(drift: float, rudder: float, rate: float) -> None:
    made, beta = rig(), math.radians(drift)
    found = state_at_rest(made, tow(drift, rudder, rate, paper.U0)).spectra
    mean = {name: float(found[name][0].real) for name in (*BEHIND, "force_aft", "force_fore")}
    u, v = paper.U0 * math.cos(beta), -paper.U0 * math.sin(beta)
    told = paper.steering(u, v, 0.0, math.radians(rudder), rate)
    half = made.oscillator.half_spacing_m
    across = -(mean["force_aft"] + mean["force_fore"])
    about = -half * (mean["force_fore"] - mean["force_aft"])
    assert mean["propeller_thrust"] == pytest.approx(told.thrust, rel=1e-5)
    assert mean["rudder_normal_force"] == pytest.approx(told.normal, rel=1e-5, abs=1e-6)
    assert mean["rudder_angle"] == pytest.approx(math.radians(rudder))
    assert mean["revolutions"] == rate
    along = -float(found["force_x"][0].real)
    # The gauges of this rig stand along the model: struts and model turn together.
    assert (along, across, about) == pytest.approx((told.x, told.y, told.n), rel=1e-5, abs=1e-5)


def test_yaw_with_rudder_reads_the_papers_loads_at_each_instant() -> None:
    made = rig()
    point = replace(tow(0.0, 10.0, RATE_HZ, paper.U0), eccentricity_m=0.05, frequency_hz=0.3)
    point = replace(point, strut_phase_rad=math.pi)
    record = simulate(made, point, periods=2, sample_rate_hz=50.0, seed=1)
    spectra = steady_run(made, point, orders=16).spectra
    half = made.oscillator.half_spacing_m
    # Sixteen orders leave 1 % of the corner where gamma_R changes.
    # Opposite struts of amplitude e, cranks exact: the angle's tangent is their difference.
    angles = np.linspace(0.0, 2.0 * math.pi, 400, endpoint=False)
    motion = np.exp(1j * np.outer(angles, np.arange(17)))
    values = {name: (motion @ one).real for name, one in spectra.items() if len(one) == 17}
    slope = (values["displacement_fore"] - values["displacement_aft"]) / (2.0 * half)
    rate = (values["velocity_fore"] - values["velocity_aft"]) / (2.0 * half)
    heading = np.arctan(slope)
    turning = rate / (1.0 + slope**2)
    # The midpoint moves across a little, by cranks and a pivot that is off it: its own velocity.
    told = [
        paper.steering(*_through(made, values, heading[k], turning[k], k), turning[k],
                       math.radians(10.0), RATE_HZ)
        for k in range(len(angles))
    ]  # fmt: skip
    normal = np.array([one.normal for one in told])
    assert values["rudder_normal_force"] == pytest.approx(normal, abs=0.01 * normal.max())
    swing = float(np.ptp(record["rudder_normal_force"].values))
    assert swing == pytest.approx(float(np.ptp(normal)), rel=0.01)


def _through(
    made: SimulatedRig, values: dict[str, np.ndarray], heading: float, turning: float, k: int
) -> tuple[float, float]:
    half = made.oscillator.half_spacing_m
    pivot = half if made.oscillator.arrangement.pivot.value == "aft" else -half
    held = values["velocity_aft" if pivot > 0.0 else "velocity_fore"][k]
    x_rate = paper.U0 - pivot * math.sin(heading) * turning
    n_rate = held + pivot * math.cos(heading) * turning
    cosine, sine = math.cos(heading), math.sin(heading)
    return x_rate * cosine + n_rate * sine, n_rate * cosine - x_rate * sine


def test_a_propeller_that_stands_leaves_the_rudder_in_the_wake() -> None:
    point = tow(0.0, 10.0, 0.0, paper.U0)
    found = state_at_rest(rig(), point).spectra
    along = paper.EPSILON * paper.U0 * (1.0 - paper.W_P0)
    lift = 0.5 * paper.RHO * paper.A_R * along**2 * paper.F_ALPHA * math.sin(math.radians(10.0))
    assert found["propeller_thrust"][0] == 0.0
    assert found["rudder_normal_force"][0].real == pytest.approx(lift, rel=1e-12)


def test_what_is_missing_is_said() -> None:
    point = tow(0.0, 10.0, RATE_HZ, paper.U0)
    with pytest.raises(ConfigurationError, match=r"rudder angle, but \[steering.rudder\]"):
        rig(None).chain(point)
    with pytest.raises(ConfigurationError, match=r"revolutions, but \[steering.propeller\]"):
        rig(None).chain(point)
    with pytest.raises(ConfigurationError, match=r"acquisition\.propeller_thrust, but nothing"):
        replace(rig(), steering=replace(STEERING, propeller=None)).chain(tow(0.0, 1.0, 0.0, 1.0))
    with pytest.raises(ConfigurationError, match=r"J = 1\.09, outside its open-water table from 0"):
        state_at_rest(rig(), tow(0.0, 0.0, 3.0, paper.U0))
    with pytest.raises(ConfigurationError, match="2, 3 and 3 numbers"):
        OpenWater(0.2, (0.0, 1.0), (1.0, 0.5, 0.0), (0.1, 0.05, 0.0))
