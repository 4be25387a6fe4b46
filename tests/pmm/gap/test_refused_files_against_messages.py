"""Files that cannot be written are refused before minutes of work."""

import os
from pathlib import Path

import pytest

from tests.pmm.gap.rigs import EXAMPLE, run

DECAY = EXAMPLE.parents[1] / "decay" / "roll.toml"
# What has nothing to diagnose says so, unless the file is looked at first.
ASKED: dict[str, tuple[str | Path, ...]] = {
    "campaign's page": ("gap", EXAMPLE.parent, "--page"),
    "campaign's plan": ("gap", EXAMPLE.parent, "--plan"),
    "pendulum's page": ("gap", "pendulum", DECAY, "--page"),
    "board's page": ("gap", "check", EXAMPLE.parent, "--page"),
}


@pytest.mark.parametrize("asked", ASKED.values(), ids=ASKED)
def test_a_folder_in_place_of_a_file(asked: tuple[str | Path, ...], tmp_path: Path) -> None:
    done = run(*asked, tmp_path)
    assert (done.exit_code, done.stdout) == (1, "")
    assert done.stderr == f"error: {asked[-1]} {tmp_path}: a folder; name a file\n"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
@pytest.mark.parametrize("asked", ASKED.values(), ids=ASKED)
def test_a_file_that_may_not_be_written(asked: tuple[str | Path, ...], tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    kept.touch(mode=0o400)
    done = run(*asked, kept)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr == f"error: {asked[-1]} {kept}: cannot be written to\n"


@pytest.mark.parametrize("asked", ASKED.values(), ids=ASKED)
def test_a_file_in_place_of_its_folder(asked: tuple[str | Path, ...], tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    done = run(*asked, tmp_path / "file" / "page")
    assert (done.exit_code, done.stdout) == (2, "")
    assert f"{tmp_path / 'file'} is a file, not a folder" in done.stderr


def test_a_file_that_is_there_is_kept_until_it_is_written_anew(tmp_path: Path) -> None:
    page, new = tmp_path / "gap.html", tmp_path / "new.html"
    page.write_text("as it was")
    assert run(*ASKED["campaign's page"], page).exit_code == 1
    assert run(*ASKED["campaign's page"], new).exit_code == 1
    assert page.read_text() == "as it was"
    assert not new.exists()
