"""Every command that writes, on a disk without room, against what it says and what it leaves.

The limit on a file's size stands for the disk: what is written beyond it fails as on a full one.
"""

import errno
import re
from pathlib import Path

import pytest

from hardware.description.room import file_error_text, is_full
from pmm.recorder.campaign_owner import LOCK
from pmm.whole_file import write_whole
from tests.pmm.run.processes import READINGS, SHORT, full_disk, pmm, written_plan
from tests.sim.devices.benches import ROOT

CAMPAIGN = ROOT / "examples" / "vertical" / "campaign.toml"
RUN = "heave-0.83"


NO_GIT = {"PATH": ""}  # which the limit would kill with its lock held


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign of one run."""
    folder = tmp_path_factory.mktemp("full") / "simulated"
    made = pmm("simulate", CAMPAIGN, "--run", RUN, "--output", folder)
    assert made.exit_code == 0, made.stderr
    return folder


COMMANDS = {
    "simulate": ("simulate", CAMPAIGN, "--run", RUN, "--output", "{to}"),
    "analyse --save": ("analyse", "{from}/heave-0.83.nc", "--save", "{to}"),
    "analyse --plot": ("analyse", "{from}/heave-0.83.nc", "--plot", "{to}"),
    "report": ("report", "{from}", "--output", "{to}/page.html"),
    "coefficients --netcdf": ("coefficients", "{from}", "--netcdf", "{to}/all.nc"),
    "coefficients --csv": ("coefficients", "{from}", "--csv", "{to}/all.csv"),
}


@pytest.mark.sample(2)
@pytest.mark.parametrize("size_bytes", [0, 200])
@pytest.mark.parametrize("command", COMMANDS)
def test_a_full_disk_is_a_sentence_with_its_file_and_leaves_no_half_of_one(
    command: str, size_bytes: int, simulated: Path, tmp_path: Path
) -> None:
    to = tmp_path / "to"
    to.mkdir()
    words = [str(one).format(**{"from": simulated, "to": to}) for one in COMMANDS[command]]
    with full_disk(size_bytes):
        done = pmm(*words, env=NO_GIT)
    assert done.exit_code == 1, done.stderr
    assert "Errno" not in done.stderr
    assert re.search(rf"{re.escape(str(to))}\S*: no room on the disk \(", done.stderr), done.stderr
    assert "make room" in done.stderr
    assert {one.name for one in to.iterdir()} <= {LOCK}


@pytest.mark.sample(1)
@pytest.mark.parametrize("size_bytes", [0, 500, 2000, 6000, 20_000])
def test_a_run_ends_with_the_hint_to_resume(size_bytes: int, tmp_path: Path) -> None:
    plan, folder = written_plan(tmp_path), tmp_path / "out"
    words = ("run", plan, "--output", folder, "--only", SHORT)
    with full_disk(size_bytes):
        done = pmm(*words, given=READINGS, env=NO_GIT)
    assert done.exit_code == 1, done.stderr
    assert "Errno" not in done.stderr
    assert f"{plan} --resume --output {folder}" in done.stderr
    assert "ake room" in done.stderr


@pytest.mark.slow
def test_recover_says_so_and_keeps_what_there_is(tmp_path: Path) -> None:
    plan, folder = written_plan(tmp_path), tmp_path / "out"
    made = pmm("run", plan, "--output", folder, "--only", SHORT, given=READINGS)
    assert made.exit_code == 0, made.stderr
    run = folder / SHORT
    for name in ("run.nc", "complete.json"):
        (run / name).unlink()
    kept = {one.name: one.read_bytes() for one in run.iterdir()}
    with full_disk(10_000):
        done = pmm("recover", run, env=NO_GIT)
    assert done.exit_code == 1, done.stderr
    assert f"{run / 'run.nc'}: no room on the disk (" in done.stderr
    assert {one.name: one.read_bytes() for one in run.iterdir()} == kept
    assert pmm("recover", run).exit_code == 0


def test_a_file_is_as_it_was_when_its_successor_cannot_be_written(tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    write_whole(path, "before")
    with full_disk(3), pytest.raises(OSError, match="File too large") as caught:
        write_whole(path, "after that")
    assert caught.value.filename == str(path)
    assert is_full(caught.value)
    assert path.read_text(encoding="utf-8") == "before"
    assert [one.name for one in tmp_path.iterdir()] == ["page.html"]


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EFBIG])
def test_an_error_without_a_name_is_a_sentence_too(number: int) -> None:
    told = file_error_text(OSError(number, "Disk quota exceeded"))
    assert told.startswith("a file could not be written: no room on the disk (")
    assert (
        file_error_text(OSError(errno.EACCES, "Permission denied", "a.nc"))
        == "a.nc: Permission denied"
    )
    assert file_error_text(OSError("closed")) == "closed"
