"""The gauges' calibration: its own uncertainty in the budget, its expiry, and not twice."""

from collections.abc import Callable
from dataclasses import replace
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers import read_recording, write_recording
from analysis.recording import Recording
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.struts import to_strut_forces
from pmm.campaign.calibrated_recording import calibrated, provenance_of
from pmm.campaign.calibration import Calibration, write_calibration
from sim.rig import SimulatedRig, vertical_rig
from tests.pmm.coefficients.campaigns import head, pair, record
from tests.pmm.coefficients.test_command_against_put_in_values import done, linear, run

FREQUENCY_HZ = 0.8
GAUGES = ("force_aft", "force_fore")
MATRIX = np.array([[1.02, 0.01], [-0.02, 0.97]])
SPREAD = np.array([[2e-3, 1e-3], [5e-4, 3e-3]])
LINES = {
    "calibration, aft gauge": (0, 0),
    "cross-talk into the aft gauge": (0, 1),
    "cross-talk into the fore gauge": (1, 0),
    "calibration, fore gauge": (1, 1),
}


def made(matrix: np.ndarray = MATRIX, spread: np.ndarray = SPREAD) -> Calibration:
    dates = date(2025, 3, 1), date(2026, 3, 1)
    return Calibration(GAUGES, matrix, spread, np.zeros(2), np.zeros(2), *dates)


def respoiled(folder: Path, change: Callable[[Recording], Recording]) -> None:
    for path in sorted(folder.glob("*.nc")):
        write_recording(change(read_recording(path)), path, overwrite=True)


