"""What a plan asks of a carriage that follows the struts, against peaks differenced by hand."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hardware.description.carriage_path import CarriagePath
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.rig_configuration import read_rig
from pmm.plan.condition_checks import motion_of
from pmm.plan.duration import tank_length_m
from pmm.plan.limits import limit_findings
from pmm.plan.plan import examine_plan
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import Limits
from pmm.plan.run_plan import RunPlan
from sim.devices.bench_file import DRIVERS
from tests.analysis.response.test_steady_ahead_against_rotations import AMPLITUDE, HZ, point_of
from tests.pmm.plan.plans import rig_file, write_plan
from tests.pmm.run.harness import oscillation
from tests.sim.devices.modbus_tables import CARRIAGE
from tests.sim.devices.test_paths_against_exact_struts import PATHS

PORT = {"url": "socket://plc:502"}
POINTS = 7200


def rig_with(*without: str, **carriage: Any) -> RigFile:
    tables = {**PATHS, "carriage": {**CARRIAGE, **carriage, "port": PORT}}
    tables = {key: one for key, one in tables.items() if key not in without}
    tables["bus"] = {"interface": "virtual", "channel": "none"}
    hardware = read_rig(tables, DRIVERS)
    return replace(
        rig_file(), oscillator=HORIZONTAL_1963, hardware=hardware, tank=None, limits=Limits()
    )


def run() -> RunPlan:
    return replace(oscillation("yaw", HZ), set_point=point_of(HORIZONTAL_1963))


def told() -> np.ndarray:
    path = CarriagePath.of(HORIZONTAL_1963, run().set_point)
    return np.array([path.at(2.0 * math.pi * k / POINTS) for k in range(POINTS)])


def refused(rig: RigFile, one: RunPlan | None = None) -> list[str]:
    return [found.message for found in limit_findings(one or run(), rig)]


def after_s(text: str) -> float:
    return float(text.split("the carriage: ")[1].split(" s into")[0])


def test_it_passes_where_the_carriage_can() -> None:
    assert refused(rig_with()) == []
    made = motion_of(run(), rig_with())
    assert np.abs(made.velocity[1]).max() < 1e-6  # no angle to the flow is told


def test_a_speed_beyond_the_carriages_own_is_refused_with_its_place() -> None:
    speed = told()
    (text,) = refused(rig_with(highest_speed_m_s=0.81, return_speed_m_s=0.5))
    assert text.startswith(f"speed [m/s] = {speed.max():.4g} is above 0.81")
    assert abs(after_s(text) - speed.argmax() / POINTS / HZ) % (0.5 / HZ) < 0.02


def test_an_acceleration_beyond_the_carriages_own_is_refused_with_its_place() -> None:
    gain = np.abs(np.gradient(told(), 1.0 / HZ / POINTS))
    (text,) = refused(rig_with(acceleration_m_s2=0.1))
    assert text.startswith(f"carriage acceleration [m/s^2] = {gain[5:-5].max():.4g} is above 0.1")
    turned = after_s(text) * HZ * POINTS
    assert gain[round(turned) % POINTS] == pytest.approx(gain[5:-5].max(), rel=1e-3)


def test_a_carriage_that_would_turn_back_is_refused() -> None:
    slow = replace(run().set_point, carriage_speed_m_s=0.02, frequency_hz=1.0)
    texts = refused(rig_with(), replace(run(), set_point=slow))
    assert any("slowest speed of a carriage" in one and "is below 0" in one for one in texts)


def test_the_way_is_that_of_the_mean_speed() -> None:
    one = run()
    mean = told().mean()
    assert mean < 0.98 * 0.8
    still = 0.5 + one.moving_s + 0.15 + HZ / PATHS["shaft"]["acceleration_hz_per_s"] + 0.8 / 0.5
    assert tank_length_m(one, rig_with()) == pytest.approx(mean * still, rel=1e-6)


@pytest.mark.parametrize(
    ("without", "remedy"),
    [
        (("carriage",), "[carriage] needs a driver"),
        (("shaft", "eccentricity", "phase", "photocell"), 'driver = "path-struts"'),
    ],
)
def test_what_cannot_follow_is_refused_with_the_remedy(
    without: tuple[str, ...], remedy: str
) -> None:
    (text,) = [one for one in refused(rig_with(*without)) if "steady_ahead" in one]
    assert remedy in text
    assert "or leave steady_ahead out" in text


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("steady_ahead = true\nspeeds_m_s = 0.8", "goes with exact = true"),
        ("exact = true\nsteady_ahead = true", "needs speeds_m_s above 0"),
        ("exact = true\nsteady_ahead = true\nspeeds_m_s = [0.8, 0.0]", "needs speeds_m_s above 0"),
        ('kind = "dry"\nexact = true\nsteady_ahead = true\nspeeds_m_s = 0.8', "is of no use"),
    ],
)
def test_keys_that_do_not_go_together_are_named(tmp_path: Any, keys: str, words: str) -> None:
    import tomllib

    text = f'[[runs]]\nmotion = "pitch"\nfrequencies_hz = 0.8\namplitudes_mm = 20.0\n{keys}\n'
    path = write_plan(tmp_path, text)
    faults = examine_plan(tomllib.loads(text), path).faults
    assert any(words in one.message for one in faults), faults


def test_the_amplitude_is_a_strut_s_largest() -> None:
    assert point_of(HORIZONTAL_1963).eccentricity_m == AMPLITUDE
