"""Every command that takes a changed ``run.nc`` says so and ends with 1, after its work.

Of unharmed files and of other programs' the walk of every campaign has its say.
"""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Final

import h5py
import pytest
from click.testing import CliRunner, Result

from benchmarks.boards.campaigns import EXAMPLES, simulated
from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from tests.end_to_end.walk import GAP

COMMANDS: Final = {
    "coefficients": ("coefficients",),
    "report": ("report",),
    "gap": GAP,
    "analyse": ("analyse",),  # which the sample draws
    "analyse --json": ("analyse", "--json"),
}
SEED: Final = 23


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    return simulated(EXAMPLES / "vertical" / "campaign.toml", folder, SEED, ())


@pytest.fixture
def campaign(made: Path, tmp_path: Path) -> Path:
    folder = made if made.is_dir() else made.parent
    shutil.copytree(folder, tmp_path / "campaign")
    return tmp_path / "campaign"


def first(campaign: Path) -> Path:
    """Return the recording of the first run."""
    return read_campaign(campaign / "campaign.toml").runs[0].recording_path(campaign)


def run(command: str, campaign: Path) -> Result:
    return CliRunner().invoke(cli, [*COMMANDS[command], str(campaign)])


def a_value(file: h5py.File) -> None:
    file["force_aft"][1500] = -file["force_aft"][1500]


def an_attribute(file: h5py.File) -> None:
    file["force_aft"].attrs["units"] = "V"


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("command", "change"), [*((one, a_value) for one in COMMANDS), ("analyse", an_attribute)]
)
def test_a_change_is_said(
    campaign: Path, command: str, change: Callable[[h5py.File], None]
) -> None:
    with h5py.File(first(campaign), "r+") as file:
        change(file)
    found = run(command, campaign)
    assert found.exit_code == 1, found.output
    assert "not what was written" in found.stderr
    assert "force_aft" in found.stderr
    assert found.stdout  # what could be done was done
