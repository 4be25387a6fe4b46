"""Records of every kind of sensor from the simulator, through the jobs, against the bodies' truth.

A phone's gyro and accelerometer, motion capture, an ultrasonic range finder, an inclinometer that
is carried along, light gates, a stopwatch; with friction, drag, offset and noise.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers.dataset import from_dataset
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.inertia import bifilar, pendulum, swing
from pmm.inertia.outcome import Outcome
from sim.acquisition.channels import Digitiser
from sim.pendulum.bench import PendulumBench
from sim.pendulum.benches import KEELBOAT_2014, SWING_2021, compound_bench, swing_bench
from sim.pendulum.coordinates import ANGLE
from sim.pendulum.effects import make_effect
from sim.pendulum.pivot import Pendulum, RigidPart
from sim.pendulum.record import PendulumRecord, record
from sim.pendulum.sensors import Sensor
from sim.pendulum.simulation import simulate_bifilar, simulate_stopwatch

BODY = RigidPart(mass_kg=12.0, lever_m=0.4, inertia_kg_m2=12.0 * 0.3**2)
HEAD = f"gravity_m_s2 = {STANDARD_GRAVITY_M_S2}\nu_gravity_m_s2 = 1e-5\n"


def accelerometer(radius_m: float) -> Sensor:
    """A phone's, along the motion: what the pivot and gravity together do there."""
    felt = ((ANGLE.acceleration, radius_m), (ANGLE.displacement, STANDARD_GRAVITY_M_S2))
    return Sensor(Channel("tangential", "m/s2"), felt)


def losses(coordinate: str, noise: float, offset: float) -> list[object]:
    return [
        make_effect("bearing_friction", coordinate=coordinate, dead_zone=2e-5),
        make_effect("quadratic_drag", coordinate=coordinate, loss=0.2),
        make_effect("sensor_offset", offset=offset),
        make_effect("sensor_noise", noise_rms=noise),
    ]


def phone(seed: int) -> PendulumRecord:
    bench = compound_bench(Pendulum((BODY,)), release_rad=0.08)
    sensors = (*bench.sensors, accelerometer(0.7))
    bench = replace(bench, sensors=sensors, digitisers=(Digitiser(),) * len(sensors))
    return _run(bench.with_effects(losses("angle", 1e-3, 2e-3)), seed, 60.0, 50.0)


def _run(bench: PendulumBench, seed: int, duration_s: float, rate_hz: float) -> PendulumRecord:
    return record(bench, duration_s=duration_s, sample_rate_hz=rate_hz, seed=seed)


def write(path: Path, one: PendulumRecord, headers: dict[str, tuple[str, float]]) -> str:
    """Write channels as text under the headers and in the units of a lab's software."""
    kept = from_dataset(one.dataset)
    columns = [kept.values(name) * factor for name, (_, factor) in headers.items()]
    rows = np.column_stack([kept.time_s(), *columns])
    names = ",".join(["Time [s]", *(header for header, _ in headers.values())])
    np.savetxt(path, rows, delimiter=",", header=names, comments="", fmt="%.7g")
    return path.name


def found(outcome: Outcome, name: str) -> tuple[float, float]:
    one = next(one.estimate for one in outcome.findings if one.name == name)
    return one.value, one.uncertainty


@pytest.mark.slow
@pytest.mark.parametrize(
    ("channel", "header", "factor"),
    [
        ("angle_rate", "Gyroscope y [rad/s]", 1.0),
        ("angle_rate", "Gyroscope y [deg/s]", np.degrees(1.0)),
        ("tangential", "Acceleration x [m/s2]", 1.0),
        ("angle", "Marker 3 [deg]", np.degrees(1.0)),
    ],
)
def test_a_phone_and_motion_capture_on_a_compound_pendulum(
    channel: str, header: str, factor: float, tmp_path: Path
) -> None:
    names = [
        write(tmp_path / f"{seed}.csv", phone(seed), {channel: (header, factor)})
        for seed in (1, 2, 3)
    ]
    (tmp_path / "job.toml").write_text(
        f"{HEAD}depth_m = 0.4\nu_depth_m = 5e-4\n[period]\nrecords = {names}\n"
    )
    value, uncertainty = found(pendulum.run(str(tmp_path / "job.toml")), "k_pitch_m")
    assert value == pytest.approx(0.3, rel=1e-3)
    assert abs(value - 0.3) < 3.0 * uncertainty


def test_a_phones_weaker_axis_is_flagged(tmp_path: Path) -> None:
    one = phone(1)
    headers = {"angle_rate": ("y [rad/s]", 1.0), "angle": ("x [rad/s]", 0.05)}
    name = write(tmp_path / "1.csv", one, headers)
    (tmp_path / "job.toml").write_text(
        f'{HEAD}depth_m = 0.4\n[period]\nrecords = ["{name}"]\nchannel = "x"\n'
    )
    outcome = pendulum.run(str(tmp_path / "job.toml"))
    assert "weaker_axis" in {flag.code for flag in outcome.flags}


