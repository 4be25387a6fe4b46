"""Drift angles and forces along the model, through rig, recorder and resolver, and back."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import Request, campaign_coefficients
from analysis.coefficients.corrections import zero_reading
from analysis.coefficients.strut_cycle import measured_cycle, static_cycle
from analysis.readers.dataset import from_dataset
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import FORCE_AFT, FORCE_FORE, FORCE_X
from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Digitiser
from sim.model.water.force_laws import CrossFlow, SurgeForces
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate
from tests.analysis.coefficients.single_row import single_row

SPEED = 1.2
ALONG = SurgeForces(x_u=-1.5, x_uu=-8.0, x_vv=-60.0, x_vr=45.0, x_rr=-8.0)
CHANNELS = ("displacement_aft", "displacement_fore", "force_aft", "force_fore", "force_x")
REST = (FORCE_AFT.name, FORCE_FORE.name, FORCE_X.name)
CUBIC = ((900.0, 0.0, 0.0, 0.0), (-90.0, 0.0, 0.0, 0.0))  # Y_vvv = -900, N_vvv = 90


def with_gauge(rig: SimulatedRig, **more: object) -> SimulatedRig:
    acquisition = replace(rig.acquisition, force_x=Digitiser(noise_rms=0.02))
    return replace(rig, acquisition=acquisition, surge=ALONG, **more)  # type: ignore[arg-type]


def turned(strut_phase_rad: float, drift_deg: float) -> SetPoint:
    return SetPoint(0.25, 0.15, strut_phase_rad, SPEED, drift_rad=math.radians(drift_deg))


def moving(rig: SimulatedRig, point: SetPoint, name: str) -> BodyCycle:
    record = simulate(rig, point, periods=8, sample_rate_hz=100.0, seed=len(name), name=name)
    analysis = analyse(
        from_dataset(record), settings=ResolverSettings(channels=CHANNELS, harmonics=3)
    )
    cycle = measured_cycle(analysis, rig.oscillator).model()
    cycle = replace(cycle, mean_known=True)  # as after zero runs that found no offset
    return cycle.without(rig.body, np.array(rig.water.restoring))


def still(rig: SimulatedRig, drift_rad: float, name: str, speed_m_s: float = SPEED) -> BodyCycle:
    point = SetPoint(0.5, 0.0, 0.0, speed_m_s, drift_rad=drift_rad)
    record = simulate(rig, point, periods=10, sample_rate_hz=100.0, seed=len(name), name=name)
    reading = zero_reading(from_dataset(record), REST)
    struts = static_cycle(name, reading, rig.oscillator, point)
    cycle = replace(struts, mean_known=True).model()
    return cycle.without(rig.body, np.array(rig.water.restoring))


def test_static_drift_gives_the_linear_and_the_cubic_derivatives() -> None:
    rig = with_gauge(horizontal_rig(), cross_flow=CrossFlow(cubic=CUBIC))
    angles = np.radians(np.linspace(-8.0, 8.0, 9))
    runs = [still(rig, float(one), f"drift-{k}") for k, one in enumerate(angles)]
    found = campaign_coefficients(runs, Request(trials=2_000))
    for name, put_in in (
        ("Y_v", -120.0), ("N_v", -40.0), ("Y_vvv", -900.0), ("N_vvv", 90.0), ("Y_0", 0.0),
        ("X_0", -1.5 * SPEED - 8.0 * SPEED**2),
        # What goes with u and not with its square differs in v^2 as the turned model loses u.
        ("X_vv", -60.0 - 1.5 / (2.0 * SPEED)),
    ):  # fmt: skip
        row = single_row(found, name, method="surge" if name[0] == "X" else "static drift")
        assert abs(found.values[row] - put_in) < 1.5 * found.half_widths[row], name
        assert found.trials.low[row] < found.values[row] < found.trials.high[row]


def test_a_straight_tow_tells_the_resistance() -> None:
    rig = with_gauge(horizontal_rig())
    for speed in (0.6, 1.2):
        found = campaign_coefficients([still(rig, 0.0, f"tow-{speed}", speed)], Request())
        row = single_row(found, "X_0")
        expected = -1.5 * speed - 8.0 * speed**2
        assert abs(found.values[row] - expected) < 1.5 * found.half_widths[row]
        assert not found.rows("Y_v")  # one heading says nothing of it, and the message what would
        assert any(one.name == "Y_v" and "drift angle" in one.message for one in found.missing)


def test_yaw_with_drift_and_pure_motions_give_surge_terms_less_the_models_own() -> None:
    rig = replace(with_gauge(horizontal_rig()), surge=replace(ALONG, x_u=0.0, x_uu=0.0))
    yaw = 2.0 * math.atan2(2.0 * math.pi * 0.25 * rig.oscillator.half_spacing_m, SPEED)
    runs = [
        moving(rig, SetPoint(0.25, 0.15, 0.0, SPEED), "sway"),
        moving(rig, SetPoint(0.25, 0.15, yaw, SPEED), "yaw"),
        moving(rig, turned(yaw, 4.0), "yaw, drift"),
        moving(rig, turned(yaw, -8.0), "yaw, other drift"),
        moving(rig, SetPoint(0.25, 0.10, 1.2, SPEED), "mixed"),
    ]
    found = campaign_coefficients(runs, Request())
    for name, put_in in (("X_vv", -60.0), ("X_vr", 45.0), ("X_rr", -8.0)):
        row = single_row(found, name, method="surge")
        assert abs(found.values[row] - put_in) < 1.5 * found.half_widths[row], name
    for name, put_in in (("Y_v", -120.0), ("Y_r", 15.0), ("N_v", -40.0), ("N_r", -35.0)):
        row = single_row(found, name, method="higher order, several runs")
        assert abs(found.values[row] - put_in) < 2.0 * found.half_widths[row], name


@pytest.mark.parametrize("nonlinear", [True, False])
def test_a_vertical_campaign_with_a_surge_gauge_tells_x(nonlinear: bool) -> None:
    rig = replace(with_gauge(vertical_rig()), surge=replace(ALONG, x_u=0.0, x_uu=0.0))
    runs = [
        moving(rig, SetPoint(0.6, amplitude, phase, SPEED), f"{name}-{amplitude}")
        for amplitude in (0.01, 0.02)
        for name, phase in (("heave", 0.0), ("pitch", math.pi))
    ]
    found = campaign_coefficients(runs, Request(nonlinear=nonlinear))
    for name, put_in in (("X_ww", -60.0), ("X_qq", -8.0)):
        rows = found.rows(name)
        assert bool(rows) is nonlinear
        for row in rows:
            assert abs(found.values[row] - put_in) < 1.5 * found.half_widths[row], name
