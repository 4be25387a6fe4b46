"""The following error of struts on drives that this file integrates, and its share in the budget.

Each drive is a position loop round a speed loop of the test's own, gain and lag planted, integrated
by ``solve_ivp`` from the set-points; amplitude, phase, rms and peak are read off the integral.
"""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.readers import read_recording, write_recording
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import COMMAND_AFT, COMMAND_FORE, DISPLACEMENTS
from hardware.description.setpoint import SetPoint
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.workflow import CampaignOutcome, coefficients_of
from pmm.parallel import InThisProcess
from pmm.report.coefficients_document import coefficients_document, report_document
from pmm.report.following import following_figure, following_rows
from tests.pmm.coefficients.campaigns import head, horizontal_rig, record

HZ, ECCENTRICITY_M = 0.5, 0.05
OMEGA = 2.0 * math.pi * HZ
# Of each strut's drive, aft first: gain, natural frequency in rad/s, damping ratio.
DRIVES = ((0.996, 60.0, 0.7), (1.002, 45.0, 0.7))
U_ECCENTRICITY_M, U_PHASE_RAD = 1e-4, 2e-3
# Relative to what is planted: the encoders' noise of a micrometre over six periods of 200 samples.
NOISE_M, NEAR = 1e-6, 1e-4


def told_s(time_s: FloatArray, ahead: complex) -> FloatArray:
    found: FloatArray = (ahead * np.exp(1j * OMEGA * time_s)).imag
    return found


def moved(drive: tuple[float, float, float], time_s: FloatArray, ahead: complex) -> FloatArray:
    gain, natural, damping = drive

    def rates(t: float, y: FloatArray) -> list[float]:
        told = float(told_s(np.array(t), ahead))
        return [y[1], natural**2 * (gain * told - y[0]) - 2.0 * damping * natural * y[1]]

    settled = time_s[0] - 1.0  # 30 time constants before the record
    span = (settled, time_s[-1])
    done = solve_ivp(rates, span, [0.0, 0.0], method="DOP853", t_eval=time_s, rtol=1e-7, atol=1e-10)
    found: FloatArray = done.y[0]
    return found


def phasor(time_s: FloatArray, values: FloatArray) -> complex:
    angle = OMEGA * time_s
    basis = np.column_stack([np.sin(angle), np.cos(angle), np.ones_like(angle)])
    return complex(*np.linalg.lstsq(basis, values, rcond=None)[0][:2])


def led(recording: Recording, seed: int) -> tuple[Recording, list[tuple[FloatArray, FloatArray]]]:
    """Give both struts set-points that their drives make the recorded motion of."""
    time_s, noise = recording.time_s(), np.random.default_rng(seed)
    rows = recording.samples[0 : len(recording.channels), 0 : recording.sample_count].copy()
    pairs = []
    for name, drive in zip(DISPLACEMENTS, DRIVES, strict=True):
        gain, natural, damping = drive
        at = 1j * OMEGA
        response = gain * natural**2 / (at**2 + 2.0 * damping * natural * at + natural**2)
        seen = phasor(time_s, recording.values(name))
        told, true = (
            told_s(time_s, seen / response),
            moved(drive, time_s, seen / response),
        )
        pairs.append((told, true))
        rows[recording.index(name)] = true + NOISE_M * noise.standard_normal(len(time_s))
    channels = (*recording.channels, COMMAND_AFT, COMMAND_FORE)
    samples = np.vstack([rows, *(told for told, _ in pairs)])
    return replace(recording, channels=channels, samples=samples), pairs


def written(folder: Path, name: str, recording: Recording) -> None:
    path = folder / f"{name}.nc"
    path.unlink(missing_ok=True)
    write_recording(recording, path)


