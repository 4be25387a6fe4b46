"""``pmm init campaign`` on CSVs of a simulator that is not ours, with other names and units."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli
from pmm.start.recordings import find_campaign
from tests.sealed.generator.case import make
from tests.sealed.generator.recordings import FOREIGN, write_csv

SEED = 4711


@pytest.mark.slow
@pytest.mark.parametrize("index", [1, 3, 4])  # all sensors, no displacements, no encoder
def test_roles_and_set_points_are_those_of_the_case(tmp_path: Path, index: int) -> None:
    case = make(SEED, index, null=True)
    rig, told = case.campaign.rig, {run.name: run for run in case.campaign.runs}
    for number, run in enumerate(told.values()):
        write_csv(tmp_path / f"{run.name}.csv.gz", case.recorded(run, number), run, rig)
    # All that lies there, the files of the photocell's pulses too.
    found = find_campaign(sorted(tmp_path.iterdir()), tmp_path)
    truth = {name: FOREIGN[name][0].rpartition(" [")[0] for name in rig.sensors if name in FOREIGN}
    assert {one.name: one.column for one in found.columns if not one.doubt} == truth
    assert found.edges_file == "{stem}_edges.csv"
    assert sorted(one.name for one in found.runs) == sorted(told)
    for one in found.runs:
        run = told[one.name]
        assert one.doubt == ""
        assert one.frequency_hz == pytest.approx(run.frequency_hz, rel=2e-3)
        assert one.carriage_speed_m_s == pytest.approx(run.carriage_speed_m_s, rel=0.02, abs=1e-3)
        if "displacement_aft" in rig.sensors:
            assert one.eccentricity_mm == pytest.approx(1e3 * run.eccentricity_m, rel=0.03)
            turn = np.deg2rad(one.strut_phase_deg) - run.strut_phase_rad
            assert abs(np.angle(np.exp(1j * turn))) < np.deg2rad(2.0)
        else:
            assert "NOT FOUND" in one.remarks["eccentricity_mm"]


@pytest.mark.slow
def test_the_commands_take_what_was_found_or_name_the_remedy(tmp_path: Path) -> None:
    case = make(SEED, 1, null=True)
    paths = [tmp_path / f"{run.name}.csv.gz" for run in case.campaign.runs]
    for number, (path, run) in enumerate(zip(paths, case.campaign.runs, strict=True)):
        write_csv(path, case.recorded(run, number), run, case.campaign.rig)
    folder = tmp_path / "made"
    model = ["--mass-kg", "70", "--inertia-kg-m2", "27.5"]
    words = ["init", "campaign", "--yes", "--output", str(folder), *model, *map(str, paths)]
    made = CliRunner().invoke(cli, words)
    assert made.exit_code == 0, made.stderr
    for command in ("analyse", "coefficients"):
        done = CliRunner().invoke(cli, [command, str(folder)])
        assert done.exit_code == 0, done.stderr
    refused = CliRunner().invoke(cli, ["gap", str(folder)])
    assert refused.exit_code == 1
    assert "the campaign has no [hull]" in refused.stderr