def read_wrongly(own: Recording) -> Recording:
    """Readings of gauges that the matrix describes, made four weeks after it expired."""
    samples = own.samples[:, 0 : own.sample_count].copy()
    rows = [own.channel_names.index(name) for name in GAUGES]
    samples[rows] = MATRIX @ samples[rows]
    return replace(
        own,
        samples=samples,
        provenance=dict(own.provenance) | {"started_utc": "2026-03-29T10:00:00+00:00"},
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Heave and pitch at one frequency, read by wrong gauges, and their calibration."""
    place: Path = tmp_path_factory.mktemp("gauges")
    rig = vertical_rig()
    text = head(rig)
    for k, (name, point) in enumerate(pair(FREQUENCY_HZ, 0.0)):
        text += record(place, rig, name, point, seed=k)
    (place / "campaign.toml").write_text(text)
    respoiled(place, read_wrongly)
    write_calibration(made(), place / "calibration.toml")
    return place


def with_file(folder: Path, settings: Path, more: str = "") -> Path:
    settings.write_text(f"calibration = '{folder / 'calibration.toml'}'\n{more}")
    return settings


def put_in_forces(rig: SimulatedRig, column: int) -> np.ndarray:
    """Strut forces per motion of one kind: C + G - omega^2 (M + A) + i omega B."""
    from analysis.ideal_rig import mass_matrix, weight_matrix

    plane, omega = rig.oscillator.plane, 2.0 * np.pi * FREQUENCY_HZ
    mass = mass_matrix(rig.body, plane) + np.array(rig.water.added_mass)
    held = np.array(rig.water.restoring) + weight_matrix(rig.body, plane, Medium.WATER)
    load = held - omega**2 * mass
    force, moment = (load + 1j * omega * np.array(rig.water.damping))[:, column]
    return np.array(to_strut_forces(force, moment, rig.oscillator.half_spacing_m, plane))


def lines(document: dict[str, Any], name: str) -> dict[str, float]:
    (budget,) = [one for one in document["budgets"] if one["name"] == name]
    return {line["source"]: abs(line["contribution"]) for line in budget["lines"]}


@pytest.mark.slow
def test_what_the_calibration_leaves_open_is_in_the_budget(folder: Path, tmp_path: Path) -> None:
    """Of a force F a part u on the gauge makes ``Re(F) u / omega^2`` of a33, ``Im(F) u / omega``
    of b33, where the moments of both cancel out."""
    found = done(folder, "--form", "seakeeping", "--settings", with_file(folder, tmp_path / "s"))
    rig, omega = vertical_rig(), 2.0 * np.pi * FREQUENCY_HZ
    spread = np.sqrt(np.linalg.inv(MATRIX) ** 2 @ SPREAD**2)
    for column, letter in enumerate("35"):
        forces = put_in_forces(rig, column)
        added, damping = (lines(found, f"{kind}3{letter}") for kind in "ab")
        for source, (reads, loaded) in LINES.items():
            one = spread[reads, loaded] * forces[loaded]
            assert added[source] == pytest.approx(abs(one.real) / omega**2, rel=0.01), source
            assert damping[source] == pytest.approx(abs(one.imag) / omega, rel=0.02), source
    stated = found["stated"]
    assert stated["gauge_aft_relative"] == pytest.approx(spread[0, 0], rel=1e-12)
    assert stated["cross_talk_fore"] == pytest.approx(spread[1, 0], rel=1e-12)


@given(seed=st.integers(0, 2**32 - 1))
def test_the_forces_uncertainty_is_that_of_drawn_matrices(seed: int) -> None:
    """Of small errors of the matrix: gains and cross-talk of the forces that it makes."""
    generator = np.random.default_rng(seed)
    matrix = np.eye(2) + 0.1 * generator.uniform(-1.0, 1.0, (2, 2))
    one = made(matrix, 1e-6 * generator.uniform(0.1, 1.0, (2, 2)))
    squares = np.zeros((2, 2))
    for at in np.ndindex(2, 2):
        wrong = matrix.copy()
        wrong[at] += one.standard_uncertainty[at]
        squares += (np.linalg.solve(wrong, matrix) - np.eye(2)) ** 2
    assert one.force_uncertainty == pytest.approx(np.sqrt(squares), rel=1e-4)


def test_the_file_gives_the_hull_and_the_settings_own_word_goes_first(
    folder: Path, tmp_path: Path
) -> None:
    said = "[uncertainty]\ngauge_aft_relative = 0.01\n"
    found = done(folder, "--settings", with_file(folder, tmp_path / "s", said))
    assert found["stated"]["gauge_aft_relative"] == 0.01
    assert found["stated"]["gauge_fore_relative"] > 0.0
    added = vertical_rig().water.added_mass
    rows = {row["name"]: row for row in linear(found)}
    for name, value in (("Z_wdot", -added[0][0]), ("M_qdot", -added[1][1])):
        assert abs(rows[name]["value"] - value) < rows[name]["half_width"]


@pytest.mark.slow
def test_a_file_in_the_settings_that_has_expired_is_said(folder: Path, tmp_path: Path) -> None:
    settings = with_file(folder, tmp_path / "s")
    flags = [one for each in done(folder, "--settings", settings)["runs"] for one in each["flags"]]
    said = [one["message"] for one in flags if one["code"] == "calibration_expired"]
    assert len(said) == 2
    assert all("28 days before 2026-03-29" in one for one in said)
    assert "expired" in run(folder, "--settings", settings).output


@pytest.mark.slow
def test_a_recordings_own_counts_as_the_file_does_and_nothing_is_applied_twice(
    folder: Path, tmp_path: Path
) -> None:
    for path in (*folder.glob("*.nc"), folder / "campaign.toml"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    carries = provenance_of(made())
    respoiled(tmp_path, lambda own: replace(own, provenance=dict(own.provenance) | carries))
    by_file = done(folder, "--settings", with_file(folder, tmp_path / "s.toml"))
    own = done(tmp_path)
    assert own["stated"] == by_file["stated"]
    assert linear(own) == linear(by_file)
    respoiled(tmp_path, calibrated)
    assert linear(done(tmp_path)) == linear(own)
    by_hand = tmp_path / "hand.toml"
    by_hand.write_text("calibration_matrix = [[1.0, 0.0], [0.0, 1.0]]\n")
    for settings in (tmp_path / "s.toml", by_hand):
        refused = run(tmp_path, "--settings", settings)
        assert refused.exit_code == 1
        assert "was applied to it already" in " ".join(refused.stderr.split())


@pytest.mark.slow
def test_of_two_calibrations_the_wider_counts(folder: Path, tmp_path: Path) -> None:
    rig = vertical_rig()
    text = head(rig)
    for k, factor in enumerate((1.0, 3.0)):
        name = f"heave-{k}"
        text += record(tmp_path, rig, name, SetPoint(FREQUENCY_HZ, 0.02), seed=k)
        path = tmp_path / f"{name}.nc"
        own = read_recording(path)
        kept = dict(own.provenance) | provenance_of(made(np.eye(2), factor * SPREAD))
        write_recording(replace(own, provenance=kept), path, overwrite=True)
    (tmp_path / "campaign.toml").write_text(text)
    stated = done(tmp_path)["stated"]
    assert stated["cross_talk_aft"] == pytest.approx(3.0 * SPREAD[0, 1])
