"""A simulated carriage that is led: its lag by Runge-Kutta, its acceleration's loads by Newton."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.setpoint import Medium, SetPoint
from sim.drive.carriage import CarriageSettings
from sim.rig import horizontal_rig
from tests.sim.devices.benches import in_process
from tests.sim.devices.modbus_tables import CARRIAGE

# Of the speed's range: half a step at each end. The derivative at the samples misses 8 %.
GAINED = 0.02
LAG_S, RATE_HZ, SUBSTEPS = 0.08, 100.0, 8


def after(speed: float, told: float) -> float:
    """Return the speed a cycle later, by Runge's and Kutta's steps."""
    step = 1.0 / RATE_HZ / SUBSTEPS
    for _ in range(SUBSTEPS):
        k1 = (told - speed) / LAG_S
        k2 = (told - speed - step / 2.0 * k1) / LAG_S
        k3 = (told - speed - step / 2.0 * k2) / LAG_S
        k4 = (told - speed - step * k3) / LAG_S
        speed += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return speed


@pytest.mark.slow
def test_a_carriage_that_is_led_lags_as_it_is_stated() -> None:
    rig_of = replace(horizontal_rig(), carriage=CarriageSettings(lag_s=LAG_S))
    with in_process({"carriage": CARRIAGE}, rig_of, on_bus=False, serial=("carriage",)) as both:
        rig, world = both
        controller, carriage = world.talkers["carriage"], rig.carriage
        carriage.enable()
        rig.run_until(lambda: carriage.enabled and not carriage.moving, 100, "enable")
        carriage.run_at(0.2)
        rig.run_until(lambda: carriage.at_speed, 500, "speed")
        told, ran, gained, wanted = [], [], [], []
        for k in range(120):
            wanted.append(0.2 + 0.03 * math.sin(4.0 * k / RATE_HZ))
            rig.follower.lead(wanted[-1])
            rig.cycle()
            told.append(controller.number(rig.configuration.carriage.settings.signals.set_speed))
            ran.append(world.plant.value("carriage_speed"))
            gained.append(world.plant.value("carriage_acceleration"))
    most, speed, ramp = 0.5 / RATE_HZ, ran[0], told[0]
    for k in range(1, len(told)):
        speed = after(speed, ramp)
        assert ran[k] == pytest.approx(speed, abs=1e-9)
        ramp += min(max(told[k - 1] - ramp, -most), most)  # told late in the cycle before
    # The acceleration's integral is the speed, of a told step every other cycle too.
    way = np.cumsum(gained) / RATE_HZ
    assert way - way[40] == pytest.approx(np.array(ran) - ran[40], abs=GAINED * 0.06)
    # What is told is what was led some cycles before; where its command is written, two more.
    late = min(range(6), key=lambda n: np.ptp(np.array(told[20:]) - wanted[20 - n : 120 - n]))
    assert 0 < late < 5
    assert np.abs(np.array(told[20:]) - wanted[20 - late : 120 - late]).max() < 0.12 * 4.0 / RATE_HZ


def test_its_acceleration_asks_of_the_struts_what_newton_says() -> None:
    rig, rate_hz, count = horizontal_rig().ideal(), 1000.0, 1200
    point = SetPoint(0.5, 0.15, math.pi, 0.8, Medium.AIR)
    chain = rig.chain(point)
    time_s = np.arange(count) / rate_hz
    speed, gain = 0.8 + 0.1 * np.sin(3.0 * time_s), 0.3 * np.cos(3.0 * time_s)
    given = {"carriage_speed": speed, "carriage_acceleration": gain}
    _, run = chain.run(chain.start(rate_hz, 1), count, given)
    half, body = rig.oscillator.half_spacing_m, rig.body
    aft, fore = run["displacement_aft"], run["displacement_fore"]
    heading = np.arctan2(fore - aft, 2.0 * half)
    ahead = np.array([np.cos(heading), np.sin(heading)])
    to_starboard = np.array([-ahead[1], ahead[0]])
    way = 0.8 * time_s + 0.1 / 3.0 * (1.0 - np.cos(3.0 * time_s))
    centre = np.array([way, aft]) + (half + body.cg_x_m) * ahead
    force = body.mass_kg * twice(centre, rate_hz)
    about_centre = (body.inertia_kg_m2 - body.mass_kg * body.cg_x_m**2) * twice(heading, rate_hz)
    inside = slice(5, -5)
    across = (force * to_starboard).sum(axis=0)
    moment = about_centre + body.cg_x_m * across
    lever = 2.0 * half / np.cos(heading) - half
    for found, exact in (
        (run["force_x"], (force * ahead).sum(axis=0)),
        (run["force_aft"] + run["force_fore"], across),
        (run["force_fore"] * lever - run["force_aft"] * half, moment),
    ):
        assert found[inside] == pytest.approx(
            exact[inside], abs=2e-5 * np.nanmax(np.abs(exact)) + 1e-3
        )
    assert np.abs(body.mass_kg * gain * np.sin(heading)).max() > 2.0  # N, that it would be off


def twice(values: np.ndarray, rate_hz: float) -> np.ndarray:
    """Return the second derivative by time, NaN at both ends."""
    found = np.full(values.shape, np.nan)
    found[..., 1:-1] = (values[..., 2:] - 2.0 * values[..., 1:-1] + values[..., :-2]) * rate_hz**2
    return found