def hull(seed: int, yaw_rad: float = 0.06, sway_m: float = 0.04) -> PendulumRecord:
    effects = [*losses("yaw", 1e-3, 0.02), make_effect("viscous_damping", coordinate="sway")]
    return simulate_bifilar(
        KEELBOAT_2014,
        effects=effects,
        seed=seed,
        yaw_rad=yaw_rad,
        sway_m=sway_m,
        stern_lever_m=3.0,
        sample_rate_hz=10.0,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("channel", "header", "factor", "oscillations"),
    [
        ("stern_displacement", "Range [mm]", 1e3, 2),
        ("yaw", "Heading [deg]", np.degrees(1.0), 1),
    ],
)
def test_a_range_finder_and_motion_capture_on_two_lines(
    channel: str, header: str, factor: float, oscillations: int, tmp_path: Path
) -> None:
    records = [hull(seed) for seed in (1, 2, 3)]
    names = [
        write(tmp_path / f"{k}.csv", one, {channel: (header, factor)})
        for k, one in enumerate(records)
    ]
    gates = [records[k].write_gates(tmp_path / f"gates-{k}.csv").name for k in range(3)]
    lines = "half_spacing_m = 0.9\nu_half_spacing_m = 2e-4\nline_m = 3.477\nu_line_m = 5e-4\n"
    text = (
        f'{HEAD}[[suspensions]]\nname = "range"\n{lines}[suspensions.yaw]\nrecords = {names}\n'
        f'oscillations = {oscillations}\n[[suspensions]]\nname = "gates"\n{lines}'
        f"[suspensions.yaw]\ngates = {gates}\n"
    )
    (tmp_path / "job.toml").write_text(text)
    outcome = bifilar.run(str(tmp_path / "job.toml"))
    true = KEELBOAT_2014.yaw_gyradius_m
    by_records, by_gates = (
        found(outcome, f"{key}_k_yaw_by_period_m") for key in ("range", "gates")
    )
    assert by_records[0] == pytest.approx(true, rel=1e-3)
    assert by_gates[0] == pytest.approx(true, rel=1e-3)
    assert by_records[0] == pytest.approx(by_gates[0], rel=5e-4)


@pytest.mark.slow
def test_beats_are_counted_in_records(tmp_path: Path) -> None:
    """Yaw and sway of one size at the stern; three records of four beats each."""
    names = [
        write(
            tmp_path / f"{seed}.csv", hull(seed, 0.04, 0.12), {"stern_displacement": ("y [m]", 1.0)}
        )
        for seed in (1, 2, 3)
    ]
    (tmp_path / "job.toml").write_text(
        f"{HEAD}[[suspensions]]\nhalf_spacing_m = 0.9\nu_half_spacing_m = 2e-4\nline_m = 3.477\n"
        f"beats = {{ records = {names} }}\n"
    )
    value, uncertainty = found(bifilar.run(str(tmp_path / "job.toml")), "k_yaw_m")
    assert value == pytest.approx(KEELBOAT_2014.yaw_gyradius_m, rel=5e-3)
    assert abs(value - KEELBOAT_2014.yaw_gyradius_m) < 3.0 * uncertainty
    assert uncertainty < 0.01 * value


@pytest.mark.slow
def test_a_carried_inclinometer_and_motion_capture_see_the_same_amplitude(tmp_path: Path) -> None:
    """Below the upper pivot P2 it reads -0.05 of the angle: refused; below P1, 0.93 of it."""
    bench = swing_bench(release_rad=0.03).with_effects(losses("angle", 2e-5, 1e-3))
    names = {"inclinometer_angle": ("Tilt [deg]", np.degrees(1.0)), "angle": ("Angle [rad]", 1.0)}
    write(tmp_path / "1.csv", _run(bench, 1, 160.0, 16.0), names)
    amplitudes = []
    for channel, more in (("Tilt", "inclinometer_radius_m = 0.92"), ("Angle", ""), ("Tilt", "")):
        (tmp_path / "job.toml").write_text(
            f"{HEAD}[tare]\nmass_kg = 42.28\ncg_below_pivot_m = 0.0719\n[tare.period]\n"
            f'records = ["1.csv"]\nchannel = "{channel}"\n{more}\n'
        )
        outcome = swing.run(str(tmp_path / "job.toml"))
        inertia = SWING_2021.about_pivot_kg_m2
        assert found(outcome, "tare_i_pivot_kg_m2")[0] == pytest.approx(inertia, rel=1e-3)
        amplitudes.append(outcome.periods[0].records[0].fit.modes[0].amplitude)
    assert amplitudes[0] == pytest.approx(amplitudes[1], rel=4e-3)  # its non-linearity
    assert amplitudes[2] == pytest.approx(0.93 * amplitudes[1], rel=0.01)


def test_an_inclinometer_that_reads_no_angle_is_refused(tmp_path: Path) -> None:
    bench = swing_bench(upper_pivot=True, release_rad=0.03)
    record_of = _run(bench.with_effects(losses("angle", 2e-5, 0.0)), 1, 60.0, 16.0)
    write(tmp_path / "1.csv", record_of, {"inclinometer_angle": ("Tilt [rad]", 1.0)})
    (tmp_path / "job.toml").write_text(
        f"{HEAD}[tare]\nmass_kg = 42.28\ncg_below_pivot_m = 1.2719\n[tare.period]\n"
        'records = ["1.csv"]\ninclinometer_radius_m = 2.12\n'
    )
    with pytest.raises(ConfigurationError, match=r"reads -0\.056 of the angle"):
        swing.run(str(tmp_path / "job.toml"))


def test_a_stopwatch_on_the_simulated_swing(tmp_path: Path) -> None:
    bench = swing_bench().with_effects([make_effect("viscous_damping")])
    times = simulate_stopwatch(bench, swings=10, readings=4, reaction_s=0.1, seed=5)
    rows = ", ".join(f"{{ swings = 10, duration_s = {one} }}" for one in times.tolist())
    (tmp_path / "job.toml").write_text(
        f"{HEAD}[tare]\nmass_kg = 42.28\ncg_below_pivot_m = 0.0719\n"
        f"period = {{ stopwatch = [{rows}] }}\n"
    )
    value, uncertainty = found(swing.run(str(tmp_path / "job.toml")), "tare_i_pivot_kg_m2")
    assert abs(value - SWING_2021.about_pivot_kg_m2) < 3.0 * uncertainty
    assert uncertainty < 0.01 * value
