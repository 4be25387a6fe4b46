"""Restoring, static drift and straight tow, against the loads that recordings were built of."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from analysis.coefficients.exchange import to_dict
from analysis.readers import write_recording
from analysis.recording import Recording
from hardware.description.channels import Channel
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from pmm.document.data import as_data
from pmm.evaluation.evaluation import Evaluation
from pmm.evaluation.water_tests import InWater, in_water
from pmm.report.evaluation_document import evaluation_document
from pmm.report.slow_tests import drift_figure
from tests.analysis.coefficients.single_row import single_row

HALF_M = 0.5
RATE_HZ = 50.0
NOISE_N = 0.05
STIFFNESS = np.array([[6900.0, 345.0], [345.0, 2400.0]])  # about the midpoint
DAMPING = np.array([[190.0, 12.0], [12.0, 55.0]])
MASS, ADDED = np.array([[70.0, 1.4], [1.4, 27.5]]), np.array([[75.0, 3.0], [3.0, 22.0]])
WEIGHT = 70.0 * 9.80665 * 0.02  # m g z_G, against pitch
FREQUENCY_HZ = 0.05
HEAD = """
[oscillator]
preset = "{plane}-1963"
frequency_hz = {{ low = 0.01, high = 2.0 }}
[model]
mass_kg = 70.0
inertia_kg_m2 = 27.5
cg_x_m = -0.02
cg_z_m = 0.02
[hull]
added_mass = [[75.0, 3.0], [3.0, 22.0]]
restoring = {restoring}
"""
TURNED = """
[[runs]]
name = "{name}"
kind = "restoring"
frequency_hz = 0.05
eccentricity_m = 0.02
strut_phase_rad = {phase}
"""
STILL = """
[[at_rest]]
name = "{name}"
kind = "{kind}"
file = "{name}.nc"
duration_s = 10.0
carriage_speed_m_s = {speed}
drift_deg = {drift}
{zeros}
"""


def write(folder: Path, name: str, rows: dict[str, np.ndarray], point: SetPoint | None) -> None:
    units = {"shaft_angle": "rad", "displacement_aft": "m", "displacement_fore": "m"}
    channels = tuple(Channel(key, units.get(key, "N")) for key in rows)
    samples = np.array(list(rows.values()))
    write_recording(
        Recording(name, channels, samples, RATE_HZ, set_point=point), folder / f"{name}.nc"
    )


def turned(folder: Path, name: str, phase_rad: float, *, seed: int = 1, bent: float = 0.0) -> str:
    """A slow turn on the vertical oscillator; ``bent`` is a cubic part of the heave force."""
    time_s = np.arange(0.0, 5.0 / FREQUENCY_HZ, 1.0 / RATE_HZ)
    omega = 2.0 * math.pi * FREQUENCY_HZ
    theta = omega * time_s
    struts = 0.02 * np.array([np.sin(theta), np.sin(theta + phase_rad)])
    speeds = 0.02 * omega * np.array([np.cos(theta), np.cos(theta + phase_rad)])

    pitch = np.arctan((struts[0] - struts[1]) / (2.0 * HALF_M))  # the fore end slides
    moved = np.array([struts[0] - HALF_M * np.sin(pitch), pitch])
    slow = np.array([speeds.mean(axis=0), (speeds[0] - speeds[1]) / (2.0 * HALF_M)])
    loads = (STIFFNESS - omega**2 * (MASS + ADDED)) @ moved + DAMPING @ slow
    loads[1] += WEIGHT * np.sin(pitch)
    loads[0] += bent * moved[0] ** 3
    fore = (HALF_M * loads[0] - loads[1]) * np.cos(pitch) / (2.0 * HALF_M)
    noise = NOISE_N * np.random.default_rng(seed).normal(size=(2, time_s.size))
    rows = {
        "shaft_angle": np.mod(theta, 2.0 * math.pi),
        "displacement_aft": struts[0],
        "displacement_fore": struts[1],
        "force_aft": loads[0] - fore + noise[0],
        "force_fore": fore + noise[1],
    }
    write(folder, name, rows, SetPoint(FREQUENCY_HZ, 0.02, phase_rad))
    return TURNED.format(name=name, phase=phase_rad)


def evaluated(folder: Path, text: str, plane: str = "vertical", *, hull: bool = True) -> InWater:
    restoring = STIFFNESS.tolist() if hull else [[0.0, 0.0], [0.0, 0.0]]
    path = folder / "campaign.toml"
    path.write_text(HEAD.format(plane=plane, restoring=restoring) + text, encoding="utf-8")
    return in_water(read_campaign(path), folder)


@pytest.mark.parametrize(
    ("phase_rad", "motion", "column"), [(0.0, "heave", 0), (math.pi, "pitch", 1)]
)
def test_stiffness_is_that_of_the_water_and_the_weight(
    tmp_path: Path, phase_rad: float, motion: str, column: int
) -> None:
    found = evaluated(tmp_path, turned(tmp_path, "slow", phase_rad))
    assert found.failed == ()
    (one,) = found.restoring
    assert one.motion == motion
    truth = (STIFFNESS + np.diag([0.0, WEIGHT]))[:, column]
    assert (one.hydrostatic_force, one.hydrostatic_moment) == pytest.approx(tuple(truth))
    # Pitch by struts that slide heaves the midpoint by l (tan - sin), 3/8 l theta^2 a radian.
    truth += column * 3.0 / 8.0 * HALF_M * 0.04**2 * STIFFNESS[:, 0]
    assert abs(one.force - truth[0]) < 2.0 * one.force_half_width
    assert abs(one.moment - truth[1]) < 2.0 * one.moment_half_width
    assert 0.0 < one.force_half_width < 1e-3 * STIFFNESS[0, 0]
    square = (2.0 * math.pi * FREQUENCY_HZ) ** 2
    taken = -square * (MASS + ADDED)[:, column]
    assert (one.force_inertia, one.moment_inertia) == pytest.approx(tuple(taken), rel=1e-6)
    wanted = 2.0 * math.pi * FREQUENCY_HZ * DAMPING[column, column] / truth[column]
    assert one.loop == pytest.approx(wanted, rel=0.02)
    (track,) = found.tracks
    assert np.ptp(track.displacement) == pytest.approx(0.04 if column == 0 else 0.08, rel=1e-3)


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say(tmp_path: Path) -> None:
    text = "".join(turned(tmp_path, f"slow-{k}", 0.0, seed=k) for k in range(40))
    found = evaluated(tmp_path, text).restoring
    inside = [abs(one.force - STIFFNESS[0, 0]) < one.force_half_width for one in found]
    assert 34 <= sum(inside) <= 40, "38 expected; fewer than 34 come once in 200"


def test_a_bent_characteristic_shows_in_the_harmonics(tmp_path: Path) -> None:
    cubic = 0.1 * STIFFNESS[0, 0] / 0.02**2  # a tenth at the end of the stroke
    text = turned(tmp_path, "straight", 0.0) + turned(tmp_path, "bent", 0.0, bent=cubic)
    straight, bent = evaluated(tmp_path, text).restoring
    assert straight.higher < 2e-3
    # x^3 has 3/4 of its size in the first harmonic and 1/4 in the third.
    assert bent.higher == pytest.approx(0.025 / 1.075, rel=0.02)
    assert bent.force == pytest.approx(1.075 * STIFFNESS[0, 0], rel=1e-3)


def test_without_hydrostatics_nothing_is_compared(tmp_path: Path) -> None:
    (one,) = evaluated(tmp_path, turned(tmp_path, "slow", 0.0), hull=False).restoring
    assert one.hydrostatic_force is None
    assert one.hydrostatic_moment is None


def test_a_mixed_motion_is_named_and_stops_no_other(tmp_path: Path) -> None:
    text = turned(tmp_path, "mixed", 1.0) + turned(tmp_path, "pure", 0.0)
    found = evaluated(tmp_path, text)
    assert [one.run for one in found.restoring] == ["pure"]
    (failed,) = found.failed
    assert "mixed: translation (17.6 mm) and rotation (9.59 mm" in failed.message
    assert "a run of each alone" in failed.message


Y_V, N_V, Y_VVV, U = -120.0, -40.0, -900.0, 0.8
OFFSET = {"force_aft": 0.7, "force_fore": -0.4, "force_x": 0.2}


def towed(
    folder: Path, name: str, kind: str, drift_deg: float, speed: float, *, zeros: bool = True
) -> str:
    v = -speed * math.sin(math.radians(drift_deg))
    water = np.array([Y_V * v + Y_VVV * v**3, N_V * v])  # on the model
    struts = {
        "force_aft": -water[0] / 2.0 + water[1] / (2.0 * HALF_M),
        "force_fore": -water[0] / 2.0 - water[1] / (2.0 * HALF_M),
        "force_x": 5.0 * speed**2,
    }
    if kind == "zero":
        struts = dict.fromkeys(struts, 0.0)
    rng = np.random.default_rng(round(1000.0 + 10.0 * drift_deg + 100.0 * speed))
    rows = {
        key: value + OFFSET[key] + NOISE_N * rng.normal(size=500) for key, value in struts.items()
    }
    write(folder, name, rows, None)
    named = 'zero_before = "zero-1"\nzero_after = "zero-2"' if zeros and kind != "zero" else ""
    return STILL.format(name=name, kind=kind, speed=speed, drift=drift_deg, zeros=named)


def campaign_of_tows(folder: Path, angles: tuple[float, ...], *, zeros: bool = True) -> str:
    text = "".join(towed(folder, f"zero-{k}", "zero", 0.0, 0.0) for k in (1, 2))
    for angle in angles:
        text += towed(folder, f"drift{angle:g}", "static-drift", angle, U, zeros=zeros)
    for speed in (0.4, U):
        text += towed(folder, f"tow{speed:g}", "straight-tow", 0.0, speed, zeros=zeros)
    return text


ANGLES = (-12.0, -8.0, -4.0, 4.0, 8.0, 12.0)


@pytest.mark.slow
def test_derivatives_of_a_drifting_model(tmp_path: Path) -> None:
    found = evaluated(tmp_path, campaign_of_tows(tmp_path, ANGLES), "horizontal")
    assert found.failed == ()
    told = found.derivatives
    assert told is not None
    force, moment = told.choices
    assert (force.verdict, moment.verdict) == ("cubic", "linear")
    for name, unit, truth in (
        ("Y_v", "N s/m", Y_V),
        ("N_v", "N s", N_V),
        ("Y_vvv", "N s3/m3", Y_VVV),
        ("Y_0", "N", 0.0),
    ):
        k = single_row(told, name, method="static drift")
        assert told.entries[k].unit == unit
        assert told.entries[k].speed_m_s == U
        assert abs(told.values[k] - truth) < 1.5 * told.half_widths[k]
        assert len(told.entries[k].runs) == 7, "the straight tow at this speed is one of them"
        assert 0.2 < told.entries[k].misfit < 3.0


def _near(value: object) -> object:
    """Numbers to rounding, all else as it is."""
    numbers = isinstance(value, float) or (
        isinstance(value, list) and all(isinstance(one, float) for one in value)
    )
    return pytest.approx(value, rel=1e-9, nan_ok=True) if numbers else value


@pytest.mark.slow
def test_evaluation_and_coefficients_say_the_same(tmp_path: Path) -> None:
    found = evaluated(tmp_path, campaign_of_tows(tmp_path, ANGLES), "horizontal")
    told = found.derivatives
    assert told is not None
    runner, folder, page = CliRunner(), str(tmp_path), tmp_path / "page.html"
    printed = runner.invoke(cli, ["coefficients", folder, "--json"]).stdout
    whole, own = json.loads(printed)["coefficients"], to_dict(told)
    for kept in ("table", "choices"):
        for one, other in zip(own[kept], whole[kept], strict=True):
            assert one == {key: _near(value) for key, value in other.items()}
    assert runner.invoke(cli, ["report", folder, "--output", str(page)]).exit_code == 0
    shown = runner.invoke(cli, ["coefficients", folder], env={"COLUMNS": "250"}).output
    for text in (shown, page.read_text(encoding="utf-8")):
        assert "static drift, cubic" in text
        assert "misfit" in text
    assert drift_figure(found.tows, told).axes[0].lines


def test_few_angles_make_a_line_and_two_an_interval_from_within_the_runs(tmp_path: Path) -> None:
    told = evaluated(tmp_path, campaign_of_tows(tmp_path, (4.0,)), "horizontal").derivatives
    assert told is not None
    assert not told.rows("N_vvv")
    k = single_row(told, "N_v", method="static drift")
    assert math.isnan(told.entries[k].misfit)
    assert 0.0 < told.half_widths[k] < 2.0
    assert abs(told.values[k] - N_V) < 1.5 * told.half_widths[k]


def test_resistance_is_against_the_motion(tmp_path: Path) -> None:
    found = evaluated(tmp_path, campaign_of_tows(tmp_path, ()), "horizontal")
    assert found.derivatives is None
    assert [one.speed_m_s for one in found.straight] == [0.4, 0.8]
    for one in found.straight:
        truth = 5.0 * one.speed_m_s**2
        assert abs(one.resistance_n - truth) < 2.0 * one.resistance_half_width
        assert one.resistance_half_width < 0.05


def test_a_tow_without_zeros_says_which_are_missing(tmp_path: Path) -> None:
    text = campaign_of_tows(tmp_path, (4.0,), zeros=False)
    found = evaluated(tmp_path, text, "horizontal")
    assert found.tows == ()
    assert [one.name for one in found.failed] == ["drift4", "tow0.4", "tow0.8"]
    assert all("no zero run is named" in one.message for one in found.failed)


def test_a_campaign_without_such_runs_says_nothing(tmp_path: Path) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text('[[runs]]\nname = "a"\nfrequency_hz = 1.0\neccentricity_mm = 20.0\n')
    assert in_water(read_campaign(path), tmp_path) == InWater()


def test_tows_have_their_froude_and_reynolds_numbers(tmp_path: Path) -> None:
    (tmp_path / "coefficients.toml").write_text("[ship]\nlength_m = 2.5\n", encoding="utf-8")
    text = campaign_of_tows(tmp_path, (4.0,)) + "[water]\ntemperature_deg_c = 15.0\n"
    found = evaluated(tmp_path, text, "horizontal")
    told = as_data(evaluation_document(Evaluation((), None, (), (), (), found)))
    speeds = sorted({one.speed_m_s for one in found.tows})
    assert told["conditions"] == [
        {
            "speed_m_s": speed,
            "froude_number": pytest.approx(speed / math.sqrt(9.80665 * 2.5)),
            "reynolds_number": pytest.approx(speed * 2.5 / 1.1386e-6, rel=1e-4),
            "depth_froude_number": None,
        }
        for speed in speeds
    ]
    assert speeds
