"""Measured records that are kept here (``tests/data/README.md``), as a user would analyse them.

What they are compared with is certified by NIST, cut by hand stride by stride, or fitted to a
spline; for what a script made, it is what the script put in.
"""

import json
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from analysis.inertia.record import analyse_record
from analysis.inertia.series import series_from_recording
from analysis.readers import read_recording
from analysis.readers.columns_options import parse_options
from hardware.description.arrays import FloatArray
from pmm.cli import cli
from tests.data.made import make

DATA = Path(__file__).parents[1] / "data"


def told(*words: object) -> dict[str, Any]:
    done = CliRunner().invoke(cli, [*map(str, words), "--json"], catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return dict(json.loads(done.stdout))


def resolved(path: Path, *words: object) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return a recording's row and its one channel."""
    (row,) = told("analyse", path, *words)["runs"]
    (channel,) = row["gates"][0]["channels"]
    return row, channel


def written(path: Path, header: str, columns: FloatArray) -> Path:
    np.savetxt(path, columns, "%.9g", delimiter=",", header=header, comments="")
    return path


def test_annual_harmonic_is_within_its_certified_deviation(tmp_path: Path) -> None:
    pressure, month = np.loadtxt(DATA / "enso" / "ENSO.dat", skiprows=60).T
    path = written(tmp_path / "enso.csv", "time_s,pressure", np.column_stack((month, pressure)))
    words = ("--frequency", 1.0 / 12.0, "--opens-at", 1, "--periods", 13, "--harmonics", 1)
    _, channel = resolved(path, *words)
    # certified: 10.511(175) + 3.076(243) cos + 0.533(244) sin of 2 pi month/12
    (first,) = channel["harmonics"]
    turned = 2.0 * math.pi / 12.0  # our phase begins with the gate, in the first month
    cosine = 3.0762 * math.cos(turned) + 0.5328 * math.sin(turned)
    sine = 0.5328 * math.cos(turned) - 3.0762 * math.sin(turned)
    assert first["quadrature"]["value"] == pytest.approx(cosine, abs=0.243)
    assert first["in_phase"]["value"] == pytest.approx(sine, abs=0.244)
    assert first["amplitude"]["value"] == pytest.approx(math.hypot(3.0762, 0.5328), abs=0.243)
    assert channel["mean"]["value"] == pytest.approx(10.511, abs=0.175)


def strides(time_s: FloatArray, force_n: FloatArray, start_s: float, end_s: float) -> FloatArray:
    """Return mean and amplitudes of harmonics 1 to 3, from each time the force passes 300 N up."""
    at = np.flatnonzero((force_n[:-1] < 300.0) & (force_n[1:] >= 300.0))
    share = (300.0 - force_n[at]) / (force_n[at + 1] - force_n[at])
    strikes = time_s[at] + share * (time_s[at + 1] - time_s[at])
    strikes = strikes[np.append(True, np.diff(strikes) > 0.8)]
    strikes = strikes[(strikes > start_s - 0.1) & (strikes < end_s + 0.1)]
    even, found = np.arange(200) / 200.0, []
    for begin, end in pairwise(strikes):
        one = np.fft.rfft(np.interp(begin + (end - begin) * even, time_s, force_n))[:4] / 200.0
        found.append(one * np.exp(-1j * np.arange(4) * np.angle(one[1])) * [1.0, 2.0, 2.0, 2.0])
    return np.asarray(np.abs(np.mean(found, axis=0)))


def test_force_of_walking_is_that_of_strides_cut_by_hand(tmp_path: Path) -> None:
    rows = np.loadtxt(DATA / "treadmill" / "vertical_force.csv", delimiter=",")
    path = written(tmp_path / "force.csv", "time_s,force [N]", rows)
    row, channel = resolved(path, "--reference", "force", "--channel", "force")
    assert {"speed_change"} <= {flag["code"] for flag in row["gates"][0]["flags"]}
    opened_s, periods = row["window_opened_s"], row["window_periods"]
    closed_s = opened_s + periods / row["gates"][0]["frequency_hz"]
    by_hand = strides(*rows.T, opened_s, closed_s)
    ours = [channel["mean"], *(one["amplitude"] for one in channel["harmonics"])]
    for found, expected in zip(ours, by_hand, strict=True):
        assert found["value"] == pytest.approx(expected, abs=found["half_width"])
        assert found["half_width"] < 5.0


def test_gyroscope_and_attitude_of_one_unit_tell_the_same_turn(tmp_path: Path) -> None:
    attitude, sensors = (
        np.loadtxt(DATA / "ngimu" / f"{name}.csv", delimiter=",", skiprows=1)
        for name in ("quaternion", "sensors")
    )
    turn = Rotation.from_quat(attitude[:, [2, 3, 4, 1]]).inv()  # the earth's, seen by the unit
    steps = (turn[:-1].inv() * turn[1:]).as_rotvec()
    pitch_deg = np.degrees(np.append(0.0, np.cumsum(steps[:, 1])))
    time_s, gyro = sensors[:, 0], sensors[:, 2]
    first = written(
        tmp_path / "attitude.csv",
        "time_s,pitch [deg]",
        np.column_stack((attitude[:, 0], pitch_deg)),
    )
    second = written(tmp_path / "gyro.csv", "time_s,rate [deg/s]", np.column_stack((time_s, gyro)))
    found = told("compare", f"{first}:pitch", f"{second}:rate", "--derivative", 1)
    rate, inside = CubicSpline(attitude[:, 0], pitch_deg).derivative(), slice(50, 450)

    def left(asked: FloatArray) -> FloatArray:
        gain, lag_s, offset = asked
        return np.asarray(gain * rate(time_s[inside] - lag_s) + offset - gyro[inside])

    gain, lag_s, _ = least_squares(left, np.array([1.0, 0.0, 0.0])).x
    # both have errors: fitted to each other either way they enclose the gain
    other_way = gain / np.corrcoef(rate(time_s[inside] - lag_s), gyro[inside])[0, 1] ** 2
    half = found["gain"]["half_width"]
    assert gain - half < found["gain"]["value"] < other_way + half
    assert abs(found["gain"]["value"] - 1.0) < half < 0.02
    assert found["lag"]["value"] == pytest.approx(lag_s, abs=found["lag"]["half_width"])
    assert found["lag"]["half_width"] < 0.01


def test_a_decay_that_a_hand_cuts_down_is_used_up_to_there() -> None:
    path = DATA / "made" / "decay.csv.gz"
    np.testing.assert_allclose(np.loadtxt(path, delimiter=",", skiprows=1), make.swing(), atol=2e-6)
    run = analyse_record(series_from_recording(read_recording(path), "angle"))
    (flag,) = run.flags
    assert flag.code == "regime_change"
    moment_s = float(flag.message.split(" at ")[1].split(" s ")[0])
    assert moment_s == pytest.approx(make.TOUCHED_S, abs=make.PERIOD_S)
    mode = run.fit.modes[0]
    assert mode.damping_ratio == pytest.approx(make.RATIO, rel=2e-3)
    assert mode.period_s == pytest.approx(make.PERIOD_S, rel=2e-4)


@pytest.mark.slow
def test_a_struck_beam_rings_as_its_frequency_response_says() -> None:
    columns = parse_options(["acc=Time_chan_2:m/s2"])
    beam = read_recording(
        DATA / "beam" / "case1.mat", replace(columns, sample_rate_hz=1280.0)
    ).between(0.05, 3.2)
    run = analyse_record(series_from_recording(beam, "acc"))
    (mode,) = run.fit.modes
    # vibration_toolbox documents 212.092530551 Hz, fitted to the analyser's response at 0.3 Hz.
    assert 1.0 / mode.period_s == pytest.approx(212.0925, abs=0.02)
    assert 1.0 / run.period().value == pytest.approx(212.11, abs=0.02)
    # Amplitudes at 212.1 Hz over 128 periods each, by the sum of a windowed transform.
    time_s, values = beam.time_s(), beam.values("acc")
    sizes = []
    for middle_s in (0.5, 1.9):
        window = np.cos(np.pi * np.clip((time_s - middle_s) / 0.6, -0.5, 0.5)) ** 2
        sizes.append(abs(np.sum(window * values * np.exp(-2j * np.pi * 212.1 * time_s))))
    decrement = math.log(sizes[0] / sizes[1]) / 1.4
    assert mode.damping_ratio == pytest.approx(decrement / (2.0 * math.pi * 212.1), rel=0.03)
    assert "structured_residual" in {flag.code for flag in run.flags}  # its damping changes


def test_axes_that_contradict_each_other_are_told_from_the_wrong_one() -> None:
    path = DATA / "made" / "axes.toml"
    assert path.read_text() == make.axes()
    (found,) = told("inertia", "pendulum", path)["redundancy"]
    assert found["stands_out"] == ["axis at 31.2 deg"]
    without = found["data"][2]["without"]
    asked = [without[name] for name in ("ixx_kg_m2", "izz_kg_m2", "ixz_kg_m2")]
    assert asked == pytest.approx(list(make.INERTIA), abs=1e-3)
