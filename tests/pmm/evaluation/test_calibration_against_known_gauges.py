"""A calibration is kept with every recording, and gives the forces behind wrong gauges."""

import json
from dataclasses import replace
from datetime import date
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from analysis.recording import Recording
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign.calibrated_recording import (
    APPLIED,
    CARRIED,
    calibrated,
    carried_calibration,
    provenance_of,
)
from pmm.campaign.calibration import Calibration, read_calibration, write_calibration
from pmm.cli import cli
from pmm.evaluation.run_results import read_results
from pmm.plan.checks import check_plan
from pmm.plan.findings import PlanVerdict
from pmm.plan.plan import read_plan_and_rig
from pmm.plan.rig_file import read_rig_file
from tests.pmm.plan.plans import GAUGES_TEXT, HEAVE, RIG_TEXT, write_plan
from tests.pmm.run.harness import bench, oscillation

GAUGES = ("force_aft", "force_fore")
MADE, EXPIRES = date(2025, 3, 1), date(2026, 3, 1)
# The aft gauge reads 2 % too much, the fore one 1 % too little and 3 % of its neighbour's force.
MATRIX = np.array([[1.02, 0.0], [0.03, 0.99]])


def made(matrix: np.ndarray = MATRIX, channels: tuple[str, ...] = GAUGES) -> Calibration:
    size = len(channels)
    return Calibration(
        channels, matrix, np.full((size, size), 1e-4), np.zeros(size), np.zeros(size), MADE, EXPIRES
    )


def record(values: np.ndarray, **more: object) -> Recording:
    names = ("shaft_angle", "force_fore", "force_aft")
    units = ("rad", "N", "N")
    channels = tuple(Channel(name, unit) for name, unit in zip(names, units, strict=True))
    return replace(Recording("run", channels, values, 100.0), **more)


ROWS = st.lists(st.integers(0, 2), min_size=1, max_size=4)


@given(rows=ROWS, start=st.integers(0, 40), stop=st.integers(0, 60), seed=st.integers(0, 99))
def test_any_part_of_the_samples_is_the_matrix_s_inverse(
    rows: list[int], start: int, stop: int, seed: int
) -> None:
    raw = np.random.default_rng(seed).normal(size=(3, 50))
    forces = np.linalg.inv(MATRIX) @ raw[[2, 1]]
    whole = np.array([raw[0], forces[1], forces[0]])
    found = calibrated(record(raw), made()).samples
    assert found.shape == (3, 50)
    assert np.allclose(found[rows, start:stop], whole[rows, start:stop], rtol=1e-13, atol=1e-13)
    assert np.allclose(found[0:3, start:stop], whole[:, start:stop], rtol=1e-13, atol=1e-13)


def test_what_a_recording_carries_is_what_was_kept(tmp_path: Path) -> None:
    one = read_calibration(write_calibration(made(), tmp_path / "calibration.toml"))
    kept = record(np.ones((3, 4)), provenance=provenance_of(one))
    found = carried_calibration(kept)
    assert found is not None
    assert (found.channels, found.made, found.expires) == (GAUGES, MADE, EXPIRES)
    assert (found.file, found.sha256) == ("calibration.toml", one.sha256)
    assert np.array_equal(found.matrix, MATRIX)
    applied = calibrated(kept)
    assert CARRIED not in applied.provenance
    assert json.loads(applied.provenance[APPLIED])["matrix"] == MATRIX.tolist()
    assert carried_calibration(applied) is None
    assert calibrated(applied) is applied
    with pytest.raises(DataError, match="was applied to it already"):
        calibrated(applied, one)


def test_a_recording_without_one_stays_as_it_is() -> None:
    one = record(np.ones((3, 4)))
    assert calibrated(one) is one
    assert provenance_of(None) == {}


def test_a_gauge_that_is_missing_is_named() -> None:
    one = record(np.ones((3, 4))).select(["force_aft"])
    with pytest.raises(DataError, match=r"no channel 'force_fore'.*cross-talk"):
        calibrated(one, made())


def test_a_damaged_one_in_a_recording_is_refused() -> None:
    with pytest.raises(DataError, match=r"run: its calibration cannot be read"):
        calibrated(record(np.ones((3, 4)), provenance={CARRIED: '{"matrix": [[1]]}'}))


