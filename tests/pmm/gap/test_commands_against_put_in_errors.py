"""A campaign with recorded commands against the errors that its simulated rig was given."""

import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from hardware.description.channels import COMMANDS
from pmm.gap.preparation import PreparedCampaign, prepare
from pmm.gap.run_notes import command_notes
from tests.pmm.gap.rigs import run, short

ADDED_M, PHASE_RAD, FASTER = (2e-4, -1e-4), 0.01, 1e-3
EFFECTS = (
    f"eccentricity-error:error_aft_m={ADDED_M[0]},error_fore_m={ADDED_M[1]}",
    f"strut-phase-error:error_rad={PHASE_RAD}",
    f"frequency-error:relative={FASTER}",
)


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("commands")
    both = "".join(f"{name} = {{}}\n" for name in COMMANDS)
    text = short().replace("[simulation]", f"{both}\n[simulation]")
    (folder / "told.toml").write_text(text)
    on = [word for effect in EFFECTS for word in ("--effect", effect)]
    done = run("simulate", folder / "told.toml", "--output", folder / "rig", *on)
    assert done.exit_code == 0, done.output
    return folder / "rig"


@pytest.fixture(scope="module")
def ready(rig: Path) -> PreparedCampaign:
    return prepare(rig, {})


def test_the_simulated_drive_records_what_it_was_told(rig: Path) -> None:
    """A sine of the set eccentricity at the set frequency, whatever the rig makes of it."""
    with xr.open_dataset(rig / "heave-0.80-20.nc") as record:
        time_s = record["time"].values - record["time"].values[0]
        for name in COMMANDS:
            values = record[name].values
            angle = 2.0 * math.pi * 0.8 * time_s
            basis = np.column_stack([np.sin(angle), np.cos(angle)])
            found = np.linalg.lstsq(basis, values, rcond=None)[0]
            assert np.hypot(*found) == pytest.approx(0.02, rel=1e-9)
            assert np.abs(values - basis @ found).max() < 1e-9


@pytest.mark.slow
def test_the_diagnosis_begins_with_the_errors(ready: PreparedCampaign) -> None:
    own = ready.recentred.rig
    for link, added_m in zip((own.linkage_aft, own.linkage_fore), ADDED_M, strict=True):
        assert link.eccentricity_m(0.02) == pytest.approx(0.02 + added_m, abs=5e-6)
    assert own.linkage_fore.phase_error_rad == pytest.approx(PHASE_RAD, abs=1e-4)
    assert own.drive.speed_error == pytest.approx(FASTER, abs=1e-5)
    assert ready.left_out == {}


def test_it_says_so(ready: PreparedCampaign) -> None:
    notes = list(command_notes(SimpleNamespace(ready=ready)))  # type: ignore[arg-type]
    assert [one.split(":")[0] for one in notes] == [
        "eccentricity aft", "eccentricity fore", "frequency", "strut phase",
    ]  # fmt: skip
    assert all("by command and measured position of 5 runs" in one for one in notes)
    assert "frequency: +0.001" in notes[2]


@pytest.mark.slow
def test_a_stated_tolerance_goes_before(rig: Path) -> None:
    case = rig / "case.toml"
    case.write_text("[tolerances]\nstrut_phase_rad = 0.002\n")
    try:
        found = prepare(rig, {})
    finally:
        case.unlink()
    assert found.recentred.rig.linkage_fore.phase_error_rad == 0.0
    assert found.settings.tolerances.strut_phase_rad == 0.002
