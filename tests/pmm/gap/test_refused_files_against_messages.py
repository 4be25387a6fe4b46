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
}


# What writes nothing over unasked.
CAREFUL: dict[str, tuple[str | Path, ...]] = {
    "coefficients' table": ("coefficients", EXAMPLE.parent, "--csv"),
    "coefficients' array": ("coefficients", EXAMPLE.parent, "--netcdf"),
    "report's page": ("report", EXAMPLE.parent, "--output"),
}


@pytest.mark.parametrize("asked", (ASKED | CAREFUL).values(), ids=ASKED | CAREFUL)
def test_a_folder_in_place_of_a_file(asked: tuple[str | Path, ...], tmp_path: Path) -> None:
    done = run(*asked, tmp_path)
    assert (done.exit_code, done.stdout) == (2, "")
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


@pytest.mark.parametrize("asked", CAREFUL.values(), ids=CAREFUL)
def test_a_file_that_is_there_already(asked: tuple[str | Path, ...], tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    done = run(*asked, tmp_path / "file")
    assert (done.exit_code, done.stdout) == (2, "")
    assert f"{asked[-1]} {tmp_path / 'file'}: there already; " in done.stderr


@pytest.mark.parametrize(
    ("asked", "other"),
    [(ASKED["campaign's page"], "--plan"), (CAREFUL["coefficients' table"], "--netcdf")],
    ids=["campaign", "coefficients"],
)
def test_one_file_for_two_options(
    asked: tuple[str | Path, ...], other: str, tmp_path: Path
) -> None:
    one, same = tmp_path / "one", tmp_path / "by" / ".." / "one"
    done = run(*asked, one, other, same)
    assert (done.exit_code, done.stdout) == (2, "")
    said = f"error: {asked[-1]} {one} and {other} {same}: the same file; name two\n"
    assert done.stderr == said


@pytest.mark.parametrize(
    ("asked", "file", "named"),
    [
        (("gap", "CAMPAIGN", "--page"), "campaign.toml", "CAMPAIGN"),
        (("gap", "CAMPAIGN/campaign.toml", "--plan"), "campaign.toml", "CAMPAIGN"),
        (("gap", "CAMPAIGN", "--plan"), "case.toml", "CAMPAIGN"),
        (("gap", "CAMPAIGN", "--effects", "CAMPAIGN/own.py", "--page"), "own.py", "--effects"),
        (("gap", "pendulum", "CAMPAIGN/roll.toml", "--page"), "roll.toml", "FILE.toml"),
    ],
)
def test_a_file_that_the_command_reads(
    asked: tuple[str, ...], file: str, named: str, tmp_path: Path
) -> None:
    (tmp_path / file).write_text("kept")
    words = [one.replace("CAMPAIGN", str(tmp_path)) for one in asked]
    done = run(*words, tmp_path / file)
    assert (done.exit_code, done.stdout) == (2, "")
    read = f"{named} is read from it; name another file"
    assert done.stderr == f"error: {asked[-1]} {tmp_path / file}: {read}\n"
    assert (tmp_path / file).read_text() == "kept"


def test_a_file_that_is_there_is_kept_until_it_is_written_anew(tmp_path: Path) -> None:
    page, new = tmp_path / "gap.html", tmp_path / "new.html"
    page.write_text("as it was")
    assert run(*ASKED["campaign's page"], page).exit_code == 1
    assert run(*ASKED["campaign's page"], new).exit_code == 1
    assert page.read_text() == "as it was"
    assert not new.exists()