@pytest.mark.parametrize(
    ("started", "days"), [("2026-03-01T10:00:00+00:00", None), ("2026-03-31T10:00:00+00:00", 30)]
)
def test_a_run_after_the_expiry_is_flagged(started: str, days: int | None) -> None:
    found = calibrated(record(np.ones((3, 4)), provenance={"started_utc": started}), made())
    said = [one.message for one in found.flags if one.code == "calibration_expired"]
    assert len(said) == (days is not None)
    for text in said:
        assert "expired on 2026-03-01, 30 days before 2026-03-31" in text
        assert "hang the check weights again" in text


def test_the_end_of_the_range_is_that_of_the_reading() -> None:
    """A gauge that stands at 490 N is clipped, although the force behind it is less."""
    raw = np.zeros((3, 50))
    raw[2, 10:13] = -490.0
    channels = (Channel("shaft_angle", "rad"), *(Channel(one, "N", 490.0) for one in GAUGES[::-1]))
    found = calibrated(replace(record(raw), channels=channels), made())
    told, flag = found.flags
    assert told.code == "calibrated"
    assert (flag.code, flag.channel) == ("saturated", "force_aft")
    assert "3 readings stand at the full scale of 490 N" in flag.message
    assert abs(found.values("force_aft")).max() == pytest.approx(490.0 / 1.02)


@pytest.mark.slow
def test_wrong_gauges_with_their_calibration_give_the_forces_of_right_ones(tmp_path: Path) -> None:
    run = oscillation(periods=3, max_periods=3)
    with bench(tmp_path / "right", [run]) as one:
        one.finish()
    with bench(tmp_path / "wrong", [run], calibration=made(np.diag([1.02, 0.99]))) as one:
        for i, wrong in enumerate((1.02, 0.99)):
            line = one.world.nodes[f"forces[{i}]"].lines[GAUGES[i]]
            line.scale = line.scale / wrong
        one.finish()
    right, wrong_one = (read_results(tmp_path / name)[0].recording() for name in ("right", "wrong"))
    assert wrong_one.provenance[CARRIED]
    assert json.loads(wrong_one.provenance["configuration_sha256"]).keys() >= {"calibration"}
    for name in GAUGES:
        raw, force = wrong_one.values(name), calibrated(wrong_one).values(name)
        truth = right.values(name)
        assert np.allclose(force, truth, atol=0.02), "counts of 10 mN"
        assert np.abs(raw - truth).max() > 0.3, "raw stays raw"


# What is wrong in a calibration file, and what the rig's file says of it.
SPOILED = [
    (None, "no calibration"),
    ("made = 2025", "channels, "),
    ("singular", "two gauges would tell the same"),
    ("narrow", "does not fit the 1 channels"),
    ("unknown", "'force_x', which is no gauge of this rig"),
]


@pytest.mark.parametrize(("how", "said"), SPOILED)
def test_a_file_that_is_no_calibration_is_named_with_all_other_errors(
    tmp_path: Path, how: str | None, said: str
) -> None:
    path = tmp_path / "calibration.toml"
    if how == "singular":
        write_calibration(made(np.ones((2, 2))), path)
    elif how == "narrow":
        write_calibration(made(MATRIX, ("force_aft",)), path)
    elif how == "unknown":
        write_calibration(made(np.eye(1), ("force_x",)), path)
    elif how is not None:
        path.write_text(how, encoding="utf-8")
    rig = tmp_path / "rig.toml"
    rig.write_text('calibration_file = "calibration.toml"\nnmae = "x"\n' + GAUGES_TEXT)
    with pytest.raises(ConfigurationError) as caught:
        read_rig_file(rig)
    assert "calibration_file" in str(caught.value)
    assert said in str(caught.value)
    assert "did you mean 'name'" in str(caught.value) or "name" in str(caught.value)


def test_a_plan_after_the_expiry_is_warned_of(tmp_path: Path) -> None:
    write_calibration(made(), tmp_path / "calibration.toml")
    text = 'calibration_file = "calibration.toml"\n' + RIG_TEXT
    path = write_plan(tmp_path, f'name = "a"\nrig = "rig.toml"\n{HEAVE}', text)
    plan, rig = read_plan_and_rig(path)
    assert rig.calibration is not None

    def warned(today: date) -> list[float]:
        found = check_plan(plan, rig, today)
        return [one.value for one in found if one.quantity.startswith("calibration")]

    assert warned(EXPIRES) == []
    assert warned(date(2026, 3, 31)) == [30.0]
    said = CliRunner().invoke(cli, ["plan", "check", str(path), "--json"])
    findings = [one for one in json.loads(said.stdout)["findings"] if "calibr" in one["quantity"]]
    assert [one["verdict"] for one in findings] == [PlanVerdict.WARN]
    assert "expired on 2026-03-01" in findings[0]["message"]
