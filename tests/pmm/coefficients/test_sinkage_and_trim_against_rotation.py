"""Sinkage and trim of recordings whose points were moved by a rotation that the test wrote."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.container import ErrorbarContainer

from analysis.attitude import AttitudeChannel, RestPosition, with_attitude
from analysis.readers import read_recording, write_recording
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from pmm.plan.rig_file import read_rig_file
from pmm.report.attitude import AttitudeRow
from pmm.report.attitude_figure import attitude_figure
from tests.pmm.coefficients.campaigns import at_rest, head, horizontal_rig, record
from tests.pmm.plan.plans import RIG_TEXT

AFT_M, FORE_M, AT_M = -0.7, 1.1, 0.25
OFFSETS_M = (0.031, -0.012)
NOISE_M = 2e-4
SINKAGE_M, TRIM_RAD = (0.012, 0.004, 0.0015), (0.2, 0.15, 0.03)  # mean and two amplitudes
FREQUENCY_HZ, SPEED_M_S = 0.25, 0.8
TABLE = f"""
[attitude]
aft_x_m = {AFT_M}
fore_x_m = {FORE_M}
sinkage_x_m = {AT_M}
heave_and_pitch = "free"
"""


def wave(parts: tuple[float, ...], time_s: FloatArray, phase: float) -> FloatArray:
    mean, first, second = parts
    turn = 2.0 * math.pi * FREQUENCY_HZ * time_s
    found: FloatArray = mean + first * np.sin(turn + phase) + second * np.sin(2.0 * turn - phase)
    return found


def positions(sinkage_m: FloatArray, trim_rad: FloatArray) -> FloatArray:
    """Rotate both points about the one whose sinkage is given; z is down, bow up lifts the bow."""
    turned = np.exp(-1j * trim_rad)  # x + i z
    rows = [sinkage_m + ((x - AT_M) * turned).imag for x in (AFT_M, FORE_M)]
    found: FloatArray = np.array(rows) + np.array(OFFSETS_M)[:, None]
    return found


def extended(recording: Recording, rows: FloatArray, seed: int, unit: str = "m") -> Recording:
    noisy = rows + NOISE_M * np.random.default_rng(seed).standard_normal(rows.shape)
    own = recording.samples[0 : len(recording.channels), 0 : recording.sample_count]
    added = (Channel("position_aft", unit), Channel("position_fore", unit))
    return replace(
        recording, channels=(*recording.channels, *added), samples=np.vstack([own, noisy])
    )


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("attitude")
    rig = horizontal_rig()
    text = head(rig) + TABLE
    sway = record(folder, rig, "sway", SetPoint(FREQUENCY_HZ, 0.05, 0.0, SPEED_M_S))
    text += sway + 'zero_before = "rest"\n'
    for name, kind in (("rest", "zero"), ("tow", "straight-tow")):
        text += f'[[at_rest]]\nname = "{name}"\nkind = "{kind}"\nduration_s = 10.0\n'
        text += f'file = "{name}.nc"\n'
    text += f'carriage_speed_m_s = {SPEED_M_S}\nzero_before = "rest"\n'
    (folder / "campaign.toml").write_text(text)
    path = folder / "sway.nc"
    moved = read_recording(path)
    time_s = moved.time_s()
    rows = positions(wave(SINKAGE_M, time_s, 0.3), wave(TRIM_RAD, time_s, 1.1))
    made = extended(moved, rows, 1)
    path.unlink()
    write_recording(made, path)
    nothing = np.zeros(1000)
    rest, tow = (at_rest(name, (0.0, 0.0)) for name in ("rest", "tow"))
    write_recording(extended(rest, positions(nothing, nothing), 2), folder / "rest.nc")
    towed = positions(nothing + SINKAGE_M[0], nothing + TRIM_RAD[0])
    write_recording(extended(tow, towed, 3), folder / "tow.nc")
    return folder


def told(folder: Path) -> dict[str, Any]:
    ran = CliRunner().invoke(cli, ["coefficients", str(folder), "--json"])
    assert ran.exit_code == 0, ran.output
    found: dict[str, Any] = json.loads(ran.stdout)
    return found


@pytest.mark.slow
def test_means_and_harmonics_of_an_oscillation_and_a_tow(campaign: Path) -> None:
    rows = {row["run"]: row for row in told(campaign)["attitude"]}
    assert set(rows) == {"sway", "tow"}
    for name, orders in (("sway", 3), ("tow", 1)):
        row = rows[name]
        assert row["speed_m_s"] == SPEED_M_S
        assert row["heave_and_pitch"] == "free"
        for key, parts in (("sinkage", SINKAGE_M), ("trim", TRIM_RAD)):
            one = row[key]
            values = [one["mean"], *one["amplitude"]]
            apart = [one["mean_u"], *one["amplitude_u"]]
            assert len(values) == orders
            for value, u, true in zip(values, apart, parts, strict=False):
                assert 1e-6 < u < 5e-5
                assert abs(value - true) < 4.0 * u
    small = (TRIM_RAD[0] - math.sin(TRIM_RAD[0])) / rows["tow"]["trim"]["mean_u"]
    assert small > 50.0  # the small angle would be refused by the test


@pytest.mark.slow
def test_people_read_it_in_millimetres_and_degrees(campaign: Path) -> None:
    shown = CliRunner().invoke(cli, ["coefficients", str(campaign)]).stdout
    assert "Sinkage and trim" in shown
    assert "11.45" in shown  # degrees: 0.2 rad


@pytest.mark.slow
def test_the_figure_shows_each_run_over_speed_and_over_drift() -> None:
    cases = [(0.8, 0.0), (0.8, 0.1), (1.2, 0.0)]
    rows = [
        AttitudeRow(f"run {k}", speed, drift, 0.0, "free", 0.0, AttitudeChannel(speed**2, 0.1),
                    AttitudeChannel(drift, 0.01))
        for k, (speed, drift) in enumerate(cases)
    ]  # fmt: skip
    axes = attitude_figure(rows).axes
    drawn = [
        sorted(
            tuple(np.ravel(one.lines[0].get_xydata()))
            for one in panel.containers
            if isinstance(one, ErrorbarContainer) and one.lines[0] is not None
        )
        for panel in axes
    ]
    degrees = [(math.degrees(drift), speed) for speed, drift in cases]
    expected = [
        [(speed, 1e3 * speed**2) for speed, _ in cases],
        [(drift, 1e3 * speed**2) for drift, speed in degrees],
        [(speed, drift) for drift, speed in degrees],
        [(drift, drift) for drift, _ in degrees],
    ]
    for found, wanted in zip(drawn, expected, strict=True):
        np.testing.assert_allclose(found, sorted(wanted))


def test_without_noise_the_rotation_comes_back_exactly(campaign: Path) -> None:
    sensors = read_campaign(campaign / "campaign.toml").attitude
    assert sensors is not None
    trim = np.linspace(-1.2, 1.2, 101)
    sinkage = np.linspace(-0.4, 0.3, 101)
    channels = (Channel("position_aft", "m"), Channel("position_fore", "m"))
    recording = Recording("turned", channels, positions(sinkage, trim), 10.0)
    found = with_attitude(recording, sensors, RestPosition(OFFSETS_M, (0.0, 0.0)))
    np.testing.assert_allclose(found.values("trim"), trim, atol=1e-13)
    np.testing.assert_allclose(found.values("sinkage"), sinkage, atol=1e-13)
    apart = replace(recording, samples=np.array([[2.0], [0.0]]))
    with pytest.raises(DataError, match=r"more than the 1\.8 m between the sensors"):
        with_attitude(apart, sensors, RestPosition((0.0, 0.0), (0.0, 0.0)))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (TABLE, "", "no table [attitude]"),
        ('zero_before = "rest"\n', "", "no zero run with both positions is named"),
    ],
)
def test_what_is_not_stated_is_not_told(
    campaign: Path, tmp_path: Path, old: str, new: str, said: str
) -> None:
    for name in ("sway.nc", "rest.nc"):
        (tmp_path / name).symlink_to(campaign / name)
    text = (campaign / "campaign.toml").read_text().replace(old, new)
    text = text[: text.index('[[at_rest]]\nname = "tow"')]
    (tmp_path / "campaign.toml").write_text(text)
    found = told(tmp_path)
    assert found["attitude"] == []
    flags = [flag for run in found["runs"] if run["name"] == "sway" for flag in run["flags"]]
    assert any(flag["code"] == "attitude_unknown" and said in flag["message"] for flag in flags)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (TABLE.replace('"free"', '"perhaps"'), "heave_and_pitch"),
        (TABLE.replace('heave_and_pitch = "free"', ""), "heave_and_pitch"),
        (TABLE.replace(f"fore_x_m = {FORE_M}", "fore_x_m = -0.8"), "is not ahead of aft_x_m"),
        (
            '[oscillator]\npreset = "vertical-1963"\n' + TABLE,
            "a vertical oscillator forces heave and pitch",
        ),
    ],
)
def test_a_wrong_table_is_refused(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "campaign.toml"
    path.write_text(text)
    with pytest.raises(ConfigurationError, match=said):
        read_campaign(path)


@pytest.mark.slow
def test_a_rig_hands_the_table_on_and_refuses_a_free_one_in_the_vertical(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"

    table = TABLE.replace("[attitude]", "[campaign.attitude]")
    path.write_text(RIG_TEXT + table.replace('"free"', '"fixed"'))
    assert read_rig_file(path).campaign["attitude"]["fore_x_m"] == FORE_M
    for wrong, said in (
        (table, "a vertical oscillator forces heave and pitch"),
        (table.replace('heave_and_pitch = "free"', ""), "heave_and_pitch is missing"),
    ):
        path.write_text(RIG_TEXT + wrong)
        with pytest.raises(ConfigurationError, match=said):
            read_rig_file(path)
