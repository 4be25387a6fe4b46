"""``pmm demo``: a table, plots, a page that needs nothing else, and a command that repeats it."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    folder = tmp_path_factory.mktemp("somewhere") / "demo"
    arguments = ["demo", "--output", str(folder), "--vertical-only"]
    return folder, CliRunner().invoke(cli, arguments, catch_exceptions=False)


def test_the_last_line_is_the_page(demo: tuple[Path, Result]) -> None:
    folder, done = demo
    assert done.exit_code == 0
    assert "11 of 11 runs complete" in done.stdout
    assert done.stdout.splitlines()[-1] == str(folder / "report.html")
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "heave-f0.5-a20" in page
    assert "pitch-f1.2-a20" in page
    assert not re.search(r"(?:src|href)=\"(?:https?:)?//", page)


def test_the_table_has_a_line_per_run_and_force(demo: tuple[Path, Result]) -> None:
    lines = demo[1].stdout.splitlines()
    assert len([line for line in lines if re.search(r"force_(?:aft|fore) \[N\]\s+1 ", line)]) == 14


def test_plots_are_written(demo: tuple[Path, Result]) -> None:
    names = {path.name for path in (demo[0] / "plots").iterdir()}
    assert {f"heave-f0.5-a20-{one}" for one in ("gate.svg", "gate.png", "phasors.svg")} <= names


def test_the_command_it_names_repeats_one_of_them(demo: tuple[Path, Result]) -> None:
    (line,) = (line for line in demo[1].stdout.splitlines() if line.startswith("again"))
    program, *arguments = shlex.split(line.removeprefix("again"))
    assert program == "pmm"
    done = CliRunner().invoke(cli, arguments, catch_exceptions=False)
    assert done.exit_code == 0
    first = re.search(r"force_aft \[N\]\s+1 .*", demo[1].stdout)
    assert first
    for value in re.findall(r"\S+ ± \S+", first[0]):
        assert value in done.stdout