@pytest.fixture(scope="module")
def campaign(
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[Path, dict[str, list[tuple[FloatArray, FloatArray]]]]:
    folder = tmp_path_factory.mktemp("following")
    rig = horizontal_rig()
    text, planted = head(rig), {}
    for name, phase_rad in (("sway", 0.0), ("yaw", math.pi)):
        point = SetPoint(HZ, ECCENTRICITY_M, phase_rad, 0.8)
        text += record(folder, rig, name, point)
        text += f"u_eccentricity_m = {U_ECCENTRICITY_M}\nu_strut_phase_rad = {U_PHASE_RAD}\n"
        made, planted[name] = led(read_recording(folder / f"{name}.nc"), len(name))
        written(folder, name, made)
    (folder / "campaign.toml").write_text(text)
    return folder, planted


def outcome_of(folder: Path) -> CampaignOutcome:
    return coefficients_of([folder], CoefficientSettings(), InThisProcess(), lambda *_: None)


@pytest.fixture(scope="module")
def found(campaign: tuple[Path, Any]) -> CampaignOutcome:
    return outcome_of(campaign[0])


@pytest.mark.slow
def test_size_amplitude_and_phase_are_those_of_the_integrated_drives(
    campaign: tuple[Path, Any], found: CampaignOutcome
) -> None:
    folder, planted = campaign
    rows = following_rows(found)
    assert [(row.run, row.channel) for row in rows] == [
        (run, channel) for run in ("sway", "yaw") for channel in DISPLACEMENTS
    ]
    for row in rows:
        told, true = planted[row.run][DISPLACEMENTS.index(row.channel)]
        time_s = read_recording(folder / f"{row.run}.nc").time_s()
        off = true - told
        assert row.rms == pytest.approx(np.sqrt(np.mean(off**2)), rel=0.01)
        assert row.peak == pytest.approx(np.abs(off).max(), abs=5.0 * NOISE_M)
        gain = phasor(time_s, true) / phasor(time_s, told)
        assert row.amplitude_relative == pytest.approx(abs(gain) - 1.0, abs=NEAR)
        assert row.phase_rad == pytest.approx(np.angle(gain), abs=NEAR)
        assert row.frequency_hz == pytest.approx(HZ, rel=1e-3)
        assert abs(row.amplitude_relative) > 10.0 * NEAR
        assert row.phase_rad < -100.0 * NEAR


@pytest.mark.slow
def test_what_is_not_known_of_the_displacements_is_in_the_budget(
    campaign: tuple[Path, Any], found: CampaignOutcome, tmp_path: Path
) -> None:
    """The share is by how much the coefficient moves where all displacements are longer."""
    folder = campaign[0]
    relative = U_ECCENTRICITY_M / ECCENTRICITY_M
    assert found.stated.amplitude_relative == pytest.approx(relative)
    assert found.stated.strut_phase_rad == U_PHASE_RAD
    copied(folder, tmp_path, lambda _: dict.fromkeys(DISPLACEMENTS, 1.0 + relative))
    longer = outcome_of(tmp_path)
    row = next(k for k, one in enumerate(found.result.entries) if one.name == "Y_v")
    moved_by = longer.result.values[row] - found.result.values[row]
    shares = {
        one.label: found.result.uncertain.variances()[k, row]
        for k, one in enumerate(found.result.uncertain.contributions)
    }
    assert math.sqrt(shares["amplitude_relative"]) == pytest.approx(abs(moved_by), rel=0.02)
    assert abs(moved_by) > 0.0


def copied(folder: Path, to: Path, factors: Any, drop: tuple[str, ...] = ()) -> None:
    for name in ("sway", "yaw"):
        one = read_recording(folder / f"{name}.nc")
        rows = one.samples[0 : len(one.channels), 0 : one.sample_count].copy()
        for channel, factor in factors(name).items():
            rows[one.index(channel)] *= factor
        kept = [
            k for k, channel in enumerate(one.channel_names) if name != "yaw" or channel not in drop
        ]
        channels = tuple(one.channels[k] for k in kept)
        written(to, name, replace(one, channels=channels, samples=rows[kept]))
    (to / "campaign.toml").write_text((folder / "campaign.toml").read_text())


@pytest.mark.slow
def test_set_points_that_stand_in_are_off_by_the_other_runs_following(
    campaign: tuple[Path, Any], tmp_path: Path
) -> None:
    folder, planted = campaign
    copied(folder, tmp_path, lambda _: {}, DISPLACEMENTS)
    stated = outcome_of(tmp_path).stated
    time_s = read_recording(folder / "sway.nc").time_s()
    gains = [phasor(time_s, true) / phasor(time_s, told) for told, true in planted["sway"]]
    off = max(abs(abs(gain) - 1.0) for gain in gains)
    assert stated.amplitude_relative == pytest.approx(off, abs=NEAR)
    apart = abs(np.angle(gains[0] / gains[1]))
    assert stated.strut_phase_rad == pytest.approx(apart, abs=NEAR)
    lag_s = max(abs(np.angle(gain)) for gain in gains) / OMEGA
    assert stated.latency_s == pytest.approx(lag_s, abs=NEAR / OMEGA)


def test_where_no_set_points_were_recorded_nothing_is_said(
    campaign: tuple[Path, Any], tmp_path: Path
) -> None:
    told = (COMMAND_AFT.name, COMMAND_FORE.name)
    for name in ("sway", "yaw"):
        one = read_recording(campaign[0] / f"{name}.nc")
        written(tmp_path, name, one.select([c for c in one.channel_names if c not in told]))
    (tmp_path / "campaign.toml").write_text((campaign[0] / "campaign.toml").read_text())
    plain = outcome_of(tmp_path)
    assert following_rows(plain) == []
    assert plain.stated.amplitude_relative == 0.0


def test_people_and_programs_read_it(found: CampaignOutcome) -> None:
    for document in (coefficients_document(found), report_document(found)):
        (table,) = (one for one in document.contents if getattr(one, "key", "") == "following")
        assert [row["run"] for row in table.data] == ["sway", "sway", "yaw", "yaw"]
        assert {"rms", "peak", "u_phase_rad", "unit"} <= table.data[0].keys()
    axes = following_figure(following_rows(found)).axes
    assert [one.get_ylabel() for one in axes] == [
        "following error (µm)", "amplitude error (%)", "phase (°)",
    ]  # fmt: skip
    drawn = sorted(float(y) for line in axes[0].lines for y in line.get_ydata())
    sizes = sorted(1e6 * size for row in following_rows(found) for size in (row.rms, row.peak))
    assert drawn == pytest.approx(sizes)
